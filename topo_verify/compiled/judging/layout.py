"""The fields of the judge's array, and how the judge reads the world and the trace.

`full` is set wherever a field has no room for what comes, and where a word of the trace is out of
range; then the verdict is open. Sizes are for worlds of up to 12 edges, whose budget is 6,780
moves.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from topo_verify.compiled.events import *
from topo_verify.compiled.kernel import inlined
from topo_verify.compiled.names import Fields, Words, WordView
from topo_verify.compiled.workspace import *

if TYPE_CHECKING:
    from topo_verify.checkers import Status

CLAIM_COUNT = 10

OK, FAILED, PARTIAL, NOT_DECLARED, UNDECIDED = range(5)
"""The status of a claim, as a number; `STATUSES` has the names."""

STATUSES: tuple[Status, ...] = ("ok", "failed", "partial", "not-declared", "undecided")

JUDGE_DARTS = 64
"""Darts of S have lower numbers, or the verdict is open: sets of them are masks."""
JUDGE_STEPS = 8192
JUDGE_ARENA = 32768
JUDGE_SEQUENCES = 4096
JUDGE_NODES = 8192
JUDGE_DOORS = 65536
JUDGE_SLOTS = JUDGE_DOORS // 4

JUDGE_CAPACITIES = {name: size for name, size in globals().items() if name.startswith("JUDGE_")}
"""How many entries the rows of the judge have."""

PerClaim = Annotated[Words, "CLAIM_COUNT"]
PerKind = Annotated[Words, "KINDS_OF_EVENTS"]
PerCaseDart = Annotated[Words, "JUDGE_DARTS"]
PerCaseStep = Annotated[Words, "JUDGE_STEPS"]
PerSequence = Annotated[Words, "JUDGE_SEQUENCES"]
PerArenaWord = Annotated[Words, "JUDGE_ARENA"]
PerNode = Annotated[Words, "JUDGE_NODES"]
PerDoor = Annotated[Words, "JUDGE_DOORS"]
PerSlot = Annotated[Words, "JUDGE_SLOTS"]  # a place where the other end of a dart is kept

FATE_POSED, FATE_LOOP, FATE_NEW = 1, 2, 3


class OpenWords(WordView):
    """Whether the judge must ask the checkers."""

    full: int  # whether the verdict is open


class FoldWords(OpenWords):
    """The fold of the history: fold.py."""

    nodes: int
    doors: int
    at: int
    dart: int
    parent: PerNode
    offset: PerNode
    weight: PerNode
    degree: PerNode
    marked: PerNode
    base: PerNode
    number: PerNode
    end_node: PerDoor
    end_dart: PerDoor
    undos: int
    undo: PerDoor
    work: PerDoor
    # -1: a contradiction ends the folding. Otherwise a mask of the contradictions met so far
    met: int
    first: PerCaseDart
    owner: PerSlot  # of each place where the other end of a dart is kept: its node
    alpha: PerCaseDart
    vertex: PerCaseDart
    size: int


class ConsequenceWords(OpenWords):
    """What follows of an assumption: `all_that_follow` in fold.py."""

    met: int  # a mask of the contradictions
    waiting: int
    entries: int
    same: PerSlot  # of each place: one that is the same dart; itself, where it stands for all
    first: PerSlot  # the first entry of what is behind it, one of each look; -1: it is open
    end: PerDoor
    next: PerDoor


class DrawnWords(OpenWords):
    """S, drawn on the fold: entailed.py."""

    darts: int
    vertices: int
    node: PerCaseDart
    dart: PerCaseDart
    open: PerCaseDart
    after: PerCaseDart  # the next dart on the face; where a dart is open, the boundary turns back
    refuted: PerCaseDart  # of each dart: the last e that was shown not to end there; -1: none
    entry: PerCaseDart  # of each vertex: its first dart
    stands: int  # whether S is proved so far
    unproved: int  # whether a decision does not follow
    rejection: int  # the number of rejections so far
    met: PerCaseStep  # of each rejection: 1 if the contradiction that it cites follows


class CaseWords(OpenWords):
    """What is asked, the verdict, and the trace, replayed."""

    darts: int  # of the world: 2m
    vertices: int
    bound: int  # the upper bound of claim 7
    level: int  # 8: claims 1 to 8; 9: and claim 9; 10: all
    delivered: int  # whether a map was delivered: the chart in the workspace
    reported: int  # the cost that was reported; -1: none
    status: PerClaim
    judged: PerClaim
    of: PerClaim
    wrong: int  # a mask of the claims that fail: bit k for claim k + 1
    cost: int
    at: int  # the reference dart of the robot, a dart of the world
    legal: int  # whether every door so far exists
    true: int  # whether every percept so far is what the world shows
    spoiled: int  # whether S grew by what is false in this world
    size: int  # the number of darts of S
    crossed: int  # the edges of the world that were crossed, as a mask of their lesser darts
    grown: int  # those along which S grew
    phi: PerCaseDart
    number: PerCaseDart  # of each dart of the world: the dart of S; -1: none
    alpha: PerCaseDart  # of each dart of S: the other end of its edge; -1: unexplored
    image: PerCaseDart
    saw: PerKind  # whether the trace has such an event, anywhere
    followed: int  # percepts up to a door that is not there
    # rejections by rules `folding` and `planar` whose contradictions are still to be found
    cited: int
    saw_planar: int
    doors_hash: int  # a hash of all doors in their order
    rejections: int
    confirmations: int
    augmentations: int
    posed: int  # hypotheses posed
    pose_at: int  # the word at which the last pose begins; -1: S grew since, or there was none
    pose_edge: int
    # of each edge of the world, by its lesser dart: 0 not posed, 1 posed, or `FATE_…` below
    fate: PerCaseDart
    cited_by: PerCaseStep  # the numbers of those rejections, from 1
    left: PerCaseDart  # of each edge: a mask of the hypotheses neither rejected nor confirmed
    # whether the last pose was made elsewhere than behind its edge: the word stays empty
    is_late: int
    turned: int
    word_size: int
    word_door: PerCaseStep
    word_percept: PerCaseStep
    # the first sequence since the last pose; those before are on record or forgotten
    first_sequence: int
    sequences: int
    sequence_at: PerSequence
    sequence_size: PerSequence
    arena: int
    arena_door: PerArenaWord
    arena_percept: PerArenaWord
    records: int
    record_of: PerCaseDart  # of each dart of S: the last record behind it; -1: none
    # where a record's first percept is in the arena; and how many doors follow behind it
    record_at: PerSequence
    record_rest: PerSequence
    record_before: PerSequence
    fold: FoldWords
    consequences: ConsequenceWords
    drawn: DrawnWords


CASE = Fields(
    "J",
    CaseWords,
    {**JUDGE_CAPACITIES, "CLAIM_COUNT": CLAIM_COUNT, "KINDS_OF_EVENTS": 1 + AUGMENT},
)

JUDGE_SIZE = CASE.size


# ---------------------------------------------------------------- the world and the trace, read


@inlined
def shown(world: WorldWords, dart: int) -> int:
    """What the world shows to a robot with this reference dart."""
    v = world.vertex[dart]
    percept = world.degree[v] << SHIFT
    if v == 0:
        percept += 1
        if dart > 0:
            percept += world.degree[0] - dart
    return percept


@inlined
def exit_of(world: WorldWords, dart: int, door: int) -> int:
    """The dart of the world that a door means to a robot with this reference dart."""
    v = world.vertex[dart]
    end = world.first[v] + world.degree[v]
    dart += door
    while dart >= end:
        dart -= world.degree[v]
    return dart


@inlined
def end_of_trace(trace: TraceWords) -> int:
    """Where the trace ends in the workspace."""
    return trace.place_of("word") + trace.size


@inlined
def event_size(run: RunWords, case: CaseWords, i: int, end: int) -> int:
    """How many words the event at i has; 0, and the verdict is open, if it is no event."""
    kind = EventWords(run, i).kind
    size = 0
    if kind in (MOVE, CONFIRM):
        size = 4
    elif kind == AUGMENT:
        size = 5
    elif i + 3 <= end and kind == POSE and PoseWords(run, i).number >= 0:
        size = 3 + PoseWords(run, i).number
    elif i + REJECT_WORDS <= end and kind == REJECT:
        size = RejectionWords(run, i).size
        if size != REJECT_WORDS + RejectionWords(run, i).doors:
            size = 0
    if size <= 0 or i + size > end:
        case.full = 1
        return 0
    return size
