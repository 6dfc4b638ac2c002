"""Darts of the world and darts of S are two types: every mix-up below is an error of types.

Each line with `type: ignore` plants one. mypy and pyright, both strict, refuse an ignore that has
nothing to ignore: should one of them let a mix-up pass, the check of types fails here.
"""

from __future__ import annotations

from topo_verify import World
from topo_verify.checkers.darts import KnownDart, WorldDart
from topo_verify.checkers.excursions import Records
from topo_verify.checkers.folding import Fold
from topo_verify.checkers.map_in_world import MapInWorld
from topo_verify.checkers.map_on_fold import MapOnFold
from topo_verify.robot.events import Augment, Confirm
from topo_verify.robot.simulator import first_percept

WORLD = World.from_id("m2/4")
IN_WORLD, ON_FOLD = MapInWorld(WORLD), MapOnFold(Fold(first_percept(WORLD)))
OF_S, OF_WORLD = KnownDart(0), IN_WORLD.phi[KnownDart(0)]


def a_dart_of_the_world_is_not_a_dart_of_s() -> None:
    IN_WORLD.end(OF_WORLD)  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    IN_WORLD.turn(OF_WORLD, 1)  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    IN_WORLD.phi[OF_WORLD]  # type: ignore[index]  # pyright: ignore[reportArgumentType]
    IN_WORLD.alpha[OF_WORLD] = OF_S  # type: ignore[index]  # pyright: ignore[reportArgumentType]
    ON_FOLD.face(OF_WORLD)  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    ON_FOLD.places[OF_WORLD]  # type: ignore[index]  # pyright: ignore[reportArgumentType]
    Records(IN_WORLD).behind(OF_WORLD, (), 1)  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]


def a_dart_of_s_is_not_a_dart_of_the_world() -> None:
    IN_WORLD.seen_at(OF_S)  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    IN_WORLD.beyond(OF_S, 0)  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    IN_WORLD.number[OF_S]  # type: ignore[index]  # pyright: ignore[reportArgumentType]
    IN_WORLD.phi[OF_S] = OF_S  # type: ignore[assignment]  # pyright: ignore[reportArgumentType]


def the_two_are_never_equal() -> bool:
    return IN_WORLD.end(OF_S) == OF_S  # type: ignore[comparison-overlap]


def a_number_of_an_event_is_neither(event: Augment | Confirm) -> None:
    IN_WORLD.end(event.edge)  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    IN_WORLD.seen_at(event.edge)  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    ON_FOLD.places[event.edge]  # type: ignore[index]  # pyright: ignore[reportArgumentType]


def a_number_is_a_dart_of_s_once_s_is_found_to_have_it(event: Augment | Confirm) -> None:
    if IN_WORLD.is_open(event.edge, 1):
        IN_WORLD.end(event.edge)
    if ON_FOLD.is_open(event.edge):
        ON_FOLD.places[event.edge]


def test_the_types_cost_nothing_when_the_program_runs() -> None:
    assert type(OF_S) is int
    assert type(OF_WORLD) is int
    assert type(WorldDart(3)) is int
    assert IN_WORLD.is_open(0, 1)
    assert not IN_WORLD.is_open(99, 1)
