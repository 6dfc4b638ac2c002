"""All figures as one Markdown file: each picture, and the paragraph under it."""

from __future__ import annotations

from collections.abc import Sequence

from topo_verify.harness.reproduce.figures import FIGURES, Figure
from topo_verify.harness.reproduce.points import FigurePoint
from topo_verify.report.figures.words import paragraph

PAGE = "figures.md"
"""The name of the file."""


def stem(figure: Figure) -> str:
    """The name of the files of a figure, without an ending."""
    return f"figure-{figure.name}"


def page(
    found: Sequence[tuple[Figure, Sequence[FigurePoint]]],
    *,
    command: str,
    judged: str,
    pictures: bool,
) -> str:
    """All figures with their paragraphs, as one Markdown file.

    Args:
        command: the command line that makes it again.
        judged: a sentence on what was judged.
        pictures: whether there are pictures to show.
    """
    lines = ["# The paper's figures", "", "Made by", "", f"    {command}", "", judged, ""]
    every = [point for _, points in found for point in points]
    for figure, points in found:
        lines += [f"## Figure {figure.name}: {figure.title}", ""]
        if pictures:
            lines += [f"![Figure {figure.name}: {figure.title}]({stem(figure)}.svg)", ""]
        lines += [paragraph(figure, points, every), ""]
    return "\n".join(lines)


def judged_sentence(points: Sequence[FigurePoint]) -> str:
    """How many runs stand behind these points, and how many claims held in each."""
    # A point of two figures, as basic at 10×10 of 3 and 6a, is one.
    asked = {
        (FIGURES[p.figure].setting.name, p.algorithm, p.size, p.pair): p
        for p in points
        if p.pair is not None
    }.values()
    runs = sum(point.graphs for point in asked)
    failed = len({finding.replay for point in asked for finding in point.findings})
    undecided = sum(point.undecided for point in asked)
    text = f"{runs:,} runs were judged"
    if failed:
        text += f": a claim fails in {failed} of them."
    else:
        held: dict[tuple[int, int], int] = {}
        for point in asked:
            held[point.held, point.of] = held.get((point.held, point.of), 0) + point.graphs
        if len(held) <= 1:
            (some, of), *_ = held or [(0, 0)]
            text += f": {some} of {of} claims held in each."
        else:
            parts = [f"{some} of {of} claims in {n:,}" for (some, of), n in sorted(held.items())]
            text += f": of those asked held {', '.join(reversed(parts))}."
    return text + (f" {undecided} more were not decided." if undecided else "")
