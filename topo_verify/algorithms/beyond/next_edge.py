"""Which edge a steered mapper settles next: the one behind which the robot can be soonest.

If all vertices look alike, doors tell nothing before v0, and short closed trips are worth most. The
shortest lead round a face, so the next edge is then nearest to the newest vertex of S; ties go
clockwise from its dart of entry.

Source: docs/homing.md.
"""

from __future__ import annotations

from collections.abc import Callable

from topo_verify.algorithms.beyond.folding import NodeDart
from topo_verify.algorithms.beyond.history import History
from topo_verify.robot.events import MapDart

OUTWARD = 0.2
"""Value of a step away from home to `outward_edge`, in moves."""

Rank = tuple[float, int, MapDart]
"""The next edge has the least: moves until the robot is behind it, tie-break, e."""


def nearest_edge(history: History) -> MapDart:
    """The dart of U behind which the robot is soonest; ties: one never crossed."""
    if look_alike(history):
        return edge_along_face(history)
    return least(history, history.at, lambda e, moves: (moves, e in history.crossed, e))


def outward_edge(history: History) -> MapDart:
    """The nearest dart of U, less `OUTWARD` moves for each step away from home."""
    if look_alike(history):
        return edge_along_face(history)
    depth, vertex = history.home().depth, history.chart.vertex

    def rank(e: MapDart, moves: int) -> Rank:
        return moves - OUTWARD * depth[vertex[e]], e in history.crossed, e

    return least(history, history.at, rank, slack=OUTWARD * max(depth))


def look_alike(history: History) -> bool:
    """Whether all vertices of S have one degree."""
    return len(set(history.chart.degree)) == 1


def edge_along_face(history: History) -> MapDart:
    """The dart of U nearest to the newest vertex; ties: the least turn at its vertex."""
    first, vertex = history.chart.first, history.chart.vertex
    newest = history.node_dart(first[-1])
    return least(history, newest, lambda e, moves: (moves, e - first[vertex[e]], e))


def least(
    history: History, start: NodeDart, rank: Callable[[MapDart, int], Rank], *, slack: float = 0
) -> MapDart:
    """The dart of U with the least rank; `slack`: how far a rank may be below the moves."""
    best: Rank | None = None
    for place, distance, _ in history.outward(start):
        if best is not None and distance - slack > best[0]:
            break
        for e in history.leads(place):
            e_rank = rank(e, distance + (e not in history.crossed))
            best = e_rank if best is None else min(best, e_rank)
    assert best is not None, "U is not empty and S is connected"
    return best[2]
