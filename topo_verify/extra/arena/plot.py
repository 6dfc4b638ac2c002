"""The arena's plot as SVG: cost / LB (logarithmic) of each mapper, family by family.

A small dot is a world; a large sign is the mean of a mapper in a family, with its confidence
interval. Coordinates are rounded, so the same runs give the same bytes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import ceil, cos, log, pi, sin
from typing import NamedTuple

from topo_verify.errors import shown
from topo_verify.extra.arena.league import LeagueEntry, MeanInterval
from topo_verify.extra.arena.suites import Suite
from topo_verify.report.blocks import PALETTE
from topo_verify.report.html import with_dark_colours, xml_text

LEFT, RIGHT, TOP, BOTTOM = 62, 16, 44, 34
WIDE, HIGH = 448, 320
"""Pixels of the frame, at least; and its margins."""

BAND, STEP = 26.0, 26.0
"""Least pixels of a family, and most between the signs of two mappers in it."""

LINE = 20
"""Pixels of a line of a legend."""

COLOURS = (
    *("#0072b2", "#d55e00", "#00805f", "#9e4a86", "#946b00", "#22282e", "#3a8fb7", "#b3261e"),
    *("#6d7780", "#5b6b00"),
)
"""After M. Okabe and K. Ito, in the table's order; then they repeat."""

CORNERS = (0, 4, 3, 5)
"""The corners of the signs in the same order; 0: a circle. More corners look like one."""

NAME = 60
"""Most characters of a name."""

TICKS = (1, 2, 5)
FEWEST = 3
"""Least number of values beside an axis, in steps of 0.1 or more."""


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


class Frame(NamedTuple):
    """The frame: a band of pixels for each family, and in it a column for each mapper.

    Attributes:
        bottom: the pixel of its lower side.
        step: pixels between two columns.
    """

    band: float
    bottom: float
    step: float
    mappers: int

    def column(self, family: int, mapper: int) -> float:
        """The pixel of a mapper's column in a family."""
        aside = self.step * (mapper - (self.mappers - 1) / 2)
        return round(LEFT + self.band * (family + 0.5) + aside, 1)


Ratios = Sequence[Sequence[float]]
"""A mapper's ratios in the worlds of each family."""


def ratio_plot(suite: Suite, ranked: Sequence[LeagueEntry], ratios: Mapping[str, Ratios]) -> str:
    """The picture of a suite.

    Args:
        ranked: the entries with a place, at least one.
        ratios: of each of these mappers.
    """
    band = max(BAND, WIDE / len(suite.families))
    bottom = TOP + HIGH
    frame = Frame(band, bottom, min(STEP, 0.8 * band / len(ranked)), len(ranked))
    values = [ratio for families in ratios.values() for family in families for ratio in family]
    values += [f.ratio.high for e in ranked for f in e.families if f.ratio.high is not None]
    y = Axis(min(1.0, *values) / 1.04, max(1.1, *values) * 1.08, bottom, TOP)
    end = round(LEFT + band * len(suite.families), 1)
    legend = bottom + BOTTOM + 6 + LINE * len(suite.families)
    width, height = round(end) + RIGHT, legend + LINE * len(ranked)
    card = PALETTE["card"].light
    parts = [f'<rect width="{width}" height="{height}" fill="{card}"/>']
    parts += [*_frame(suite, y, end), *_names(ranked[0], frame)]
    for number, entry in enumerate(ranked):
        for place, family in enumerate(entry.families):
            at = frame.column(place, number)
            parts += _dots(ratios[entry.name][place], at, _colour(number), y)
            parts += _mean(family.ratio, at, number, y)
        at = legend + LINE * number
        parts += [
            _sign(LEFT + 4, at, number),
            _text(LEFT + 16, at + 4, shown(entry.name, limit=NAME)),
        ]
    return with_dark_colours(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}"'
        f' width="{width}" height="{height}" font-family="sans-serif" font-size="12">\n'
        + "\n".join(parts)
        + "\n</svg>\n"
    )


def _colour(number: int) -> str:
    return COLOURS[number % len(COLOURS)]


def _text(x: float, y: float, words: str, *, soft: bool = False, more: str = "") -> str:
    ink = PALETTE["soft" if soft else "ink"].light
    return f'<text x="{x}" y="{y}" fill="{ink}"{more}>{xml_text(words)}</text>'


def _frame(suite: Suite, y: Axis, end: float) -> Iterator[str]:
    line = PALETTE["line"].light
    yield _text(LEFT, 22, f"{suite.name}: {suite.about}", more=' font-size="15"')
    for value in y.ticks:
        at = y.at(value)
        yield f'<path d="M {LEFT} {at} H {end}" stroke="{line}"/>'
        yield _text(LEFT - 8, at + 4, f"{value:g}", soft=True, more=' text-anchor="end"')
    middle = (y.start + y.end) / 2
    turn = f' text-anchor="middle" transform="rotate(-90 18 {middle})"'
    yield _text(18, middle, "cost / LB", soft=True, more=turn)


def _names(entry: LeagueEntry, frame: Frame) -> Iterator[str]:
    line, bottom = PALETTE["line"].light, frame.bottom
    for place, family in enumerate(entry.families):
        if place:
            at = round(LEFT + frame.band * place, 1)
            yield f'<path d="M {at} {TOP} V {bottom}" stroke="{line}"/>'
        at = round(LEFT + frame.band * (place + 0.5), 1)
        yield _text(at, bottom + 16, f"{place + 1}", soft=True, more=' text-anchor="middle"')
        words = f"{place + 1}: {family.family}, {family.edges:.0f} edges"
        yield _text(LEFT, bottom + BOTTOM + 6 + LINE * place, words)


def _dots(ratios: Sequence[float], at: float, colour: str, y: Axis) -> Iterator[str]:
    for up in dict.fromkeys(map(y.at, ratios)):
        yield f'<circle cx="{at}" cy="{up}" r="1.8" fill="{colour}" fill-opacity="0.35"/>'


def _mean(ratio: MeanInterval, at: float, number: int, y: Axis) -> Iterator[str]:
    if ratio.low is not None and ratio.high is not None and ratio.low < ratio.high:
        low, high = y.at(max(ratio.low, y.low)), y.at(min(ratio.high, y.high))
        yield f'<path d="M {at} {low} V {high}" stroke="{_colour(number)}" stroke-width="2"/>'
    yield _sign(at, y.at(ratio.mean), number)


def _sign(x: float, y: float, number: int) -> str:
    corners = CORNERS[number % len(CORNERS)]
    style = f'fill="{_colour(number)}" stroke="{PALETTE["card"].light}"'
    if not corners:
        return f'<circle cx="{x}" cy="{y}" r="4.5" {style}/>'
    turns = (2 * pi * k / corners for k in range(corners))
    points = " ".join(f"{x + 5.5 * sin(turn):.1f},{y - 5.5 * cos(turn):.1f}" for turn in turns)
    return f'<polygon points="{points}" {style}/>'
