"""Formats that are not read: how to know them, and a line of Python that converts a file.

GML, GEXF, Pajek, OpenStreetMap and GIS may hold positions; edge_code and OFF hold a rotation. The
others have neither, so their lines choose a rotation in which the graph is planar.

Source: NetworkX, "Reading and writing graphs"; plantri-guide.txt (edge_code); Geomview (OFF).
"""

from __future__ import annotations

import re
from os import PathLike, fspath
from pathlib import PurePath
from typing import NamedTuple

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import files

READ = (
    "world JSON (.json), planar_code (.pc), GraphML (.graphml), node-link JSON (.nx.json) and road"
    " networks of SUMO (.net.xml)"
)

_SNIFFED = 4096
"""Bytes at the beginning of a file that are looked at."""


class _Format(NamedTuple):
    """A format: the endings of its files, how they begin, and the line that converts FILE to TO."""

    name: str
    endings: tuple[str, ...]
    begins: str
    line: str


def _drawing(graph: str, positions: str = "") -> str:
    return (
        "import networkx as nx; from topo_verify.world.formats.nx import from_positions;"
        f" g = {graph}; from_positions(g{positions}).save(TO)"
    )


def _planar(graph: str) -> str:
    return (
        "import networkx as nx; from topo_verify.world.formats.nx import from_planar_embedding;"
        f" g = nx.Graph({graph}); from_planar_embedding(nx.check_planarity(g)[1]).save(TO)"
    )


_XML = r"(?:\s++|(?><\?.*?\?>)|(?><!--.*?-->))*+<(?:\w++:)?"
_VIZ = (
    ", {n: (p['x'], p['y']) for n, d in g.nodes(data=True)"
    " for p in [d.get('viz', {}).get('position', d)]}"
)
_EDGE_CODE = (
    "import topo_verify as tv; from pathlib import Path; s = set();"
    " rows = Path(FILE).read_bytes()[14:].split(b'\\xff');"
    " tv.World.from_rotations([[2*e + (e in s or bool(s.add(e))) for e in row] for row in rows],"
    " [(2*e, 2*e + 1) for e in sorted(s)], 0).save(TO)"
)
_OFF = (
    "import networkx as nx; from topo_verify.world.formats.nx import from_planar_embedding;"
    " from pathlib import Path;"
    " rows = [l.partition('#')[0].split() for l in Path(FILE).read_text().splitlines()];"
    " rows = [r for r in rows if r];"
    " g = nx.Graph((r[i], r[i - 1] if i > 1 else r[int(r[0])])"
    " for r in rows[2 + int(rows[1][0]):] for i in range(1, int(r[0]) + 1));"
    " from_planar_embedding(nx.check_planarity(g)[1]).save(TO)"
)
_FORMATS = (
    _Format(
        "GML",
        (".gml",),
        r"(?:\s++|#[^\n]*+|(?:Creator|Version|Comment)[^\n]*+)*+graph\s*+\[",
        _drawing("nx.read_gml(FILE, label='id')"),
    ),
    _Format("GEXF", (".gexf",), _XML + "gexf", _drawing("nx.read_gexf(FILE)", _VIZ)),
    _Format(
        "DOT",
        (".dot", ".gv"),
        r"(?:\s++|//[^\n]*+|#[^\n]*+|(?>/\*.*?\*/))*+(?:strict\s++)?(?:di)?graph\b[^\[{]*+\{",
        _planar("nx.nx_pydot.read_dot(FILE)"),
    ),
    _Format("graph6", (".g6",), ">>graph6<<", _planar("nx.read_graph6(FILE)")),
    _Format("sparse6", (".s6",), ">>sparse6<<", _planar("nx.read_sparse6(FILE)")),
    _Format("edge_code", (".ec",), ">>edge_code<<", _EDGE_CODE),
    _Format(
        "Pajek", (".net", ".paj"), r"\s*\*(?:vertices|network)", _drawing("nx.read_pajek(FILE)")
    ),
    _Format("an edge list", (".edgelist", ".edges"), "(?!)", _planar("nx.read_edgelist(FILE)")),
    _Format("an adjacency list", (".adjlist",), "(?!)", _planar("nx.read_adjlist(FILE)")),
    _Format(
        "YAML",
        (".yaml", ".yml"),
        "(?!)",
        "import json, yaml; from pathlib import Path;"
        " Path(TO).write_text(json.dumps(yaml.safe_load(Path(FILE).read_text())))",
    ),
    _Format(
        "OpenStreetMap's XML",
        (".osm",),
        _XML + "osm",
        "import osmnx as ox; from topo_verify.world.formats.nx import from_positions;"
        " from_positions(ox.graph_from_xml(FILE)).save(TO)",
    ),
    _Format("OFF", (".off",), r"\s*(?:ST)?C?N?4?n?OFF\b", _OFF),
    _Format(
        "a format of GIS",
        (".geojson", ".shp", ".gpkg"),
        r'\s*\{[^{]*"type"\s*:\s*"FeatureCollection"',
        "import geopandas, momepy; from topo_verify.world.formats.nx import from_positions;"
        " from_positions(momepy.gdf_to_nx(geopandas.read_file(FILE))).save(TO)",
    ),
)

_BY_ENDING = {ending: form for form in _FORMATS for ending in form.endings}


def refuse(path: str | PathLike[str], data: bytes, kind: str) -> None:
    """Refuse a file of a format that is not read; `kind` is the one that its name says.

    How a file begins counts more than its ending, and an ending only where it says no format that
    is read. The path `-` is standard input.
    """
    given = "FILE" if fspath(path) == "-" else fspath(path)
    subject = "standard input" if fspath(path) == "-" else shown(path)
    ending = PurePath(files.unpacked_name(given)).suffix.lower()
    begin = data[:_SNIFFED].decode("utf-8-sig", "replace")
    if kind == "json":
        for element, right in (("graphml", ".graphml"), ("net", ".net.xml")):
            if re.match(rf"{_XML}{element}\b", begin, re.DOTALL):
                raise InputError(
                    f"{subject} begins with <{element}>: give it as a file whose name ends in"
                    f" {right}; {READ} are read"
                )
    form = _by_beginning(begin) or (_BY_ENDING.get(ending) if kind == "json" else None)
    if form is not None:
        target = files.stem(given) + (".world.json" if ending == ".json" else ".json")
        line = form.line.replace("FILE", repr(given)).replace("TO", repr(target))
        raise InputError(
            f"{subject} is {form.name}, which is not read; {READ} are. In Python this converts it:"
            f" {line}"
        )
    if kind == "json" and ending not in _TEXTS and not begin.lstrip().startswith(("{", "[")):
        raise InputError(
            f"{subject} is of no format that is read; {READ} are. In Python, with a graph of"
            f" NetworkX whose nodes have x and y, this converts it: {_ANY}"
        )


def _by_beginning(begin: str) -> _Format | None:
    flags = re.DOTALL | re.IGNORECASE
    return next((form for form in _FORMATS if re.match(form.begins, begin, flags)), None)


_TEXTS = ("", ".json", ".jsonl", ".csv", ".tsv", ".txt", ".log")
"""Endings of files that may be worlds or logs: the reader of world JSON says more about them."""

_ANY = (
    "from topo_verify.world.formats.nx import from_positions; from_positions(graph).save('w.json')"
)
