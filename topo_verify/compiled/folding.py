"""Folding, the complete rule: it keeps a hypothesis exactly if some world that fits makes it true.

Mirrors: algorithms/folding.py, `FoldingRule`. Differs: every test is made anew and taken back
(partial_fold.py).

Source: docs/semantics.md, section 11.
"""

from __future__ import annotations

from topo_verify.compiled.faults import FORGETS_THAT_VU_MAY_BE_NEW, planted
from topo_verify.compiled.kernel import Words, kernel
from topo_verify.compiled.partial_fold import (
    across,
    add_place,
    identify,
    join_places,
    resolve,
    take_back,
)
from topo_verify.compiled.prefix import cite
from topo_verify.compiled.workspace import (
    CF,
    CP,
    CV,
    DOORS,
    E_DOOR,
    E_NODE,
    EV_WRONG,
    KNOWN,
    LAYER,
    MASK,
    NDOORS,
    NPLACE_DOORS,
    NPLACES,
    NUNDO,
    NV,
    PP,
    REM,
    STOP,
    VD,
    VN,
    VU_DOOR,
    VU_NODE,
)


@kernel
def start_fold(W: Words) -> None:
    """Start with v0 alone."""
    W[NPLACES] = 0
    W[NPLACE_DOORS] = 0
    W[LAYER] = 0
    W[NUNDO] = 0
    W[VN] = add_place(W, W[CP], 1)
    W[VD] = 0


@kernel
def node_dart(W: Words, dart: int) -> tuple[int, int]:
    """The node and door of a dart of S."""
    v = W[CV + dart]
    return W[VN + v], W[VD + v] + dart - W[CF + v]


@kernel
def arrive_fold(W: Words, e: int, percept: int) -> None:
    """Take note of vu, which is a place seen before, or a new ghost."""
    node, door = node_dart(W, e)
    W[E_NODE] = node
    W[E_DOOR] = door
    node, door = cross_fold(W, node, door, percept)
    W[VU_NODE] = node
    W[VU_DOOR] = door


@kernel
def cross_fold(W: Words, node: int, door: int, percept: int) -> tuple[int, int]:
    """The dart by which the robot comes in behind an exit; adds a ghost if it is new there."""
    beyond, entered = across(W, node, door)
    if beyond < 0:
        beyond = add_place(W, percept, 0)
        if W[STOP] != 0:
            return 0, 0
        join_places(W, node, door, beyond, 0)
        if percept & MASK > 0:
            identify(W, beyond, (percept & MASK) - 1, 0, 0)
    return beyond, entered


@kernel
def observe_fold(W: Words) -> None:
    """Keep every percept of the excursion, which ended in a mismatch."""
    node = W[VU_NODE]
    door = W[VU_DOOR]
    for step in range(1, W[NDOORS] + 1):
        node, door = cross_fold(W, node, door + W[DOORS + step - 1], W[PP + step])
        if W[STOP] != 0:
            return


@kernel
def refute_by_folding(W: Words, h: int) -> bool:
    """Whether no world allows the hypothesis; the contradiction is cited."""
    node, door = node_dart(W, h)
    W[LAYER] = 1
    wrong = join_places(W, W[E_NODE], W[E_DOOR], node, door)
    take_back(W)
    W[LAYER] = 0
    if wrong == 0:
        return False
    cite(W, 0, -1, -1, -1)
    W[EV_WRONG] = wrong
    return True


@kernel
def conclude(W: Words, remaining: int) -> int:
    """The last hypothesis, once vu is known to be a vertex of S; -1: none."""
    if remaining != 1:
        return -1
    node, _door = resolve(W, W[VU_NODE], W[VU_DOOR])
    if W[KNOWN + node] == 0 and not planted(W, FORGETS_THAT_VU_MAY_BE_NEW):
        return -1
    return W[REM]


@kernel
def learn_fold(W: Words, entry: int, new: int) -> None:
    """Note which vertex of S vu is: a new one, or that of `entry`."""
    if new != 0:
        v = W[NV] - 1
        W[VN + v] = W[VU_NODE]
        W[VD + v] = W[VU_DOOR]
        node, _door = resolve(W, W[VU_NODE], W[VU_DOOR])
        W[KNOWN + node] = 1
    else:
        node, door = node_dart(W, entry)
        join_places(W, W[E_NODE], W[E_DOOR], node, door)
