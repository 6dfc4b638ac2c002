"""A world as a plane map, and a triangulated disc over it.

Edges that do not fit cross others in dummy nodes of degree 4, so every vertex keeps its cyclic
order. A spanning tree is inserted first, then edges with both corners on one face, then each other
edge on a shortest way through the dual; the best of several random orders counts (M. Chimani and C.
Gutwenger, "Advances in the Planarization Method", JGAA 16 (2012)). A half-edge lies in the face on
its left.

**The mesh** has points on every edge, a centre of every face, and a collar within a face that
touches itself, so it has no loops and no parallel edges. A ring of triangles replaces the outer
face. An edge of the mesh should be as long as the radii of its points.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Sequence
from dataclasses import dataclass
from math import pi, sin
from random import Random

import numpy as np

from topo_verify.pictures.drawing.arrays import Floats, Ints
from topo_verify.world.rooted_map import Dart, World

MOST_CROSSINGS = 1000
"""A picture with more is unreadable."""


class PlaneMap:
    """A plane map that grows from the nodes.

    Attributes:
        other, after, before: the other half of each half-edge, and its clockwise neighbours.
        node, edge, face: of each half-edge; the edge is the world's.
        half: the half-edge of each inserted dart.
        nodes: their number; dummies begin at `vertices`.
    """

    def __init__(self, world: World) -> None:
        self.world = world
        self.other: list[int] = []
        self.after: list[int] = []
        self.before: list[int] = []
        self.node: list[int] = []
        self.edge: list[int] = []
        self.face: list[int] = []
        self.half: dict[Dart, int] = {}
        self.vertices = self.nodes = len(world.vertices)
        self._faces = 0

    @property
    def crossings(self) -> int:
        """The number of dummies."""
        return self.nodes - self.vertices

    def cycle(self, half: int) -> list[int]:
        """The half-edges of the face on the left of this one."""
        cycle = [half]
        while (half := self.after[self.other[half]]) != cycle[0]:
            cycle.append(half)
        return cycle

    def faces(self) -> list[list[int]]:
        """All faces, by their least half-edges."""
        visited: set[int] = set()
        faces: list[list[int]] = []
        for half in range(len(self.other)):
            if half not in visited:
                faces.append(self.cycle(half))
                visited.update(faces[-1])
        return faces

    def chain(self, number: int) -> list[int]:
        """The half-edges along an edge, from its lesser dart."""
        a, b = self.world.edges[number]
        chain = [self.half[a]]
        while self.other[chain[-1]] != self.half[b]:
            chain.append(self.after[self.after[self.other[chain[-1]]]])
        return chain

    def corner(self, dart: Dart) -> int | None:
        """The half-edge that follows the dart's place at its vertex."""
        turned = self.world.sigma[dart]
        while turned not in self.half:
            if turned == dart:
                return None
            turned = self.world.sigma[turned]
        return self.half[turned]

    def _new(self, node: int, edge: int, before: int | None = None) -> int:
        half = len(self.other)
        self.other.append(-1)
        self.node.append(node)
        self.edge.append(edge)
        self.face.append(-1)
        self.after.append(half)
        self.before.append(half)
        if before is not None:
            previous = self.before[before]
            self.after[previous] = self.before[before] = half
            self.after[half], self.before[half] = before, previous
        return half

    def _place(self, dart: Dart, edge: int) -> int:
        half = self._new(self.world.vertex_of[dart], edge, self.corner(dart))
        self.half[dart] = half
        return half

    def _join(self, a: int, b: int) -> None:
        self.other[a], self.other[b] = b, a

    def insert_tree(self, numbers: Sequence[int]) -> None:
        """Insert the edges of a spanning tree."""
        for number in numbers:
            a, b = self.world.edges[number]
            first, second = self._place(a, number), self._place(b, number)
            self._join(first, second)
        self._name_faces(range(len(self.other)))

    def insert(self, number: int, way: Sequence[int] = ()) -> None:
        """Insert an edge across these half-edges in turn."""
        a, b = self.world.edges[number]
        halves = [self._place(a, number)]
        for half in way:
            beyond, across, dummy = self.other[half], self.edge[half], self.nodes
            self.nodes += 1
            # clockwise: arrival, ahead, departure, back
            arrive = self._new(dummy, number)
            ahead = self._new(dummy, across, arrive)
            leave = self._new(dummy, number, arrive)
            back = self._new(dummy, across, arrive)
            self._join(half, back)
            self._join(ahead, beyond)
            self._join(halves[-1], arrive)
            halves += [arrive, leave]
        halves.append(self._place(b, number))
        self._join(halves[-2], halves[-1])
        self._name_faces(halves)

    def _name_faces(self, halves: Sequence[int]) -> None:
        for half in halves:
            if self.face[half] < 0:
                for other in self.cycle(half):
                    self.face[other] = self._faces
                self._faces += 1

    def way(self, number: int) -> list[int]:
        """The half-edges that a shortest way between the ends crosses."""
        goal, home = (self.face_at(dart) for dart in self.world.edges[number])
        halves: dict[int, list[int]] = {}
        for half, face in enumerate(self.face):
            halves.setdefault(face, []).append(half)
        entered: dict[int, int] = {home: -1}
        queue = deque([home])
        while queue and goal not in entered:
            for half in halves[queue.popleft()]:
                face = self.face[self.other[half]]
                if face not in entered:
                    entered[face] = self.other[half]
                    queue.append(face)
        way: list[int] = []
        while goal != home:
            way.append(entered[goal])
            goal = self.face[self.other[entered[goal]]]
        return way

    def face_at(self, dart: Dart) -> int:
        """The face at the place of the dart."""
        corner = self.corner(dart)
        return -1 if corner is None else self.face[corner]


def planarise(world: World, random: Random) -> PlaneMap | None:
    """The plane map of a random order; None if it has more than `MOST_CROSSINGS`."""
    plane = PlaneMap(world)
    number = {dart: k for k, edge in enumerate(world.edges) for dart in edge}
    tree = [number[dart] for dart in _spanning_tree(world, random)]
    plane.insert_tree(tree)
    inside = set(tree)
    rest = [k for k in range(len(world.edges)) if k not in inside]
    random.shuffle(rest)
    rest = _insert_uncrossed(plane, rest)
    while rest:
        pool = rest if len(rest) <= 12 else random.sample(rest, 12)
        ways = [(len(way := plane.way(k)), place, k, way) for place, k in enumerate(pool)]
        _, _, best, way = min(ways)
        rest.remove(best)
        plane.insert(best, way)
        if plane.crossings > MOST_CROSSINGS:
            return None
    return plane


def _spanning_tree(world: World, random: Random) -> list[Dart]:
    root = random.randrange(len(world.vertices))
    reached, queue, tree = {root}, deque([root]), list[Dart]()
    while queue:
        vertex = queue.popleft() if random.random() < 0.7 else queue.pop()
        darts = list(world.vertices[vertex])
        random.shuffle(darts)
        for dart in darts:
            end = world.vertex_of[world.alpha[dart]]
            if end not in reached:
                reached.add(end)
                queue.append(end)
                tree.append(dart)
    return tree


def _insert_uncrossed(plane: PlaneMap, rest: list[int]) -> list[int]:
    while True:
        crossing: list[int] = []
        for number in rest:
            a, b = map(plane.face_at, plane.world.edges[number])
            if a == b:
                plane.insert(number)
            else:
                crossing.append(number)
        if len(crossing) == len(rest):
            return crossing
        rest = crossing


def best_plane_map(world: World, seed: int = 0) -> PlaneMap | None:
    """The plane map with the fewest crossings of several, or None as `planarise`."""
    edges = len(world.edges)
    tries = max(3, min(4 + 2 * edges, 40, 3000 // max(1, edges))) if world.genus else 1
    best: PlaneMap | None = None
    for k in range(tries):
        plane = planarise(world, Random(1000 * seed + k))
        if plane is None and best is None:
            return None
        if plane and (best is None or plane.crossings < best.crossings):
            best = plane
    return best


COLLAR, RING, OUTER = 0.6, 0.25, 0.002
"""Weights of the triangles of collars, of the ring, and between ring and frame."""

AROUND = 3.0
"""The weight factor at vertices of the world."""


@dataclass(frozen=True)
class Mesh:
    """A triangulated disc, with the points and edges of the plane map on it.

    Attributes:
        size: the number of points, the plane map's nodes first.
        triangles: three points each, counter-clockwise with y upwards.
        weights: of the triangles' shapes.
        radii: the wished radius of each point.
        frame: the outermost triangle, counter-clockwise.
        between: the points inside each half-edge.
        lines: three consecutive points each, along edges.
    """

    size: int
    triangles: Ints
    weights: Floats
    radii: Floats
    frame: Ints
    between: dict[int, tuple[int, ...]]
    lines: Ints


class _Builder:
    def __init__(self, plane: PlaneMap, points: int) -> None:
        self.size, self.vertices = plane.nodes, plane.vertices
        self.triangles: list[tuple[int, int, int]] = []
        self.weights: list[float] = []
        self.between: dict[int, tuple[int, ...]] = {}
        for half, other in enumerate(plane.other):
            if half < other:
                loop = plane.node[half] == plane.node[other]
                middle = self.new(max(points, 2) if loop else points)
                self.between[half], self.between[other] = middle, middle[::-1]

    def new(self, number: int) -> tuple[int, ...]:
        self.size += number
        return tuple(range(self.size - number, self.size))

    def triangle(self, a: int, b: int, c: int, weight: float) -> None:
        self.triangles.append((a, b, c))
        self.weights.append(weight * (AROUND if min(a, b, c) < self.vertices else 1))

    def strip(self, walk: tuple[int, ...], weight: float) -> tuple[int, ...]:
        """Add triangles between a walk and a new cycle on its left."""
        inner = self.new(len(walk))
        for j, (a, d) in enumerate(zip(walk, inner, strict=True)):
            b, c = walk[(j + 1) % len(walk)], inner[(j + 1) % len(walk)]
            self.triangle(a, b, d, weight)
            self.triangle(b, c, d, weight)
        return inner

    def framed(self, cycle: tuple[int, ...]) -> tuple[int, ...]:
        """Add triangles between a counter-clockwise cycle and a new triangle around it."""
        corners = self.new(3)
        above = [corners[3 * j // len(cycle)] for j in range(len(cycle))]
        for j, point in enumerate(cycle):
            self.triangle(cycle[(j + 1) % len(cycle)], point, above[j], OUTER)
            if above[j] != above[j - 1]:
                self.triangle(point, above[j - 1], above[j], OUTER)
        return corners


def over(plane: PlaneMap, outer: int, *, points: int) -> Mesh:
    """The mesh over the plane map.

    Args:
        outer: a half-edge of the outer face.
        points: between the two ends of a half-edge pair.
    """
    builder = _Builder(plane, points)
    frame: tuple[int, ...] = ()
    for face in plane.faces():
        walk = tuple(p for half in face for p in (plane.node[half], *builder.between[half]))
        if outer in face:
            frame = builder.framed(builder.strip(walk, RING)[::-1])
            continue
        weight = 1.0
        if len(set(walk)) < len(walk):
            walk, weight = builder.strip(walk, COLLAR), COLLAR
        (centre,) = builder.new(1)
        for j, a in enumerate(walk):
            builder.triangle(a, walk[(j + 1) % len(walk)], centre, weight)
    triangles = np.array(builder.triangles)
    return Mesh(
        size=builder.size,
        triangles=triangles,
        radii=_radii(plane, builder),
        weights=np.array(builder.weights),
        frame=np.array(frame),
        between=builder.between,
        lines=_lines(plane, builder),
    )


def _radii(plane: PlaneMap, builder: _Builder) -> Floats:
    degree = Counter(p for triangle in builder.triangles for p in triangle)
    drawn = {p for middle in builder.between.values() for p in middle}
    radii = np.full(builder.size, 0.5)
    for point, number in degree.items():
        fit = 0.5 / sin(pi / max(number, 3)) - 0.5
        if point in drawn:
            radii[point] = 0.4
        elif point < plane.vertices:
            radii[point] = max(0.8, fit**0.6)
        elif point >= plane.nodes:
            radii[point] = max(0.3, fit) ** 0.8
    return radii


def _lines(plane: PlaneMap, builder: _Builder) -> Ints:
    rows: list[tuple[int, int, int]] = []
    for number in range(len(plane.world.edges)):
        chain = points_of(plane, builder.between, number)
        rows += zip(chain, chain[1:], chain[2:], strict=False)
    return np.array(rows, int).reshape(-1, 3)


def points_of(plane: PlaneMap, between: dict[int, tuple[int, ...]], number: int) -> list[int]:
    """The points of the mesh along an edge, from its lesser dart's vertex on."""
    chain = plane.chain(number)
    points = [plane.node[chain[0]]]
    for half in chain:
        points += [*between[half], plane.node[plane.other[half]]]
    return points
