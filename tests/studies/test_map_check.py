"""A map and a log: refuted, proved, or a way on that proves it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.helpers import EMPTY, any_world, path, some, trace_of, typed, worlds
from tests.world.test_least_cost import shape, walked
from topo_verify import World, families
from topo_verify.errors import InputError
from topo_verify.robot.events import Move, Start, Trace
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import first_percept, percepts
from topo_verify.studies.log_report import certify
from topo_verify.studies.map_check import check_map, moves, tour_log


def log_of(world: World, doors: tuple[int, ...]) -> Trace:
    """The log of a robot that takes these doors."""
    return Start(percept=first_percept(world)), *moves(world, world.root or 0, doors)


def walks(world: World, longest: int) -> Iterator[tuple[int, ...]]:
    """The doors of every walk of at most so many moves."""
    walk: list[tuple[int, ...]] = [()]
    for doors in walk:  # grows as it goes
        yield doors
        if len(doors) < longest:
            _, at, _ = walked(world, doors)
            walk += [(*doors, door) for door in range(percepts(world)[at].degree)]


def cheapest_way_on(world: World, doors: tuple[int, ...], most: int) -> int | None:
    """The fewest moves behind these doors that close the fold, if they are at most `most`."""
    seen: set[object] = set()
    frontier = [doors]
    for cost in range(most + 1):
        following: list[tuple[int, ...]] = []
        for walk in frontier:
            fold, at, _ = walked(world, walk)
            if not fold.open_darts():
                return cost
            for door in range(percepts(world)[at].degree):
                state = shape(walked(world, (*walk, door))[0])
                if state not in seen:
                    seen.add(state)
                    following.append((*walk, door))
        frontier = following
    return None


def excess(world: World, longest: int) -> Iterator[int]:
    """Over every log that leaves the map open: how many moves the way on is over the cheapest."""
    for doors in walks(world, longest):
        found = check_map(world, log_of(world, doors))
        if found.verdict == "UNKNOWN":
            cheapest = some(cheapest_way_on(world, doors, len(found.doors)))
            yield len(found.doors) - cheapest


def test_after_the_start_alone_the_way_on_is_the_tour() -> None:
    for world in worlds(range(5)):
        found = check_map(world, log_of(world, ()))
        assert len(found.doors) == world.least_cost()
        assert len(found.unproved) == len(world.edges)


@pytest.mark.nightly
@pytest.mark.parametrize("edges", [1, 2, 3])
def test_the_way_on_proves_the_map_behind_every_log(edges: int) -> None:
    for world in worlds([edges]):
        for doors in walks(world, 3):
            log = log_of(world, doors)
            found = check_map(world, log)
            proof = certify((*log, *found.onward))
            assert some(proof.map).code == world.code
            assert (found.verdict == "PROVED") == (not found.onward) == (not found.unproved)
            assert (found.verdict == "PROVED") == (certify(log).map is not None)


@pytest.mark.long
@given(any_world(max_edges=15), st.data())
def test_the_way_on_proves_larger_maps_behind_any_log(world: World, data: st.DataObject) -> None:
    at, doors = world.root or 0, list[int]()
    for _ in range(data.draw(st.integers(0, 30))):
        doors.append(data.draw(st.integers(0, percepts(world)[at].degree - 1)))
        at = walked(world, tuple(doors))[1]
    log = log_of(world, tuple(doors))
    proof = certify((*log, *check_map(world, log).onward))
    assert some(proof.map).code == world.code


@pytest.mark.parametrize(
    ("edges", "longest"), [(1, 4), (2, 3), pytest.param(3, 3, marks=pytest.mark.nightly)]
)
@pytest.mark.no_cover
def test_behind_short_logs_the_way_on_is_the_cheapest(edges: int, longest: int) -> None:
    for world in worlds([edges]):
        assert set(excess(world, longest)) <= {0}, world


@pytest.mark.no_cover
def test_behind_some_logs_a_cheaper_way_is_missed() -> None:
    found = Counter(more for world in worlds([2]) for more in excess(world, 4))
    assert found == {0: 338, 1: 2}
    doors = (0, 1, 2, 2)
    assert 1 in excess(World.from_id("m2/1"), 4)
    assert cheapest_way_on(World.from_id("m2/1"), doors, 4) == 3
    assert len(check_map(World.from_id("m2/1"), log_of(World.from_id("m2/1"), doors)).doors) == 4


def test_a_loop_that_follows_from_the_others_is_not_walked() -> None:
    # Two loops at a vertex behind v0: the log went down, through both, and home.
    world = World.from_rotations([[0], [1, 2, 3, 4, 5]], [[0, 1], [2, 3], [4, 5]], 0)
    found = check_map(world, log_of(world, (0, 1, 1, 1)))
    assert found.unproved == ((2, 3), (4, 5))
    assert len(found.doors) == 3


def test_in_a_tree_the_robot_goes_on_where_it_stands() -> None:
    world = path(6, marker=0)
    found = check_map(world, log_of(world, (0, 1, 1)))
    assert found.doors == (1, 1)
    assert found.unproved == ((6, 7), (8, 9))


def test_the_first_event_that_the_map_does_not_show_refutes_it() -> None:
    world = World.from_id("m4/300")
    log = list(tour_log(world))
    for when in range(1, len(log)):
        event = typed(Move, log[when])
        wrong = msgspec.structs.replace(event, percept=Percept(event.percept.degree + 1, None))
        found = check_map(world, [*log[:when], wrong, *log[when + 1 :], Move(0, Percept(9, None))])
        assert (found.verdict, found.event) == ("REFUTED", when)
        assert str(wrong.percept) in found.message
        assert not found.onward
        assert not found.unproved


def test_a_door_that_the_map_does_not_have_refutes_it() -> None:
    world = path(3, marker=0)
    found = check_map(world, (*log_of(world, (0,)), Move(2, Percept(1, None))))
    assert (found.verdict, found.event) == ("REFUTED", 2)
    assert "doors 0 to 1 there, and the log takes door 2" in found.message


def test_a_tour_of_another_map_refutes_this_one_or_proves_it() -> None:
    some = list(worlds([3]))[::5]
    for one in some:
        for other in some:
            verdict = check_map(one, tour_log(other)).verdict
            assert verdict == ("PROVED" if one == other else "REFUTED")


def test_the_world_without_a_dart_is_proved_by_its_start() -> None:
    assert check_map(EMPTY, tour_log(EMPTY)).verdict == "PROVED"


def test_what_a_mapper_declared_does_not_count() -> None:
    trace = trace_of("m3/20", "basic")
    assert check_map(World.from_id("m3/20"), trace).verdict == "PROVED"
    assert check_map(World.from_id("m3/20"), trace[:6]).verdict == "UNKNOWN"


def test_a_log_that_does_not_begin_with_its_start_is_refused() -> None:
    with pytest.raises(InputError, match="begins with its only 'start'"):
        check_map(World.from_id("m1/0"), [Move(0, Percept(1, None))])


def test_large_maps_have_a_way_on() -> None:
    world = families.lattice(8, 8, holes=0.2, seed=2)
    log = tour_log(world)[:100]
    found = check_map(world, log)
    # What was walked so far is a part of a cheapest proof, and so is the way on.
    assert len(found.doors) + 99 <= world.least_cost() + 2
    assert 0 < len(found.unproved) < len(world.edges)
