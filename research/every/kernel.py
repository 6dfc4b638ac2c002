"""The states of one world by masks of darts, for rules that remember nothing: kernels.

The mapper does not run here: each way home is walked on the table of the world's darts.

    S          explored: a mask of darts; entries: four bits a vertex, its first dart; 15: unknown
    between    S and the robot's vertex. All positions over one S share what happens behind e.
    behind e   masks: `remaining` of places in H; `kills` of each hypothesis: which others the rule
               rejects once it has been walked

`world` has five rows: alpha, vertex, percept of each dart; first dart, degree of each vertex,
whose darts are consecutive, clockwise.

Judged in every state: the true hypothesis is neither killed nor found to differ on its way
(claim 3), no other way home shows what it should (4), and rejections rest on a percept that
differs (8).
"""

from __future__ import annotations

from topo_verify.extra.fast.kernels.kernel import WordCube, WordTable, entry, kernel
from topo_verify.extra.fast.kernels.names import Words
from topo_verify.extra.fast.kernels.workspace import WordLayout

STATES = WordLayout("states", {}, sources=(__name__,))

MOST_DARTS = 14

KEY, REACHED, PLACE, SLOT = 0, 1, 2, 3

ROOM = 1 << 14

NONE, PREFIX, HISTORY = 0, 1, 2

VERTICES, UNKNOWN, NEVER = 8, 15, 1 << 40
"""Most vertices in a key; no dart; no cost."""

GOOD, KILLED, DIFFERS, CONFIRMED, FULL = 0, 1, 2, 3, 4


# ---------------------------------------------------------------- behind one e


@kernel
def turned(world: WordTable, dart: int, door: int) -> int:
    """The dart behind a door, for a robot with this reference dart."""
    vertex = world[1, dart]
    first, degree = world[3, vertex], world[4, vertex]
    return first + (dart - first + door) % degree


@entry
def outward(
    world: WordTable, explored: int, entries: int, root: int, tree: Words, depth: Words,
) -> None:  # fmt: skip
    """Breadth-first search on S: each vertex's dart towards the root, and its distance."""
    for vertex in range(VERTICES):
        depth[vertex], tree[vertex] = -1, -1
    depth[root] = 0
    queue, head, tail = root, 0, 1  # four bits a vertex
    while head < tail:
        vertex = queue >> 4 * head & 15
        head += 1
        for door in range(world[4, vertex]):
            dart = turned(world, entries >> 4 * vertex & 15, door)
            other = world[0, dart]
            beyond = world[1, other]
            if explored >> dart & 1 and depth[beyond] < 0:
                depth[beyond], tree[beyond] = depth[vertex] + 1, other
                queue |= beyond << 4 * tail
                tail += 1


@kernel
def walk_home(world: WordTable, tree: Words, vu: int, h: int, place: int, row: WordTable) -> int:
    """Walk the way home of h from vu. Returns the step that differs, or -1.

    `row[place]` gets: length of the way, doors walked; then per step door, expected, seen.
    """
    at, real, step = h, vu, 0
    differs = -1 if world[2, at] == world[2, real] else 0
    while tree[world[1, at]] >= 0:
        up = tree[world[1, at]]
        door = (up - at) % world[4, world[1, at]]
        at = world[0, up]
        step += 1
        row[place, 3 * step], row[place, 3 * step + 1] = door, world[2, at]
        if differs < 0:
            real = world[0, turned(world, real, door)]
            row[place, 3 * step + 2] = world[2, real]
            if world[2, real] != world[2, at]:
                differs = step
    row[place, 0], row[place, 1] = step, step if differs < 0 else differs
    return differs


@kernel
def shared_doors(row: WordTable, way: int, last: int) -> int:
    """Number of doors that a way home shares with the last sequence."""
    most = min(row[way, 0], row[last, 1])
    step = 0
    while step < most and row[way, 3 * step + 3] == row[last, 3 * step + 3]:
        step += 1
    return step


@kernel
def refutes(
    world: WordTable, explored: int, rule: int, row: WordTable, last: int, g: int, way: int,
) -> bool:  # fmt: skip
    """Whether the last sequence refutes g for the rule."""
    if rule == PREFIX:
        for step in range(1, shared_doors(row, way, last) + 1):
            if row[last, 3 * step + 2] != row[way, 3 * step + 1]:
                return True
    if rule == HISTORY:
        at = g
        for step in range(1, row[last, 1] + 1):
            leaves = turned(world, at, row[last, 3 * step])
            if not explored >> leaves & 1:
                return False
            at = world[0, leaves]
            if world[2, at] != row[last, 3 * step + 2]:
                return True
    return False


@kernel
def pose(
    world: WordTable, explored: int, entries: int, tree: Words, e: int, rule: int, darts: Words,
    row: WordTable, kills: Words, facts: Words,
) -> None:  # fmt: skip
    """Make H for e, walk every hypothesis, and find what each rules out.

    `facts` gets: number of hypotheses, place of the true one or -1, vu is v0, what is wrong.
    """
    vu = world[0, e]
    at_marker = world[1, vu] == world[1, 0]
    count, true, wrong = 0, -1, GOOD
    for vertex in range(VERTICES):
        if entries >> 4 * vertex & 15 == UNKNOWN:
            continue
        if world[4, vertex] != world[4, world[1, vu]] or (vertex == world[1, 0]) != at_marker:
            continue
        for dart in range(world[3, vertex], world[3, vertex] + world[4, vertex]):
            if dart != e and not explored >> dart & 1:
                darts[count] = dart
                true = count if dart == vu else true
                count += 1
    for place in range(count):
        kills[place] = 1 << place
        differs = walk_home(world, tree, vu, darts[place], place, row)
        row[place, 2] = differs
        if place == true and differs >= 0:
            wrong = DIFFERS
        if place != true and differs < 0:
            wrong = CONFIRMED
    for place in range(count):
        if row[place, 2] < 0 or row[place, 1] == 0 or rule == NONE:
            continue
        for other in range(count):
            if other == place:
                continue
            if refutes(world, explored, rule, row, place, darts[other], other):
                kills[place] |= 1 << other
                if other == true and wrong == GOOD:
                    wrong = KILLED
    facts[0], facts[1], facts[2], facts[3] = count, true, int(at_marker), wrong


@kernel
def free_order(row: WordTable, facts: Words, ends: Words) -> None:
    """The range of the costs and the number of states if no hypothesis rules out another."""
    count, true = facts[0], facts[1]
    false = count - (true >= 0)
    last = row[true, 1] if true >= 0 else 0
    every = -last
    for place in range(count):
        every += 2 * row[place, 1]
    ends[0], ends[1] = last if true >= 0 else every, every
    # Beside the true one any set of false ones may remain; without it two or more.
    sets, apart = (1 << false) - 1, 0 if true >= 0 else false
    ends[2], ends[3] = sets - apart, (sets if true >= 0 else 0) + false * (sets + 1 >> 1) - apart


@entry
def tie(row: WordTable, remaining: int, last: int, count: int, overlap: int) -> int:
    """A mask of the hypotheses that the motion allows next."""
    if not overlap or last == count:
        return remaining
    longest, allowed = -1, 0
    for place in range(count):
        if remaining >> place & 1:
            shared = shared_doors(row, place, last)
            if shared > longest:
                longest, allowed = shared, 0
            if shared == longest:
                allowed |= 1 << place
    return allowed


@kernel
def price(row: WordTable, place: int, last: int, count: int, overlap: int) -> int:
    """The moves of trying a hypothesis; under `retrace` including the way back to vu."""
    walked = row[place, 1]
    if not overlap:
        return 2 * walked if row[place, 2] >= 0 else walked
    if last == count:
        return walked
    shared = shared_doors(row, place, last)
    if shared == row[place, 0]:  # walked already
        return 0
    return row[last, 1] - shared + walked - shared


@entry
def same_walk(row: WordTable, place: int) -> int:
    """The first hypothesis whose sequence has the same doors."""
    for other in range(place):
        if row[other, 2] >= 0 and row[other, 1] == row[place, 1]:
            step = 1
            while step <= row[place, 1] and row[other, 3 * step] == row[place, 3 * step]:
                step += 1
            if step > row[place, 1]:
                return other
    return place


@kernel
def ordered(
    row: WordTable, kills: Words, facts: Words, overlap: int, best: WordTable, ends: Words,
) -> None:  # fmt: skip
    """The range of the costs behind e, and the number of states.

    `best[remaining * (count + 1) + last]` gets the least and the most that remains to be paid.
    """
    count = facts[0]
    full, wide = (1 << count) - 1, count + 1
    ends[2], ends[3] = 0, 0
    for index in range((full + 1) * wide):
        best[index, 0] = -1
    best[full * wide + count, 0] = NEVER
    for remaining in range(full, 0, -1):
        for last in range(wide):
            if best[remaining * wide + last, 0] < 0:
                continue
            allowed, ways = tie(row, remaining, last, count, overlap), 0
            for place in range(count):
                if allowed >> place & 1:
                    ways += 1
                    remaining_then = remaining & ~kills[place]
                    if row[place, 2] >= 0 and remaining_then:
                        after = same_walk(row, place) if overlap and row[place, 1] else count
                        best[remaining_then * wide + after, 0] = NEVER
            if ways > 1:
                ends[2] += 1
                ends[3] += ways
    for remaining in range(1, full + 1):
        for last in range(wide):
            index = remaining * wide + last
            if best[index, 0] < 0:
                continue
            allowed = tie(row, remaining, last, count, overlap)
            least, most = NEVER, 0
            for place in range(count):
                if allowed >> place & 1:
                    low, high = tried(row, kills, count, overlap, best, remaining, last, place)
                    least, most = min(least, low), max(most, high)
            best[index, 0], best[index, 1] = least, most
    ends[0], ends[1] = best[full * wide + count, 0], best[full * wide + count, 1]


@entry
def tried(
    row: WordTable, kills: Words, count: int, overlap: int, best: WordTable, remaining: int,
    last: int, place: int,
) -> tuple[int, int]:  # fmt: skip
    """The least and the most that is paid from a state on by this hypothesis."""
    paid = price(row, place, last, count, overlap)
    if row[place, 2] < 0:
        return paid, paid
    remaining_then = remaining & ~kills[place]
    if not remaining_then:  # the robot goes back to vu
        paid += row[place, 1] if overlap else 0
        return paid, paid
    after = same_walk(row, place) if overlap and row[place, 1] else count
    index = remaining_then * (count + 1) + after
    return paid + best[index, 0], paid + best[index, 1]


@entry
def behind(
    world: WordTable, explored: int, entries: int, tree: Words, e: int, rule: int, overlap: int,
    darts: Words, row: WordTable, kills: Words, facts: Words, best: WordTable, ends: Words,
) -> None:  # fmt: skip
    """Everything that may happen behind e, in `facts` and `ends`."""
    pose(world, explored, entries, tree, e, rule, darts, row, kills, facts)
    if facts[0] == 0:
        ends[0], ends[1], ends[2], ends[3] = 0, 0, 0, 0
    elif facts[2] or (rule == NONE and not overlap):
        free_order(row, facts, ends)
    else:
        ordered(row, kills, facts, overlap, best, ends)


# ---------------------------------------------------------------- the states of a world


@kernel
def number_of(work: WordTable, key: int, count: int) -> int:
    """The number of an S, which is noted: `count` if it is new."""
    slots = 4 * ROOM
    slot = (key * 0x9E3779B1 >> 7) % slots
    while work[SLOT, slot] >= 0:
        if work[KEY, work[SLOT, slot]] == key:
            return work[SLOT, slot]
        slot = (slot + 1) % slots
    work[SLOT, slot] = count
    work[KEY, count] = key
    work[PLACE, count] = slot
    work[REACHED, count] = 0
    return count


@kernel
def after(world: WordTable, explored: int, entries: int, e: int) -> tuple[int, int]:
    """S once e is explored, as a key, and the vertex where the robot then stands."""
    other = world[0, e]
    vertex, at = world[1, other], 0
    if entries >> 4 * vertex & 15 == UNKNOWN:
        at = vertex
        entries ^= (UNKNOWN ^ other) << (4 * vertex)
    return entries << MOST_DARTS | explored | 1 << e | 1 << other, at


@entry
def search_world(
    world: WordTable, size: int, rule: int, overlap: int, work: WordTable, cost: WordCube,
    low: WordCube, darts: Words, row: WordTable, kills: Words, best: WordTable, found: Words,
    facts: Words, ends: Words, tree: Words, depth: Words,
) -> None:  # fmt: skip
    """Search every state of a world with `size` darts.

    `found` gets: what is wrong, states, choices, least cost, highest cost, number of S. `low`
    gets for each S and e the range behind e, and where it leads; `cost` the range from S on.
    """
    full, known = (1 << size) - 1, (1 << MOST_DARTS) - 1
    start = ((1 << 4 * VERTICES) - UNKNOWN - 1) << MOST_DARTS
    for place in range(6):
        found[place] = 0
    count = number_of(work, start, 0) + 1
    work[REACHED, 0] = 1
    here = 0
    while here < count and found[0] == GOOD:
        explored, entries = work[KEY, here] & known, work[KEY, here] >> MOST_DARTS
        outward(world, explored, entries, 0, tree, depth)
        for e in range(size):
            if explored >> e & 1 or entries >> 4 * world[1, e] & 15 == UNKNOWN:
                continue
            behind(
                world, explored, entries, tree, e, rule, overlap,
                darts, row, kills, facts, best, ends,
            )  # fmt: skip
            found[0] = facts[3] if found[0] == GOOD else found[0]
            found[1] += ends[2]
            found[2] += ends[3]
            key, at = after(world, explored, entries, e)
            number = number_of(work, key, count)
            count = max(count, number + 1)
            work[REACHED, number] |= 1 << at
            low[here, e, 0], low[here, e, 1] = ends[0], ends[1]
            low[here, e, 2] = number * VERTICES + at
        here += 1
        if count + MOST_DARTS >= ROOM:
            found[0] = FULL
    if found[0] == GOOD:
        for here in range(count - 1, -1, -1):
            between(world, size, full, work, cost, low, found, here, tree, depth)
        found[3], found[4], found[5] = cost[0, 0, 0], cost[0, 0, 1], count
    for here in range(count):
        work[SLOT, work[PLACE, here]] = -1


@kernel
def between(
    world: WordTable, size: int, full: int, work: WordTable, cost: WordCube, low: WordCube,
    found: Words, here: int, tree: Words, depth: Words,
) -> None:  # fmt: skip
    """The range of what remains to be paid from an S, for each place of the robot."""
    explored, entries = work[KEY, here] & full, work[KEY, here] >> MOST_DARTS
    for at in range(VERTICES):
        if not work[REACHED, here] >> at & 1:
            continue
        outward(world, explored, entries, at, tree, depth)
        ways, cost[here, at, 0], cost[here, at, 1] = 0, NEVER, 0
        for e in range(size):
            if explored >> e & 1 or entries >> 4 * world[1, e] & 15 == UNKNOWN:
                continue
            ways += 1
            number, there = low[here, e, 2] // VERTICES, low[here, e, 2] % VERTICES
            paid = depth[world[1, e]] + 1
            least = paid + low[here, e, 0] + cost[number, there, 0]
            most = paid + low[here, e, 1] + cost[number, there, 1]
            cost[here, at, 0] = min(cost[here, at, 0], least)
            cost[here, at, 1] = max(cost[here, at, 1], most)
        if ways == 0:
            cost[here, at, 0] = 0
        if ways > 1:
            found[1] += 1
            found[2] += ways
