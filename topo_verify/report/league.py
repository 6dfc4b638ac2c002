"""The league table of the arena, for people: blocks, CSV, a plot of ratio against size.

What differs from run to run (time, memory) stands in columns of its own, which the files of a
folder leave out: they are the same, byte for byte, whenever the same runs are made again.

**The plot** shows cost / LB against the number of edges, as plain SVG. A small dot a world; a large
sign a family, at its mean size and mean ratio, with its confidence interval as a bar. Both axes are
logarithmic. Colours are after M. Okabe and K. Ito; the signs differ in shape as well, and the
legend names them in the order of the table. The light card can be read on a dark page. Coordinates
are rounded, so the same runs give the same bytes.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Mapping, Sequence
from io import StringIO
from math import ceil, cos, log, pi, sin
from typing import NamedTuple

from topo_verify.campaign.judge import in_words
from topo_verify.campaign.row import Row
from topo_verify.errors import plural
from topo_verify.report.blocks import Block, Bullets, Cell, Command, Text, TextTable
from topo_verify.report.html import xml_text
from topo_verify.report.style import PALETTE
from topo_verify.studies.arena.league import LeagueBehind, LeagueEntry, MeanInterval
from topo_verify.studies.arena.suites import Suite

Memory = Callable[[LeagueEntry], float | None]
"""The mebibytes that a mapper took in its dearest world of a suite, if they are known."""


def suite_blocks(
    suite: Suite, entries: Sequence[LeagueEntry], seed: int, memory: Memory | None
) -> Iterator[Block]:
    """The table of a suite, the families in it, and what kept mappers from a place.

    Args:
        entries: of this suite.
        memory: for the columns of time and memory; None: without them.
    """
    ranked = [entry for entry in entries if entry.place is not None]
    if ranked:
        yield _league(suite, ranked, seed, memory)
        if len(suite.families) > 1:
            yield Text("")
            yield _families(ranked)
    else:
        yield Text(f"{suite.name}: no mapper has a place")
    late = [entry for entry in entries if entry.place is None and entry.counterexample is None]
    for entry in late:
        gone = entry.total - entry.worlds
        yield Text("")
        yield Text(
            f"{entry.mapper} has no place in {suite.name}: {plural(gone, 'world')} of {entry.total}"
            " not decided"
        )
        if entry.why:
            yield Bullets(entry.why)


def _league(
    suite: Suite, ranked: Sequence[LeagueEntry], seed: int, memory: Memory | None
) -> TextTable:
    varying = (">ms/move", ">MiB") if memory is not None else ()
    columns = (">#", "mapper", ">cost/LB", ">behind", ">free", *varying, "claims")
    drawn = "" if suite.exact else f", seed {seed}"
    title = f"{suite.name}: {suite.about}, {plural(ranked[0].total, 'world')}{drawn}"
    rows = [
        (
            str(entry.place),
            entry.mapper,
            _figure(entry.ratio),
            _figure(entry.behind, sign="+"),
            _free(entry),
            *(() if memory is None else _varying(entry, memory(entry))),
            claims_in_words(entry),
        )
        for entry in ranked
    ]
    return TextTable(columns, rows, title)


def _families(ranked: Sequence[LeagueEntry]) -> TextTable:
    """cost / LB of each mapper, a row a family."""
    rows = [
        (of_family[0].family, f"{of_family[0].edges:.0f}", *(_figure(f.ratio) for f in of_family))
        for of_family in zip(*(entry.families for entry in ranked), strict=True)
    ]
    return TextTable(("family", ">edges", *(f">{entry.mapper}" for entry in ranked)), rows)


def claims_in_words(entry: LeagueEntry) -> str:
    """How many claims hold, and how many of them were judged in part or not at all."""
    if {*entry.claims.values()} == {"ok"}:
        return f"{len(entry.claims)} hold"
    return in_words(entry.claims, "hold")


def _figure(found: MeanInterval | LeagueBehind | None, sign: str = "") -> str:
    """A mean and how far its interval reaches to each side; JSON has more digits."""
    if found is None:
        return "-"
    mean = f"{found.mean:{sign}.2f}"
    if found.high is None:
        return mean
    reach = found.high - found.mean
    return f"{mean} ± {reach:.2f}" if reach else f"{mean} exact"


def _free(entry: LeagueEntry) -> str:
    rejected = entry.rejected_free + entry.rejected_moving
    return f"{entry.rejected_free / rejected:.0%}" if rejected else "-"


def _varying(entry: LeagueEntry, memory: float | None) -> tuple[str, str]:
    """What differs from run to run: milliseconds a move, mebibytes."""
    time = "-" if entry.ms_per_move is None else f"{entry.ms_per_move:.3f}"
    return time, "-" if memory is None else f"{memory:.0f}"


def broken_blocks(entries: Sequence[LeagueEntry]) -> Iterator[Block]:
    """The mappers that broke a claim: no place, only the counterexample."""
    broken = {e.mapper: e.counterexample for e in entries if e.counterexample is not None}
    if broken:
        rows = [
            (mapper, Cell(found.claim, tone="failed"), found.world, found.suite)
            for mapper, found in broken.items()
        ]
        yield Text("")
        columns = ("mapper", "claim that fails", "world", "suite")
        yield TextTable(columns, rows, title="No place, for a claim fails")
    for mapper, found in broken.items():
        yield Text("")
        yield Text(f"{mapper} in {found.world}:")
        yield Bullets((f"{found.claim}: {found.message}",))
        if found.replay:
            yield Command(found.replay, "again: ")


# ---------------------------------------------------------------- CSV

TABLE = (
    *("place", "mapper", "suite", "family", "worlds", "edges", "least", "cost"),
    *("ratio", "low", "high", "behind", "behind_low", "behind_high"),
    *("rejected_free", "rejected_moving", "claims", "counterexample"),
)
"""The columns of `table_csv`."""


def table_csv(entries: Sequence[LeagueEntry]) -> str:
    """A row a mapper and suite, then a row a family of it, where there are several."""
    return _csv(TABLE, [row for entry in entries for row in _rows(entry)])


def _rows(entry: LeagueEntry) -> Iterator[Sequence[object]]:
    ratio, behind = entry.ratio, entry.behind
    found = entry.counterexample
    one = entry.families[0] if len(entry.families) == 1 else None
    yield (
        *(entry.place, entry.mapper, entry.suite, one.family if one else "", entry.worlds),
        *((one.edges, one.least, one.cost) if one else (None, None, None)),
        *((ratio.mean, ratio.low, ratio.high) if ratio else (None, None, None)),
        *((behind.mean, behind.low, behind.high) if behind else (None, None, None)),
        *(entry.rejected_free, entry.rejected_moving, claims_in_words(entry)),
        f"{found.claim} in {found.world}" if found else None,
    )
    for family in entry.families if one is None else ():
        mean = family.ratio
        yield (
            *(None, entry.mapper, entry.suite, family.family, family.worlds),
            *(family.edges, family.least, family.cost, mean.mean, mean.low, mean.high),
            *(None,) * (len(TABLE) - 11),
        )


RUNS = (
    *("mapper", "suite", "world", "edges", "least", "cost", "ratio"),
    *("rejected_free", "rejected_moving"),
)
"""The columns of `runs_csv`."""


def runs_csv(runs: Mapping[tuple[str, str], Sequence[Row]]) -> str:
    """A row a run, by mapper and suite."""
    return _csv(
        RUNS,
        [
            (
                *(mapper, suite, run.world, run.edges, run.least, run.cost, round(run.ratio, 6)),
                *(run.free, run.moving),
            )
            for (mapper, suite), made in runs.items()
            for run in made
        ],
    )


def _csv(columns: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    out = StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(rows)
    return out.getvalue()


# ---------------------------------------------------------------- the plot

WIDTH, HEIGHT = 720, 430
LEFT, RIGHT, TOP, BOTTOM = 62, 210, 64, 48

COLOURS = (
    *("#0072b2", "#d55e00", "#00805f", "#9e4a86", "#946b00", "#22282e", "#3a8fb7", "#b3261e"),
    *("#6d7780", "#5b6b00"),
)
"""The colours of the mappers, in the order of the table; then they begin anew."""

CORNERS = (0, 4, 3, 5, 8, 6, 7)
"""The corners of the signs, in the same order; 0: a circle. With ten colours: 70 different ones."""

NAME = 26
"""The most characters of a name in the legend."""

TICKS = (1, 2, 5)
FEWEST = 3
"""So many values stand beside an axis, if steps of a tenth give them."""

SHIFT, SPREAD = 5.0, 16.0
"""Pixels between the signs of two mappers at one family, so that equal ones are both seen; and of
all of them together at most, so that families stay apart."""


class Axis(NamedTuple):
    """A logarithmic axis: values, and the pixels at which the first and the last one lie."""

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
        """The values that are written beside the axis: three, if steps of 0.1 give them."""
        powers = range(5)
        every = [tick * 10**power for power in powers for tick in TICKS]
        found: list[float] = [value for value in every if self.low <= value <= self.high]
        for tenths in reversed(TICKS):
            if len(found) < FEWEST:
                steps = range(ceil(10 * self.low / tenths), int(10 * self.high / tenths) + 1)
                found = [step * tenths / 10 for step in steps]
        return found


def ratio_plot(
    suite: Suite, ranked: Sequence[LeagueEntry], runs: Mapping[str, Sequence[Row]]
) -> str:
    """The picture of a suite.

    Args:
        ranked: the entries of the mappers that have a place, one at least.
        runs: of each of these mappers.
    """
    every = [run for made in runs.values() for run in made]
    edges, ratios = [run.edges for run in every], [run.ratio for run in every]
    x = Axis(min(edges) / 1.15, max(edges) * 1.15, LEFT, WIDTH - RIGHT)
    y = Axis(min(1.0, *ratios) / 1.04, max(1.1, *ratios) * 1.08, HEIGHT - BOTTOM, TOP)
    parts = [*_frame(suite, x, y), *_names(ranked[0], x)]
    for number, entry in enumerate(ranked):
        parts += _dots(runs[entry.mapper], _colour(number), x, y)
    middle = (len(ranked) - 1) / 2
    step = min(SHIFT, SPREAD / (2 * middle)) if middle else 0.0
    for number, entry in enumerate(ranked):
        parts += _means(entry, number, step * (number - middle), x, y)
        parts += _legend(entry, number)
    return (
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
    """Card, title, grid and axes."""
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
    """The names of the families above their places, in three rows so that none covers another."""
    line = PALETTE["faint"].light
    for number, family in enumerate(sorted(entry.families, key=lambda one: one.edges)):
        at = min(max(x.at(family.edges), LEFT + 60), WIDTH - RIGHT - 20)
        more = ' text-anchor="middle" font-size="10"'
        yield (
            f'<path d="M {x.at(family.edges)} {TOP} V {HEIGHT - BOTTOM}" stroke="{line}"'
            ' stroke-dasharray="2 4"/>'
        )
        yield _text(at, TOP - 4 - 12 * (number % 3), family.family, soft=True, more=more)


def _dots(runs: Sequence[Row], colour: str, x: Axis, y: Axis) -> Iterator[str]:
    places = dict.fromkeys((x.at(run.edges), y.at(run.ratio)) for run in runs)
    for across, up in places:
        yield f'<circle cx="{across}" cy="{up}" r="1.8" fill="{colour}" fill-opacity="0.35"/>'


def _means(entry: LeagueEntry, number: int, shift: float, x: Axis, y: Axis) -> Iterator[str]:
    """The sign of each family, and the bar of its interval."""
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
