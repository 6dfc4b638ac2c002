"""The workspace: everything that a run knows, as fields at fixed places of one array of integers.

`run.chart.alpha[d]` is a field of dart `d`: a constant offset when kernels are compiled, so this
costs what a local array would. (A tuple of eighteen arrays took 1.5 times as long.) Integers have
64 bits: narrower ones were not faster, and no sum overflows.

There are layouts. `SMALL` is for worlds of up to 12 edges: what a run touches stays in the fastest
cache of the processor. `FAULTY` lets mistakes be planted (`faults.py`), by which S may grow without
end, and has room for a larger S. `LARGE` is for worlds of up to 65,536 edges; pages that are never
touched take no memory. Kernels that run as plain Python have the capacities of `SMALL`.

Nothing here is cleared between runs: a kernel sets what it reads. A buffer that is full ends the
run with a reason in `stop`; nothing is written beyond it.

Source: docs/semantics.md, sections 1 to 3; the fields of algorithms/chart.py and motion.py.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

from topo_verify.compiled.names import Fields, Words, WordView


@dataclass(frozen=True)
class WordLayout:
    """Where the fields stand in workspaces of one kind.

    Attributes:
        name: part of the name of the module of machine code.
        constants: the capacities, and the offsets of the fields by their names in that module.
        places: the offset of every field, as in `chart.first`; `SIZE`, the words in all.
        sources: the modules of its kernels; (): those of this package.
    """

    name: str
    constants: dict[str, int] = field(hash=False, compare=False)
    places: dict[str, int] = field(hash=False, compare=False, default_factory=dict[str, int])
    sources: tuple[str, ...] = ()

    def at(self, name: str) -> int:
        """The offset of a field."""
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
"""How many entries the fields of `SMALL` have."""

WORLD_DARTS = CAPACITIES["WORLD_DARTS"]
CHART_DARTS = CAPACITIES["CHART_DARTS"]
STEPS = CAPACITIES["STEPS"]
RECORDS = CAPACITIES["RECORDS"]
PLACE_DARTS = CAPACITIES["PLACE_DARTS"]
CHANGED = CAPACITIES["CHANGED"]
LAYER_WORDS = CAPACITIES["LAYER_WORDS"]
TRACE = CAPACITIES["TRACE"]
FAULTS = 0
"""Whether mistakes can be planted; 1 in `FAULTY`."""

SHIFT = 16
P = 1 << SHIFT
MASK = P - 1
"""A percept is `degree * P`, and 1 + marker if the marker is here: degrees are below P - 1."""

# ---------------------------------------------------------------- rows: a place for each

PerWorldDart = Annotated[Words, "WORLD_DARTS"]  # a dart (or vertex) of the world
PerDart = Annotated[Words, "CHART_DARTS"]  # a dart (or vertex) of S
PerStep = Annotated[Words, "STEPS"]  # a step of the sequences behind one e
PerRecord = Annotated[Words, "RECORDS"]  # a percept on record behind unexplored darts
PerPlaceDart = Annotated[Words, "PLACE_DARTS"]  # a dart of a node of the fold
PerChange = Annotated[Words, "CHANGED"]  # a change of the fold
PerLayerWord = Annotated[Words, "LAYER_WORDS"]  # a change in a layer that is kept
PerTraceWord = Annotated[Words, "TRACE"]  # a word of the trace


# ---------------------------------------------------------------- fields


class EndWords(WordView):
    """Why the run ended early."""

    stop: int  # STOP_… below; 0: it did not


class TaskWords(EndWords):
    """What the caller asks for."""

    rule: int  # the rule of the algorithm: RULE_… below
    motion: int  # 0: retrace, 1: overlap
    fault: int  # the mistake, in `FAULTY` only; 0: none
    budget: int  # how many moves are allowed
    tracing: int  # whether the run is to be written down
    room: int  # how many words of trace there is room for


class WorldWords(EndWords):
    """The world, which the caller places."""

    alpha: PerWorldDart  # of each dart of the world: its other end
    vertex: PerWorldDart  # of each dart of the world: its vertex
    first: PerWorldDart  # of each vertex of the world: its first dart
    degree: PerWorldDart  # of each vertex of the world: its degree


class RobotWords(EndWords):
    """The state of the robot: robot.py."""

    dart: int  # the reference dart, a dart of the world
    cost: int  # edge traversals so far


class ChartWords(EndWords):
    """The map S: chart.py."""

    vertices: int  # vertices of S
    darts: int  # darts of S
    unexplored: int  # darts in U
    has_tree: int  # whether `depth` and `up` are those of the current S
    alpha: PerDart  # alpha of each dart; -1: unexplored
    vertex: PerDart  # vertex of each dart
    percept: PerDart  # percept with each dart as the reference dart
    in_u: PerDart  # whether the dart is in U
    first: PerDart  # first dart of each vertex
    degree: PerDart  # degree of each vertex
    signature: PerDart  # signature of each vertex: 2 * degree, and 1 if the marker is here
    open: PerDart  # how many darts of each vertex are in U
    depth: PerDart  # distance of each vertex from v0
    up: PerDart  # dart of each vertex towards v0; -1: v0
    queue: PerDart  # the queue of that search
    seen: PerDart  # searches from other roots: number of the last that met v
    near: PerDart  # the same: distance
    towards: PerDart  # the same: dart towards the root; -1: the root
    reached: PerDart  # the same: the queue
    search: int  # the number of the last search


class ExcursionWords(EndWords):
    """The excursion from vu: motion.py."""

    turned: int  # doors from the dart of entry to the reference dart
    shared: int  # doors of its way that the chosen hypothesis shares with the last sequence
    size: int  # doors of the excursion
    door: PerDart  # those doors
    percept: PerDart  # percepts behind them, vu's own first


class RemainingWords(EndWords):
    """H, the hypotheses that remain, in the order in which to try them."""

    dart: PerDart  # H: the remaining hypotheses
    counts: PerDart  # for sorting H
    sorted: PerDart  # the same


class EvidenceWords(EndWords):
    """Why a hypothesis is rejected: `cite` of evidence.py."""

    step: int
    expected: int  # a percept; -1: none
    observed: int  # a percept; -1: none
    at: int  # dart of S; -1: none
    record: int  # dart of the record; -1: none
    first: int  # the record's first door, as an index of DOORS
    wrong: int  # a contradiction of folding or planar; 0: none


class SequenceWords(EndWords):
    """The sequences executed for e: evidence.py."""

    number: int  # sequences executed for e
    length: PerDart  # doors of each sequence
    first: PerDart  # where each begins among the steps
    steps: int  # steps of all sequences
    door: PerStep
    percept: PerStep


class RecordWords(EndWords):
    """T, the percepts on record: evidence.py."""

    number: int  # percepts on record
    of_dart: PerDart  # T of each dart: the record behind it; -1: none
    percept: PerRecord
    door: PerRecord  # the door that leads to it from the one before
    behind: PerRecord  # the first record behind it; -1: none
    next: PerRecord  # the next one behind the same place; -1: none


class PlaceWords(EndWords):
    """The fold, of all places seen: folding.py."""

    darts: int  # darts of all nodes, and 0, which is none
    node: PerPlaceDart  # the first dart of its node
    looks: PerPlaceDart  # of its node: 2 * degree, and 1 if the marker is here
    leader: PerPlaceDart  # a dart that it is; 0: it leads
    behind: PerPlaceDart  # the other end of a dart that leads; 0: not seen
    weight: PerPlaceDart  # of a first dart: how many nodes its node stands for
    known: PerPlaceDart  # of a first dart: whether its node is a vertex of S
    waiting: PerPlaceDart  # pairs of darts that are still to be made one
    changed: int  # changes of a test so far
    changes: PerChange  # where a word was changed, and what stood there
    laid: int  # nodes that were identified by these changes
    merges: int  # how many times seen places were identified
    entry: PerDart  # of each vertex of S: the dart that its first dart is
    e: int  # the dart that e is
    vu: int  # the dart by which the robot entered vu


class LayerWords(EndWords):
    """What each hypothesis adds to the fold: folding.py."""

    joined: int  # edges that the last sequence added to what was seen
    joined_one: PerDart  # one end of each
    joined_other: PerDart  # the other end
    anew: int  # whether each hypothesis is to be folded anew
    even: PerLayerWord  # layers: where a word differs, and that word
    odd: PerLayerWord  # the same, of every other stage
    stage: int  # stages so far in which layers were written
    size: int  # words of the layers of this stage
    first: PerDart  # where the layer of a hypothesis begins
    end: PerDart  # where it ends


class FaceWords(EndWords):
    """The faces of S: evidence.py."""

    face: PerDart  # the number of the last e on whose face the dart was
    number: int  # how many faces were walked: the number of this e


class NativeWords(EndWords):
    """A native mapper: native.py."""

    mapper: int  # the address of its function
    robot: int  # the address of the robot that it is given
    self: int  # the address of the workspace
    beats: int  # the address of the signs of life: worlds that are finished, and a count
    exit: int  # the address of a function that ends the process
    first: int  # the rank of the first world of the shard
    rank: int  # the rank of the world
    delivered: int  # whether it delivered a map
    reported: int  # the cost that it reported; -1: none
    given: PerDart  # of each dart delivered: the vertex
    named: PerDart  # of each dart delivered: the number that the chart gives it


class TraceWords(EndWords):
    """The words of the trace; last, for there may be more."""

    size: int  # words of trace
    word: PerTraceWord


class RunWords(EndWords):
    """The workspace: everything that a run knows."""

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
"""Where everything stands; `SMALL` has these capacities."""

RULE_NONE, RULE_PREFIX, RULE_HISTORY, RULE_ONE, RULE_ALL, RULE_FOLDING, RULE_PLANAR = range(7)
RULE_NATIVE = 7  # a native mapper

STOP_BUDGET = 1  # one more move than the budget
STOP_DOOR = 2  # no such door
STOP_MAP = 3  # what was delivered is no map
STOP_EVENT = 4  # what was declared is no decision
STOP_SKIP = 5  # the mapper declines the world
STOP_FULL = 16  # a buffer is full; STOP - STOP_FULL is one of FULL_… below
FULL_CHART, FULL_STEPS, FULL_RECORDS, FULL_PLACES, FULL_TRACE = range(5)


def layout(
    name: str, capacities: dict[str, int], *, faults: bool = False, gap: int = 0
) -> WordLayout:
    """The layout in which rows have these capacities.

    Args:
        faults: whether mistakes can be planted.
        gap: words between fields, in which a test sees what is written beyond one.
    """
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


# ---------------------------------------------------------------- the state of an enumeration

MOST_LISTED_EDGES = 12
"""The most edges for which `SMALL` has room. (Ranks fit in 64 bits up to 16 edges.)"""

G_ROW = 2 * MOST_LISTED_EDGES + 2
"""Room for one number a step, a dart or a vertex."""

PerGrown = Annotated[Words, "G_ROW"]


class WalkWords(WordView):
    """What is asked for, where the walk stands, the class, and the pruners."""

    darts: int  # of the worlds: 2m
    start: int  # the first rank
    stop: int  # the rank after the last one
    completions: Annotated[Words, "COMPLETIONS"]  # F(u, r) at u · G_ROW + r
    rank: int  # class `any`: the rank of the next world
    skip: int  # class `any`: how many worlds are still to be passed over
    root: int
    root_after: int  # the rank behind all worlds with this root
    depth: int
    created: int
    opened: int
    vertices: int
    dart: PerGrown
    partner: PerGrown
    is_new: PerGrown  # whether the partner is the first dart of a new vertex
    after: PerGrown  # the rank behind all completions of the step
    pruned: int  # whether the class is another one than `any`
    most_degree: int
    has_genus: int  # whether the genus is bounded
    most_genus: int
    exact: int  # whether the genus must be `most_genus`
    loopless: int  # also where the class is `simple`
    simple: int
    handles: int  # by how much the genus may still grow
    odd_words: int
    words: int
    next: PerGrown  # of each open dart, the next one along its boundary; and the one before it
    before: PerGrown
    word: PerGrown  # at each step: the darts of e's word but e, as a mask
    word_places: PerGrown  # at each step: those of them that are 1, 3, 5, … places behind e
    word_odd: PerGrown  # at each step: 1 if e's word, with e, has an odd length
    was_handles: PerGrown
    was_odd_words: PerGrown
    was_words: PerGrown
    dart_next: PerGrown
    dart_before: PerGrown
    partner_next: PerGrown
    partner_before: PerGrown
    open_at: PerGrown  # how many open darts each vertex has
    near: PerGrown  # the neighbours of each vertex, as a mask (`simple` alone)


GROWTH = Fields("G", WalkWords, {"G_ROW": G_ROW, "COMPLETIONS": G_ROW * G_ROW})
