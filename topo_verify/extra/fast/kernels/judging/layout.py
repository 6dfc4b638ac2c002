"""The fields of the judge's array, and how it reads the world and the trace.

`full` is set where a field has no room or a word of the trace is out of range; the verdict is then
open. Sizes are for worlds of up to 12 edges, whose budget is 6,780 moves.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from topo_verify.extra.fast.kernels.events import *
from topo_verify.extra.fast.kernels.kernel import inlined
from topo_verify.extra.fast.kernels.names import Fields, Words, WordView
from topo_verify.extra.fast.kernels.workspace import *

CLAIM_COUNT = 10

OK, FAILED, PARTIAL, NOT_DECLARED, UNDECIDED = range(5)
"""The status of a claim, as a number."""

JUDGE_DARTS = 64
"""S has fewer darts, else the verdict is open."""
JUDGE_STEPS = 8192
JUDGE_ARENA = 32768
JUDGE_SEQUENCES = 4096
JUDGE_NODES = 8192
JUDGE_DOORS = 65536
JUDGE_SLOTS = JUDGE_DOORS // 4
JUDGE_SET = JUDGE_DARTS // 64
"""Words of a set of darts."""
JUDGE_SETS = JUDGE_DARTS * JUDGE_SET

JUDGE_CAPACITIES = {name: size for name, size in globals().items() if name.startswith("JUDGE_")}

PerClaim = Annotated[Words, "CLAIM_COUNT"]
PerKind = Annotated[Words, "KINDS_OF_EVENTS"]
PerCaseDart = Annotated[Words, "JUDGE_DARTS"]
PerCaseStep = Annotated[Words, "JUDGE_STEPS"]
PerSequence = Annotated[Words, "JUDGE_SEQUENCES"]
PerArenaWord = Annotated[Words, "JUDGE_ARENA"]
PerNode = Annotated[Words, "JUDGE_NODES"]
PerDoor = Annotated[Words, "JUDGE_DOORS"]
PerSlot = Annotated[Words, "JUDGE_SLOTS"]
PerSet = Annotated[Words, "JUDGE_SETS"]

FATE_POSED, FATE_LOOP, FATE_NEW = 1, 2, 3


class OpenWords(WordView):
    full: int


class FoldWords(OpenWords):
    nodes: int
    doors: int
    tidied: int  # doors left after merged nodes were dropped
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
    owner: PerSlot
    alpha: PerCaseDart
    vertex: PerCaseDart
    seen: PerCaseDart  # is its face counted?
    size: int


class ConsequenceWords(OpenWords):
    met: int  # mask
    waiting: int
    entries: int
    same: PerSlot
    first: PerSlot  # first entry behind it, one of each look; -1: open
    end: PerDoor
    next: PerDoor


class DrawnWords(OpenWords):
    darts: int
    vertices: int
    node: PerCaseDart
    dart: PerCaseDart
    open: PerCaseDart
    after: PerCaseDart  # next dart on the face; an open dart turns back
    refuted: PerCaseDart  # the last e shown not to end there; -1: none
    entry: PerCaseDart  # first dart of each vertex
    asked: int  # is S drawn at all?
    stands: int  # is S proved so far?
    unproved: int  # does some decision not follow?
    rejection: int
    met: PerCaseStep  # 1 if the cited contradiction follows


class CaseWords(OpenWords):
    """The question, the verdict, and the replayed trace."""

    darts: int  # 2m
    vertices: int
    bound: int
    level: int  # claims 1 to 8, 9 or 10
    delivered: int
    reported: int  # -1: none
    status: PerClaim
    judged: PerClaim
    of: PerClaim
    wrong: int  # bit k: claim k + 1 fails
    cost: int
    at: int
    legal: int  # does every door so far exist?
    true: int  # is every percept so far the world's?
    spoiled: int  # did S grow by what is false?
    size: int  # darts of S
    phi: PerCaseDart
    crossed: PerCaseDart  # was this edge crossed? by its lesser dart
    grown: PerCaseDart  # did S grow along it?
    number: PerCaseDart  # dart of S; -1: none
    alpha: PerCaseDart  # of S; -1: unexplored
    image: PerCaseDart
    saw: PerKind  # does the trace have such an event?
    followed: int  # percepts up to a door that does not exist
    # rejections by rules `folding` and `planar` whose contradictions are still to be found
    cited: int
    saw_planar: int
    doors_hash: int
    rejections: int
    confirmations: int
    augmentations: int
    posed: int
    pose_edge: int  # of the last pose; -1: S grew since, or none
    # of each edge of the world, by its lesser dart: 0 not posed, 1 posed, or `FATE_…` below
    fate: PerCaseDart
    cited_by: PerCaseStep  # their numbers, from 1
    left: PerSet  # of each edge that was posed: the set of undecided hypotheses
    poses: int  # number of poses in all runs
    posed_by: PerCaseDart  # the last pose with this hypothesis
    # whether the last pose was made elsewhere than behind its edge: the word stays empty
    is_late: int
    turned: int
    word_size: int
    word_step: PerCaseStep  # a percept, and the door before it: percept << SHIFT | door
    sequences: int  # since the last pose; those before are on record or forgotten
    sequence_at: PerSequence
    sequence_size: PerSequence
    arena: int
    recorded: int  # words of the arena that are on record
    arena_step: PerArenaWord  # steps of the sequences
    records: int
    record_of: PerCaseDart  # the last record behind it; -1: none
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

_LONG_CAPACITIES = {
    "JUDGE_DARTS": 1 << 15,
    "JUDGE_STEPS": 1 << 22,
    "JUDGE_ARENA": 1 << 24,
    "JUDGE_SEQUENCES": 1 << 22,
    "JUDGE_NODES": 1 << 21,
    "JUDGE_DOORS": 1 << 23,
    "JUDGE_SLOTS": 1 << 21,
    "JUDGE_SET": 1 << 9,
    "JUDGE_SETS": 1 << 24,
}

_LONG_OFFSETS = CASE.offsets({**CASE.capacities, **_LONG_CAPACITIES})

_LONG_RUN = layout(
    "long",
    {
        **dict.fromkeys(CAPACITIES, 1),
        "WORLD_DARTS": _LONG_CAPACITIES["JUDGE_DARTS"],
        "CHART_DARTS": _LONG_CAPACITIES["JUDGE_DARTS"],
    },
)

LONG = replace(
    _LONG_RUN,
    constants={
        **_LONG_RUN.constants,
        **_LONG_CAPACITIES,
        **CASE.constants(_LONG_OFFSETS),
    },
    sources=tuple(
        f"topo_verify.extra.fast.kernels.{name}"
        for name in (
            "workspace", "pruning", "events", "judging.layout", "judging.justified",
            "judging.truth", "judging.fold", "judging.entailed", "judging.verdict",
        )
    ),
)  # fmt: skip
"""The layout in which a trace is judged part by part, in worlds of up to 16,384 edges.

The fields of a case up to `size` stand where they stand in `CASE`.
"""

LONG_SIZE = _LONG_OFFSETS["SIZE"]


@inlined
def shown(world: WorldWords, dart: int) -> int:
    v = world.vertex[dart]
    percept = world.degree[v] << SHIFT
    if v == 0:
        percept += 1
        if dart > 0:
            percept += world.degree[0] - dart
    return percept


@inlined
def exit_of(world: WorldWords, dart: int, door: int) -> int:
    v = world.vertex[dart]
    end = world.first[v] + world.degree[v]
    dart += door
    while dart >= end:
        dart -= world.degree[v]
    return dart


@inlined
def end_of_trace(trace: TraceWords) -> int:
    return trace.place_of("word") + trace.size


@inlined
def event_size(run: RunWords, case: CaseWords, i: int, end: int) -> int:
    """The length of the event at i in words; 0 (verdict open) if there is no event."""
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
