"""The least cost of a proof, LB, is exact.

Coq and `World.least_cost` agree; the tour that Coq computes proves the map, in Python too.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.helpers import worlds
from tests.proofs.mechanised.conftest import LIMIT
from topo_verify import World, families
from topo_verify.checkers import Fold
from topo_verify.proofs.mechanised import toolchain
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.world.resolve import resolve_world

HEAD = """\
From Coq Require Import Arith List Bool.
Import ListNotations.
From Topo Require Import World Log Table LeastCost Tour.
Definition agrees (c : map_table * list nat * list nat * nat) := let '(t, depth, up, cost) := c in
  least_cost (map_of t) (fun b => nth b depth 0) (fun b => nth b up 0) =? cost.
Definition doors (c : map_table * list nat * list nat * nat) := let '(t, depth, up, _) := c in
  map fst (moves (tour_log (map_of t) (fun b => nth b depth 0) (fun b => nth b up 0))).
"""

PENDANT = ("family:path(5)", "family:star(4)", "family:random_tree(6,seed=1)")
"""Worlds whose last trip saves something."""


def tree(world: World) -> tuple[list[int], list[int]]:
    """Per dart: the distance of its vertex from v0, and its vertex's dart that leads nearer."""
    depth = {world.marker_vertex: 0}
    up = {world.marker_vertex: 0}
    for v in (queue := [world.marker_vertex]):
        for dart in world.vertices[v]:
            other = world.alpha[dart]
            u = world.vertex_of[other]
            if u not in depth:
                depth[u], up[u] = depth[v] + 1, other
                queue.append(u)
    vertices = [world.vertex_of[dart] for dart in range(len(world.alpha))]
    return [depth[v] for v in vertices], [up[v] for v in vertices]


def case(world: World, cost: int) -> str:
    """A world as Coq reads it, and its LB."""
    world = World.from_code(world.code)
    before = {after: dart for dart, after in enumerate(world.sigma)}
    rows = [
        f"({after}, {before[dart]}, Some {world.alpha[dart]})"
        for dart, after in enumerate(world.sigma)
    ]
    depth, up = tree(world)
    return f"([{'; '.join(rows)}], {listed(depth)}, {listed(up)}, {cost})"


def listed(numbers: Sequence[int]) -> str:
    return f"[{'; '.join(map(str, numbers))}]"


def told(cases: Sequence[str]) -> str:
    return (
        f"{HEAD}Example all_agree : forallb agrees [\n{';'.join(cases)}] = true.\n"
        "Proof. vm_compute. reflexivity. Qed.\n"
    )


def accepted(place: Path, cases: Sequence[str]) -> bool:
    (place / "Costs.v").write_text(told(cases))
    return toolchain.compile_one(place, "Costs", timeout=LIMIT).accepted


def test_coq_and_python_agree_on_the_least_cost(place: Path) -> None:
    some = [*worlds(range(1, 4)), *map(resolve_world, PENDANT), families.lattice(3, 3)]
    assert accepted(place, [case(world, world.least_cost()) for world in some])


@pytest.mark.parametrize("world", ["m3/8", PENDANT[0]])
@pytest.mark.parametrize("more", [-1, 1])
def test_another_number_is_refused(place: Path, world: str, more: int) -> None:
    found = resolve_world(world)
    assert not accepted(place, [case(found, found.least_cost() + more)])


def test_what_the_last_trip_saves_matters() -> None:
    """A path is walked one way only, and a star's last edge is."""
    assert [resolve_world(world).least_cost() for world in PENDANT[:2]] == [4, 7]


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
