"""Door words: the doors that a robot takes on a walk through a world.

    strategy     draws                                       its simplest value
    door_words   doors that a robot can take one after the   (): it stays where it is
                 other, beginning at the marker

They are for tests of robots, charts and traces that need a walk but no mapper.
"""

from __future__ import annotations

from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from topo_verify.errors import InputError
from topo_verify.robot.percept import Door
from topo_verify.robot.simulator import exit_dart
from topo_verify.strategies.draws import draw_bytes
from topo_verify.strategies.naming import shown_as_called
from topo_verify.strategies.shapes import LARGEST, integer
from topo_verify.world.rooted_map import World


@shown_as_called
def door_words(
    world: World, *, min_length: int = 0, max_length: int = 100
) -> SearchStrategy[tuple[Door, ...]]:
    """Sequences of doors, each less than the degree of the vertex that it leads out of.

    Shrinks to few doors, then to low ones: door 0 goes back. (At a vertex of degree above 256 only
    the first 256 doors are drawn.)

    Args:
        world: where the robot walks; it begins at the marker.
        min_length, max_length: the number of doors.
    Raises:
        InputError: a length is out of range, or the world has no door and `min_length` is above 0.
    Example:
        >>> from hypothesis import find
        >>> find(door_words(World.from_id("m2/0"), min_length=2), lambda doors: True)
        (0, 0)
    """
    least = integer("door_words", "min_length", min_length)
    most = integer("door_words", "max_length", max_length)
    if not least <= most <= LARGEST:
        raise InputError(
            f"door_words: min_length={least}, max_length={most}, expected"
            f" min_length <= max_length <= {LARGEST}"
        )
    if not world.alpha:
        if least:
            raise InputError(
                f"door_words: expected min_length=0 in a world without doors, got {least}"
            )
        most = 0
    return _door_words(world, least, most)


@st.composite
def _door_words(draw: st.DrawFn, world: World, least: int, most: int) -> tuple[Door, ...]:
    doors: list[Door] = []
    at = world.root or 0
    for byte in draw_bytes(draw, least, most):
        # Modulo the degree of the vertex at hand, so every string of bytes is a walk.
        doors.append(byte % world.degrees[world.vertex_of[at]])
        at = world.alpha[exit_dart(world, at, doors[-1])]
    return tuple(doors)
