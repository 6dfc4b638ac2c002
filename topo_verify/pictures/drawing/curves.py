"""SVG path data of absolute `M`, `L` and `Q`."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from topo_verify.pictures.drawing.arrays import Floats, Ints
from topo_verify.world.formats.junctions import Point

STEPS = 8
"""Pieces of a flattened quadratic arc."""


def number(value: float) -> str:
    """The coordinate with at most two decimals, never `-0`."""
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def straight(points: Iterable[Point]) -> str:
    """Path data of the polyline."""
    return "M" + "L".join(map(_pair, points))


def smooth(points: Sequence[Point], rounding: float = 0.5) -> str:
    """Path data of the polyline with rounded corners.

    Args:
        rounding: how far along each leg a corner's arc reaches; 0.5 is the quadratic B-spline.
    """
    if len(points) < 3 or not rounding:
        return straight(points)
    data = [f"M{_pair(points[0])}"]
    last = len(points) - 2
    for k in range(1, len(points) - 1):
        before, corner, after = points[k - 1 : k + 2]
        start = _between(corner, before, rounding if k > 1 else min(1.0, 1.6 * rounding))
        end = _between(corner, after, rounding if k < last else min(1.0, 1.6 * rounding))
        if rounding < 0.5 or k == 1:
            data.append(f"L{_pair(start)}")
        data.append(f"Q{_pair(corner)} {_pair(end)}")
    data.append(f"L{_pair(points[-1])}")
    return "".join(data)


def _pair(point: Point) -> str:
    return f"{number(point[0])} {number(point[1])}"


def _between(a: Point, b: Point, share: float) -> Point:
    return (a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share)


_WORD = re.compile(r"[MLQ]|-?\d+(?:\.\d+)?")


def flatten(data: str) -> Floats:
    """The points of the path, arcs in `STEPS` pieces; ValueError for other commands."""
    if _WORD.sub("", data).strip(" "):
        raise ValueError(f"expected absolute M, L and Q in path data, got {data!r}")
    words = iter(_WORD.findall(data))
    points: list[Point] = []
    for command in words:
        take = [float(next(words)) for _ in range(4 if command == "Q" else 2)]
        if command == "Q":
            points += _arc(points[-1], (take[0], take[1]), (take[2], take[3]))
        else:
            points.append((take[0], take[1]))
    return np.array(points)


def _arc(a: Point, b: Point, c: Point) -> list[Point]:
    arc: list[Point] = []
    for k in range(1, STEPS + 1):
        t = k / STEPS
        u, v, w = (1 - t) * (1 - t), 2 * t * (1 - t), t * t
        arc.append((u * a[0] + v * b[0] + w * c[0], u * a[1] + v * b[1] + w * c[1]))
    return arc


def length(points: Floats) -> float:
    """The length of the polyline."""
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def place(points: Floats, distance: float | Floats) -> Floats:
    """The points at these distances along the polyline."""
    along = _along(points)
    return np.stack([np.interp(distance, along, points[:, k]) for k in (0, 1)], -1)


def _along(points: Floats) -> Floats:
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])


def piece(points: Floats, middle: float, half: float) -> str:
    """Path data of the polyline within `half` of `middle` along it."""
    along = _along(points)
    low, high = max(0.0, middle - half), min(float(along[-1]), middle + half)
    inside = [place for place in along.tolist() if low < place < high]
    ends = place(points, np.array([low, *inside, high]))
    return straight(dict.fromkeys((x, y) for x, y in ends.tolist()))


def distances(points: Floats, line: Floats) -> Floats:
    """The distance of each point from the polyline."""
    start, step = line[:-1], np.diff(line, axis=0)
    square = np.maximum((step**2).sum(1), 1e-24)
    offset = points[:, None] - start[None]
    t = np.clip((offset * step[None]).sum(2) / square, 0, 1)
    gap = offset - t[:, :, None] * step[None]
    apart: Floats = np.sqrt((gap**2).sum(2)).min(1)
    return apart


class Crossing(NamedTuple):
    """A crossing of two curves."""

    first: int
    second: int
    at: tuple[float, float]
    along_first: float
    along_second: float


def crossings(curves: Sequence[Floats]) -> list[Crossing]:
    """All crossings and touches of the polylines, each with itself included."""
    starts, steps, owner, place, along = _legs(curves)
    if not len(owner):
        return []
    first, second = _close(starts, steps)
    follow = (owner[first] == owner[second]) & (np.abs(place[first] - place[second]) < 2)
    first, second = first[~follow], second[~follow]
    p, q, offset = steps[first], steps[second], starts[second] - starts[first]
    turn = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (offset[:, 0] * q[:, 1] - offset[:, 1] * q[:, 0]) / turn
        u = (offset[:, 0] * p[:, 1] - offset[:, 1] * p[:, 0]) / turn
        hit = (t >= 0) & (t < 1) & (u >= 0) & (u < 1)
    result: list[Crossing] = []
    for i, j, s, r in zip(first[hit], second[hit], t[hit], u[hit], strict=True):
        x, y = starts[i] + s * steps[i]
        reach = (float(np.hypot(*steps[k])) * float(part) for k, part in ((i, s), (j, r)))
        a, b = (float(along[k]) + more for k, more in zip((i, j), reach, strict=True))
        result.append(Crossing(int(owner[i]), int(owner[j]), (float(x), float(y)), a, b))
    return result


def _legs(curves: Sequence[Floats]) -> tuple[Floats, Floats, Ints, Ints, Floats]:
    curves = [curve if len(curve) > 1 else np.zeros((1, 2)) for curve in curves]
    starts = np.concatenate([np.zeros((0, 2)), *(curve[:-1] for curve in curves)])
    steps = np.concatenate([np.zeros((0, 2)), *(np.diff(curve, axis=0) for curve in curves)])
    counts = [len(curve) - 1 for curve in curves]
    owner = np.repeat(np.arange(len(curves)), counts)
    place = np.concatenate([np.zeros(0, int), *(np.arange(count) for count in counts)])
    lengths = np.hypot(steps[:, 0], steps[:, 1])
    total = np.concatenate([[0.0], np.cumsum(lengths)])[:-1]
    begin = np.concatenate([[0], np.cumsum(counts)])[:-1][owner] if len(owner) else owner
    return starts, steps, owner, place, total - total[begin] if len(owner) else total


def _close(starts: Floats, steps: Floats) -> tuple[Ints, Ints]:
    ends = starts + steps
    low, high = np.minimum(starts, ends), np.maximum(starts, ends)
    extent = float((high.max(0) - low.min(0)).max())
    cell = max(float(np.median((high - low).max(1))) * 2, extent / 400, 1e-9)
    least, most = np.floor(low / cell).astype(int), np.floor(high / cell).astype(int)
    spans = most - least + 1
    counts = spans[:, 0] * spans[:, 1]
    leg = np.repeat(np.arange(len(starts)), counts)
    inner = np.arange(len(leg)) - np.repeat(np.cumsum(counts) - counts, counts)
    column = least[leg, 0] + inner % spans[leg, 0]
    row = least[leg, 1] + inner // spans[leg, 0]
    key = (column - column.min()) * (int(row.max() - row.min()) + 1) + row - row.min()
    by_cell = np.argsort(key, kind="stable")
    leg, key = leg[by_cell], key[by_cell]
    left, right = [np.zeros(0, int)], [np.zeros(0, int)]
    for gap in range(1, len(leg)):
        same = key[gap:] == key[:-gap]
        if not same.any():
            break
        left.append(leg[:-gap][same])
        right.append(leg[gap:][same])
    a, b = np.concatenate(left), np.concatenate(right)
    lesser, greater = np.minimum(a, b), np.maximum(a, b)
    pairs = np.unique(lesser * len(starts) + greater)
    first, second = pairs // len(starts), pairs % len(starts)
    box = (low[first] <= high[second]).all(1) & (low[second] <= high[first]).all(1)
    return first[box], second[box]
