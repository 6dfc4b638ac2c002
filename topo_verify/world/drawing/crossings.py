"""Where flattened curves cross, found on a grid of cells."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from topo_verify.world.drawing.arrays import Floats, Ints


class Crossing(NamedTuple):
    """Two curves cross: their indices, where, and how far along each."""

    first: int
    second: int
    at: tuple[float, float]
    along_first: float
    along_second: float


def crossings(curves: Sequence[Floats]) -> list[Crossing]:
    """All crossings and touches of the polylines, each with itself included.

    Two legs that follow each other on one curve meet in their common point: that is no crossing.
    """
    starts, steps, owner, place, along = _legs(curves)
    if not len(owner):
        return []
    first, second = _close(starts, steps)
    # Legs that follow each other on one curve share a point.
    follow = (owner[first] == owner[second]) & (np.abs(place[first] - place[second]) < 2)
    first, second = first[~follow], second[~follow]
    p, q, offset = steps[first], steps[second], starts[second] - starts[first]
    turn = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (offset[:, 0] * q[:, 1] - offset[:, 1] * q[:, 0]) / turn
        u = (offset[:, 0] * p[:, 1] - offset[:, 1] * p[:, 0]) / turn
        hit = (t >= 0) & (t < 1) & (u >= 0) & (u < 1)  # False where parallel
    found: list[Crossing] = []
    for i, j, s, r in zip(first[hit], second[hit], t[hit], u[hit], strict=True):
        x, y = starts[i] + s * steps[i]
        reach = (float(np.hypot(*steps[k])) * float(part) for k, part in ((i, s), (j, r)))
        a, b = (float(along[k]) + more for k, more in zip((i, j), reach, strict=True))
        found.append(Crossing(int(owner[i]), int(owner[j]), (float(x), float(y)), a, b))
    return found


def _legs(curves: Sequence[Floats]) -> tuple[Floats, Floats, Ints, Ints, Floats]:
    """Of every leg of every curve: start, step, whose it is, its place, how far along it begins."""
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
    """Pairs of legs (the lesser first) whose boxes share a cell of a grid."""
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
