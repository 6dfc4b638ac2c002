"""The workspace: everything that a run knows, as fields at fixed places of one array of integers.

`W[CA + d]` is the field `CA` of dart `d`: the offsets are constants when kernels are compiled, so
this costs what a local array would. (A tuple of eighteen arrays took 1.5 times as long.) Integers
have 64 bits: narrower ones were not faster, and no sum overflows.

There are layouts. `SMALL` is for worlds of up to 12 edges: what a run touches stays in the fastest
cache of the processor. `FAULTY` has the same capacities and lets mistakes be planted (`faults.py`).
`LARGE` is for worlds of up to 65,536 edges; pages that are never touched take no memory. The
constants below are those of `SMALL`; `compiled` puts those of another layout in their place.

Nothing here is cleared between runs: a kernel sets what it reads. A buffer that is full ends the
run with a reason in `STOP`; nothing is written beyond it.

    suffix      a place for every                         capacity
    WORLD       dart (and vertex) of the world            WORLD_DARTS
    CHART       dart (and vertex) of S                    CHART_DARTS
    STEPS       step of the sequences behind one e        STEPS
    RECORDS     percept on record behind unexplored darts RECORDS
    PLACES      node of the fold                          PLACES
    DOORS       door of a node of the fold                PLACE_DOORS

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
    "PLACES": 4096,
    "PLACE_DOORS": 16384,
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
PLACES = CAPACITIES["PLACES"]
PLACE_DOORS = CAPACITIES["PLACE_DOORS"]
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

# ---------------------------------------------------------------- sequences and T: records.py
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

# ---------------------------------------------------------------- the fold: partial_fold.py
NPLACES = one("NPLACES")  # nodes
NPLACE_DOORS = one("NPLACE_DOORS")  # doors of all nodes
LEADER = row("LEADER", "PLACES")  # the node itself, or the one it was made one with
OFFSET = row("OFFSET", "PLACES")  # door k is door k + OFFSET of LEADER
WEIGHT = row("WEIGHT", "PLACES")  # how many nodes a leader stands for
SIGNATURE = row("SIGNATURE", "PLACES")  # 2 * degree, and 1 if the marker is here
KNOWN = row("KNOWN", "PLACES")  # whether it is a vertex of S
BASE = row("BASE", "PLACES")  # its door 0 among all doors
FILLED = row("FILLED", "PLACES")  # how many of its doors have an end
BEHIND_NODE = row("BEHIND_NODE", "PLACE_DOORS")  # the other end of a door: node; -1: none
BEHIND_DOOR = row("BEHIND_DOOR", "PLACE_DOORS")  # the other end of a door: door
ORDER = row("ORDER", "PLACE_DOORS")  # a node's doors as they were filled
WAITING = row("WAITING", "PLACE_DOORS")  # pairs of darts that are still to be made one
NUNDO = one("NUNDO")  # what is to be taken back
UNDO = row("UNDO", "PLACE_DOORS")  # 4 * node + UNDO_…: what was changed, in order
LAYER = one("LAYER")  # whether changes are to be taken back
VN = row("VN", "CHART_DARTS")  # of each vertex of S: its node
VD = row("VD", "CHART_DARTS")  # of each vertex of S: the node's door that is its first dart
E_NODE = one("E_NODE")
E_DOOR = one("E_DOOR")
VU_NODE = one("VU_NODE")
VU_DOOR = one("VU_DOOR")
FACE = row("FACE", "CHART_DARTS")  # the number of the last e on whose face the dart was
NFACES = one("NFACES")  # how many faces were walked: the number of this e

# ---------------------------------------------------------------- the trace, last: it may be longer
TR = row("TR", "TRACE")

RULE_NONE, RULE_PREFIX, RULE_HISTORY, RULE_ONE, RULE_ALL, RULE_FOLDING, RULE_PLANAR = range(7)

UNDO_MERGE, UNDO_FILL, UNDO_KNOWN = range(3)

STOP_BUDGET = 1  # one more move than the budget
STOP_DOOR = 2  # no such door
STOP_FULL = 16  # a buffer is full; STOP - STOP_FULL is one of FULL_… below
FULL_CHART, FULL_STEPS, FULL_RECORDS, FULL_PLACES, FULL_TRACE = range(5)

SMALL = layout("small", CAPACITIES)
FAULTY = layout("faulty", CAPACITIES, faults=True, gap=1)
LARGE = layout(
    "large",
    {
        "WORLD_DARTS": 1 << 17,
        "CHART_DARTS": 1 << 17,
        "STEPS": 1 << 21,
        "RECORDS": 1 << 21,
        "PLACES": 1 << 20,
        "PLACE_DOORS": 1 << 22,
        "TRACE": 1,
    },
)
