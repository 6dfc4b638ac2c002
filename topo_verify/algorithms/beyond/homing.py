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
from functools import cache
from math import log2
from typing import NamedTuple

from topo_verify.algorithms.beyond.folding import NodeDart
from topo_verify.algorithms.beyond.history import History
from topo_verify.algorithms.beyond.next_edge import nearest_edge
from topo_verify.algorithms.beyond.places import PlaceNode, Places
from topo_verify.algorithms.beyond.steering import HistoryOf, explore
from topo_verify.algorithms.chart import Survey, Vertex
from topo_verify.robot.events import MapDart, Robot

BIT = 1.4
"""The value of a bit in moves; between 1 and 2 the costs hardly change."""

DegreeShares = Mapping[int, float]
"""Degree -> share of the darts of S at vertices of that degree."""


Prior = Callable[[MapDart], float]
"""The prior weight of a hypothesis, up to a common factor."""

UNSEEN = 0.005
"""The share of a degree that is not in S."""

ROUNDING = 1e-6
"""More than the rounding of a score."""

DartEnds = tuple[tuple[NodeDart, Vertex | None] | None, ...]
"""Where an open dart leads by each hypothesis, as `Places.beyond` says."""


class Belief(NamedTuple):
    """A hypothesis: the places if it is true, its probability, the way home from vu."""

    places: Places
    share: float
    over_vu: int


def homing(robot: Robot, *, history_of: HistoryOf = History) -> Survey:
    """Map the robot's world."""
    return explore(robot, edge=nearest_edge, door=most_telling_door, history_of=history_of)


def alike(_: MapDart) -> float:
    """The prior of `homing`: all hypotheses are equally likely."""
    return 1.0


def most_telling_door(history: History, e: MapDart, prior: Prior = alike) -> NodeDart:
    """The dart by which the robot leaves for the open dart with the best score.

    Ghosts are weighed nearest first. No percept tells more bits than it takes to identify the true
    hypothesis, so most open darts cannot have the best score and are not weighed in full.
    """
    outlook = history.notes.get(e) or Outlook(history, e, prior)
    history.notes[e] = outlook
    best: tuple[float, int, NodeDart] | None = None
    for place, steps in history.distances(outlook.ghosts):
        if best is not None and steps + 1 - outlook.most > best[0]:
            break
        for dart, way_home, ends in outlook.open_darts(place):  # H.11
            moves = steps + 1 + way_home
            if best is None or moves - outlook.most < best[0]:
                score = moves - BIT * outlook.bits(ends)  # H.12
                if best is None or (score, outlook.rank[place]) < best[:2]:
                    best = score, outlook.rank[place], dart
    assert best is not None, "a ghost without an open dart would be known to be in S"
    return next(iter(history.way(best[2])), best[2])


def degree_shares(history: History) -> DegreeShares:
    """The share of the darts of S that each degree has."""
    degrees = history.chart.degree
    darts = sum(degrees)
    return {d: d * vertices / darts for d, vertices in Counter(degrees).items()}


def weigh(history: History, e: MapDart, usual: DegreeShares, prior: Prior) -> list[Belief]:
    """The hypotheses for e, each with its probability if one is true."""
    depth, vertex = history.home().depth, history.chart.vertex
    rarity: defaultdict[int, float] = defaultdict(lambda: log2(UNSEEN))
    rarity.update((degree, log2(share)) for degree, share in usual.items())
    weighed: list[tuple[Places, float, int]] = []
    for h, places in history.hypotheses(e):
        bits = log2(prior(h)) - sum(map(rarity.__getitem__, places.coincidences()))
        weighed.append((places, bits, depth[vertex[h]]))
    most = max(bits for _, bits, _ in weighed)
    total = sum(2 ** (bits - most) for _, bits, _ in weighed)
    return [Belief(places, 2 ** (bits - most) / total, home) for places, bits, home in weighed]


class Outlook:
    """What the hypotheses for e say about its ghosts, as long as there is no new percept.

    Attributes:
        ghosts: the ghosts of e, with their distances from vu.
        rank: their order among equal scores.
        most: the value of all bits that a percept can tell.
        open_darts: of a ghost, each with the expected way home behind it, and its ends.
        bits: the bits that the percept behind an open dart tells, given its ends.
    """

    def __init__(self, history: History, e: MapDart, prior: Prior) -> None:
        self._history = history
        self.ghosts = history.ghosts(e)
        self.rank = {place: number for number, place in enumerate(self.ghosts)}
        self._usual = degree_shares(history)
        self._beliefs = weigh(history, e, self._usual, prior)  # H.10
        self.most = BIT * _entropy(belief.share for belief in self._beliefs) + ROUNDING
        self.open_darts, self.bits = cache(self._open_darts), cache(self._bits)

    def _open_darts(self, ghost: PlaceNode) -> list[tuple[NodeDart, float, DartEnds]]:
        depth = self._history.home().depth
        images = [(belief, belief.places.vertex(ghost)) for belief in self._beliefs]
        # a place that stays a ghost: home over vu
        homes = [
            belief.over_vu + self.ghosts[ghost] if v is None else depth[v] for belief, v in images
        ]
        weighed: list[tuple[NodeDart, float, DartEnds]] = []
        beyond = [belief.places.beyond for belief in self._beliefs]
        for dart in self._history.open_darts(ghost):
            ends = tuple([find(dart) for find in beyond])
            way_home = 0.0
            for (_, share, _), home, end in zip(self._beliefs, homes, ends, strict=True):
                v = end and end[1]
                way_home += share * (home + 1 if v is None else depth[v])
            weighed.append((dart, way_home, ends))
        return weighed

    def _bits(self, ends: DartEnds) -> float:
        foretold: defaultdict[tuple[int, MapDart], float] = defaultdict(float)
        unforetold = 0.0
        for (places, share, _), end in zip(self._beliefs, ends, strict=True):
            if end is None:
                unforetold += share
            else:  # at v0 the percept also has the marker's direction
                dart, v = end
                direction = self._history.map_dart(dart, places) if v == 0 else None
                foretold[places.looks(dart)[0], -1 if direction is None else direction] += share
        for degree, share in self._usual.items():
            foretold[degree, -1] += unforetold * share
        return _entropy(foretold.values()) - unforetold * _entropy(self._usual.values())


def _entropy(shares: Iterable[float]) -> float:
    return -sum(share * log2(share) for share in shares if share)
