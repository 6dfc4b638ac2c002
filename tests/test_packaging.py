"""What is built and installed: exactly one import package, whole, with its data and its licence.

The sdist is built from the tree and the wheel from the sdist, the way an index or a distributor
would, without the network. What this does not show: that other build frontends do the same.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tarfile
import tomllib
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path, PurePosixPath
from typing import Any
from zipfile import ZipFile

import pytest

import topo_verify
from tests.python import python

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "topo_verify"
LINKED = ("algorithms", "strategies", "proofs")
"""Packages that also stand at the top of the repository, as links, from the day they exist."""


@dataclass(frozen=True)
class Built:
    """One sdist and the wheel that was built from it."""

    sdist: Path
    wheel: Path

    def sdist_names(self) -> set[str]:
        """The files in the sdist, without the folder that holds them all."""
        with tarfile.open(self.sdist) as archive:
            files = [PurePosixPath(entry.name) for entry in archive if entry.isfile()]
        return {str(PurePosixPath(*path.parts[1:])) for path in files}

    def wheel_names(self) -> set[str]:
        """The files in the wheel."""
        with ZipFile(self.wheel) as archive:
            return {name for name in archive.namelist() if not name.endswith("/")}

    def wheel_text(self, name: str) -> str:
        """The text of one file in the wheel."""
        with ZipFile(self.wheel) as archive:
            return archive.read(name).decode()


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Built:
    """Build the sdist from the tree and the wheel from the sdist, with what is installed."""
    out = tmp_path_factory.mktemp("dist")
    command = [sys.executable, "-m", "build", "--no-isolation", "--outdir", str(out), str(ROOT)]
    # The backend looks for its program on PATH; it was installed beside this Python.
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    done = subprocess.run(
        command, env={**os.environ, "PATH": path}, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, f"the build failed:\n{done.stdout}\n{done.stderr}"
    (sdist,), (wheel,) = out.glob("*.tar.gz"), out.glob("*.whl")
    return Built(sdist, wheel)


def project_table() -> dict[str, Any]:
    """The [project] table of pyproject.toml."""
    table: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    return table


def package_files() -> set[str]:
    """Every file of the package in the tree, modules and data, but no compiled leftovers."""
    return {
        path.relative_to(ROOT).as_posix()
        for path in PACKAGE.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts and path.suffix != ".pyc"
    }


def run_python(code: str, *, path: Path, cwd: Path) -> subprocess.CompletedProcess[str]:
    """Run a line of Python with `path` ahead of everything that is installed."""
    return python("-P", "-c", code, environment={"PYTHONPATH": str(path)}, cwd=cwd)


@pytest.mark.long
def test_the_wheel_installs_one_top_level_name(built: Built) -> None:
    tops = {name.split("/")[0] for name in built.wheel_names()}
    assert tops == {"topo_verify", f"topo_verify-{topo_verify.__version__}.dist-info"}


def test_the_wheel_holds_the_data_and_the_type_marker(built: Built) -> None:
    inside = {name for name in built.wheel_names() if name.startswith("topo_verify/")}
    assert inside == package_files()
    assert "topo_verify/py.typed" in inside
    assert any(name.startswith("topo_verify/world/data/") for name in inside)


def test_the_sdist_holds_the_package_and_what_building_it_needs(built: Built) -> None:
    needed = {"pyproject.toml", "README.md", "LICENSE"}
    assert built.sdist_names() >= package_files() | needed
    assert not [name for name in built.sdist_names() if name.split("/")[0] in LINKED]


def test_the_licence_travels_with_both(built: Built) -> None:
    licence = (ROOT / "LICENSE").read_text()
    inside = f"topo_verify-{topo_verify.__version__}.dist-info/licenses/LICENSE"
    assert built.wheel_text(inside) == licence
    assert "Version 2.0, January 2004" in licence
    assert "LICENSE" in built.sdist_names()


def test_the_wheel_starts_the_command(built: Built) -> None:
    inside = f"topo_verify-{topo_verify.__version__}.dist-info/entry_points.txt"
    assert "topo-verify = topo_verify.cli:main" in built.wheel_text(inside)


def test_the_wheel_works_on_its_own(built: Built, tmp_path: Path) -> None:
    site = tmp_path / "site"
    with ZipFile(built.wheel) as archive:
        archive.extractall(site)
    done = run_python("import topo_verify; print(topo_verify.__file__)", path=site, cwd=tmp_path)
    assert done.stdout.strip() == str(site / "topo_verify" / "__init__.py"), done.stderr


@pytest.mark.long
def test_the_command_of_the_wheel_works_on_its_own(built: Built, tmp_path: Path) -> None:
    site = tmp_path / "site"
    with ZipFile(built.wheel) as archive:
        archive.extractall(site)
    for line in ("--help", "explore m2/8 --target folding", "world draw m2/8 -o world.svg"):
        code = f"from topo_verify.cli import main; main({line.split()!r})"
        done = run_python(code, path=site, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "world.svg").exists()


def test_the_sdist_holds_tests_docs_and_examples(built: Built) -> None:
    names = built.sdist_names()
    assert names >= {
        *("Makefile", "CHANGELOG.md", "CITATION.cff", "CONTRIBUTING.md", "constraints.txt"),
        "action.yml",
        *(".ci/run", "docs/conf.py", "docs/gallery/m2-8.svg", "docs/site/glossary.py"),
        *("tests/test_packaging.py", "tests/data/golden.json", "examples/mapper_c/mapper.c"),
        *("examples/own_mapper/mapper.py", "benchmarks/run.py"),
    }


def test_the_sdist_holds_every_page_and_no_leftovers(built: Built) -> None:
    names = built.sdist_names()
    pages = {page.relative_to(ROOT).as_posix() for page in (ROOT / "docs").rglob("[!_]*.md")}
    assert pages <= names
    left = {"build", "dist", ".venv", "__pycache__", ".hypothesis", ".git"}
    assert not [name for name in names if left & set(name.split("/")) or name.endswith(".pyc")]


@pytest.mark.long
def test_the_tests_in_the_sdist_run_where_it_is_unpacked(built: Built, tmp_path: Path) -> None:
    with tarfile.open(built.sdist) as archive:
        archive.extractall(tmp_path, filter="data")
    (folder,) = tmp_path.iterdir()
    tests = ["tests/docs", "tests/world/test_io.py", "-k", "not window"]  # no browser needed
    line = ("-m", "pytest", "-q", "-p", "no:cacheprovider", "-n", "0", *tests)
    done = python(*line, "-m", "not (nightly or long)", cwd=folder)
    assert done.returncode == 0, done.stdout


def test_the_four_versions_are_one() -> None:
    assert topo_verify.__version__ == project_table()["version"]
    assert f"\nversion: {topo_verify.__version__}\n" in (ROOT / "CITATION.cff").read_text()
    assert metadata.version("topo-verify") == topo_verify.__version__


def test_no_python_is_named_that_is_not_supported() -> None:
    table = project_table()
    assert table["requires-python"] == ">=3.11"
    minors = [line.rpartition(" 3.")[2] for line in table["classifiers"] if " :: 3." in line]
    assert minors == sorted(minors)
    assert minors[0] == "11"


def test_the_constraints_name_versions_and_no_registry() -> None:
    lines = (ROOT / "constraints.txt").read_text().splitlines()
    pins = [line for line in lines if line and not line.startswith("#")]
    assert pins
    assert all("==" in line.split(";")[0] for line in pins)
    assert not [line for line in lines if "://" in line or line.startswith("-") or "@" in line]


@pytest.mark.parametrize("name", LINKED)
def test_a_root_link_stands_exactly_where_its_package_does(name: str) -> None:
    link = ROOT / name
    if (ROOT / "PKG-INFO").exists():
        pytest.skip("an unpacked sdist has no links: nothing but the repository does")
    if not (PACKAGE / name / "__init__.py").exists():
        assert not link.is_symlink(), f"{link} points at a package that does not exist"
        return
    assert link.is_symlink(), f"make it: ln -s topo_verify/{name} {name}"
    assert link.readlink() == Path("topo_verify", name)


@pytest.mark.parametrize(
    "name", [name for name in LINKED if (PACKAGE / name / "__init__.py").exists()]
)
def test_a_linked_package_refuses_a_second_name(name: str, tmp_path: Path) -> None:
    code = f"try:\n import {name}\nexcept ImportError as refusal:\n print(refusal)"
    done = run_python(code, path=ROOT, cwd=tmp_path)
    assert f"topo_verify.{name}" in done.stdout, done.stderr or "it was imported twice"
