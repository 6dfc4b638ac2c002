"""The hash of a mapper's sources: it changes with the mapper and what it imports."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from topo_verify.harness.search.identity import source_hash
from topo_verify.harness.targets import targets
from topo_verify.programs.loader import Target


@pytest.fixture
def package(folder: Path) -> Path:
    """A file that imports neighbours in several ways, and one that nobody imports."""
    (folder / "mine.py").write_text(
        "import near\nfrom far import away\nimport json\ndef explore(robot): ...\n"
    )
    (folder / "near.py").write_text("def f(): from nested import one\n".replace("def f(): ", ""))
    (folder / "far").mkdir()
    (folder / "far" / "__init__.py").write_text("")
    (folder / "far" / "away.py").write_text("from . import beside\n")
    (folder / "far" / "beside.py").write_text("")
    (folder / "nested.py").write_text("one = 1\n")
    (folder / "stranger.py").write_text("")
    return folder


def hashed(text: str = "mine.py:explore") -> str:
    for name in ("near", "far", "far.away", "far.beside", "nested"):
        sys.modules.pop(name, None)
    return source_hash(targets(text))


@pytest.mark.parametrize(
    ("file", "counts"),
    [
        ("mine.py", True),
        ("near.py", True),
        ("far/__init__.py", True),
        ("far/away.py", True),
        ("far/beside.py", True),
        ("nested.py", True),
        ("stranger.py", False),
    ],
)
def test_what_a_mapper_imports_counts_and_nothing_else(
    package: Path, file: str, *, counts: bool
) -> None:
    before = hashed()
    assert hashed() == before
    with (package / file).open("a") as opened:
        opened.write("# changed\n")
    assert (hashed() != before) == counts


def test_a_module_in_a_package_is_hashed_with_its_package(package: Path) -> None:
    with (package / "far" / "away.py").open("a") as opened:
        opened.write("def explore(robot): ...\n")
    before = hashed("far.away:explore")
    assert before == hashed("far.away:explore")
    (package / "far" / "beside.py").write_text("# changed\n")
    assert before != hashed("far.away:explore")


def test_algorithms_of_the_catalogue_share_the_hash_of_topo_verify() -> None:
    assert source_hash(targets("basic")) == source_hash(targets("folding"))


def test_a_mapper_without_a_file_has_that_hash_too() -> None:
    def made(_robot: object) -> None: ...

    made.__module__ = "nowhere"
    assert source_hash([Target("made", made)]) == source_hash(targets("basic"))
