"""Other formats: one sentence with those that are read, and a line of Python that converts."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import Any

import networkx as nx
import pytest
import yaml

from topo_verify.errors import InputError
from topo_verify.world import World, families
from topo_verify.world.resolve import resolve_world

NX: Any = nx
"""NetworkX where its stubs leave types open."""

GML = """Creator "a program"
graph [
  node [ id 0 label "a" x 0.0 y 0.0 ] node [ id 1 label "b" x 1.0 y 0.0 ]
  node [ id 2 label "c" x 0.0 y 1.0 ]
  edge [ source 0 target 1 ] edge [ source 0 target 2 ] edge [ source 1 target 2 ]
]
"""
GEXF = """<?xml version='1.0'?><!-- a comment -->
<gexf xmlns="http://www.gexf.net/1.2draft" xmlns:viz="http://www.gexf.net/1.2draft/viz"
 version="1.2"><graph defaultedgetype="undirected"><nodes>
<node id="a" label="a"><viz:position x="0" y="0" z="0"/></node>
<node id="b" label="b"><viz:position x="1" y="0" z="0"/></node>
<node id="c" label="c"><viz:position x="0" y="1" z="0"/></node></nodes><edges>
<edge source="a" target="b" id="0"/><edge source="a" target="c" id="1"/>
<edge source="b" target="c" id="2"/></edges></graph></gexf>
"""
PAJEK = """*Vertices 3
1 "a" 0.0 0.0 ellipse
2 "b" 1.0 0.0 ellipse
3 "c" 0.0 1.0 ellipse
*Edges
1 2
1 3
2 3
"""
OFF = """OFF
# a pyramid
5 5 8
0 0 0
1 0 0
1 1 0
0 1 0
0.5 0.5 1
4 0 3 2 1 255 0 0
3 0 1 4
3 1 2 4
3 2 3 4
3 3 0 4
"""
EDGE_CODE = b">>edge_code<<\x0f\0\2\1\xff\0\3\4\xff\1\5\3\xff\2\4\5"
OSM = b"<?xml version='1.0'?><osm version='0.6'><node id='1' lat='60' lon='25'/></osm>"
GEOJSON = b'{"type": "FeatureCollection", "features": []}'

CONVERTED: dict[str, tuple[bytes, World]] = {
    "t.gml": (GML.encode(), families.cycle(3)),
    "t.gexf": (GEXF.encode(), families.cycle(3)),
    "t.net": (PAJEK.encode(), families.cycle(3)),
    "t.g6": (NX.to_graph6_bytes(NX.cycle_graph(4)), families.cycle(4)),
    "t.s6": (NX.to_sparse6_bytes(NX.cycle_graph(4)), families.cycle(4)),
    "t.ec": (EDGE_CODE, families.tetrahedron()),
    "t.off": (OFF.encode(), families.wheel(4)),
    "t.edgelist": (b"a b\nb c\nc a\n", families.cycle(3)),
    "t.adjlist": (b"a b c\nb c\n", families.cycle(3)),
    "t.yaml": (
        yaml.safe_dump(yaml.safe_load(families.cycle(3).to_json())).encode(),
        families.cycle(3),
    ),
}
KNOWN_BY_ITS_BEGINNING = ("t.gml", "t.gexf", "t.net", "t.g6", "t.s6", "t.ec", "t.off")
NOT_CONVERTED = {"t.dot": b"graph { a -- b }", "t.osm": OSM, "t.geojson": GEOJSON}


def sentence_of(file: Path) -> str:
    """The one sentence that refuses the file."""
    with pytest.raises(InputError) as refusal:
        World.load(file)
    sentence = str(refusal.value)
    assert sentence.isprintable()
    assert all(
        ending in sentence for ending in (".json", ".pc", ".graphml", ".nx.json", ".net.xml")
    )
    return sentence


@pytest.mark.parametrize("name", CONVERTED)
def test_the_line_of_python_converts_the_file(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    data, world = CONVERTED[name]
    Path(name).write_bytes(data)
    line = sentence_of(Path(name)).partition("converts it: ")[2]
    exec(line, {})  # noqa: S102  it is the statement under test
    codes = {world.with_marker(dart).code for dart in range(2 * len(world.edges))}
    assert World.load("t.json").code in codes


@pytest.mark.parametrize("name", KNOWN_BY_ITS_BEGINNING)
@pytest.mark.parametrize("other", ["t", "t.json", "t.txt", "t.graphml", "t.nx.json"])
def test_a_file_is_known_by_its_beginning(name: str, other: str, tmp_path: Path) -> None:
    (tmp_path / other).write_bytes(CONVERTED[name][0])
    assert "converts it: " in sentence_of(tmp_path / other)


@pytest.mark.parametrize("name", [*CONVERTED, *NOT_CONVERTED])
def test_a_file_is_known_by_its_ending(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(b"{}")
    (tmp_path / f"{name}.gz").write_bytes(b"{}")
    for ending in ("", ".gz"):
        assert "converts it: " in sentence_of(tmp_path / f"{name}{ending}")


@pytest.mark.parametrize("name", NOT_CONVERTED)
def test_a_line_that_needs_other_packages_names_them(name: str, tmp_path: Path) -> None:
    file = tmp_path / "data"
    file.write_bytes(NOT_CONVERTED[name])
    package = {"t.dot": "nx_pydot", "t.osm": "osmnx", "t.geojson": "geopandas"}[name]
    assert package in sentence_of(file)


@pytest.mark.parametrize(
    ("data", "ending"),
    [(b"<graphml><graph/></graphml>", ".graphml"), (b"<?xml version='1.0'?><net/>", ".net.xml")],
)
@pytest.mark.parametrize("name", ["t.xml", "t", "t.json", "t.net", "t.gexf", "t.yaml"])
def test_a_format_that_is_read_has_its_ending(
    data: bytes, ending: str, name: str, tmp_path: Path
) -> None:
    (tmp_path / name).write_bytes(data)
    assert f"a file whose name ends in {ending}; " in sentence_of(tmp_path / name)


@pytest.mark.parametrize("name", KNOWN_BY_ITS_BEGINNING)
def test_a_beginning_counts_more_than_an_ending(name: str, tmp_path: Path) -> None:
    for other in CONVERTED:
        (tmp_path / other).write_bytes(CONVERTED[name][0])
    kinds = {
        sentence_of(tmp_path / other).partition(" is ")[2].partition(",")[0] for other in CONVERTED
    }
    assert len(kinds) == 1


@pytest.mark.parametrize("name", KNOWN_BY_ITS_BEGINNING)
def test_standard_input_is_known_by_its_beginning(name: str) -> None:
    with pytest.raises(InputError, match=r"^standard input is .* converts it: "):
        resolve_world("-", stdin=BytesIO(CONVERTED[name][0]))


@pytest.mark.parametrize("data", [b"<graphml><graph/></graphml>", b"<net/>"])
def test_standard_input_in_a_format_with_an_ending_belongs_into_a_file(data: bytes) -> None:
    with pytest.raises(InputError, match=r"^standard input begins with .* a file whose name ends"):
        resolve_world("-", stdin=BytesIO(data))


@pytest.mark.parametrize("name", ["t.tgf", "t.bin", "t.md", "t.osm.pbf"])
@pytest.mark.parametrize("data", [b"1 2\n", b"\xff\0\1", b""])
def test_a_format_that_nothing_tells_is_refused_with_those_that_are_read(
    name: str, data: bytes, tmp_path: Path
) -> None:
    (tmp_path / name).write_bytes(data)
    assert "converts it: " in sentence_of(tmp_path / name)


def test_a_world_may_have_a_name_with_any_ending(tmp_path: Path) -> None:
    (tmp_path / "m4.629").write_text(families.cycle(3).to_json())
    assert World.load(tmp_path / "m4.629") == families.cycle(3)


@pytest.mark.parametrize("text", ["#", "/**/", "<!---->", "<??>", " ", "//", "Creator "])
def test_a_long_beginning_is_looked_through_once(text: str, tmp_path: Path) -> None:
    """A pattern that backtracks would not end."""
    (tmp_path / "t.bin").write_text(text * 2000 + "!")
    assert "is of no format that is read" in sentence_of(tmp_path / "t.bin")
