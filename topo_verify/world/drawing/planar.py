"""Sketches of any world as a plane map with bridges, one after the other until one is true."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from topo_verify.world.drawing import mesh as meshes
from topo_verify.world.drawing.fit import Sketch
from topo_verify.world.drawing.layout import Kind
from topo_verify.world.drawing.packing import packed
from topo_verify.world.drawing.plane_map import PlaneMap, best_plane_map
from topo_verify.world.drawing.polish import polished
from topo_verify.world.rooted_map import World

BEND = 0.4
"""What a bend costs, beside the shape of a triangle."""

STEPS = 60

ATTEMPTS, LARGE_ATTEMPTS = 6, 2
"""How many plane maps and outer faces are tried; less of worlds with more than 100 edges."""


def planar(world: World) -> Iterator[Sketch]:
    """Sketches of the world, the most promising first.

    Each has the crossings of a plane map and no other, as long as its chains are straight; rounded
    corners may spoil that, which the finished picture shows.
    """
    if not world.edges:
        yield Sketch("planar", np.zeros((1, 2)), ())
        return
    tried = set[tuple[int, int]]()
    for attempt in range(ATTEMPTS if len(world.edges) <= 100 else LARGE_ATTEMPTS):
        plane = best_plane_map(world, seed=attempt // 2)
        if plane is None:
            return
        outers = outer_faces(plane)
        outer = outers[min(attempt % 2 if attempt < 4 else attempt - 2, len(outers) - 1)]
        if (attempt // 2, outer) in tried:  # there are fewer faces than attempts
            continue
        tried.add((attempt // 2, outer))
        points = 2 if len(plane.other) < 600 else 1
        mesh = meshes.over(plane, outer, points=points)
        places = packed(mesh)
        if places is None:
            continue
        places = polished(mesh, places, bend=BEND, steps=STEPS)
        chains = [
            places[meshes.points_of(plane, mesh.between, number)]
            for number in range(len(world.edges))
        ]
        kind: Kind = "bridges" if plane.crossings else "planar"
        yield Sketch(kind, places[: plane.vertices], tuple(chains), bridges=plane.crossings)


def outer_faces(plane: PlaneMap) -> list[int]:
    """A half-edge of each face, each face once, the best for the outer face first."""
    faces = plane.faces()

    def worth(face: list[int]) -> tuple[int, int]:
        edges = {plane.edge[half] for half in face}
        dummies = sum(plane.node[half] >= plane.vertices for half in face)
        return len(edges) - 2 * dummies, len(face)

    by_size = sorted(faces, key=worth, reverse=True)
    # Second the face in the middle: from there every other one is near.
    middle = min(by_size[:40], key=lambda face: (_depth(plane, face), -len(face)))
    rest = [face for face in by_size if face is not by_size[0] and face is not middle]
    # The best face may be the middle: what failed with it as the outer face fails again.
    best = [by_size[0]] if middle is by_size[0] else [by_size[0], middle]
    return [face[0] for face in (*best, *rest)]


def _depth(plane: PlaneMap, face: list[int]) -> tuple[int, float]:
    """How many rings of faces lie around this one, and how far a node is in the mean."""
    seen, ring = {plane.face[face[0]]}, [face]
    nodes: set[int] = set()
    depth = total = 0
    at: dict[int, list[int]] = {}
    for half, node in enumerate(plane.node):
        at.setdefault(node, []).append(half)
    while ring:
        fresh = {plane.node[half] for around in ring for half in around} - nodes
        nodes |= fresh
        total += depth * len(fresh)
        depth += 1
        ring = list[list[int]]()
        for node in sorted(fresh):
            for half in at[node]:
                if plane.face[half] not in seen:
                    seen.add(plane.face[half])
                    ring.append(plane.cycle(half))
    return depth, total / len(nodes)
