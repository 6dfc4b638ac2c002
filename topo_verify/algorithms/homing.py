"""Homing: settle the nearest edge, by doors that tell much and lead home soon.

It is sound by the fold (history.py) and ends by the loop (steering.py); this file affects the cost.
Each hypothesis predicts the percept behind an open dart of a ghost. The next door leads towards the
open dart with the least

    steps to it + 1 + expected way home behind it - BIT · bits that it tells about h

The expectation is over the hypotheses, as if one were true. Each is weighed by its coincidences: if
h is false, the places that it identifies have equal degrees by chance, each with the share of that
degree in S.

Source: docs/homing.md, whose lines are cited as `# H.12`.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Mapping
from math import log2
from typing import NamedTuple

from topo_verify.algorithms.chart import Survey
from topo_verify.algorithms.folding import NodeDart
from topo_verify.algorithms.history import History
from topo_verify.algorithms.next_edge import nearest_edge
from topo_verify.algorithms.places import PlaceNode, Places
from topo_verify.algorithms.steering import HistoryOf, explore
from topo_verify.robot.events import MapDart, Robot

BIT = 1.4
"""The value of a bit in moves; between 1 and 2 the costs hardly change."""

DegreeShares = Mapping[int, float]
"""Degree -> share of the darts of S at vertices of that degree."""


Prior = Callable[[MapDart], float]
"""The prior weight of a hypothesis, up to a common factor."""

UNSEEN = 0.005
"""The share of a degree that is not in S."""


class Belief(NamedTuple):
    """A hypothesis: the places if it is true, its probability, each ghost's way home."""

    places: Places
    share: float
    homes: Mapping[PlaceNode, int]


def homing(robot: Robot, *, history_of: HistoryOf = History) -> Survey:
    """Map the robot's world."""
    return explore(robot, edge=nearest_edge, door=most_telling_door, history_of=history_of)


def alike(_: MapDart) -> float:
    """The prior of `homing`: all hypotheses are equally likely."""
    return 1.0


def most_telling_door(history: History, e: MapDart, prior: Prior = alike) -> NodeDart:
    """The dart by which the robot leaves for the open dart with the best score."""
    ghosts = history.ghosts(e)
    steps = history.distances(ghosts)
    usual = degree_shares(history)
    beliefs = weigh(history, e, ghosts, usual, prior)  # H.10
    best: tuple[float, NodeDart] | None = None
    for place in ghosts:
        for dart in history.open_darts(place):  # H.11
            way_home, bits = foretell(history, beliefs, place, dart, usual)
            score = steps[place] + 1 + way_home - BIT * bits  # H.12
            if best is None or score < best[0]:
                best = score, dart
    assert best is not None, "a ghost without an open dart would be known to be in S"
    return next(iter(history.way(best[1])), best[1])


def degree_shares(history: History) -> DegreeShares:
    """The share of the darts of S that each degree has."""
    degrees = history.chart.degree
    darts = sum(degrees)
    return {d: d * vertices / darts for d, vertices in Counter(degrees).items()}


def weigh(
    history: History, e: MapDart, ghosts: Mapping[PlaceNode, int], usual: DegreeShares, prior: Prior
) -> list[Belief]:
    """The hypotheses for e, each with its probability if one is true."""
    depth, vertex = history.home().depth, history.chart.vertex
    weighed: list[tuple[Places, float, dict[PlaceNode, int]]] = []
    for h, places in history.hypotheses(e):
        # a place that stays a ghost: home over vu
        images = {ghost: places.vertex(ghost) for ghost in ghosts}
        over_vu = depth[vertex[h]]
        homes = {
            ghost: over_vu + ghosts[ghost] if v is None else depth[v] for ghost, v in images.items()
        }
        bits = log2(prior(h)) - sum(
            log2(usual.get(degree, UNSEEN)) for degree in places.coincidences()
        )
        weighed.append((places, bits, homes))
    most = max(bits for _, bits, _ in weighed)
    total = sum(2 ** (bits - most) for _, bits, _ in weighed)
    return [Belief(places, 2 ** (bits - most) / total, homes) for places, bits, homes in weighed]


def foretell(
    history: History,
    beliefs: Iterable[Belief],
    place: PlaceNode,
    dart: NodeDart,
    usual: DegreeShares,
) -> tuple[float, float]:
    """The expected way home behind an open dart, and the bits that the percept there tells."""
    depth = history.home().depth
    foretold: defaultdict[tuple[int, MapDart], float] = defaultdict(float)
    way_home = unforetold = 0.0
    for places, share, homes in beliefs:
        end = places.across(dart)
        v = None if end is None else places.vertex(end)
        way_home += share * (homes[place] + 1 if v is None else depth[v])
        if end is None:
            unforetold += share
        else:  # at v0 the percept also has the marker's direction
            direction = history.map_dart(end, places) if v == 0 else None
            foretold[places.looks(end)[0], -1 if direction is None else direction] += share
    for degree, share in usual.items():
        foretold[degree, -1] += unforetold * share
    bits = _entropy(foretold.values()) - unforetold * _entropy(usual.values())
    return way_home, bits


def _entropy(shares: Iterable[float]) -> float:
    return -sum(share * log2(share) for share in shares if share)
