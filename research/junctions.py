"""Which rule reads the order of roads at junctions with an extent (150 drawings of a kind: 1 min).

    python -m research.junctions 150

Random planar drawings of known worlds, five kinds of them (tests/world/formats/drawings.py), are
read by each rule: the one of topo_verify/world/formats/junctions.py, and four that sort the ends at
a vertex by one bearing. A drawing is misread if another world comes out than the one drawn.
"""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Callable, Sequence
from math import dist
from random import Random

from tests.world.formats.drawings import KINDS, Drawing, drawing
from topo_verify.errors import InputError
from topo_verify.world.formats import embedding
from topo_verify.world.formats.embedding import DrawnEdge, DrawnVertex
from topo_verify.world.formats.flaws import Flaws
from topo_verify.world.formats.junctions import Point, bearing
from topo_verify.world.rooted_map import World

STEP = 0.25
"""Metres between the points along a road at which a rule looks."""


def read(drawn: Drawing) -> World:
    """The world that the reader of files makes of the drawing."""
    places = [DrawnVertex(str(number), at) for number, at in enumerate(drawn.at)]
    ways = [DrawnEdge(road.start, road.end, road.course) for road in drawn.roads]
    marker = embedding.DrawnEnd(0, 0)
    return embedding.as_world(World, places, ways, Flaws("the drawing"), marker=marker)


Direction = Callable[[Point, Sequence[Point], float], float]
"""The bearing by which an end is sorted: the vertex, the course outwards, the largest offset."""


def along(course: Sequence[Point], length: float) -> Point:
    """The point of a course at this length from its beginning, or its last point."""
    for a, b in itertools.pairwise(course):
        step = dist(a, b)
        if step >= length:
            share = length / step if step else 0.0
            return a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])
        length -= step
    return course[-1]


def leaves(at: Point, course: Sequence[Point], radius: float) -> Point:
    """Where a course is in a circle for the last time, in steps; its end if it never leaves."""
    whole = sum(dist(a, b) for a, b in itertools.pairwise(course))
    points = [along(course, STEP * number) for number in range(int(whole / STEP) + 1)]
    inside = [number for number, point in enumerate(points) if dist(at, point) <= radius]
    return points[min(inside[-1] + 1, len(points) - 1)] if inside else course[0]


RULES: dict[str, Direction] = {
    "direction of the first segment": lambda _at, course, _most: bearing(course[0], course[1]),
    "bearing of the first point": lambda at, course, _most: bearing(
        at, course[1] if course[0] == at else course[0]
    ),
    "bearing of the point 10 m along the road (SUMO)": lambda at, course, _most: bearing(
        at, along(course, 10)
    ),
    "exit from a circle of 1.5 times the largest offset": lambda at, course, most: bearing(
        at, leaves(at, course, 1.5 * most) if most else course[1]
    ),
}


def sorted_by(drawn: Drawing, direction: Direction) -> World:
    """The world of a drawing whose ends are sorted by one bearing."""
    rows: list[list[tuple[float, int]]] = [[] for _ in drawn.at]
    outwards = [
        (vertex, 2 * number + side, road.course[:: -1 if side else 1])
        for number, road in enumerate(drawn.roads)
        for side, vertex in enumerate((road.start, road.end))
    ]
    most = [0.0] * len(drawn.at)
    for vertex, _, course in outwards:
        most[vertex] = max(most[vertex], dist(drawn.at[vertex], course[0]))
    for vertex, dart, course in outwards:
        rows[vertex].append((direction(drawn.at[vertex], course, most[vertex]), dart))
    rotations = [[dart for _, dart in sorted(row)] for row in rows]
    pairs = [(2 * number, 2 * number + 1) for number in range(len(drawn.roads))]
    return World.from_rotations(rotations, pairs, 0)


def main() -> None:
    ask = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    ask.add_argument("drawings", type=int, nargs="?", default=150, help="of each kind")
    number = ask.parse_args().drawings
    drawn = [drawing(kind, Random(f"{kind} {n}")) for kind in KINDS for n in range(number)]
    refused = misread = 0
    for one in drawn:
        try:
            misread += read(one).code != one.world.code
        except InputError:
            refused += 1
    print("| rule | drawings | refused | misread |\n| --- | ---: | ---: | ---: |")
    print(f"| spokes that meet no other edge | {len(drawn)} | {refused} | {misread} |")
    for name, rule in RULES.items():
        wrong = sum(sorted_by(one, rule).code != one.world.code for one in drawn)
        print(f"| {name} | {len(drawn)} | 0 | {wrong} |", flush=True)


if __name__ == "__main__":
    main()
