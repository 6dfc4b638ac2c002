"""A drawing as a graph with attributes: where its nodes lie, and how its edges run.

A node lies at its `pos`, its `x` and `y`, its `geometry` (a point), or its `lon` and `lat`. An edge
runs along its `geometry`, past its `bends` (OGDF: the points between its ends), or straight.

If a polyline were overlooked, its edge would leave the vertex in another direction. So an attribute
that holds points but is not read is refused by its name: the name is known for it, or the value
looks like points.

Source: docs/formats.md, "Drawings"; OGDF, `GraphMLParser.cpp` (`bends`).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from itertools import chain, islice
from math import isclose
from typing import Any, NamedTuple, TypeVar, cast

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import embedding, geometry
from topo_verify.world.formats.embedding import DrawnEdge, DrawnEnd, DrawnVertex
from topo_verify.world.formats.flaws import Flaws
from topo_verify.world.formats.junctions import Point
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)

_DEGREES = (("lon", "lat"), ("lng", "lat"), ("long", "lat"), ("longitude", "latitude"))
"""Names of the coordinates in degrees. They only stretch a map: clockwise orders stay the same."""

_ROUNDING = 1e-6
"""Relative difference of two positions of one node up to which they are the same."""

PLACES = frozenset({"pos", "x", "y", "geometry", *chain.from_iterable(_DEGREES)})
"""The attributes that hold a node's position."""

NOT_READ = frozenset({"graphics", "viz", "coords", "coordinates", "location", "position", "point"})
"""Other attributes that may say it: the refusal of a node without a place names them."""

_SURELY_DRAWN = frozenset(
    {"wkt", "wkb", "geom", "thegeom", "geojson", "polyline", "linestring", "sections"}
)
_MAYBE_DRAWN = re.compile(
    "(bend|control|way)?points?|bends?|coords?|coordinates?|curves?|d|graphics|lines?|paths?|pos"
    "|positions?|route|shape|splines?|track|vertices"
)
"""Names of polylines, in lower case and without - and _; the second have other uses, too."""

ELEMENT = "<{}>"
"""The name under which a reader of XML hands over an element that draws, as yEd's `<Path>`."""


class GraphEdge(NamedTuple):
    """An edge with its attributes; the label names it in messages."""

    source: Any
    target: Any
    attributes: Mapping[str, Any]
    directed: bool
    label: Any


def as_world(
    cls: type[W],
    nodes: Mapping[Any, Mapping[str, Any]],
    edges: Iterable[GraphEdge],
    flaws: Flaws,
    *,
    name: str = "",
    marker: DrawnEnd | None = None,
    largest_part: bool = False,
) -> W:
    """The world of the drawing; `nodes` by their ids, the rest as for `embedding.as_world`."""
    number: dict[Any, int] = {}
    places: list[DrawnVertex] = []
    for key, attributes in nodes.items():
        with flaws:
            at = position(attributes, f"{flaws.source}: node {_named(key)}")
            number[key] = len(places)
            places.append(DrawnVertex(str(key), at))
    ways: list[DrawnEdge] = []
    for edge in edges:
        ends = edge.source, edge.target
        start, end = (number.get(key) for key in ends)
        subject = f"{flaws.source}: edge {_named(edge.label)}"
        if start is not None and end is not None:
            with flaws:
                label = edge.label if isinstance(edge.label, str) else repr(edge.label)
                line = course(edge.attributes, subject, (places[start].at, places[end].at))
                ways.append(DrawnEdge(start, end, line, edge.directed, label))
                continue
        elif not nodes.keys() >= {*ends}:
            with flaws:
                raise InputError(f"{subject}: expected the ids of two nodes as source and target")
        flaws.touched |= {place for place in (start, end) if place is not None}
    return embedding.as_world(
        cls, places, ways, flaws, name=name, marker=marker, largest_part=largest_part
    )


def _named(label: Any) -> str:
    return shown(repr(label), limit=60)


def position(attributes: Mapping[str, Any], subject: str) -> Point:
    """The position of the node."""
    given = {name: value for name, value in attributes.items() if not is_blank(value)}
    readings: list[Point] = []
    if "pos" in given and not _is_word(given["pos"]):
        readings.append(geometry.point(given["pos"], f"{subject}, pos"))
    if given.keys() >= {"x", "y"}:
        readings.append(_coordinates(given, ("x", "y"), subject))
    if "geometry" in given:
        readings.append(geometry.geometry_point(given["geometry"], f"{subject}, geometry"))
    # a map in metres may keep its degrees
    degrees = [axes for axes in _DEGREES if given.keys() >= {*axes} and not readings]
    readings += [_coordinates(given, axes, subject) for axes in degrees]
    for other in readings[1:]:
        pairs = zip(readings[0], other, strict=True)
        if not all(isclose(*pair, rel_tol=_ROUNDING, abs_tol=_ROUNDING) for pair in pairs):
            raise InputError(
                f"{subject} lies at {readings[0]} and at {other}, by two of its attributes pos, x"
                " and y, geometry: give it one position"
            )
    if readings:
        return readings[0]
    unread = next((name for name in given if _plain(name) in NOT_READ or name.startswith("<")), "")
    raise InputError(
        f"{subject} has no '{'y' if 'x' in given else 'x'}': the rotation comes from positions, so"
        " give each node x and y (y upwards), pos, lon and lat, or a POINT as geometry"
        + (f"; its {shown(unread, limit=60)!r} is not read" if unread else "")
    )


def _coordinates(given: Mapping[str, Any], axes: tuple[str, str], subject: str) -> Point:
    x, y = (geometry.number(given[axis], f"{subject}, {axis}") for axis in axes)
    return x, y


def _is_word(value: Any) -> bool:
    """Whether a `pos` is a part of speech, as NOUN."""
    return isinstance(value, str) and not re.search(r"\d", value)


def course(
    attributes: Mapping[str, Any], subject: str, ends: tuple[Point, Point]
) -> Sequence[Point]:
    """The polyline of the edge between these ends; empty if it is straight."""
    line, bends = attributes.get("geometry"), attributes.get("bends")
    for name, value in attributes.items():
        if name not in {"geometry", "bends"} and is_drawn(name, value):
            raise InputError(
                f"{subject} has points in {shown(name, limit=60)!r}, which is not read: give"
                " them as 'geometry', LINESTRING (0 0, 1 2), or leave them out"
            )
    if is_blank(bends):
        return [] if is_blank(line) else _line(line, f"{subject}, geometry", ends)
    if not is_blank(line):
        raise InputError(f"{subject} has 'geometry' and 'bends': leave one of the two out")
    subject = f"{subject}, bends"
    row = bends.replace(",", " ").split() if isinstance(bends, str) else bends
    row = geometry.row_of(row, subject)
    if all(isinstance(value, str) or not hasattr(value, "__len__") for value in row):
        if len(row) % 2:
            raise InputError(f"{subject} has {len(row)} numbers, expected x y x y …: give both")
        row = [*zip(row[::2], row[1::2], strict=True)]
    return [ends[0], *geometry.points(row, subject), ends[1]]


def _line(value: Any, subject: str, ends: tuple[Point, Point]) -> Sequence[Point]:
    line = geometry.line(value, subject)
    if len(line) > 2 and line[0] == line[-1] and ends[0] != ends[1]:
        raise InputError(
            f"{subject} is a ring, and the edge joins two vertices: give it the line from the one"
            " to the other"
        )
    return line


def is_blank(value: Any) -> bool:
    """Whether an attribute stands there without a value."""
    return value is None or (isinstance(value, str) and not value.strip())


# ---------------------------------------------------------------- points that are not read

_N = r"[-+]?+(?:\d++(?:\.\d*+)?+|\.\d++)(?:[eE][-+]?+\d++)?+"
_LOOKS_DRAWN = re.compile(
    rf"""\s*+(?:
      (?:SRID=\d++\s*+;\s*+)?(?:MULTI|COMPOUND|CIRCULAR)?(?:LINESTRING|LINEARRING|POINT|POLYGON|
        CURVE|STRING|GEOMETRYCOLLECTION)\s*+(?:ZM?|M)?\s*+(?:\(|EMPTY)      # well-known text
    | (?:00000000|00[0-9A-F]00000|01)0[1-7](?:0000[0-9A-F]0)?[0-9A-F]{{32}}   # its binary form
    | {_N},{_N}(?:,{_N})?+(?:[\s;]++{_N},{_N}(?:,{_N})?+)++\s*+;?\Z          # 0,0 1,2
    | {_N}\s++{_N}(?:\s++{_N})?+(?:\s*+[,;]\s*+{_N}\s++{_N}(?:\s++{_N})?+)++\s*+\Z  # 0 0, 1 2
    | [\[(]\s*+[\[({{]\s*+(?:"x"\s*+:\s*+)?{_N}\s*+,                         # [[0, 0], [1, 2]]
    | [Mm]\s*+{_N}[\s,]++{_N}[\s,]*+[LHVCSQTA]\s*+{_N}                       # a path of SVG
    | \{{.*"coordinates"\s*+:                                               # GeoJSON
    )""",
    re.IGNORECASE | re.VERBOSE | re.DOTALL,
)
_NOT_POINTS = re.compile(r"[^\s\d.,;:()\[\]{}'\"+eExyzMLHVCSQTAmlhvcsqta-]")


def _plain(name: str) -> str:
    return re.sub(r"[-_:\s]", "", name).lower()


def is_drawn(name: str, value: Any) -> bool:
    """Whether an attribute of an edge holds points."""
    if is_blank(value) or isinstance(value, bool | int | float):
        return False
    if _is_sure(name) or _looks_drawn(value):
        return True
    return _is_polyline_name(name) and _holds_numbers(value)


@lru_cache
def _is_sure(name: str) -> bool:
    read = {"geometry", "bends"}
    return name in read or name.startswith("<") or _plain(name) in _SURELY_DRAWN


@lru_cache
def _is_polyline_name(name: str) -> bool:
    return _MAYBE_DRAWN.fullmatch(_plain(name)) is not None


def _looks_drawn(value: Any) -> bool:
    if isinstance(value, str):
        return _LOOKS_DRAWN.match(value) is not None
    if isinstance(value, Mapping):
        return {"coordinates", "Line", "points"} & value.keys() != set() or {"x", "y"} <= {*value}
    if isinstance(value, bytes):
        return value[:1] in {b"\0", b"\1"}
    return hasattr(value, "__geo_interface__") or hasattr(value, "coords") or _has_points(value)


def _holds_numbers(value: Any) -> bool:
    if isinstance(value, str):
        return len(re.findall(_N, value)) > 1 and not _NOT_POINTS.search(value)
    return _has_points([value, value])


def _has_points(value: Any) -> bool:
    """Whether the value is a row of points; a mapping alone is one only with x and y."""
    try:
        first = [*islice(value, 2)]
        rows = [_values(row) for row in first]
    except TypeError:
        return False
    if len(first) == 1 and isinstance(first[0], Mapping):
        return {"x", "y"} <= {*first[0]}
    return len(rows) > 0 and all(len(row) > 1 and all(map(_is_number, row)) for row in rows)


def _values(row: Any) -> list[Any]:
    return list(cast("Mapping[str, Any]", row).values() if isinstance(row, Mapping) else row)


def _is_number(value: Any) -> bool:
    return not isinstance(value, str | bool) and hasattr(value, "__float__")
