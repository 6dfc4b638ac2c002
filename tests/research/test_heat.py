"""The heat map is true to the world and to the costs; a wrong colour or place is seen."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest

from research import heat
from research.heat import colour, heat_map, heat_svg, untrue_colours
from topo_verify import InternalError, World, families
from topo_verify.pictures.drawing import Layout, read_back
from topo_verify.world.resolve import resolve_world

WORLD = World.from_id("m5/17")
COSTS = [7 + 3 * dart for dart in range(10)]
DRAWN = Path(__file__).parents[2] / "docs" / "heat.svg"


@pytest.mark.long
def test_the_picture_of_the_docs_is_what_the_script_draws() -> None:
    assert heat_map("nyc", "basic") == DRAWN.read_text(encoding="utf-8")


def test_the_heat_map_of_a_mapper_is_a_true_drawing_and_has_a_colour_a_dart() -> None:
    svg = heat_map("m5/17", "basic")
    assert read_back.untruths(read_back.read(svg), WORLD) == []
    assert svg.count("data-mean=") == len(WORLD.vertices)
    assert svg.count("data-dart=") == 9  # the arrow stands on the tenth
    assert "basic in m5/17: cost by place and direction of the marker" in svg


def test_there_is_no_heat_map_of_runs_that_fail() -> None:
    with pytest.raises(AssertionError, match="no-false-confirm"):
        heat_map("m2/5", "examples/undirected.py:undirected")


@pytest.mark.parametrize(
    "name",
    [
        "m1/0",
        "m1/1",
        "m5/17",
        "family:torus(3,4)",
        pytest.param("nyc", marks=pytest.mark.long),
        pytest.param("family:random_genus(12,2,seed=1)", marks=pytest.mark.long),
    ],
)
def test_every_kind_of_drawing_can_be_coloured(name: str) -> None:
    world = resolve_world(name)
    costs = [(7 * dart) % 31 for dart in range(len(world.alpha))]
    svg = heat_svg(world, costs, title="a mapper")
    assert svg == heat_svg(world, costs, title="a mapper")
    assert untrue_colours(svg, world, costs) == []


@pytest.mark.nightly
def test_of_a_large_world_the_part_that_is_shown_is_coloured() -> None:
    world = families.random_genus(900, 30, seed=1)
    costs = [dart % 97 for dart in range(len(world.alpha))]
    svg = heat_svg(world, costs, title="a mapper")
    assert "vertices are shown" in svg
    assert 0 < svg.count("data-mean=") < len(world.vertices)


def test_another_cost_is_seen() -> None:
    svg = heat_svg(WORLD, COSTS, title="a mapper")
    other = [*COSTS]
    other[5] += 9
    found = untrue_colours(svg, WORLD, other)
    assert f"the stroke of dart 5 shows another cost than {other[5]}" in found
    assert any("the disc of vertex" in line for line in found)


def test_a_stroke_at_another_place_is_seen() -> None:
    svg = heat_svg(WORLD, COSTS, title="a mapper")
    moved = re.sub(r'(data-dart="3"[^>]* d="M)', r"\g<1>1", svg)
    assert moved != svg
    assert "the stroke of dart 3 begins elsewhere" in untrue_colours(moved, WORLD, COSTS)


def test_a_wrong_picture_is_not_handed_out() -> None:
    strokes = heat._strokes  # pyright: ignore[reportPrivateUsage]

    def reversed_strokes(world: World, layout: Layout, costs: list[int], best: int) -> Any:
        return strokes(world, layout, costs[::-1], best)

    with (
        patch.object(heat, "_strokes", reversed_strokes),
        pytest.raises(InternalError, match=r"is not true: the stroke of dart \d shows another"),
    ):
        heat_svg(WORLD, COSTS, title="a mapper")


def test_the_arrow_is_on_the_best_dart_and_the_ring_around_the_worst() -> None:
    svg = heat_svg(WORLD, [*reversed(COSTS)], title="a mapper")
    drawn = {*map(int, re.findall(r'data-dart="(\d+)"', svg))}
    assert drawn == {*range(9)}  # the arrow covers dart 9
    ring = re.search(r'class="tv-mark" stroke-dasharray="[^"]*" cx="([^"]*)" cy="([^"]*)"', svg)
    vertex = re.search(rf'data-vertex="{WORLD.vertex_of[0]}" cx="([^"]*)" cy="([^"]*)"', svg)
    assert ring is not None
    assert vertex is not None
    assert ring.groups() == vertex.groups()


def test_colours_grow_lighter_and_end_at_the_ends() -> None:
    assert (colour(0), colour(1)) == ("#002051", "#fdea45")
    shades = [sum(bytes.fromhex(colour(k / 20)[1:])) for k in range(21)]
    assert shades == sorted(shades)


def test_a_title_from_anywhere_is_escaped() -> None:
    assert "<b>" not in heat_svg(WORLD, COSTS, title="<b>&\x1b")
