"""Nodes, their identifications so far, and what lies behind their doors.

Mirrors: algorithms/folding.py, `PartialFold`. Differs: a test of a hypothesis folds in the one fold
there is (`LAYER` is set), and each change is noted and taken back. The reference drops a layer, and
keeps it while it stands; what it cites is always of a layer made anew, and so the same. The doors
of a node are visited in the order in which they were filled, as those of the reference's
dictionaries: that decides which contradiction is met first.

Source: docs/semantics.md, section 11.
"""

from __future__ import annotations

from topo_verify.compiled.events import OWN_OTHER_END, TURNED_ITSELF, TWO_OF_S, UNLIKE
from topo_verify.compiled.faults import (
    IDENTIFIES_WITHOUT_TURNING,
    TAKES_EACH_PLACE_FOR_KNOWN,
    planted,
)
from topo_verify.compiled.kernel import Words, kernel
from topo_verify.compiled.workspace import (
    BASE,
    BEHIND_DOOR,
    BEHIND_NODE,
    FILLED,
    FULL_PLACES,
    KNOWN,
    LAYER,
    LEADER,
    MASK,
    NPLACE_DOORS,
    NPLACES,
    NUNDO,
    OFFSET,
    ORDER,
    PLACE_DOORS,
    PLACES,
    SHIFT,
    SIGNATURE,
    STOP,
    STOP_FULL,
    UNDO,
    UNDO_FILL,
    UNDO_KNOWN,
    UNDO_MERGE,
    WAITING,
    WEIGHT,
)


@kernel
def add_place(W: Words, percept: int, known: int) -> int:
    """Add a node with this percept at its door 0. Returns the node."""
    node = W[NPLACES]
    base = W[NPLACE_DOORS]
    degree = percept >> SHIFT
    if node >= PLACES or base + degree > PLACE_DOORS:
        W[STOP] = STOP_FULL + FULL_PLACES
        return 0
    W[LEADER + node] = node
    W[OFFSET + node] = 0
    W[WEIGHT + node] = 1
    W[SIGNATURE + node] = 2 * degree + ((percept & MASK) > 0)
    W[KNOWN + node] = 1 if planted(W, TAKES_EACH_PLACE_FOR_KNOWN) else known
    W[BASE + node] = base
    W[FILLED + node] = 0
    for i in range(base, base + degree):
        W[BEHIND_NODE + i] = -1
    W[NPLACES] = node + 1
    W[NPLACE_DOORS] = base + degree
    return node


@kernel
def resolve(W: Words, node: int, door: int) -> tuple[int, int]:
    """The pair that stands for all pairs that are the same dart."""
    degree = W[SIGNATURE + node] >> 1
    while door >= degree:
        door -= degree
    up = W[LEADER + node]
    while up != node:
        door += W[OFFSET + node]
        if door >= degree:
            door -= degree
        node = up
        up = W[LEADER + node]
    return node, door


@kernel
def across(W: Words, node: int, door: int) -> tuple[int, int]:
    """The other end of a dart's edge; (-1, 0) if nothing was seen behind it."""
    node, door = resolve(W, node, door)
    i = W[BASE + node] + door
    if W[BEHIND_NODE + i] < 0:
        return -1, 0
    return W[BEHIND_NODE + i], W[BEHIND_DOOR + i]


@kernel
def join_places(W: Words, one: int, k: int, other: int, n: int) -> int:
    """Join two darts to one edge, and fold. Returns the contradiction; 0: none."""
    one, k = resolve(W, one, k)
    other, n = resolve(W, other, n)
    if one == other and k == n:
        return OWN_OTHER_END
    had, had_door = across(W, one, k)
    has, has_door = across(W, other, n)
    if had < 0:
        put(W, one, k, other, n)
    if has < 0:
        put(W, other, n, one, k)
    wrong = 0
    if had >= 0:
        wrong = identify(W, had, had_door, other, n)
    if wrong == 0 and has >= 0:
        wrong = identify(W, has, has_door, one, k)
    return wrong


@kernel
def identify(W: Words, one: int, k: int, other: int, n: int) -> int:
    """Make two darts one, and fold. Returns the contradiction; 0: none."""
    W[WAITING] = one
    W[WAITING + 1] = k
    W[WAITING + 2] = other
    W[WAITING + 3] = n
    waiting = 4
    while waiting > 0:
        waiting -= 4
        i = WAITING + waiting
        small, k = resolve(W, W[i], W[i + 1])
        large, n = resolve(W, W[i + 2], W[i + 3])
        if small == large:
            if k != n:
                return TURNED_ITSELF
            continue
        if W[WEIGHT + small] > W[WEIGHT + large]:  # keeps every chain of leaders short
            small, large = large, small
            k, n = n, k
        if W[SIGNATURE + small] != W[SIGNATURE + large]:
            return UNLIKE
        if W[KNOWN + small] != 0 and W[KNOWN + large] != 0:
            return TWO_OF_S
        merge(W, small, large, n - k)
        waiting = move_doors(W, small, large, waiting)
        if waiting < 0:
            return OWN_OTHER_END
        if W[STOP] != 0:
            return UNLIKE
    return 0


@kernel
def merge(W: Words, small: int, large: int, turned: int) -> None:
    """Make `large` the leader of `small`, whose door k is door k + turned of `large`."""
    if turned < 0:
        turned += W[SIGNATURE + small] >> 1
    if planted(W, IDENTIFIES_WITHOUT_TURNING):
        turned = 0
    W[WEIGHT + large] += W[WEIGHT + small]
    W[LEADER + small] = large
    W[OFFSET + small] = turned
    note(W, small, UNDO_MERGE)
    if W[KNOWN + small] != 0 and W[KNOWN + large] == 0:
        W[KNOWN + large] = 1
        note(W, large, UNDO_KNOWN)


@kernel
def move_doors(W: Words, small: int, large: int, waiting: int) -> int:
    """Put the doors of a node to those of its leader. Returns the words that are waiting then.

    It returns -1 where a dart would be its own other end.
    """
    degree = W[SIGNATURE + small] >> 1
    turned = W[OFFSET + small]
    base = W[BASE + small]
    for number in range(W[FILLED + small]):
        door = W[ORDER + base + number]
        moved = door + turned
        if moved >= degree:
            moved -= degree
        node, k = resolve(W, W[BEHIND_NODE + base + door], W[BEHIND_DOOR + base + door])
        if node == large and k == moved:
            return -1
        i = W[BASE + large] + moved
        if W[BEHIND_NODE + i] < 0:
            put(W, large, moved, node, k)
        elif W[BEHIND_NODE + i] != node or W[BEHIND_DOOR + i] != k:
            if waiting + 4 > PLACE_DOORS:
                W[STOP] = STOP_FULL + FULL_PLACES
                return 0
            W[WAITING + waiting] = W[BEHIND_NODE + i]
            W[WAITING + waiting + 1] = W[BEHIND_DOOR + i]
            W[WAITING + waiting + 2] = node
            W[WAITING + waiting + 3] = k
            waiting += 4
    return waiting


@kernel
def put(W: Words, node: int, door: int, beyond_node: int, beyond_door: int) -> None:
    """Note one end of an edge behind the other, which is a dart of a leader with nothing behind."""
    base = W[BASE + node]
    W[BEHIND_NODE + base + door] = beyond_node
    W[BEHIND_DOOR + base + door] = beyond_door
    W[ORDER + base + W[FILLED + node]] = door
    W[FILLED + node] += 1
    note(W, node, UNDO_FILL)


# ---------------------------------------------------------------- a layer


@kernel
def note(W: Words, node: int, change: int) -> None:
    """Note a change if it is to be taken back."""
    if W[LAYER] != 0:
        n = W[NUNDO]
        if n >= PLACE_DOORS:
            W[STOP] = STOP_FULL + FULL_PLACES
            return
        W[UNDO + n] = 4 * node + change
        W[NUNDO] = n + 1


@kernel
def take_back(W: Words) -> None:
    """Take back every change of the layer, the last one first."""
    while W[NUNDO] > 0:
        W[NUNDO] -= 1
        change = W[UNDO + W[NUNDO]] & 3
        node = W[UNDO + W[NUNDO]] >> 2
        if change == UNDO_FILL:
            W[FILLED + node] -= 1
            base = W[BASE + node]
            W[BEHIND_NODE + base + W[ORDER + base + W[FILLED + node]]] = -1
        elif change == UNDO_KNOWN:
            W[KNOWN + node] = 0
        else:
            W[WEIGHT + W[LEADER + node]] -= W[WEIGHT + node]
            W[LEADER + node] = node
            W[OFFSET + node] = 0
