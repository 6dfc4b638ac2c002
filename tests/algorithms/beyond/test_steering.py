"""Mappers that steer by the fold of their history: sound whatever they choose, and they end."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.helpers import any_world, fits, worlds
from topo_verify import InputError, World, examine, explore, families
from topo_verify.algorithms import CATALOGUE, NAMED, STEERED
from topo_verify.algorithms.beyond import steering
from topo_verify.algorithms.beyond.folding import NodeDart
from topo_verify.algorithms.beyond.history import History
from topo_verify.algorithms.beyond.homing import most_telling_door
from topo_verify.algorithms.beyond.next_edge import nearest_edge
from topo_verify.algorithms.chart import Survey
from topo_verify.campaign.judge import Report
from topo_verify.campaign.targets import targets, text_of
from topo_verify.robot.events import MapDart, Robot
from topo_verify.robot.percept import Purpose
from topo_verify.world.resolve import resolve_world

Mapper = Callable[[Robot], Survey]


def families_world(text: str) -> World:
    """The world of a family that is called so."""
    return resolve_world(f"family:{text}")


LARGER = ["lattice(5,5,holes=0.2,seed=3)", "king(4,4,seed=1)", "torus(4,4)", "regular(10,4,seed=2)"]


def first_dart(history: History, _: MapDart) -> NodeDart:
    """Back and forth for ever, at a place with one door; anything but clever elsewhere."""
    return history.places.darts(history.places.place(history.at))[0]


def back(history: History, _: MapDart) -> NodeDart:
    """The way it came: a pendulum."""
    return history.places.resolve(history.at)


def drawn(random: Random) -> Mapper:
    """A mapper that draws every edge and every door."""

    def door(history: History, _: MapDart) -> NodeDart:
        return random.choice(history.places.darts(history.places.place(history.at)))

    def edge(history: History) -> MapDart:
        return random.choice(list(history.chart.unexplored))

    return partial(steering.explore, edge=edge, door=door)


SILLY: dict[str, Mapper] = {
    "first dart": partial(steering.explore, edge=nearest_edge, door=first_dart),
    "pendulum": partial(steering.explore, edge=nearest_edge, door=back),
}


def every_claim_holds(report: Report) -> bool:
    """All ten, each about everything that there was to judge."""
    return set(report.claims.values()) == {"ok"}


# ---------------------------------------------------------------- sound by construction


@pytest.mark.no_cover
@pytest.mark.parametrize(
    ("name", "text"),
    [(name, text) for name in STEERED for text in LARGER if fits(name, families_world(text))],
)
def test_every_claim_holds_in_larger_worlds(name: str, text: str) -> None:
    report = examine(STEERED[name], families_world(text))
    assert every_claim_holds(report), str(report)


@pytest.mark.long
@pytest.mark.parametrize("name", [name for name in STEERED if STEERED[name].assumes is None])
@given(world=any_world(max_edges=12))
def test_every_claim_holds_in_worlds_drawn(name: str, world: World) -> None:
    report = examine(STEERED[name], world)
    assert every_claim_holds(report), str(report)


@pytest.mark.no_cover
@given(world=any_world(max_edges=7), random=st.randoms(use_true_random=False))
def test_no_choice_of_edges_and_doors_breaks_a_claim(world: World, random: Random) -> None:
    report = examine(drawn(random), world)
    # A mapper that draws takes other doors in the worlds that claim 9 would try, if it failed.
    assert every_claim_holds(report), str(report)


@pytest.mark.parametrize("name", SILLY)
def test_silly_doors_break_no_claim_in_any_small_world(name: str) -> None:
    for world in worlds(range(1, 4)):
        report = examine(SILLY[name], world)
        assert every_claim_holds(report), str(report)


# ---------------------------------------------------------------- it ends


def counted(door: steering.NextDoor, runs: list[int]) -> steering.NextDoor:
    """The same policy; notes after each of its moves how many it made with no edge settled."""
    last = [-1]

    def counts(history: History, e: MapDart) -> NodeDart:
        if history.settled != last[0]:
            last[0] = history.settled
            runs.append(0)
        runs[-1] += 1
        return door(history, e)

    return counts


@pytest.mark.parametrize("door", [back, first_dart, most_telling_door])
def test_patience_ends_every_round(
    door: steering.NextDoor, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(steering, "PATIENCE", 7)
    runs: list[int] = []
    mapper = partial(steering.explore, edge=nearest_edge, door=counted(door, runs))
    assert examine(mapper, families.torus(3, 3)).ok
    assert max(runs) <= 7


def watched_ways(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[list[int]]]:
    """How many hypotheses are left before each way home, a list for each edge settled so."""
    settle, walk_home = steering.settle_by_ways_home, steering.walk_home
    left: list[int] = []

    def walks(history: History, e: MapDart, h: MapDart) -> None:
        left.append(len(list(history.hypotheses(e))))
        walk_home(history, e, h)

    found: list[list[int]] = []

    def settles(history: History, e: MapDart) -> None:
        left.clear()
        settle(history, e)
        assert e not in history.crossed
        found.append(list(left))

    monkeypatch.setattr(steering, "walk_home", walks)
    monkeypatch.setattr(steering, "settle_by_ways_home", settles)
    for text in LARGER:
        explore(families_world(text), SILLY["pendulum"])
        yield found


@pytest.mark.no_cover
def test_each_way_home_leaves_fewer_hypotheses(monkeypatch: pytest.MonkeyPatch) -> None:
    for rounds in watched_ways(monkeypatch):
        assert max(map(len, rounds)) > 1
        for left in rounds:
            assert all(one > other for one, other in pairwise(left))


def test_a_way_home_leads_over_what_was_never_crossed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(steering, "PATIENCE", 0)
    seen: list[bool] = []
    move = History.move

    def moves(history: History, exit_dart: NodeDart, purpose: Purpose = "walk") -> None:
        if purpose == "validate":
            seen.append(history.places.across(exit_dart) is not None)
        move(history, exit_dart, purpose)

    monkeypatch.setattr(History, "move", moves)
    assert examine("homing", families.torus(4, 4)).ok
    assert len(seen) > 16
    assert not any(seen)


@pytest.mark.no_cover
@pytest.mark.parametrize("door", [back, first_dart])
def test_the_bound_ends_every_run_even_without_patience(
    door: steering.NextDoor, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(steering, "PATIENCE", 10**9)
    mapper = partial(steering.explore, edge=nearest_edge, door=door)
    for world in [*worlds(range(1, 4)), families.torus(2, 3), families.lattice(3, 3)]:
        report = examine(mapper, world)
        assert every_claim_holds(report), str(report)


def always(_: History) -> bool:
    """In place of the look at the bound: there is always enough left."""
    return True


def test_without_both_rules_a_pendulum_swings_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(steering, "PATIENCE", 10**9)
    monkeypatch.setattr(steering, "affords", always)
    report = examine(SILLY["pendulum"], families.lattice(3, 3))
    assert [finding.claim for finding in report.findings] == ["map-isomorphic"]
    assert "move" in str(report.findings[0].message)


def test_in_the_families_no_round_of_homing_runs_out(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(history: History, e: MapDart) -> None:
        raise AssertionError(f"edge {e} is settled by ways home, at cost {history.cost}")

    monkeypatch.setattr(steering, "settle_by_ways_home", never)
    for name in STEERED:
        assert explore(families.lattice(6, 6, holes=0.2, seed=1), name).cost


def test_no_walk_to_the_next_edge_begins_among_its_ghosts(monkeypatch: pytest.MonkeyPatch) -> None:
    began: list[tuple[bool, bool]] = []
    reach = steering.reach

    def watched(history: History, e: MapDart) -> None:
        began.append((history.in_s(), history.beside(e)))
        reach(history, e)

    monkeypatch.setattr(steering, "reach", watched)
    for name in STEERED:
        assert explore(families.lattice(6, 6, holes=0.2, seed=1), name).cost
    assert set(began) == {(True, False)}


# ---------------------------------------------------------------- in the catalogue


def test_they_have_names_and_all_leaves_them_out() -> None:
    assert list(NAMED) == [*CATALOGUE, *STEERED]
    assert not STEERED.keys() & {target.text for target in targets("all")}
    for name, mapper in STEERED.items():
        (target,) = targets(name)
        assert (target.text, target.mapper) == (name, mapper)
        assert text_of(mapper) == name
        assert repr(mapper) == f"<Steered {name!r}>"


def test_one_that_is_not_of_the_catalogue_does_not_pass_for_one() -> None:
    mine = type(STEERED["homing"])("homing", STEERED["homing"])
    assert text_of(mine) == "<homing>"


def test_they_have_no_policies_to_choose() -> None:
    with pytest.raises(InputError, match="homing has no policies"):
        targets("homing", pick="last")
