"""Which edge a steered mapper settles next: policies for the loop of steering.py.

The next edge is the one behind which the robot is soonest. Where all places look alike it is chosen
otherwise, **along a face**: from the newest vertex of S, and of edges that are equally near the
first one clockwise from the dart by which its vertex was found. No door tells anything there, until
the robot comes to v0. Then small closed trips are worth most, and those that turn at every vertex
to the same side are the smallest: they lead round a face. On tori that saves a third or more.

    letter       what it is
    U, e         as in history.py

Source: docs/homing.md.
"""

from __future__ import annotations

from collections.abc import Callable

from topo_verify.algorithms.folding import NodeDart
from topo_verify.algorithms.history import History
from topo_verify.robot.events import MapDart

OUTWARD = 0.2
"""So many moves each step away from home is worth to `outward_edge`."""

Rank = tuple[float, int, MapDart]
"""What the next edge has least of: moves until the robot is behind it; which of equals; e."""


def nearest_edge(history: History) -> MapDart:
    """The dart of U behind which the robot is soonest; one never crossed wins a tie."""
    if look_alike(history):
        return edge_along_face(history)
    return least(history, history.at, lambda e, moves: (moves, e in history.crossed, e))


def outward_edge(history: History) -> MapDart:
    """The dart of U that is nearest, but for a fraction of a move for each step away from home."""
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
    """The dart of U that is nearest to the newest vertex; ties: the least turn at its vertex."""
    first, vertex = history.chart.first, history.chart.vertex
    newest = history.node_dart(first[-1])
    return least(history, newest, lambda e, moves: (moves, e - first[vertex[e]], e))


def least(
    history: History, start: NodeDart, rank: Callable[[MapDart, int], Rank], *, slack: float = 0
) -> MapDart:
    """The dart of U with the least rank.

    Args:
        start: from where the moves are counted.
        rank: of a dart, and the moves until a robot that sets out there is behind it.
        slack: by so many moves a rank may be below the moves.
    """
    best: Rank | None = None
    for place, distance, _ in history.outward(start):
        if best is not None and distance - slack > best[0]:
            break
        for e in history.leads(place):
            found = rank(e, distance + (e not in history.crossed))
            best = found if best is None else min(best, found)
    assert best is not None, "U is not empty and S is connected"
    return best[2]
