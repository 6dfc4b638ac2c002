"""Worlds in which many places look alike, so that the marker alone tells them apart.

A **cover** is n copies of a small map, its *sheets*, numbered round a circle. Each edge of the
small map has a *shift* s: in sheet i it leads to sheet i + s. Turning the circle maps the cover
onto itself, so without the marker no place differs from its copies.

**Rosettes**: the small map has one vertex (the Cayley maps of cyclic groups). Its darts are `a A b
B …`; a letter without its capital is half an edge a sheet, which must shift by n/2:

    darts, sheets          cover                        darts, sheets          cover
    aA, n, a: 1            cycle                        abAB, n, a: 1, b: c    lattice on a torus
    abc, 2, all: 1         3 parallel edges             all of n-1 shifts      complete graph
    aAbB, 1                2 loops                      abA, n, b: n/2         Möbius ladder

**Necklaces**: the small map, a bead, is any map with a cycle. Source (voltage graphs): J. L. Gross
and T. W. Tucker, "Topological Graph Theory" (1987), chapter 2.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import cycle, islice

from hypothesis import reject
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from topo_verify.errors import InputError
from topo_verify.strategies.draws import (
    AT_MOST,
    Sizes,
    at_most,
    canonical,
    draw_dart,
    marked_darts,
    shown_as_called,
)
from topo_verify.strategies.growth import BALANCED, Grown, grow
from topo_verify.strategies.shapes import (
    MANY,
    WIDEST,
    MarkerPlace,
    Shape,
    edge_bounds,
    grown_shape,
)
from topo_verify.world.rooted_map import Dart, World

_FIRST = st.sampled_from(
    [(bound, is_necklace) for is_necklace in (False, True) for bound in AT_MOST]
)

_NUMBERS = 8
"""The least number of bytes that place the edges; they are read in a circle."""


@dataclass(frozen=True, slots=True)
class Small:
    """The small map that every sheet is a copy of; `alpha` of half an edge is itself."""

    alpha: tuple[Dart, ...]
    sigma: tuple[Dart, ...]
    shift: tuple[int, ...]
    vertex: tuple[int, ...]


@shown_as_called
def symmetric_worlds(
    *,
    min_edges: int = 1,
    max_edges: int = WIDEST,
    simple: bool = False,
    loopless: bool = False,
    max_degree: int | None = None,
    marker: MarkerPlace = "any",
) -> SearchStrategy[World]:
    """Rosettes, in which all vertices look alike, and necklaces, in which all beads do.

    Shrinks to few edges, then to rosettes, then to few sheets. For a genus, filter.
    """
    least, most = edge_bounds("symmetric_worlds", min_edges, max_edges)
    shape = grown_shape(
        "symmetric_worlds", simple=simple, loopless=loopless, max_degree=max_degree, marker=marker
    )
    if not any(_kinds(shape, least, most)):
        raise InputError(
            f"symmetric_worlds: no rosette or necklace of {shape} has {least} to {most} edges:"
            " widen the bounds"
        )
    return _symmetric(shape, least, most, marker)


@st.composite
def _symmetric(draw: st.DrawFn, shape: Shape, least: int, most: int, marker: MarkerPlace) -> World:
    bound, is_necklace = draw(_FIRST)
    kinds = _kinds(shape, least, max(least, at_most(most, bound)))
    if not any(kinds):
        kinds = _kinds(shape, least, most)
    sizes = kinds[is_necklace] or kinds[not is_necklace]
    assert sizes is not None
    size, sheets = sizes.draw(draw)
    numbers = cycle(draw(st.binary(min_size=_NUMBERS, max_size=_NUMBERS + 2 * most)))
    if sizes is kinds[0]:
        small = rosette(shape, sheets, size, numbers)
    else:
        bead = grow(_bead(shape, sheets), BALANCED, bytes(islice(numbers, size)))
        small = reject() if bead is None else necklace(shape, sheets, bead, numbers)
    if not small.alpha:
        return World((), (), None)
    if marker == "leaf":  # dart 0 leaves a leaf
        return canonical(cover(small, sheets, 0))
    root = draw_dart(draw, marked_darts(small.vertex, marker), 2 * most)
    return canonical(cover(small, sheets, root))


def cover(small: Small, sheets: int, root: Dart) -> World:
    """The world of these sheets, with the marker on sheet 0."""
    darts = len(small.alpha)
    # dart d of sheet i is i·darts + d
    alpha = [
        (sheet + small.shift[dart]) % sheets * darts + small.alpha[dart]
        for sheet in range(sheets)
        for dart in range(darts)
    ]
    sigma = [sheet * darts + after for sheet in range(sheets) for after in small.sigma]
    return World(tuple(alpha), tuple(sigma), root)


@lru_cache(maxsize=256)
def _kinds(shape: Shape, least: int, most: int) -> tuple[Sizes | None, Sizes | None]:
    # n·darts/2 edges of a rosette, n·edges of a bead; -(-a // b) rounds up
    rosettes = {0: [1] * (least == 0 and not shape.leaf)}
    for darts in range(1, min(2 * most, shape.max_degree) + 1):
        sheets = range(max(1, -(-2 * least // darts)), 2 * most // darts + 1)
        rosettes[darts] = [n for n in sheets if _is_rosette(shape, n, darts)]
    necklaces: dict[int, list[int]] = {}
    for edges in range(1, most // 2 + 1):
        sheets = range(max(2, -(-least // edges)), most // edges + 1)
        necklaces[edges] = [n for n in sheets if _bead(shape, n).is_possible(edges)]
    return Sizes.of(rosettes), Sizes.of(necklaces)


def _is_rosette(shape: Shape, sheets: int, darts: int) -> bool:
    if darts == 1:
        return sheets == 2
    if shape.leaf or sheets * darts % 2:
        return False
    if shape.max_parallel == 1:
        return darts < sheets
    return shape.max_loops > 0 or sheets > 1


def _bead(shape: Shape, sheets: int) -> Shape:
    """The bounds on a bead whose cover keeps the bounds of the shape.

    Its parallel edges and loops come apart if their shifts differ.
    """
    if shape.max_parallel == 1:
        return replace(shape, min_cycles=1, max_parallel=sheets, max_loops=(sheets - 1) // 2)
    return replace(shape, min_cycles=1, max_loops=MANY)


def rosette(shape: Shape, sheets: int, darts: int, drawn: Iterator[int]) -> Small:
    """One vertex with `darts` darts: half edges, then whole ones, placed by the numbers drawn.

    The first whole edge shifts by 1, which joins all sheets.
    """
    halves = darts % 2
    # each shifts by sheets/2
    if sheets % 2 == 0 and shape.max_parallel > 1:
        # above 2 sheets a whole edge must join them
        spare = darts - halves - 2 * (sheets > 2 and darts > 1)
        halves += 2 * (next(drawn) % (spare // 2 + 1))
    # s and -s make the same edges; sheets/2 would make them twice
    pool = list(range(1, (sheets + 1) // 2))
    alpha: list[Dart] = []
    shift: list[int] = []
    row: list[Dart] = []
    while len(alpha) < darts:
        dart = len(alpha)
        if dart < halves:
            alpha.append(dart)
            shift.append(sheets // 2)
        else:
            if dart == halves:
                s = pool.pop(0) if pool else 1
            elif shape.max_parallel == 1:
                s = pool.pop(next(drawn) % len(pool))
            else:
                s = _free_shift(shape, sheets, next(drawn))
            alpha += [dart + 1, dart]
            shift += [s, -s]
        # byte 0: side by side
        for new in range(dart, len(alpha)):
            row.insert(new - next(drawn) % (new + 1), new)
    after = dict(zip(row, row[1:] + row[:1], strict=True))
    return Small(tuple(alpha), tuple(after[d] for d in range(darts)), tuple(shift), (0,) * darts)


def necklace(shape: Shape, sheets: int, bead: Grown, drawn: Iterator[int]) -> Small:
    """A bead whose closing edges shift; the first by 1, which joins all sheets."""
    shift: list[int] = []
    taken: dict[tuple[int, int], set[int]] = {}
    for edge in range(len(bead.sigma) // 2):
        ends = bead.vertex[2 * edge], bead.vertex[2 * edge + 1]
        u, v = min(ends), max(ends)
        before = taken.setdefault((u, v), {0} if u == v else set())
        if edge not in bead.closings:
            s = 0
        elif edge == bead.closings[0]:
            s = 1
        elif shape.max_parallel == 1:
            shifts = range((sheets + 1) // 2 if u == v else sheets)
            pool = [s for s in shifts if s not in before]
            s = pool[next(drawn) % len(pool)]
        elif u == v:
            s = _free_shift(shape, sheets, next(drawn))
        else:
            s = next(drawn) % sheets
        # shifts from the lesser vertex on can be compared
        before.add(s)
        shift += [s, -s] if ends == (u, v) else [-s, s]
    return Small(bead.alpha, bead.sigma, tuple(shift), bead.vertex)


def _free_shift(shape: Shape, sheets: int, number: int) -> int:
    return number % sheets if shape.max_loops > 0 else 1 + number % (sheets - 1)
