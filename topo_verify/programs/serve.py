"""A Python mapper behind protocol 1: `python -m topo_verify.programs.serve TARGET`.

For a mapper that should run in a process of its own (because it sits in C code, leaks, prints, or
must be stopped by force), and as a program to try the protocol with:

    topo-verify conform --cmd 'python -m topo_verify.programs.serve my_mapper.py:explore'

What the mapper prints goes to standard error. An exception ends the program.

Source: docs/semantics.md, section 15.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from typing import BinaryIO, cast

import msgspec

from topo_verify.errors import InputError
from topo_verify.programs import protocol as ms
from topo_verify.programs.loading import Mapper, load
from topo_verify.robot.events import Decision, MapData
from topo_verify.robot.percept import Door, Percept, Purpose
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.world.validation import map_parts, optional_part

CATALOGUE = "topo_verify.algorithms:CATALOGUE.{}"
"""Where a name without a colon is looked up: the algorithms are loaded by name, like any mapper."""

_told: msgspec.json.Decoder[ms.ToProgram] = msgspec.json.Decoder(ms.ToProgram)


class Distant:
    """The robot at the other end of the pipe. Lives as long as one world."""

    def __init__(self, percept: Percept, hear: BinaryIO, say: BinaryIO) -> None:
        self._percept, self._hear, self._say = percept, hear, say

    @property
    def percept(self) -> Percept:
        """What is sensed where the robot stands now."""
        return self._percept

    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:  # noqa: ARG002  not sent
        """Leave by a door; what is sensed behind it."""
        self._write(ms.MoveMessage(door))
        self._say.flush()
        message = _told.decode(self._hear.readline())
        if not isinstance(message, ms.PerceptMessage):
            raise InputError(f"a move was answered by {message!r}, not by a percept")
        self._percept = Percept(message.degree, message.marker)
        return self._percept

    def declare(self, event: Decision | Mapping[str, object]) -> None:
        """Put a decision on record."""
        self._write({"type": "declare", "event": event})

    def done(self, result: object) -> None:
        """Deliver what the mapper returned."""
        vertices, edges, marker = map_parts(result)
        delivered = MapData(tuple(map(tuple, vertices)), tuple(map(tuple, edges)), marker)
        cost = optional_part(result, "cost")
        self._write({"type": "done", "map": delivered, "cost": cost})
        self._say.flush()

    def _write(self, message: object) -> None:
        self._say.write(msgspec.json.encode(message) + b"\n")


def serve(mapper: Mapper, hear: BinaryIO, say: BinaryIO) -> None:
    """Play worlds until told to stop, or until nobody is there any more."""
    for line in hear:
        message = _told.decode(line)
        if not isinstance(message, ms.StartMessage):
            return
        robot = Distant(message.percept, hear, say)
        robot.done(mapper(cast("SimulatedRobot", robot)))  # it has all that a mapper may ask for


def main(text: str) -> None:
    """Serve the mapper that a TARGET names, on standard input and output."""
    say = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what the mapper prints is no message
    serve(load(text if ":" in text else CATALOGUE.format(text)), sys.stdin.buffer, say)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python -m topo_verify.programs.serve TARGET")
    try:
        main(sys.argv[1])
    except InputError as error:
        sys.exit(f"topo-verify: {error}")
