"""Plane maps: spheres by Euler's formula, with every vertex' order, crossings in dummies."""

from __future__ import annotations

from random import Random

import numpy as np
import pytest

from topo_verify.pictures.drawing import planar
from topo_verify.pictures.drawing import plane_map as meshes
from topo_verify.pictures.drawing.arrays import Floats
from topo_verify.pictures.drawing.planar import outer_faces
from topo_verify.pictures.drawing.plane_map import PlaneMap, best_plane_map, planarise
from topo_verify.world import families
from topo_verify.world.rooted_map import World

pytestmark = pytest.mark.no_cover  # drawing is not trusted: it is left out of the measure

SMALL = [World.from_id(f"m3/{rank}") for rank in range(74)]
OTHERS = [families.complete(6, seed=1), families.random_genus(25, 3, seed=1), families.torus(4, 4)]


def plane_map(world: World) -> PlaneMap:
    found = best_plane_map(world)
    assert found is not None
    return found


@pytest.mark.parametrize("world", [*SMALL[::3], *OTHERS])
def test_a_plane_map_is_a_sphere_that_keeps_every_order(world: World) -> None:
    plane = plane_map(world)
    assert plane.nodes - len(plane.other) // 2 + len(plane.faces()) == 2
    for dart, turned in enumerate(world.sigma):
        assert plane.after[plane.half[dart]] == plane.half[turned]
    assert (plane.crossings > 0) == (world.genus > 0)
    for number in range(len(world.edges)):
        assert {plane.edge[half] for half in plane.chain(number)} == {number}


@pytest.mark.parametrize("world", [*SMALL[::3], *OTHERS])
def test_no_face_is_tried_twice_as_the_outer_one(world: World) -> None:
    plane = plane_map(world)
    outers = outer_faces(plane)
    assert len(outers) == len({plane.face[half] for half in outers}) == len(plane.faces())


def test_the_faces_have_names_of_their_own() -> None:
    plane = plane_map(OTHERS[1])
    names = [{plane.face[half] for half in face} for face in plane.faces()]
    assert all(len(name) == 1 for name in names)
    assert len({name for group in names for name in group}) == len(names)


def test_a_map_with_too_many_crossings_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    world = families.complete(8, seed=1)
    crossings = plane_map(world).crossings
    monkeypatch.setattr(meshes, "MOST_CROSSINGS", crossings // 2)
    assert planarise(world, Random(0)) is None
    assert best_plane_map(world) is None


@pytest.mark.parametrize("world", [SMALL[20], OTHERS[1], families.dodecahedron()])
def test_no_triangle_flips_on_the_grid_or_in_the_polish(world: World) -> None:
    plane = plane_map(world)
    mesh = meshes.over(plane, plane.faces()[0][0], points=2)
    pairs = np.concatenate([mesh.triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])])
    edges = {frozenset(pair) for pair in pairs.tolist()}
    # A disc: V - E + F = 1. Its boundary is the frame.
    assert mesh.size - len(edges) + len(mesh.triangles) == 1
    assert 3 * len(mesh.triangles) == 2 * len(edges) - 3
    start = planar.gridded(mesh)
    polished = planar.polished(mesh, start, bend=0.4, steps=60)
    for places in (start, polished):
        assert areas(mesh, places).min() > 0
    assert misfit(mesh, polished) < 0.7 * misfit(mesh, start)


def misfit(mesh: meshes.Mesh, places: Floats) -> float:
    """How much the sides of triangles that matter differ from their wished lengths, by factors."""
    sides = mesh.triangles[mesh.weights >= meshes.RING][:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    lengths = np.hypot(*(places[sides[:, 0]] - places[sides[:, 1]]).T)
    return float(np.log(lengths / mesh.radii[sides].sum(1)).std())


def areas(mesh: meshes.Mesh, places: Floats) -> Floats:
    a, b, c = (places[mesh.triangles[:, k]] for k in range(3))
    return np.asarray((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
