"""Enhancement III: records of percepts behind unexplored darts (rule `records`).

Once vu is known, the sequences executed for e start at a known dart of S. Where one crosses an
unexplored dart d, the percepts behind d enter T[d]: the first alone (one-level), or all of them in
a trie by relative doors (all-level).

Source: section III-C of the paper; listing 3, lines 3, 10-16, 29; docs/semantics.md, section 7.
"""

from __future__ import annotations

from collections.abc import Sequence

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.enhancement_ii import HistoryRule
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed
from topo_verify.robot.events import Evidence, MapDart, Record
from topo_verify.robot.percept import Door, Percept


class Seen:
    """A node of the trie: the percept of a place, and by door the places behind it."""

    __slots__ = ("behind", "percept")

    def __init__(self, percept: Percept) -> None:
        self.percept = percept
        self.behind: dict[Door, Seen] = {}


class RecordsRule(HistoryRule):
    """Traces as `history` does, and on along T.

    Args:
        levels: depth of the records in places; None: as deep as the robot went.
    """

    def __init__(self, levels: int | None = None) -> None:
        self.levels = levels
        self.records: dict[MapDart, Seen] = {}  # T: A3.3

    def beyond(
        self, exit_dart: MapDart, sequence: Executed, step: int, number: int
    ) -> Refutation | None:
        """The first recorded percept behind the dart that the sequence contradicts."""
        place = self.records.get(exit_dart)  # A3.14
        first = step
        while place is not None:
            if place.percept != sequence.percepts[step]:
                record = Record(exit_dart, sequence.doors[first:step])  # doors[first - 1] crossed
                evidence = Evidence(
                    step,
                    place.percept,
                    sequence.percepts[step],
                    sequence=number,
                    at=exit_dart,
                    record=record,
                )
                return Refutation("records", evidence)
            if step == len(sequence.doors):
                break
            place = place.behind.get(sequence.doors[step])
            step += 1
        return None

    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        """Record the percepts behind unexplored darts, with the sequences traced on the grown S."""
        self.records.pop(e, None)
        self.records.pop(entry, None)
        for sequence in sequences:  # A3.29
            at = entry
            for step, door in enumerate(sequence.doors, 1):
                exit_dart = chart.turn(at, door)
                arrival = chart.alpha[exit_dart]
                if arrival is None:
                    self._record(exit_dart, sequence, step)
                    break
                at = arrival

    def _record(self, exit_dart: MapDart, sequence: Executed, step: int) -> None:
        place = self.records.setdefault(exit_dart, Seen(sequence.percepts[step]))
        # the place behind the dart is level 1
        deepest = len(sequence.doors) if self.levels is None else step + self.levels - 1
        for deeper in range(step + 1, min(deepest, len(sequence.doors)) + 1):
            place = place.behind.setdefault(
                sequence.doors[deeper - 1], Seen(sequence.percepts[deeper])
            )
