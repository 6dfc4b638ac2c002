"""A user's Python mapper in its own process: a `Program` that we serve.

    with Foreign("my_mapper.py:explore") as mapper:
        report = examine(mapper.target, world)

When a limit stops the robot, the mapper's next move raises. If the mapper then ends in time, its
process (serve.py) plays the next world.

What this does not show: that exceptions, prints, `loaded` and the line of a hang, the child's own
words, are true.
"""

from __future__ import annotations

import os
import re
from typing import ClassVar, TypeVar

import msgspec

from topo_verify.errors import HelperLost, InputError, plural
from topo_verify.programs import protocol as ms
from topo_verify.programs.child import Child, Ended, ReaperProcess, Silent, TooLong
from topo_verify.programs.delivery import users_line
from topo_verify.programs.isolation import python_command
from topo_verify.programs.library import LIBRARY, library_file
from topo_verify.programs.loaded import Loaded
from topo_verify.programs.loader import Target
from topo_verify.programs.misbehaviour import Misbehaved, crash_report, decoded
from topo_verify.programs.program import Program
from topo_verify.programs.serve import WHERE
from topo_verify.robot.events import Finish, Robot
from topo_verify.robot.limits import Limits, MapperStopped, helped_by, within
from topo_verify.robot.simulator import SimulatedRobot

T = TypeVar("T")

LOADING = 120.0
"""Seconds for the import of a mapper."""

UNWINDING = Limits(move_timeout=1.0, world_timeout=1.0)
"""How long a mapper has to end a world in which its robot was stopped."""

SANITIZER = "; -fsanitize=address names the line: docs/tutorials/native.md"
"""The end of the message of a library's crash."""

WHERE_SECONDS = 0.5
"""How long to wait for the line at which a mapper hangs."""

_FRAME = re.compile(rb'^  File "(.*)", line (\d+) in ', re.MULTILINE)

LONGEST = 2**26
"""The most bytes of a message: a Python mapper need not know the protocol's limit."""

_from_child: msgspec.json.Decoder[ms.FromChild] = msgspec.json.Decoder(ms.FromChild)
_from_loading: msgspec.json.Decoder[ms.FromLoading] = msgspec.json.Decoder(ms.FromLoading)
_from_stock: msgspec.json.Decoder[ms.FromStock] = msgspec.json.Decoder(ms.FromStock)

_OVER = msgspec.json.encode(ms.OverMessage()) + b"\n"

_WORLD_ENDS = ms.DoneMessage | ms.UndeliveredMessage


class Unlisted(InputError):
    """A mapper's process does not say what it has loaded, though it has played."""


class Foreign(Program):
    """A Python mapper in its own process.

    Args:
        text: the TARGET, `package.module:attribute` or `path/file.py:attribute`.
        fresh: play each world in a process that has played none: a fork, or if `once` a new one.
    Raises (by `start` and by a call):
        InputError: no such module, file or attribute, or not callable. If it fails to load again
            later, that is a misbehaviour in its world.
    """

    longest: ClassVar[int] = LONGEST
    advice: ClassVar[str] = ""

    def __init__(self, text: str, *, fresh: bool = False, once: bool = False) -> None:
        served = "serve:fresh" if fresh else "serve:child"
        words = (text, "once") if once else (text,)
        super().__init__(python_command(f"topo_verify.programs.{served}", *words))
        self.text = text
        self._decode = _from_child.decode
        self._was_loaded = False
        self._robot: Robot | None = None
        self._says_line = not fresh and not text.startswith(LIBRARY)

    @property
    def target(self) -> Target:
        """The mapper with its TARGET."""
        return Target(self.text, self)

    def loaded(self) -> Loaded:
        """What its process has loaded until now.

        Raises:
            InputError: the mapper cannot be loaded; the name of a file cannot be kept.
            Unlisted: its process ends, is silent, or says something else.
        """
        self.settle()
        try:
            child = self._ready()
            self._send(child, ms.StockMessage())
            answer = self._answer(child, _from_stock, "said what it had loaded")
        except Misbehaved as why:
            raise Unlisted(f"target {self.text!r}: {why}") from None
        if isinstance(answer, ms.RefusedMessage):
            raise InputError(f"target {self.text!r}: {answer.why}")
        return answer.loaded

    def line(self) -> str:
        """The user's file and line at which a time limit stopped it, or "" if nothing tells."""
        if self._child is None or self._idle or self._halted or not self._says_line:
            return ""
        return _users_line(self._child.after_signal(WHERE, WHERE_SECONDS))

    def _play(self, child: Child, robot: Robot) -> Finish | Misbehaved:
        self._robot = robot
        return super()._play(child, robot)

    def _report_crash(self, child: Child, due: str) -> Misbehaved:
        if self.text.startswith(LIBRARY):
            path, symbol = library_file(self.text)
            when = ""
            if isinstance(self._robot, SimulatedRobot):
                when = f"after {plural(self._robot.cost, 'move')}"
            advice = "" if path.endswith(".py") else SANITIZER
            return crash_report(child, due, advice, who=f"{symbol} of {path}", when=when)
        why = crash_report(child, due)
        line = _users_line(os.fsencode(child.stderr())) if why.signal else ""
        if why.kind != "crashed" or not line:
            return why
        words = f"the mapper was ended by {why.signal} at {line}"
        return Misbehaved(why.kind, words, signal=why.signal)

    def _unwound(self) -> bool:
        child = self._ready()

        def unwind() -> None:
            child.write(_OVER)
            with helped_by(child.process, lambda: child.heard):
                while not isinstance(
                    decoded(child.line(), self._decode, validate=False), _WORLD_ENDS
                ):
                    pass
                self._await_next(child)

        try:
            within(UNWINDING, lambda: 0, unwind)
        except (MapperStopped, Ended, TooLong):
            return False
        return self._idle

    def _started(self, reaper: ReaperProcess) -> Child:
        child = Child(self.command, reaper, longest=self.longest, echo=self.text)
        why: Misbehaved | InputError | HelperLost
        try:
            answer = self._answer(child, _from_loading, "was loaded")
        except Misbehaved as wrong:
            unloaded = HelperLost if wrong.maybe_external else InputError
            why = wrong if self._was_loaded else unloaded(f"target {self.text!r}: {wrong}")
        except BaseException:
            child.end()
            raise
        else:
            if isinstance(answer, ms.ReadyMessage):
                self._was_loaded = True
                return child
            refused = answer.why
            why = Misbehaved("crashed", refused) if self._was_loaded else InputError(refused)
        child.end()
        raise why

    def _answer(self, child: Child, decoder: msgspec.json.Decoder[T], due: str) -> T:
        """The child's next message outside of a world; `due` as in "was loaded"."""
        who = "its process"
        try:
            line = child.line(seconds=LOADING)
        except Silent:
            raise Misbehaved("silent", f"{who} sent nothing for {LOADING:g} s") from None
        except (Ended, TooLong):
            raise crash_report(child, due, who=who) from None
        message: T = decoded(line, decoder.decode, validate=False, who=who)
        return message


def _users_line(stack: bytes) -> str:
    """The innermost line of the user's files in a stack that faulthandler wrote, or ""."""
    frames = _FRAME.findall(stack)
    return users_line([(os.fsdecode(file), int(line)) for file, line in reversed(frames)])
