"""The world and the words of a trace, as the judge reads them: every number is checked for range."""

from __future__ import annotations

from topo_verify.compiled.events import AUGMENT, CONFIRM, MOVE, POSE, REJECT, REJECT_WORDS
from topo_verify.compiled.judging.layout import J_FULL
from topo_verify.compiled.kernel import Words, inlined
from topo_verify.compiled.workspace import AL, DG, NTR, SHIFT, ST, TR, VT


@inlined
def shown(W: Words, dart: int) -> int:
    """What the world shows to a robot with this reference dart."""
    v = W[VT + dart]
    percept = W[DG + v] << SHIFT
    if v == 0:
        percept += 1
        if dart > 0:
            percept += W[DG] - dart
    return percept


@inlined
def exit_of(W: Words, dart: int, door: int) -> int:
    """The dart of the world that a door means to a robot with this reference dart."""
    v = W[VT + dart]
    end = W[ST + v] + W[DG + v]
    dart += door
    while dart >= end:
        dart -= W[DG + v]
    return dart


@inlined
def end_of_trace(W: Words) -> int:
    """Where the trace ends in the workspace."""
    return TR + W[NTR]


@inlined
def event_size(W: Words, J: Words, i: int, end: int) -> int:
    """How many words the event at i has; 0, and the verdict is open, if it is no event."""
    kind = W[i]
    size = 0
    if kind in (MOVE, CONFIRM):
        size = 4
    elif kind == AUGMENT:
        size = 5
    elif i + 3 <= end and kind == POSE and W[i + 2] >= 0:
        size = 3 + W[i + 2]
    elif i + REJECT_WORDS <= end and kind == REJECT:
        size = W[i + 3]
        if size != REJECT_WORDS + W[i + 12]:
            size = 0
    if size <= 0 or i + size > end:
        J[J_FULL] = 1
        return 0
    return size
