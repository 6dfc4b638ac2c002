"""Every version of every format: a stored file is read, or the refusal says how to make it anew.

Whoever raises the version of a format stores a file of the new version, and keeps the old one.
Formats that nothing reads, such as the JSON of a command, are not here: their fields are pinned in
tests/docs/test_reference.py. What this does not show: that each file of a version is read; one is.
"""

from __future__ import annotations

import gzip
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.formats import Format, files_of, missing
from topo_verify import InputError, World, examine, explore, families
from topo_verify.campaign import store as stores
from topo_verify.campaign.store import Store
from topo_verify.campaign.targets import one_target, targets
from topo_verify.checkers import check
from topo_verify.programs import library, protocol
from topo_verify.robot import events
from topo_verify.studies.baseline import file as baselines
from topo_verify.studies.baseline.compare import BaselineWorlds, compare
from topo_verify.studies.baseline.record import baseline_runs
from topo_verify.studies.search.search import search_campaign
from topo_verify.world.formats import rotated, world_json

ROOT = Path(__file__).resolve().parent.parent
STORED = ROOT / "tests" / "data" / "formats"

EDGE, LOOP = World.from_id("m1/0"), World.from_id("m1/1")


# ---------------------------------------------------------------- how each format is read


def read_world(path: Path) -> None:
    assert World.load(path) == families.cube()


def read_graph(path: Path) -> None:
    assert World.load(path) == World.from_id("m4/41")


def read_trace(path: Path) -> None:
    trace = events.read_trace(path.read_bytes())
    assert {judgement.status for judgement in check(World.from_id("m4/41"), trace)} == {"ok"}


def read_baseline(path: Path) -> None:
    """The algorithm of today makes the moves and decisions that version 0.1 recorded."""
    baseline, basic = baselines.load(path), one_target("basic")
    limits = baseline.header.limits
    runs = baseline_runs(basic, BaselineWorlds(baseline, path.name), 12, limits=limits)
    assert compare(baseline, basic, runs.rows(0), tolerance="0").kinds["equal"] == 12


def read_store(path: Path) -> None:
    """The file is opened and verified; only the sources that wrote it resume its search."""
    mappers = targets("basic")
    with Store(path) as store:
        assert sorted(key for _, key in store.places) == ["m1/0-2", "m2/0-10"]
        again = r"topo-verify has changed since; name another file or folder, or remove this one"
        with pytest.raises(InputError, match=again):
            store.resumed(search_campaign(mappers, edges=2), mappers)


def read_protocol(path: Path) -> None:
    require_edge_mapper(f"--cmd {shlex.join([sys.executable, str(path)])}")


def read_native(path: Path) -> None:
    if shutil.which("cc") is None:
        pytest.skip("cc is not installed")
    built = path.with_suffix(".so")
    line = ["cc", "-shared", "-fPIC", "-I", str(STORED), "-o", str(built), str(path)]
    subprocess.run(line, check=True)
    require_edge_mapper(f"--library {built}")


def require_edge_mapper(target: str) -> None:
    """The mapper is right where the world is an edge, and declines a loop."""
    report = examine(one_target(target), EDGE)
    assert {report.claims[name] for name in ("map-entailed", "decisions-entailed")} == {"ok"}
    assert report.ok
    assert "of degree 1" in str(explore(LOOP, one_target(target)).stopped)


ANEW = r"wrote this ledger\. .* remove it, or name another file, and start anew"

FORMATS = (
    Format("world", world_json.VERSION, read_world),
    Format("graph", rotated.VERSION, read_graph),
    Format("trace", events.TRACE_VERSION, read_trace),
    Format("baseline", baselines.VERSION, read_baseline),
    Format("store", stores.VERSION, read_store, {1: ANEW, 2: ANEW}),
    Format("protocol", protocol.PROTOCOL, read_protocol),
    Format("native", library.VERSION, read_native),
)

ELSEWHERE = {
    "ledger": "the name of `store` in its versions 1 and 2",
    "certificate": "tests/extra/certificates/test_format_versions.py",
    "transcript": "written, never read",
    "arena": "written, never read",
    "corpus": "a part of a hash, never written",
}
"""Formats that the source names, and no row of the table, with the reason."""


# ---------------------------------------------------------------- the tests


@pytest.mark.parametrize(("kind", "version", "file"), files_of(STORED, FORMATS, without=[".h"]))
def test_a_stored_file_is_read_or_refused_with_how_to_make_it_anew(
    kind: Format, version: int, file: Path, tmp_path: Path
) -> None:
    copy = tmp_path / file.name
    shutil.copy(file, copy)
    if kind.name == "store":
        copy = tmp_path / file.stem
        copy.write_bytes(gzip.decompress(file.read_bytes()))
    if version not in kind.refused:
        kind.read(copy)
        return
    with pytest.raises(InputError, match=kind.refused[version]):
        kind.read(copy)


def test_a_file_of_every_version_is_stored() -> None:
    assert missing(STORED, FORMATS) == []


def test_a_new_version_without_a_stored_file_is_noticed() -> None:
    world = FORMATS[0]._replace(version=3)
    words = "store a file of version {} of the format as formats/world_{}.*"
    assert missing(STORED, [world]) == [words.format(2, 2), words.format(3, 3)]


def test_every_stored_file_belongs_to_a_version() -> None:
    stems = {f"{kind.name}_{v}" for kind in FORMATS for v in range(1, kind.version + 1)}
    files = {path.name.partition(".")[0] for path in STORED.iterdir() if path.is_file()}
    assert files == stems


def test_the_header_states_the_version_that_the_table_has() -> None:
    assert f"#define TV_VERSION {library.VERSION}\n" in library.header_text()


def names_in(source: str) -> set[str]:
    """The names of formats that a source text has between quotes."""
    return {name for name, _ in re.findall(r'"topo-verify/([a-z-]+)( \d+)?"', source)}


def test_every_format_that_the_source_names_has_a_row() -> None:
    sources = (path.read_text("utf-8") for path in (ROOT / "topo_verify").rglob("*.py"))
    named = set[str]().union(*map(names_in, sources))
    rows = {kind.name for kind in FORMATS} - {"protocol", "native"}  # messages and a C interface
    assert named == rows | ELSEWHERE.keys()


def test_a_format_without_a_row_is_noticed() -> None:
    assert names_in('FORMAT = "topo-verify/map"\nHEAD = "topo-verify/proof 2"') == {"map", "proof"}
