"""The least cost of a proof, LB: what Coq computes is what `World.least_cost` says."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.helpers import worlds
from tests.proofs.mechanised.conftest import LIMIT
from topo_verify import World, families
from topo_verify.proofs.mechanised import toolchain
from topo_verify.world.resolve import resolve_world

HEAD = """\
From Coq Require Import Arith List Bool.
Import ListNotations.
From Topo Require Import World Table LeastCost.
Definition agrees (c : map_table * list nat * list nat * nat) := let '(t, depth, up, cost) := c in
  least_cost (map_of t) (fun b => nth b depth 0) (fun b => nth b up 0) =? cost.
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
