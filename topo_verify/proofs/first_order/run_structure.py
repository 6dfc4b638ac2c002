"""S, percepts and records of a real run as a structure in which `rules.py` can be evaluated.

No world is needed: the dart b of the terms is the number of a percept, and `rot(b, i) = root` means
that the marker was sensed at door i.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from topo_verify.algorithms.chart import Chart
from topo_verify.proofs.first_order.structures import Function, Structure, Value
from topo_verify.robot.events import MapDart
from topo_verify.robot.percept import Door, Percept

NO_DOOR = -1
"""The value of `rot(b, i)` for every dart but the root: it only has to differ from 0."""


class RecordTrie:
    """The records as numbered nodes: the percept seen, and by door the node behind it."""

    def __init__(self) -> None:
        self.percepts: list[Percept] = []
        self.behind: list[dict[Door, int]] = []
        self.records: dict[MapDart, int] = {}

    def node(self, percept: Percept) -> int:
        """Add a node for this percept, and return its number."""
        self.percepts.append(percept)
        self.behind.append({})
        return len(self.percepts) - 1


def points(percept: Percept, door: Door) -> bool:
    """Whether the marker points at this door."""
    return percept.marker is not None and (door - percept.marker) % percept.degree == 0


def structure(chart: Chart, seen: Sequence[Percept], trie: RecordTrie) -> Structure:
    """The structure of S, the sensed percepts, and the records."""
    rows = {
        "root": nullary(0),
        "mroot": nullary(0),
        "succ": unary(lambda k: k + 1),
        **_of_chart(chart),
        **_of_percepts(seen),
        **_of_records(trie),
    }
    # Quantifiers over doors range up to the largest degree: beyond it, doors repeat.
    degrees = [*chart.degree, *(percept.degree for percept in seen), 1]
    return Structure({"K": max(degrees), "M": len(chart.alpha)}, rows)


def _of_chart(chart: Chart) -> dict[str, Function]:
    percepts, alpha = chart.percepts, chart.alpha
    return {
        "explored": unary(lambda x: alpha[x] is not None),
        # No rule uses malpha at an unexplored dart; any value will do there.
        "malpha": unary(lambda x: x if alpha[x] is None else chart.across(x)),
        "mrot": binary(chart.turn),
        "mdeg": unary(lambda x: percepts[x].degree),
        "minv0": unary(lambda x: percepts[x].marker is not None),
        "mfirst": unary(lambda x: chart.first[chart.vertex[x]]),
    }


def _of_percepts(seen: Sequence[Percept]) -> dict[str, Function]:
    return {
        "deg": unary(lambda b: seen[b].degree),
        "inv0": unary(lambda b: seen[b].marker is not None),
        "rot": binary(lambda b, i: 0 if points(seen[b], i) else NO_DOOR),
    }


def _of_records(trie: RecordTrie) -> dict[str, Function]:
    percepts, records = trie.percepts, trie.records
    return {
        "recorded": unary(lambda x: x in records),
        "record": unary(lambda x: records.get(x, 0)),
        "deeper": binary(lambda r, k: k in trie.behind[r]),
        "behind": binary(lambda r, k: trie.behind[r].get(k, 0)),
        "rdeg": unary(lambda r: percepts[r].degree),
        "rinv0": unary(lambda r: percepts[r].marker is not None),
        "rpoints": binary(lambda r, i: points(percepts[r], i)),
    }


def nullary(value: Value) -> Function:
    """A constant of the structure."""
    return lambda: value


def unary(function: Callable[[int], Value]) -> Function:
    """A function of one element."""
    # Only the type checker gains by this: it learns how many arguments there are.
    return function


def binary(function: Callable[[int, int], Value]) -> Function:
    """A function of two elements."""
    return function
