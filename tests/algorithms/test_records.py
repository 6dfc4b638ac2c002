"""Enhancement III: what is recorded behind unexplored darts, and when it is looked up."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tests.helpers import failing, of_type, trace_of, variant
from topo_verify import CATALOGUE, World
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.motion import Executed, Hypothesis, overlap
from topo_verify.algorithms.rules import HistoryRule, RecordsRule, Seen
from topo_verify.faults import FAULTS
from topo_verify.robot.events import Evidence, MapDart, Record, Reject, Trace
from topo_verify.robot.percept import Percept

ONE, ALL = "enhancement-iii-one", "enhancement-iii-all"
FROM_DART_0 = FAULTS["records-a-loop-from-dart-0"]


def recorded(trace: Trace) -> list[Reject]:
    """The rejections whose expectation came from a record."""
    return [r for r in of_type(Reject, trace) if r.evidence.record is not None]


class Watched(RecordsRule):
    """Remembers, after each augmentation, whether all of T lies behind unexplored darts."""

    clean = True

    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        super().learn(chart, e, entry, sequences)
        self.clean &= self.records.keys() <= chart.unexplored.keys()


def test_the_direction_of_the_marker_counts_inside_records() -> None:
    # Behind dart 7 the marker was seen at door 2, now it is at door 1. Presence alone would agree.
    reject = recorded(trace_of("m6/23746", ALL))[-1]
    assert reject == Reject(
        1, 9, "records",
        Evidence(1, Percept(3, 2), Percept(3, 1), sequence=0, at=7, record=Record(7, ())),
    )  # fmt: skip


@pytest.mark.parametrize("name", [ONE, ALL])
def test_the_record_behind_e_is_consulted_where_tracing_crosses_e(name: str) -> None:
    (reject,) = recorded(trace_of("m5/434", name))
    assert reject.evidence.record == Record(reject.edge, ())


def test_the_record_behind_h_is_consulted_where_tracing_crosses_h() -> None:
    (reject,) = recorded(trace_of("m7/41544", "enhancement-iii-all+i"))
    assert reject.evidence.record == Record(reject.hypothesis, ())


def test_no_record_is_consulted_when_h_is_made() -> None:
    # T[3] is known to show degree 7 when e = 3 is posed: all darts of that degree are posed.
    trace = trace_of("m5/434", ALL)
    assert [(r.edge, r.hypothesis, r.rule) for r in of_type(Reject, trace)][2:] == [
        (3, 4, "motion"), (3, 6, "records"),
    ]  # fmt: skip


def test_one_level_stops_behind_the_unexplored_dart_and_all_level_goes_deeper() -> None:
    deep = Record(10, (3,))
    one, every = (recorded(trace_of("m7/20231", name)) for name in (ONE, ALL))
    assert deep in [reject.evidence.record for reject in every]
    assert [reject.evidence.record for reject in one] == [Record(12, ())]


def test_a_loop_is_traced_from_its_dart_h_and_not_from_the_first_of_the_vertex() -> None:
    # What was executed behind dart 2 is known to have begun at dart 5, of the vertex whose first
    # dart is 1. Traced from 5, its door 5 is dart 3; traced from 1, it would be dart 6.
    (reject,) = recorded(trace_of("m5/434", ALL))
    assert reject.evidence.record == Record(3, ())
    assert recorded(trace_of("m5/434", FROM_DART_0)) == []


def test_tracing_loops_from_the_first_dart_would_reject_what_is_true() -> None:
    world = World.from_id("m5/446")
    assert failing(world, trace_of(world, ALL)) == set()
    assert "true-hypothesis-kept" in failing(world, trace_of(world, FROM_DART_0))


@pytest.mark.parametrize("world_id", ["m5/434", "m6/23746", "m7/20231", "m7/41544"])
def test_records_are_dropped_with_their_trie_when_their_dart_is_explored(world_id: str) -> None:
    rules: list[Watched] = []

    def rule() -> Watched:
        rules.append(Watched())
        return rules[-1]

    trace_of(world_id, variant(rule, overlap))
    assert all(rule.clean for rule in rules)
    assert not rules[0].records  # the map is complete: nothing is unexplored


def test_a_dropped_trie_moves_nowhere() -> None:
    chart = Chart(Percept(2, 0))
    rule = RecordsRule()
    rule.records[0] = Seen(Percept(3, None))
    rule.records[0].behind[1] = Seen(Percept(4, None))
    chart.join(0, chart.add_vertex(Percept(3, None)))
    rule.learn(chart, 0, 2, [])
    assert not rule.records


@pytest.mark.parametrize("levels", [1, 2, None])
def test_records_go_as_deep_as_their_levels(levels: int | None) -> None:
    chart = Chart(Percept(1, 0))
    chart.join(0, chart.add_vertex(Percept(2, None)))  # darts 1 and 2
    rule = RecordsRule(levels=levels)
    row = tuple(Percept(degree, None) for degree in (2, 5, 6, 7))
    rule.learn(chart, 0, 1, [Executed((1, 4, 3), row)])
    depth, place = 0, rule.records[2]
    while place.behind:
        depth, place = depth + 1, next(iter(place.behind.values()))
    assert place.percept == row[depth + 1]
    assert depth + 1 == (levels or 3)


SEEN = (6, 4, 3, 2, 5)
"""Degrees at vx and behind 3, 2, 1, 4 from there, in section III-C; the marker is elsewhere."""


@pytest.mark.parametrize(
    ("rule", "compared"),
    [(HistoryRule(), 1), (RecordsRule(levels=1), 2), (RecordsRule(), 4)],
    ids=["history", "one level", "all levels"],
)
def test_the_examples_of_records_in_the_paper(rule: HistoryRule, compared: int) -> None:
    # vk has the darts 1 to 7; e = 2 ends at vx, whose edge 0 is dart 8; edge 5 from dart 4 is e.
    chart = Chart(Percept(1, 0))
    chart.join(0, chart.add_vertex(Percept(7, None)))
    vx = chart.add_vertex(Percept(SEEN[0], None))
    chart.join(2, vx)
    rule.learn(chart, 2, vx, [Executed((3, 2, 1, 4), percepts(SEEN))])
    hypothesis = Hypothesis(4, chart, chart.tree(0))
    for place in range(4):
        other = [7, *SEEN[:4]]
        assert rule.refute(chart, hypothesis, [Executed((5, 3, 2, 1), percepts(other))]) is None
        other[place + 1] = 9
        refuted = rule.refute(chart, hypothesis, [Executed((5, 3, 2, 1), percepts(other))])
        assert (refuted is not None) == (place < compared)


def percepts(degrees: Sequence[int]) -> tuple[Percept, ...]:
    """Percepts without the marker."""
    return tuple(Percept(degree, None) for degree in degrees)


def test_a_second_sequence_adds_branches_to_the_trie() -> None:
    chart = Chart(Percept(1, 0))
    chart.join(0, chart.add_vertex(Percept(2, None)))
    rule = RecordsRule()
    row = tuple(Percept(degree, None) for degree in (2, 5, 6))
    rule.learn(chart, 0, 1, [Executed((1, 4), row), Executed((1, 3), row), Executed((0,), row[:2])])
    assert list(rule.records) == [2]
    assert list(rule.records[2].behind) == [4, 3]


def test_every_algorithm_of_the_catalogue_has_its_own_records() -> None:
    one, other = CATALOGUE[ALL].rule(), CATALOGUE[ALL].rule()
    assert isinstance(one, RecordsRule)
    assert isinstance(other, RecordsRule)
    assert one.records is not other.records
