"""The workspace: everything that a run knows, as fields at fixed places of one array of integers.

`W[CA + d]` is the field `CA` of dart `d`: the offsets are constants when kernels are compiled, so
this costs what a local array would. (A tuple of eighteen arrays took 1.5 times as long.) Integers
have 64 bits: narrower ones were not faster, and no sum overflows.

There are layouts. `SMALL` is for worlds of up to 12 edges: what a run touches stays in the fastest
cache of the processor. `FAULTY` lets mistakes be planted (`faults.py`), by which S may grow without
end, and has room for a larger S. `LARGE` is for worlds of up to 65,536 edges; pages that are never
touched take no memory. The constants below are those of `SMALL`; `compiled` puts those of another
layout in their place.

Nothing here is cleared between runs: a kernel sets what it reads. A buffer that is full ends the
run with a reason in `STOP`; nothing is written beyond it.

    suffix      a place for every                         capacity
    WORLD       dart (and vertex) of the world            WORLD_DARTS
    CHART       dart (and vertex) of S                    CHART_DARTS
    STEPS       step of the sequences behind one e        STEPS
    RECORDS     percept on record behind unexplored darts RECORDS
    PLACES      dart of a node of the fold                PLACE_DARTS
    LAYERS      change in a layer that is kept            LAYER_WORDS

Source: docs/semantics.md, sections 1 to 3; the fields of algorithms/chart.py and motion.py.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple


class Field(NamedTuple):
    """A field: its name, and the name of the capacity that it has; "" for a single word."""

    name: str
    capacity: str


@dataclass(frozen=True)
class WordLayout:
    """Where the fields stand in workspaces of one kind.

    Attributes:
        name: part of the name of the module of machine code.
        constants: the capacities and the offset of every field, by name; `SIZE`, the words in all.
        sources: the modules of its kernels; (): those of this package.
    """

    name: str
    constants: dict[str, int] = field(hash=False, compare=False)
    sources: tuple[str, ...] = ()

    def at(self, name: str) -> int:
        """The offset of a field."""
        return self.constants[name]


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

FIELDS: list[Field] = []
"""Every field in the order in which they stand."""

_end = 0


def one(name: str) -> int:
    """The place of a new single word."""
    return row(name, "")


def row(name: str, capacity: str) -> int:
    """The offset of a new field with so many places."""
    global _end  # noqa: PLW0603  the end of what is placed so far
    offset = _end
    FIELDS.append(Field(name, capacity))
    _end += CAPACITIES.get(capacity, 1)
    return offset


def layout(
    name: str, capacities: dict[str, int], *, faults: bool = False, gap: int = 0
) -> WordLayout:
    """The layout in which fields have these capacities, in the order of `FIELDS`.

    Args:
        faults: whether mistakes can be planted.
        gap: words between fields, in which a test sees what is written beyond one.
    """
    constants = {**capacities, "FAULTS": int(faults)}
    end = 0
    for one_field in FIELDS:
        constants[one_field.name] = end
        end += capacities.get(one_field.capacity, 1) + gap
    return WordLayout(name, {**constants, "SIZE": end})


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

# ---------------------------------------------------------------- what the caller sets
RULE = one("RULE")  # the rule of the algorithm: RULE_… below
MOTION = one("MOTION")  # 0: retrace, 1: overlap
FAULT = one("FAULT")  # the mistake, in `FAULTY` only; 0: none
BUDGET = one("BUDGET")  # how many moves are allowed
TRACING = one("TRACING")  # whether the run is to be written down
ROOM = one("ROOM")  # how many words of trace there is room for
AL = row("AL", "WORLD_DARTS")  # of each dart of the world: its other end
VT = row("VT", "WORLD_DARTS")  # of each dart of the world: its vertex
ST = row("ST", "WORLD_DARTS")  # of each vertex of the world: its first dart
DG = row("DG", "WORLD_DARTS")  # of each vertex of the world: its degree

# ---------------------------------------------------------------- the robot: robot.py
POS = one("POS")  # the reference dart, a dart of the world
COST = one("COST")  # edge traversals so far
STOP = one("STOP")  # why the run ended early: STOP_… below; 0: it did not
NTR = one("NTR")  # words of trace

# ---------------------------------------------------------------- S: chart.py
NV = one("NV")  # vertices of S
NDARTS = one("NDARTS")  # darts of S
NU = one("NU")  # darts in U
TREE = one("TREE")  # whether DEP and PAR are those of S as it is now
CA = row("CA", "CHART_DARTS")  # alpha of each dart; -1: unexplored
CV = row("CV", "CHART_DARTS")  # vertex of each dart
CP = row("CP", "CHART_DARTS")  # percept with each dart as the reference dart
UN = row("UN", "CHART_DARTS")  # whether the dart is in U
CF = row("CF", "CHART_DARTS")  # first dart of each vertex
CD = row("CD", "CHART_DARTS")  # degree of each vertex
SG = row("SG", "CHART_DARTS")  # signature of each vertex: 2 * degree, and 1 if the marker is here
UO = row("UO", "CHART_DARTS")  # how many darts of each vertex are in U
DEP = row("DEP", "CHART_DARTS")  # distance of each vertex from v0
PAR = row("PAR", "CHART_DARTS")  # dart of each vertex towards v0; -1: v0
Q = row("Q", "CHART_DARTS")  # the queue of that search
SEEN = row("SEEN", "CHART_DARTS")  # searches from other roots: number of the last that met v
NEAR = row("NEAR", "CHART_DARTS")  # the same: distance
TOWARDS = row("TOWARDS", "CHART_DARTS")  # the same: dart towards the root; -1: the root
REACHED = row("REACHED", "CHART_DARTS")  # the same: the queue
SEARCH = one("SEARCH")  # the number of the last search

# ---------------------------------------------------------------- excursions: motion.py
TURNED = one("TURNED")  # doors from the dart of entry to the reference dart
SHARED = one("SHARED")  # doors of its way that the chosen hypothesis shares with the last sequence
NDOORS = one("NDOORS")  # doors of the excursion
DOORS = row("DOORS", "CHART_DARTS")  # those doors
PP = row("PP", "CHART_DARTS")  # percepts behind them, vu's own first
REM = row("REM", "CHART_DARTS")  # H: the remaining hypotheses
COUNTS = row("COUNTS", "CHART_DARTS")  # for sorting H
SORTED = row("SORTED", "CHART_DARTS")  # the same

# ---------------------------------------------------------------- evidence: exploration.py
EV_STEP = one("EV_STEP")
EV_EXPECTED = one("EV_EXPECTED")  # a percept; -1: none
EV_OBSERVED = one("EV_OBSERVED")  # a percept; -1: none
EV_AT = one("EV_AT")  # dart of S; -1: none
EV_RECORD = one("EV_RECORD")  # dart of the record; -1: none
EV_FIRST = one("EV_FIRST")  # the record's first door, as an index of DOORS
EV_WRONG = one("EV_WRONG")  # a contradiction of folding or planar; 0: none

# ---------------------------------------------------------------- sequences and T: evidence.py
NSEQ = one("NSEQ")  # sequences executed for e
SQ_LENGTH = row("SQ_LENGTH", "CHART_DARTS")  # doors of each sequence
SQ_FIRST = row("SQ_FIRST", "CHART_DARTS")  # where each begins among the steps
NSTEPS = one("NSTEPS")  # steps of all sequences
SQ_DOORS = row("SQ_DOORS", "STEPS")
SQ_PERCEPTS = row("SQ_PERCEPTS", "STEPS")
NREC = one("NREC")  # percepts on record
TREC = row("TREC", "CHART_DARTS")  # T of each dart: the record behind it; -1: none
RC_PERCEPT = row("RC_PERCEPT", "RECORDS")
RC_DOOR = row("RC_DOOR", "RECORDS")  # the door that leads to it from the one before
RC_BEHIND = row("RC_BEHIND", "RECORDS")  # the first record behind it; -1: none
RC_NEXT = row("RC_NEXT", "RECORDS")  # the next one behind the same place; -1: none

# ---------------------------------------------------------------- the fold: folding.py
NPLACE_DARTS = one("NPLACE_DARTS")  # darts of all nodes, and 0, which is none
NODE = row("NODE", "PLACE_DARTS")  # the first dart of its node
LOOKS = row("LOOKS", "PLACE_DARTS")  # of its node: 2 * degree, and 1 if the marker is here
LEADER = row("LEADER", "PLACE_DARTS")  # a dart that it is; 0: it leads
BEHIND = row("BEHIND", "PLACE_DARTS")  # the other end of a dart that leads; 0: not seen
WEIGHT = row("WEIGHT", "PLACE_DARTS")  # of a first dart: how many nodes its node stands for
KNOWN = row("KNOWN", "PLACE_DARTS")  # of a first dart: whether its node is a vertex of S
WAITING = row("WAITING", "PLACE_DARTS")  # pairs of darts that are still to be made one
NCHANGES = one("NCHANGES")  # changes of a test so far
CHANGES = row("CHANGES", "CHANGED")  # where a word was changed, and what stood there
LAID = one("LAID")  # nodes that were identified by these changes
MERGES = one("MERGES")  # how many times seen places were identified
NJOINED = one("NJOINED")  # edges that the last sequence added to what was seen
JOINED_ONE = row("JOINED_ONE", "CHART_DARTS")  # one end of each
JOINED_OTHER = row("JOINED_OTHER", "CHART_DARTS")  # the other end
ANEW = one("ANEW")  # whether each hypothesis is to be folded anew
LAYERS_EVEN = row("LAYERS_EVEN", "LAYER_WORDS")  # layers: where a word differs, and that word
LAYERS_ODD = row("LAYERS_ODD", "LAYER_WORDS")  # the same, of every other stage
STAGE = one("STAGE")  # stages so far in which layers were written
NLAYER_WORDS = one("NLAYER_WORDS")  # words of the layers of this stage
LAYER_FIRST = row("LAYER_FIRST", "CHART_DARTS")  # where the layer of a hypothesis begins
LAYER_END = row("LAYER_END", "CHART_DARTS")  # where it ends
ENTRIES = row("ENTRIES", "CHART_DARTS")  # of each vertex of S: the dart that its first dart is
PLACE_E = one("PLACE_E")  # the dart that e is
PLACE_VU = one("PLACE_VU")  # the dart by which the robot came to vu
FACE = row("FACE", "CHART_DARTS")  # the number of the last e on whose face the dart was
NFACES = one("NFACES")  # how many faces were walked: the number of this e

# ---------------------------------------------------------------- the trace, last: it may be longer
TR = row("TR", "TRACE")

RULE_NONE, RULE_PREFIX, RULE_HISTORY, RULE_ONE, RULE_ALL, RULE_FOLDING, RULE_PLANAR = range(7)

STOP_BUDGET = 1  # one more move than the budget
STOP_DOOR = 2  # no such door
STOP_FULL = 16  # a buffer is full; STOP - STOP_FULL is one of FULL_… below
FULL_CHART, FULL_STEPS, FULL_RECORDS, FULL_PLACES, FULL_TRACE = range(5)

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
