"""LB is exact: the tour that Coq computes proves the map, in Python too, at the least cost."""

from __future__ import annotations

import re
from pathlib import Path

from tests.helpers import worlds
from tests.proofs.mechanised.conftest import LIMIT
from tests.proofs.mechanised.test_least_cost import PENDANT, case
from topo_verify import World, families
from topo_verify.checkers import Fold
from topo_verify.proofs.mechanised import toolchain
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.world.resolve import resolve_world

HEAD = """\
From Coq Require Import Arith List Bool.
Import ListNotations.
From Topo Require Import World Log Table LeastCost Tour.
Definition doors (c : map_table * list nat * list nat * nat) := let '(t, depth, up, _) := c in
  map fst (moves (tour_log (map_of t) (fun b => nth b depth 0) (fun b => nth b up 0))).
"""


def tours(place: Path, some: list[World]) -> list[tuple[int, ...]]:
    """The doors of the tour of each world, as Coq computes them."""
    cases = ";\n".join(case(world, 0) for world in some)
    (place / "Tours.v").write_text(f"{HEAD}Eval vm_compute in map doors [\n{cases}].\n")
    ran = toolchain.compile_one(place, "Tours", timeout=LIMIT)
    assert ran.accepted, ran.output
    answer = ran.output.partition("=")[2].partition(": list")[0]
    rows = re.findall(r"\[([\d;\s]*)\]", answer.strip()[1:-1])
    return [tuple(map(int, re.findall(r"\d+", row))) for row in rows]


def proved(world: World, doors: tuple[int, ...]) -> bool:
    """Does the log of a robot that takes these doors prove its map?"""
    robot = SimulatedRobot(world, len(doors))
    fold = Fold(robot.percept)
    for door in doors:
        fold.move(door, robot.move(door))
    return fold.open_darts() == 0


def test_the_tour_of_coq_proves_each_map_at_the_least_cost(place: Path) -> None:
    some = [*worlds(range(1, 4)), *map(resolve_world, PENDANT), families.lattice(3, 3)]
    found = tours(place, some)
    assert len(found) == len(some)
    for world, doors in zip(some, found, strict=True):
        assert proved(world, doors), world
        assert len(doors) == world.least_cost() == len(world.proof_tour()), world


def test_a_tour_cut_short_proves_nothing(place: Path) -> None:
    some = list(worlds([2]))
    for world, doors in zip(some, tours(place, some), strict=True):
        assert not proved(world, doors[:-1])
