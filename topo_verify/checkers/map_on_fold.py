"""The map S beside the fold of a history: which place of the fold each dart of S is.

Trusted; no world is needed. A declared augmentation says that S grows, and here it is believed: the
caller has found it to follow from the history, or knows it to be right. The fold identifies places
as it grows, so S is kept as one place for each vertex, and a dart of S is found from there by
turning; whether two places are one is for the fold to say.

    on_fold = MapOnFold(fold)           # S is v0
    on_fold.is_open(e)                  # does S have a dart e, and is it unexplored?
    fold.partner(on_fold.place(e))      # the place at the other end, if e was crossed
    on_fold.is_known(node)              # is this node of the fold a vertex of S?
    on_fold.grow(augment)               # S has a vertex, or an explored edge, more
    on_fold.face(e)                     # the darts of S on the face of e
"""

from __future__ import annotations

from typing import TypeGuard, cast

from topo_verify.checkers.darts import KnownDart
from topo_verify.checkers.folding import Fold, Place
from topo_verify.robot.events import Augment


class MapOnFold:
    """S, from v0 alone on. Grows by `grow`, as a trace is read.

    Attributes:
        fold: the fold of the history so far; the caller lets it grow.
        size: the number of darts of S; the next new dart has this number.
        entries: of each vertex of S, the place of its first dart.
    """

    def __init__(self, fold: Fold) -> None:
        self.fold = fold
        self.size = 0
        self.entries: list[Place] = []
        self._places: list[Place] = []
        self._clockwise: list[KnownDart] = []  # the next dart at the same vertex
        self._alpha: dict[KnownDart, KnownDart] = {}
        self._open: set[KnownDart] = set()
        self._add_vertex((0, 0))

    def place(self, dart: KnownDart) -> Place:
        """The place of the fold that a dart of S is."""
        return self._places[dart]

    def is_open(self, dart: int) -> TypeGuard[KnownDart]:
        """Whether this is a dart of S, and unexplored."""
        return dart in self._open

    def others(self, e: KnownDart) -> list[KnownDart]:
        """The unexplored darts of S but e, in ascending order."""
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
        if event.kind == "new":
            entry = self.fold.partner(self._places[event.edge])
            assert entry is not None, "an edge is crossed before S grows along it"
            self._add_vertex(entry)
        e, other = KnownDart(event.edge), KnownDart(event.dart)
        self._open -= {e, other}
        self._alpha |= {e: other, other: e}

    def _add_vertex(self, entry: Place) -> None:
        node, first = entry
        degree = self.fold.degree(node)
        darts = cast("list[KnownDart]", [*range(self.size, self.size + degree)])
        self.size += degree
        self.entries.append(entry)
        self._places += [(node, first + door) for door in range(degree)]
        self._clockwise += [*darts[1:], *darts[:1]]
        self._open.update(darts)
