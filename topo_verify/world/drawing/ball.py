"""The part of a large world around a dart, as a world of its own, and its layout put back."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from topo_verify.world.drawing import curves
from topo_verify.world.drawing.layout import Bridge, Layout
from topo_verify.world.rooted_map import Dart, World

LIMIT = 220
"""The darts that a ball has at most, unless its middle alone has more."""


@dataclass(frozen=True)
class Ball:
    """A part of a world.

    Attributes:
        part: the world of this part. Where an edge leaves it there is a vertex of degree 1.
        whole: the world that it is a part of.
        vertices: the vertices of the whole that are shown, as they stand first in `part`.
        cut: the darts whose edges leave the part, each with the vertex of `part` at its end.
    """

    part: World
    whole: World
    vertices: tuple[int, ...]
    cut: dict[Dart, int]


def ball(world: World, centre: Dart, *, limit: int = LIMIT) -> Ball:
    """The vertices nearest to the dart's vertex, breadth-first, as many as the limit lets in."""
    first = world.vertex_of[centre]
    inside, queue, darts = {first}, deque([first]), len(world.vertices[first])
    while queue:
        for dart in world.vertices[queue.popleft()]:
            end = world.vertex_of[world.alpha[dart]]
            if end not in inside and darts + len(world.vertices[end]) <= limit:
                inside.add(end)
                queue.append(end)
                darts += len(world.vertices[end])
    vertices = tuple(sorted(inside))
    rotations = [list(world.vertices[vertex]) for vertex in vertices]
    edges: list[tuple[Dart, Dart]] = []
    cut: dict[Dart, int] = {}
    for dart in (dart for rotation in rotations[:] for dart in rotation):
        other = world.alpha[dart]
        if world.vertex_of[other] not in inside:
            # The new dart is greater than all others: the edge is drawn from the inside.
            cut[dart] = len(rotations)
            rotations.append([len(world.alpha) + dart])
            edges.append((dart, len(world.alpha) + dart))
        elif dart < other:
            edges.append((dart, other))
    part = World.from_rotations(rotations, edges, centre)
    return Ball(part, world, vertices, cut)


def put_back(around: Ball, layout: Layout) -> Layout:
    """The layout of the whole world that shows its part as in this layout of the part."""
    world, part = around.whole, around.part
    # Darts of the part keep their order: the k-th of the part is the k-th of these.
    darts = sorted(dart for vertex in around.vertices for dart in world.vertices[vertex])
    edge_of = {dart: k for k, edge in enumerate(world.edges) for dart in edge}
    numbers = [edge_of[darts[a]] for a, _ in part.edges]
    paths: list[tuple[str, ...]] = [()] * len(world.edges)
    stubs: list[tuple[Dart, str]] = []
    for number, (a, _), parts in zip(numbers, part.edges, layout.paths, strict=True):
        if darts[a] in around.cut:
            points = curves.flatten(parts[0])
            stubs.append((darts[a], curves.piece(points, 0.0, 0.7 * curves.length(points))))
        else:
            paths[number] = parts
    bridges = tuple(
        Bridge(numbers[bridge.over], numbers[bridge.under], bridge.path)
        for bridge in layout.bridges
        if not {darts[part.edges[k][0]] for k in (bridge.over, bridge.under)} & around.cut.keys()
    )
    shown = dict(zip(around.vertices, layout.centres, strict=False))
    places = dict(shown)
    # A hidden vertex lies where the shortest way to it leaves the ball.
    queue: deque[int] = deque()
    for dart, leaf in around.cut.items():
        end = world.vertex_of[world.alpha[dart]]
        if end not in places:
            places[end] = layout.centres[leaf]
            queue.append(end)
    while queue:
        vertex = queue.popleft()
        for dart in world.vertices[vertex]:
            end = world.vertex_of[world.alpha[dart]]
            if end not in places:
                places[end] = places[vertex]
                queue.append(end)
    return Layout(
        kind="ball",
        width=layout.width,
        height=layout.height,
        radius=layout.radius,
        centres=tuple(places[vertex] for vertex in range(len(world.vertices))),
        paths=tuple(paths),
        bridges=bridges,
        stubs=tuple(sorted(stubs)),
        hidden=frozenset(range(len(world.vertices))) - shown.keys(),
    )
