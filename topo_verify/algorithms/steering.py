"""The loop of the mappers that steer by the fold of their whole history, and why it ends.

Such a mapper is two policies: the next dart of U to settle, and the next door behind it. Neither
can make the map wrong: `History` settles what the history proves, the loop ends when U is empty,
and then no dart of the fold is open. What they could do is walk for ever. Two rules forbid it:

1. **Patience.** After `PATIENCE` moves behind edges with none settled, the loop settles e itself,
   by ways home as the basic algorithm does. Each way that it walks refutes the hypothesis whose way
   it is, or leads home and makes vu a vertex of S. So the hypotheses for e become fewer, and when
   there is none, or vu is in S, e is settled.
2. **The bound.** Claim 7 grants each edge A = n + (2m-1)·2(n-1) moves. S is a part of the world:
   n is at least its vertices and 2m at least its darts. A policy chooses a door only while, after
   it, the grant of the edges settled so far and of one more, as far as S shows it, still pays for
   settling any edge by ways home; otherwise the loop does that now.

**It ends.** The measure (edges not settled; patience left; hypotheses for e; steps left on the way
that is walked) falls lexicographically with every move, but for the ways to the next edge, which
are shortest ways, and at whose end a policy's move or a hypothesis follows.

**It keeps the bound.** Let j edges be settled, c the cost, a the distance from the robot to S, and
W = |U|·2(n-1). To go back to S, over S to any edge, and across takes at most a + n moves; to walk
each hypothesis home and back takes W. So settling one more edge by ways home takes at most
a + n + W moves, with the walk from where the last way ended to where something new of the next one
begins, which is no longer than that over vu: afterwards c + a has grown by no more. With one vertex
W is 0 and every crossing settles its edge. With more, at least two darts of S are explored, so
W <= (2m-2)·2(n-1), and n + 1 + W < A.

- If an edge was just settled, c + a <= j·A (below), so c + a + n + 1 + W <= (j+1)·A: settling one
  more by ways home is paid for, with a move to spare (behind a new edge the robot is one from S).
- If none was settled since, the loop has looked: it made the last move only since that was so.

So whichever way an edge is settled, c + a <= (j+1)·A afterwards: by ways home as was just said, by
a policy since the loop looked before its last move. At the end j = m: the cost is at most m·A.
"""

from __future__ import annotations

from collections.abc import Callable

from topo_verify.algorithms.chart import Survey
from topo_verify.algorithms.folding import NodeDart
from topo_verify.algorithms.history import History
from topo_verify.robot.events import MapDart, Robot

PATIENCE = 60
"""So many moves behind edges may settle none. On a torus it is used up now and then."""

NextEdge = Callable[[History], MapDart]
"""The dart of U that is settled next."""

NextDoor = Callable[[History, MapDart], NodeDart]
"""The dart by which the robot leaves, to find out where this crossed edge ends."""


HistoryOf = Callable[[Robot], History]
"""Begins the history of a run: `History`, or one that takes more for granted."""


def explore(
    robot: Robot, *, edge: NextEdge, door: NextDoor, history_of: HistoryOf = History
) -> Survey:
    """Map the robot's world: the map, and its cost in edge traversals, which is O(m²n)."""
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
    """Whether after one more move settling any edge by ways home is within the bound of claim 7."""
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
    """Walk to the place of a dart, over anything that was seen."""
    for exit_dart in history.way(goal):
        history.move(exit_dart)


def settle_by_ways_home(history: History, e: MapDart) -> None:
    """Validate one hypothesis after the other by its way home, that nearest to e on S first."""
    vertex = history.chart.vertex
    while e in history.crossed:
        near = history.chart.tree(vertex[e]).depth
        h = min((h for h, _ in history.hypotheses(e)), key=lambda h: (near[vertex[h]], h))  # H.7
        walk_home(history, e, h)


def walk_home(history: History, e: MapDart, h: MapDart) -> None:
    """Walk the way home of h, until h is refuted or e settled.

    What was seen of it before is not walked again, as in Enhancement I.
    """
    chart, places = history.chart, history.places
    towards = history.home().parent
    at, place = h, history.behind(e)  # a dart on the way home, and what was seen there if h is true
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
