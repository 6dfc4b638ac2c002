"""Claims 9 and 10: a lucky guess is convicted, with a world in which it is wrong."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import pytest

from tests.faults.every import EVERY
from tests.helpers import edited, place, trace_of, variant, worlds
from topo_verify import World, examine
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed, Hypothesis
from topo_verify.algorithms.rules import NoRule
from topo_verify.campaign.judge import Report
from topo_verify.checkers import check, claims, decision_conclusions
from topo_verify.checkers.entailment import FoldedTrace, map_conclusion
from topo_verify.faults.fault import ForwardingRobot
from topo_verify.robot import events as ev
from topo_verify.robot.simulator import first_percept


class TheRestIsNew(NoRule):
    """Takes vu for new after the first mismatch."""

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        if not sequences:
            return None
        percept = chart.percepts[hypothesis.dart]
        return Refutation("history", ev.Evidence(0, percept, percept))


class Mute(ForwardingRobot):
    """A robot that keeps to itself what its mapper declares."""

    def declare(self, event: ev.Decision) -> None:
        """Nobody is told."""


class Tactful(Mute):
    """A robot that is told how the map grows, and nothing else."""

    def declare(self, event: ev.Decision) -> None:
        if isinstance(event, ev.Augment):
            self.robot.declare(event)


GUESSERS = {
    "elimination": EVERY["concludes-by-elimination"],
    "the only one": EVERY["confirms-what-is-alone"],
}


def lucky(report: Report) -> bool:
    """Does none of claims 1-8 fail?"""
    return all(s != "failed" for claim, s in report.claims.items() if "entailed" not in claim)


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "worlds_where_lucky"),
    [("elimination", {3: 3, 4: 61}), ("the only one", {2: 1, 3: 15, 4: 207})],
)
@pytest.mark.no_cover
def test_where_a_guess_is_lucky_its_witness_breaks_it(
    name: str, worlds_where_lucky: dict[int, int]
) -> None:
    guesser = GUESSERS[name]
    convicted = Counter[int]()
    for world in worlds(range(1, 5)):
        report = examine(guesser, world)
        if not lucky(report) or report.ok:
            continue
        for finding in report.findings:
            if finding.claim == "map-entailed":
                assert finding.witness is not None
                broken = examine(guesser, World.from_id(finding.witness))
                assert broken.claims["map-isomorphic"] == "failed"
                assert "run there, the mapper is wrong" in finding.message
                convicted[len(world.edges)] += 1
    assert convicted == worlds_where_lucky


@pytest.mark.long
@pytest.mark.no_cover
def test_a_silent_guess_is_convicted_by_its_history_alone() -> None:
    guesser = EVERY["joins-the-last-two-unseen"]
    convicted = 0
    for world in worlds([3, 4]):
        report = examine(lambda robot: guesser(Mute(robot)), world)
        if report.claims["map-isomorphic"] == "failed" or report.ok:
            continue
        finding = next(f for f in report.findings if f.claim == "map-entailed")
        assert "run there, the mapper is wrong" in finding.message
        convicted += 1
    assert convicted >= 10


@pytest.mark.parametrize("where", ["m5/105", "m5/205", "m5/207", "m5/209", "m5/965", "m5/1019"])
def test_a_place_taken_for_new_too_early_is_convicted_though_the_map_is_proved(where: str) -> None:
    """In six worlds with five edges, and in none with fewer, it was merely lucky."""

    def guesser(robot: ev.Robot) -> object:
        return variant(TheRestIsNew)(Tactful(robot))

    report = examine(guesser, World.from_id(where))
    assert lucky(report)
    assert report.claims["map-entailed"] == "ok"
    (finding, *_) = report.findings
    assert finding.claim == "decisions-entailed"
    assert finding.witness is not None
    assert not examine(guesser, World.from_id(finding.witness)).ok


def test_a_mapper_that_declares_nothing_is_still_convicted_of_guessing() -> None:
    world = next(
        w for w in worlds([3, 4]) if lucky(r := examine(GUESSERS["elimination"], w)) and not r.ok
    )
    silent = [
        e
        for e in trace_of(world, GUESSERS["elimination"])
        if isinstance(e, ev.Start | ev.Move | ev.Finish)
    ]
    claims = {j.claim: j.status for j in check(world, silent)}
    assert claims["map-entailed"] == "failed"
    assert claims["decisions-entailed"] == "not-declared"


def why(trace: ev.Trace) -> list[str]:
    return [
        conclusion.why for conclusion in decision_conclusions(FoldedTrace(trace)) if conclusion.why
    ]


def test_a_decision_made_too_early_does_not_follow() -> None:
    trace = trace_of("m4/300")
    early = [
        e for e in trace if not isinstance(e, ev.Move) or e.purpose not in ("validate", "retrace")
    ]
    assert why(tuple(early))


@pytest.mark.parametrize(
    ("kind", "fields", "message"),
    [
        (ev.Augment, {"degree": 9}, "another vertex"),
        (ev.Augment, {"edge": 99}, "not an unexplored dart"),
        (ev.Augment, {"dart": 99}, "not an unexplored dart"),
        (ev.Confirm, {"hypothesis": -1}, "not an unexplored dart"),
        (ev.Reject, {"hypothesis": 99}, "not an unexplored dart"),
    ],
)
def test_nonsense_is_a_finding(kind: type, fields: dict[str, object], message: str) -> None:
    world = next(
        w
        for w in worlds([4])
        if {ev.Confirm, ev.Reject} <= {type(e) for e in trace_of(w)}
        and next(e for e in trace_of(w) if isinstance(e, ev.Augment)).kind == "new"
    )
    assert message in " ".join(why(edited(trace_of(world), place(trace_of(world), kind), **fields)))


def test_an_edge_that_was_never_crossed_proves_no_new_vertex() -> None:
    for degree in (1, 2):
        start = ev.Start(percept=first_percept(World.from_id("m2/0")))
        told = [*decision_conclusions(FoldedTrace((start, ev.Augment(0, "new", 1, degree))))]
        assert told[0].why == "the edge was never crossed"
        assert told[0].witness is not None
        assert told[0].witness.degrees[1] != degree


def test_a_history_that_no_world_shows_is_a_finding_and_no_crash() -> None:
    at_home = first_percept(World.from_id("m4/300"))
    trace = trace_of("m4/300")
    trace = edited(trace, place(trace, ev.Move), percept=at_home)
    assert "no world shows this history" in map_conclusion(FoldedTrace(trace)).why
    assert "no world shows this history" in " ".join(why(trace))


def test_without_a_map_nothing_is_proved() -> None:
    assert "no map" in map_conclusion(FoldedTrace(trace_of("m2/0")[:-1])).why


def test_large_worlds_are_asked_claim_10_only_if_strict(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(claims, "LARGE", 100)
    world = World.from_rotations(
        [range(101), *([d] for d in range(101, 202))],
        zip(range(101), range(101, 202), strict=True),
        0,
    )
    trace = trace_of(world)
    *_, left_out = check(world, trace)
    assert (left_out.claim, left_out.status) == ("decisions-entailed", "not-asked")
    assert left_out.judged == 0
    assert {j.claim: j.status for j in check(world, trace, strict=True)}[
        "decisions-entailed"
    ] == "ok"


def test_the_planar_prior_counts_planar_witnesses_only() -> None:
    assert set(examine("folding+planar", World.from_id("m4/300")).claims.values()) == {"ok"}
