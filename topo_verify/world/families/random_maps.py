"""Random maps: trees, planar maps and, in sizes that allow it, maps of a genus exactly uniform.

**Trees.** A rooted plane tree with m edges is a word of m ups and m downs that never sinks below
its start. By the cycle lemma, m ups and m+1 downs, shuffled and read from behind their first lowest
point, are such a word and a last down, all equally likely.

**Maps with one face.** Let a map with one face have genus g-p, and choose 2p+1 of its vertices.
Glued together in the way of `glued`, they are one vertex of a map with one face and genus g. Each
map of genus g arises in 2g ways, over all p from 1 to g, so a draw from all ways is uniform.

**Maps of a genus.** Steps -1, 0 or 1 along the edges of a random map with one face label its
vertices, if they close; in a tree they do. In the order of a walk around the face, each corner is
joined with the next corner whose label is less by one, or with one new vertex if none follows. In
this quadrangulation the vertices of even labels (or of odd ones: a coin decides), joined across
each face, are the map. Each map of genus g with m edges arises from m+2-2g triples (map with one
face, steps that close, coin), so the draw is **exactly uniform**. Steps close with a chance of
about m^(-g/2).

**Maps of a genus, of any size.** `random_genus` adds edges to a random tree; each splits a face, or
merges two and raises the genus. Every rooted map can occur, but they are **not equally likely**.
O(m²).

Source: G. Schaeffer, "Conjugaison d'arbres et cartes combinatoires aléatoires", thesis, Bordeaux
    1998; P. Chassaing and G. Schaeffer, "Random planar lattices and integrated superBrownian
    excursion", Probab. Theory Relat. Fields 128 (2004); G. Chapuy, M. Marcus and G. Schaeffer, "A
    bijection for rooted maps on orientable surfaces", SIAM J. Discrete Math. 23 (2009); G. Chapuy,
    "A new combinatorial identity for unicellular maps, via a direct bijective approach", Adv. in
    Appl. Math. 47 (2011); A. Dvoretzky and Th. Motzkin, "A problem of arrangements", Duke Math. J.
    14 (1947).
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cache
from itertools import accumulate
from math import comb
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
    planar = drawn(edges, 0, random, name=name, marker=marker)
    assert planar is not None  # in a tree the steps close
    return planar


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


@cache
def one_face_maps(edges: int, genus: int) -> int:
    """The number of rooted maps with one face."""
    if genus == 0:
        return comb(2 * edges, edges) // (edges + 1)
    return sum(_ways(edges, genus)) // (2 * genus)


@cache
def _ways(edges: int, genus: int) -> list[int]:
    """The ways to glue 2p+1 vertices, p = 1 … genus, of maps with one face and genus - p."""
    return [
        one_face_maps(edges, genus - p) * comb(edges + 1 - 2 * (genus - p), 2 * p + 1)
        for p in range(1, genus + 1)
    ]


def _one_face(edges: int, genus: int, random: Random) -> list[Dart]:
    """The walk around a map with one face, uniform among all rooted ones."""
    if genus == 0:
        return _walk(_tree(edges, random))
    totals = [*accumulate(_ways(edges, genus))]
    p = 1 + bisect_right(totals, random.randrange(totals[-1]))
    walk = _one_face(edges, genus - p, random)
    after, visited, first = _next_corners(walk), [False] * len(walk), list[int]()
    for corner in range(len(walk)):
        if not visited[corner]:
            first.append(corner)
        while not visited[corner]:
            visited[corner] = True
            corner = after[corner]  # noqa: PLW2901
    return glued(walk, sorted(random.sample(first, 2 * p + 1)))


def glued(walk: list[Dart], corners: list[int]) -> list[Dart]:
    """The walk around the face after the vertices with these corners are made one.

    Args:
        corners: of an odd number of vertices, the first corner of each on the walk, ascending.
    """
    *others, c = corners
    while others:
        *others, a, b = others
        walk = walk[:a] + walk[b:c] + walk[a:b] + walk[c:]
        c = a + c - b
    return walk


def _next_corners(walk: Sequence[Dart]) -> list[int]:
    """The next corner clockwise at its vertex; corner i lies before the i-th dart of the walk."""
    following = [0] * len(walk)
    for i, dart in enumerate(walk):
        following[dart] = (i + 1) % len(walk)
    return [following[dart ^ 1] for dart in walk]


def drawn(
    edges: int, genus: int, random: Random, *, name: str = "", marker: Dart | None = None
) -> World | None:
    """A map of the genus, uniform among all rooted ones; None if the steps do not close."""
    walk = _one_face(edges, genus, random)
    steps = [random.choice((-1, 0, 1)) for _ in range(edges)]
    made = labelled_map(walk, steps, coin=random.randrange(2)) if walk else (list[Dart](), 0)
    return made and _rooted(name, *made, marker)


def draws(edges: int, genus: int) -> Fraction:
    """The draws that `drawn` needs for one map are, on average, this over the number of maps."""
    return Fraction(2 * 3**edges * one_face_maps(edges, genus), edges + 2 - 2 * genus)


def labelled_map(
    walk: Sequence[Dart], steps: Sequence[int], *, coin: int
) -> tuple[list[Dart], Dart] | None:
    """`sigma` and the root of the map that a map with one face, steps and a coin encode.

    Args:
        walk: around the face, with at least one edge; edge e has darts 2e and 2e+1.
        steps: the rise of the label along each edge, from 2e to 2e+1.
        coin: 0 for labels of the root's parity.
    Returns:
        None if the steps give a vertex two labels.
    """
    rises = (-steps[dart // 2] if dart % 2 else steps[dart // 2] for dart in walk[:-1])
    labels, after = [*accumulate(rises, initial=0)], _next_corners(walk)
    if [labels[corner] for corner in after] != labels:
        return None
    # one end of each arc is a vertex of the map
    around = _quadrangulation(after, labels)
    # twice "cross, then turn": across the face of the dart
    kept = [2 * i + (label + coin) % 2 for i, label in enumerate(labels)]
    number: dict[Dart, Dart] = {}
    for dart in kept:
        if dart not in number:
            number[dart] = len(number)
            number[around[around[dart ^ 1] ^ 1]] = len(number)
    sigma = [0] * len(kept)
    for dart in kept:
        sigma[number[dart]] = number[around[dart]]
    return sigma, number[kept[0]]


def _quadrangulation(after: Sequence[int], labels: Sequence[int]) -> list[Dart]:
    """The next dart clockwise of each; arc i has darts 2i and 2i+1, the latter at its end."""
    corners = len(labels)
    arriving: list[list[Dart]] = [[] for _ in range(corners)]
    at_new: list[Dart] = []
    nearest: dict[int, int] = {}
    for walked in reversed(range(2 * corners)):  # twice around: the first follows the last
        corner = walked % corners
        if walked < corners:
            joined = nearest.get(labels[corner] - 1)
            (at_new if joined is None else arriving[joined]).append(2 * corner + 1)
        nearest[labels[corner]] = corner
    for corner, darts in enumerate(arriving):
        darts.sort(key=_distance_to(corner, corners))
        darts.append(2 * corner)
    around = [0] * (2 * corners)
    for place, dart in enumerate(at_new):
        around[at_new[place - 1]] = dart
    for corner, darts in enumerate(arriving):
        for dart, following in zip(darts, [*darts[1:], arriving[after[corner]][0]], strict=True):
            around[dart] = following
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
