"""A figure of the paper as SVG and PNG: costs on a log scale, means with standard errors.

Colours are after M. Okabe and K. Ito. The same points give the same bytes with one version of
matplotlib.
"""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from math import exp, log
from typing import Any, Literal, NamedTuple

from topo_verify.extra.figures.figures import YARDSTICKS, Figure
from topo_verify.extra.figures.points import FigurePoint
from topo_verify.extra.figures.words import SHORT
from topo_verify.report.html import with_dark_colours

CARD, INK, SOFT, GRID = "#fdfcf9", "#22282e", "#5c656e", "#dcdcd6"

PAPER = "#b3261e"

INCHES = (7.2, 5.0)

GAP = 0.048
"""Least distance of two labels, as a share of the axis."""


class LineStyle(NamedTuple):
    """How a line is drawn."""

    colour: str
    marker: str
    dashes: str = "-"


LINES = {
    "basic": LineStyle("#22282e", "o"),
    "enhancement-i": LineStyle("#d55e00", "s"),
    "enhancement-ii": LineStyle("#0072b2", "^"),
    "enhancement-ii+i": LineStyle("#0072b2", "v", "--"),
    "enhancement-iii-one": LineStyle("#946b00", "D"),
    "enhancement-iii-one+i": LineStyle("#946b00", "d", "--"),
    "enhancement-iii-all": LineStyle("#9e4a86", "P"),
    "enhancement-iii-all+i": LineStyle("#9e4a86", "X", "--"),
    "folding": LineStyle("#00805f", "*"),
    "edges": LineStyle("#6d7780", "", ":"),
    "least-cost": LineStyle("#5c656e", "", "-."),
}

SETTINGS = {
    "svg.hashsalt": "topo-verify",
    "svg.fonttype": "path",
    "font.family": "DejaVu Sans",  # comes with matplotlib
    "font.size": 10,
    "text.color": INK,
    "axes.labelcolor": INK,
    "axes.edgecolor": SOFT,
    "xtick.color": SOFT,
    "ytick.color": SOFT,
}


def picture(figure: Figure, points: Sequence[FigurePoint], kind: Literal["svg", "png"]) -> bytes:
    """The picture of a figure as the content of a file."""
    import matplotlib as mpl
    from matplotlib.figure import Figure as Canvas

    library: Any = mpl
    with library.rc_context(SETTINGS):
        canvas: Any = Canvas(figsize=INCHES, facecolor=CARD, layout="constrained")
        _draw(canvas.add_subplot(), figure, points)
        out = BytesIO()
        none = {"Date": None, "Creator": None} if kind == "svg" else {"Software": None}
        canvas.savefig(out, format=kind, dpi=150, metadata=none)
    content = out.getvalue()
    return content if kind == "png" else with_dark_colours(content.decode()).encode()


def _draw(axes: Any, figure: Figure, points: Sequence[FigurePoint]) -> None:
    axes.set_facecolor(CARD)
    axes.set_yscale("log")
    title = f"Figure {figure.name}: {figure.title}"
    pairs = {point.pair for point in points} - {None}
    if len(pairs) > 1:
        title += f"\nthick bars: lowest to highest mean over {len(pairs)} pairs of policies"
        _spread(axes, figure.lines, points)
    axes.set_title(title, loc="left", fontsize=11)
    axes.set_xlabel(figure.setting.measure)
    axes.set_ylabel("cost (edge traversals)")
    axes.grid(visible=True, which="major", color=GRID, linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)
    sizes = sorted({point.size for point in points})
    if _is_wide(sizes):
        axes.set_xscale("log")
        axes.minorticks_off()
    axes.set_xticks(sizes, [str(size) for size in sizes])
    ends: dict[str, tuple[float, float]] = {}
    for name in (*figure.lines, *YARDSTICKS):
        line = [point for point in points if point.algorithm == name and point.mean > 0]
        reference = [point for point in line if point.is_reference]
        if reference:
            _line(axes, name, reference)
            ends[name] = (reference[-1].size, reference[-1].mean)
    _stated(axes, points)
    if ends:
        _labels(axes, ends, sizes)


def _is_wide(sizes: Sequence[int]) -> bool:
    return max(sizes) > 10 * min(sizes)


def _line(axes: Any, name: str, line: Sequence[FigurePoint]) -> None:
    style = LINES[name]
    axes.errorbar(
        [point.size for point in line],
        [point.mean for point in line],
        yerr=None if name in YARDSTICKS else [point.stderr or 0.0 for point in line],
        color=style.colour,
        linestyle=style.dashes,
        marker=style.marker or None,
        markersize=5,
        linewidth=1.4,
        capsize=2.5,
        zorder=3,
    )


def _spread(axes: Any, names: Sequence[str], points: Sequence[FigurePoint]) -> None:
    sizes = [point.size for point in points]
    step = 0.011 * (max(sizes) - min(sizes))
    for k, name in enumerate(names):
        means: dict[int, list[float]] = {}
        for point in points:
            if point.algorithm == name:
                means.setdefault(point.size, []).append(point.mean)
        axes.vlines(
            [size + (k - (len(names) - 1) / 2) * step for size in means],
            *([pick(values) for values in means.values()] for pick in (min, max)),
            color=LINES[name].colour,
            linewidth=4,
            alpha=0.35,
        )


def _stated(axes: Any, points: Sequence[FigurePoint]) -> None:
    for point in points:
        if point.paper is None:
            continue
        axes.plot(
            [point.size],
            [point.paper],
            marker="^" if "more" in (point.stated or "") else "D",
            markersize=8,
            color=PAPER,
            fillstyle="none",
            markeredgewidth=1.6,
            linestyle="none",
            zorder=4,
        )
        axes.annotate(
            f"paper, {SHORT[point.algorithm]}: {point.stated}",
            (point.size, point.paper),
            xytext=(0, 26) if _is_wide([point.size for point in points]) else (-9, 3),
            textcoords="offset points",
            ha="center" if _is_wide([point.size for point in points]) else "right",
            color=PAPER,
            fontsize=9,
        )


def _labels(axes: Any, ends: dict[str, tuple[float, float]], sizes: Sequence[int]) -> None:
    wide = sizes[-1] - sizes[0] or 1
    if _is_wide(sizes):
        axes.set_xlim(0.9 * sizes[0], 1.9 * sizes[-1])
    else:
        axes.set_xlim(sizes[0] - 0.03 * wide, sizes[-1] + 0.2 * wide)
    low, high = map(log, axes.get_ylim())
    places = spread([log(height) for _, height in ends.values()], GAP * (high - low))
    for (name, (x, height)), place in zip(ends.items(), places, strict=True):
        axes.annotate(
            SHORT[name],
            (x, height),
            xytext=(1.12 * sizes[-1] if _is_wide(sizes) else sizes[-1] + 0.035 * wide, exp(place)),
            textcoords="data",
            va="center",
            color=LINES[name].colour,
            fontsize=9,
            arrowprops={
                "arrowstyle": "-",
                "color": LINES[name].colour,
                "linewidth": 0.6,
                "relpos": (0.0, 0.5),
            },
        )


def spread(places: Sequence[float], gap: float) -> list[float]:
    """The places, moved as little as possible so that any two are at least `gap` apart.

    Neighbours that are too near form a group, spaced evenly around its mean.
    """
    groups: list[list[int]] = []

    def low(group: Sequence[int]) -> float:
        return sum(places[k] for k in group) / len(group) - gap * (len(group) - 1) / 2

    for k in sorted(range(len(places)), key=lambda k: (places[k], k)):
        groups.append([k])
        while len(groups) > 1 and low(groups[-1]) - low(groups[-2]) < gap * (
            len(groups[-2]) - 1e-9
        ):
            groups[-2:] = [groups[-2] + groups[-1]]
    moved = [0.0] * len(places)
    for group in groups:
        for step, k in enumerate(group):
            moved[k] = low(group) + step * gap
    return moved
