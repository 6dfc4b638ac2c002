"""A mapper may walk first and decide later: late poses are judged like any other decision."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import given

from tests.checkers.second_opinion import failing_claims
from tests.helpers import any_world, edited, of_type, place, worlds
from topo_verify import World, families
from topo_verify.checkers import check
from topo_verify.checkers.darts import KnownDart
from topo_verify.checkers.folding import Fold, Place
from topo_verify.checkers.map_on_fold import MapOnFold
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import SimulatedRobot


def walked(world: World) -> tuple[ev.Trace, Fold]:
    """The start and the moves of the world's proof tour, and what they prove."""
    robot = SimulatedRobot(world, world.cost_bound)
    start, moves, fold = ev.Start(percept=robot.percept), list[ev.Move](), Fold(robot.percept)
    for door in world.proof_tour():
        moves.append(ev.Move(door, robot.move(door)))
        fold.move(door, robot.percept)
    return (start, *moves), fold


class Decider(MapOnFold):
    """Declares, for a closed fold, where each edge leads."""

    def look(self, place: Place) -> tuple[int, bool]:
        """The signature of a place."""
        node, _ = self.fold.find(place)
        return self.fold.degree(node), node == self.fold.find((0, 0))[0]

    def decisions(self) -> Iterator[ev.Decision]:
        """The poses, least dart first, each with its rejections or its confirmation; S grows."""
        while darts := [d for d in range(len(self.places)) if self.is_open(d)]:
            yield from self.decided(KnownDart(darts[0]))

    def decided(self, e: KnownDart) -> Iterator[ev.Decision]:
        """What is declared of one edge."""
        end = self.fold.partner(self.places[e])
        assert end is not None
        alike = [h for h in self.others(e) if self.look(self.places[h]) == self.look(end)]
        yield ev.Pose(e, tuple(alike))
        true = [h for h in alike if self.fold.find(self.places[h]) == self.fold.find(end)]
        if true:
            yield ev.Confirm(e, true[0], "folding")
            grown = ev.Augment(e, "loop", true[0], self.look(end)[0])
        else:
            for h in alike:
                met = self.fold.contradictions(self.places[e], self.places[h], self.entries)
                yield ev.Reject(e, h, "folding", ev.Evidence(0, contradiction=next(met)[0]))
            grown = ev.Augment(e, "new", len(self.places), self.look(end)[0])
        yield grown
        self.grow(grown)


def decided_at_the_end(world: World) -> ev.Trace:
    """The trace of a robot that walks the proof tour, and then declares every decision."""
    log, fold = walked(world)
    decisions = [*Decider(fold).decisions()] if world.alpha else []
    grown = of_type(ev.Augment, decisions)
    firsts = [(0, world.degrees[world.marker_vertex])]
    firsts += [(one.dart, one.degree) for one in grown if one.kind == "new"]
    vertices = tuple(tuple(range(first, first + degree)) for first, degree in firsts)
    edges = tuple((one.edge, one.dart) for one in grown)
    return (*log, *decisions, ev.Finish(len(log) - 1, ev.MapData(vertices, edges, 0)))


@pytest.mark.no_cover
def test_every_claim_holds_and_is_fully_judged_of_what_is_decided_at_the_end() -> None:
    for world in [*worlds(range(1, 5)), families.lattice(4, 4), families.torus(3, 3)]:
        for judgement in check(world, decided_at_the_end(world)):
            assert judgement.status == "ok", (world, judgement)
            assert judgement.judged == judgement.of


@given(any_world(max_edges=12))
def test_a_second_opinion_finds_nothing_wrong_either(world: World) -> None:
    assert not failing_claims(world, decided_at_the_end(world))


LATTICE = families.lattice(4, 4)
LATE = decided_at_the_end(LATTICE)


def wrong(trace: ev.Trace) -> set[str]:
    """The claims that fail in the lattice."""
    return {judgement.claim for judgement in check(LATTICE, trace) if judgement.findings}


def test_an_edge_is_not_posed_before_it_is_crossed() -> None:
    last = place(LATE, ev.Move, -1)
    pose = place(LATE, ev.Pose, -1)
    early = (*LATE[:last], LATE[pose], *LATE[last:pose], *LATE[pose + 1 :])
    assert "true-hypothesis-posed" in wrong(early)


def test_the_true_hypothesis_is_not_left_out_of_a_late_pose() -> None:
    when = place(LATE, ev.Confirm) - 1
    pose = LATE[when]
    assert isinstance(pose, ev.Pose)
    assert wrong(edited(LATE, when, hypotheses=())) == {"true-hypothesis-posed"}


def test_moves_after_a_late_pose_are_no_moves_behind_its_edge() -> None:
    """The robot goes on and cites what it sees there as if it had walked there from the edge."""
    reject = place(LATE, ev.Reject)
    event = LATE[reject]
    assert isinstance(event, ev.Reject)
    robot = SimulatedRobot(LATTICE, LATTICE.cost_bound)
    for move in of_type(ev.Move, LATE):
        robot.move(move.door)
    seen = robot.move(0)
    for expected in (Percept(1, None), Percept(2, None), Percept(3, None), Percept(4, None)):
        evidence = ev.Evidence(1, expected, seen)
        lie = (
            *LATE[:reject],
            ev.Move(0, seen),
            ev.Reject(event.edge, event.hypothesis, "motion", evidence),
            *LATE[reject + 1 : -1],
            edited(LATE, len(LATE) - 1, cost=LATTICE.least_cost() + 1)[-1],
        )
        assert wrong(lie) == {"rejection-justified"}
