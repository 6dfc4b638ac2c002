"""A mapper in Python that is not ours, in a process of its own: a `Program` that we serve.

    with Foreign("my_mapper.py:explore") as mapper:
        report = examine(mapper.target, world)

World, robot and trace stay here; the mapper's process (serve.py) has a pipe. What a mapper in the
same process would show is not lost: the purpose of its moves, the text of its exceptions with file
and line, what it prints (on our standard error, each line marked), what it has loaded.

A robot that does not go on (the budget is used up) stops the mapper as it would in this process: by
an exception from its next move. So the process plays the next world, too, and is not started anew
for each world in which a mapper fails. One that does not come back in time is ended.

What this does not show: that what the child says about itself is true. Its exceptions, its prints
and `loaded` are its own words; moves, cost and trace are ours.
"""

from __future__ import annotations

from typing import Any, ClassVar

import msgspec

from topo_verify.errors import InputError
from topo_verify.programs import protocol as ms
from topo_verify.programs.child import Child, Ended, Silent, TooLong
from topo_verify.programs.isolation import python_command
from topo_verify.programs.loaded import Loaded
from topo_verify.programs.loader import Target
from topo_verify.programs.misbehaviour import Misbehaved, crash_report, decoded
from topo_verify.programs.program import Program
from topo_verify.programs.reaper_process import ReaperProcess
from topo_verify.robot.limits import Limits, MapperStopped, helped_by, within
from topo_verify.robot.simulator import EXPECTED

LOADING = 120.0
"""Seconds that a mapper has to be imported."""

UNWINDING = Limits(move_timeout=1.0, world_timeout=1.0)
"""How long a mapper has to end a world in which its robot was stopped, or its process is ended."""

LONGEST = 2**26
"""The most bytes of a message: a mapper in Python need not know of the protocol's limit."""

_from_child: msgspec.json.Decoder[ms.FromChild] = msgspec.json.Decoder(ms.FromChild)

_OVER = msgspec.json.encode(ms.OverMessage()) + b"\n"

_WORLD_ENDS = ms.DoneMessage | ms.UndeliveredMessage


def _decoded(line: bytes) -> ms.FromChild:
    """The message of our child, whose robot leaves it to us to judge declarations.

    Raises:
        Misbehaved: the mapper declared what is no decision; in the words of a robot in Python.
    """
    try:
        return _from_child.decode(line)
    except msgspec.ValidationError as error:
        if "`$.event" not in str(error):
            raise
        words = str(error).replace("`$.event", "`$")
    raise Misbehaved("bad-declaration", f"{EXPECTED}: {words}")


class Foreign(Program):
    """A Python mapper in a process of its own; the module's docstring says how.

    Args:
        text: the TARGET, `package.module:attribute` or `path/file.py:attribute`.
        fresh: it plays each world in a process that has played none.
    Raises (by `start` and by a call):
        InputError: there is no such module, file or attribute; or it cannot be called.
    """

    longest: ClassVar[int] = LONGEST

    def __init__(self, text: str, *, fresh: bool = False) -> None:
        served = "serve_fresh:fresh" if fresh else "serve:child"
        super().__init__(python_command(f"topo_verify.programs.{served}", text))
        self.text = text
        self._decode = _decoded

    @property
    def target(self) -> Target:
        """The mapper with its TARGET."""
        return Target(self.text, self)

    def loaded(self) -> Loaded:
        """What its process has loaded until now.

        Raises:
            InputError: the process ends or is silent instead of saying it.
        """
        self.settle()
        child = self._ready()
        self._send(child, ms.StockMessage())
        answer = self._answer(child)
        if not isinstance(answer, ms.LoadedMessage):
            raise InputError(f"target {self.text!r}: expected what it has loaded, got {answer!r}")
        return answer.loaded

    def _unwound(self) -> bool:
        child = self._ready()

        def unwind() -> None:
            child.write(_OVER)
            with helped_by(child.process, lambda: child.heard):
                while not isinstance(self._decode(child.line()), _WORLD_ENDS):
                    pass
                self._await_next(child)

        try:
            within(UNWINDING, lambda: 0, unwind)
        except (MapperStopped, Ended, TooLong, msgspec.MsgspecError):
            return False
        return self._idle

    def _started(self, reaper: ReaperProcess) -> Child:
        child = Child(self.command, reaper, longest=self.longest, echo=self.text)
        try:
            answer = self._answer(child)
        except BaseException:
            child.end()
            raise
        if isinstance(answer, ms.ReadyMessage):
            return child
        child.end()
        raise InputError(
            answer.why
            if isinstance(answer, ms.RefusedMessage)
            else f"target {self.text!r}: it wrote a message of its own while it was loaded"
        )

    def _answer(self, child: Child) -> Any:
        """The child's next message outside of a world."""
        try:
            return decoded(child.line(seconds=LOADING), self._decode, validate=False)
        except Silent:
            why = f"it gave no sign of life for {LOADING:g} s"
        except (Ended, TooLong):
            why = str(crash_report(child, "was loaded")).replace("the program", "its process")
        except Misbehaved as error:
            why = str(error)
        raise InputError(f"target {self.text!r}: {why}")
