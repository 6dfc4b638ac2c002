"""Listing 1, the basic algorithm, from docs/semantics.md (sections 2 to 6), compiled by numba.

    topo-verify search examples/native_numba/mapper.py:explore --edges 6
    topo-verify conform examples/native_numba/mapper.py:explore --like basic
    topo-verify search examples/native_numba/mapper.py:wrong --edges 3

`wrong` forgets that the way back turns the robot.

S, the map so far, is a table of rows. For each vertex `BASE` has its first dart, and `DEGREE`; for
each dart `VERTEX` has its vertex, `ALPHA` its other end, `LOOK` what is seen with it as the
reference dart, and `OPEN` whether it is unexplored. `N`, `DARTS` and `COST` are counts.
"""

from __future__ import annotations

import numba
import numpy as np

from topo_verify import native as tv

BASE, DEGREE, VERTEX, ALPHA, LOOK, OPEN, QUEUE, ROWS = range(8)
N, DARTS, COST = range(3)
DISTANCE, UP = range(2)


@numba.njit
def turned_look(look, k):
    """What is seen k doors clockwise from where this is seen."""
    if look.marker < 0:
        return look
    return tv.NativePercept(look.degree, (look.marker - k) % look.degree)


@numba.njit
def add_vertex(table, count, look):
    """Add a vertex that looks like this from its first dart, which is returned."""
    first = count[DARTS]
    table[BASE, count[N]], table[DEGREE, count[N]] = first, look.degree
    for k in range(look.degree):
        table[VERTEX, first + k], table[ALPHA, first + k] = count[N], tv.NONE
        table[LOOK, first + k], table[OPEN, first + k] = tv.word(turned_look(look, k)), 1
    count[DARTS] += look.degree
    count[N] += 1
    return first


@numba.njit
def with_room(table, count, more):
    """The table, copied into a larger one if it lacks room for `more` darts."""
    if max(count[DARTS] + more, count[N] + 1) <= table.shape[1]:
        return table
    larger = np.zeros((ROWS, 2 * (table.shape[1] + more)), np.int64)
    for row in range(ROWS):
        for k in range(table.shape[1]):
            larger[row, k] = table[row, k]
    return larger


@numba.njit
def tree_to(table, count, root):
    """Breadth-first from a vertex, darts in ascending order: distances, and darts to the root."""
    tree = np.full((2, count[N]), tv.NONE)
    tree[DISTANCE, root], table[QUEUE, 0] = 0, root
    tail, at = 1, 0
    while at < tail:
        v = table[QUEUE, at]
        at += 1
        for dart in range(table[BASE, v], table[BASE, v] + table[DEGREE, v]):
            far = table[ALPHA, dart]
            if far < 0 or tree[DISTANCE, table[VERTEX, far]] >= 0:
                continue
            w = table[VERTEX, far]
            tree[DISTANCE, w], tree[UP, w] = tree[DISTANCE, v] + 1, far
            table[QUEUE, tail] = w
            tail += 1
    return tree


@numba.njit
def way_to_root(table, dart, tree):
    """The way from a reference dart to the root: doors, and the darts by which it arrives."""
    length = max(tree[DISTANCE, table[VERTEX, dart]], 0)
    doors, arrivals = np.empty(length, np.int64), np.empty(length + 1, np.int64)
    arrivals[0] = dart
    for k in range(length):
        out = tree[UP, table[VERTEX, dart]]
        doors[k] = (out - dart) % table[DEGREE, table[VERTEX, dart]]
        dart = table[ALPHA, out]
        arrivals[k + 1] = dart
    return doors, arrivals


@numba.njit
def go(robot, count, here, door, purpose):
    """Leave by a door, counted from the reference door; what is seen then."""
    if tv.refused(here):
        return here
    count[COST] += 1
    return tv.move(robot, door % here.degree, purpose)


@numba.njit
def is_before(table, tree, one, other):
    """Whether a dart is nearer to the root than another one, or as near and lower."""
    less = tree[DISTANCE, table[VERTEX, one]] - tree[DISTANCE, table[VERTEX, other]]
    return less < 0 or (less == 0 and one < other)


@numba.njit
def hypotheses_for(table, count, home, seen):
    """The unexplored darts by which the place may have been entered, nearest to v0 first."""
    found = np.empty(count[DARTS], np.int64)
    number = 0
    for h in range(count[DARTS]):
        look = tv.percept_of(table[LOOK, h])
        if table[OPEN, h] == 0 or look.degree != seen.degree:
            continue
        if (look.marker < 0) != (seen.marker < 0):
            continue
        k = number
        while k > 0 and is_before(table, home, h, found[k - 1]):
            found[k] = found[k - 1]
            k -= 1
        found[k] = h
        number += 1
    return found[:number]


@numba.njit
def validate(robot, table, count, e, seen, forgets):
    """Walk each hypothesis' way home: which is confirmed, what is seen then, and the turn."""
    home = tree_to(table, count, 0)
    hypotheses = hypotheses_for(table, count, home, seen)
    tv.pose(robot, e, hypotheses)
    here, turned = seen, 0
    for h in hypotheses:
        doors, arrivals = way_to_root(table, h, home)
        here, step = seen, 0
        while tv.word(here) == table[LOOK, arrivals[step]] and step < len(doors):
            here = go(robot, count, here, doors[step] - turned, tv.VALIDATE)
            step, turned = step + 1, 0
            if tv.refused(here):
                return tv.NONE, here, 0
        expected = tv.percept_of(table[LOOK, arrivals[step]])
        if here == expected:
            tv.confirm(robot, e, h, tv.MOTION)
            return h, here, turned
        tv.reject(robot, e, h, step, expected, here)
        for k in range(step - 1, -1, -1):
            here = go(robot, count, here, -turned, tv.RETRACE)
            if tv.refused(here):
                return tv.NONE, here, 0
            turned = 0 if forgets and k == 0 else doors[k]
    return tv.NONE, here, turned


@numba.njit
def pick(table, count, at):
    """The unexplored dart that is nearest to a dart; none: there is no such dart."""
    e = tv.NONE
    near = tree_to(table, count, table[VERTEX, at]) if count[DARTS] else np.zeros((2, 1), np.int64)
    for dart in range(count[DARTS]):
        if table[OPEN, dart] and (e < 0 or is_before(table, near, dart, e)):
            e = dart
    return e


@numba.njit
def explore_edge(robot, table, count, e, at, here, forgets):
    """Explore an edge: the table, the robot's reference dart on S afterwards, and what it sees."""
    table[OPEN, e] = 0
    doors, arrivals = way_to_root(table, at, tree_to(table, count, table[VERTEX, e]))
    for door in doors:
        here = go(robot, count, here, door, tv.WALK)
    seen = go(robot, count, here, e - arrivals[-1], tv.CROSS)
    if tv.refused(seen):
        return table, 0, seen

    entry, here, turned = validate(robot, table, count, e, seen, forgets)
    if tv.refused(here):
        return table, 0, here
    kind = tv.LOOP if entry >= 0 else tv.NEW
    if kind == tv.NEW:
        table = with_room(table, count, seen.degree)
        entry = add_vertex(table, count, seen)
    table[ALPHA, e], table[ALPHA, entry], table[OPEN, entry] = entry, e, 0
    tv.augment(robot, e, kind, entry, seen.degree)
    if kind == tv.NEW:
        return table, entry + turned % seen.degree, here
    return table, -here.marker % here.degree, here  # it has walked home, to the marker


@numba.njit
def map_world(robot, forgets):
    """Map the world, and deliver the map."""
    here, at = tv.look(robot), 0
    count = np.zeros(3, np.int64)
    table = with_room(np.zeros((ROWS, 16), np.int64), count, here.degree)
    add_vertex(table, count, here)
    e = pick(table, count, at)
    while e >= 0:
        table, at, here = explore_edge(robot, table, count, e, at, here, forgets)
        if tv.refused(here):
            return
        e = pick(table, count, at)
    marker = 0 if count[DARTS] else tv.NONE
    tv.deliver(robot, table[DEGREE, : count[N]], table[ALPHA, : count[DARTS]], marker, count[COST])


@numba.njit
def explore(robot):
    """The mapper."""
    map_world(robot, forgets=False)


@numba.njit
def wrong(robot):
    """The mapper that forgets that the last step of the way back turns the robot."""
    map_world(robot, forgets=True)
