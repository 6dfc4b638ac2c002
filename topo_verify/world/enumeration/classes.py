"""Classes of worlds, such as `planar` or `simple,max-degree:4`: membership, counts and samples.

A class is terms joined with commas, which must all hold; none depends on the marker. They are
`any`, `planar`, `genus:G`, `genus<=G`, `loopless`, `simple`, `min-degree:D`, `max-degree:D` and
`regular:D`.

Source: docs/semantics.md, section 16.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from random import Random

from topo_verify.errors import InputError, close_name, shown
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.counts import (
    count_genus,
    count_graphs,
    count_planar_loopless,
    count_planar_simple,
)
from topo_verify.world.families import random_maps
from topo_verify.world.rooted_map import World

MAX_LISTED_EDGES = 7
"""Some classes are counted by listing: 1,708,394 worlds with 7 edges."""

PLANAR = {"planar,loopless": count_planar_loopless, "planar,simple": count_planar_simple}
"""The classes of a genus and a property of the graph that a formula counts."""

MAX_BY_VERTICES = 100
"""Limit of `count_by_vertices`: a second for planar worlds."""

MAX_DRAWN_EDGES = 500_000
"""Drawing gives up after worlds with this many edges together: about 10 seconds."""

_WORDS = ("any", "planar", "simple", "loopless")

_BOUNDS = ("genus:", "genus<=", "min-degree:", "max-degree:", "regular:")

_TERM = re.compile(rf"({'|'.join(_WORDS)})|({'|'.join(_BOUNDS)})([0-9]{{1,9}})")


@dataclass(frozen=True, slots=True)
class WorldClass:
    """The worlds with all of these properties. `str` gives the text; equal classes print alike.

    Attributes:
        genus: the exact genus; None: any.
        most_genus: if `genus` is None.
    """

    genus: int | None = None
    most_genus: int | None = None
    least_degree: int = 0
    most_degree: int | None = None
    loopless: bool = False
    simple: bool = False

    @classmethod
    def parse(cls, text: str) -> WorldClass:
        """The class that the text describes.

        Raises:
            InputError: a term is unknown, or the class is empty.
        """
        words, bounds = _terms(text)
        exact = {*bounds["genus:"], *([0] if "planar" in words else [])}
        most = min(bounds["genus<="], default=None)
        if most == 0:
            exact.add(0)
        if len(exact) > 1 or (exact and most is not None and max(exact) > most):
            raise InputError(
                f"class {shown(text, limit=80)!r} contradicts itself: a world has one genus;"
                " name one or one bound"
            )
        genus = max(exact, default=None)
        least_degree, most_degree = _degrees(text, bounds, genus)
        return cls(
            genus=genus,
            most_genus=most if genus is None else None,
            least_degree=least_degree,
            most_degree=most_degree,
            loopless="loopless" in words and "simple" not in words,
            simple="simple" in words,
        )

    def __repr__(self) -> str:
        return f"tv.WorldClass.parse({str(self)!r})"

    def __str__(self) -> str:
        genus = "planar" if self.genus == 0 else f"genus:{self.genus}"
        terms = {
            genus: self.genus is not None,
            f"genus<={self.most_genus}": self.most_genus is not None,
            "loopless": self.loopless,
            "simple": self.simple,
            f"regular:{self.most_degree}": self.least_degree == self.most_degree,
            f"min-degree:{self.least_degree}": 0 < self.least_degree != self.most_degree,
            f"max-degree:{self.most_degree}": self.most_degree not in (None, self.least_degree),
        }
        return ",".join(term for term, holds in terms.items() if holds) or "any"

    def admits(self, table: rank_order.Table) -> bool:
        """Whether the world with this table is in the class, without making a `World`."""
        # the genus walks every face, so it comes last
        if self.most_degree is not None and max(table[0]) > self.most_degree:
            return False
        if min(table[0]) < self.least_degree:
            return False
        if self.loopless or self.simple:
            ends = _ends(table)
            # without loops, only parallel edges repeat a pair
            if any(a == b for a, b in ends) or (self.simple and len(set(ends)) < len(ends)):
                return False
        if self.genus is not None:
            return _genus(table) == self.genus
        return self.most_genus is None or _genus(table) <= self.most_genus

    def count(self, edges: int) -> int:
        """The number of worlds with this many edges in the class.

        Genera are counted by a formula, properties of the graph by `count_graphs`, both together by
        listing, but for those of `PLANAR`. None uses the pruned search, so a search that reaches
        the number was complete.
        """
        formula = PLANAR.get(str(self))
        return formula(edges) if formula else self._count(edges)

    def count_by_vertices(self, edges: int) -> dict[int, int]:
        """The number of worlds in the class with each number of vertices, where there is one.

        Raises:
            InputError: more than `MAX_BY_VERTICES` edges, or too many for `count`.
        """
        if edges > MAX_BY_VERTICES:
            raise InputError(
                f"expected at most {MAX_BY_VERTICES} edges to count by vertices, got {edges}:"
                " ask for fewer, or for the total"
            )
        width = self.count(edges).bit_length()
        packed = self._count(edges, 1 << width)  # a number for each number of vertices
        numbers = {v: packed >> v * width & (1 << width) - 1 for v in range(1, edges + 2)}
        return {vertices: number for vertices, number in numbers.items() if number}

    def _count(self, edges: int, x: int = 1) -> int:
        """The sum of x^(number of vertices)."""
        if self._has_formula:
            return self._count_by_formula(edges, x)
        if not self.is_listed(by_vertices=True):
            return count_graphs(
                edges,
                x,
                least_degree=self.least_degree,
                most_degree=self.most_degree,
                loopless=self.loopless,
                simple=self.simple,
            )
        if edges > MAX_LISTED_EDGES:
            raise InputError(
                f"class {self}: expected at most {MAX_LISTED_EDGES} edges, got {edges}: no formula"
                " counts a genus and a property of the graph together, and a count from the list of"
                " the class would not prove the list complete; in Python"
                f" tv.worlds({edges}, cls={str(self)!r}) lists its worlds"
            )
        return sum(x ** len(t[0]) for t in rank_order.tables(edges) if self.admits(t))

    def is_listed(self, *, by_vertices: bool = False) -> bool:
        """Whether its worlds are counted one by one: it has a genus and a property of the graph."""
        mixed = not (self._has_formula or (self.genus is None and self.most_genus is None))
        return mixed and (by_vertices or str(self) not in PLANAR)

    def most(self, edges: int) -> int:
        """A bound for `count`, quickly: the worlds of its genus, or with its graphs."""
        if not self.is_listed():
            return self.count(edges)
        by_genus = WorldClass(self.genus, self.most_genus)
        by_graph = replace(self, genus=None, most_genus=None)
        return min(by_genus.count(edges), by_graph.count(edges))

    def sample(self, edges: int, random: Random) -> World:
        """A world of the class, exactly uniform, by rejection; InputError if it is too rare."""
        if self.genus is not None and edges < 2 * self.genus:
            raise InputError(f"class {self}: there is no world with {edges} edges in it")
        genus = self._drawn_genus(edges)
        # a draw from a genus takes a quarter of the time
        tries = MAX_DRAWN_EDGES * (1 if genus is None else 4) // max(edges, 1)
        self._require_frequent(edges, genus, tries)
        for _ in range(tries):
            if genus is None:
                table = rank_order.sample(edges, random)
            else:
                world = random_maps.drawn(edges, genus, random)
                if world is None:
                    continue
                table = world.code
            if self.admits(table):
                return World.from_code(table)
        raise InputError(self._too_rare(edges, f"none of {tries} that were drawn"))

    def _drawn_genus(self, edges: int) -> int | None:
        """The genus to draw from; None: worlds of any genus need fewer draws."""
        if self.genus is None or edges > rank_order.MAX_ID_EDGES:
            return self.genus
        draws = random_maps.draws(edges, self.genus)
        return self.genus if draws < rank_order.count(edges) else None

    def _require_frequent(self, edges: int, genus: int | None, tries: int) -> None:
        if self == WorldClass() or not (self._has_formula or str(self) in PLANAR):
            return
        if edges <= rank_order.MAX_ID_EDGES:
            drawn = rank_order.count(edges) if genus is None else random_maps.draws(edges, genus)
            inside = self.count(edges)
            if 4 * drawn > inside * tries:  # e^-4: fails once in 50 times, at most
                raise InputError(self._too_rare(edges, f"{float(inside / drawn):.0e} of all draws"))
        elif self != WorldClass(genus):
            most = rank_order.MAX_ID_EDGES
            raise InputError(self._too_rare(edges, f"none is tried above {most} edges"))

    @property
    def _has_formula(self) -> bool:
        return self == WorldClass(self.genus, self.most_genus)

    def _count_by_formula(self, edges: int, x: int = 1) -> int:
        if self.genus == 0 and x == 1:
            return rank_order.count_planar(edges)
        if self.genus is not None:
            return count_genus(edges, self.genus, x)
        # 2g <= m, by Euler's formula
        if self.most_genus is not None and 2 * self.most_genus < edges:
            return sum(count_genus(edges, genus, x) for genus in range(self.most_genus + 1))
        return rank_order.count(edges) if x == 1 else rank_order.count_by_recurrence(edges, x)

    def _too_rare(self, edges: int, evidence: str) -> str:
        instead = (
            "draw from the family random_genus, whose worlds are not equally likely"
            if self._has_formula
            else f"if it has few, choose from tv.worlds({edges}, cls={str(self)!r})"
        )
        return (
            f"class {self}: too few of the worlds with {edges} edges are in it to draw one"
            f" ({evidence}): ask for fewer edges or a wider class, or {instead}"
        )


def _terms(text: str) -> tuple[set[str], dict[str, list[int]]]:
    words: set[str] = set()
    bounds: dict[str, list[int]] = {bound: [] for bound in _BOUNDS}
    for term in text.split(","):
        match = _TERM.fullmatch(term.strip())
        if not match:
            name = shown(term.strip(), limit=80)
            raise InputError(
                f"class {name!r}{close_name(name, _WORDS) or ':'} expected any, planar, genus:G,"
                " genus<=G, simple, loopless, min-degree:D, max-degree:D or regular:D, or several"
                " of them joined with commas, all of which hold"
            )
        word, bound, number = match.groups()
        if bound:
            bounds[bound].append(int(number))
        else:
            words.add(word)
    return words, bounds


def _degrees(text: str, bounds: dict[str, list[int]], genus: int | None) -> tuple[int, int | None]:
    """The least and the most degree; InputError if no world with an edge has such degrees."""
    least = max(bounds["min-degree:"] + bounds["regular:"], default=0)
    most = min(bounds["max-degree:"] + bounds["regular:"], default=None)
    if most is not None and least > most:
        raise InputError(
            f"class {shown(text, limit=80)!r} contradicts itself: no vertex has at least {least}"
            f" and at most {most} exits; lower the one or raise the other"
        )
    # paths and cycles have genus 0
    if most == 0 or (genus and most in (1, 2)):
        raise InputError(
            f"class {shown(text, limit=80)!r} is empty: with at most {most} exits a vertex there is"
            f" no world {f'of genus {genus}' if most else 'with an edge'}; raise max-degree"
        )
    return least, most


def _ends(table: rank_order.Table) -> list[tuple[int, int]]:
    degrees, alpha = table
    vertex = [v for v, degree in enumerate(degrees) for _ in range(degree)]
    return [(vertex[dart], vertex[other]) for dart, other in enumerate(alpha)]


def _genus(table: rank_order.Table) -> int:
    degrees, alpha = table
    after: list[int] = []
    for degree in degrees:
        first = len(after)
        after += range(first + 1, first + degree)
        after += [first] * (degree > 0)
    visited = [False] * len(alpha)
    faces = 0 if alpha else 1
    for dart in range(len(alpha)):
        faces += not visited[dart]
        while not visited[dart]:
            visited[dart] = True
            dart = after[alpha[dart]]  # noqa: PLW2901
    return (2 - len(degrees) + len(alpha) // 2 - faces) // 2
