"""The paper's four rules: when a hypothesis is rejected without walking it.

    NoRule        `none`     the basic algorithm (listing 1): only motion rejects
    PrefixRule    `prefix`   Enhancement I, stage 1: percepts on the common prefix of doors
    HistoryRule   `history`  Enhancement II: every sequence executed for this edge, traced on S
    RecordsRule   `records`  Enhancement III: records of percepts behind unexplored darts

The basic algorithm walks each hypothesis until it differs. One case needs no move: the robot sees
the marker at vu, and the hypothesis predicts another direction of it. Reports count it as rejected
free.

**Prefix.** If the ways home of two hypotheses begin with the same doors, both must expect the same
percepts there. (Stage 2 is `motion.overlap`.)

**History.** Assume that the robot entered vu by dart h of S. While tracing stays on explored edges,
S shows the percept behind each door. Tracing ends at an unexplored dart; e and h count as
unexplored.

**Records.** Once vu is known, the sequences executed for e start at a known dart of S. Where one
crosses an unexplored dart d, the percepts behind d enter T[d]: the first alone (one-level), or all
of them in a trie by relative doors (all-level).

Source: H. Wang, M. Jenkin, P. Dymond, "The relative power of immovable markers in topological
    mapping", ICRA 2011, cost O(m²n) edge traversals; sections III-A to III-C of the paper; listing
    2, lines 16-19; listing 3, lines 3, 10-16, 29; docs/semantics.md, section 7.
"""

from __future__ import annotations

from collections.abc import Sequence

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed, Hypothesis, common_prefix
from topo_verify.robot.events import Evidence, MapDart, Record
from topo_verify.robot.percept import Door, Percept


class NoRule:
    """Rejects nothing without motion; remembers nothing."""

    def arrive(self, chart: Chart, e: MapDart, percept: Percept) -> None:
        """Keep nothing of the percept at vu."""

    def observe(self, sequence: Executed) -> None:
        """Keep nothing of the sequence."""

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        """None: only motion rejects."""
        return None

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        """None: only motion confirms."""
        return None

    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        """Keep nothing of the sequences behind e."""


class PrefixRule(NoRule):
    """Compares the last sequence with the hypothesis' way home."""

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        """The first percept on the common prefix that the hypothesis does not expect."""
        if not sequences:
            return None
        last = sequences[-1]
        shared = common_prefix(hypothesis.doors, last.doors)  # A2.17
        # at step 0 all hypotheses expect the same
        for step in range(1, shared + 1):
            if last.percepts[step] != hypothesis.expected[step]:  # A2.18
                evidence = Evidence(
                    step,
                    hypothesis.expected[step],
                    last.percepts[step],
                    sequence=len(sequences) - 1,
                    at=hypothesis.arrivals[step],
                )
                return Refutation("prefix", evidence)
        return None


class HistoryRule(NoRule):
    """Traces the last sequence from the hypothesis."""

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        """The first percept that contradicts S where the last sequence leads from h.

        Earlier sequences were traced when they were executed, and S has not changed since.
        """
        if not sequences:
            return None
        last, number = sequences[-1], len(sequences) - 1
        at = hypothesis.dart  # A3.10
        for step, door in enumerate(last.doors, 1):
            exit_dart = chart.turn(at, door)
            # e and h are joined only when h is confirmed
            arrival = chart.alpha[exit_dart]
            if arrival is None:
                return self.beyond(exit_dart, last, step, number)  # A3.13
            at = arrival  # A3.11
            if chart.percepts[at] != last.percepts[step]:  # A3.12 A3.15
                evidence = Evidence(
                    step, chart.percepts[at], last.percepts[step], sequence=number, at=at
                )
                return Refutation("history", evidence)
        return None

    def beyond(
        self, exit_dart: MapDart, sequence: Executed, step: int, number: int
    ) -> Refutation | None:
        """What contradicts step `step` of a sequence behind an unexplored dart; here nothing."""
        return None


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
