"""Darts, doors and percepts as they are named in lines of text.

    w1:4    a dart of the world and its vertex: vertex 1, dart 4, as the world file numbers them
    v2:7    a dart of S and its vertex: the third vertex that was discovered, dart 7

Percepts are short here: `5` is degree 5 with no marker, `5, marker 2` has the marker at door 2.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from topo_verify.checkers.darts import KnownDart, WorldDart
from topo_verify.player.scenes import Playback
from topo_verify.robot.percept import Door, Percept


def percept_words(percept: Percept | None) -> str:
    """A percept: its degree, and the door of the marker where the marker is."""
    if percept is None:
        return "nothing"
    marker = "" if percept.marker is None else f", marker {percept.marker}"
    return f"{percept.degree}{marker}"


def percept_in_brackets(percept: Percept | None) -> str:
    """A percept within a sentence: `(5, marker 2)`, or `nothing`."""
    return "nothing" if percept is None else f"({percept_words(percept)})"


def door_words(doors: Sequence[Door]) -> str:
    """Doors in the order in which they are taken: `doors 1 0 2`."""
    if not doors:
        return "no door"
    return f"door{'s' if len(doors) > 1 else ''} {' '.join(map(str, doors))}"


def world_place(playback: Playback, dart: WorldDart | None) -> str:
    """A dart of the world with its vertex; `?` where it is unknown."""
    if dart is None:
        return "?"
    return f"w{playback.world.vertex_of[dart]}:{dart}" if playback.world.alpha else "w0"


def map_place(playback: Playback, dart: KnownDart | None) -> str:
    """A dart of S with its vertex; `-` where S does not have the place."""
    return "-" if dart is None else f"v{playback.vertex(dart)}:{dart}"


def either_place(playback: Playback, known: KnownDart | None, dart: WorldDart | None) -> str:
    """A dart on S where S has it, else in the world."""
    return world_place(playback, dart) if known is None else map_place(playback, known)


def listed(things: Iterable[object], none: str = "none") -> str:
    """The things with commas; a long list is cut."""
    texts = [str(thing) for thing in things]
    if len(texts) > _MOST:
        texts = [*texts[:_MOST], f"and {len(texts) - _MOST} more"]
    return ", ".join(texts) or none


_MOST = 12
