"""Rejection without motion: `prefix` and `history`, and what they leave alone."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tests.helpers import PAPER, cited, doors, of_type, sketch, trace_of, variant
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed, Hypothesis
from topo_verify.algorithms.rules import HistoryRule
from topo_verify.robot.events import Evidence, Reject
from topo_verify.robot.percept import Percept

WITHOUT_MOTION = [name for name in PAPER if name != "basic"]


class JoinedHistory(HistoryRule):
    """The other reading: while h is assumed, crossing e or h leads on to the other of the two."""

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        e = next(
            d for d, end in enumerate(chart.alpha) if end is None and d not in chart.unexplored
        )
        chart.alpha[e], chart.alpha[hypothesis.dart] = hypothesis.dart, e
        try:
            return super().refute(chart, hypothesis, sequences)
        finally:
            chart.alpha[e] = chart.alpha[hypothesis.dart] = None


def free(trace_id: str, name: str) -> list[Reject]:
    """The rejections without motion."""
    return [
        reject for reject in of_type(Reject, trace_of(trace_id, name)) if reject.rule != "motion"
    ]


def test_the_basic_algorithm_rejects_by_motion_alone() -> None:
    assert {reject.rule for reject in of_type(Reject, trace_of("m5/1269"))} == {"motion"}


def test_prefix_compares_percepts_on_the_common_doors_marker_direction_included() -> None:
    # Dart 9 goes home by the door that was executed for dart 5, and expects the marker there.
    (reject,) = free("m5/1009", "enhancement-i")
    assert reject == Reject(
        7, 9, "prefix", Evidence(1, Percept(2, 1), Percept(4, None), sequence=0, at=1)
    )
    rejects = free("m6/20146", "enhancement-i")
    assert [tuple(percept.marker for percept in cited(r)) for r in rejects] == [(1, 2)]


def test_prefix_does_not_look_beyond_the_common_doors() -> None:
    # `history` traces the whole sequence from dart 4 and rejects it; its first door differs.
    assert free("m4/41", "enhancement-i") == []
    assert [reject.hypothesis for reject in free("m4/41", "enhancement-ii")] == [4]


def test_history_traces_every_sequence_of_this_edge() -> None:
    (reject,) = free("m5/202", "enhancement-ii")
    assert reject.evidence.sequence == 1


def test_the_example_of_history_in_the_paper() -> None:
    # Section III-B, figure 5: h is dart 2 of a vertex with five; its doors 3, then 2, are explored.
    chart = Chart(Percept(1, 0))
    for e, degree in ((0, 5), (5, 4), (8, 3)):
        chart.join(e, chart.add_vertex(Percept(degree, None)))
    seen = [Percept(degree, None) for degree in (5, 4, 2, 3, 5)]
    hypothesis = Hypothesis(2, chart, chart.tree(0))
    refutation = HistoryRule().refute(chart, hypothesis, [Executed((3, 2, 1, 4), tuple(seen))])
    evidence = Evidence(2, Percept(3, None), Percept(2, None), sequence=0, at=10)
    assert refutation == Refutation("history", evidence)


def test_history_compares_the_direction_of_the_marker() -> None:
    (reject,) = free("m5/2103", "enhancement-ii")
    expected, observed = cited(reject)
    assert expected.signature == observed.signature


def test_history_ends_at_unexplored_darts_e_and_h_included() -> None:
    # Tracing from dart 4 leaves S by e itself. Were e and h joined while h is assumed, that
    # would contradict at once and save two moves. The paper's text does not go that far.
    assert free("m4/36", "enhancement-ii") == []
    assert len(doors(trace_of("m4/36", "enhancement-ii"))) == 11
    assert len(doors(trace_of("m4/36", variant(JoinedHistory)))) == 9


@pytest.mark.parametrize("name", WITHOUT_MOTION)
def test_a_rule_rejects_in_the_order_of_h_right_after_the_mismatch(name: str) -> None:
    trace = trace_of("m5/1269", name)
    if name == "enhancement-i":
        assert free("m5/1269", name) == []
        return
    assert sketch(trace[16:22]) == [
        "pose", "validate 5", "reject", "reject", "reject", "retrace 0",
    ]  # fmt: skip
    rejects = of_type(Reject, trace[16:22])
    assert [r.hypothesis for r in rejects] == [4, 5, 8]
    assert rejects[0].rule == "motion" not in {r.rule for r in rejects[1:]}
