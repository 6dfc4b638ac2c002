"""A Python mapper behind protocol 1: `python -m topo_verify.programs.serve TARGET`.

Use this for a mapper that needs a process of its own, because it blocks in C code, leaks memory,
prints, or must be stopped by force; and for a program to try the protocol with:

    topo-verify conform --cmd 'python -m topo_verify.programs.serve my_mapper.py:explore'

The mapper's prints go to standard error. An exception ends the program.

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
from topo_verify.programs.loader import Mapper, load
from topo_verify.robot.events import Decision, MapData
from topo_verify.robot.percept import Door, Percept, Purpose
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.world.validation import map_parts, optional_part

CATALOGUE = "topo_verify.algorithms:CATALOGUE.{}"
"""The place of a name without a colon. Loaded by text, since programs/ imports no algorithms."""

_to_program: msgspec.json.Decoder[ms.ToProgram] = msgspec.json.Decoder(ms.ToProgram)


class RemoteRobot:
    """The robot at the other end of the pipe. Lives as long as one world."""

    def __init__(self, percept: Percept, reader: BinaryIO, writer: BinaryIO) -> None:
        self._percept, self._reader, self._writer = percept, reader, writer

    @property
    def percept(self) -> Percept:
        """The percept of the robot's vertex."""
        return self._percept

    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:  # noqa: ARG002  not sent
        """Leave by a door; the percept behind it."""
        self._write(ms.MoveMessage(door))
        self._writer.flush()
        message = _to_program.decode(self._reader.readline())
        if not isinstance(message, ms.PerceptMessage):
            raise InputError(f"expected a percept in answer to a move, got {message!r}")
        self._percept = Percept(message.degree, message.marker)
        return self._percept

    def declare(self, event: Decision | Mapping[str, object]) -> None:
        """Declare a decision; it is sent with the next move."""
        self._write({"type": "declare", "event": event})

    def done(self, result: object) -> None:
        """Deliver the result of the mapper."""
        vertices, edges, marker = map_parts(result)
        delivered = MapData(tuple(map(tuple, vertices)), tuple(map(tuple, edges)), marker)
        cost = optional_part(result, "cost")
        self._write({"type": "done", "map": delivered, "cost": cost})
        self._writer.flush()

    def _write(self, message: object) -> None:
        self._writer.write(msgspec.json.encode(message) + b"\n")


def serve(mapper: Mapper, reader: BinaryIO, writer: BinaryIO) -> None:
    """Play worlds until a `stop` message or the end of the input."""
    for line in reader:
        message = _to_program.decode(line)
        if not isinstance(message, ms.StartMessage):
            return
        robot = RemoteRobot(message.percept, reader, writer)
        robot.done(mapper(cast("SimulatedRobot", robot)))  # it has all that a mapper may use


def main(text: str) -> None:
    """Serve the mapper of a TARGET on standard input and output."""
    # Move the pipe away from descriptor 1, where a mapper's prints would mix with the messages.
    writer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    serve(load(text if ":" in text else CATALOGUE.format(text)), sys.stdin.buffer, writer)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python -m topo_verify.programs.serve TARGET")
    try:
        main(sys.argv[1])
    except InputError as error:
        sys.exit(f"topo-verify: {error}")
