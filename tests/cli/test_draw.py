"""`world draw`: the picture in a file, what is said about it, and bad names."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from topo_verify import World
from topo_verify.world.drawing import choice, read_back

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


def test_the_part_that_is_shown_of_a_large_world_may_be_around_any_vertex(
    call: Call, results: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(choice, "READABLE", 20)  # it counts as large here
    monkeypatch.setattr(choice, "LIMIT", 30)
    line = "world draw family:random_planar(60,seed=1)"
    (entry,) = results(line)["results"]
    assert (entry["layout"], entry["shown"] < entry["vertices"]) == ("ball", True)
    vertices = [f'data-vertex="{vertex}"' for vertex in range(entry["vertices"])]
    hidden = next(k for k, vertex in enumerate(vertices) if vertex not in entry["text"])
    assert vertices[hidden] in call(f"{line} --around {hidden}").stdout


def test_a_vertex_that_is_not_there_is_refused(call: Call) -> None:
    done = call("world draw m3/14 --around 99")
    assert (done.exit_code, done.stdout) == (2, "")
    assert "--around 99: expected a vertex of the world, 0 … " in done.stderr
    assert "shown whole" in call("world draw m3/14 --around 0").stderr


@pytest.mark.parametrize("name", ["w.gif", "svg", ""])
def test_a_name_with_another_ending_is_refused(call: Call, name: str) -> None:
    done = call(f"world draw m2/0 -o '{name}'")
    assert done.exit_code == 2
    assert "expected a name that ends in .svg, .png, .pdf, .html" in done.stderr
