"""Bounds on the worlds of a strategy, and whether any world keeps them.

    min_edges, max_edges   the number of edges m; default: 1 to 200, the worlds with an id
    min_genus, max_genus   the genus g of the surface
    simple, loopless       no loops, and if simple no parallel edges
    max_degree             the most exits of a vertex
    marker                 "any" exit; "leaf", at a dead end, where its direction says nothing;
                           "hub", at a vertex of the greatest degree, where it says most

Worlds are grown edge by edge: a **leaf** is a new vertex on a new edge; a **split** joins two
corners of one face (one face more); a **cross** joins corners of two faces (one face less, the
genus one more). Splits and crosses are **closings**. `can_finish` tells by counts alone whether a
half-grown map may still be finished:

    closings  each missing handle takes a cross, and a split before it if there is one face
    leaves    all other edges to come count as leaves, which is best
    room      the free places at vertices: a leaf takes one and brings max_degree - 1, a closing two
    capacity  the edges that the vertices can carry, if loops or parallels are forbidden

The condition is necessary; without `max_degree` it is sufficient (M. Škoviera, "The maximum genus
of graphs of diameter two", Discrete Math. 87 (1991)).
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

LARGEST = 2000
"""The greatest max_edges: half of Hypothesis's 8 KiB of choices an example."""

MANY = 10**9
"""Stands for a number without a bound."""


@dataclass(frozen=True, slots=True, repr=False)
class Shape:
    """Bounds that a grown map keeps, besides the number of edges.

    Attributes:
        max_parallel, max_loops: edges between two vertices, and at one vertex.
        min_cycles, max_cycles: edges outside a spanning tree.
        dense: at least half as many edges as pairs of vertices.
        leaf: dart 0 leaves a vertex of degree 1.
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
        """The most darts of the first vertex."""
        return min(1, self.max_degree) if self.leaf else self.max_degree

    def at(self, edges: int) -> Shape:
        """The bounds for this number of edges: if dense, with the most vertices that it allows."""
        if not self.dense:
            return self
        # the largest n with n(n-1)/2 <= 2m
        return replace(self, max_vertices=(1 + isqrt(1 + 16 * edges)) // 2)

    def capacity(self, vertices: int) -> int:
        """The most edges that this number of vertices can carry."""
        # the leaf with the marker has one edge
        inner = vertices - 1 if self.leaf and vertices > 1 else vertices
        pairs = inner * (inner - 1) // 2
        return pairs * self.max_parallel + inner * self.max_loops + vertices - inner

    def can_finish(
        self, *, edges: int, to_come: int, vertices: int, faces: int, genus: int, room: int
    ) -> bool:
        """Whether a map may keep the bounds with `to_come` more edges; yes may be wrong."""
        missing = max(0, self.min_genus - genus)
        cycles = edges - to_come - vertices + 1
        # one face must remain: faces - 1 crosses need no split
        closings = max(missing + max(0, missing - faces + 1), self.min_cycles - cycles)
        leaves = min(to_come - closings, self.max_vertices - vertices)
        return (
            leaves >= 0
            and genus <= self.max_genus
            and cycles + to_come - leaves <= self.max_cycles
            and room >= (to_come > 0)
            and room + leaves * (self.max_degree - 2) >= 2 * (to_come - leaves)
            and edges <= self.capacity(vertices + leaves)
        )

    def is_possible(self, edges: int) -> bool:
        """Whether a world may have this many edges; yes may be wrong."""
        if self.leaf and not edges:
            return False
        return self.at(edges).can_finish(
            edges=edges, to_come=edges, vertices=1, faces=1, genus=0, room=self.first_room
        )

    def edges_between(self, strategy: str, min_edges: int, max_edges: int) -> tuple[int, int]:
        """The least and the greatest possible number of edges within these bounds."""
        # possible numbers have no gaps, and only degrees end them
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

    def _repr_pretty_(self, printer: Any, _cycle: bool) -> None:  # noqa: FBT001
        printer.text(repr(self))

    def __str__(self) -> str:
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


def edge_bounds(strategy: str, min_edges: object, max_edges: object) -> tuple[int, int]:
    """The bounds as plain integers."""
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
    """The shape that these arguments ask for."""
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
        max_degree=MANY if max_degree is None else integer(strategy, "max_degree", max_degree),
        max_parallel=1 if simple else MANY,
        max_loops=0 if simple or loopless else MANY,
        leaf=marker == "leaf",
    )


def integer(strategy: str, name: str, value: object) -> int:
    """The value as a plain integer of 0 or more."""
    if isinstance(value, SupportsIndex) and not isinstance(value, bool) and index(value) >= 0:
        return index(value)
    raise InputError(f"{strategy}: {name}={value!r}, expected an integer of 0 or more")


def require_marker(strategy: str, marker: str, known: tuple[str, ...]) -> None:
    """Refuse a place where the strategy puts no markers."""
    if marker not in known:
        places = ", ".join(map(repr, known))
        raise InputError(f"{strategy}: marker={marker!r}, expected one of {places}")


def _in_order(strategy: str, quantity: str, least: int, most: int) -> None:
    if least > most:
        mend = (
            "min_edges=0 draws m0/0, too"
            if (quantity, most) == ("edges", 0)
            else (f"lower the one, or raise max_{quantity}")
        )
        raise InputError(
            f"{strategy}: min_{quantity}={least} is above max_{quantity}={most}: {mend}"
        )
