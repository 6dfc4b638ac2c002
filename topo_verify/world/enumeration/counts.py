"""Counts worlds by a property of their graph, and by genus, without listing them.

With x = 1 each function counts worlds. With another x it is the sum of x^(number of vertices): if x
is above all counts, its digits to the base x are the numbers of worlds with each number of
vertices.

**Loopless, simple, or a bound on the degrees.** Let the darts of vertex i be 0 … d_i-1, and
wirings(d1, …, dn) the ways to join all darts in pairs such that the property holds. A world is
rooted, so it has no symmetry: it comes from a multiset of degrees, up to the numbering of equal
vertices and of each vertex's darts. With one term for each partition of 2m into degrees,

    T(z) = Σ z^m · x^n · wirings(d1, …, dn) / Π d_i / Π (how often each degree occurs)!

counts all maps, connected or not, each 1 / (its symmetries) times. log T counts the connected ones,
and rooting them at one of 2m darts removes the symmetries: N(m) = 2m · [z^m] log T(z).

**By genus.** Q[g][m] counts rooted maps with genus g and m edges. For m >= 1,

    (m+1)/6 · Q[g][m] = (1+x)(2m-1)/3 · Q[g][m-1] + (2m-3)(2m-2)(2m-1)/12 · Q[g-1][m-2]
                        + 1/2 · Σ (2k-1)(2l-1) · Q[i][k-1] · Q[j][l-1],

the sum over k + l = m with k, l >= 1 and i + j = g; Q[0][0] = x, and Q is 0 outside (S. R. Carrell
and G. Chapuy, "Simple recurrence formulas to count maps on orientable surfaces", J. Combin. Theory
Ser. A 133 (2015): theorem 1, and its variant with a weight x).

**Planar, loopless or simple.** L(z) = Σ z^m · 2(4m+1)! / ((m+1)! (3m+2)!) counts the loopless ones
(T. R. S. Walsh and A. B. Lehman, "Counting rooted maps by genus. III: Nonseparable maps", J.
Combin. Theory Ser. B 18 (1975)). Take a simple one, and replace each edge by a bundle: an edge, or
what lies within two parallel edges, which is a loopless one with its root edge opened. Each
loopless one arises once, so L(z) = S(z·L(z)), and by Lagrange's inversion
S(m) = [z^m] L(z)^(1-m) / (1-m) for m >= 2.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from fractions import Fraction
from functools import cache
from math import comb, factorial, prod

from topo_verify.errors import InputError

Degrees = tuple[int, ...]
"""A multiset of degrees, descending."""

MAX_EDGES = 16
"""Limit of `count_graphs`: counting takes a second or two."""

MAX_NARROW_EDGES = 100
"""The limit if no degree is above 2."""


def count_graphs(
    edges: int,
    x: int = 1,
    *,
    least_degree: int = 0,
    most_degree: int | None = None,
    loopless: bool = False,
    simple: bool = False,
) -> int:
    """The number of rooted maps of any genus with this many edges and these properties.

    Raises:
        InputError: more edges than can be counted.
    """
    if edges < 0:
        raise InputError(f"expected 0 or more edges, got {edges}")
    highest = 2 * edges if most_degree is None else min(most_degree, 2 * edges)
    most = MAX_EDGES if highest > 2 else MAX_NARROW_EDGES
    if edges > most:
        raise InputError(
            f"expected at most {most} edges, got {edges}: with more, worlds with a property of"
            " their graph are too many to count; ask for fewer edges"
        )
    bounds = max(least_degree, 1), highest
    total = [_all_maps(m, x, bounds, loopless=loopless, simple=simple) for m in range(edges + 1)]
    # [z^m] log T(z)
    connected = [Fraction(0)]
    for m in range(1, edges + 1):  # T' = T·(log T)'
        known = sum((k * connected[k] * total[m - k] for k in range(1, m)), Fraction(0))
        connected.append(total[m] - known / m)
    rooted = 2 * edges * connected[edges] if edges else Fraction(x * (least_degree == 0))
    assert rooted.denominator == 1, "the number of worlds is an integer"
    return rooted.numerator


def _all_maps(
    edges: int, x: int, bounds: tuple[int, int], *, loopless: bool, simple: bool
) -> Fraction:
    number = Fraction(0)
    for degrees in _partitions(2 * edges, *bounds):
        ways = _simple_wirings(degrees) if simple else _wirings(degrees, loopless=loopless)
        alike = prod(map(factorial, Counter(degrees).values()))
        number += Fraction(x ** len(degrees) * ways, prod(degrees) * alike)
    return number


def _partitions(total: int, lowest: int, highest: int) -> Iterator[Degrees]:
    if total == 0:
        yield ()
    for first in range(min(total, highest), lowest - 1, -1):
        for rest in _partitions(total - first, lowest, first):
            yield (first, *rest)


@cache
def _wirings(degrees: Degrees, *, loopless: bool) -> int:
    if not degrees:
        return 1
    # the partner of one dart of the first vertex
    first, rest = degrees[0], degrees[1:]
    ways = 0
    if first > 1 and not loopless:
        ways += (first - 1) * _wirings(_sorted(first - 2, *rest), loopless=False)
    for degree, times in Counter(rest).items():
        others = list(rest)
        others.remove(degree)
        lower = _wirings(_sorted(first - 1, degree - 1, *others), loopless=loopless)
        ways += times * degree * lower
    return ways


@cache
def _simple_wirings(degrees: Degrees) -> int:
    if not degrees:
        return 1
    meetings = _meetings(degrees[0], tuple(Counter(degrees[1:]).items()))
    return factorial(degrees[0]) * sum(
        ways * _simple_wirings(_sorted(*remaining)) for ways, remaining in meetings
    )


def _meetings(darts: int, groups: tuple[tuple[int, int], ...]) -> Iterator[tuple[int, Degrees]]:
    """Each choice of different vertices for the darts: its number of ways, and the degrees left.

    Args:
        groups: (degree, how many of the other vertices have it).
    """
    if not groups:
        if darts == 0:
            yield 1, ()
        return
    (degree, times), *others = groups
    for chosen in range(min(darts, times) + 1):
        here = comb(times, chosen) * degree**chosen
        remaining = (degree - 1,) * chosen + (degree,) * (times - chosen)
        for ways, further in _meetings(darts - chosen, tuple(others)):
            yield here * ways, remaining + further


def _sorted(*degrees: int) -> Degrees:
    # one form for each multiset: a key of the caches
    return tuple(sorted(filter(None, degrees), reverse=True))


def count_genus(edges: int, genus: int, x: int = 1) -> int:
    """Q[genus][edges], in O(edges² · genus²) products.

    Raises:
        InputError: a negative number.
    """
    if edges < 0 or genus < 0:
        raise InputError(f"expected 0 or more edges and genus, got edges={edges}, genus={genus}")
    if 2 * genus > edges:
        return 0
    known: list[list[int]] = []
    for g in range(genus + 1):
        known.append([0 if g else x])
        for m in range(1, edges + 1):
            known[g].append(_next(known, g, m, x))
    return known[genus][edges]


def _next(known: list[list[int]], g: int, m: int, x: int) -> int:
    # the recurrence times 6
    total = 2 * (1 + x) * (2 * m - 1) * known[g][m - 1]
    if g and m >= 2:
        total += (2 * m - 3) * (m - 1) * (2 * m - 1) * known[g - 1][m - 2]
    for k in range(1, m):
        products = sum(known[i][k - 1] * known[g - i][m - k - 1] for i in range(g + 1))
        total += 3 * (2 * k - 1) * (2 * (m - k) - 1) * products
    return total // (m + 1)


def count_planar_loopless(edges: int) -> int:
    """The number of planar loopless worlds with this many edges."""
    return 2 * factorial(4 * edges + 1) // (factorial(edges + 1) * factorial(3 * edges + 2))


def count_planar_simple(edges: int) -> int:
    """The number of planar simple worlds with this many edges, in O(edges²) products."""
    if edges < 2:
        return 1
    loopless = [count_planar_loopless(m) for m in range(edges + 1)]
    exponent = 1 - edges
    power = [1]  # P = L^e: P'·L = e·L'·P
    for m in range(1, edges + 1):
        terms = ((exponent * k - (m - k)) * loopless[k] * power[m - k] for k in range(1, m + 1))
        power.append(sum(terms) // m)
    return power[edges] // exponent
