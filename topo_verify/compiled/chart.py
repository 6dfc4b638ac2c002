"""The map S that the mapper draws while it explores.

Mirrors: algorithms/chart.py, `Chart`. Differs: U is a mark at each dart with a count at each
vertex, so that vertices without a dart of U are passed over. The tree rooted at v0 is kept from one
e to the next (`TREE`), and made anew only after an edge that may change it:

- A new vertex hangs at vk. It comes into the queue somewhere, and leaves the others in their order.
- An edge between vertices at one distance is in no breadth-first tree.
- Any other edge may give a vertex another way to v0, and so another place in the queue.

Source: docs/semantics.md, section 3.
"""

from __future__ import annotations

from topo_verify.compiled.faults import COUNTS_DOORS_ANTICLOCKWISE, planted
from topo_verify.compiled.kernel import Words, inlined, kernel
from topo_verify.compiled.workspace import *


@kernel
def start_chart(W: Words, percept: int) -> None:
    """Start with v0 alone. The marked dart is dart 0, so the first percept has marker 0."""
    W[NV] = 0
    W[NDARTS] = 0
    W[NU] = 0
    add_vertex(W, percept)
    W[DEP] = 0
    W[PAR] = -1
    W[TREE] = 1


@kernel
def add_vertex(W: Words, percept: int) -> int:
    """Add a vertex, given its percept at its first dart. Returns that dart."""
    v = W[NV]
    first = W[NDARTS]
    degree = percept >> SHIFT
    if first + degree > CHART_DARTS:  # a vertex has a dart, so there is room for vertices, too
        W[STOP] = STOP_FULL + FULL_CHART
        return 0
    marker = percept & MASK  # 1 + marker
    W[CF + v] = first
    W[CD + v] = degree
    W[SG + v] = 2 * degree + (marker > 0)
    W[UO + v] = degree
    W[DEP + v] = -1
    for dart in range(first, first + degree):
        W[CA + dart] = -1
        W[CV + dart] = v
        W[UN + dart] = 1
        W[TREC + dart] = -1
        # Seen from one place further clockwise, the marker is one door nearer.
        W[CP + dart] = degree * P + marker
        if marker == 1:
            marker = degree
        elif marker > 1:
            marker -= 1
    W[NV] = v + 1
    W[NDARTS] = first + degree
    W[NU] += degree
    return first


@inlined
def leave_u(W: Words, dart: int) -> None:
    """Take a dart out of U, if it is there."""
    if W[UN + dart] != 0:
        W[UN + dart] = 0
        W[NU] -= 1
        W[UO + W[CV + dart]] -= 1


@inlined
def join(W: Words, e: int, other: int) -> None:
    """Put on record that the two darts are the two ends of one edge."""
    W[CA + e] = other
    W[CA + other] = e
    leave_u(W, e)
    leave_u(W, other)
    vk = W[CV + e]
    v = W[CV + other]
    if W[DEP + v] < 0:
        W[DEP + v] = W[DEP + vk] + 1
        W[PAR + v] = other
    elif W[DEP + v] != W[DEP + vk]:
        W[TREE] = 0


@inlined
def turn(W: Words, dart: int, door: int) -> int:
    """The dart behind a door, for a robot with this reference dart: sigma^door(dart)."""
    v = W[CV + dart]
    beyond = W[CF + v] + W[CD + v]
    turned = dart + door
    while turned >= beyond:  # once at most, but for the doors of another vertex
        turned -= W[CD + v]
    return turned


@inlined
def door(W: Words, dart: int, exit_dart: int) -> int:
    """The door through which a robot with reference dart `dart` leaves by `exit_dart`."""
    doors = exit_dart - dart
    if planted(W, COUNTS_DOORS_ANTICLOCKWISE):
        doors = dart - exit_dart
    if doors < 0:
        doors += W[CD + W[CV + dart]]
    return doors


@kernel
def tree(W: Words, root: int, until: int) -> None:
    """The breadth-first tree rooted at a vertex, until `until` is reached: SEEN, NEAR, TOWARDS."""
    search = W[SEARCH] + 1
    W[SEARCH] = search
    W[SEEN + root] = search
    W[TOWARDS + root] = -1
    W[REACHED] = root
    head = 0
    tail = 1
    while head < tail:
        v = W[REACHED + head]
        head += 1
        # All vertices on its way to the root were reached before it.
        if v == until:
            return
        for dart in range(W[CF + v], W[CF + v] + W[CD + v]):
            other = W[CA + dart]
            if other >= 0:
                u = W[CV + other]
                if W[SEEN + u] != search:
                    # `other` is the dart at the far end, so it is the one that leads back.
                    W[SEEN + u] = search
                    W[TOWARDS + u] = other
                    W[REACHED + tail] = u
                    tail += 1


@kernel
def tree_of_v0(W: Words) -> None:
    """The complete breadth-first tree rooted at v0, as S is now: DEP, PAR."""
    if W[TREE] != 0:
        return
    W[TREE] = 1
    for v in range(1, W[NV]):
        W[DEP + v] = -1
    W[Q] = 0
    head = 0
    tail = 1
    while head < tail:
        v = W[Q + head]
        head += 1
        depth = W[DEP + v] + 1
        for dart in range(W[CF + v], W[CF + v] + W[CD + v]):
            other = W[CA + dart]
            if other >= 0:
                u = W[CV + other]
                if W[DEP + u] < 0:
                    W[DEP + u] = depth
                    W[PAR + u] = other
                    W[Q + tail] = u
                    tail += 1


@kernel
def first_in_u(W: Words, v: int) -> int:
    """The lowest dart of U at a vertex that has one."""
    dart = W[CF + v]
    while W[UN + dart] == 0:
        dart += 1
    return dart


@kernel
def reach(W: Words, root: int) -> int:
    """The lowest dart of U among those of the vertices nearest to the root; `policies.nearest`."""
    search = W[SEARCH] + 1
    W[SEARCH] = search
    W[SEEN + root] = search
    W[NEAR + root] = 0
    W[REACHED] = root
    head = 0
    tail = 1
    best = -1
    distance = 0
    while head < tail:
        v = W[REACHED + head]
        head += 1
        if best >= 0 and W[NEAR + v] > distance:
            break  # the search goes outward: no vertex as near is still to come
        if W[UO + v] > 0:
            opened = first_in_u(W, v)
            if best < 0 or opened < best:
                best = opened
                distance = W[NEAR + v]
        elif best < 0:  # else its neighbours are farther than the best
            for dart in range(W[CF + v], W[CF + v] + W[CD + v]):
                other = W[CA + dart]
                if other >= 0:
                    u = W[CV + other]
                    if W[SEEN + u] != search:
                        W[SEEN + u] = search
                        W[NEAR + u] = W[NEAR + v] + 1
                        W[REACHED + tail] = u
                        tail += 1
    return best
