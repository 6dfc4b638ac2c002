"""The workspace: all that a run knows, as fields at fixed places of one array of 64-bit integers.

`run.chart.alpha[d]` is a constant offset in machine code. (A tuple of eighteen arrays took 1.5
times as long; narrower integers were not faster.) Layouts: `SMALL`, up to 12 edges, keeps what a
run touches in the fastest cache. `FAULTY` allows planted mistakes (`faults.py`). `LARGE`, up to
65,536 edges: pages that are never touched take no memory.

Nothing is cleared between runs: a kernel sets what it reads. A full buffer ends the run with a
reason in `stop`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

from topo_verify.extra.fast.kernels.names import Fields, Words, WordView


@dataclass(frozen=True)
class WordLayout:
    """Where the fields stand in workspaces of one kind.

    Attributes:
        constants: capacities and offsets by their names in machine code.
        places: the offset of every field, as in `chart.first`, and `SIZE`.
        sources: the modules of its kernels; (): this package's.
    """

    name: str
    constants: dict[str, int] = field(hash=False, compare=False)
    places: dict[str, int] = field(hash=False, compare=False, default_factory=dict[str, int])
    sources: tuple[str, ...] = ()

    def at(self, name: str) -> int:
        return self.places[name]


CAPACITIES = {
    "WORLD_DARTS": 24,
    "CHART_DARTS": 320,
    "STEPS": 2048,
    "RECORDS": 4096,
    "PLACE_DARTS": 16384,
    "CHANGED": 32768,
    "LAYER_WORDS": 65536,
    "TRACE": 65536,
}

WORLD_DARTS = CAPACITIES["WORLD_DARTS"]
CHART_DARTS = CAPACITIES["CHART_DARTS"]
STEPS = CAPACITIES["STEPS"]
RECORDS = CAPACITIES["RECORDS"]
PLACE_DARTS = CAPACITIES["PLACE_DARTS"]
CHANGED = CAPACITIES["CHANGED"]
LAYER_WORDS = CAPACITIES["LAYER_WORDS"]
TRACE = CAPACITIES["TRACE"]
FAULTS = 0

SHIFT = 16
P = 1 << SHIFT
MASK = P - 1
"""A percept is `degree * P`, plus 1 + marker if present."""

PerWorldDart = Annotated[Words, "WORLD_DARTS"]
PerDart = Annotated[Words, "CHART_DARTS"]
PerStep = Annotated[Words, "STEPS"]
PerRecord = Annotated[Words, "RECORDS"]
PerPlaceDart = Annotated[Words, "PLACE_DARTS"]
PerChange = Annotated[Words, "CHANGED"]
PerLayerWord = Annotated[Words, "LAYER_WORDS"]
PerTraceWord = Annotated[Words, "TRACE"]


class EndWords(WordView):
    stop: int  # STOP_…; 0: it did not


class TaskWords(EndWords):
    rule: int  # RULE_…
    motion: int  # 0: retrace, 1: overlap
    fault: int  # 0: none
    budget: int
    tracing: int
    room: int


class WorldWords(EndWords):
    alpha: PerWorldDart
    vertex: PerWorldDart
    first: PerWorldDart
    degree: PerWorldDart


class RobotWords(EndWords):
    dart: int
    cost: int


class ChartWords(EndWords):
    vertices: int
    darts: int
    unexplored: int
    has_tree: int  # are `depth` and `up` current?
    alpha: PerDart  # -1: unexplored
    vertex: PerDart
    percept: PerDart
    in_u: PerDart
    first: PerDart
    degree: PerDart
    signature: PerDart  # 2 * degree, and 1 if the marker is here
    open: PerDart
    depth: PerDart  # distance from v0
    up: PerDart  # dart towards v0; -1: v0
    queue: PerDart
    seen: PerDart  # searches from other roots: the last that met v
    near: PerDart
    towards: PerDart  # its dart towards the root; -1: the root
    reached: PerDart
    search: int


class ExcursionWords(EndWords):
    """The excursion from vu: motion.py."""

    turned: int  # doors from entry to reference dart
    shared: int  # doors that the chosen way shares with the last sequence
    size: int
    door: PerDart
    percept: PerDart  # vu's first


class RemainingWords(EndWords):
    """H, the hypotheses to try, in order."""

    dart: PerDart
    counts: PerDart
    sorted: PerDart


class EvidenceWords(EndWords):
    """Why a hypothesis is rejected: `cite` of evidence.py."""

    step: int
    expected: int  # -1: none
    observed: int  # -1: none
    at: int  # dart of S; -1: none
    record: int  # dart; -1: none
    first: int  # index of the record's first door
    wrong: int  # a contradiction; 0: none


class SequenceWords(EndWords):
    """The sequences executed for e: evidence.py."""

    number: int
    length: PerDart
    first: PerDart
    steps: int
    door: PerStep
    percept: PerStep


class RecordWords(EndWords):
    """T, the percepts on record: evidence.py."""

    number: int
    of_dart: PerDart  # -1: none
    percept: PerRecord
    door: PerRecord
    behind: PerRecord  # first record behind it; -1: none
    next: PerRecord  # next one behind the same place; -1: none


class PlaceWords(EndWords):
    """The fold of all places: folding.py."""

    darts: int  # with dart 0, a placeholder
    node: PerPlaceDart  # first dart of its node
    looks: PerPlaceDart  # 2 * degree, and 1 if the marker is here
    leader: PerPlaceDart  # 0: it leads
    behind: PerPlaceDart  # other end of a leader; 0: not seen
    weight: PerPlaceDart  # of a first dart: nodes merged
    known: PerPlaceDart  # of a first dart: is its node in S?
    waiting: PerPlaceDart  # pairs of darts to identify
    changed: int
    changes: PerChange  # where, and the old word
    laid: int  # nodes identified by these changes
    merges: int
    entry: PerDart
    e: int
    vu: int


class LayerWords(EndWords):
    """What each hypothesis adds to the fold: folding.py."""

    joined: int  # edges that the last sequence added
    joined_one: PerDart
    joined_other: PerDart
    anew: int  # fold each hypothesis anew?
    even: PerLayerWord  # layers: where, and the new word
    odd: PerLayerWord  # of every other stage
    stage: int
    size: int
    first: PerDart
    end: PerDart


class FaceWords(EndWords):
    """The faces of S: evidence.py."""

    face: PerDart  # the last e on whose face the dart was
    number: int


class NativeWords(EndWords):
    mapper: int  # addresses follow
    robot: int
    self: int
    beats: int  # worlds finished, and a heartbeat
    exit: int  # ends the process
    first: int  # first rank of the shard
    rank: int
    delivered: int
    reported: int  # reported cost; -1: none
    given: PerDart  # vertex of each delivered dart
    named: PerDart


class TraceWords(EndWords):
    """The trace; the last field, since it may be longer."""

    size: int
    word: PerTraceWord


class RunWords(EndWords):
    task: TaskWords
    world: WorldWords
    robot: RobotWords
    chart: ChartWords
    excursion: ExcursionWords
    remaining: RemainingWords
    evidence: EvidenceWords
    sequences: SequenceWords
    records: RecordWords
    places: PlaceWords
    layers: LayerWords
    faces: FaceWords
    native: NativeWords
    trace: TraceWords


RUN = Fields("W", RunWords, CAPACITIES)

RULE_NONE, RULE_PREFIX, RULE_HISTORY, RULE_ONE, RULE_ALL, RULE_FOLDING, RULE_PLANAR = range(7)
RULE_NATIVE = 7

STOP_BUDGET = 1
STOP_DOOR = 2
STOP_MAP = 3
STOP_EVENT = 4
STOP_SKIP = 5
STOP_FULL = 16  # STOP - STOP_FULL is FULL_…
FULL_CHART, FULL_STEPS, FULL_RECORDS, FULL_PLACES, FULL_TRACE = range(5)


def layout(
    name: str, capacities: dict[str, int], *, faults: bool = False, gap: int = 0
) -> WordLayout:
    """The layout for these capacities; a test looks for stray writes in each `gap`."""
    places = RUN.offsets(capacities, gap=gap)
    constants = {**capacities, "FAULTS": int(faults), **RUN.constants(places)}
    return WordLayout(name, constants, places)


SMALL = layout("small", CAPACITIES)
FAULTY = layout("faulty", {**CAPACITIES, "CHART_DARTS": 4096}, faults=True, gap=1)
LARGE = layout(
    "large",
    {
        "WORLD_DARTS": 1 << 17,
        "CHART_DARTS": 1 << 17,
        "STEPS": 1 << 21,
        "RECORDS": 1 << 21,
        "PLACE_DARTS": 1 << 22,
        "CHANGED": 1 << 23,
        "LAYER_WORDS": 1 << 26,
        "TRACE": 1,
    },
)


MOST_LISTED_EDGES = 12
"""The most edges in `SMALL`. (Ranks fit in 64 bits up to 16 edges.)"""

G_ROW = 2 * MOST_LISTED_EDGES + 2
"""The size of rows by step, dart or vertex."""

PerGrown = Annotated[Words, "G_ROW"]


class WalkWords(WordView):
    """The range, the state of the walk, the class, and the pruners."""

    darts: int  # 2m
    start: int
    stop: int
    completions: Annotated[Words, "COMPLETIONS"]  # F(u, r) at u · G_ROW + r
    rank: int  # class `any`: next rank
    skip: int  # class `any`: worlds to skip
    root: int
    root_after: int  # the rank after this root
    depth: int
    created: int
    opened: int
    vertices: int
    dart: PerGrown
    partner: PerGrown
    is_new: PerGrown
    after: PerGrown  # the rank after all completions
    pruned: int
    least_degree: int
    most_degree: int
    has_genus: int
    most_genus: int
    exact: int  # must it be `most_genus`?
    loopless: int
    simple: int
    handles: int  # genus that may be added
    odd_words: int
    words: int
    next: PerGrown  # along the boundary, of each open dart
    before: PerGrown
    word: PerGrown  # mask of the other darts of e's word
    word_places: PerGrown  # those 1, 3, 5, … places behind e
    word_odd: PerGrown
    was_handles: PerGrown
    was_odd_words: PerGrown
    was_words: PerGrown
    dart_next: PerGrown
    dart_before: PerGrown
    partner_next: PerGrown
    partner_before: PerGrown
    open_at: PerGrown
    near: PerGrown  # mask of neighbours (`simple` alone)


GROWTH = Fields("G", WalkWords, {"G_ROW": G_ROW, "COMPLETIONS": G_ROW * G_ROW})
