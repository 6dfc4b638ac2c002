"""What makes a world no world: every way, with a sentence that names the dart.

The functions raise `InputError` or return; nothing is repaired and nothing is guessed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence, Sized
from collections.abc import Set as AbstractSet
from contextlib import suppress
from math import isfinite
from operator import index
from typing import Any, SupportsIndex, cast

from topo_verify.errors import InputError


def require_permutations(alpha: Sequence[int], sigma: Sequence[int], root: int | None) -> None:
    """Are these an involution without fixed point, a permutation and one of their darts?"""
    darts = len(alpha)
    if len(sigma) != darts or darts % 2:
        raise InputError(
            f"alpha has {darts} entries and sigma {len(sigma)}: both have one a dart, two"
            " darts an edge"
        )
    if (root is None) != (darts == 0):
        raise InputError(
            f"marker {root} with {darts} darts: the marker points at a dart; it is null"
            " exactly if the world has none"
        )
    if root is not None and not 0 <= root < darts:
        raise InputError(
            f"the marker points at dart {root}, which is out of range:"
            f" the darts are 0 … {darts - 1}"
        )
    for name, row in (("alpha", alpha), ("sigma", sigma)):
        for dart, image in enumerate(row):
            if not 0 <= image < darts:
                raise InputError(
                    f"{name}[{dart}] = {image} is out of range: the darts are 0 … {darts - 1}"
                )
    for dart, other in enumerate(alpha):
        if other == dart:
            raise InputError(f"alpha has the fixed point {dart}: an edge is two different darts")
        if alpha[other] != dart:
            raise InputError(
                f"alpha is not an involution: alpha[{dart}] = {other}, but"
                f" alpha[{other}] = {alpha[other]}"
            )
    if len(set(sigma)) != darts:
        first = {image: dart for dart, image in reversed(list(enumerate(sigma)))}
        second = min(dart for dart, image in enumerate(sigma) if first[image] != dart)
        raise InputError(
            f"sigma is not a permutation: darts {first[sigma[second]]} and {second} both turn"
            f" to dart {sigma[second]}"
        )


def require_one_each(
    vertices: int, names: Sequence[str], positions: Sequence[Sequence[float]]
) -> None:
    """Refuse names or positions unless there is one a vertex, or none; positions are finite."""
    for what, row in (("vertex_names", names), ("positions", positions)):
        if row and len(row) != vertices:
            raise InputError(
                f"{what} has {len(row)} entries for {vertices} vertices:"
                " give one a vertex, in the order of the vertices, or leave it out"
            )
    for vertex, position in enumerate(positions):
        if len(position) != 2 or not all(map(isfinite, position)):
            raise InputError(
                f"positions[{vertex}] is {position!r}: a position is two finite numbers, x and y"
            )


def numbering(rotations: Sequence[Sequence[int]], pairs: Sequence[Sequence[int]]) -> dict[int, int]:
    """The number of each dart, in ascending order, if each has one vertex and one edge."""
    vertex: dict[int, int] = {}
    for place, rotation in enumerate(rotations):
        if not rotation and len(rotations) > 1:
            raise InputError(f"vertices[{place}] has no dart: the world is not connected")
        for dart in rotation:
            if dart in vertex:
                raise InputError(
                    f"dart {dart} stands at two places of 'vertices': in vertices[{vertex[dart]}]"
                    f" and vertices[{place}]; each dart belongs to one vertex, once"
                )
            vertex[dart] = place
    if not rotations:
        raise InputError("'vertices' is empty: the smallest world has one vertex, [[]]")
    edge: dict[int, int] = {}
    for place, pair in enumerate(pairs):
        if len(pair) != 2:
            raise InputError(f"edges[{place}] has {len(pair)} darts: an edge is two darts")
        for dart in pair:
            if dart not in vertex:
                raise InputError(f"edges[{place}] names dart {dart}, which no vertex has")
            if dart in edge:
                raise InputError(
                    f"dart {dart} stands in edges[{edge[dart]}] and edges[{place}]:"
                    " each dart belongs to one edge, and an edge is two different darts"
                )
            edge[dart] = place
    for dart, place in vertex.items():
        if dart not in edge:
            raise InputError(f"dart {dart} of vertices[{place}] belongs to no edge")
    return {dart: place for place, dart in enumerate(sorted(vertex))}


def map_parts(map_like: object) -> tuple[list[list[int]], list[list[int]], int | None]:
    """The vertices, edges and marker of anything that has them, as attributes or as keys."""
    vertices, edges, marker = (_part(map_like, name) for name in ("vertices", "edges", "marker"))
    dart = None if marker is None else _integer(marker)
    if marker is not None and dart is None:
        raise InputError(
            f"the map's 'marker' is of type {type(marker).__name__}: it is a dart (an integer of at"
            " most 64 bits) or None"
        )
    return _rows("vertices", vertices), _rows("edges", edges), dart


def optional_part(map_like: object, name: str, default: Any = None) -> Any:
    """What a map has under this name, as an attribute or as a key; if nothing, the default."""
    if isinstance(map_like, Mapping):
        return cast("Mapping[str, Any]", map_like).get(name, default)
    return getattr(map_like, name, default)


_MISSING = object()


def _part(map_like: object, name: str) -> Any:
    part = optional_part(map_like, name, _MISSING)
    if part is _MISSING:
        raise InputError(
            f"{type(map_like).__name__} is no map: it has no {name!r}; a map has vertices, edges"
            " and marker, as attributes or as keys"
        )
    return part


def _rows(name: str, value: object) -> list[list[int]]:
    given = _items(value)
    if given is None:
        raise InputError(f"the map's {name!r} is no list of lists of darts")
    rows: list[list[int]] = []
    for place, row in enumerate(given):
        items = None if name == "vertices" and isinstance(row, AbstractSet) else _items(row)
        darts = [dart for item in items or () if (dart := _integer(item)) is not None]
        if items is None or len(darts) < len(items):
            raise InputError(
                f"the map's {name}[{place}] is no list of darts (integers of at most 64 bits)"
            )
        rows.append(darts)
    return rows


def _items(value: object) -> list[Any] | None:
    """What is in a list or its like; None where it is no list or may have no end."""
    if isinstance(value, (tuple, list)):  # nearly always
        return list(cast("Iterable[Any]", value))
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, Sized):
        return None
    with suppress(TypeError):  # an array without a dimension looks like a list and is none
        return list(cast("Iterable[Any]", value))
    return None


def _integer(value: object) -> int | None:
    """The value as an int; None where it is none, or longer than a message could show."""
    if type(value) is int:  # nearly always, and no bool
        return value if value.bit_length() <= 64 else None
    if isinstance(value, bool) or not hasattr(value, "__index__"):  # quick, unlike SupportsIndex
        return None
    with suppress(TypeError):  # an array of one number looks like an integer and may be none
        number = index(cast("SupportsIndex", value))
        return number if number.bit_length() <= 64 else None
    return None
