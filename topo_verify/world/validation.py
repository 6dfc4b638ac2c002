"""Refuses what is not a world, and names the dart.

Nothing is repaired: results about another world are worthless.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence, Sized
from collections.abc import Set as AbstractSet
from contextlib import suppress
from itertools import chain
from math import isfinite
from operator import eq, index
from typing import Annotated, Any, SupportsIndex, cast

import msgspec

from topo_verify.errors import InputError, plural

LEAST_NUMBER, MOST_NUMBER = -(2**63), 2**63 - 1

Number = Annotated[int, msgspec.Meta(ge=LEAST_NUMBER, le=MOST_NUMBER)]
"""A dart, door or cost in a map, trace, message or file: 64 bits with a sign."""

RANGE = "from -2^63 to 2^63 - 1"


def is_in_range(number: int) -> bool:
    """Whether this is a `Number`."""
    return LEAST_NUMBER <= number <= MOST_NUMBER


def require_permutations(alpha: Sequence[int], sigma: Sequence[int], root: int | None) -> None:
    """Refuse all but an involution without fixed point, a permutation and one of the darts."""
    darts = len(alpha)
    if len(sigma) != darts or darts % 2:
        raise InputError(
            f"alpha has {darts} entries and sigma {len(sigma)}: give both one a dart, two darts an"
            " edge"
        )
    if (root is None) != (darts == 0):
        raise InputError(
            f"marker {root} with {darts} darts: the marker points at a dart; it is null"
            " exactly if the world has none: name a dart, or null"
        )
    if root is not None and not 0 <= root < darts:
        raise InputError(
            f"the marker points at dart {root}, which is out of range:"
            f" name one of the darts 0 … {darts - 1}"
        )
    numbers = range(darts)
    if (  # all is well: the usual case, quickly
        set(sigma) == set(numbers)
        and dict(zip(alpha, numbers, strict=True)) == dict(enumerate(alpha))  # its own inverse
        and not any(map(eq, alpha, numbers))
    ):
        return
    # ranges first: images are indices below
    for name, row in (("alpha", alpha), ("sigma", sigma)):
        for dart, image in enumerate(row):
            if not 0 <= image < darts:
                raise InputError(
                    f"{name}[{dart}] = {image} is out of range: name one of the darts"
                    f" 0 … {darts - 1}"
                )
    for dart, other in enumerate(alpha):
        if other == dart:
            raise InputError(
                f"alpha has the fixed point {dart}: an edge is two different darts; pair it with"
                " the dart at its other end"
            )
        if alpha[other] != dart:
            raise InputError(
                f"alpha is not an involution: alpha[{dart}] = {other}, but"
                f" alpha[{other}] = {alpha[other]}; let the two darts of an edge name each other"
            )
    # else sigma has an image twice; reversed, the lower dart stays
    first = {image: dart for dart, image in reversed(list(enumerate(sigma)))}
    second = min(dart for dart, image in enumerate(sigma) if first[image] != dart)
    raise InputError(
        f"sigma is not a permutation: darts {first[sigma[second]]} and {second} both turn"
        f" to dart {sigma[second]}; let one of them turn to the dart that none turns to"
    )


def require_connected(reached: Sequence[int], given: Sequence[int]) -> None:
    """Refuse darts that the marker, which is reached first, does not lead to."""
    if len(reached) != len(given):
        lost = min(set(range(len(given))) - set(reached))
        raise InputError(
            f"the world is not connected: no way leads from the marker (dart {given[reached[0]]})"
            f" to dart {given[lost]}; give one world a file, or join the parts"
        )


def require_one_each(
    vertices: int, names: Sequence[str], positions: Sequence[Sequence[float]]
) -> None:
    """Refuse names or positions of a wrong number, and positions that are not finite."""
    for name, row in (("vertex_names", names), ("positions", positions)):
        if row and len(row) != vertices:
            raise InputError(
                f"{name} has {len(row)} entries for {vertices} vertices:"
                " give one a vertex, in the order of the vertices, or leave it out"
            )
    for vertex, position in enumerate(positions):
        if len(position) != 2 or not all(map(isfinite, position)):
            raise InputError(
                f"positions[{vertex}] is {position!r}: give two finite numbers, x and y"
            )


def numbering(rotations: Sequence[Sequence[int]], pairs: Sequence[Sequence[int]]) -> dict[int, int]:
    """The number of each dart, ascending; refuses darts without exactly one vertex and one edge."""
    darts, ends = [*chain.from_iterable(rotations)], [*chain.from_iterable(pairs)]
    if (  # all is well: the usual case, quickly
        len(darts) == len(ends) == len(set(darts))
        and set(darts) == set(ends)
        and {2}.issuperset(map(len, pairs))
        and (len(rotations) == 1 or (len(rotations) > 1 and all(rotations)))
    ):
        return {dart: place for place, dart in enumerate(sorted(darts))}
    vertex: dict[int, int] = {}
    for place, rotation in enumerate(rotations):
        if not rotation and len(rotations) > 1:
            raise InputError(
                f"vertices[{place}] has no dart: the world is not connected; leave it out, or"
                " give it an edge"
            )
        for dart in rotation:
            if dart in vertex:
                raise InputError(
                    f"dart {dart} stands at two places of 'vertices': in vertices[{vertex[dart]}]"
                    f" and vertices[{place}]; each dart belongs to one vertex, once:"
                    " take one of the two out"
                )
            vertex[dart] = place
    if not rotations:
        raise InputError("'vertices' is empty: give one list a vertex; the smallest world is [[]]")
    edge: dict[int, int] = {}
    for place, pair in enumerate(pairs):
        if len(pair) != 2:
            raise InputError(
                f"edges[{place}] has {plural(len(pair), 'dart')}: an edge is two darts; give both"
            )
        for dart in pair:
            if dart not in vertex:
                raise InputError(
                    f"edges[{place}] names dart {dart}, which no vertex has: put it into 'vertices'"
                    " where the edge ends"
                )
            if dart in edge:
                raise InputError(
                    f"dart {dart} stands in edges[{edge[dart]}] and edges[{place}]:"
                    " each dart belongs to one edge, and an edge is two different darts; correct"
                    " one of the two places"
                )
            edge[dart] = place
    dart, *_ = (dart for dart in vertex if dart not in edge)  # that is left to be wrong
    raise InputError(
        f"dart {dart} of vertices[{vertex[dart]}] belongs to no edge: put it into 'edges' with the"
        " dart at its other end, or take it out"
    )


def require_marker(marker: int | None, darts: Container[int]) -> None:
    """Refuse a marker that is not a dart."""
    if marker is not None and marker not in darts:
        raise InputError(
            f"the marker points at dart {marker}, which no vertex has: name a dart of 'vertices'"
        )


def map_parts(map_like: object) -> tuple[list[list[int]], list[list[int]], int | None]:
    """The vertices, edges and marker of an object, read from attributes or keys."""
    vertices, edges, marker = (_part(map_like, name) for name in ("vertices", "edges", "marker"))
    dart = None if marker is None else _integer(marker)
    if marker is not None and dart is None:
        got = "another one" if type(marker) is int else f"a {type(marker).__name__}"
        raise InputError(
            f"expected a dart (an integer {RANGE}) or None as the map's 'marker', got"
            f" {got}: give the number of the dart"
        )
    return _rows("vertices", vertices), _rows("edges", edges), dart


def optional_part(map_like: object, name: str, default: Any = None) -> Any:
    """A map's attribute or key of this name, or the default."""
    if isinstance(map_like, Mapping):
        return cast("Mapping[str, Any]", map_like).get(name, default)
    return getattr(map_like, name, default)


_MISSING = object()


def _part(map_like: object, name: str) -> Any:
    part = optional_part(map_like, name, _MISSING)
    if part is _MISSING:
        kind = "None (is a `return` missing?)" if map_like is None else type(map_like).__name__
        raise InputError(
            f"{kind} has no {name!r}; expected a map with vertices, edges and"
            " marker, as attributes or as keys: give it all three"
        )
    return part


def _rows(name: str, value: object) -> list[list[int]]:
    given = _items(value)
    if given is None:
        got = type(value).__name__
        raise InputError(
            f"expected a list of lists of darts as the map's {name!r}, got a {got}: give one list"
            f" of darts {'a vertex' if name == 'vertices' else 'an edge'}"
        )
    if {tuple, list}.issuperset(map(type, given)):
        all_darts = [0, *chain.from_iterable(given)]
        is_plain = {int}.issuperset(map(type, all_darts))
        if is_plain and is_in_range(min(all_darts)) and is_in_range(max(all_darts)):
            return [*map(list, given)]  # the usual case, quickly
    rows: list[list[int]] = []
    for place, row in enumerate(given):
        is_set = isinstance(row, AbstractSet)  # has no order
        items = None if name == "vertices" and is_set else _items(row)
        darts = [dart for item in items or () if (dart := _integer(item)) is not None]
        if items is None or len(darts) < len(items):
            got = f"a {type(row).__name__}" if items is None else "one with something else in it"
            raise InputError(
                f"expected a list of darts (integers {RANGE}) as the map's"
                f" {name}[{place}], got {got}: give their numbers"
            )
        rows.append(darts)
    return rows


def _items(value: object) -> list[Any] | None:
    if isinstance(value, (tuple, list)):
        return list(cast("Iterable[Any]", value))
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, Sized):
        return None
    with suppress(TypeError):  # a 0-dimensional array
        return list(cast("Iterable[Any]", value))
    return None


def _integer(value: object) -> int | None:
    """None unless the value is an integer in the range of numbers."""
    if type(value) is int:  # no bool
        return value if is_in_range(value) else None
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        return None
    with suppress(TypeError):  # an array of one float
        number = index(cast("SupportsIndex", value))
        return number if is_in_range(number) else None
    return None
