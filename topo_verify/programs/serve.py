"""A Python mapper behind protocol 1, in its own process.

The command line starts one for mappers outside the catalogue (foreign.py), which says more than the
protocol can. As a program it speaks protocol 1 alone; an exception ends it:

    topo-verify conform --cmd 'python -m topo_verify.programs.serve my_mapper.py:explore'
"""

from __future__ import annotations

import faulthandler
import os
import signal
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from io import TextIOWrapper
from operator import index
from typing import BinaryIO, Literal, NoReturn, cast

import msgspec

from topo_verify.errors import InputError
from topo_verify.programs import isolation, loaded
from topo_verify.programs import protocol as ms
from topo_verify.programs.delivery import Undelivered, deliver, finish_of, stop_text
from topo_verify.programs.library import LIBRARY, Skipped
from topo_verify.programs.loader import Mapper, load, prepare
from topo_verify.robot.events import Decision
from topo_verify.robot.limits import MapperStopped
from topo_verify.robot.percept import Door, Percept, Purpose
from topo_verify.robot.simulator import Misuse, door_number, plain_decision, require_purpose
from topo_verify.robot.stopwatch import tasks_of

CATALOGUE = "topo_verify.algorithms:NAMED.{}"
"""The place of a name without a colon, as text, since programs/ imports no algorithms."""

_to_child: msgspec.json.Decoder[ms.ToChild] = msgspec.json.Decoder(ms.ToChild)
_encode = msgspec.json.Encoder(enc_hook=index).encode


WHERE = signal.SIGUSR2
"""The signal upon which a child of `Foreign` writes its frames to the harness."""

WORDS = 100_000
"""Most characters of an explanation that are sent."""


class RemoteRobot:
    """The robot at the other end of the pipe, for one world.

    Attributes:
        misuse: how the mapper misused the robot, which then never moves again, or None.
    """

    __slots__ = ("_is_under_way", "_over", "_percept", "_reader", "_writer", "misuse")

    def __init__(self, percept: Percept, reader: BinaryIO, writer: BinaryIO) -> None:
        self._percept, self._reader, self._writer = percept, reader, writer
        self.misuse: tuple[Literal["bad-door", "bad-declaration"], Misuse] | None = None
        self._over: MapperStopped | None = None
        self._is_under_way = False  # a move was begun, and its percept has not come

    def __getattr__(self, name: str) -> NoReturn:
        raise AttributeError(f"the robot has percept, move and declare, but no {name!r}")

    @property
    def percept(self) -> Percept:
        """The percept of the robot's vertex."""
        return self._percept

    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:
        """Leave by a door; return the percept behind it."""
        self._require_usable()
        try:
            number = door_number(door, self._percept.degree)
            require_purpose(purpose)
        except Misuse as why:
            self.misuse = ("bad-door", why)
            raise
        # An exception (recursion limit, signal handler) may strike anywhere below. Then this robot
        # does not know whether it moved, and `serve` skips the percept that may come yet.
        self._is_under_way = True
        _send(self._writer, ms.MoveMessage(number, purpose))
        line = self._reader.readline()
        if not line:
            raise MapperStopped("the harness is gone")
        message = _to_child.decode(line)
        if isinstance(message, ms.OverMessage):
            self._over = MapperStopped("the harness has ended the world")
            raise self._over
        if not isinstance(message, ms.PerceptMessage):
            raise InputError(f"expected a percept in answer to a move, got {message!r}")
        self._percept = Percept(message.degree, message.marker)
        self._is_under_way = False
        return self._percept

    def declare(self, event: Decision | Mapping[str, object]) -> None:
        """Declare a decision; it is sent with the next move."""
        self._require_usable()
        try:
            message = ms.DeclareMessage(plain_decision(event))
        except Misuse as why:
            self.misuse = ("bad-declaration", why)
            raise
        self._writer.write(_encode(message) + b"\n")

    def _require_usable(self) -> None:
        if self.misuse is not None:
            raise self.misuse[1]
        if self._over is not None:
            raise self._over
        if self._is_under_way:
            raise MapperStopped("an exception interrupted robot.move: the robot does not go on")


LATE = ms.OverMessage | ms.PerceptMessage
"""Messages of a world that may come after the mapper has ended it."""

Player = Callable[[Mapper, RemoteRobot], object]
"""Plays one world; returns the message that ends it."""


def serve(
    mapper: Mapper, reader: BinaryIO, writer: BinaryIO, play: Player, values: str = ""
) -> None:
    """Play worlds until a `stop` message or the end of the input."""
    for line in reader:
        message = _to_child.decode(line)
        if isinstance(message, ms.StartMessage):
            answer = play(mapper, RemoteRobot(message.percept, reader, writer))
        elif isinstance(message, ms.StockMessage):
            answer = _listed(values)
        elif isinstance(message, LATE):
            continue
        else:
            return
        with suppress(OSError, ValueError):
            sys.stdout.flush()
        _send(writer, answer)


def _send(writer: BinaryIO, message: object) -> None:
    writer.write(_encode(message) + b"\n")
    writer.flush()


def _listed(values: str) -> ms.FromStock:
    try:
        return ms.LoadedMessage(loaded.loaded(values))
    except InputError as error:
        return ms.RefusedMessage(_words(str(error)))


def _as_program(mapper: Mapper, robot: RemoteRobot) -> object:
    result = mapper(robot)
    if robot.misuse is not None:
        raise robot.misuse[1]
    finish = finish_of(result)
    return ms.DoneMessage(finish.map, finish.cost)


def _as_child(mapper: Mapper, robot: RemoteRobot) -> object:
    """Play for `Foreign`; the answer says why the mapper delivers no map."""
    try:
        result = deliver(mapper, robot, alone=True)
    except Skipped as stop:
        return ms.UndeliveredMessage("skip", _words(str(stop)))
    except MapperStopped as stop:
        result = Undelivered(str(stop))
    if robot.misuse is not None:
        kind, misuse = robot.misuse
        return ms.UndeliveredMessage(kind, _words(stop_text(misuse)))
    if isinstance(result, Undelivered):
        return ms.UndeliveredMessage(result.kind, _words(result.why))
    return ms.DoneMessage(result.map, result.cost)


def _words(text: str) -> str:
    return text[:WORDS].encode(errors="backslashreplace").decode()


def main(text: str) -> None:
    """Serve the mapper of a TARGET over protocol 1 alone."""
    reader, writer = isolation.private_pipes()
    serve(load(text if ":" in text else CATALOGUE.format(text)), reader, writer, _as_program)


def child(text: str) -> None:
    """Serve the mapper of a TARGET for `Foreign`."""
    _reset_signals()
    loaded.watch()
    reader, writer = isolation.private_pipes()
    cast("TextIOWrapper", sys.stdout).reconfigure(line_buffering=True)
    if not text.startswith(LIBRARY):  # below a library's function stand lines of ours alone
        faulthandler.enable()
        faulthandler.register(WHERE, writer, all_threads=False)
    try:
        mapper = load(text)
    except InputError as error:
        _send(writer, ms.RefusedMessage(_words(str(error))))
        return
    values = loaded.values_hash(mapper)  # before it runs and changes a default
    _send(writer, ms.ReadyMessage())
    serve(mapper, reader, writer, _as_child, values)


def _reset_signals() -> None:
    """Let SIGINT end this process: as an exception it would be the mapper's."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)  # a mapper in the parent may have it ignored


# ---------------------------------------------------------------- a process for each world


def fresh(text: str, once: str = "") -> None:
    """Serve the mapper of a TARGET for `Foreign`, each world in a process that has played none.

    It loads the mapper, and each world is played in a fork, which takes some milliseconds; a new
    Python takes a few hundred. With several threads, which a fork would lack, or if `once`, this
    process plays one world and ends. A library is loaded in each fork, since it forbids to fork.
    If a signal ends a fork, this process ends itself by the same.

    What this does not show: that an earlier world left nothing on the disk, in the environment or
    in a file that was opened while the mapper was loaded.
    """
    _reset_signals()
    reader, writer = isolation.private_pipes()
    native = text.startswith(LIBRARY)
    if native:
        with suppress(InputError):
            prepare(text)
    play = None if native else _loaded(text)
    _send(writer, ms.ReadyMessage())
    for line in reader:
        message = _to_child.decode(line)
        if isinstance(message, LATE):
            continue
        if not isinstance(message, ms.StartMessage):
            return
        here = once or len([*tasks_of(os.getpid())]) > 1
        if not here and (fork := os.fork()):
            _, status = os.waitpid(fork, 0)
            _end_likewise(os.waitstatus_to_exitcode(status))
            continue
        code = 1
        try:
            robot = RemoteRobot(message.percept, reader, writer)
            _send(writer, (play or _loaded(text))(robot))
            code = 0
        finally:
            os._exit(code)


def _loaded(text: str) -> Callable[[RemoteRobot], object]:
    """What plays a world with the mapper; if it cannot be loaded, the answer to each says why."""
    try:
        return partial(_as_child, load(text))
    except InputError as error:
        refusal = ms.UndeliveredMessage("no-map", _words(str(error)))
        return lambda _robot: refusal


def _end_likewise(code: int) -> None:
    """End this process as the fork ended, unless that was done with its world."""
    if code < 0:
        signal.signal(-code, signal.SIG_DFL) if -code != signal.SIGKILL else None
        os.kill(os.getpid(), -code)
    elif code > 0:
        os._exit(code)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python -m topo_verify.programs.serve TARGET")
    try:
        main(sys.argv[1])
    except InputError as error:
        sys.exit(f"topo-verify: {error}")
