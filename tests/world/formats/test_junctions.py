"""Junctions with an extent: random drawings are read as the worlds that were drawn."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from itertools import pairwise
from math import dist
from random import Random

import pytest

from tests.world.formats.drawings import KINDS, Drawing, Road, crossings, drawing, rounded
from topo_verify.errors import InputError
from topo_verify.world import World
from topo_verify.world.formats import embedding, junctions
from topo_verify.world.formats.embedding import DrawnEdge, DrawnEnd, DrawnVertex
from topo_verify.world.formats.flaws import Flaws
from topo_verify.world.formats.junctions import Leaving, Point

FEW, MANY = 6, 60
"""Drawings of each kind, and at night."""

CHANGES: dict[str, Callable[[Drawing, Random], Drawing]] = {
    "as it is": lambda drawn, _: drawn,
    "turned": lambda drawn, random: drawn.turned(random.uniform(0, 7)),
    "mirrored": lambda drawn, _: drawn.mirrored(),
    "to centimetres": lambda drawn, random: rounded(drawn.turned(random.uniform(0, 7)), 2),
    "in UTM": lambda drawn, random: rounded(
        drawn.turned(random.uniform(0, 7)).moved(lambda p: (p[0] + 385000, p[1] + 6672000)), 2
    ),
    "in degrees": lambda drawn, random: rounded(
        drawn.turned(random.uniform(0, 7)).moved(lambda p: (p[0] / 1e5 + 25, p[1] / 1e5 - 60)), 7
    ),
    "begun 1e-7 aside": lambda drawn, random: drawn.shaken(random, 1e-7),
    "in degrees, begun 1e-7 aside": lambda drawn, random: drawn.moved(
        lambda p: (p[0] / 1e5 + 25, p[1] / 1e5 - 60)
    ).shaken(random, 1e-7),
}


@cache
def drawings(kind: str, number: int) -> list[Drawing]:
    return [drawing(kind, Random(f"{kind} {n}")) for n in range(number)]


def read(drawn: Drawing, *, both: bool = False) -> World:
    """The world that is read, with both directions of each road or one."""
    ways = [
        DrawnEdge(road.start, road.end, road.course, directed=both, name=str(number))
        for number, road in enumerate(drawn.roads)
    ]
    if both:
        ways += [
            DrawnEdge(road.end, road.start, road.course[::-1], directed=True)
            for road in drawn.roads
        ]
    places = [DrawnVertex(str(number), at) for number, at in enumerate(drawn.at)]
    marker = DrawnEnd(0, 0)
    return embedding.as_world(World, places, ways, Flaws("the drawing"), marker=marker)


def refused_of(drawn: Sequence[Drawing], *, both: bool = False) -> int:
    """How many are refused; the others are read as they were drawn."""
    refused = 0
    for one in drawn:
        try:
            world = read(one, both=both)
        except InputError:
            refused += 1
            continue
        assert world.code == one.world.code
        assert world.genus == 0
    return refused


@pytest.mark.parametrize(
    ("number", "most"), [(FEW, 1), pytest.param(MANY, MANY / 10, marks=pytest.mark.nightly)]
)
@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("kind", KINDS)
def test_a_drawing_is_read_as_the_world_that_was_drawn_or_refused(
    kind: str, change: str, number: int, most: float
) -> None:
    changed = [CHANGES[change](drawn, Random(n)) for n, drawn in enumerate(drawings(kind, number))]
    assert refused_of(changed) <= most  # a loop around its vertex


@pytest.mark.parametrize("kind", KINDS)
def test_a_drawing_of_both_directions_is_read_as_the_world_that_was_drawn(kind: str) -> None:
    assert refused_of(drawings(kind, FEW), both=True) <= 1


# ---------------------------------------------------------------- by hand


def around(world: World, vertex: int = 0) -> list[int]:
    """The vertices to which the edges lead from a vertex, clockwise, from the least one on."""
    row = [world.vertex_of[world.alpha[dart]] for dart in world.vertices[vertex]]
    first = row.index(min(row))
    return [*row[first:], *row[:first]]


def drawn_world(at: Sequence[Point], *roads: Road) -> World:
    return read(Drawing(at, roads, []))


NESW: list[Point] = [(0, 0), (0, 90), (90, 0), (0, -90), (-90, 0)]


def rim(radius: float) -> list[Road]:
    """Four straight roads to the north, east, south and west that begin on a rim."""
    return [
        Road(0, n, [(x / 90 * radius, y / 90 * radius), (x, y)])
        for n, (x, y) in enumerate(NESW[1:], 1)
    ]


def test_roads_that_leave_away_from_the_point_and_slant_towards_each_other() -> None:
    at: list[Point] = [(0, 0), (0, 100), (-8, -100), (8, -100)]
    slant = [Road(0, 2, [(-12, -3), (-8, -100)]), Road(0, 3, [(12, -3), (8, -100)])]
    assert around(drawn_world(at, Road(0, 1, [(0, 0), (0, 100)]), *slant)) == [1, 3, 2]


@pytest.mark.parametrize("aside", [3, 0.5, 0.05])
def test_straight_parallel_roads_that_begin_apart_and_end_together_are_two(aside: float) -> None:
    at: list[Point] = [(0, 0), (100, 0), (0, 100)]
    roads = [Road(0, 1, [(8, y), (100, 0)]) for y in (aside, -aside)]
    world = drawn_world(at, *roads, Road(0, 2, [(0, 8), (0, 100)]), Road(2, 1, [at[2], at[1]]))
    assert (around(world), world.genus) == ([1, 1, 2], 0)


@pytest.mark.parametrize("length", [0.01, 2, 14])
def test_a_street_may_be_shorter_than_the_extents_of_its_junctions(length: float) -> None:
    far = 23 + length  # a rim of 15, and one of 8 around (far, 0)
    at: list[Point] = [*NESW[:2], (far, 0), *NESW[3:], (far, 90), (far + 90, 0), (far, -90)]
    roads = rim(15)
    roads[1] = Road(0, 2, [(15, 0), (15 + length, 0)])
    roads += [
        Road(2, 5, [(far, 8), (far, 90)]),
        Road(2, 6, [(far + 8, 0), (far + 90, 0)]),
        Road(2, 7, [(far, -8), (far, -90)]),
    ]
    world = drawn_world(at, *roads)
    assert around(world) == [1, 2, 3, 4]
    assert around(world, 2) == [0, 5, 6, 7]


@pytest.mark.parametrize("near", [1, 3, 9, 14])
def test_a_road_may_pass_through_the_extent_of_another_junction(near: float) -> None:
    world = drawn_world(NESW, *rim(15), Road(2, 1, [(90, 0), (near, near), (0, 90)]))
    assert around(world) == [1, 2, 3, 4]
    assert world.genus == 0


@pytest.mark.parametrize("size", [0.5, 3, 30])
@pytest.mark.parametrize("begin", [0, 2, 7])
def test_a_loop_may_lie_within_the_extent(size: float, begin: float) -> None:
    first, far = (begin, begin), (begin + size, begin + size)
    loop = [first, (begin + size / 9, far[1]), (far[0], begin + size / 9), first]
    world = drawn_world(NESW, *rim(15), Road(0, 0, loop))
    assert around(world) == [0, 0, 2, 3, 4, 1]
    assert world.genus == 0


def test_edges_that_meet_on_every_way_are_refused_with_the_vertex_and_both() -> None:
    ring: list[Point] = [(5, 0), (0, 5), (-5, 0), (0, -5), (5.1, 0)]
    with pytest.raises(InputError, match=r"vertex '0' .*'4'.*"):
        read(Drawing(NESW, [*rim(1), Road(0, 0, ring)], []))


# ---------------------------------------------------------------- far from the vertices


@pytest.mark.parametrize("scale", [1e-5, 0.4, 3])
def test_a_polyline_in_other_coordinates_is_refused_with_its_edge(scale: float) -> None:
    at: list[Point] = [(385000, 6672000), (385100, 6672000)]
    course = [(385000 * scale, 6672000 * scale), (385100 * scale, 6672000 * scale)]
    roads = [Road(0, 1, [*at]), Road(0, 1, course)]
    for strange in (roads, roads[1:]):
        with pytest.raises(InputError, match=f"edge '{len(strange) - 1}' has an end"):
            read(Drawing(at, [*strange], []))


def test_an_end_may_be_away_by_half_of_the_distance_and_the_extent() -> None:
    at: list[Point] = [(0, 0), (0, 100), (10, 0)]

    def short(offset: float) -> list[Road]:
        return [Road(0, 1, [(0, 15), (0, 100)]), Road(0, 2, [(10, offset), (10, 0)])]

    assert read(Drawing(at, short(-17), [])).genus == 0  # 19.7 from the point
    with pytest.raises(InputError, match="edge '1' has an end"):
        read(Drawing(at, short(-18), []))


def test_a_loop_begins_within_half_of_its_length() -> None:
    def loop(x: float) -> list[Road]:
        return [
            Road(0, 1, [(0, 0), (0, 90)]),
            Road(0, 0, [(x, 0), (x + 4, 3), (x + 4, -3), (x, 0)]),
        ]

    assert read(Drawing(NESW[:2], loop(7.9), [])).genus == 0
    with pytest.raises(InputError, match="edge '1' has an end"):
        read(Drawing(NESW[:2], loop(8.1), []))


# ---------------------------------------------------------------- the law


def with_spokes(drawn: Drawing) -> list[list[Point]]:
    """The courses of the roads, each straight from its vertices to its exits."""
    cuts: dict[tuple[int, int], tuple[list[Point], int]] = {}  # new points; points that stay
    for at, row in zip(drawn.at, drawn.rotations, strict=True):
        outwards = [drawn.roads[number].course[:: -1 if side else 1] for number, side in row]
        courses = junctions.snapped(at, outwards)
        for end, course in zip(row, courses, strict=True):
            cuts[end] = [at], len(course) - 1
        if any(course[0] != at for course in courses):
            leaving = [Leaving(n, c) for (n, _), c in zip(row, courses, strict=True)]
            for spoke in junctions.clockwise(at, leaving):
                stay = len(courses[spoke.end]) - spoke.after
                cuts[row[spoke.end]] = [at, spoke.exit], stay
    redrawn: list[list[Point]] = []
    for number, road in enumerate(drawn.roads):
        (head, stay), (tail, until) = cuts[number, 0], cuts[number, 1]
        first = len(road.course) - stay
        between = road.course[first:until] if first <= until else road.course[until:first][::-1]
        points = [*head, *between, *tail[::-1]]
        redrawn.append([points[0], *(b for a, b in pairwise(points) if a != b)])
    return redrawn


def scrawl(random: Random) -> Drawing:
    """A drawing with crossings, whose roads begin around their vertices."""
    at = [(random.uniform(0, 100), random.uniform(0, 100)) for _ in range(random.randint(2, 7))]

    def near(p: Point, sizes: Sequence[float]) -> Point:
        size = random.choice(sizes)
        return p[0] + random.uniform(-size, size), p[1] + random.uniform(-size, size)

    ends = [(n, n + 1) for n in range(len(at) - 1)]
    ends += [(random.randrange(len(at)), random.randrange(len(at))) for _ in range(len(at))]
    roads: list[Road] = []
    for a, b in ends:
        first, last = (near(at[end], [0, 0, 1e-9, 0.1, 5, 20]) for end in (a, b))
        if dist(first, at[b]) + dist(last, at[a]) < dist(first, at[a]) + dist(last, at[b]):
            first, last = last, first  # else the reader turns the course
        bends = [near(random.choice(at), [1, 5, 20]) for _ in range(3)]
        roads.append(Road(a, b, [first, *bends, last]))
    rows = [
        [(n, side) for n, ends in enumerate(ends) for side in (0, 1) if ends[side] == vertex]
        for vertex in range(len(at))
    ]
    return Drawing(at, roads, rows)


@pytest.mark.parametrize("seed", range(40))
def test_the_genus_is_at_most_the_number_of_crossings_of_the_drawing_with_spokes(seed: int) -> None:
    random = Random(seed)
    judged = 0
    while judged < 10:
        drawn = scrawl(random)
        try:
            world = read(drawn)
            courses = with_spokes(drawn)
        except (InputError, junctions.NoOrder):
            continue
        assert world.genus <= crossings(courses)
        judged += 1
