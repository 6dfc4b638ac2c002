"""Reads points and lines in every notation that graphs are drawn with.

| notation | example |
| --- | --- |
| rows of numbers, also of numpy | `[(0, 0), (1, 2)]` |
| well-known text, perhaps with SRID, Z or M | `LINESTRING (0 0, 1 2)` |
| GeoJSON, and what has a `__geo_interface__`, as shapely's objects | `{"type": "LineString", …}` |
| an object with `coords` | |

Heights and measures are left out. A line in several parts is read if each part joins the next.

Why not a library? shapely reads well-known text and no more of this: a compiled dependency for one
line of text.

Source: docs/formats.md, "Drawings"; OGC 06-103r4 (well-known text); RFC 7946 (GeoJSON).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from contextlib import suppress
from typing import Any, Final, cast

from topo_verify.errors import InputError, shown
from topo_verify.world.formats.junctions import Point

FARTHEST = 1e12
"""The largest coordinate: products must not overflow."""

_Rows = Iterable[Sequence[object]]

LINE: Final = "LINESTRING"
POINT: Final = "POINT"
_EXPECTED = {LINE: "a line as LINESTRING (0 0, 1 2)", POINT: "a point as POINT (0 0)"}
_KINDS = {LINE: {"linestring", "linearring", "multilinestring"}, POINT: {"point"}}

_WELL_KNOWN = re.compile(
    r"\s*+(?:SRID=\d++\s*+;)?\s*+([A-Z]+?)\s*+(?:ZM|Z|M)?\s*+(?:(EMPTY)|\((.*)\))\s*",
    re.IGNORECASE | re.DOTALL,
)


def number(value: Any, subject: str, most: float = FARTHEST) -> float:
    """The value as a coordinate, at most `most` either way."""
    with suppress(TypeError, ValueError, OverflowError):
        coordinate = float(value)
        is_python = isinstance(value, bool) or (isinstance(value, str) and "_" in value)
        if abs(coordinate) <= most and not is_python:  # other programs have no True and no 1_000
            return coordinate + 0.0  # not -0.0
    # long integers cannot be printed
    got = "an integer" if type(value) is int else repr(value)
    raise InputError(
        f"{subject} is {shown(got, limit=60)}, expected a number of at most {most:.0e} in size"
    )


def point(value: Any, subject: str) -> Point:
    """The point of a row of x and y, or of a text such as `0.5,2`; a height is left out."""
    row = re.split(r"[,\s]+", value.strip("()[]! ")) if isinstance(value, str) else value
    (at,) = _points([row], subject, most=3)
    return at


def points(rows: Iterable[Any], subject: str) -> tuple[Point, ...]:
    """The points of rows of x and y, perhaps with height and measure."""
    return _points(rows, subject, most=4)


def geometry_point(value: Any, subject: str) -> Point:
    """The point that a geometry is."""
    rows = [row for part in _parts(value, subject, POINT) for row in part]
    if len(rows) != 1:
        raise InputError(f"{subject} has {len(rows)} points, expected {_EXPECTED[POINT]}")
    return points(rows, subject)[0]


def line(value: Any, subject: str) -> tuple[Point, ...]:
    """The points of the line that a geometry is."""
    parts = [points(part, subject) for part in _parts(value, subject, LINE)]
    if not parts or not all(parts):
        raise InputError(f"{subject} is empty, expected {_EXPECTED[LINE]}: or leave it out")
    joined = list(parts[0])
    if len(parts) > 1 and joined[-1] not in (parts[1][0], parts[1][-1]):
        joined.reverse()
    for part in parts[1:]:
        onward = part if part[0] == joined[-1] else part[::-1]
        if onward[0] != joined[-1]:
            raise InputError(
                f"{subject} has {len(parts)} parts, and two that follow each other do not join:"
                " join them (shapely.line_merge does), or give each part its own edge"
            )
        joined += onward[1:]
    return tuple(joined)


def _parts(geometry: Any, subject: str, kind: str) -> list[_Rows]:
    """The parts of a geometry, each with its rows of coordinates."""
    parts: list[_Rows] = []
    waiting = [geometry]  # collections may be nested deeply
    while waiting:
        value = waiting.pop()
        value = getattr(value, "__geo_interface__", value)
        fields = _fields(value)
        if isinstance(value, str):
            parts += _text_parts(value, subject, kind)
        elif "type" in fields:
            name, inside = str(fields["type"]), fields.get("geometries", fields.get("coordinates"))
            if name == "GeometryCollection":
                waiting += row_of(inside, subject)[::-1]
            else:
                _require_kind(name, subject, kind)
                rows = row_of(inside, subject)
                parts += (
                    [row_of(row, subject) for row in rows]
                    if name == "MultiLineString"
                    else [[rows] if kind == POINT and rows else rows]
                )
        else:
            rows = row_of(getattr(value, "coords", value), subject)
            parts.append([rows] if kind == POINT and not _is_nested(rows) else rows)
    return parts


def _text_parts(text: str, subject: str, kind: str) -> Iterator[_Rows]:
    match = _WELL_KNOWN.fullmatch(text)
    if not match:
        raise InputError(f"{subject} is '{shown(text, limit=60)}', expected {_EXPECTED[kind]}")
    name, empty, inside = match.groups()
    _require_kind(name, subject, kind)
    if empty:
        return
    texts = re.findall(r"\(([^()]*+)\)", inside) if name.upper().startswith("MULTI") else [inside]
    for part in texts:
        # a list of texts would take ten times the memory
        yield (coordinates.split() for coordinates in _split(part))


def _require_kind(name: str, subject: str, kind: str) -> None:
    if name.lower() not in _KINDS[kind]:
        raise InputError(f"{subject} is a {shown(name, limit=60)}, expected {_EXPECTED[kind]}")


def _split(text: str) -> Iterator[str]:
    begin = 0
    while (comma := text.find(",", begin)) >= 0:
        yield text[begin:comma]
        begin = comma + 1
    yield text[begin:]


def _is_nested(rows: Sequence[Any]) -> bool:
    return bool(rows) and not isinstance(rows[0], str | int | float) and hasattr(rows[0], "__len__")


def _points(rows: Iterable[Any], subject: str, most: int) -> tuple[Point, ...]:
    return tuple(_point(row_of(row, subject), subject, most) for row in rows)


def _point(row: Sequence[object], subject: str, most: int) -> Point:
    if not 2 <= len(row) <= most:
        raise InputError(
            f"{subject} has a point of {len(row)} coordinates, expected x and y: give it both"
        )
    return number(row[0], subject), number(row[1], subject)


def row_of(value: Any, subject: str) -> list[Any]:
    """The values in a row of any kind; a point may be a mapping with x and y."""
    if isinstance(value, list):
        return cast("list[Any]", cast("object", value))
    fields = _fields(value)
    if {"x", "y"} <= fields.keys():
        return [fields["x"], fields["y"]]
    if not isinstance(value, str | bytes | Mapping | AbstractSet):  # a set has no order
        with suppress(TypeError):  # numpy's arrays without a dimension
            return list(cast("Iterable[Any]", value))
    raise InputError(
        f"{subject} is {shown(repr(cast('object', value)), limit=60)}, expected x and y in a row,"
        " or such rows"
    )


def _fields(value: object) -> Mapping[str, Any]:
    return cast("Mapping[str, Any]", value) if isinstance(value, Mapping) else {}
