"""docs/formats.md shows what the commands print and what its Python does."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from topo_verify.cli import main

PAGE = (Path(__file__).parents[3] / "docs" / "formats.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ["cube.pc", "town.graphml", "crossing.net.xml"])
def test_the_examples_print_what_the_page_shows(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    found = re.search(rf"`{re.escape(name)}`.*?```xml\n(.*?)```", PAGE, re.DOTALL)
    if found:
        Path(name).write_text(found[1])
    else:
        line = ["world", "convert", "family:cube()", "--to", "planar_code", "-o", name]
        assert CliRunner().invoke(main, line).exit_code == 0
    shown = re.search(
        rf"\$ topo-verify world convert {re.escape(name)}\n(.*?)\n```", PAGE, re.DOTALL
    )
    assert shown is not None
    assert CliRunner().invoke(main, ["world", "convert", name]).stdout == shown[1] + "\n"


def test_the_node_link_json_of_the_page_is_what_is_printed() -> None:
    line = "topo-verify world convert m4/41 --to nx-json"
    printed = CliRunner().invoke(main, line.split()[1:]).stdout
    assert f"$ {line}\n{printed}```" in PAGE


def test_the_python_of_the_page_runs() -> None:
    *_, last = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    names: dict[str, object] = {}
    exec(last, names)  # noqa: S102  the page's own example
    assert repr(names["world"]) == "tv.World.from_id('m2/3')"
