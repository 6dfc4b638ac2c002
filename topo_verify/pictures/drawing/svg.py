"""A layout as SVG: literal colours for light, a media query for dark; every text escaped.

docs/commands.md, "world draw", promises how scripts find vertices and edges.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from html import escape
from math import cos, pi, sin

import numpy as np

from topo_verify.errors import map_size, plural, shown
from topo_verify.pictures.drawing import curves
from topo_verify.pictures.drawing.arrays import Floats
from topo_verify.pictures.drawing.curves import number
from topo_verify.pictures.drawing.layout import CutSurface, Layout
from topo_verify.world.formats.junctions import Point
from topo_verify.world.rooted_map import Dart, World

STYLE = (
    ".tv-card,.tv-vertex{fill:#fdfcf9}.tv-edge,.tv-over,.tv-stub{fill:none;stroke:#8a939c}"
    ".tv-halo{fill:none;stroke:#fdfcf9}.tv-vertex{stroke:#22282e}.tv-name{fill:#22282e}"
    ".tv-soft{fill:#626b74}.tv-mark{fill:none;stroke:#b3261e}.tv-tip{fill:#b3261e}"
    ".tv-side-a{fill:none;stroke:#1f6feb}.tv-side-b{fill:none;stroke:#c2510c}"
    ".tv-side-c{fill:none;stroke:#1a7f4b}.tv-side-d{fill:none;stroke:#7a5cc4}"
    ".tv-back{fill:#fdfcf9;fill-opacity:.85}"
    "@media(prefers-color-scheme:dark){.tv-card,.tv-vertex,.tv-back{fill:#14181c}"
    ".tv-edge,.tv-over,.tv-stub{stroke:#717c87}.tv-halo{stroke:#14181c}.tv-vertex{stroke:#e8eaec}"
    ".tv-name{fill:#e8eaec}.tv-soft{fill:#9aa4ae}.tv-mark{stroke:#ff8078}.tv-tip{fill:#ff8078}"
    ".tv-side-a{stroke:#6cb0ff}.tv-side-b{stroke:#ff9d5c}"
    ".tv-side-c{stroke:#56d090}.tv-side-d{stroke:#b39ddb}}"
)
"""Colours only, so that two pictures in one page do not disturb each other."""

SMALL = 260.0
"""Pixels of width below which a picture is shown larger, up to twice."""

SIDES = "abcd"
"""Colours repeat; letters do not."""

FONT = "system-ui,-apple-system,'Segoe UI',Helvetica,Arial,sans-serif"


def to_svg(
    world: World,
    layout: Layout,
    *,
    doors: bool = False,
    darts: bool = False,
    here: int | None = None,
) -> str:
    """The picture of the world, the same bytes for the same arguments; marks as in `World.draw`.

    The vertex `here` has a second circle.
    """
    body = [*_body(world, layout, doors, darts)]
    if here is not None:
        body[0:0] = _ring(layout, here)
    return "\n".join([*_head(world, layout), *body, "</svg>\n"])


def _ring(layout: Layout, vertex: int) -> Iterator[str]:
    x, y = layout.centres[vertex]
    size = legible(layout)
    at = f'cx="{number(x)}" cy="{number(y)}" r="{number(layout.radius + 0.6 * size)}"'
    wide = number(0.2 * size)
    yield f'<circle class="tv-side-a" stroke-width="{wide}" {at}><title>here</title></circle>'


def text(words: str, *, limit: int = 200) -> str:
    """Words of unknown origin on one line, escaped."""
    return escape(shown(words, limit=limit))


def caption(world: World, layout: Layout) -> str:
    """The picture's content in words."""
    size = f"{map_size(len(world.vertices), len(world.edges))}, genus {world.genus}"
    words = "; ".join(([] if layout.kind == "known" else [size]) + _shown(layout))
    return f"{world.name}: {words}" if world.name else words


def _shown(layout: Layout) -> list[str]:
    """A sentence if not everything is shown."""
    if not layout.hidden:
        return []
    visible = len(layout.centres) - len(layout.hidden)
    if layout.kind == "known":
        return [f"{plural(visible, 'place')}, {plural(len(layout.hidden), 'open door')}"]
    return [f"{visible} of {len(layout.centres)} vertices are shown"]


def _head(world: World, layout: Layout) -> Iterator[str]:
    width, height = number(layout.width), number(layout.height)
    title = text(caption(world, layout))
    larger = min(2.0, max(1.0, SMALL / layout.width))
    shown = " ".join(
        f'{name}="{number(larger * size)}"'
        for name, size in (("width", layout.width), ("height", layout.height))
    )
    yield (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" {shown}'
        f' style="max-width:100%;height:auto" role="img" aria-label="{title}">'
    )
    yield f"<title>{title}</title><style>{STYLE}</style>"
    yield f'<rect class="tv-card" fill="#fdfcf9" width="{width}" height="{height}"/>'


def _body(world: World, layout: Layout, doors: bool, darts: bool) -> Iterator[str]:  # noqa: FBT001
    radius = layout.radius
    line = min(max(0.15 * radius, max(layout.width, layout.height) / 800), 0.45 * radius)
    if layout.cell:
        yield from _cell(layout.cell, radius)
    yield f'<g stroke-width="{number(line)}" stroke-linecap="round" stroke-linejoin="round">'
    for (a, b), parts in zip(world.edges, layout.paths, strict=True):
        for k, data in enumerate(parts):
            part = f' data-part="{k}"' if len(parts) > 1 else ""
            yield f'<path class="tv-edge" data-darts="{a} {b}"{part} d="{data}"/>'
    for dart, data in layout.stubs:
        dash = f"{number(0.1 * legible(layout))} {number(0.5 * legible(layout))}"
        yield f'<path class="tv-stub" data-stub="{dart}" stroke-dasharray="{dash}" d="{data}"/>'
    yield "</g>"
    if layout.bridges:
        halo = number(max(0.62 * radius, 3 * line))
        yield f'<g stroke-width="{number(line)}">'
        for bridge in layout.bridges:
            yield f'<path class="tv-halo" stroke-width="{halo}" d="{bridge.path}"/>'
            yield f'<path class="tv-over" d="{bridge.path}"/>'
        yield "</g>"
    if world.root is not None:
        yield from arrow(world, layout, world.root)
    yield from _vertices(world, layout)
    for words in _shown(layout):
        size = number(max(0.9 * radius, layout.width / 60))
        at = f'x="{number(radius)}" y="{number(layout.height - radius)}"'
        yield f'<text class="tv-soft" font-family="{FONT}" font-size="{size}" {at}>{words}</text>'
    if doors or darts:
        yield from _dart_labels(world, layout, doors, darts)


def _cell(cell: CutSurface, radius: float) -> Iterator[str]:
    """Glued sides have one colour and one letter."""
    (x, y), *others = cell.corners
    dash = f"{number(0.5 * radius)} {number(0.4 * radius)}"
    if cell.sides == "abab":
        numbers = [x, y, others[0][0] - x, others[0][1] - y, others[2][0] - x, others[2][1] - y]
        names = f'data-cell="{" ".join(map(number, numbers))}"'
    else:
        outline = " ".join(f"{number(px)} {number(py)}" for px, py in cell.corners)
        names = f'data-polygon="{outline}" data-sides="{cell.sides}"'
    yield (
        f'<g {names} stroke-width="{number(0.12 * radius)}" stroke-dasharray="{dash}"'
        f' font-family="{FONT}" font-size="{number(1.1 * radius)}" text-anchor="middle">'
    )
    middle = np.mean(cell.corners, axis=0)
    for k, letter in enumerate(cell.sides):
        line = np.array([cell.corners[k], cell.corners[(k + 1) % len(cell.corners)]])
        colour = SIDES[(ord(letter) - ord("a")) % len(SIDES)]
        data = curves.straight([(px, py) for px, py in line.tolist()])
        yield f'<path class="tv-side-{colour}" d="{data}"/>'
        out = line.mean(0) - middle
        px, py = line.mean(0) + 1.1 * radius * out / np.hypot(*out)
        at = f'x="{number(px)}" y="{number(py + 0.35 * radius)}"'
        yield f'<text class="tv-soft" {at}>{letter}</text>'
    yield "</g>"


def arrow(world: World, layout: Layout, dart: Dart) -> Iterator[str]:
    """The marker: an arrow along the beginning of its dart."""
    along = leaving(world, layout).get(dart)
    if along is None:
        return
    size = legible(layout)
    if size > layout.radius:
        x, y = layout.centres[world.vertex_of[dart]]
        at = f'cx="{number(x)}" cy="{number(y)}" r="{number(layout.radius + 0.6 * size)}"'
        yield f'<circle class="tv-mark" stroke-width="{number(0.2 * size)}" {at}/>'
    # a loop turns back beneath the arrow
    loop = layout.cell is None and world.vertex_of[dart] == world.vertex_of[world.alpha[dart]]
    reach = min(2.5 * size, (0.3 if loop else 0.66) * curves.length(along))
    tip = 0.5 * reach
    shaft = curves.piece(along, 0.0, reach - 0.8 * tip)
    base, end = curves.place(along, reach - tip), curves.place(along, reach)
    ahead = (end - base) / max(float(np.hypot(*(end - base))), 1e-9)
    side = np.array([-ahead[1], ahead[0]]) * 0.42 * tip
    head = curves.straight([(x, y) for x, y in (base + side, end, base - side)])
    width = number(0.32 * min(size, reach))
    yield f'<path class="tv-mark" stroke-width="{width}" d="{shaft}"/>'
    yield f'<path class="tv-tip" d="{head}Z"/>'


def legible(layout: Layout) -> float:
    """The least size of legible signs, at least the radius."""
    return max(layout.radius, max(layout.width, layout.height) / 110)


def _vertices(world: World, layout: Layout) -> Iterator[str]:
    radius, size = layout.radius, legible(layout)
    yield (
        f'<g stroke-width="{number(0.13 * radius)}" font-family="{FONT}" text-anchor="middle"'
        f' font-size="{number(size)}">'
    )
    names = world.vertex_names or tuple(map(str, range(len(world.vertices))))
    labels = _labels(world)
    places = dict(enumerate(layout.centres)) if size == layout.radius else {}
    places = places or _beside(layout, labels, size)
    for vertex, (x, y) in enumerate(layout.centres):
        if vertex in layout.hidden:
            continue
        at = f'cx="{number(x)}" cy="{number(y)}" r="{number(radius)}"'
        circle = f'<circle class="tv-vertex" data-vertex="{vertex}" {at}>'
        yield f"{circle}<title>{text(names[vertex])}</title></circle>"
        if vertex in places:
            left, middle = places[vertex]
            at = f'x="{number(left)}" y="{number(middle + 0.36 * size)}"'
            yield f'<text class="tv-name" stroke="none" {at}>{text(labels[vertex])}</text>'
    yield "</g>"


MOST_NAMES = 250
"""With more vertices, small circles have no names."""


def _labels(world: World) -> list[str]:
    names = world.vertex_names or ("",) * len(world.vertices)
    return [name if 0 < len(name) <= 3 else str(vertex) for vertex, name in enumerate(names)]


def _beside(layout: Layout, labels: Sequence[str], size: float) -> dict[int, Point]:
    """The middles of the names of vertices beside their circles, where there is room."""
    if len(labels) > MOST_NAMES:
        return {}
    page = layout.width, layout.height
    circles = [c for vertex, c in enumerate(layout.centres) if vertex not in layout.hidden]
    lines = _strands(layout, 0.5 * size)
    taken = [(x, y, 0.0, 0.0) for x, y in circles]
    places: dict[int, Point] = {}
    for vertex, (x, y) in enumerate(layout.centres):
        wide, high = 0.3 * size * len(labels[vertex]) + 0.2 * size, 0.55 * size
        room = np.array([(px, py, w + wide, h + high) for px, py, w, h in taken])
        near = lines[np.abs(lines - (x, y)).max(1) < 4 * size + wide]
        for turn in range(0 if vertex in layout.hidden else 8):
            place = np.array([x, y]) + (layout.radius + 0.3 * size) * UNITS[turn]
            place = place + (wide, high) * UNITS[turn]
            inside = ((wide, high) < place) & (place < np.array(page) - (wide, high))
            clear = inside.all() and (np.abs(near - place) > (wide, high)).any(1).all()
            if clear and (np.abs(room[:, :2] - place) > room[:, 2:]).any(1).all():
                places[vertex] = (float(place[0]), float(place[1]))
                taken.append((*places[vertex], wide, high))
                break
    return places


UNITS = np.array([(cos(turn * pi / 4), sin(turn * pi / 4)) for turn in range(8)])


def _dart_labels(world: World, layout: Layout, doors: bool, darts: bool) -> Iterator[str]:  # noqa: FBT001
    size = _label_size(world, layout)
    words = {
        dart: ":".join([str(door)] * doors + [str(dart)] * darts)
        for rotation in world.vertices
        for door, dart in enumerate(rotation)
    }
    yield f'<g font-family="{FONT}" text-anchor="middle" font-size="{number(0.8 * size)}">'
    for dart, (x, y) in places(world, layout, words).items():
        at = f'cx="{number(x)}" cy="{number(y)}"'
        yield f'<circle class="tv-back" {at} r="{number(0.4 * size)}"/>'
        at = f'x="{number(x)}" y="{number(y + 0.25 * size)}"'
        yield f'<text class="tv-soft" {at}>{words[dart]}</text>'
    yield "</g>"


def _label_size(world: World, layout: Layout) -> float:
    """Legible where vertices have names, else the radius."""
    return legible(layout) if len(world.vertices) <= MOST_NAMES else layout.radius


FIRST, STEP, MOST = 0.75, 0.3, 24
"""In sizes of a label: the first place along an edge and the step; the number of places."""

CLEAR, BESIDE = 0.48, 0.5
"""In sizes: the least distance of a one-digit number's middle from edges; from its own edge."""

DIGIT = 0.2
"""In sizes: half the width of a digit."""


def leaving(world: World, layout: Layout) -> dict[Dart, Floats]:
    """The first part of each drawn dart's edge, as points from the dart on."""
    lines: dict[Dart, Floats] = {}
    for (a, b), parts in zip(world.edges, layout.paths, strict=True):
        if parts:
            lines[a], lines[b] = curves.flatten(parts[0]), curves.flatten(parts[-1])[::-1]
    return lines | {dart: curves.flatten(data) for dart, data in layout.stubs}


def places(world: World, layout: Layout, words: Mapping[Dart, str]) -> dict[Dart, Point]:
    """The places of the darts' words, each on its edge and clear of the others."""
    lines, radius, size = leaving(world, layout), layout.radius, _label_size(world, layout)
    circles = [c for vertex, c in enumerate(layout.centres) if vertex not in layout.hidden]
    # points to avoid, and the distance across and down
    taken = [(x, y, radius + 0.3 * size, radius + 0.3 * size) for x, y in circles]
    if size > radius:
        names = _labels(world)
        for named, (x, y) in _beside(layout, names, size).items():
            taken.append((x, y, (0.3 * len(names[named]) + 0.2) * size, size))
    chosen: dict[Dart, Point] = {}
    strands, far = _strands(layout, 0.25 * size), (FIRST + STEP * MOST + 2) * size
    bridges = np.reshape([curves.flatten(b.path).mean(0) for b in layout.bridges], (-1, 2))
    for vertex, rotation in enumerate(world.vertices):
        x, y = layout.centres[vertex]
        begin, end = np.searchsorted(strands[:, 0], (x - far, x + far))
        near = strands[begin:end][np.abs(strands[begin:end, 1] - y) < far]
        held = [mark for mark in taken if max(abs(mark[0] - x), abs(mark[1] - y)) < 2 * far]
        for dart in rotation if vertex not in layout.hidden else ():
            across = len(words[dart]) * DIGIT * size
            wider = across - DIGIT * size  # than one digit
            chosen[dart] = _best(
                _along(lines[dart], bridges, size, wider, marked=dart == world.root),
                near,
                np.array(held) + np.array([0, 0, across, 0]),
                np.array([CLEAR * size + wider, CLEAR * size]),
            )
            held.append((*chosen[dart], across + 0.15 * size, 0.8 * size))
            taken.append(held[-1])
    return chosen


def _strands(layout: Layout, step: float) -> Floats:
    """Points on all edges, from left to right."""
    parts = [*(data for parts in layout.paths for data in parts), *(d for _, d in layout.stubs)]
    lines = [curves.flatten(data) for data in parts]
    points = [curves.place(line, np.arange(0.0, curves.length(line), step)) for line in lines]
    strands = np.concatenate([np.empty((0, 2)), *points])
    return strands[np.argsort(strands[:, 0])]


def _along(
    line: Floats, bridges: Floats, size: float, wider: float, *, marked: bool
) -> Iterator[Point]:
    """The places to try, the nearest first; on the marked dart beside the arrow."""
    most = 0.35 * curves.length(line)  # the other end has a number, too
    for k in range(MOST):
        away = (FIRST + STEP * k) * size
        place = curves.place(line, min(away, most))
        if k and (away > most or (np.abs(bridges - place) < 0.5 * size).all(1).any()):
            return
        ahead = curves.place(line, min(away, most) + 0.2 * size) - place
        left = np.array([ahead[1], -ahead[0]]) / np.hypot(*ahead)
        place = place + ((0.8 if marked else BESIDE) * size + wider * abs(left[0])) * left
        yield float(place[0]), float(place[1])


def _best(tries: Iterator[Point], lines: Floats, taken: Floats, clear: Floats) -> Point:
    """The first place clear of all; else one on no other number, and off the lines."""
    best, room = (0.0, 0.0), (-1.0, -1.0)
    for place in tries:
        apart = (np.abs(taken[:, :2] - place) / taken[:, 2:]).max(axis=1).min()
        off = np.hypot(*((lines - place) / clear).T).min()
        here = min(float(apart), 1.0), min(float(off), 1.0)
        if here > room:
            best, room = place, here
        if room == (1.0, 1.0):
            break
    return best
