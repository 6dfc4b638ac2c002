"""Claims 9 and 10: what does not follow has a witness, which shows the history and tells."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import pytest

from tests.checkers.example import LOOP, TRACE, fold_history, inserted
from tests.checkers.test_folding import shows
from tests.helpers import edited, of_type, place, statuses, trace_of, worlds
from topo_verify import World, certify
from topo_verify.checkers import check, claims, decision_conclusions
from topo_verify.checkers.entailment import Conclusion, FoldedTrace, map_conclusion
from topo_verify.checkers.folding import Fold
from topo_verify.checkers.replayed_trace import ReplayedTrace
from topo_verify.errors import plural
from topo_verify.faults import FAULTS
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import first_percept


def delivering(history: Sequence[ev.Event], world: World) -> ev.Trace:
    """The history, and at its end the map of this world."""
    return (*history, ev.Finish(None, ev.MapData(world.vertices, world.edges, world.marker)))


def unproved(trace: ev.Trace) -> list[Conclusion]:
    """The conclusions that do not follow."""
    return [conclusion for conclusion in decision_conclusions(FoldedTrace(trace)) if conclusion.why]


def test_a_trace_is_folded_into_the_fold_that_is_given() -> None:
    world = World.from_id("m3/14")
    fold = Fold(first_percept(world))
    folded = FoldedTrace(trace_of(world), fold)
    assert folded.read_to(len(folded.trace)) is None
    assert folded.fold is fold
    assert fold.open_darts() == 0


# ---------------------------------------------------------------- claim 9


@pytest.mark.no_cover
def test_while_a_dart_is_open_neither_of_the_two_worlds_is_proved() -> None:
    for world in worlds(range(1, 4)):
        trace = [e for e in trace_of(world) if isinstance(e, ev.Start | ev.Move)]
        for length in range(1, len(trace)):
            history = trace[:length]
            fold, _ = fold_history(history)
            for hang in (1, 2):
                when, why, witness, _ = map_conclusion(
                    FoldedTrace(delivering(history, fold.world(hang)))
                )
                doors = plural(fold.open_darts(), "door")
                assert (when, why) == (length, f"{doors} seen and never crossed")
                assert witness is not None
                assert witness.code == fold.world(3 - hang).code
                assert shows(witness, history)


def test_the_witness_against_another_map_than_the_proved_one_is_the_proved_one() -> None:
    world, other = World.from_id("m3/14"), World.from_id("m3/15")
    history = trace_of(world)[:-1]
    when, why, witness, _ = map_conclusion(FoldedTrace(delivering(history, other)))
    assert (when, why) == (len(history), "it proves another map")
    assert witness is not None
    assert witness.is_isomorphic(world)
    assert map_conclusion(FoldedTrace(delivering(history, world))) == Conclusion(len(history), "")


@pytest.mark.parametrize("name", ["concludes-by-elimination", "confirms-what-is-alone"])
def test_a_decision_is_judged_by_the_history_before_it_even_after_the_whole_is_read(
    name: str,
) -> None:
    doubted = 0
    for world in worlds(range(1, 4)):
        trace = trace_of(world, FAULTS[name])
        run = ReplayedTrace(world, trace)
        list(claims.map_entailed(run))
        assert run.conclusions == ReplayedTrace(world, trace).conclusions
        doubted += any(conclusion.why for conclusion in run.conclusions.values())
    assert doubted


def test_a_finding_says_whether_a_map_or_a_decision_is_not_proved() -> None:
    doubt = Conclusion(7, "an edge is open")
    (of_map,) = claims.unproved("map-entailed", [doubt])
    (of_decision,) = claims.unproved("decisions-entailed", [doubt])
    assert of_map.message == "the history proves no such map: an edge is open"
    assert of_map.expected == "a map that is proved"
    assert of_decision.message == "the decision does not follow: an edge is open"
    assert of_decision.expected == "a proved decision"


def test_what_is_no_map_and_a_history_of_no_world_are_named_at_their_event() -> None:
    trace = trace_of("m3/14")
    assert map_conclusion(FoldedTrace(trace[:-1])) == Conclusion(0, "no map was delivered")
    when, why, *_ = map_conclusion(FoldedTrace(edited(trace, -1, map=ev.MapData((), (), None))))
    assert (when, why[:32]) == (len(trace) - 1, "the delivered value is not a map")
    third = place(trace, ev.Move, 2)
    when, why, *_ = map_conclusion(FoldedTrace(edited(trace, third, door=99)))
    assert (when, why[:28]) == (third, "no world shows this history:")


@pytest.mark.parametrize(
    "percept", [(0, 0), (1, None), (2, None), (2, 1), (2, 2), (2, -1), (-1, None), (-1, 0)]
)
def test_at_the_start_nothing_is_seen_but_the_marker_at_door_0(
    percept: tuple[int, int | None],
) -> None:
    start = ev.Start(percept=Percept(*percept))
    assert fold_history([start])[1] is not None
    (conclusion,) = decision_conclusions(FoldedTrace([start, ev.Augment(0, "new", 2, 2)]))
    assert (conclusion.when, conclusion.why[:28]) == (0, "no world shows this history:")
    (finding,) = certify([start]).findings
    assert finding.event == 0


@pytest.mark.parametrize("marker", [2, 3, -1, -2])
def test_a_marker_at_a_door_that_is_not_there_proves_nothing(marker: int) -> None:
    log: ev.Trace = (ev.Start(percept=Percept(2, 0)), ev.Move(0, Percept(2, marker)))
    assert fold_history(log)[1] == (
        1,
        f"no place behind a door shows (degree 2, marker at door {marker})",
    )
    assert certify(log).map is None


# ---------------------------------------------------------------- claim 10: rejections


def test_the_witness_against_a_rejection_is_a_world_where_it_rejects_the_truth() -> None:
    told = 0
    for world in worlds([3]):
        trace = trace_of(world)
        for when, _, witness, _ in unproved(rejecting_at_once(trace, "motion")):
            assert witness is not None
            assert_wrong_in(witness, rejecting_at_once(trace, "motion"), when)
            told += 1
    assert told > 100


def rejecting_at_once(trace: ev.Trace, rule: ev.RuleName) -> ev.Trace:
    """The trace, but each hypothesis is rejected as soon as it is posed."""
    events: list[ev.Event] = []
    for event in trace:
        events.append(event)
        if isinstance(event, ev.Pose):
            events += rejections(event, rule)
    return tuple(events)


def rejections(pose: ev.Pose, rule: ev.RuleName) -> Iterator[ev.Reject]:
    nothing = ev.Evidence(0, Percept(1, None), Percept(1, None))
    if rule == "planar":
        nothing = ev.Evidence(0, contradiction="it lies on another face than e")
    for hypothesis in pose.hypotheses:
        yield ev.Reject(pose.edge, hypothesis, rule, nothing)


def assert_wrong_in(witness: World, trace: ev.Trace, when: int) -> None:
    """The witness shows the history up to an event, and the rejection there is false in it."""
    event = trace[when]
    assert isinstance(event, ev.Reject)
    assert shows(witness, [e for e in trace[:when] if isinstance(e, ev.Start | ev.Move)])
    run = ReplayedTrace(witness, trace[: when + 1])
    assert run.rounds[-1].truth == event.hypothesis


def renamed(trace: ev.Trace, old: ev.RuleName, new: ev.RuleName) -> ev.Trace:
    """The trace with another rule in some of its rejections."""
    return tuple(
        ev.Reject(e.edge, e.hypothesis, new, e.evidence)
        if isinstance(e, ev.Reject) and e.rule == old
        else e
        for e in trace
    )


@pytest.mark.no_cover
def test_what_only_planarity_rejects_follows_only_if_planarity_was_declared() -> None:
    told = 0
    for world in worlds([4]):
        if world.is_planar:
            trace = trace_of(world, "folding+planar")
            assert not unproved(trace)
            silent = renamed(trace, "planar", "folding")
            for when, _, witness, _ in unproved(silent):
                assert witness is not None
                assert not witness.is_planar
                assert_wrong_in(witness, silent, when)
                told += 1
    assert told == 5


def test_the_declared_planarity_of_the_world_excuses_no_other_guess() -> None:
    told = 0
    for world in worlds([3]):
        lie = rejecting_at_once(trace_of(world), "planar")
        for when, _, witness, _ in unproved(lie):
            assert witness is not None
            assert witness.is_planar
            assert_wrong_in(witness, lie, when)
            told += 1
    assert told > 100


@pytest.mark.long
@pytest.mark.no_cover
def test_a_dart_is_rejected_by_planarity_just_if_the_edge_would_raise_the_genus_of_s() -> None:
    """Claim 8 walks the face of e; here the darts are joined, and the genus is counted."""
    rejected, raised = 0, 0
    for world in worlds([4]):
        if world.is_planar:
            lie = rejecting_at_once(trace_of(world), "planar")
            unjustified = {f.event for f in check(world, lie)[7].findings}
            for when, event in enumerate(lie):
                if isinstance(event, ev.Reject) and event.rule == "planar":
                    raises = not joined(lie[:when], event.edge, event.hypothesis).is_planar
                    assert (when in unjustified) != raises
                    rejected, raised = rejected + 1, raised + raises
    assert (rejected, raised) == (1909, 65)


def joined(history: ev.Trace, e: int, h: int) -> World:
    """S with two of its darts joined and a leaf on every other open one, from the augmentations."""
    assert isinstance(history[0], ev.Start)
    vertices = [range(history[0].percept.degree)]
    edges = [(e, h)]
    for event in of_type(ev.Augment, history):
        edges.append((event.edge, event.dart))
        if event.kind == "new":
            vertices.append(range(event.dart, event.dart + event.degree))
    darts = sum(map(len, vertices))
    ends = sorted(set(range(darts)) - {dart for edge in edges for dart in edge})
    leaves = range(darts, darts + len(ends))
    return World.from_rotations(
        [*vertices, *([leaf] for leaf in leaves)], [*edges, *zip(ends, leaves, strict=True)], 0
    )


# ---------------------------------------------------------------- claim 10: augmentations


@pytest.mark.parametrize("rule", [None, "planar"])
def test_a_loop_of_s_is_no_new_vertex_in_any_world(rule: ev.RuleName | None) -> None:
    """The world of one vertex on the torus: with the planar prior, no planar world refutes it."""
    world = World.from_id("m2/8")
    assert (len(world.vertices), world.genus) == (1, 1)
    trace = trace_of(world)
    loop = place(trace, ev.Augment)
    lie = edited(trace, loop, kind="new", dart=4)
    if rule is not None:
        lie = inserted(lie, loop + 1, *rejections(ev.Pose(1, (3,)), rule))
    (*_, (when, why, witness, _)) = decision_conclusions(FoldedTrace(lie))
    assert (when, why) == (loop, "the edge leads to another vertex")
    assert witness is not None
    assert witness.is_isomorphic(World.from_id("m2/8")) or shows(witness, lie[:loop])


def test_a_vertex_of_s_is_no_new_vertex_where_s_has_others_too() -> None:
    lie = edited(TRACE, LOOP, kind="new", dart=8)
    (*_, last) = decision_conclusions(FoldedTrace(lie))
    assert (last.when, last.why) == (LOOP, "the edge leads to another vertex")


@pytest.mark.parametrize(("degree", "witness"), [(1, "m2/0"), (2, "m1/0"), (3, "m1/0")])
def test_behind_an_edge_that_was_never_crossed_stands_the_least_that_was_not_claimed(
    degree: int, witness: str
) -> None:
    start = ev.Start(percept=first_percept(World.from_id("m1/0")))
    (told,) = decision_conclusions(FoldedTrace([start, ev.Augment(0, "new", 1, degree)]))
    assert (told.when, told.why) == (1, "the edge was never crossed")
    assert told.witness is not None
    assert told.witness.code == World.from_id(witness).code


def test_an_edge_that_s_has_is_not_explored_again() -> None:
    repeated = 0
    for world in worlds([2]):
        trace = trace_of(world)
        for event in of_type(ev.Augment, trace):
            after = trace.index(event) + 1
            repetitions: ev.Trace = (
                ev.Augment(event.edge, "loop", event.dart, event.degree),
                ev.Confirm(event.dart, event.edge, "motion"),
                *rejections(ev.Pose(event.edge, (event.dart,)), "motion"),
            )
            for again in repetitions:
                lie = inserted(trace, after, again)
                (*_, wrong) = [c for c in decision_conclusions(FoldedTrace(lie)) if c.why]
                assert wrong.when == after
                assert "is not an unexplored dart of S" in wrong.why
                repeated += 1
    assert repeated > 20


def test_after_an_augmentation_that_does_not_follow_nothing_is_judged() -> None:
    trace = trace_of("m4/300")
    for when in (i for i, event in enumerate(trace) if isinstance(event, ev.Augment)):
        (*before, last) = decision_conclusions(FoldedTrace(edited(trace, when, degree=9)))
        assert last.when == when
        assert last.why in (
            "the edge leads to another vertex",
            "the vertex there has another degree",
        )
        assert last.witness is not None
        assert shows(last.witness, [e for e in trace[:when] if isinstance(e, ev.Start | ev.Move)])
        assert not any(conclusion.why for conclusion in before)


# ---------------------------------------------------------------- how far it is asked


def star(leaves: int) -> World:
    """A vertex and its leaves."""
    rim = range(leaves, 2 * leaves)
    return World.from_rotations(
        [range(leaves), *([dart] for dart in rim)], zip(range(leaves), rim, strict=True), 0
    )


@pytest.mark.parametrize("edges", [100, 101])
def test_beyond_a_size_claim_10_and_no_other_is_not_asked(
    edges: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert claims.LARGE == 2000  # too long for a test
    monkeypatch.setattr(claims, "LARGE", 100)
    world = star(edges)
    verdict = statuses(world, trace_of(world))
    assert verdict.pop("decisions-entailed") == ("ok" if edges == 100 else "not-asked")
    assert set(verdict.values()) == {"ok"}
