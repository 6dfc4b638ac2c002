"""The number of worlds without their marker: maps up to isomorphism that keeps the orientation.

They are the connected pairs (alpha, sigma) on 2m darts, up to renumbering. By Burnside's lemma, all
pairs are counted by a sum over permutations g of the darts, one of each cycle type, of the
fixed-point-free involutions that commute with g; the commuting sigma cancel with the order of g's
centraliser. On j cycles of length k there are

    c(k, j) = sum over i of  j! / (i! 2^i (j - 2i)!) * k^i * [k is even or j = 2i]

such involutions: i pairs of cycles, the others turned by half. The generating function is a product
over k; the inverse Euler transform keeps the connected pairs.

Planar maps: a rotation of the sphere has two fixed points, each a vertex, a face or the middle of
an edge (V. A. Liskovets, "Enumeration of nonisomorphic planar maps", 1981).
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from math import comb, factorial, gcd

from topo_verify.errors import InputError
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.enumeration.pruned import count, ranked_tables
from topo_verify.world.rooted_map import Code, Dart, World

SIZES = (20, 60, 200)
"""The first formula is evaluated for all sizes up to one of these."""

MOST_LISTED = 250_000
"""Classes other than `any` and `planar` are counted by listing at most this many: 20 seconds."""

PLANAR = WorldClass(genus=0)


def unrooted_count(edges: int, kind: WorldClass) -> int | None:
    """The number of unrooted maps in a class; None if it would take too long."""
    if edges == 0:
        return kind.count(0)
    if kind == WorldClass():
        most = next((size for size in SIZES if edges <= size), None)
        return None if most is None else _connected(most)[edges]
    if kind == PLANAR:
        return _planar(edges)
    try:
        if count(edges, kind) > MOST_LISTED:
            return None
    except InputError:
        return None
    return sum(1 for _ in ranks(edges, kind))


def ranks(edges: int, kind: WorldClass) -> Iterator[int]:
    """The first rank of each unrooted map in a class, ascending."""
    codes: set[Code] = set()  # of all maps that were met, with each marker
    for rank, code in ranked_tables(edges, kind):
        if code not in codes:
            yield rank
            codes.update(world.code for world in _markers(World.from_code(code)))


def automorphisms(world: World) -> int:
    """The number of automorphisms of the map without its marker. O(m) memory, O(m²) steps."""
    return sum(_leads_to(world, world, dart) for dart in range(len(world.alpha))) or 1


def same_unrooted(world: World, other: World) -> bool:
    """Whether two worlds differ in the marker alone, up to isomorphism; any size.

    O(m) memory; O(m²) steps at worst, when no dart is told from the root but from afar.
    """
    if len(world.alpha) != len(other.alpha):
        return False
    return not world.alpha or any(_leads_to(world, other, dart) for dart in range(len(other.alpha)))


def unrooted_id(world: World) -> str:
    """The least id with a marker at any dart: equal for two worlds iff their unrooted maps are.

    InputError above 200 edges; `same_unrooted` compares larger worlds.
    """
    rank_order.require_id_edges(len(world.edges))
    return min(_markers(world), key=lambda each: rank_order.rank(each.code)).id


def _leads_to(world: World, other: World, image: Dart) -> bool:
    """Whether an isomorphism of the unrooted maps, of one size, takes the root to this dart."""
    images = {world.root: image}
    queue = [world.root or 0]
    for dart in queue:  # growing
        for row, there in ((world.alpha, other.alpha), (world.sigma, other.sigma)):
            if row[dart] not in images:
                queue.append(row[dart])
            if images.setdefault(row[dart], there[images[dart]]) != there[images[dart]]:
                return False
    return True


def _markers(world: World) -> list[World]:
    return [world.with_marker(dart) for dart in range(len(world.alpha))] or [world]


def _planar(edges: int) -> int:
    """The sum over the turns of the sphere, divided by their number for each rooted map."""
    fixed = PLANAR.count(edges)
    for part in range(1, edges):
        if edges % part == 0:  # the turn's order is edges / part, without an edge in its middle
            turns = sum(gcd(k, edges // part) == 1 for k in range(1, edges // part + 1))
            fixed += turns * comb(part + 2, 2) * PLANAR.count(part)
    half = (edges - 1) // 2  # half a turn about the middle of one edge, or of two
    ways = edges * (edges + 3) if edges % 2 else edges * (edges - 1)
    return (fixed + ways * PLANAR.count(half) // 2) // (2 * edges)


@cache
def _connected(most: int) -> list[int]:
    pairs = _pairs(most)
    sums = [0] * (most + 1)  # Σ d·connected[d] over the divisors d of n
    connected = [0] * (most + 1)
    for n in range(1, most + 1):
        sums[n] = n * pairs[n] - sum(sums[k] * pairs[n - k] for k in range(1, n))
        divisors = (d for d in range(1, n) if n % d == 0)
        connected[n] = (sums[n] - sum(d * connected[d] for d in divisors)) // n
    return connected


def _pairs(edges: int) -> list[int]:
    size = 2 * edges
    total = [1] + [0] * size
    for k in range(1, size + 1):
        ways = [_involutions(k, j) for j in range(size // k + 1)]
        total = [
            sum(ways[j] * total[n - k * j] for j in range(n // k + 1)) for n in range(size + 1)
        ]
    return total[::2]


def _involutions(k: int, j: int) -> int:
    return sum(
        factorial(j) // (factorial(i) * 2**i * factorial(j - 2 * i)) * k**i
        for i in range(j // 2 + 1)
        if k % 2 == 0 or j == 2 * i
    )
