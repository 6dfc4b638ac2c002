"""SVG path data: written from control points, and flattened into points.

Only absolute `M`, `L` and `Q` occur.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

import numpy as np

from topo_verify.world.drawing.arrays import Floats
from topo_verify.world.formats.embedding import Point

STEPS = 8
"""The pieces into which a quadratic arc is flattened."""


def number(value: float) -> str:
    """The coordinate with two decimals at most, never `-0`."""
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def straight(points: Iterable[Point]) -> str:
    """Path data of the polyline."""
    return "M" + "L".join(f"{number(x)} {number(y)}" for x, y in points)


def smooth(points: Sequence[Point], rounding: float = 0.5) -> str:
    """Path data of the polyline with rounded corners.

    Args:
        rounding: how far along each leg a corner's arc reaches; 0.5 is the quadratic B-spline, 0
            the polyline itself.
    """
    if len(points) < 3 or not rounding:
        return straight(points)
    data = [f"M{_pair(points[0])}"]
    last = len(points) - 2
    for k in range(1, len(points) - 1):
        before, corner, after = points[k - 1 : k + 2]
        # The first and the last leg have one corner only: it may take more of them.
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
    """The points of the path, arcs in `STEPS` pieces.

    Raises:
        ValueError: the data holds anything but absolute M, L and Q.
    """
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


def place(points: Floats, distance: float) -> Floats:
    """The point at this distance along the polyline."""
    steps = np.hypot(*np.diff(points, axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    return np.array([np.interp(distance, along, points[:, k]) for k in (0, 1)])


def piece(points: Floats, middle: float, half: float) -> str:
    """Path data of the part of the polyline within `half` of the place `middle` along it."""
    steps = np.hypot(*np.diff(points, axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    low, high = max(0.0, middle - half), min(float(along[-1]), middle + half)
    inside = [place for place in along.tolist() if low < place < high]
    places = [low, *inside, high]
    xs, ys = (np.interp(places, along, points[:, k]) for k in (0, 1))
    kept = [(float(xs[0]), float(ys[0]))]
    for x, y in zip(xs.tolist()[1:], ys.tolist()[1:], strict=True):
        if (x, y) != kept[-1]:
            kept.append((x, y))
    return straight(kept)
