"""What a robot senses at a vertex, and by which doors it can leave.

The robot stands at a vertex with a **reference dart**, by which it came in (at the start: the
marked dart). It senses the degree of the vertex and, where the marker lies, its direction. It
leaves by a **door**: door k is the k-th exit clockwise after the reference dart, so door 0 goes
back. Nothing else of the world is ever visible.

Source: docs/semantics.md, section 2.
"""

from __future__ import annotations

from typing import Annotated, Literal, get_args

import msgspec

from topo_verify.world.validation import Number

Door = Number
"""0 … degree-1, counted clockwise from the reference dart."""

Purpose = Literal["walk", "cross", "validate", "retrace"]
"""What a mapper says a move is for; recorded, never needed."""

PURPOSES: tuple[Purpose, ...] = get_args(Purpose)

MOST_DOORS = 1_000_000
"""The highest degree read from a file: a fold takes memory for every door."""


class Percept(msgspec.Struct, frozen=True, gc=False):
    """What is sensed at a vertex, relative to the reference dart.

    Attributes:
        degree: the number of doors.
        marker: the door that the marker points at, or None if the marker is not here.
    """

    degree: Annotated[int, msgspec.Meta(ge=0, le=MOST_DOORS)]
    marker: Door | None

    @property
    def signature(self) -> tuple[int, bool]:
        """The degree, and whether the marker is here: equal for all reference darts."""
        return self.degree, self.marker is not None

    def is_like(self, other: Percept) -> bool:
        """Whether the signatures are equal; called for each move of a long log, so makes none."""
        return self.degree == other.degree and (self.marker is None) == (other.marker is None)

    def __str__(self) -> str:
        marker = "no marker" if self.marker is None else f"marker at door {self.marker}"
        return f"(degree {self.degree}, {marker})"
