"""Every file of examples/ is run by a test: a table says which; a new file needs its line."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.python import python

ROOT = Path(__file__).resolve().parents[2]

RUN_BY = {
    "first_look.ipynb": ("tests/examples/test_first_look.py", "first_look.ipynb"),
    "github-workflow.yml": ("tests/examples/test_pytest_plugin.py", "github-workflow.yml"),
    "mapper_c/mapper.c": ("tests/studies/conform/test_conform.py", '"mapper_c" / "mapper.c"'),
    "mapper_js/mapper.js": ("tests/studies/conform/test_conform.py", '"mapper_js" / "mapper.js"'),
    "mapper_python/mapper.py": ("tests/studies/conform/test_conform.py", "'mapper.py'"),
    "mapper_python/short.py": ("tests/studies/conform/test_conform.py", "'short.py'"),
    "mapper_python/test_mapper.py": ("tests/examples/test_every_example.py", "mapper_folder"),
    "mapper_python/wrong.py": ("tests/studies/conform/test_conform.py", "'wrong.py'"),
    "native_c/mapper.c": ("docs/tutorials/native.md", "examples/native_c/mapper.c"),
    "native_c/in_gdb.py": ("tests/programs/test_library.py", '"native_c" / "in_gdb.py"'),
    "native_numba/mapper.py": (
        "tests/extra/fast/test_functions.py",
        '"native_numba" / "mapper.py"',
    ),
    "native_rust/mapper.rs": ("tests/programs/test_library.py", '"native_rust" / "mapper.rs"'),
    "own_mapper/declared.py": ("docs/start/find-a-mistake.md", "own_mapper/declared.py:explore"),
    "own_mapper/mapper.py": ("docs/start/find-a-mistake.md", "own_mapper/mapper.py:explore"),
    "own_mapper/mended.py": ("docs/start/find-a-mistake.md", "own_mapper/mended.py:explore"),
    "property_test/my_mapper.py": ("tests/examples/test_property_test.py", '"property_test"'),
    "property_test/test_my_mapper.py": ("tests/examples/test_property_test.py", "test_my_mapper"),
    "pytest_plugin/test_mapper.py": ("tests/examples/test_pytest_plugin.py", "test_mapper.py"),
    "undirected.py": ("docs/search.md", "examples/undirected.py:undirected --class"),
    "wrong_mappers.py": ("docs/replay.md", "--target examples/wrong_mappers.py:a"),
}
"""Each example, with the test that runs it, or the page whose commands a test runs, and where."""


def test_every_example_is_run_by_a_test() -> None:
    examples = ROOT / "examples"
    files = {
        path.relative_to(examples).as_posix()
        for path in examples.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert files == RUN_BY.keys()
    for example, (place, text) in RUN_BY.items():
        assert text in (ROOT / place).read_text(encoding="utf-8"), example


def test_the_quiet_mapper_is_the_declared_one_without_its_declarations() -> None:
    quiet, declared = (
        (ROOT / "examples" / "own_mapper" / name).read_text(encoding="utf-8").splitlines()
        for name in ("mapper.py", "declared.py")
    )
    more = [line.strip() for line in declared if line not in quiet]
    spoken = ("self.say(", "def say(", "self.robot.declare(", "why = ", "kind = ", '"""A first')
    changed = (
        "end = next((h for h in alike if self.leads_home(e, h)",
        "def leads_home(self, e, h)",
    )
    assert not [line for line in more if not line.startswith(spoken + changed)]
    assert sum("self.say(" in line for line in declared) == 4


@pytest.mark.long
def test_the_pytest_file_beside_the_python_mapper_passes(tmp_path: Path) -> None:
    mapper_folder = shutil.copytree(ROOT / "examples" / "mapper_python", tmp_path / "a")
    line = ("-m", "pytest", "-q", "-p", "no:cacheprovider", "--hypothesis-profile=topo")
    done = python(*line, "test_mapper.py", cwd=mapper_folder)
    assert done.returncode == 0, done.stdout
    assert "1 passed" in done.stdout
