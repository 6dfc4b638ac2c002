"""Folds as values: histories with equal folds have equal codes. Independent of `checkers.Fold`.

A **fold code** is the fold of a history (docs/semantics.md, section 11) in the numbering of the
canonical code (section 12): the degrees of its vertices, and the other end of each dart, or
`OPEN`. The marker points at dart 0, and only vertex 0 saw it.

**What proves the map.** In a world below the fold, the visited part is a quotient of the fold,
and beyond the open darts there may be anything that the class allows. So the quotients decide
whether one world is left.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache
from itertools import accumulate, combinations
from math import prod

FoldCode = tuple[tuple[int, ...], tuple[int, ...]]
"""Degrees of the vertices, and alpha on their darts."""

Sight = tuple[int, int]
"""A percept: the degree, and the marker's door or `ABSENT`."""

OPEN = -1
ABSENT = -1


def first_fold(degree: int) -> FoldCode:
    """The fold at the start: the marker's vertex, nothing crossed."""
    return (degree,), (OPEN,) * degree


@cache
def vertices(degrees: tuple[int, ...]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """The first dart of each vertex; the vertex of each dart."""
    first = tuple(accumulate(degrees, initial=0))[:-1]
    return first, tuple(v for v, degree in enumerate(degrees) for _ in range(degree))


def open_darts(code: FoldCode) -> list[int]:
    """The darts never crossed, ascending."""
    return [dart for dart, end in enumerate(code[1]) if end == OPEN]


def distances(code: FoldCode, start: int) -> list[int]:
    """The distance of each vertex from `start` along crossed edges."""
    degrees, alpha = code
    first, vertex = vertices(degrees)
    distance = {start: 0}
    queue = [start]
    for v in queue:
        for dart in range(first[v], first[v] + degrees[v]):
            if (end := alpha[dart]) != OPEN and vertex[end] not in distance:
                distance[vertex[end]] = distance[v] + 1
                queue.append(vertex[end])
    return [distance[v] for v in range(len(degrees))]


def crossed(code: FoldCode, dart: int, sight: Sight) -> tuple[FoldCode, int]:
    """The fold after an open dart was crossed and this was seen; and the dart of arrival.

    With the marker the place is v0; if its edge is known already, the two known ends are one
    dart, and so on.
    """
    degrees, alpha = code
    degree, marker = sight
    sigma, ends = _sigma(degrees), list(alpha)
    if marker == ABSENT:
        arrival = len(ends)
        sigma += [*range(arrival + 1, arrival + degree), arrival]
        ends += [OPEN] * degree
        ends[dart], ends[arrival] = arrival, dart
        return _numbered(sigma, ends, arrival)
    arrival = -marker % degrees[0]
    if ends[arrival] == OPEN:
        ends[dart], ends[arrival] = arrival, dart
        return _numbered(sigma, ends, arrival)
    return _numbered(*_identified(sigma, ends, dart, ends[arrival])[:2], arrival)


def quotients(code: FoldCode) -> Iterator[FoldCode]:
    """The fold, and every fold with some vertices identified, each once."""
    known, todo = {code}, [code]
    while todo:
        yield (code := todo.pop())
        degrees, alpha = code
        first, _ = vertices(degrees)
        for u, v in combinations(range(1, len(degrees)), 2):  # v0 is no other vertex
            for turn in range(degrees[u] if degrees[u] == degrees[v] else 0):
                merged = _quotient(degrees, alpha, first[u], first[v] + turn)
                if merged is not None and merged not in known:
                    known.add(merged)
                    todo.append(merged)


def _quotient(
    degrees: tuple[int, ...], alpha: tuple[int, ...], first_dart: int, twin: int
) -> FoldCode | None:
    """The fold in which two darts are one; None if that contradicts."""
    first, vertex = vertices(degrees)
    sigma, ends, names = _identified(_sigma(degrees), list(alpha), first_dart, twin)
    for v, start in enumerate(first):
        if len({names[dart] for dart in range(start, start + degrees[v])}) < degrees[v]:
            return None  # a vertex would be itself, turned
    for dart, name in enumerate(names):
        if ends[name] == name or (vertex[name] == 0) != (vertex[dart] == 0):
            return None  # a dart would be its own other end, or a vertex without the marker v0
    return _numbered(sigma, ends, 0)[0]


def _sigma(degrees: Sequence[int]) -> list[int]:
    sigma = list[int]()
    for degree in degrees:
        start = len(sigma)
        sigma += [*range(start + 1, start + degree), start]
    return sigma


def _identified(
    sigma: list[int], ends: list[int], dart: int, twin: int
) -> tuple[list[int], list[int], list[int]]:
    """Sigma, alpha and the name of each dart after identifying two darts and all that follows.

    A name is the least of the identified darts; only names have a sigma and an alpha.
    """
    parent = list(range(len(sigma)))

    def name(d: int) -> int:
        while parent[d] != d:
            d = parent[d]
        return d

    pairs = [(dart, twin)]
    while pairs:
        a, b = sorted(map(name, pairs.pop()))
        if a == b:
            continue
        parent[b] = a
        pairs.append((sigma[a], sigma[b]))
        if ends[a] == OPEN:
            ends[a] = ends[b]
        elif ends[b] != OPEN:
            pairs.append((ends[a], ends[b]))
    names = list(map(name, parent))
    return (
        [names[d] for d in sigma],
        [OPEN if end == OPEN else names[end] for end in ends],
        names,
    )


def _numbered(sigma: Sequence[int], ends: Sequence[int], at: int) -> tuple[FoldCode, int]:
    """The code of dart 0's component; and the number of the dart `at`."""
    number, order, degrees = dict[int, int](), list[int](), list[int]()

    def take(dart: int) -> None:
        degrees.append(0)
        while dart not in number:
            number[dart] = len(order)
            order.append(dart)
            degrees[-1] += 1
            dart = sigma[dart]

    take(0)
    for dart in order:
        if ends[dart] != OPEN and ends[dart] not in number:
            take(ends[dart])
    alpha = tuple(OPEN if ends[dart] == OPEN else number[ends[dart]] for dart in order)
    return (tuple(degrees), alpha), number[at]


# ---------------------------------------------------------------- what proves the map


def is_closed(code: FoldCode) -> bool:
    """Whether one world fits: no dart is open (docs/semantics.md, section 11)."""
    return OPEN not in code[1]


def is_single_of_vertices(code: FoldCode, n: int) -> bool:
    """Whether one world with n vertices fits.

    A quotient with n vertices lies in one for each way to pair its open darts. One with fewer
    and an open dart lies in any number, since an unseen vertex may have any number of loops.
    """
    if is_closed(code):
        return True
    if len(code[0]) < n:
        return False  # the fold itself, in which a dart is open
    fitting = 0
    for quotient in quotients(code):
        open_now = len(open_darts(quotient))
        if len(quotient[0]) < n and open_now:
            return False
        if len(quotient[0]) == n and open_now % 2 == 0:
            fitting += prod(range(1, open_now, 2))
    return fitting == 1


def is_single_planar(code: FoldCode) -> bool:
    """Whether one planar world fits.

    A planar quotient with an open dart lies in at least two: hang a leaf on each, or a path of two.
    """
    if is_closed(code):
        return True
    if is_planar(code):
        return False  # the fold itself, in which a dart is open
    planar = [quotient for quotient in quotients(code) if is_planar(quotient)]
    return len(planar) == 1 and is_closed(planar[0])


def is_planar(code: FoldCode) -> bool:
    """Whether the fold is planar, whatever leaves hang on it."""
    degrees, alpha = code
    first, vertex = vertices(degrees)
    todo, faces = set(range(len(alpha))), 0
    while todo:
        faces += 1
        dart = start = min(todo)
        while True:
            todo.discard(dart)
            end = dart if alpha[dart] == OPEN else alpha[dart]  # an open dart is a dead end
            v = vertex[end]
            dart = first[v] + (end - first[v] + 1) % degrees[v]
            if dart == start:
                break
    edges = sum(dart < end for dart, end in enumerate(alpha))
    return len(degrees) - edges + faces == 2
