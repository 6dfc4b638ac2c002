"""The paragraph under a figure: what agrees with the paper, what does not, what cannot be compared.

Every sentence is computed from the points. The paper's statements are those of its text (sections
I, III and IV), not read off its pictures.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from topo_verify.errors import plural
from topo_verify.extra.figures.figures import FIGURES, LATTICE, Figure
from topo_verify.extra.figures.points import FigurePoint

SHORT = {
    "basic": "basic",
    "enhancement-i": "I",
    "enhancement-ii": "II",
    "enhancement-ii+i": "II+I",
    "enhancement-iii-one": "III one",
    "enhancement-iii-one+i": "III one+I",
    "enhancement-iii-all": "III all",
    "enhancement-iii-all+i": "III all+I",
    "folding": "folding",
    "edges": "edges m",
    "least-cost": "least cost",
}
"""`+I` walks as Enhancement I does: on from where a percept differed."""


# ---------------------------------------------------------------- paragraphs

_Line = dict[int, FigurePoint]


LADDER = (
    "basic",
    "enhancement-i",
    "enhancement-ii",
    "enhancement-iii-one",
    "enhancement-iii-all",
)
"""By cost, according to the paper."""


def paragraph(
    figure: Figure, points: Sequence[FigurePoint], others: Sequence[FigurePoint] = ()
) -> str:
    """The paragraph under a figure.

    Args:
        others: points of other figures, for statements across figures.
    """
    lines = {
        name: {p.size: p for p in points if p.algorithm == name and p.is_reference}
        for name in (*figure.lines, "edges", "least-cost")
    }
    earlier = {
        p.algorithm: {q.size: q for q in others if q.algorithm == p.algorithm and q.is_reference}
        for p in others
        if FIGURES[p.figure].setting is figure.setting
    }
    sentences = [
        *_stated(figure, lines),
        *_first_beyond(figure, lines["basic"]),
        *_order(figure, earlier | lines),
        *_reduction(figure, lines),
        *_growths(lines),
        *_yardsticks(lines),
        *_policies(figure, points),
        _open(figure),
    ]
    return " ".join(sentences)


def _stated(figure: Figure, lines: dict[str, _Line]) -> Iterator[str]:
    for (name, size), stated in figure.stated.items():
        point = lines[name].get(size)
        if point is None:
            continue
        yield (
            f"Not reproduced: at {size}×{size} the paper states {stated.words} edge"
            f" traversals for {SHORT[name]}, measured are {_cost(point)},"
            f" {_percent(point.mean / stated.cost)} of that."
        )


def _first_beyond(figure: Figure, basic: _Line) -> Iterator[str]:
    stated = figure.stated.get(("basic", 10))
    if stated is None or not basic:
        return
    size = next((size for size, point in basic.items() if point.mean >= stated.cost), None)
    if size is None:
        yield f"No size here has a basic mean of {stated.cost:,} or more."
    else:
        yield f"The first size here whose basic mean reaches {stated.cost:,} is {size}×{size}."


def _order(figure: Figure, lines: dict[str, _Line]) -> Iterator[str]:
    for before, after in pairwise(LADDER):
        if after not in figure.lines or not lines.get(before):
            continue
        both = [size for size in lines[before] if size in lines[after]]
        differ = {s: lines[before][s].mean - lines[after][s].mean for s in both}
        equal = [s for s in both if differ[s] == 0]
        costlier = [s for s in both if differ[s] < 0]
        claim = f"{SHORT[after]} costs less than {SHORT[before]}"
        agreeing = len(both) - len(equal) - len(costlier)
        others = [f"more at {_sizes(costlier)}"] * bool(costlier)
        others += [f"the same at {_sizes(equal)}"] * bool(equal)
        if others:
            head = "Does not agree" if costlier or not agreeing else "Agrees in part"
            yield (
                f"{head}: the paper says that {claim}; in the mean it does at {agreeing} of"
                f" {plural(len(both), 'size')}, and costs {' and '.join(others)}."
            )
        elif both:
            yield f"Agrees: {claim} in the mean at every size."


def _sizes(sizes: Sequence[int]) -> str:
    return f"size {', '.join(map(str, sizes))}"


def _reduction(figure: Figure, lines: dict[str, _Line]) -> Iterator[str]:
    best = [name for name in LADDER if name in figure.lines][-1]
    both = [size for size in lines["basic"] if size in lines[best]]
    if best == "basic" or not both:
        return
    saved = {size: 1 - lines[best][size].mean / lines["basic"][size].mean for size in both}
    sizes = sorted({min(both), max(both), *({10} & {*both} if figure.setting is LATTICE else ())})
    shares = ", ".join(f"{_percent(saved[size])} at size {size}" for size in sizes)
    text = f"{SHORT[best]} saves of basic {shares}"
    stated = [figure.stated.get((name, 10)) for name in ("basic", best)]
    if stated[0] and stated[1]:
        text += f" (the paper at 10: {_percent(1 - stated[1].cost / stated[0].cost)})"
    yield f"{text}; the introduction says up to 60 %, for some environments."


def _growths(lines: dict[str, _Line]) -> Iterator[str]:
    fits = [
        f"{SHORT[name]} {point.growth}"
        for name, line in lines.items()
        if name != "edges" and line and (point := next(iter(line.values()))).growth
    ]
    if fits:
        yield f"Cost grows as a power of m over these sizes, fitted: {', '.join(fits)}."


def _yardsticks(lines: dict[str, _Line]) -> Iterator[str]:
    basic, folding, least = lines["basic"], lines["folding"], lines["least-cost"]
    shared = [size for size in basic if size in folding and size in least]
    if shared:
        size = max(shared)
        floor = least[size].mean
        yield (
            f"At size {size} no mapper that is right in all worlds can pay less than"
            f" {floor:,.0f} on average, {floor / least[size].edges:.1f} times m; basic pays"
            f" {basic[size].mean / floor:.1f} times that least cost, folding"
            f" {folding[size].mean / floor:.1f} times."
        )


def _policies(figure: Figure, points: Sequence[FigurePoint]) -> Iterator[str]:
    pairs = {point.pair for point in points} - {None}
    if len(pairs) < 2:
        return
    sizes = {point.size for point in points}
    size = 10 if figure.setting is LATTICE and 10 in sizes else max(sizes)
    for name in figure.lines:
        if name.endswith("+i"):
            continue
        here = [p for p in points if p.algorithm == name and p.size == size and p.mean]
        low, high = (pick(here, key=lambda p: p.mean) for pick in (min, max))
        yield (
            f"Over {len(pairs)} pairs of policies {SHORT[name]} costs {low.mean:,.0f}"
            f" ({low.pair}) to {high.mean:,.0f} ({high.pair}) at size {size}."
        )


def _open(figure: Figure) -> str:
    if figure.setting is LATTICE:
        return (
            "The text leaves open which edge and which hypothesis come next, where the marker lies,"
            " and every size but 10×10."
        )
    return (
        "The text gives no number for dense graphs, and neither their degree nor their sizes;"
        " degree 8 is our choice. Only the order of the algorithms can be compared."
    )


def _cost(point: FigurePoint) -> str:
    error = "" if point.stderr is None else f" ± {point.stderr:,.0f}"
    return f"{point.mean:,.0f}{error}"


def _percent(share: float) -> str:
    return f"{share * 100:.0f} %"


# ---------------------------------------------------------------- the page

PAGE = "figures.md"


def stem(figure: Figure) -> str:
    """A figure's file name without an ending."""
    return f"figure-{figure.name}"


def page(
    figures: Sequence[tuple[Figure, Sequence[FigurePoint]]],
    *,
    command: str,
    judged: str,
) -> str:
    """All figures with their paragraphs as one Markdown file.

    Args:
        command: the command line that makes it again.
        judged: a sentence on what was judged.
    """
    lines = ["# The paper's figures", "", "Made by", "", f"    {command}", "", judged, ""]
    every = [point for _, points in figures for point in points]
    for figure, points in figures:
        lines += [f"## Figure {figure.name}: {figure.title}", ""]
        lines += [f"![Figure {figure.name}: {figure.title}]({stem(figure)}.svg)", ""]
        lines += [paragraph(figure, points, every), ""]
    return "\n".join(lines)


def judged_sentence(points: Sequence[FigurePoint]) -> str:
    """The number of runs behind these points, and of claims that held."""
    # A point of two figures, as basic at 10×10 of 3 and 6a, is one.
    distinct = {
        (FIGURES[p.figure].setting.name, p.algorithm, p.size, p.pair): p
        for p in points
        if p.pair is not None
    }.values()
    runs = sum(point.graphs for point in distinct)
    failed = len({finding.replay for point in distinct for finding in point.findings})
    undecided = sum(point.undecided for point in distinct)
    text = f"{runs:,} runs were judged"
    if failed:
        text += f": a claim fails in {failed} of them."
    else:
        counts: dict[tuple[int, int], int] = {}
        for point in distinct:
            counts[point.held, point.of] = counts.get((point.held, point.of), 0) + point.graphs
        if len(counts) <= 1:
            (some, of), *_ = counts or [(0, 0)]
            text += f": {some} of {of} claims held in each."
        else:
            parts = [f"{some} of {of} claims in {n:,}" for (some, of), n in sorted(counts.items())]
            text += f": of those asked held {', '.join(reversed(parts))}."
    return text + (f" {undecided} more were not decided." if undecided else "")
