"""A world: a connected graph embedded in an orientable surface, with one directional marker.

Every edge is two **darts**, one at each end. `alpha` exchanges the darts of an edge; `sigma` turns
a dart to the next exit of its vertex, **clockwise** seen from above, so mirror images are different
worlds. The cycles of `sigma` are the vertices, those of `sigma∘alpha` (cross, then turn) the faces.
The marker points at one dart, the `root`.

The only automorphism of such a **rooted map** is the identity, so numbering its darts breadth-first
from the root gives a canonical code: two worlds are isomorphic iff their codes are equal.

Source: docs/semantics.md, section 1; S. K. Lando and A. K. Zvonkin, "Graphs on Surfaces and Their
    Applications" (2004), chapter 1.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import InitVar, dataclass, field, replace
from functools import cached_property
from os import PathLike
from typing import Any, Literal, Self

from topo_verify.errors import map_size
from topo_verify.world import validation
from topo_verify.world.enumeration import rank_order

Dart = int
"""One of the numbers 0 … 2m-1."""

Code = tuple[tuple[int, ...], tuple[Dart, ...]]
"""Degrees and `alpha` in the breadth-first numbering from the root."""


@dataclass(frozen=True, eq=False, repr=False)  # cached_property needs `__dict__`
class World:
    """An immutable, validated, hashable world, made in O(m). Equal iff alpha, sigma and root are.

    Args:
        alpha: the other dart of each edge; an involution without fixed point on 0 … 2m-1.
        sigma: the next dart clockwise at the same vertex; a permutation.
        root: the dart that the marker points at; None iff m = 0 (one vertex).
        starts: the first dart of each vertex, in their order; default: the least darts, ascending.
        given: what errors call the darts; default: their numbers.
        name, vertex_names, positions, source, licence: not compared; positions have y upwards.
    Raises:
        InputError: the arguments do not make one connected map with a marker; names the dart.
    """

    alpha: tuple[Dart, ...]
    sigma: tuple[Dart, ...]
    root: Dart | None
    starts: tuple[Dart, ...] = field(default=(), kw_only=True)
    given: InitVar[Sequence[int]] = field(default=(), kw_only=True)
    name: str = field(default="", kw_only=True)
    vertex_names: tuple[str, ...] = field(default=(), kw_only=True)
    positions: tuple[tuple[float, float], ...] = field(default=(), kw_only=True)
    source: str = field(default="", kw_only=True)
    licence: str = field(default="", kw_only=True)

    def __post_init__(self, given: Sequence[int]) -> None:
        vars(self).update(alpha=tuple(self.alpha), sigma=tuple(self.sigma))
        validation.require_permutations(self.alpha, self.sigma, self.root)
        validation.require_connected(self.discovery[0], given or range(len(self.alpha)))
        if self.vertex_names or self.positions:
            validation.require_one_each(len(self.vertices), self.vertex_names, self.positions)

    @classmethod
    def from_rotations(
        cls,
        vertices: Iterable[Sequence[int]],
        edges: Iterable[Sequence[int]],
        marker: int | None,
        **about: Any,
    ) -> Self:
        """The world from rotations, pairs of darts and the marked dart, as a world file has them.

        Args:
            vertices: the darts of each vertex, clockwise; distinct integers, renumbered ascending.
            edges: two darts each.
            marker: a dart; None if there is no dart.
            about: name, vertex_names, positions, source, licence.
        Raises:
            InputError: names the dart or vertex and what is wrong with it.
        """
        rotations = [tuple(rotation) for rotation in vertices]
        pairs = [tuple(edge) for edge in edges]
        number = validation.numbering(rotations, pairs)
        validation.require_marker(marker, number)
        alpha, sigma = [0] * len(number), [0] * len(number)
        for pair in pairs:
            alpha[number[pair[0]]], alpha[number[pair[1]]] = number[pair[1]], number[pair[0]]
        for rotation in rotations:
            for dart, after in zip(rotation, rotation[1:] + rotation[:1], strict=True):
                sigma[number[dart]] = number[after]
        return cls(
            tuple(alpha),
            tuple(sigma),
            None if marker is None else number[marker],
            starts=tuple(number[rotation[0]] for rotation in rotations if rotation),
            given=tuple(number),  # ascending
            **about,
        )

    @classmethod
    def from_map(cls, map_like: object) -> Self:
        """The world of a map with `vertices`, `edges`, `marker` as attributes or keys.

        Raises:
            InputError: they are missing, malformed, or make no world.
        """
        return cls.from_rotations(*validation.map_parts(map_like))

    @classmethod
    def from_code(cls, code: Code, *, name: str = "", rank: int | None = None) -> Self:
        """The world with this code, or with any table whose vertices own consecutive darts.

        Args:
            rank: its place in the order of ids, not checked. A wrong one acquits no map: no claim
                reads the id, and a world made of a table that is some map's code is that map.
        """
        degrees, alpha = code
        sigma: list[Dart] = []
        for degree in degrees:
            first = len(sigma)
            sigma += [*range(first + 1, first + degree), *[first] * (degree > 0)]
        world = cls(alpha, tuple(sigma), 0 if alpha else None, name=name)
        if rank is not None:
            vars(world).update(code=code, id=f"m{len(alpha) // 2}/{rank}")
        return world

    @classmethod
    def from_id(cls, text: str) -> Self:
        """The world with this id; the inverse of `id`.

        Raises:
            InputError: the text is no id, or its rank does not exist.
        """
        return cls.from_code(rank_order.unrank(*rank_order.id_parts(str(text))), name=text)

    @cached_property
    def vertices(self) -> tuple[tuple[Dart, ...], ...]:
        """The darts of each vertex, clockwise."""
        if not self.alpha:
            return ((),)
        return cycles(self.sigma, self.starts)

    @cached_property
    def edges(self) -> tuple[tuple[Dart, Dart], ...]:
        """The darts of each edge, lesser first, ascending."""
        return tuple([(dart, other) for dart, other in enumerate(self.alpha) if dart < other])

    @property
    def marker(self) -> Dart | None:
        """`root`, as world files call it."""
        return self.root

    @cached_property
    def vertex_of(self) -> tuple[int, ...]:
        """The vertex of each dart."""
        row = [0] * len(self.alpha)
        for vertex, rotation in enumerate(self.vertices):
            for dart in rotation:
                row[dart] = vertex
        return tuple(row)

    @cached_property
    def place_of(self) -> tuple[int, ...]:
        """The place of each dart in its rotation."""
        row = [0] * len(self.alpha)
        for rotation in self.vertices:
            for place, dart in enumerate(rotation):
                row[dart] = place
        return tuple(row)

    @property
    def marker_vertex(self) -> int:
        """v0, where the marker lies and the robot starts."""
        return 0 if self.root is None else self.vertex_of[self.root]

    @cached_property
    def degrees(self) -> tuple[int, ...]:
        """The degree of each vertex."""
        return tuple(map(len, self.vertices))

    @cached_property
    def faces(self) -> tuple[tuple[Dart, ...], ...]:
        """The cycles of sigma∘alpha; without a dart, one empty face."""
        if not self.alpha:
            return ((),)
        return cycles(tuple(self.sigma[other] for other in self.alpha))

    @property
    def genus(self) -> int:
        """g in V - E + F = 2 - 2g."""
        return (2 - len(self.vertices) + len(self.edges) - len(self.faces)) // 2

    @property
    def is_planar(self) -> bool:
        """Whether the genus is 0."""
        return self.genus == 0

    @cached_property
    def is_loopless(self) -> bool:
        """Whether there are no loops."""
        return all(self.vertex_of[a] != self.vertex_of[b] for a, b in self.edges)

    @cached_property
    def is_simple(self) -> bool:
        """Whether there are neither loops nor parallel edges."""
        ends = {frozenset((self.vertex_of[a], self.vertex_of[b])) for a, b in self.edges}
        return self.is_loopless and len(ends) == len(self.edges)

    @property
    def cost_bound(self) -> int:
        """An upper bound for the edge traversals of a run: m·(n + (2m-1)·2(n-1))."""
        m, n = len(self.edges), len(self.vertices)
        return m * (n + (2 * m - 1) * 2 * (n - 1))

    @cached_property
    def discovery(self) -> tuple[tuple[Dart, ...], tuple[int, ...]]:
        """Darts in breadth-first order from the root, and the degrees of the vertices met."""
        if self.root is None:
            return (), (0,)
        order: list[Dart] = []
        degrees: list[int] = []
        known = [False] * len(self.alpha)
        entries = [self.root]
        for entry in entries:  # a growing queue
            if known[entry]:
                continue
            first, dart = len(order), entry
            while not known[dart]:
                known[dart] = True
                order.append(dart)
                dart = self.sigma[dart]
            degrees.append(len(order) - first)
            entries += [self.alpha[d] for d in order[first:]]
        return tuple(order), tuple(degrees)

    @cached_property
    def code(self) -> Code:
        """The canonical code. O(m)."""
        order, degrees = self.discovery
        number = {dart: place for place, dart in enumerate(order)}
        return degrees, tuple([number[self.alpha[dart]] for dart in order])

    @cached_property
    def id(self) -> str:
        """`m<edges>/<rank>`, up to isomorphism. Raises InputError above 200 edges."""
        rank_order.require_id_edges(len(self.edges))
        return f"m{len(self.edges)}/{rank_order.rank(self.code)}"

    @property
    def known_id(self) -> str | None:
        """The id; None above 200 edges."""
        return self.id if len(self.edges) <= rank_order.MAX_ID_EDGES else None

    def is_isomorphic(self, other: World) -> bool:
        """Whether a bijection of darts keeps alpha, sigma and root."""
        return self.code == other.code

    def mirror(self) -> Self:
        """The world with every rotation reversed, unnamed."""
        back = sorted(range(len(self.sigma)), key=self.sigma.__getitem__)  # sigma's inverse
        flipped = tuple((-x, y) for x, y in self.positions)  # in the y axis
        return replace(self, sigma=tuple(back), positions=flipped, name="")

    def dual(self) -> Self:
        """The dual map, unnamed: dart d leaves the face on its left, across its own edge.

        The dual of the dual is isomorphic to this map with the marker at the other end of its edge.
        """
        back = self.mirror().sigma  # along a face: counterclockwise
        return type(self)(self.alpha, tuple([self.alpha[dart] for dart in back]), self.root)

    def with_marker(self, root: Dart) -> Self:
        """The same map with the marker at another dart, unnamed. Raises InputError for no dart."""
        return replace(self, root=root, name="")

    def renumbered(self, numbers: Sequence[Dart]) -> Self:
        """The same world with dart d called numbers[d], a permutation."""
        rows = [[numbers[dart] for dart in row] for row in self.vertices]
        pairs = [(numbers[a], numbers[b]) for a, b in self.edges]
        root = None if self.root is None else numbers[self.root]
        other = World.from_rotations(rows, pairs, root)
        return replace(self, alpha=other.alpha, sigma=other.sigma, root=root, starts=other.starts)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, World):
            return NotImplemented
        return (self.alpha, self.sigma, self.root) == (other.alpha, other.sigma, other.root)

    def __hash__(self) -> int:
        return self._hash

    @cached_property
    def _hash(self) -> int:
        return hash((self.alpha, self.sigma, self.root))

    def __repr__(self) -> str:
        if len(self.edges) <= 30:
            return f"tv.World.from_id({self.id!r})"
        size = f"{map_size(len(self.vertices), len(self.edges))}, genus {self.genus}"
        return f"<World {self.name!r}: {size}>" if self.name else f"<World: {size}>"

    @classmethod
    def load(cls, path: str | PathLike[str], *, graph: int | None = None) -> Self:
        """The world in a file of any format.

        Args:
            graph: index of the graph in a file of planar_code; default: the only one.
        Raises:
            InputError: the file cannot be read, or holds no world.
        """
        from topo_verify.world import io

        return io.load(cls, path, graph=graph)

    @classmethod
    def from_json(cls, text: str | bytes) -> Self:
        """The world in this world JSON; raises as `load`."""
        from topo_verify.world import io

        return io.decode(cls, text)

    def to_json(self) -> str:
        """World JSON on one line."""
        from topo_verify.world import io

        return io.encode(self)

    def save(self, path: str | PathLike[str]) -> None:
        """Write the file, whole or not at all; its name says the format, as for `load`."""
        from topo_verify.world import io

        io.save(self, path)

    @property
    def text(self) -> str:
        """The id; the JSON of a world too large for an id."""
        return self.known_id or self.to_json()

    def least_cost(self) -> int:
        """The fewest edge traversals of a walk that proves this map."""
        from topo_verify.world import least_cost

        return least_cost.least_cost(self.code)

    def proof_tour(self) -> tuple[int, ...]:
        """The doors of a cheapest walk from the marker that proves this map."""
        from topo_verify.world import least_cost

        return least_cost.proof_tour(self.code)

    def draw(self, path: str | PathLike[str] | None = None, **marks: bool) -> str:
        """The picture as SVG, with the true order of the darts at every vertex.

        Args:
            path: also write it to this .svg, .png, .pdf or .html file.
            marks: `doors=True` numbers the doors of each vertex, `darts=True` the darts.
        Raises:
            InputError: the file cannot be written, or the renderer is missing.
        """
        from topo_verify.pictures.drawing import draw

        return draw(self, path, **marks)

    def twin(self, model: Literal["undirected", "none"] = "undirected") -> World | None:
        """Another world that looks the same to a robot that sees less of the marker, or None.

        It sees whether the marker is here, not its direction (`undirected`), or nothing of it.
        """
        from topo_verify.world import twins

        return twins.find_twin(self, model)[0]

    def _repr_html_(self) -> str:
        from topo_verify.pictures.drawing import notebook

        return notebook(self)

    def _repr_pretty_(self, printer: Any, _: bool) -> None:  # noqa: FBT001  asked by Hypothesis
        printer.text(f"tv.World.from_id({self.id!r})" if self.known_id else repr(self))


def cycles(permutation: Sequence[int], starts: Sequence[int] = ()) -> tuple[tuple[int, ...], ...]:
    """The cycles: those of the starts in their order, then the others by their least dart."""
    visited = [False] * len(permutation)
    cycles: list[tuple[int, ...]] = []
    for start in (*starts, *range(len(permutation))):
        cycle: list[int] = []
        dart = start
        while not visited[dart]:
            visited[dart] = True
            cycle.append(dart)
            dart = permutation[dart]
        if cycle:
            cycles.append(tuple(cycle))
    return tuple(cycles)
