"""The formats: files to begin with, the command line that reads them, and their mutations."""

from __future__ import annotations

import gzip
import json
import re
import sys
import zlib
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from mutations import Mutation, of_bytes, of_json, of_lines, of_numbers, of_xml
from trial import run

import topo_verify as tv
from topo_verify.robot.events import Move, Start, write_trace

HERE = Path(__file__).parent
DATA = HERE.parent.parent / "tests" / "data"
LIMITS = ("--move-timeout", "0.5", "--world-timeout", "3")


@dataclass(frozen=True)
class Format:
    """One format.

    Attributes:
        suffix: how its files end.
        seeds: the files to begin with.
        words: the command lines that read a file, equally likely.
        mutations: equally likely, too.
        codes: the allowed exit codes.
        sealed: it carries checksums.
    """

    suffix: str
    seeds: Callable[[], Sequence[bytes]]
    words: Callable[[str], Sequence[Sequence[str]]]
    mutations: tuple[Mutation, ...]
    codes: tuple[int, ...]
    sealed: bool = False


# ---------------------------------------------------------------- files to begin with


def _worlds() -> Sequence[bytes]:
    lattice = tv.families.lattice(3, 3)
    named = {
        **json.loads(lattice.to_json()),
        "vertex_names": [f"v{n}" for n in range(len(lattice.vertices))],
        "positions": [[n, n * n] for n in range(len(lattice.vertices))],
        "source": "a test",
        "licence": "none",
    }
    worlds = [tv.World.from_id(i).to_json() for i in ("m1/0", "m1/1", "m4/17", "m5/1000")]
    return [text.encode() for text in (*worlds, json.dumps(named))]


def _planar_code() -> Sequence[bytes]:
    tetrahedron = (DATA / "planar_code" / "solids.pc").read_bytes()[:32]
    return [tetrahedron, (DATA / "planar_code" / "grid_300.pc").read_bytes()]


SQUARE = """<?xml version="1.0" encoding="utf-8"?>
<graphml xmlns="http://graphml.graphdrawing.org/xmlns">
<key id="d0" for="node" attr.name="x" attr.type="double"/>
<key id="d1" for="node" attr.name="y" attr.type="double"><default>0</default></key>
<key id="d2" for="edge" attr.name="geometry" attr.type="string"/>
<graph edgedefault="directed">
<node id="1"><data key="d0">0</data><data key="d1">0</data></node>
<node id="2"><data key="d0">1.5</data></node>
<node id="3"><data key="d0">1</data><data key="d1">1e0</data></node>
<edge source="1" target="2"><data key="d2">LINESTRING (0 0, 0.7 0.1, 1.5 0)</data></edge>
<edge source="2" target="1"><data key="d2">LINESTRING (1.5 0, 0.7 0.1, 0 0)</data></edge>
<edge source="2" target="3" directed="false"/>
<edge source="3" target="1"/>
</graph></graphml>"""

STREETS = """<net version="1.20" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
<location netOffset="0,0" convBoundary="0,0,9,9"/>
<edge id=":a_0" function="internal"><lane id=":a_0_0" index="0"/></edge>
<edge id="ab" from="a" to="b" shape="0,0 0,5 9,9"><lane id="ab_0" index="0"/></edge>
<edge id="-ab" from="b" to="a"/>
<edge id="bc" from="b" to="c"/>
<edge id="cb" from="c" to="b" shape="9,0 8,5 9,9"/>
<junction id="a" type="priority" x="0.00" y="0.00"/>
<junction id="b" type="priority" x="9.00" y="9.00"/>
<junction id="c" type="dead_end" x="9.00" y="0.00"/>
</net>"""


def _traces() -> Sequence[bytes]:
    runs = [
        tv.explore(tv.World.from_id(world), mapper)
        for world, mapper in (
            ("m2/5", "basic"),
            ("m4/17", "enhancement-iii-all"),
            ("m5/3", "folding"),
        )
    ]
    return [write_trace(run.trace) for run in runs]


def _logs() -> Sequence[bytes]:
    """Logs without decisions: a whole one, one cut short, and the traces."""
    trace = tv.explore(tv.World.from_id("m4/17"), "basic").trace
    bare = [event for event in trace if isinstance(event, Start | Move)]
    return [write_trace(bare), write_trace(bare[: len(bare) // 2]), *_traces()]


def _written(*words: str) -> bytes:
    """The file that a command line writes, which names it `FILE`."""
    with TemporaryDirectory() as folder:
        path = str(Path(folder) / "file")
        done = run([path if word == "FILE" else word for word in words])
        assert done.code == 0, done.stderr
        return Path(path).read_bytes()


@cache
def ledger() -> bytes:
    """The ledger of a finished search."""
    return _written("search", "basic", "--edges", "3", "--workers", "0", "--ledger", "FILE")


@cache
def baseline() -> bytes:
    """A baseline of twelve worlds."""
    return _written("record", "basic", "--worlds", "edges<=2", "--out", "FILE")


def search_words(path: str) -> Sequence[str]:
    """The command line that resumes the ledger."""
    return ("search", "basic", "--edges", "3", "--workers", "0", "--ledger", path)


def compare_words(path: str) -> Sequence[str]:
    """The command line that compares with the baseline."""
    return ("compare", path, "basic")


def _readings(path: str) -> Sequence[Sequence[str]]:
    return [
        ("world", "show", path),
        ("world", "show", path, "--format", "markdown"),
        ("world", "convert", path, "--to", "json"),
        ("explore", path, "--target", "enhancement-i", *LIMITS),
    ]


def _replies() -> Sequence[bytes]:
    run = tv.explore(tv.World.from_id("m2/5"), "enhancement-i")
    lines: list[object] = []
    for event in run.trace[1:]:
        told = json.loads(write_trace([event]))
        match told["type"]:
            case "move":
                lines.append({"type": "move", "door": told["door"]})
            case "finish":
                lines.append({"type": "done", "map": told["map"], "cost": told["cost"]})
            case _:
                lines.append({"type": "declare", "event": told})
    return ["".join(json.dumps(line) + "\n" for line in lines).encode()]


def _batch() -> Sequence[bytes]:
    leaf = {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}
    loop = {"vertices": [[0, 1]], "edges": [[0, 1]], "marker": 0}
    runs = [
        {"id": "m1/0", "doors": [0], "map": leaf, "cost": 1},
        {"id": "m1/1", "doors": [0], "declare": [], "map": loop},
    ]
    return ["".join(json.dumps(one) + "\n" for one in runs).encode()]


# ---------------------------------------------------------------- mutations of packed files


def of_gzip(draw: Random, data: bytes) -> bytes:
    """One change of a baseline's packed bytes, or of a line without a new checksum."""
    lines = _unpacked(data)
    if lines is None or draw.random() < 0.5:
        return of_bytes(draw, data)
    return gzip.compress(of_lines(draw, lines), mtime=0)


def _unpacked(data: bytes) -> bytes | None:
    with suppress(OSError, EOFError, zlib.error):
        return gzip.decompress(data)
    return None


def of_sums(draw: Random, data: bytes) -> bytes:
    """One change of a line of a baseline, with new checksums."""
    lines = of_lines(draw, re.sub(rb',"sum":"\w+"}', b"}", _unpacked(data) or b"")).splitlines()
    total, made = "", b""
    for line in lines:
        body = line[:-1]
        total = sha256(total.encode() + body).hexdigest()[:16]
        made += body + f',"sum":"{total}"}}\n'.encode()
    return gzip.compress(made, mtime=0)


def as_is(_draw: Random, data: bytes) -> bytes:
    """The unchanged file."""
    return data


PYTHON = f"{sys.executable} -I -S"

FORMATS: dict[str, Format] = {
    "world JSON": Format(
        ".json",
        _worlds,
        _readings,
        (of_bytes, of_json, of_json, of_json),
        (0, 2),
    ),
    "planar_code": Format(
        ".pc",
        _planar_code,
        _readings,
        (of_bytes, of_numbers, of_numbers),
        (0, 2),
    ),
    "GraphML": Format(
        ".graphml",
        lambda: [SQUARE.encode()],
        _readings,
        (of_bytes, of_xml, of_xml),
        (0, 2),
    ),
    "SUMO": Format(
        ".net.xml",
        lambda: [STREETS.encode()],
        _readings,
        (of_bytes, of_xml, of_xml),
        (0, 2),
    ),
    "trace": Format(
        ".jsonl",
        _traces,
        lambda path: [("replay", path), ("replay", path, "--world", "m2/5")],
        (of_bytes, of_lines, of_lines),
        (0, 1, 2, 3),
    ),
    "log": Format(
        ".jsonl",
        _logs,
        lambda path: [("certify", path), ("certify", path, "--witness", "worlds")],
        (of_bytes, of_lines, of_lines),
        (0, 1, 2, 3),
    ),
    "ledger": Format(
        ".ledger",
        lambda: [ledger()],
        lambda path: [search_words(path)],
        (of_bytes,),
        (0, 2),
        sealed=True,
    ),
    "baseline": Format(
        ".gz",
        lambda: [baseline()],
        lambda path: [compare_words(path)],
        (of_gzip,),
        (0, 2),
        sealed=True,
    ),
    "baseline, new sums": Format(
        ".gz",
        lambda: [baseline()],
        lambda path: [compare_words(path)],
        (of_sums,),
        (0, 1, 2, 3),
    ),
    "protocol": Format(
        ".lines",
        _replies,
        lambda path: [
            ("replay", "m2/5", *LIMITS, "--cmd", f"{PYTHON} {HERE / 'replies.py'} {path}")
        ],
        (of_bytes, of_lines, of_lines),
        (0, 1, 3),
    ),
    "batch": Format(
        ".lines",
        _batch,
        lambda path: [
            ("conform", "--batch", "--worlds", "edges<=1", "--workers", "0", "--cmd", f"cat {path}")
        ],
        (of_bytes, of_lines, of_lines),
        (0, 1, 3),
    ),
}
