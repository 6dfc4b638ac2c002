"""`world draw`: the picture in a file, what is said about it, and bad names."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from topo_verify import World
from topo_verify.world.drawing import read_back

Call = Callable[..., Any]


def test_an_entry_has_the_promised_fields(results: Call, folder: Path) -> None:
    envelope = results("world draw 'family:king(3,3)' -o king.svg")
    assert envelope["format"] == "topo-verify/world-draw"
    assert envelope["results"] == [
        {
            "world": "king(3,3)", "file": "king.svg", "layout": "positions", "vertices": 9,
            "shown": 9, "bridges": 4, "text": None,
        }
    ]  # fmt: skip
    assert (folder / "king.svg").read_text().startswith("<svg ")


def test_without_a_file_the_svg_is_printed_and_is_true(call: Call) -> None:
    picture = read_back.read(call("world draw m3/14 --doors --darts").stdout)
    assert read_back.untruths(picture, World.from_id("m3/14")) == []


def test_doors_and_darts_are_written_beside_the_edges(call: Call) -> None:
    svg = call("world draw m2/0 --doors").stdout
    assert svg.count('class="tv-soft"') == 4
    assert ">0:3<" in call("world draw m2/0 --doors --darts").stdout


def test_the_marker_may_be_elsewhere(call: Call) -> None:
    assert call("world draw m2/0").stdout != call("world draw m2/0 --marker 3").stdout


@pytest.mark.parametrize("name", ["w.gif", "svg", ""])
def test_a_name_with_another_ending_is_refused(call: Call, name: str) -> None:
    done = call(f"world draw m2/0 -o '{name}'")
    assert done.exit_code == 2
    assert "expected a name that ends in .svg, .png, .pdf, .html" in done.stderr
