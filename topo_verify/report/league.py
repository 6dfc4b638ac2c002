"""The arena's plot as SVG: cost / LB against the number of edges, both logarithmic.

A small dot is a world; a large sign is a family at its mean size and ratio, with its confidence
interval. Coordinates are rounded, so the same runs give the same bytes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import ceil, cos, log, pi, sin
from typing import NamedTuple

from topo_verify.report.blocks import PALETTE
from topo_verify.report.html import with_dark_colours, xml_text
from topo_verify.studies.arena.league import LeagueEntry
from topo_verify.studies.arena.suites import Suite

WIDTH, HEIGHT = 720, 430
LEFT, RIGHT, TOP, BOTTOM = 62, 210, 64, 48

COLOURS = (
    *("#0072b2", "#d55e00", "#00805f", "#9e4a86", "#946b00", "#22282e", "#3a8fb7", "#b3261e"),
    *("#6d7780", "#5b6b00"),
)
"""After M. Okabe and K. Ito, in the table's order; then they repeat."""

CORNERS = (0, 4, 3, 5, 8, 6, 7)
"""The corners of the signs in the same order; 0: a circle."""

NAME = 26
"""Most characters of a legend's name."""

TICKS = (1, 2, 5)
FEWEST = 3
"""Least number of values beside an axis, in steps of 0.1 or more."""

SHIFT, SPREAD = 5.0, 16.0
"""Pixels between the signs of two mappers at one family; and most between the outermost."""


class Axis(NamedTuple):
    """A logarithmic axis from `low` to `high`, drawn from pixel `start` to `end`."""

    low: float
    high: float
    start: float
    end: float

    def at(self, value: float) -> float:
        """The pixel of a value."""
        share = (log(value) - log(self.low)) / (log(self.high) - log(self.low))
        return round(self.start + share * (self.end - self.start), 1)

    @property
    def ticks(self) -> list[float]:
        """The values written beside the axis."""
        powers = range(5)
        every = [tick * 10**power for power in powers for tick in TICKS]
        values: list[float] = [value for value in every if self.low <= value <= self.high]
        for tenths in reversed(TICKS):
            if len(values) < FEWEST:
                steps = range(ceil(10 * self.low / tenths), int(10 * self.high / tenths) + 1)
                values = [step * tenths / 10 for step in steps]
        return values


Points = Sequence[tuple[int, float]]
"""The edges of each world, and a mapper's ratio."""


def ratio_plot(suite: Suite, ranked: Sequence[LeagueEntry], points: Mapping[str, Points]) -> str:
    """The picture of a suite.

    Args:
        ranked: the entries with a place, at least one.
    """
    edges, ratios = zip(*(point for every in points.values() for point in every), strict=True)
    x = Axis(min(edges) / 1.15, max(edges) * 1.15, LEFT, WIDTH - RIGHT)
    y = Axis(min(1.0, *ratios) / 1.04, max(1.1, *ratios) * 1.08, HEIGHT - BOTTOM, TOP)
    parts = [*_frame(suite, x, y), *_names(ranked[0], x)]
    for number, entry in enumerate(ranked):
        parts += _dots(points[entry.mapper], _colour(number), x, y)
    middle = (len(ranked) - 1) / 2
    step = min(SHIFT, SPREAD / (2 * middle)) if middle else 0.0
    for number, entry in enumerate(ranked):
        parts += _means(entry, number, step * (number - middle), x, y)
        parts += _legend(entry, number)
    return with_dark_colours(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}"'
        f' width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" font-size="12">\n'
        + "\n".join(parts)
        + "\n</svg>\n"
    )


def _colour(number: int) -> str:
    return COLOURS[number % len(COLOURS)]


def _text(x: float, y: float, words: str, *, soft: bool = False, more: str = "") -> str:
    ink = PALETTE["soft" if soft else "ink"].light
    return f'<text x="{x}" y="{y}" fill="{ink}"{more}>{xml_text(words)}</text>'


def _frame(suite: Suite, x: Axis, y: Axis) -> Iterator[str]:
    card, line = PALETTE["card"].light, PALETTE["line"].light
    yield f'<rect width="{WIDTH}" height="{HEIGHT}" fill="{card}"/>'
    yield _text(LEFT, 22, f"{suite.name}: {suite.about}", more=' font-size="15"')
    middle = ' text-anchor="middle"'
    for value in x.ticks:
        at = x.at(value)
        yield f'<path d="M {at} {TOP} V {HEIGHT - BOTTOM}" stroke="{line}"/>'
        yield _text(at, HEIGHT - BOTTOM + 17, f"{value:g}", soft=True, more=middle)
    for value in y.ticks:
        at = y.at(value)
        yield f'<path d="M {LEFT} {at} H {WIDTH - RIGHT}" stroke="{line}"/>'
        yield _text(LEFT - 8, at + 4, f"{value:g}", soft=True, more=' text-anchor="end"')
    yield _text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 12, "edges", soft=True, more=middle)
    height = (TOP + HEIGHT - BOTTOM) / 2
    turn = f' transform="rotate(-90 18 {height})"'
    yield _text(18, height, "cost / LB", soft=True, more=f"{middle}{turn}")


def _names(entry: LeagueEntry, x: Axis) -> Iterator[str]:
    line = PALETTE["faint"].light
    for number, family in enumerate(sorted(entry.families, key=lambda family: family.edges)):
        at = min(max(x.at(family.edges), LEFT + 60), WIDTH - RIGHT - 20)
        more = ' text-anchor="middle" font-size="10"'
        yield (
            f'<path d="M {x.at(family.edges)} {TOP} V {HEIGHT - BOTTOM}" stroke="{line}"'
            ' stroke-dasharray="2 4"/>'
        )
        yield _text(at, TOP - 4 - 12 * (number % 3), family.family, soft=True, more=more)


def _dots(points: Points, colour: str, x: Axis, y: Axis) -> Iterator[str]:
    places = dict.fromkeys((x.at(edges), y.at(ratio)) for edges, ratio in points)
    for across, up in places:
        yield f'<circle cx="{across}" cy="{up}" r="1.8" fill="{colour}" fill-opacity="0.35"/>'


def _means(entry: LeagueEntry, number: int, shift: float, x: Axis, y: Axis) -> Iterator[str]:
    for family in entry.families:
        at, ratio = round(x.at(family.edges) + shift, 1), family.ratio
        if ratio.low is not None and ratio.high is not None and ratio.low < ratio.high:
            low, high = y.at(max(ratio.low, y.low)), y.at(min(ratio.high, y.high))
            yield f'<path d="M {at} {low} V {high}" stroke="{_colour(number)}" stroke-width="2"/>'
        yield _sign(at, y.at(ratio.mean), number)


def _sign(x: float, y: float, number: int) -> str:
    corners = CORNERS[number % len(CORNERS)]
    style = f'fill="{_colour(number)}" stroke="{PALETTE["card"].light}"'
    if not corners:
        return f'<circle cx="{x}" cy="{y}" r="5" {style}/>'
    turns = (2 * pi * k / corners for k in range(corners))
    points = " ".join(f"{x + 6 * sin(turn):.1f},{y - 6 * cos(turn):.1f}" for turn in turns)
    return f'<polygon points="{points}" {style}/>'


def _legend(entry: LeagueEntry, number: int) -> Iterator[str]:
    height = TOP + 10 + 20 * number
    if height > HEIGHT - 10:
        return
    name = entry.mapper if len(entry.mapper) <= NAME else f"{entry.mapper[: NAME - 1]}…"
    yield _sign(WIDTH - RIGHT + 18, height, number)
    yield _text(WIDTH - RIGHT + 30, height + 4, name)
