"""Chooses how a world is drawn, and tries again until the picture is true.

Of a large world a ball is drawn: the part around a dart.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace

from topo_verify.errors import InputError, InternalError
from topo_verify.pictures.drawing import curves, read_back
from topo_verify.pictures.drawing.cells import polygon, torus_cell
from topo_verify.pictures.drawing.layout import Layout, Sketch, find_bridges, fitted
from topo_verify.pictures.drawing.planar import planar
from topo_verify.pictures.drawing.straight import given, is_crowded, spread, tree
from topo_verify.pictures.drawing.svg import to_svg
from topo_verify.world.rooted_map import Dart, World

ROUNDINGS = (0.5, 0.35, 0.2, 0.1, 0.0)

ROOMY = 0.025
"""Vertex radius, as a share of the longer side, that needs no improvement."""

CRAMPED = 0.0003
"""The share that leaves vertices no room."""

WHOLE = 1000


def lay_out(world: World, *, centre: Dart | None = None) -> Layout:
    """A layout of the world whose picture was read back and found true.

    Args:
        centre: show the part around this dart; default: everything, or the part around the marker.
    """
    if centre is not None and len(ball(world, centre, limit=LIMIT).vertices) < len(world.vertices):
        return _ball(world, centre)
    flat = torus_cell(world) or polygon(world)
    if flat is not None and not untrue(world, flat):
        return flat
    for sketch in _sketches(world):
        layout = _true(world, sketch)
        if layout is not None:
            return layout
    assert world.root is not None, "a vertex alone is drawn true"
    return _ball(world, world.root)


def lay_out_known(world: World, places: int) -> Layout:
    """A true layout whose vertices from number `places` on are not drawn: each is an open door.

    InputError: the world has too many edges for a whole picture.
    """
    if places == len(world.vertices):
        return lay_out(world)
    assert world.root is not None, "a vertex alone has no open door"
    around = _part(world, world.root, frozenset(range(places)))
    for sketch in _sketches(around.part):
        layout = _true(around.part, sketch)
        if layout is None:
            continue
        words = 2 * max(layout.radius, layout.width / 60)  # a line below the picture
        whole = replace(put_back(around, layout), kind="known", height=layout.height + words)
        if not untrue(world, whole):
            return whole
    raise InputError(
        f"no picture of {len(world.edges):,} edges, expected up to about {WHOLE:,}: draw the map"
        " when it is proved"
    )


def _sketches(world: World) -> Iterator[Sketch]:
    positions = given(world)
    if positions is not None and is_crowded(positions):
        if _true(world, positions) and (even := spread(world, positions)):
            yield even
    elif positions is not None:
        yield positions
    branches = tree(world)
    if branches is not None:
        yield branches
    if len(world.edges) <= WHOLE:
        yield from planar(world)
    if positions is not None:
        yield positions


def _ball(world: World, centre: Dart) -> Layout:
    limit = LIMIT
    while limit > 8:
        around = ball(world, centre, limit=limit)
        for sketch in planar(around.part):
            layout = _true(around.part, sketch)
            if layout is not None:
                whole = put_back(around, layout)
                if not untrue(world, whole):
                    return whole
        limit //= 2
    raise InternalError(f"no true picture of {world!r} was found")


def _true(world: World, sketch: Sketch) -> Layout | None:
    """The true layout of the sketch with the roundest corners, if any."""
    straight = fitted(sketch, 0.0)
    if _share(straight) < CRAMPED and _wrong(world, sketch, straight):
        return None  # vertices coincide
    best: Layout | None = None
    for rounding in ROUNDINGS:
        layout = fitted(sketch, rounding)
        if best is not None and _share(layout) < 1.3 * _share(best):
            break
        if not _wrong(world, sketch, layout):
            best = layout
            if _share(layout) > ROOMY:
                break
    return best


def _wrong(world: World, sketch: Sketch, layout: Layout) -> bool:
    """Whether the picture is untrue, or over a twentieth off the sketch's number of bridges."""
    meant = len(layout.bridges) if sketch.bridges is None else sketch.bridges
    return abs(len(layout.bridges) - meant) > meant // 20 or bool(untrue(world, layout))


def _share(layout: Layout) -> float:
    return layout.radius / max(layout.width, layout.height)


def untrue(world: World, layout: Layout) -> list[str]:
    """The mistakes in the picture of the layout."""
    return read_back.untruths(read_back.read(to_svg(world, layout)), world)


LIMIT = 220
"""Maximal darts of a ball, unless its central vertex has more."""


@dataclass(frozen=True)
class Ball:
    """A part of a world.

    Attributes:
        part: as a world; an edge that leaves it ends at a vertex of degree 1.
        vertices: those of `whole` shown, the first ones in `part`.
        cut: the darts whose edges leave the part, each with the vertex of `part` at its end.
    """

    part: World
    whole: World
    vertices: tuple[int, ...]
    cut: dict[Dart, int]


def ball(world: World, centre: Dart, *, limit: int = LIMIT) -> Ball:
    """The part nearest to the dart's vertex, with at most `limit` darts."""
    first = world.vertex_of[centre]
    inside, queue, darts = {first}, deque([first]), len(world.vertices[first])
    while queue:
        for dart in world.vertices[queue.popleft()]:
            end = world.vertex_of[world.alpha[dart]]
            if end not in inside and darts + len(world.vertices[end]) <= limit:
                inside.add(end)
                queue.append(end)
                darts += len(world.vertices[end])
    return _part(world, centre, inside)


def _part(world: World, centre: Dart, inside: AbstractSet[int]) -> Ball:
    vertices = tuple(sorted(inside))
    rotations = [list(world.vertices[vertex]) for vertex in vertices]
    edges: list[tuple[Dart, Dart]] = []
    cut: dict[Dart, int] = {}
    for dart in (dart for rotation in rotations[:] for dart in rotation):
        other = world.alpha[dart]
        if world.vertex_of[other] not in inside:
            # greatest, so the edge is drawn from the inside
            cut[dart] = len(rotations)
            rotations.append([len(world.alpha) + dart])
            edges.append((dart, len(world.alpha) + dart))
        elif dart < other:
            edges.append((dart, other))
    part = World.from_rotations(rotations, edges, centre)
    return Ball(part, world, vertices, cut)


def put_back(around: Ball, layout: Layout) -> Layout:
    """The layout of the whole world that shows its part like this."""
    world, part = around.whole, around.part
    darts = sorted(dart for vertex in around.vertices for dart in world.vertices[vertex])
    edge_of = {dart: k for k, edge in enumerate(world.edges) for dart in edge}
    numbers = [edge_of[darts[a]] for a, _ in part.edges]
    paths: list[tuple[str, ...]] = [()] * len(world.edges)
    stubs: dict[Dart, str] = {}
    visible = [""] * len(world.edges)
    for number, (a, _), parts in zip(numbers, part.edges, layout.paths, strict=True):
        if darts[a] in around.cut:
            points = curves.flatten(parts[0])
            visible[number] = curves.piece(points, 0.0, 0.7 * curves.length(points))
            stubs[darts[a]] = visible[number]
        else:
            paths[number] = parts
            visible[number] = parts[0]
    places = dict(zip(around.vertices, layout.centres, strict=False))
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
    return replace(
        layout,
        kind="ball",
        centres=tuple(places[vertex] for vertex in range(len(world.vertices))),
        paths=tuple(paths),
        bridges=find_bridges(visible, layout.radius),
        stubs=tuple(sorted(stubs.items())),
        hidden=frozenset(range(len(world.vertices))) - {*around.vertices},
    )
