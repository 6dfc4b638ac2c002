"""Random maps: trees and planar maps exactly uniform, maps of any given genus by adding edges.

**Trees.** A rooted plane tree with m edges is a word of m ups and m downs that never sinks below
its start. By the cycle lemma, m ups and m+1 downs, shuffled and read from behind their first lowest
point, are such a word and a last down, all equally likely.

**Planar maps.** Steps -1, 0 or 1 along the edges of a random tree label its vertices. In the order
of a walk around the tree, each corner is joined with the next corner whose label is less by one, or
with one new vertex if none follows. In this quadrangulation the vertices of even labels (or of odd
ones: a coin decides), joined across each face, are the map. Each planar map with m edges arises
from m+2 triples (tree, steps, coin), so the draw is **exactly uniform**.

**Maps of a genus.** An edge added to a random tree splits a face, or merges two and raises the
genus. Every rooted map can occur, but they are **not equally likely**. O(m²).

Source: G. Schaeffer, "Conjugaison d'arbres et cartes combinatoires aléatoires", thesis, Bordeaux
    1998; P. Chassaing and G. Schaeffer, "Random planar lattices and integrated superBrownian
    excursion", Probab. Theory Relat. Fields 128 (2004); A. Dvoretzky and Th. Motzkin, "A problem of
    arrangements", Duke Math. J. 14 (1947).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import accumulate
from random import Random

from topo_verify.errors import InputError
from topo_verify.world.families import _arguments as arguments
from topo_verify.world.rooted_map import Dart, World

MAX_EDGES = 10_000
"""Limit of `random_genus`."""


def random_tree(edges: int, *, seed: int = 0, marker: Dart | None = None) -> World:
    """A tree, uniform among all rooted plane trees with this many edges.

    Args:
        marker: a dart; default: the root.
    """
    edges = arguments.integer("random_tree", "edges", edges, 0)
    name, marker, random = arguments.settled(
        "random_tree", edges, darts=2 * edges, marker=marker, seed=seed
    )
    return _rooted(name, _turning([_walk(_tree(edges, random))]), 0, marker)


def random_planar(edges: int, *, seed: int = 0, marker: Dart | None = None) -> World:
    """A planar map, uniform among all rooted ones; loops and parallel edges are usual."""
    edges = arguments.integer("random_planar", "edges", edges, 0)
    name, marker, random = arguments.settled(
        "random_planar", edges, darts=2 * edges, marker=marker, seed=seed
    )
    word = _tree(edges, random)
    steps = [random.choice((-1, 0, 1)) for _ in range(edges)]
    coin = random.randrange(2)
    sigma, root = planar_map(word, steps, coin=coin) if word else ([], 0)
    return _rooted(name, sigma, root, marker)


def random_genus(edges: int, genus: int, *, seed: int = 0, marker: Dart | None = None) -> World:
    """A map of this genus; all can be drawn, not equally likely.

    Args:
        edges: at least twice the genus, at most `MAX_EDGES`.
    """
    family = "random_genus"
    genus = arguments.integer(family, "genus", genus, 0)
    edges = arguments.integer(family, "edges", edges, 2 * genus)
    if edges > MAX_EDGES:
        raise InputError(f"{family}: edges is {edges}, expected {MAX_EDGES} at most")
    name, marker, random = arguments.settled(
        family, edges, genus, darts=2 * edges, marker=marker, seed=seed
    )
    in_tree = sum(random.randrange(2) for _ in range(edges - 2 * genus))
    kinds = [1] * (edges - in_tree - genus) + [-1] * genus
    random.shuffle(kinds)
    faces = _Faces(_walk(_tree(in_tree, random)))
    # the sum so far is faces - 1 >= 0: a join finds two
    for kind in _from_lowest_point(kinds):
        (faces.split if kind > 0 else faces.join)(random)
    root = random.randrange(2 * edges) if edges else 0
    return _rooted(name, _turning(faces.faces), root, marker)


def _rooted(name: str, sigma: Sequence[Dart], root: Dart, marker: Dart | None) -> World:
    if marker is None and sigma:
        marker = root
    try:
        return World(tuple(d ^ 1 for d in range(len(sigma))), tuple(sigma), marker, name=name)
    except InputError as error:
        raise InputError(f"{name}: {error}") from error


def _turning(faces: Sequence[Sequence[Dart]]) -> list[Dart]:
    # a face is a cycle of sigma∘alpha, and alpha(d) = d ^ 1
    sigma = [0] * sum(map(len, faces))
    for face in faces:
        for place, dart in enumerate(face):
            sigma[face[place - 1] ^ 1] = dart
    return sigma


def _tree(edges: int, random: Random) -> list[int]:
    word = [1] * edges + [-1] * (edges + 1)
    random.shuffle(word)
    return _from_lowest_point(word)[:-1]


def _from_lowest_point(word: list[int]) -> list[int]:
    """The word rotated to start behind its first lowest point."""
    heights = [0, *accumulate(word)]
    lowest = heights.index(min(heights))
    return word[lowest:] + word[:lowest]


def _walk(word: Sequence[int]) -> list[Dart]:
    """The darts of a walk around the tree: 2e up edge e, 2e+1 back."""
    walk: list[Dart] = []
    above: list[int] = []
    edges = 0
    for step in word:
        if step > 0:
            above.append(edges)
            walk.append(2 * edges)
            edges += 1
        else:
            walk.append(2 * above.pop() + 1)
    return walk


def planar_map(word: Sequence[int], steps: Sequence[int], *, coin: int) -> tuple[list[Dart], Dart]:
    """`sigma` and the root of the map that a tree, its steps and a coin encode.

    Args:
        word: the tree, ups (1) and downs (-1), at least one.
        steps: the rise of the label along each edge, in the order of the ups.
        coin: 0 for labels of the root's parity.
    """
    # one end of each arc is a vertex of the map
    vertices, labels = _corners(word, steps)
    around = _quadrangulation(vertices, labels)
    # twice "cross, then turn": across the face of the dart
    kept = [2 * i + (label - labels[0] + coin) % 2 for i, label in enumerate(labels)]
    number: dict[Dart, Dart] = {}
    for dart in kept:
        if dart not in number:
            number[dart] = len(number)
            number[around[around[dart ^ 1] ^ 1]] = len(number)
    sigma = [0] * len(kept)
    for dart in kept:
        sigma[number[dart]] = number[around[dart]]
    return sigma, number[kept[0]]


def _corners(word: Sequence[int], steps: Sequence[int]) -> tuple[list[int], list[int]]:
    rises = iter(steps)
    vertices, labels = [0], [0]
    below: list[tuple[int, int]] = []
    count = 1
    for step in word[:-1]:
        if step > 0:
            below.append((vertices[-1], labels[-1]))
            labels.append(labels[-1] + next(rises))
            vertices.append(count)
            count += 1
        else:
            vertex, label = below.pop()
            vertices.append(vertex)
            labels.append(label)
    return vertices, labels


def _quadrangulation(vertices: Sequence[int], labels: Sequence[int]) -> list[Dart]:
    """The next dart clockwise of each; arc i has darts 2i and 2i+1, the latter at its end."""
    corners = len(labels)
    arriving: list[list[Dart]] = [[] for _ in range(corners)]
    at_new: list[Dart] = []
    nearest: dict[int, int] = {}
    for walked in reversed(range(2 * corners)):  # twice around: the first follows the last
        corner = walked % corners
        if walked < corners:
            after = nearest.get(labels[corner] - 1)
            (at_new if after is None else arriving[after]).append(2 * corner + 1)
        nearest[labels[corner]] = corner
    rotations: list[list[Dart]] = [[] for _ in range(max(vertices) + 1)]
    for corner, (vertex, darts) in enumerate(zip(vertices, arriving, strict=True)):
        rotations[vertex] += [*sorted(darts, key=_distance_to(corner, corners)), 2 * corner]
    around = [0] * (2 * corners)
    for rotation in (*rotations, at_new):
        for place, dart in enumerate(rotation):
            around[rotation[place - 1]] = dart
    return around


def _distance_to(corner: int, corners: int) -> Callable[[Dart], int]:
    return lambda dart: (corner - dart // 2) % corners


class _Faces:
    """The faces of a growing map: the darts of each in the order of a walk, and each dart's face.

    One vertex has one empty face.
    """

    def __init__(self, walk: list[Dart]) -> None:
        self.faces = [walk]
        self.face_of = [0] * len(walk)

    def split(self, random: Random) -> None:
        face, first = self._corner(random)
        darts = self.faces[face]
        second = random.randrange(len(darts) or 1)
        here, there = self._edge()
        low, high = sorted((first, second))
        parts = [[here, *darts[low:high]], [there, *darts[high:], *darts[:low]]]
        parts.sort(key=len)
        self.faces[face] = parts[1]
        self.faces.append(parts[0])
        self.face_of[parts[1][0]] = face
        for dart in parts[0]:
            self.face_of[dart] = len(self.faces) - 1

    def join(self, random: Random) -> None:
        here_face, first = self._corner(random)
        there_face = (here_face + 1 + random.randrange(len(self.faces) - 1)) % len(self.faces)
        second = random.randrange(len(self.faces[there_face]))
        here, there = self._edge()
        # across the new edge, around the other face, back, around this one
        joined = [
            here,
            *_turned(self.faces[there_face], second),
            there,
            *_turned(self.faces[here_face], first),
        ]
        small, large = sorted((here_face, there_face), key=lambda face: len(self.faces[face]))
        for dart in (here, *self.faces[small], there):
            self.face_of[dart] = large
        self.faces[large] = joined
        last = self.faces.pop()
        if small < len(self.faces):
            self.faces[small] = last
            for dart in last:
                self.face_of[dart] = small

    def _corner(self, random: Random) -> tuple[int, int]:
        """A random dart's face and its place there; it stands for the corner before it."""
        if not self.face_of:
            return 0, 0
        dart = random.randrange(len(self.face_of))
        return self.face_of[dart], self.faces[self.face_of[dart]].index(dart)

    def _edge(self) -> tuple[Dart, Dart]:
        darts = len(self.face_of)
        self.face_of += [0, 0]
        return darts, darts + 1


def _turned(face: list[Dart], place: int) -> list[Dart]:
    return face[place:] + face[:place]
