"""What every picture of a world must be: true to the world, read back from its finished SVG."""

from __future__ import annotations

from topo_verify.pictures.drawing import Layout, lay_out, read_back, to_svg
from topo_verify.world.rooted_map import Dart, World


def drawn(world: World, *, centre: Dart | None = None) -> Layout:
    """The layout of the world, once its picture is found to be true.

    It has no crossing that is not a bridge, and none at all in planar drawings and in cells.
    """
    layout = lay_out(world, centre=centre)
    picture = read_back.read(to_svg(world, layout))
    assert read_back.untruths(picture, world) == [], repr(world)
    flat = world.is_planar or layout.kind in ("planar", "cell")
    assert not (layout.bridges and flat), repr(world)
    shown = set(range(len(world.vertices))) - layout.hidden
    assert picture.circles.keys() == shown
    assert bool(layout.hidden) == (layout.kind == "ball")
    return layout
