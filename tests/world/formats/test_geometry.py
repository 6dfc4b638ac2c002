"""Points and lines in every notation, and what is neither."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from topo_verify.errors import InputError
from topo_verify.world.formats import geometry

BENT = ((0.0, 0.0), (0.5, 0.1), (1.0, 0.0))


def geojson(kind: str, coordinates: Any) -> dict[str, Any]:
    """A geometry of GeoJSON."""
    return {"type": kind, "coordinates": coordinates}


def shape(kind: str, coordinates: Any) -> SimpleNamespace:
    """An object as shapely makes it, whose parts have no `coords`."""
    return SimpleNamespace(__geo_interface__=geojson(kind, coordinates))


def collection(*parts: Any) -> dict[str, Any]:
    """A collection of GeoJSON."""
    return {"type": "GeometryCollection", "geometries": [*parts]}


LINES: dict[str, Any] = {
    "rows": [[0, 0], [0.5, 0.1], [1, 0]],
    "heights": [(0, 0, 7), (0.5, 0.1, 7), (1, 0, 7)],
    "named": [{"x": 0, "y": 0}, {"y": 0.1, "x": 0.5}, {"x": 1, "y": 0}],
    "array": np.array([[0, 0], [0.5, 0.1], [1, 0]]),
    "texts": [("0", "0"), ("0.5", "1e-1"), ("1", "0")],
    "coords": SimpleNamespace(coords=[(0, 0), (0.5, 0.1), (1, 0)]),
    "wkt": "LINESTRING (0 0, 0.5 0.1, 1 0)",
    "wkt on lines": "\nLineString(0 0,\n 0.5\t0.1,1 0)\n",
    "wkt with a system": "SRID=4326;LINESTRING (0 0, 0.5 0.1, 1 0)",
    "wkt Z": "LINESTRING Z (0 0 5, 0.5 0.1 5, 1 0 5)",
    "wkt Z without blank": "LINESTRINGZ(0 0 5, 0.5 0.1 5, 1 0 5)",
    "wkt M": "LINESTRING M (0 0 1, 0.5 0.1 2, 1 0 3)",
    "wkt ZM": "SRID=4326;LINESTRING ZM (0 0 1 2, 0.5 0.1 1 2, 1 0 1 2)",
    "wkt in parts": "MULTILINESTRING ((0 0, 0.5 0.1), (0.5 0.1, 1 0))",
    "wkt of one part": "MULTILINESTRING ((0 0, 0.5 0.1, 1 0))",
    "GeoJSON": geojson("LineString", [[0, 0], [0.5, 0.1], [1, 0]]),
    "GeoJSON in parts": geojson("MultiLineString", [[[0, 0], [0.5, 0.1]], [[0.5, 0.1], [1, 0]]]),
    "second part turned": geojson("MultiLineString", [[[0, 0], [0.5, 0.1]], [[1, 0], [0.5, 0.1]]]),
    "first part turned": geojson("MultiLineString", [[[0.5, 0.1], [0, 0]], [[0.5, 0.1], [1, 0]]]),
    "shapely": shape("LineString", ((0, 0), (0.5, 0.1), (1, 0))),
    "collection": collection(geojson("LineString", [[0, 0], [0.5, 0.1], [1, 0]])),
    "nested": collection(collection(shape("LineString", BENT[:2])), shape("LineString", BENT[1:])),
}


@pytest.mark.parametrize("notation", LINES)
def test_a_line_is_read_in_every_notation(notation: str) -> None:
    assert geometry.line(LINES[notation], "it") == BENT


def test_a_ring_is_a_line() -> None:
    ring = shape("LinearRing", [(0, 0), (1, 0), (1, 1), (0, 0)])
    assert geometry.line(ring, "it") == ((0, 0), (1, 0), (1, 1), (0, 0))
    halves = geojson("MultiLineString", [[[0, 0], [1, 0], [1, 1]], [[1, 1], [0, 0]]])
    assert geometry.line(halves, "it") == ((0, 0), (1, 0), (1, 1), (0, 0))


@pytest.mark.parametrize(
    "value",
    [
        None, True, 7, float("nan"), "", "north", b"\1\2\0\0\0", {}, {0: 0}, [], [0, 0],
        [[0, 0], 1], [[0]], [[0, 0, 0, 0, 0]], [[0, "x"]], [["1_0", 0], [0, 0]],
        [[0, float("nan")]], [[0, float("inf")]],
        [[True, 0], [0, 0]], [[0, 1e13]], [[10**5000, 0]], [[1j, 0]], [None], [(None, 0)],
        {(0, 0), (1, 0)},
        np.zeros((0, 2)), np.array(5), np.array([1.0, 2.0]), np.array([[np.nan, 0], [1, 1]]),
        SimpleNamespace(coords=None), SimpleNamespace(coords=[]),
        "POINT (0 0)", "POLYGON ((0 0, 1 0, 1 1, 0 0))", "LINESTRING EMPTY", "LINESTRING Z EMPTY",
        "LINESTRING ()", "LINESTRING (0 0, 1)", "LINESTRING (0 0, , 1 0)",
        "LINESTRING (0 0, 1 nan)",
        "LINESTRING (0,0 1,1)", "LINESTRING (0 0, 1 1", "SRID=x;LINESTRING (0 0, 1 1)",
        "MULTILINESTRING EMPTY", "MULTILINESTRING ()", "MULTILINESTRING ((0 0, 1 0), (2 0, 3 0))",
        "MULTILINESTRING ((0 0, 1 0), EMPTY, (1 0, 2 0))x", "MULTIPOINT ((0 0), (1 1))",
        "MULTILINESTRING (0 0, 1 1)", "GEOMETRYCOLLECTION (LINESTRING (0 0, 1 0))",
        "CIRCULARSTRING (0 0, 1 1, 2 0)", "010200000002000000", " " * 99999 + "x",
        geojson("Point", [0, 0]), geojson("Polygon", [[[0, 0], [1, 0], [0, 0]]]),
        geojson("MultiLineString", []), geojson("MultiLineString", [[]]),
        geojson("LineString", None),
        geojson("MultiLineString", [[[0, 0], [1, 0]], [[2, 0], [3, 0]]]),
        geojson("Feature", None), collection(), collection(geojson("Polygon", [])), {"type": 7},
        shape("Point", (0, 0)), shape("MultiPoint", ((0, 0), (1, 1))), shape("LineString", ()),
    ],
)  # fmt: skip
def test_what_is_no_line_is_refused(value: Any) -> None:
    with pytest.raises(InputError, match=r"^the line ") as refusal:
        geometry.line(value, "the line")
    assert str(refusal.value).isprintable()


def test_collections_may_be_nested_deeply() -> None:
    nested: Any = geojson("LineString", [[0, 0], [1, 0]])
    for _ in range(50_000):
        nested = collection(nested)
    assert geometry.line(nested, "it") == ((0, 0), (1, 0))


@pytest.mark.parametrize(
    "value",
    ["POINT (1 2)", "SRID=4326;POINT Z (1 2 3)", geojson("Point", [1, 2]),
     shape("Point", (1, 2, 3)), SimpleNamespace(coords=[(1, 2)]), [1, 2], (1, 2, 3),
     np.array([1, 2])],
)  # fmt: skip
def test_a_point_is_read_in_every_notation(value: Any) -> None:
    assert geometry.geometry_point(value, "it") == (1, 2)


@pytest.mark.parametrize(
    "value",
    ["POINT EMPTY", "POINT (1)", "POINT (1 2, 3 4)", "LINESTRING (0 0, 1 1)", "MULTIPOINT ((0 0))",
     geojson("Point", []), geojson("Point", None), geojson("Polygon", []), [], [[1, 2], [3, 4]],
     [float("nan"), 0], 7, "1 2"],
)  # fmt: skip
def test_what_is_no_point_is_refused(value: Any) -> None:
    with pytest.raises(InputError, match=r"^the point "):
        geometry.geometry_point(value, "the point")


@pytest.mark.parametrize("text", ["1,2", "1 2", "(1, 2)", "[1, 2, 3]", "1,2!", " 1.0 , 2e0 "])
def test_a_position_may_be_a_text_of_numbers(text: str) -> None:
    assert geometry.point(text, "it") == (1, 2)


@given(st.text("LINESTRGMUOCZ();=, 0.1-e\n", max_size=40) | st.recursive(
    st.none() | st.booleans() | st.floats() | st.text(max_size=3),
    lambda inner: st.lists(inner, max_size=3)
    | st.fixed_dictionaries({"type": st.sampled_from(["LineString", "MultiLineString", "Point"]),
                             "coordinates": inner})
    | st.fixed_dictionaries({"type": st.just("GeometryCollection"), "geometries": inner}),
    max_leaves=9,
))  # fmt: skip
def test_any_value_is_points_or_one_sentence(value: Any) -> None:
    for read in (geometry.line, geometry.geometry_point, geometry.point):
        try:
            read(value, "it")
        except InputError as refusal:
            assert str(refusal).isprintable()  # noqa: PT017
