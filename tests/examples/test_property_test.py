"""The first property test of docs/property-tests.md, run as its readers will run it."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from tests.python import python

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples" / "property_test"
PYTEST = ("-m", "pytest", "-q", "-p", "no:cacheprovider", "--hypothesis-profile=topo-ci")
PAGE = (ROOT / "docs" / "property-tests.md").read_text()


def test_the_page_shows_the_example_as_it_is() -> None:
    blocks = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    assert (EXAMPLE / "test_my_mapper.py").read_text() == blocks[0]


@pytest.mark.long
@pytest.mark.parametrize(("arguments", "world"), [("", "m1/1"), (", simple=True", "m3/13")])
def test_it_fails_with_the_world_that_the_page_says(
    arguments: str, world: str, tmp_path: Path
) -> None:
    shutil.copytree(EXAMPLE, tmp_path, dirs_exist_ok=True)
    test = tmp_path / "test_my_mapper.py"
    test.write_text(test.read_text().replace("max_edges=30", f"max_edges=30{arguments}"))
    done = python(*PYTEST, test, cwd=tmp_path)
    assert done.returncode == 1
    assert f"world=tv.World.from_id('{world}')" in done.stdout
    assert f"again: topo-verify replay {world} --target my_mapper:explore" in done.stdout
    assert f"World.from_id('{world}')" in done.stdout
    assert f"`{world}`" in PAGE


@pytest.mark.long
def test_the_other_tests_of_the_page_pass(tmp_path: Path) -> None:
    blocks = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)[1:]
    (conftest,) = (block for block in blocks if "load_profile" in block)
    (tmp_path / "conftest.py").write_text(conftest)
    blocks.remove(conftest)
    for number, block in enumerate(blocks):
        (tmp_path / f"test_{number}.py").write_text(block)
    done = python(*PYTEST, tmp_path, cwd=tmp_path)
    assert f"{len(blocks)} passed" in done.stdout, done.stdout
