"""The map S beside the fold of a history: which place of the fold each dart of S is.

Trusted. The caller knows that the declared augmentations are right. The fold identifies places as
it grows, so S keeps one place for each vertex, from which its darts are found by turning.
"""

from __future__ import annotations

from typing import TypeGuard, cast

from topo_verify.checkers.darts import KnownDart
from topo_verify.checkers.folding import Fold, Place
from topo_verify.robot.events import Augment


class MapOnFold:
    """S, from v0 alone on. Grows by `grow`, as a trace is read.

    Attributes:
        fold: of the history so far; the caller lets it grow.
        places: of each dart of S, its place on the fold; the next new dart has the next number.
        entries: of each vertex of S, the place of its first dart.
    """

    def __init__(self, fold: Fold) -> None:
        self.fold = fold
        self.entries: list[Place] = []
        self.places: dict[KnownDart, Place] = {}
        self._clockwise: list[KnownDart] = []
        self._alpha: dict[KnownDart, KnownDart] = {}
        self._open: set[KnownDart] = set()
        self._add_vertex((0, 0))

    def is_open(self, dart: int) -> TypeGuard[KnownDart]:
        """Whether this is an unexplored dart of S."""
        return dart in self._open

    def others(self, e: KnownDart) -> list[KnownDart]:
        """The unexplored darts of S but e, ascending."""
        return sorted(self._open - {e})

    def is_known(self, node: int) -> bool:
        """Whether this node of the fold is a vertex of S."""
        return any(self.fold.find(entry)[0] == node for entry in self.entries)

    def face(self, e: KnownDart) -> list[KnownDart]:
        """The darts of S on the face of e; where a dart is open, the boundary turns back."""
        face = [e]
        while (dart := self._clockwise[self._alpha.get(face[-1], face[-1])]) != e:
            face.append(dart)
        return face

    def grow(self, event: Augment) -> None:
        """Let S grow by a right augmentation, whose edge was crossed."""
        e, other = KnownDart(event.edge), KnownDart(event.dart)
        if event.kind == "new":
            entry = self.fold.partner(self.places[e])
            assert entry is not None, "an edge is crossed before S grows along it"
            self._add_vertex(entry)
        self._open -= {e, other}
        self._alpha |= {e: other, other: e}

    def _add_vertex(self, entry: Place) -> None:
        node, first = entry
        size, degree = len(self.places), self.fold.degree(node)
        darts = cast("list[KnownDart]", [*range(size, size + degree)])
        self.entries.append(entry)
        self.places |= {dart: (node, first + door) for door, dart in enumerate(darts)}
        self._clockwise += [*darts[1:], *darts[:1]]
        self._open.update(darts)
