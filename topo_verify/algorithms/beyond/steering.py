"""The loop of the steered mappers, and why it ends.

Such a mapper is two policies: the next dart of U to settle, and the next door behind it. They
cannot make the map wrong: `History` settles only what the history proves, and the loop ends when U
is empty. Two rules keep them from walking for ever:

1. **Patience.** After `PATIENCE` moves behind edges with none settled, the loop settles e itself,
   by ways home: each refutes its hypothesis, or leads home and makes vu a vertex of S.
2. **The bound.** Claim 7 grants each edge A = n + (2m-1)·2(n-1) moves, where the vertices and darts
   of S bound n and 2m from below. A policy chooses a door only while, after it, the grant of the
   settled edges and of one more still pays for settling any edge by ways home.

**It ends.** The measure (edges not settled; patience left; hypotheses for e; steps left on the way)
falls lexicographically with every move, except on the shortest ways to the next edge.

**It keeps the bound.** Let j edges be settled, c the cost, a the distance from the robot to S, and
W = |U|·2(n-1), the moves to walk each hypothesis home and back. Settling one more edge by ways home
takes at most a + n + W moves, c + a grows by no more, and n + 1 + W < A. So c + a <= j·A whenever
an edge is settled: if one was just settled, the grant pays for the next; else the loop has checked
that before its last move. At the end the cost is at most m·A.

Coq proves both for all policies: coq/SteeredEnds.v; docs/proofs.md compares it with this file.
"""

from __future__ import annotations

from collections.abc import Callable

from topo_verify.algorithms.beyond.folding import NodeDart
from topo_verify.algorithms.beyond.history import History
from topo_verify.algorithms.chart import Survey
from topo_verify.robot.events import MapDart, Robot

PATIENCE = 60
"""Moves behind edges that may settle none."""

NextEdge = Callable[[History], MapDart]

NextDoor = Callable[[History, MapDart], NodeDart]


HistoryOf = Callable[[Robot], History]


def explore(
    robot: Robot, *, edge: NextEdge, door: NextDoor, history_of: HistoryOf = History
) -> Survey:
    """Map the robot's world in O(m²n) edge traversals."""
    history = history_of(robot)
    patience, settled = PATIENCE, 0
    while history.chart.unexplored:  # H.2
        e = edge(history)  # H.3
        if not history.beside(e):
            reach(history, e)  # H.4
        if history.settled > settled:
            patience, settled = PATIENCE, history.settled
        while e in history.crossed and not history.in_s():  # H.5
            if not patience or not affords(history):  # H.6
                settle_by_ways_home(history, e)
                break
            history.move(door(history, e), "validate")  # H.9 H.13
            patience -= 1
    return history.chart.survey(history.cost)  # H.18


def affords(history: History) -> bool:
    """Whether after one more move settling any edge by ways home keeps the bound."""
    chart = history.chart
    n, darts = len(chart.first), len(chart.alpha)
    grant = n + (2 * ((darts + 1) // 2) - 1) * 2 * (n - 1)
    ways_home = len(chart.unexplored) * 2 * max(history.home().depth)
    back_on_s = history.cost + 1 + history.away() + 1
    return back_on_s + n + 1 + ways_home <= (history.settled + 1) * grant


def reach(history: History, e: MapDart) -> None:
    """Walk to the place behind a dart of S, and cross the dart if it was never crossed."""
    crossed = e in history.crossed
    walk(history, history.behind(e) if crossed else history.node_dart(e))
    if not crossed:
        history.move(history.node_dart(e), "cross")


def walk(history: History, goal: NodeDart) -> None:
    """Walk to the place of a dart, over all places visited."""
    for exit_dart in history.way(goal):
        history.move(exit_dart)


def settle_by_ways_home(history: History, e: MapDart) -> None:
    """Validate hypotheses by their ways home, that nearest to e on S first."""
    vertex = history.chart.vertex
    while e in history.crossed:
        near = history.chart.tree(vertex[e]).depth
        h = min((h for h, _ in history.hypotheses(e)), key=lambda h: (near[vertex[h]], h))  # H.7
        walk_home(history, e, h)


def walk_home(history: History, e: MapDart, h: MapDart) -> None:
    """Walk the way home of h until h is refuted or e settled.

    Doors taken before are not walked again.
    """
    chart, places = history.chart, history.places
    towards = history.home().parent
    at, place = h, history.behind(e)  # a dart on the way home; its place if h is true
    while e in history.crossed and history.suppose(e, h) is not None:  # H.8
        leads_home = towards[chart.vertex[at]]
        assert leads_home is not None, "at v0 the marker has told whether h is true"
        exit_dart = places.turn(place, chart.door(at, leads_home))
        beyond = places.across(exit_dart)
        if beyond is None:
            walk(history, exit_dart)
            history.move(exit_dart, "validate")
            beyond = history.at
        at, place = chart.across(leads_home), beyond
