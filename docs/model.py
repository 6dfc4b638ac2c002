"""Draws docs/model.svg, the picture of the model: python docs/model.py.

A small world, half explored. Door numbers are not written down here: they are counted clockwise
from the reference dart, as the robot counts them, so the picture cannot get them wrong.
"""

from __future__ import annotations

from itertools import pairwise
from math import atan2, cos, degrees, hypot, radians, sin
from pathlib import Path

Point = tuple[float, float]

PLACES: dict[str, Point] = {
    "v0": (88, 250),
    "a": (172, 106),
    "b": (238, 300),
    "vk": (330, 92),
    "w": (362, 250),
    "vu": (520, 168),
}
"""The vertices; y grows downwards, so angles grow clockwise."""

EXPLORED = [("v0", "a"), ("v0", "b"), ("a", "b"), ("a", "vk"), ("b", "w")]
E = ("vk", "vu")
MARKED = ("v0", "a")
HOME = ("w", "b", "v0")

OPEN: dict[str, list[float]] = {"vk": [64], "w": [-44, 30, 104], "vu": [-78, 12, 98]}
"""Unexplored darts by their angle in degrees; the first one of w is the hypothesis h."""

RADIUS, STUB = 17, 58


def main() -> None:
    """Write the picture beside this file."""
    Path(__file__).with_suffix(".svg").write_text(picture(), encoding="utf-8")


# ---------------------------------------------------------------- geometry


def angle(here: str, there: str) -> float:
    """The direction of an edge at one of its ends, in degrees clockwise from the east."""
    (x, y), (u, v) = PLACES[here], PLACES[there]
    return degrees(atan2(v - y, u - x))


def exits(vertex: str) -> list[float]:
    """The angles of all darts of a vertex."""
    edges = [*EXPLORED, E]
    ends = [b if a == vertex else a for a, b in edges if vertex in (a, b)]
    return [angle(vertex, other) for other in ends] + OPEN.get(vertex, [])


def doors(vertex: str, reference: float) -> dict[int, float]:
    """The angle of each door: door k is the k-th exit clockwise after the reference dart."""
    turned = sorted((way - reference + 1e-6) % 360 for way in exits(vertex))
    return {door: reference + way for door, way in enumerate(turned)}


def way_home() -> list[tuple[str, float, int]]:
    """Each vertex on the way home, its reference dart, and the door to take (or to be marked)."""
    steps: list[tuple[str, float, int]] = []
    reference = OPEN[HOME[0]][0]
    for here, there in [*pairwise(HOME), MARKED]:
        way = angle(here, there)
        numbered = doors(here, reference).items()
        door = min(numbered, key=lambda one: abs((one[1] - way + 180) % 360 - 180))[0]
        steps.append((here, reference, door))
        reference = angle(there, here)
    return steps


def away(vertex: str, way: float, distance: float, aside: float = 0) -> Point:
    """A point in a direction from a vertex, and perhaps a little clockwise beside it."""
    x, y = PLACES[vertex]
    c, s = cos(radians(way)), sin(radians(way))
    return x + distance * c - aside * s, y + distance * s + aside * c


# ---------------------------------------------------------------- pieces of SVG


def line(start: Point, end: Point, kind: str) -> str:
    """A straight line."""
    (x, y), (u, v) = start, end
    return f'<path class="{kind}" d="M{x:.0f} {y:.0f} L{u:.0f} {v:.0f}"/>'


def edge(here: str, there: str, kind: str, gap: float = RADIUS) -> str:
    """A line from the rim of one vertex to the rim of another."""
    way = angle(here, there)
    (x, y), (u, v) = PLACES[here], PLACES[there]
    length = hypot(u - x, v - y)
    return line(away(here, way, gap), away(here, way, length - gap), kind)


def text(at: Point, words: str, kind: str = "", anchor: str = "middle") -> str:
    """Words; <i> and <sub> inside become slanted and lowered."""
    words = words.replace("<i>", '<tspan font-style="italic">').replace("</i>", "</tspan>")
    words, *rest = words.replace("<sub>", '<tspan dy="4" font-size="70%">').split("</sub> ")
    words = words.replace("</sub>", "</tspan>")
    for more in rest:  # a space of its own: some programs drop one at the head of a tspan
        words += f'</tspan><tspan dx="5" dy="-4">{more}</tspan>'
    place = f'x="{at[0]:.0f}" y="{at[1]:.0f}" text-anchor="{anchor}"'
    return f'<text class="{kind}" {place}>{words}</text>'


def arrow(tip: Point, way: float, kind: str, size: float = 11) -> str:
    """A filled arrowhead."""
    x, y = tip
    corners = [(x, y)]
    corners += [
        (x - size * cos(radians(way + side)), y - size * sin(radians(way + side)))
        for side in (28, -28)
    ]
    return f'<path class="{kind}" d="M{" L".join(f"{u:.1f} {v:.1f}" for u, v in corners)}Z"/>'


def door_numbers(vertex: str, reference: float, taken: int | None, kind: str) -> list[str]:
    """The number of each door beside its dart; the one that is taken on a disc."""
    pieces: list[str] = []
    for door, way in doors(vertex, reference).items():
        came_in = door == 0 and kind != "e"  # an arrowhead is in the way
        x, y = away(vertex, way, RADIUS + 15, 20 if came_in else 14)
        if door == taken:
            pieces.append(f'<circle class="disc {kind}" cx="{x:.0f}" cy="{y:.0f}" r="9.5"/>')
        shade = "taken" if door == taken else f"door {kind if kind == 'e' else 'home'}"
        pieces.append(text((x, y + 4.5), str(door), shade))
    return pieces


# ---------------------------------------------------------------- the picture

SHAPES = """
text{font:17px system-ui,-apple-system,"Segoe UI",Helvetica,Arial,sans-serif}
path{fill:none;stroke-width:2.5;stroke-linecap:round}.vertex,.end{stroke-width:2}
path.e{stroke-width:3}path.h{stroke-width:3;stroke-dasharray:2 7}path.home{stroke-width:8;
opacity:.35}path.mark{stroke-width:5}.arc{stroke-width:1.5}
path.tip,.disc{stroke:none;opacity:1}.halo{fill:none;stroke-dasharray:1 4;stroke-width:1.5;
stroke-linecap:round}.name{font-size:18px}
.door,.taken{font-size:15px}.taken{font-weight:700}.soft{font-size:17px}
"""

COLOURS = """
.card,.vertex,.out,.taken{fill:CARD}.land,.end{fill:LAND}text{fill:INK}text.soft{fill:SOFT}
.known,.open,.end{stroke:LINE}.arc{stroke:SOFT}.tip.soft{fill:SOFT}.vertex{stroke:INK}.vertex.unknown,.halo,path.e{stroke:EDGE}
path.h{stroke:HYPO}path.home{stroke:HOME}path.mark{stroke:MARK}
text.e,.tip.e{fill:EDGE}text.h{fill:HYPO}text.home,.tip.home,.disc.home{fill:HOME}
text.mark,.tip.mark,.disc.mark{fill:MARK}
"""

LIGHT = {
    "CARD": "#fdfcf9", "LAND": "#eef0ee", "INK": "#22282e", "SOFT": "#626b74", "LINE": "#8a939c",
    "EDGE": "#1f6feb", "HYPO": "#c2510c", "HOME": "#1a7f4b", "MARK": "#b3261e",
}  # fmt: skip
DARK = {
    "CARD": "#14181c", "LAND": "#20262c", "INK": "#e8eaec", "SOFT": "#9aa4ae", "LINE": "#717c87",
    "EDGE": "#6cb0ff", "HYPO": "#ff9d5c", "HOME": "#56d090", "MARK": "#ff8078",
}  # fmt: skip


def style() -> str:
    """The style sheet: light, and dark where the reader's system is."""
    light = dark = COLOURS
    for name, colour in LIGHT.items():
        light, dark = light.replace(name, colour), dark.replace(name, DARK[name])
    sheet = f"{SHAPES}{light}@media(prefers-color-scheme:dark){{{dark}}}"
    return sheet.replace("\n", "")


def picture() -> str:
    """The whole SVG."""
    pieces = [*_frame(), *_map(), *_unknown(), *_home(), *_vertices(), *_clockwise(), *_legend()]
    return "\n".join([*pieces, "</svg>\n"])


def _frame() -> list[str]:
    title = "The robot behind an unexplored edge, one hypothesis, and its way home"
    size = 'viewBox="0 0 600 396" role="img"'
    return [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} aria-label="{title}">',
        f"<title>{title}</title><style>{style()}</style>",
        '<rect class="card" width="600" height="396" rx="14"/>',
        '<rect class="land" x="24" y="24" width="408" height="348" rx="60"/>',
        text((52, 62), "<i>S</i>, the map so far", "soft", "start"),
    ]


def _map() -> list[str]:
    pieces = [edge(a, b, "known") for a, b in EXPLORED]
    for vertex, ways in OPEN.items():
        for way in ways:
            end = away(vertex, way, STUB)
            out = " out" if vertex == "vu" else ""
            pieces.append(line(away(vertex, way, RADIUS), end, "open"))
            pieces.append(f'<circle class="end{out}" cx="{end[0]:.0f}" cy="{end[1]:.0f}" r="4"/>')
    return pieces


def _unknown() -> list[str]:
    way = angle(*E)
    half = away("vk", way, 105)
    start = away("w", OPEN["w"][0], STUB + 5)
    bend = away("w", OPEN["w"][0], STUB + 58)
    curve = "M{:.0f} {:.0f} Q{:.0f} {:.0f} {:.0f} {:.0f}".format(*start, *bend, *half)
    return [
        f'<path class="h" d="{curve}"/>',
        edge(*E, "e", RADIUS + 5),
        arrow(away("vu", way, -RADIUS - 9), way, "tip e", 13),
    ]


def _home() -> list[str]:
    pieces: list[str] = []
    for here, there in pairwise(HOME):
        way = angle(here, there)
        pieces.append(edge(here, there, "home", RADIUS + 6))
        pieces.append(arrow(away(there, way, -RADIUS - 4), way, "tip home", 14))
    return pieces


def _vertices() -> list[str]:
    pieces: list[str] = []
    marked = angle(*MARKED)
    pieces.append(line(away("v0", marked, RADIUS), away("v0", marked, RADIUS + 34), "mark"))
    pieces.append(arrow(away("v0", marked, RADIUS + 46), marked, "tip mark", 17))
    for name, (x, y) in PLACES.items():
        if name == "vu":
            pieces.append(f'<circle class="halo" cx="{x}" cy="{y}" r="{RADIUS + 6}"/>')
        unknown = " unknown" if name == "vu" else ""
        pieces.append(f'<circle class="vertex{unknown}" cx="{x}" cy="{y}" r="{RADIUS}"/>')
        words = f"<i>{name[0]}</i><sub>{name[1]}</sub>" if name[1:] else f"<i>{name}</i>"
        pieces.append(text((x, y + 5), words, "name"))
    pieces += door_numbers("vu", angle("vu", "vk"), None, "e")
    for here, reference, taken in way_home():
        pieces += door_numbers(here, reference, taken, "mark" if here == HOME[-1] else "home")
    return pieces


def _clockwise() -> list[str]:
    radius = RADIUS + 33
    start, end = away("vu", 212, radius), away("vu", 256, radius)
    curve = "M{:.0f} {:.0f} A{r} {r} 0 0 1 {:.0f} {:.0f}".format(*start, *end, r=radius)
    return [
        f'<path class="arc" d="{curve}"/>',
        arrow(away("vu", 262, radius), 352, "tip soft", 8),
    ]


def _legend() -> list[str]:
    h = away("w", OPEN["w"][0], STUB)
    return [
        text((518, 62), "not known yet", "soft"),
        text((h[0] - 13, h[1] - 1), "<i>h</i>", "h name", "end"),
        text((452, 118), "<i>e</i>", "e name"),
        text((442, 290), "the same edge?", "h", "start"),
        text((520, 262), "degree 4", "soft"),
        text((362, 346), "degree 4", "soft"),
        text((88, 196), "marker", "mark", "end"),
    ]


if __name__ == "__main__":
    main()
