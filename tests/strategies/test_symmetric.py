"""Covers: the worlds that they are known for, and that their places do look alike."""

from __future__ import annotations

from itertools import cycle, repeat

import pytest
from hypothesis import find, given, settings
from hypothesis import strategies as st

from tests.helpers import some
from tests.strategies import features
from topo_verify import families
from topo_verify.strategies import symmetric_worlds
from topo_verify.strategies.growth import BALANCED, grow
from topo_verify.strategies.shapes import Shape
from topo_verify.strategies.symmetric import Small, cover, necklace, rosette


def one_vertex(darts: str, shifts: dict[str, int]) -> Small:
    """A rosette as the module writes them: `abAB`, letters in both cases are the two halves."""
    place = {letter: number for number, letter in enumerate(darts)}
    count = len(darts)
    return Small(
        alpha=tuple(place.get(letter.swapcase(), place[letter]) for letter in darts),
        sigma=tuple((number + 1) % count for number in range(count)),
        shift=tuple(
            shifts[letter] if letter in shifts else -shifts[letter.lower()] for letter in darts
        ),
        vertex=(0,) * count,
    )


@pytest.mark.parametrize(
    ("darts", "sheets", "shifts", "vertices", "edges", "genus", "simple"),
    [
        ("aA", 7, {"a": 1}, 7, 7, 0, True),  # a cycle
        ("aA", 1, {"a": 0}, 1, 1, 0, False),  # a loop
        ("abc", 2, {"a": 1, "b": 1, "c": 1}, 2, 3, 1, False),  # three parallel edges, crossing
        ("abA", 2, {"a": 1, "b": 1}, 2, 3, 0, False),  # three parallel edges in the plane
        ("aAbB", 1, {"a": 0, "b": 0}, 1, 2, 0, False),  # two loops side by side
        ("abAB", 1, {"a": 0, "b": 0}, 1, 2, 1, False),  # two loops that cross
        ("abAB", 9, {"a": 1, "b": 3}, 9, 18, 1, True),  # a lattice on the torus
        ("abA", 6, {"a": 1, "b": 3}, 6, 9, 1, True),  # three houses, three wells: a Möbius ladder
        ("abA", 8, {"a": 1, "b": 4}, 8, 12, 2, True),  # a Möbius ladder with four rungs
        ("abAB", 5, {"a": 1, "b": 2}, 5, 10, 1, True),  # the complete graph on 5 vertices
        ("abA", 4, {"a": 1, "b": 2}, 4, 6, 1, True),  # the complete graph on 4, on a torus
    ],
)
def test_rosettes_cover_what_they_are_known_to_cover(
    darts: str,
    sheets: int,
    shifts: dict[str, int],
    vertices: int,
    edges: int,
    genus: int,
    simple: bool,
) -> None:
    world = cover(one_vertex(darts, shifts), sheets, 0)
    assert (len(world.vertices), len(world.edges)) == (vertices, edges)
    assert (world.genus, world.is_simple) == (genus, simple)


def test_a_bead_with_a_crossing_loop_makes_the_torus() -> None:
    """A ring of 4 vertices, a loop of shift 1 across it at each: 4 rows, and 3 sheets."""
    ring = one_vertex("abAB", {"a": 1, "b": 0})
    darts = [(sheet, dart) for sheet in range(4) for dart in range(4)]
    alpha = [(sheet + ring.shift[dart]) % 4 * 4 + ring.alpha[dart] for sheet, dart in darts]
    bead = Small(
        alpha=tuple(alpha),
        sigma=tuple(4 * sheet + ring.sigma[dart] for sheet, dart in darts),
        shift=tuple((0, 1, 0, -1)[dart] for _, dart in darts),
        vertex=tuple(sheet for sheet, _ in darts),
    )
    torus = families.torus(4, 3)
    codes = {torus.with_marker(dart).code for dart in range(len(torus.alpha))}
    assert cover(bead, 3, 0).code in codes


@settings(max_examples=60)
@given(
    sheets=st.integers(1, 9),
    darts=st.integers(2, 8),
    drawn=st.binary(min_size=1),
    simple=st.booleans(),
)
def test_all_vertices_of_a_rosette_look_alike(
    sheets: int, darts: int, drawn: bytes, simple: bool
) -> None:
    if sheets * darts % 2 or (simple and darts >= sheets):
        return
    shape = Shape(max_parallel=1, max_loops=0) if simple else Shape()
    small = rosette(shape, sheets, darts, cycle(drawn))
    world = cover(small, sheets, 0)
    assert len(world.vertices) == sheets
    assert not simple or world.is_simple
    for sheet in range(sheets):
        assert world.with_marker(sheet * darts).code == world.code


@settings(max_examples=60)
@given(sheets=st.integers(2, 6), steps=st.binary(min_size=1, max_size=7), drawn=st.binary())
def test_all_beads_of_a_necklace_look_alike(sheets: int, steps: bytes, drawn: bytes) -> None:
    bead = some(grow(Shape(min_cycles=1), BALANCED, steps))
    world = cover(necklace(Shape(), sheets, bead, cycle(drawn or b"\0")), sheets, 0)
    assert len(world.edges) == sheets * len(steps)
    for sheet in range(sheets):
        assert world.with_marker(sheet * 2 * len(steps)).code == world.code


@settings(max_examples=60)
@given(sheets=st.integers(2, 6), steps=st.binary(min_size=4, max_size=9), drawn=st.binary())
def test_the_cover_of_a_fitting_bead_is_simple(sheets: int, steps: bytes, drawn: bytes) -> None:
    fitting = Shape(min_cycles=1, max_parallel=sheets, max_loops=(sheets - 1) // 2)
    bead = some(grow(fitting, BALANCED, steps))
    small = necklace(Shape(max_parallel=1, max_loops=0), sheets, bead, cycle(drawn or b"\0"))
    assert cover(small, sheets, 0).is_simple


def test_loops_shift_where_loops_are_forbidden() -> None:
    bouquet = rosette(Shape(max_loops=0), 3, 6, repeat(0))
    assert cover(bouquet, 3, 0).is_loopless
    assert not cover(rosette(Shape(), 3, 6, repeat(0)), 3, 0).is_loopless


@pytest.mark.parametrize(
    ("what", "edges"),
    [
        *(("cycle", 6), ("K5", 10), ("K4", 6)),
        pytest.param("prism", 9, marks=pytest.mark.long),
        pytest.param("torus", 18, marks=pytest.mark.nightly),
    ],
)
def test_well_known_worlds_are_found(what: str, edges: int) -> None:
    known = {
        "cycle": families.cycle(6),
        "K5": families.complete(5),
        "K4": families.complete(4),
        "prism": families.prism(3),
        "torus": families.torus(3, 3),
    }[what]
    strategy = symmetric_worlds(simple=True, min_edges=edges, max_edges=edges)
    world = find(
        strategy,
        lambda w: (
            sorted(w.degrees) == sorted(known.degrees)
            and sorted(features.joins(w).values()) == sorted(features.joins(known).values())
            and (what in ("K5", "K4") or w.genus == known.genus)
        ),
        settings=settings(max_examples=2000, derandomize=True, database=None),
    )
    assert len(world.vertices) == len(known.vertices)
