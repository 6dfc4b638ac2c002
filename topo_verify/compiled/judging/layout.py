"""The judge's array J, fields at constant places, and how the judge reads the world and the trace.

`J_FULL` is set wherever a field has no room for what comes, and where a word of the trace is out of
range; then the verdict is open. Sizes are for worlds of up to 12 edges, whose budget is 6,780
moves.
"""

from __future__ import annotations

from topo_verify.compiled.events import AUGMENT, CONFIRM, MOVE, POSE, REJECT, REJECT_WORDS
from topo_verify.compiled.kernel import Words, inlined
from topo_verify.compiled.workspace import *

_used = 0


def _field(size: int = 1) -> int:
    """The place of the next field, which takes so many numbers."""
    global _used  # noqa: PLW0603  the layout is made once, when the module is loaded
    place = _used
    _used += size
    return place


CLAIM_COUNT = 10

OK, FAILED, PARTIAL, NOT_DECLARED, UNDECIDED = range(5)
"""The status of a claim, as a number; `STATUSES` has the names."""

STATUSES = ("ok", "failed", "partial", "not-declared", "undecided")

JUDGE_DARTS = 64
"""Darts of S have lower numbers, or the verdict is open: sets of them are masks."""
JUDGE_STEPS = 8192
JUDGE_ARENA = 32768
JUDGE_SEQUENCES = 4096
JUDGE_NODES = 8192
JUDGE_DOORS = 65536

# ---------------------------------------------------------------- what is asked

J_DARTS = _field()
"""Of the world: 2m."""
J_VERTICES = _field()
J_BOUND = _field()
"""The upper bound of claim 7."""
J_LEVEL = _field()
"""8: claims 1 to 8; 9: and claim 9; 10: all."""
J_DELIVERED = _field()
"""Whether a map was delivered: the chart in the workspace."""
J_REPORTED = _field()
"""The cost that was reported; -1: none."""

# ---------------------------------------------------------------- the verdict

J_STATUS = _field(CLAIM_COUNT)
J_JUDGED = _field(CLAIM_COUNT)
J_OF = _field(CLAIM_COUNT)
J_WRONG = _field()
"""A mask of the claims that fail: bit k for claim k + 1."""
J_FULL = _field()
"""Whether the verdict is open."""

# ---------------------------------------------------------------- the trace, replayed

J_COST = _field()
J_AT = _field()
"""The reference dart of the robot, a dart of the world."""
J_LEGAL = _field()
"""Whether every door so far exists."""
J_TRUE = _field()
"""Whether every percept so far is what the world shows."""
J_SPOILED = _field()
"""Whether S grew by what is false in this world."""
J_SIZE = _field()
"""The number of darts of S."""
J_CROSSED = _field()
"""The edges of the world that were crossed, as a mask of their lesser darts."""
J_GROWN = _field()
"""Those along which S grew."""
J_PHI = _field(JUDGE_DARTS)
J_NUMBER = _field(JUDGE_DARTS)
"""Of each dart of the world: the dart of S; -1: none."""
J_ALPHA = _field(JUDGE_DARTS)
"""Of each dart of S: the other end of its edge; -1: unexplored."""
J_IMAGE = _field(JUDGE_DARTS)

J_SAW_POSE = _field()
J_SAW_REJECT = _field()
J_SAW_CONFIRM = _field()
J_SAW_AUGMENT = _field()
"""Whether the trace has such an event, anywhere."""
J_FOLLOWED = _field()
"""Percepts up to a door that is not there."""
J_CITED = _field()
"""Rejections by rules `folding` and `planar` whose contradictions are still to be found."""
J_SAW_PLANAR = _field()
J_DOORS_HASH = _field()
"""A hash of all doors in their order."""
J_REJECTIONS = _field()
J_CONFIRMATIONS = _field()
J_AUGMENTATIONS = _field()
J_POSED = _field()
"""Hypotheses posed."""

J_POSE_AT = _field()
"""The word at which the last pose begins; -1: S grew since, or there was none."""
J_POSE_EDGE = _field()
J_FATE = _field(JUDGE_DARTS)
"""Of each edge of the world, by its lesser dart: 0 not posed, 1 posed, or `FATE_…` below."""
J_CITED_BY = _field(JUDGE_STEPS)
"""The numbers of those rejections, from 1."""
J_LEFT = _field(JUDGE_DARTS)
"""Of each edge: a mask of the hypotheses neither rejected nor confirmed."""

FATE_POSED, FATE_LOOP, FATE_NEW = 1, 2, 3

# ---------------------------------------------------------------- excursions and records

J_IS_LATE = _field()
"""Whether the last pose was made elsewhere than behind its edge: the word stays empty."""
J_TURNED = _field()
J_WORD_SIZE = _field()
J_WORD_DOOR = _field(JUDGE_STEPS)
J_WORD_PERCEPT = _field(JUDGE_STEPS)
J_FIRST_SEQUENCE = _field()
"""The first sequence since the last pose; those before are on record or forgotten."""
J_SEQUENCES = _field()
J_SEQUENCE_AT = _field(JUDGE_SEQUENCES)
J_SEQUENCE_SIZE = _field(JUDGE_SEQUENCES)
J_ARENA = _field()
J_ARENA_DOOR = _field(JUDGE_ARENA)
J_ARENA_PERCEPT = _field(JUDGE_ARENA)
J_RECORDS = _field()
J_RECORD_OF = _field(JUDGE_DARTS)
"""Of each dart of S: the last record behind it; -1: none."""
J_RECORD_AT = _field(JUDGE_SEQUENCES)
"""Where a record's first percept is in the arena; and how many doors follow behind it."""
J_RECORD_REST = _field(JUDGE_SEQUENCES)
J_RECORD_BEFORE = _field(JUDGE_SEQUENCES)

# ---------------------------------------------------------------- the fold

F_NODES = _field()
F_DOORS = _field()
F_AT = _field()
F_DART = _field()
F_PARENT = _field(JUDGE_NODES)
F_OFFSET = _field(JUDGE_NODES)
F_WEIGHT = _field(JUDGE_NODES)
F_DEGREE = _field(JUDGE_NODES)
F_MARKED = _field(JUDGE_NODES)
F_BASE = _field(JUDGE_NODES)
F_NUMBER = _field(JUDGE_NODES)
F_END_NODE = _field(JUDGE_DOORS)
F_END_DART = _field(JUDGE_DOORS)
F_UNDOS = _field()
F_UNDO = _field(JUDGE_DOORS)
F_WORK = _field(JUDGE_DOORS)
F_MET = _field()
"""-1: a contradiction ends the folding. Otherwise a mask of the contradictions met so far."""
F_FIRST = _field(JUDGE_DARTS)
F_OWNER = _field(JUDGE_DOORS // 4)
"""Of each place where the other end of a dart is kept: its node."""
F_ALPHA = _field(JUDGE_DARTS)
F_VERTEX = _field(JUDGE_DARTS)
F_SIZE = _field(JUDGE_DARTS)

# ---------------------------------------------------------------- what follows of an assumption

C_MET = _field()
"""A mask of the contradictions."""
C_WAITING = _field()
C_ENTRIES = _field()
C_SAME = _field(JUDGE_DOORS // 4)
"""Of each place: one that is the same dart; itself, where it stands for all."""
C_FIRST = _field(JUDGE_DOORS // 4)
"""The first entry of what is behind it, one of each look; -1: it is open."""
C_END = _field(JUDGE_DOORS)
C_NEXT = _field(JUDGE_DOORS)

# ---------------------------------------------------------------- S on the fold

S_DARTS = _field()
S_VERTICES = _field()
S_NODE = _field(JUDGE_DARTS)
S_DART = _field(JUDGE_DARTS)
S_OPEN = _field(JUDGE_DARTS)
S_AFTER = _field(JUDGE_DARTS)
"""The next dart on the face; where a dart is open, the boundary turns back."""
S_REFUTED = _field(JUDGE_DARTS)
"""Of each dart: the last e that was shown not to end there; -1: none."""
S_ENTRY = _field(JUDGE_DARTS)
"""Of each vertex: its first dart."""
S_STANDS = _field()
"""Whether S is proved so far."""
S_UNPROVED = _field()
"""Whether a decision does not follow."""
S_REJECTION = _field()
"""The number of rejections so far."""
S_MET = _field(JUDGE_STEPS)
"""Of each rejection: 1 if the contradiction that it cites follows."""

JUDGE_SIZE = _used


# ---------------------------------------------------------------- the world and the trace, read


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
