"""Bounds on the worlds of a strategy, and whether any world keeps them.

These arguments mean the same in every strategy:

    min_edges, max_edges   the number of edges m; default: 1 to 200. A world with 200 edges still
                           has a one-line id, so every failing example prints one. min_edges=0
                           also draws m0/0, the world with no edge, which no command ever tries
    min_genus, max_genus   the genus g of the surface; from 0 up
    simple                 neither loops nor parallel edges
    loopless               no loops
    max_degree             no vertex has more exits than this
    marker                 where the marker lies: "any" exit; "leaf", at a dead end, where its
                           direction says nothing; "hub", at a vertex of the greatest degree, where
                           it says most. m0/0 has no marker, so "leaf" excludes it

Worlds are grown edge by edge: a **leaf** is a new vertex on a new edge; a **split** joins two
corners of one face (one face more); a **cross** joins corners of two faces (one face less, the
genus one more). Splits and crosses together are **closings**: they close cycles. `can_finish` tells
whether a half-grown map may still be finished within the bounds. The condition is necessary and
uses counts alone:

    closings  each missing handle takes a cross, and a split before it if there is one face
    leaves    all edges to come that need not be closings are counted as leaves: that is best
    room      the free places at vertices: a leaf takes one and brings max_degree - 1, a closing two
    capacity  the edges that the vertices can carry, if loops or parallels are forbidden

What this does not show: that a world exists wherever the answer is yes. Without `max_degree` one
does (one-faced graphs of diameter two: M. Škoviera, "The maximum genus of graphs of diameter two",
Discrete Math. 87 (1991)); with it, the tests compare with all worlds up to 6 edges.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isqrt
from operator import index
from typing import Any, Literal, SupportsIndex, get_args

from topo_verify.errors import InputError
from topo_verify.world.enumeration.rank_order import MAX_ID_EDGES

MarkerPlace = Literal["any", "leaf", "hub"]

WIDEST = MAX_ID_EDGES
"""The default of max_edges."""

LARGEST = 2000
"""The greatest max_edges: Hypothesis allows 8 KiB of choices an example, this takes half."""

MANY = 10**9
"""Stands for no bound."""


@dataclass(frozen=True, slots=True, repr=False)
class Shape:
    """Bounds that a grown map keeps. The number of edges is not among them: it is drawn first.

    Attributes:
        max_parallel, max_loops: edges between two vertices, and from one vertex to itself.
        min_cycles, max_cycles: closings, that is edges outside a spanning tree.
        dense: at least half as many edges as there are pairs of vertices.
        leaf: the first vertex, which dart 0 leaves, has degree 1.
    """

    min_genus: int = 0
    max_genus: int = MANY
    max_degree: int = MANY
    max_parallel: int = MANY
    max_loops: int = MANY
    min_cycles: int = 0
    max_cycles: int = MANY
    max_vertices: int = MANY
    dense: bool = False
    leaf: bool = False

    @property
    def first_room(self) -> int:
        """How many darts the first vertex may have."""
        return min(1, self.max_degree) if self.leaf else self.max_degree

    def at(self, edges: int) -> Shape:
        """The same bounds for this number of edges: if dense, with the most vertices it allows."""
        if not self.dense:
            return self
        # The largest n with n(n-1)/2 <= 2m.
        return replace(self, max_vertices=(1 + isqrt(1 + 16 * edges)) // 2)

    def capacity(self, vertices: int) -> int:
        """The most edges that this number of vertices can carry."""
        # The leaf with the marker has one edge; all others lie between the other vertices.
        inner = vertices - 1 if self.leaf and vertices > 1 else vertices
        pairs = inner * (inner - 1) // 2
        return pairs * self.max_parallel + inner * self.max_loops + vertices - inner

    def can_finish(
        self, *, edges: int, left: int, vertices: int, faces: int, genus: int, room: int
    ) -> bool:
        """Can a map keep all the bounds if `left` of its `edges` are still to come?

        The answer uses counts alone: no is always right, yes may be wrong.
        """
        # As in the table above: the closings that must come, and the most leaves besides them.
        missing = max(0, self.min_genus - genus)
        cycles = edges - left - vertices + 1
        # A cross takes a face away and one must be left: faces - 1 of them need no split.
        closings = max(missing + max(0, missing - faces + 1), self.min_cycles - cycles)
        leaves = min(left - closings, self.max_vertices - vertices)
        return (
            leaves >= 0
            and genus <= self.max_genus
            and cycles + left - leaves <= self.max_cycles
            and room >= (left > 0)
            and room + leaves * (self.max_degree - 2) >= 2 * (left - leaves)
            and edges <= self.capacity(vertices + leaves)
        )

    def is_possible(self, edges: int) -> bool:
        """Can a world have this many edges? No is always right, yes may be wrong."""
        if self.leaf and not edges:
            return False
        return self.at(edges).can_finish(
            edges=edges, left=edges, vertices=1, faces=1, genus=0, room=self.first_room
        )

    def edges_between(self, strategy: str, min_edges: int, max_edges: int) -> tuple[int, int]:
        """The least and the greatest number of edges within these bounds that is possible.

        Raises:
            InputError: none is possible; the sentence says how many edges it takes.
        """
        # Possible numbers of edges have no gaps, and go on for ever unless degrees end them.
        for least in range(min_edges, max_edges + 1):
            if self.is_possible(least):
                break
        else:
            raise InputError(f"{strategy}: {self._objection(min_edges, max_edges)}")
        most = max_edges
        while not self.is_possible(most):
            most -= 1
        return least, most

    def _objection(self, min_edges: int, max_edges: int) -> str:
        asked = f"no world of {self} has {_range(min_edges, max_edges)} edges"
        least = next((m for m in range(LARGEST) if self.is_possible(m)), None)
        if least is None:
            return f"{asked}, and none has more or fewer: ask for less"
        if least > max_edges:
            return f"{asked}: it takes {least} or more; raise max_edges"
        return f"{asked}: it has fewer; lower min_edges"

    def __repr__(self) -> str:
        return f"<{self}>"

    def _repr_pretty_(self, printer: Any, _cycle: bool) -> None:  # noqa: FBT001  IPython's protocol
        """The text that Hypothesis prints in the name of a strategy."""
        printer.text(repr(self))

    def __str__(self) -> str:
        """The bounds in words, without those that are not set."""
        words = [f"genus {_range(self.min_genus, self.max_genus)}"] * (
            self.min_genus > 0 or self.max_genus < MANY
        )
        words += ["density one half or more"] * self.dense
        if self.max_parallel == 1:
            words.append("a simple graph")
        elif self.max_loops == 0:
            words.append("no loops")
        words += [f"max_degree {self.max_degree}"] * (self.max_degree < MANY)
        words += ["a marker at a dead end"] * self.leaf
        return " and ".join(words) or "any kind"


def _range(least: int, most: int) -> str:
    if least == most:
        return str(least)
    return f"{least} or more" if most >= MANY else f"{least} to {most}"


# ---------------------------------------------------------------- checks of arguments


def edge_bounds(strategy: str, min_edges: object, max_edges: object) -> tuple[int, int]:
    """The bounds as plain integers in order.

    Raises:
        InputError: one is not a number of edges, or the least is above the greatest.
    """
    least = integer(strategy, "min_edges", min_edges)
    most = integer(strategy, "max_edges", max_edges)
    if most > LARGEST:
        raise InputError(
            f"{strategy}: max_edges={most} is more than {LARGEST}, the most that fits into one"
            " example of Hypothesis"
        )
    _in_order(strategy, "edges", least, most)
    return least, most


def grown_shape(
    strategy: str,
    *,
    min_genus: object = 0,
    max_genus: object = None,
    simple: object = False,
    loopless: object = False,
    max_degree: object = None,
    marker: str = "any",
) -> Shape:
    """The shape that these arguments ask for.

    Raises:
        InputError: an argument is out of range or two contradict each other.
    """
    least = integer(strategy, "min_genus", min_genus)
    most = MANY if max_genus is None else integer(strategy, "max_genus", max_genus)
    _in_order(strategy, "genus", least, most)
    require_marker(strategy, marker, get_args(MarkerPlace))
    for name, value in (("simple", simple), ("loopless", loopless)):
        if not isinstance(value, bool):
            raise InputError(f"{strategy}: {name}={value!r}, expected True or False")
    return Shape(
        min_genus=least,
        max_genus=most,
        max_degree=degree_bound(strategy, max_degree),
        max_parallel=1 if simple else MANY,
        max_loops=0 if simple or loopless else MANY,
        leaf=marker == "leaf",
    )


def degree_bound(strategy: str, max_degree: object) -> int:
    """The bound as a plain integer; `MANY` for None."""
    return MANY if max_degree is None else integer(strategy, "max_degree", max_degree)


def integer(strategy: str, name: str, value: object) -> int:
    """The value as a plain integer; refuses what is not one, or is negative."""
    if isinstance(value, SupportsIndex) and not isinstance(value, bool) and index(value) >= 0:
        return index(value)
    raise InputError(f"{strategy}: {name}={value!r}, expected an integer of 0 or more")


def require_marker(strategy: str, marker: str, known: tuple[str, ...]) -> None:
    """Refuse a place where the strategy puts no markers."""
    if marker not in known:
        places = ", ".join(map(repr, known))
        raise InputError(f"{strategy}: marker={marker!r}, expected one of {places}")


def _in_order(strategy: str, what: str, least: int, most: int) -> None:
    if least > most:
        # min_edges=1 is the default, so the caller may not have written it.
        mend = "min_edges=0 draws m0/0, too" if (what, most) == ("edges", 0) else "swap them"
        raise InputError(f"{strategy}: min_{what}={least} is above max_{what}={most}: {mend}")
