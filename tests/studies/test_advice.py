"""Advice for an incomplete log ends: who follows it proves the map, at about the cost of homing."""

from __future__ import annotations

from random import Random

import pytest

import topo_verify as tv
from tests.helpers import some
from topo_verify.robot.events import Event, Start
from topo_verify.robot.percept import Door
from topo_verify.robot.simulator import exit_dart, first_percept
from topo_verify.studies import advice as adviser
from topo_verify.studies.log_report import certify, open_doors
from topo_verify.studies.map_check import moves
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.rooted_map import World


class Walker:
    """A robot in a world that writes a log."""

    def __init__(self, world: World) -> None:
        self.world, self.at = world, world.root or 0
        self.log: list[Event] = [Start(percept=first_percept(world))]

    def go(self, doors: tuple[Door, ...]) -> None:
        self.log += moves(self.world, self.at, doors)
        for door in doors:
            self.at = self.world.alpha[exit_dart(self.world, self.at, door)]

    def stray(self, steps: int, random: Random) -> None:
        for _ in range(steps):
            self.go((random.randrange(self.world.degrees[self.world.vertex_of[self.at]]),))

    def follow(self) -> int:
        """Follow the advice until there is none; return the number of moves since."""
        before = len(self.log)
        most = 2 * self.world.cost_bound
        while (way := certify(self.log).advice) is not None:
            self.go(way.walk)
            assert len(self.log) - before <= most, "the advice proves nothing"
        return len(self.log) - before


@pytest.mark.long
def test_who_follows_it_proves_the_map_of_100_random_worlds() -> None:
    """From the start, it costs what `homing` costs; after a stroll it proves the map, too."""
    random = Random(2026)
    for number in range(100):
        world = WorldClass().sample(random.randrange(1, 11), random)
        walker = Walker(world)
        strolled = number % 2
        walker.stray(strolled * random.randrange(1, 20), random)
        cost = walker.follow()
        known = some(certify(walker.log).map)
        assert known.is_isomorphic(world)
        assert strolled or world.least_cost() <= cost <= tv.explore(world, "homing").cost


def test_the_way_home_leads_to_the_marker() -> None:
    random = Random(7)
    world = tv.families.lattice(4, 4)
    walker = Walker(world)
    for _ in range(20):
        walker.stray(3, random)
        way = some(certify(walker.log).advice)
        walker.go(way.home)
        assert world.vertex_of[walker.at] == world.vertex_of[world.root or 0]


def test_the_way_ends_with_a_door_that_was_never_crossed() -> None:
    walker = Walker(tv.families.lattice(3, 3))
    while (way := (certificate := certify(walker.log)).advice) is not None:
        assert way.walk in [door.walk for door in open_doors(certificate)]
        walker.go(way.walk)


def test_a_proved_log_gets_no_advice() -> None:
    walker = Walker(World.from_id("m1/0"))
    walker.go((0,))
    assert certify(walker.log).advice is None


def test_where_thinking_takes_too_long_the_way_home_remains(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(adviser, "MOST_THOUGHTS", 2)
    walker = Walker(tv.families.lattice(3, 3))
    walker.go((0, 1, 1))
    way = some(certify(walker.log).advice)
    assert (way.walk, len(way.home)) == ((), 3)
