"""The states of one world by masks of darts, for rules that remember nothing: kernels.

The mapper does not run here: each way home is walked on the table of the world's darts.

    S          explored: a mask of darts; entries: four bits a vertex, its first dart; 15: unknown
    between    S and the robot's vertex. All positions over one S share what happens behind e.
    behind e   `behind.py`

`world` has five rows: alpha, vertex, percept of each dart; first dart, degree of each vertex, whose
darts are consecutive, clockwise.
"""

from __future__ import annotations

from topo_verify.compiled.kernel import WordCube, WordTable, entry, kernel
from topo_verify.compiled.names import Words
from topo_verify.compiled.workspace import WordLayout
from topo_verify.studies.search.states.behind import (
    FULL,
    GOOD,
    NEVER,
    UNKNOWN,
    VERTICES,
    behind,
    outward,
)

STATES = WordLayout("states", {}, sources=(behind.__module__, __name__))

MOST_DARTS = 14

KEY, REACHED, PLACE, SLOT = 0, 1, 2, 3

ROOM = 1 << 14


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

    `found` gets: what is wrong, states, choices, the least cost, the most, how many S. `low` gets
    of each S and e the range behind e, and where it leads; `cost` the range from S on.
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
    """The range of what is still to be paid from an S, for each place of the robot."""
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
