"""Folding, the complete rule: it keeps a hypothesis exactly if some world that fits makes it true.

Mirrors: algorithms/folding.py, `FoldingRule`. Differs: all hypotheses that remain are asked after
each mismatch, so what was joined since, and whether places were identified, is noted once for all
layers (`NJOINED`, `ANEW`). What is asked then is a stage: the layers that are kept are written one
after another into one field, while those of the stage before stand in another.

Source: docs/semantics.md, section 11.
"""

from __future__ import annotations

from topo_verify.compiled.faults import FORGETS_THAT_VU_MAY_BE_NEW, planted
from topo_verify.compiled.kernel import Words, kernel
from topo_verify.compiled.partial_fold import (
    across,
    add_place,
    identify_seen,
    join_places,
    join_seen,
    keep_layer,
    lay_again,
    resolve,
    take_back,
    turn_at_place,
)
from topo_verify.compiled.prefix import cite
from topo_verify.compiled.workspace import (
    ANEW,
    CF,
    CP,
    CV,
    DOORS,
    ENTRIES,
    EV_WRONG,
    JOINED_ONE,
    JOINED_OTHER,
    KNOWN,
    LAID,
    MASK,
    MERGES,
    NCHANGES,
    NDOORS,
    NJOINED,
    NLAYER_WORDS,
    NODE,
    NPLACE_DARTS,
    NV,
    PLACE_E,
    PLACE_VU,
    PP,
    REM,
    STAGE,
    STOP,
)


@kernel
def start_fold(W: Words) -> None:
    """Start with v0 alone."""
    W[NPLACE_DARTS] = 1
    W[NCHANGES] = 0
    W[LAID] = 0
    W[MERGES] = 0
    W[STAGE] = 0
    W[ENTRIES] = add_place(W, W[CP], 1)


@kernel
def node_dart(W: Words, dart: int) -> int:
    """The dart of a node that a dart of S is."""
    v = W[CV + dart]
    return turn_at_place(W, W[ENTRIES + v], dart - W[CF + v])


@kernel
def arrive_fold(W: Words, e: int, percept: int) -> None:
    """Take note of vu, which is a place seen before, or a new ghost."""
    W[PLACE_E] = node_dart(W, e)
    W[PLACE_VU] = cross_fold(W, W[PLACE_E], percept)
    W[ANEW] = 1
    W[NLAYER_WORDS] = 0


@kernel
def cross_fold(W: Words, exit_place: int, percept: int) -> int:
    """The dart by which the robot comes in behind an exit; adds a ghost if it is new there."""
    beyond = across(W, exit_place)
    if beyond == 0:
        beyond = add_place(W, percept, 0)
        if W[STOP] != 0:
            return 0
        join_seen(W, exit_place, beyond)
        if percept & MASK > 0:
            identify_seen(W, turn_at_place(W, beyond, (percept & MASK) - 1), W[ENTRIES])
    return beyond


@kernel
def observe_fold(W: Words) -> None:
    """Keep every percept of the excursion, which ended in a mismatch."""
    merges = W[MERGES]
    joined = 0
    at = W[PLACE_VU]
    for step in range(1, W[NDOORS] + 1):
        exit_place = turn_at_place(W, at, W[DOORS + step - 1])
        darts = W[NPLACE_DARTS]
        at = cross_fold(W, exit_place, W[PP + step])
        if W[STOP] != 0:
            return
        if W[NPLACE_DARTS] != darts:
            W[JOINED_ONE + joined] = exit_place
            W[JOINED_OTHER + joined] = at
            joined += 1
    W[NJOINED] = joined
    W[ANEW] = W[MERGES] != merges
    if joined > 0:
        W[STAGE] += 1
        W[NLAYER_WORDS] = 0


@kernel
def refute_by_folding(W: Words, h: int) -> bool:
    """Whether no world allows the hypothesis; the contradiction is cited."""
    wrong = 0
    if W[ANEW] != 0:
        wrong = join_places(W, W[PLACE_E], node_dart(W, h))
    elif W[NJOINED] == 0:
        return False  # its layer stays as it is
    else:
        wrong = follow_layer(W, h)
    if wrong == 0:
        keep_layer(W, h)
    take_back(W)
    if wrong == 0:
        return False
    cite(W, 0, -1, -1, -1)
    W[EV_WRONG] = wrong
    return True


@kernel
def follow_layer(W: Words, h: int) -> int:
    """Fold what was joined since into the layer of a hypothesis. Returns the contradiction."""
    lay_again(W, h)
    for i in range(W[NJOINED]):
        if W[STOP] != 0:
            return 0
        wrong = join_places(W, W[JOINED_ONE + i], W[JOINED_OTHER + i])
        if wrong != 0:
            return wrong
    return 0


@kernel
def conclude(W: Words, remaining: int) -> int:
    """The last hypothesis, once vu is known to be a vertex of S; -1: none."""
    if remaining != 1:
        return -1
    known = W[KNOWN + W[NODE + resolve(W, W[PLACE_VU])]]
    if known == 0 and not planted(W, FORGETS_THAT_VU_MAY_BE_NEW):
        return -1
    return W[REM]


@kernel
def learn_fold(W: Words, entry: int, new: int) -> None:
    """Note which vertex of S vu is: a new one, or that of `entry`."""
    if new != 0:
        W[ENTRIES + W[NV] - 1] = W[PLACE_VU]
        W[KNOWN + W[NODE + resolve(W, W[PLACE_VU])]] = 1
    else:
        join_seen(W, W[PLACE_E], node_dart(W, entry))
