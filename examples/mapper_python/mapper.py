"""Listing 1, the basic algorithm, from docs/semantics.md alone: sections 2 to 6."""


def views(seen):  # the percept at each dart of a vertex, from that at its first
    degree, marker = seen["degree"], seen["marker"]
    turned = (None if marker is None else (marker - k) % degree for k in range(degree))
    return [{"degree": degree, "marker": door} for door in turned]


def signature(seen):  # what can be compared before the robot knows which door is which
    return seen["degree"], seen["marker"] is None


def explore(robot):  # noqa: C901, PLR0915  one listing, one function
    base, vertex, looks, alpha, unexplored = [], [], [], {}, set()

    def add_vertex(seen):  # its darts take the next numbers; each has the percept that it looks at
        base.append(len(vertex))
        looks.extend(views(seen))
        vertex.extend([len(base) - 1] * seen["degree"])
        unexplored.update(range(base[-1], len(vertex)))
        return base[-1]

    def darts(v):
        return range(base[v], base[v] + looks[base[v]]["degree"])

    def turn(dart, k):  # the dart that door k means to a robot with this reference dart
        row = darts(vertex[dart])
        return row[(dart - row[0] + k) % len(row)]

    def tree(root):  # for each vertex: its distance from the root, its dart towards it
        found = {root: (0, None)}
        for v in (queue := [root]):
            for far in (alpha[dart] for dart in darts(v) if dart in alpha):
                if vertex[far] not in found:
                    found[vertex[far]] = found[v][0] + 1, far
                    queue.append(vertex[far])
        return found

    def way(dart, up):  # to the root of a tree: doors, and the darts of arrival
        doors, arrivals = [], [dart]
        while (out := up[vertex[dart]][1]) is not None:
            doors.append(out - dart)
            arrivals.append(dart := alpha[out])
        return doors, arrivals

    def go(door, purpose):  # the purpose is for pictures of the run
        moves.append(robot.move(door % robot.percept.degree, purpose))
        return {"degree": moves[-1].degree, "marker": moves[-1].marker}

    def say(event, **fields):
        robot.declare({"type": event, "edge": e, **fields})

    moves, at = [], 0
    if robot.percept.degree:  # else there is nothing to explore
        add_vertex({"degree": robot.percept.degree, "marker": robot.percept.marker})
    while unexplored:
        near, home = tree(vertex[at]), tree(0)
        e = min(unexplored, key=lambda dart: (near[vertex[dart]][0], dart))
        unexplored.remove(e)
        doors, arrivals = way(at, tree(vertex[e]))
        for door in doors:
            go(door, "walk")
        seen = go(e - arrivals[-1], "cross")
        alike = [h for h in unexplored if signature(looks[h]) == signature(seen)]
        alike.sort(key=lambda h: (home[vertex[h]][0], h))
        say("pose", hypotheses=alike)
        turned, entry = 0, None
        for h in alike:
            doors, arrivals = way(h, home)
            step, now = 0, seen
            while now == looks[arrivals[step]] and step < len(doors):
                now, turned, step = go(doors[step] - turned, "validate"), 0, step + 1
            if now == looks[arrivals[step]]:
                say("confirm", hypothesis=h, rule="motion")
                entry = h
                break
            why = {"step": step, "expected": looks[arrivals[step]], "observed": now}
            say("reject", hypothesis=h, rule="motion", evidence=why)
            for door in reversed(doors[:step]):
                go(-turned, "retrace")
                turned = door
        kind, entry = ("new", add_vertex(seen)) if entry is None else ("loop", entry)
        alpha[e], alpha[entry] = entry, e
        unexplored.remove(entry)
        say("augment", kind=kind, dart=entry, degree=seen["degree"])
        at = turn(entry, turned) if kind == "new" else turn(0, -robot.percept.marker)
    return {
        "vertices": [[*darts(v)] for v in range(len(base))] or [[]],
        "edges": [[d, alpha[d]] for d in sorted(alpha) if d < alpha[d]],
        "marker": 0 if alpha else None,
        "cost": len(moves),
    }
