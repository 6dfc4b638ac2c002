"""The complete rule: it rejects what no world allows, and nothing else."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.helpers import any_world, of_type, some, trace_of, worlds
from topo_verify import World, examine, explore, families
from topo_verify.algorithms.beyond.folding import PartialFold
from topo_verify.checkers import Fold, decision_conclusions
from topo_verify.checkers.entailment import FoldedTrace
from topo_verify.checkers.folding import Contradiction
from topo_verify.robot.events import Augment, Confirm, Event, Move, Pose, Reject, Start, Trace
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import SimulatedRobot


def kept_hypotheses(trace: Trace) -> list[tuple[int, int, int]]:
    """(event, e, h): the hypotheses that are left when the robot sets out behind an edge."""
    kept: list[tuple[int, int, int]] = []
    edge, alive = -1, list[int]()
    for when, event in enumerate(trace):
        match event:
            case Pose(edge, hypotheses):
                alive = list(hypotheses)
            case Reject(_, hypothesis):
                alive.remove(hypothesis)
            case Move(_, _, "validate" | "retrace") if not isinstance(trace[when - 1], Move):
                kept += [(when, edge, h) for h in alive]
            case _:
                pass
    return kept


def seats(trace: Trace, until: int) -> tuple[Fold, dict[int, tuple[int, int]]]:
    """The fold of the events before `until`, and where the darts of S are in it."""
    assert isinstance(trace[0], Start)
    fold = Fold(trace[0].percept)
    place = {dart: (0, dart) for dart in range(fold.degree(0))}
    for event in trace[:until]:
        if isinstance(event, Move):
            fold.move(event.door, event.percept)
        elif isinstance(event, Augment) and event.kind == "new":
            entry = some(fold.partner(place[event.edge]))
            place |= {event.dart + k: (entry[0], entry[1] + k) for k in range(event.degree)}
    return fold, place


def assert_complete(world: World) -> None:
    """Every hypothesis that `folding` keeps is true in some world that shows the whole history."""
    trace = trace_of(world, "folding")
    for when, e, h in kept_hypotheses(trace):
        fold, place = seats(trace, when)
        if any(fold.contradictions(place[e], place[h], ())):
            pytest.fail(f"{world}: {h} is kept for {e} at event {when}, but no world allows it")
        fold.join(place[e], place[h])
        witness = fold.world()
        robot = SimulatedRobot(witness, budget=when)
        history: list[Event] = [x for x in trace[:when] if isinstance(x, Move)]
        assert all(isinstance(x, Move) and robot.move(x.door) == x.percept for x in history)


@pytest.mark.parametrize("edges", [1, 2, 3, pytest.param(4, marks=pytest.mark.nightly)])
def test_what_is_kept_has_a_witness_in_every_small_world(edges: int) -> None:
    for world in worlds([edges]):
        assert_complete(world)


@pytest.mark.nightly
@pytest.mark.no_cover
@given(any_world(max_edges=16))
def test_what_is_kept_has_a_witness_in_larger_worlds(world: World) -> None:
    assert_complete(world)


def test_what_is_kept_has_a_witness_in_a_lattice() -> None:
    assert_complete(families.lattice(5, 5, holes=0.2, seed=3))


NONSENSE = st.lists(
    st.tuples(st.integers(0, 3), st.integers(1, 4), st.none() | st.integers(0, 3)), max_size=25
)


def both(moves: Sequence[tuple[int, Percept]], first: Percept) -> tuple[list[bool], list[bool]]:
    """At which moves the fold of the checkers and the partial of the rule meet a contradiction."""
    fold, partial = Fold(first), PartialFold()
    start = at = partial.add(first, known=True)
    theirs, ours = [False], [False]
    for door, percept in moves:
        try:
            fold.move(door, percept)
        except Contradiction:
            theirs.append(True)
        else:
            theirs.append(False)
        here = partial.add(percept)
        wrong = partial.join(partial.turn(at, door), here)
        if not wrong and percept.marker is not None:
            v0 = partial.turn(start, first.marker or 0)
            wrong = partial.identify(partial.turn(here, percept.marker), v0)
        at = here
        ours.append(bool(wrong))
        if theirs[-1] or ours[-1]:
            break
    return theirs, ours


@pytest.mark.no_cover
@given(st.integers(1, 4), NONSENSE)
def test_the_two_foldings_agree_on_nonsense(
    degree: int, drawn: list[tuple[int, int, int | None]]
) -> None:
    seen = Percept(degree, 0)
    moves: list[tuple[int, Percept]] = []
    at = seen
    for door, ways, marker in drawn:
        percept = Percept(ways, None if marker is None else marker % ways)
        moves.append((door % at.degree, percept))
        at = percept
    theirs, ours = both(moves, seen)
    assert theirs == ours


@given(any_world(max_edges=12), st.lists(st.integers(0, 23), max_size=40), st.integers(0, 40))
def test_the_two_foldings_agree_on_a_walk_with_one_lie(
    world: World, doors: list[int], lie: int
) -> None:
    robot = SimulatedRobot(world, budget=len(doors))
    first, moves = robot.percept, list[tuple[int, Percept]]()
    for number, door in enumerate(doors):
        taken = door % robot.percept.degree
        percept = robot.move(taken)
        moves.append((taken, Percept(percept.degree, 0) if number == lie else percept))
    theirs, ours = both(moves, first)
    assert theirs == ours


@pytest.mark.nightly
def test_all_claims_hold_in_every_world_with_five_edges() -> None:
    for world in worlds([5]):
        assert set(examine("folding", world).claims.values()) == {"ok"}


@pytest.mark.no_cover
def test_it_concludes_without_motion_what_is_left_alone() -> None:
    confirmed = [
        confirm
        for world in worlds([4])
        for confirm in of_type(Confirm, trace_of(world, "folding"))
        if confirm.rule == "folding"
    ]
    assert confirmed


@pytest.mark.no_cover
def test_it_agrees_with_the_checker_at_every_rejection() -> None:
    for world in worlds(range(1, 5)):
        assert not [
            c for c in decision_conclusions(FoldedTrace(trace_of(world, "folding"))) if c.why
        ]


def test_a_hypothesis_that_is_kept_is_not_folded_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """In this lattice 3,337 layers; 4,565 if each test began anew."""
    layers = 0
    layer = PartialFold.layer

    def counted(fold: PartialFold) -> PartialFold:
        nonlocal layers
        layers += 1
        return layer(fold)

    monkeypatch.setattr(PartialFold, "layer", counted)
    explore(families.lattice(12, 12), "folding")
    assert layers < 4_000


def test_contradictions_of_the_sketch() -> None:
    partial = PartialFold()
    known = partial.add(Percept(3, None), known=True)
    other = partial.add(Percept(3, None), known=True)
    ghost = partial.add(Percept(2, None))
    marked = partial.add(Percept(3, 0), known=True)
    assert "own other end" in partial.join(known, partial.turn(known, 3))
    assert "vertices of S" in partial.identify(known, partial.turn(other, 1))
    assert "degrees" in partial.identify(known, ghost)
    assert "degrees" in partial.identify(known, marked)
    assert "turned" in partial.identify(known, partial.turn(known, 1))
    assert partial.identify(partial.turn(known, 2), partial.turn(known, 5)) == ""


def test_a_layer_leaves_what_is_below_as_it_is() -> None:
    partial = PartialFold()
    known = partial.add(Percept(2, None), known=True)
    ghost, end = partial.add(Percept(2, None)), partial.add(Percept(1, None))
    assert partial.join(partial.turn(ghost, 1), end) == ""
    assert partial.layer().identify(known, ghost) == ""
    assert partial.resolve(ghost) == ghost
    assert partial.across(partial.turn(known, 1)) == 0


def test_a_layer_follows_what_is_joined_below() -> None:
    partial = PartialFold()
    known = partial.add(Percept(2, None), known=True)
    ghost, end, wide = (partial.add(Percept(degree, None)) for degree in (2, 1, 3))
    layer = partial.layer()
    assert layer.identify(known, ghost) == ""
    assert partial.join(partial.turn(ghost, 1), end) == ""
    assert layer.follow() == ""
    assert layer.across(partial.turn(known, 1)) == end
    assert partial.join(partial.turn(known, 1), wide) == ""
    assert "degrees" in (layer.follow() or "")


def test_a_layer_is_lost_only_when_places_change_below_that_it_changes_too() -> None:
    partial = PartialFold()
    known = partial.add(Percept(2, None), known=True)
    ghost, one, other = (partial.add(Percept(2, None)) for _ in range(3))
    layer, empty = partial.layer(), partial.layer()
    assert layer.identify(ghost, known) == ""
    assert partial.identify(one, other) == ""
    assert layer.follow() == ""
    assert layer.resolve(one) == partial.resolve(one)
    partial.know(ghost)
    assert layer.follow() is None
    assert empty.follow() == ""


def test_an_end_foretold_wrongly_after_another_change_is_folded_anew() -> None:
    partial = PartialFold()
    known = partial.add(Percept(2, None), known=True)
    ghost, end, one, other = (partial.add(Percept(degree, None)) for degree in (2, 1, 2, 2))
    assert partial.join(partial.turn(ghost, 1), end) == ""
    layer = partial.layer()
    assert layer.identify(known, ghost) == ""
    assert partial.identify(one, other) == ""
    assert partial.join(partial.turn(known, 1), partial.add(Percept(3, None))) == ""
    assert layer.follow() is None


def test_a_contradiction_below_leaves_what_was_seen_as_it_was() -> None:
    partial = PartialFold()
    one, other = partial.add(Percept(2, None)), partial.add(Percept(2, None))
    for place, degree in ((one, 1), (other, 3)):
        assert partial.join(partial.turn(place, 1), partial.add(Percept(degree, None))) == ""
    assert "degrees" in partial.identify(one, other)
    assert partial.resolve(one) == one
    assert partial.resolve(other) == other
