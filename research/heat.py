"""A world coloured by a cost for each dart: where to put the marker, and where to point it.

    .venv/bin/python -m research.heat -o docs/heat.svg        # some seconds

A disc on each vertex has the colour of the mean over its darts, a stroke along each dart that of
its cost. The arrow stands on the best dart, a dashed ring around the vertex of the worst. The scale
is perceptually uniform, also for colour-blind eyes (J. R. Nuñez, C. R. Anderton, R. S. Renslow:
"Optimizing colormaps with consideration for color vision deficiency", PLOS ONE 13(7), 2018).
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from statistics import mean
from xml.etree import ElementTree as ET

from research import marker
from topo_verify.errors import InternalError
from topo_verify.pictures.drawing import curves, read_back
from topo_verify.pictures.drawing.choice import lay_out
from topo_verify.pictures.drawing.curves import number
from topo_verify.pictures.drawing.layout import Layout
from topo_verify.pictures.drawing.svg import FONT, leaving, text, to_svg
from topo_verify.world.resolve import resolve_world
from topo_verify.world.rooted_map import Dart, World

SCALE = (
    (0, 32, 81), (10, 50, 109), (43, 68, 110), (76, 86, 108), (104, 104, 109), (127, 124, 117),
    (146, 143, 120), (166, 163, 117), (190, 184, 107), (218, 206, 91), (253, 234, 69),
)  # fmt: skip
"""From dark to light, evenly spaced."""

STEPS = 40


def colour(share: float) -> str:
    """The colour of a share of the scale."""
    place = min(max(share, 0.0), 1.0) * (len(SCALE) - 1)
    k = min(int(place), len(SCALE) - 2)
    mixed = (a + (b - a) * (place - k) for a, b in zip(SCALE[k], SCALE[k + 1], strict=True))
    return "#" + "".join(f"{round(part):02x}" for part in mixed)


def heat_svg(world: World, costs: Sequence[int], *, title: str) -> str:
    """The heat map; the same bytes for the same arguments.

    Args:
        costs: of the marker at each dart, in edge traversals.
    """
    best, worst = costs.index(min(costs)), costs.index(max(costs))
    there = replace(world.with_marker(best), name=world.name)
    layout = lay_out(there)
    room = max(4.5 * _unit(layout), 2.0 * layout.radius)
    taller = replace(layout, height=layout.height + room)
    base = to_svg(there, taller).rstrip().removesuffix("</svg>")
    overlay = [
        *_strokes(there, layout, costs, best),
        *_discs(there, layout, costs, worst),
        *_legend(layout, costs, title),
    ]
    svg = base + "\n".join([*overlay, "</svg>\n"])
    mistakes = read_back.untruths(read_back.read(svg), there)
    mistakes += untrue_colours(svg, world, costs)
    if mistakes:
        raise InternalError(f"the heat map of {world!r} is not true: {mistakes[0]}")
    return svg


def _unit(layout: Layout) -> float:
    return layout.width / 30


def _share(cost: float, costs: Sequence[int]) -> float:
    low, high = min(costs), max(costs)
    return (cost - low) / (high - low) if high > low else 0.0


def _strokes(world: World, layout: Layout, costs: Sequence[int], best: Dart) -> Iterator[str]:
    width = 0.42 * layout.radius
    yield f'<g fill="none" stroke-linecap="butt" stroke-width="{number(width)}">'
    for dart, along in sorted(leaving(world, layout).items()):
        if world.vertex_of[dart] in layout.hidden or dart == best:
            continue
        cost = costs[dart]
        reach = min(1.4 * layout.radius, 0.4 * curves.length(along))
        data = curves.piece(along, 0.0, reach)
        yield f'<path class="tv-halo" stroke-width="{number(1.5 * width)}" d="{data}"/>'
        yield (
            f'<path data-dart="{dart}" data-cost="{cost}" stroke="{colour(_share(cost, costs))}"'
            f' d="{data}"><title>dart {dart}: {cost}</title></path>'
        )
    yield "</g>"


def _discs(world: World, layout: Layout, costs: Sequence[int], worst: Dart) -> Iterator[str]:
    radius = layout.radius
    yield (
        f'<g font-family="{FONT}" text-anchor="middle" font-size="{number(0.9 * radius)}"'
        f' stroke-width="{number(0.13 * radius)}">'
    )
    for vertex, darts in enumerate(world.vertices):
        if vertex in layout.hidden:
            continue
        x, y = layout.centres[vertex]
        average = mean(costs[dart] for dart in darts)
        share = _share(average, costs)
        at = f'cx="{number(x)}" cy="{number(y)}"'
        if vertex == world.vertex_of[worst]:
            dash = f"{number(0.5 * radius)} {number(0.3 * radius)}"
            yield (
                f'<circle class="tv-mark" stroke-dasharray="{dash}" {at}'
                f' r="{number(1.45 * radius)}" stroke-width="{number(0.25 * radius)}"/>'
            )
        words = f"vertex {vertex}: mean {average:.1f}, {len(darts)} directions"
        yield (
            f'<circle class="tv-ring" data-mean="{average:.2f}" fill="{colour(share)}"'
            f' stroke="#8a939c" {at} r="{number(radius)}"><title>{words}</title></circle>'
        )
        ink = "#14181c" if share > 0.5 else "#fdfcf9"
        yield (
            f'<text fill="{ink}" stroke="none" x="{number(x)}" y="{number(y + 0.33 * radius)}">'
            f"{vertex}</text>"
        )
    yield "</g>"


def _legend(layout: Layout, costs: Sequence[int], title: str) -> Iterator[str]:
    unit, size = _unit(layout), number(0.8 * _unit(layout))
    left, top = 0.7 * unit, layout.height + 0.9 * unit
    yield f'<g class="tv-name" font-family="{FONT}" font-size="{size}">'
    head = f"{text(title, limit=60)}: cost by place and direction of the marker"
    yield f'<text x="{number(left)}" y="{number(top)}">{head}</text>'
    wide = (layout.width - 2 * left) * 0.5
    low, high = min(costs), max(costs)
    start = left + 0.62 * unit * (len(str(low)) + 0.4)
    y = top + 0.5 * unit
    yield f'<text x="{number(left)}" y="{number(y + 0.75 * unit)}">{low}</text>'
    for step in range(STEPS):
        x = start + wide * step / STEPS
        yield (
            f'<rect x="{number(x)}" y="{number(y)}" width="{number(wide / STEPS + 0.3)}"'
            f' height="{number(unit)}" fill="{colour((step + 0.5) / STEPS)}"/>'
        )
    words = f"{high} edge traversals"
    end = start + wide + 0.4 * unit
    yield f'<text x="{number(end)}" y="{number(y + 0.75 * unit)}">{words}</text>'
    signs = "disc: mean over directions · stroke: one direction · arrow: best · dashed ring: worst"
    yield (
        f'<text class="tv-soft" font-size="{number(0.68 * unit)}" x="{number(left)}"'
        f' y="{number(y + 2.1 * unit)}">{signs}</text>'
    )
    yield "</g>"


def untrue_colours(svg: str, world: World, costs: Sequence[int]) -> list[str]:
    """A sentence on every disc and stroke of a heat map that shows another cost."""
    mistakes: list[str] = []
    picture = read_back.read(svg)
    ends = read_back.leavings(picture)
    centres = {(x, y): vertex for vertex, (x, y, _) in picture.circles.items()}
    strokes: dict[Dart, str] = {}
    discs: dict[int, str] = {}
    for element in ET.fromstring(svg).iter():  # noqa: S314  our own picture
        get = element.attrib.get
        if get("data-mean") is not None:
            discs[centres[float(get("cx", "")), float(get("cy", ""))]] = get("fill", "")
        elif (shown := get("data-dart")) is not None:
            start = curves.flatten(get("d", ""))[0]
            if abs(start - ends[int(shown)][0]).max() > read_back.TOLERANCE:
                mistakes.append(f"the stroke of dart {shown} begins elsewhere")
            strokes[int(shown)] = get("stroke", "")
    for vertex in picture.circles:
        average = mean(costs[dart] for dart in world.vertices[vertex])
        if discs.get(vertex) != colour(_share(average, costs)):
            mistakes.append(f"the disc of vertex {vertex} shows another cost than {average:.2f}")
    best = costs.index(min(costs))
    return mistakes + [
        f"the stroke of dart {dart} shows another cost than {costs[dart]}"
        for dart in ends
        if dart != best and strokes.get(dart) != colour(_share(costs[dart], costs))
    ]


def heat_map(world: str, mapper: str) -> str:
    """The heat map of a mapper's costs in a world; it must deliver a right map from every dart."""
    there = resolve_world(world)
    return heat_svg(there, marker.costs(there, mapper), title=f"{mapper} in {there.name}")


def main() -> None:
    ask = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    ask.add_argument("world", nargs="?", default="nyc", metavar="WORLD")
    ask.add_argument("mapper", nargs="?", default="basic", metavar="TARGET")
    ask.add_argument("-o", type=Path, required=True, metavar="FILE", dest="file")
    asked = ask.parse_args()
    asked.file.write_text(heat_map(asked.world, asked.mapper), encoding="utf-8")


if __name__ == "__main__":
    main()
