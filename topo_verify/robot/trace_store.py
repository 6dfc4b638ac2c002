"""Moves kept compactly: a run repeats a few different moves a great many times.

How many different ones there are depends on the degrees in a world, not on the length of the run.
So equal moves are one immutable object, and a trace takes eight bytes for each.
"""

from __future__ import annotations

from functools import lru_cache

from topo_verify.robot.events import Move
from topo_verify.robot.percept import Door, Percept, Purpose


@lru_cache(maxsize=2**16)
def move(door: Door, percept: Percept, purpose: Purpose | None) -> Move:
    """The one `Move` with these fields, as long as it is remembered; else an equal one."""
    return Move(door, percept, purpose)
