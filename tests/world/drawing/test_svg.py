"""The marker in a picture: an arrow that can be seen."""

from __future__ import annotations

import re

import pytest

from topo_verify.world.rooted_map import World

pytestmark = pytest.mark.no_cover  # drawing is not trusted: it is left out of the measure


@pytest.mark.parametrize("name", ["m1/0", "m2/5", "m2/8"])
def test_the_arrow_is_half_as_long_as_a_vertex_is_wide_or_longer(name: str) -> None:
    svg = World.from_id(name).draw()
    world = World.from_id(name)
    circle = rf'data-vertex="{world.vertex_of[world.root or 0]}" cx="(\S+)" cy="(\S+)" r="(\S+)"'
    place = re.search(circle, svg)
    tip = re.search(r'class="tv-tip" d="M\S+ [^L]+L(\S+) ([^L]+)L', svg)
    assert place is not None
    assert tip is not None
    x, y, radius = map(float, place.groups())
    across = ((float(tip[1]) - x) ** 2 + (float(tip[2]) - y) ** 2) ** 0.5
    assert across - radius >= radius
