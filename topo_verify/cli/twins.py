"""What `world show` prints of rotations and of twins: worlds that look the same to a robot."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

import msgspec

from topo_verify.errors import plural, shown
from topo_verify.report.blocks import Block, Text, TextTable
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import Dart, World
from topo_verify.world.twins import MarkerModel, find_twin


class TwinEntry(msgspec.Struct, frozen=True):
    """Another world that looks the same without the marker's direction, or why there is none.

    Attributes:
        model: what a robot senses of the marker: where it lies (undirected), or nothing (none).
        id: of the twin; null: there is none, or it has over 200 edges.
        why: why no twin was found; "no exchange ..." does not exclude one.
        rotation, edge_darts: of the twin; empty without one.
        file: the picture of both; null without -o.
    """

    model: str
    id: str | None
    genus: int | None
    why: str
    rotation: tuple[tuple[int, ...], ...]
    edge_darts: tuple[tuple[int, int], ...]
    file: str | None


def twin_entry(world: World, model: MarkerModel, file: str | None) -> TwinEntry:
    """The twin of a world; both are drawn to the file, if one is named."""
    other, why = find_twin(world, model)
    if other is None:
        return TwinEntry(model, None, None, why, (), (), None)
    if file is not None:
        files.write(file, _side_by_side(world, other))
    return TwinEntry(
        model,
        other.known_id,
        other.genus,
        "",
        other.vertices,
        other.edges,
        file,
    )


def _side_by_side(*worlds: World) -> str:
    """The pictures of the worlds on one card, with id and genus below each."""
    pictures = [world.draw() for world in worlds]
    sizes = [re.search(r'width="([0-9.]+)" height="([0-9.]+)"', picture) for picture in pictures]
    columns = [(float(size[1]), float(size[2])) for size in sizes if size is not None]
    font = max(9.0, sum(width for width, _ in columns) / 70)
    top = max(height for _, height in columns)
    parts: list[str] = []
    x = 0.0
    for world, picture, (width, height) in zip(worlds, pictures, columns, strict=True):
        name = world.known_id or plural(len(world.edges), "edge")
        words = f"{shown(name, limit=24)}, genus {world.genus}"
        column = max(width, 0.65 * font * len(words))
        at = f'x="{x + (column - width) / 2:g}" y="{(top - height) / 2:g}"'
        # Without its style, which some browsers take for a height of 100 %.
        bare = picture.replace(' style="max-width:100%;height:auto"', "", 1)
        parts.append(bare.replace("<svg ", f"<svg {at} ", 1))
        parts.append(
            f'<text class="tv-name" x="{x + column / 2:g}" y="{top + font:g}" font-size="{font:g}"'
            f' font-family="sans-serif" text-anchor="middle">{words}</text>'
        )
        x += column
    across, down = f"{x:g}", f"{top + 2 * font:g}"
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {across} {down}">\n'
        f'<rect class="tv-card" fill="#fdfcf9" width="{across}" height="{down}"/>'
    )
    return "\n".join([head, *parts, "</svg>\n"])


def twin_blocks(name: str, twin: TwinEntry) -> Iterator[Block]:
    """The twin of a world, or why there is none."""
    sensed = "without a marker" if twin.model == "none" else "without the marker's direction"
    yield Text("")
    if twin.why:
        yield Text(f"{name} has no twin {sensed}: {twin.why}.")
        return
    other = twin.id or "of over 200 edges"
    yield Text(
        f"{name} has a twin {sensed}, {other}, of genus {twin.genus}: on every walk a robot"
        " senses the same in both."
    )
    yield rotation_table(twin.rotation, twin.edge_darts)
    if twin.file is not None:
        yield Text(f"Both are drawn in {twin.file}.")


def rotation_table(
    rotation: Sequence[Sequence[Dart]],
    edges: Iterable[tuple[Dart, Dart]],
    names: Sequence[str] = (),
) -> TextTable:
    """Each vertex with its darts clockwise, and the other ends of these edges."""
    other = {dart: end for a, b in edges for dart, end in ((a, b), (b, a))}
    vertex = {dart: v for v, darts in enumerate(rotation) for dart in darts}
    rows = [
        (
            str(v),
            *names[v : v + 1],
            " ".join(map(str, darts)),
            " ".join(str(other[dart]) for dart in darts),
            " ".join(str(vertex[other[dart]]) for dart in darts),
        )
        for v, darts in enumerate(rotation)
    ]
    columns = (">vertex", *["name"] * bool(names), "darts clockwise", "to darts", "at vertices")
    return TextTable(columns, rows)
