"""The library in Coq, compiled once for all workers of pytest."""

from __future__ import annotations

import filecmp
import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

from tests.helpers import made_once
from topo_verify.proofs.mechanised import toolchain

EXTRACTED = Path(__file__).parent / "extracted"
"""Files that make programs of functions in Coq: of each an extraction, and a main program."""

LIMIT = 300.0
"""Seconds for each call of a program, on a machine that has other things to do."""


RARE = (pytest.mark.nightly, pytest.mark.rare)
"""For tests that only `make nightly` runs."""


def nowhere(_program: str) -> None:
    """In place of `shutil.which`: nothing is installed."""


@pytest.fixture(scope="session")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with all sources, compiled; skips where Coq is not installed."""
    if why := toolchain.missing():
        pytest.skip(why)
    return made_once(tmp_path_factory, "library", _compile)


def _compile(folder: Path) -> None:
    toolchain.copy_library(folder, toolchain.files())
    ran = toolchain.compile_all(folder, toolchain.files(), timeout=LIMIT)
    assert ran.accepted, ran.output


@pytest.fixture
def place(library: Path, tmp_path: Path) -> Path:
    """A folder of the test's own in which the compiled library lies."""
    for path in library.iterdir():
        if path.suffix in {".v", ".vo"}:
            (tmp_path / path.name).symlink_to(path)
    return tmp_path


@pytest.fixture
def linked(library: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A source of the library that is to be compiled, unchanged, is linked to its compiled file."""
    compile_all = toolchain.compile_all

    def link(folder: Path, names: Iterable[str], **options: Any) -> toolchain.ProgramRun:
        others: list[str] = []
        for name in names:
            compiled = library / f"{name}.vo"
            same = (toolchain.SOURCES / f"{name}.v", folder / f"{name}.v")
            if compiled.exists() and filecmp.cmp(*same, shallow=False):
                (folder / compiled.name).symlink_to(compiled)
            else:
                others.append(name)
        if not others:
            return toolchain.ProgramRun(accepted=True, output="")
        return compile_all(folder, others, **options)

    monkeypatch.setattr(toolchain, "compile_all", link)


def extracted(library: Path, folder: Path, name: str, main: str) -> Path:
    """The program of extracted/NAME.v and its main program, built in this folder.

    Skips where there is no compiler for it.
    """
    if shutil.which("ocamlfind") is None:
        pytest.skip("ocamlfind is not installed")
    for path in library.glob("*.vo"):
        (folder / path.name).symlink_to(path)
    for path in EXTRACTED.iterdir():
        shutil.copy(path, folder)
    ran = toolchain.compile_one(folder, name, timeout=LIMIT)
    assert ran.accepted, ran.output
    sources = [f"{name.lower()}.mli", f"{name.lower()}.ml", f"{main}.ml"]
    command = ["ocamlfind", "ocamlopt", "-w", "-a", *sources, "-o", "program"]
    ran = toolchain.run(command, folder, timeout=LIMIT)
    assert ran.accepted, ran.output
    return folder / "program"
