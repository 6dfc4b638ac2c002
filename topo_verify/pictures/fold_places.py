"""Where in the world a fold identifies visits, and where a rejection by folding contradicts itself.

The fold repeats `checkers.folding` and records its merges; nothing is judged.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from topo_verify.checkers.darts import WorldDart
from topo_verify.checkers.entailment import FoldedTrace
from topo_verify.checkers.folding import UNLIKE, Fold, Place
from topo_verify.checkers.map_on_fold import MapOnFold
from topo_verify.pictures.scenes import Moment
from topo_verify.robot.events import Augment, Reject, Start
from topo_verify.robot.percept import Percept


class FoldPlaces(NamedTuple):
    """What the fold of a history shows.

    Attributes:
        identified: by event, reference darts of visits recognised as an earlier place (not v0).
        clashes: by rejection, the reference darts at two visits that would be one place.
    """

    identified: dict[int, tuple[WorldDart, ...]]
    clashes: dict[int, tuple[WorldDart, WorldDart]]


class _WatchedFold(Fold):
    def __init__(self, percept: Percept) -> None:
        self.merged: list[int] = []
        self._whose: dict[int, int] = {}
        super().__init__(percept)

    def _visit(self, percept: Percept) -> int:
        # A copy for each visit: `_require_alike` identifies visits by it.
        node = super()._visit(Percept(percept.degree, percept.marker))
        self._whose[id(self._seen[node])] = node
        return node

    def _require_alike(self, one: Percept, other: Percept) -> None:
        super()._require_alike(one, other)
        if id(other) in self._whose:  # not just sensed
            self.merged.append(self._whose[id(one)])

    @property
    def visits(self) -> int:
        return len(self._seen)

    def identified(self, mark: int) -> list[int]:
        """Nodes merged since merge number `mark`, except those merged into v0."""
        v0, _ = self.find((0, 0))
        return [node for node in self.merged[mark:] if self.find((node, 0))[0] != v0]

    def clash(self, one: Place, other: Place) -> tuple[int, int] | None:
        """Two nodes that would be one place if these were the ends of one edge, and differ."""
        contradiction, places = next(self.contradictions(one, other, ()), ("", ()))
        nodes = sorted(node for node, _ in places)
        return (nodes[0], nodes[1]) if contradiction == UNLIKE else None


LONGEST = 20_000
"""Most events of a run whose fold is shown: more rings would fill megabytes."""


def fold_places(moments: Sequence[Moment]) -> FoldPlaces:
    """Fold the history of a run up to the first illegal move, lie or false augmentation."""
    places = FoldPlaces({}, {})
    if len(moments) > LONGEST:
        return places
    if not moments or moments[0].position is None:
        return places
    start, first = moments[0].event, moments[0].position
    assert isinstance(start, Start)
    fold = _WatchedFold(start.percept)
    folded, on_fold = FoldedTrace([moment.event for moment in moments], fold), MapOnFold(fold)
    visited = [first]
    for number, moment in enumerate(moments):
        mark = len(fold.merged)
        if moment.position is None or folded.read_to(number + 1):
            break
        visited += [moment.position] * (fold.visits - len(visited))
        if nodes := fold.identified(mark):
            places.identified[number] = tuple(dict.fromkeys(visited[node] for node in nodes))
        match moment.event:
            case Reject(e, h, "folding") if on_fold.is_open(e) and on_fold.is_open(h):
                if clash := fold.clash(on_fold.places[e], on_fold.places[h]):
                    places.clashes[number] = visited[clash[0]], visited[clash[1]]
            case Augment() if not _grown(on_fold, moment):
                break
            case _:
                pass
    return places


def _grown(on_fold: MapOnFold, moment: Moment) -> bool:
    event = moment.event
    assert isinstance(event, Augment)
    true = moment.growth is not None and moment.growth.true is True
    if not (true and on_fold.is_open(event.edge)):
        return False
    if on_fold.fold.partner(on_fold.places[event.edge]) is None:
        return False
    on_fold.grow(event)
    return True
