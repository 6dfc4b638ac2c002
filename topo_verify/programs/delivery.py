"""Calls a mapper and reads its result.

Reading is part of the call, because attributes of a foreign object may run code.
"""

from __future__ import annotations

import os
import sys
import traceback
from bdb import BdbQuit
from collections.abc import Callable, Iterable
from contextlib import suppress
from inspect import iscoroutine, isgenerator
from operator import index
from pathlib import Path
from typing import Literal, NamedTuple, TypeVar

from topo_verify import errors
from topo_verify.errors import LINE, InputError, shown
from topo_verify.programs import interruption
from topo_verify.programs.loaded import is_users
from topo_verify.robot.events import Finish, MapData
from topo_verify.robot.limits import MapperStopped, TimeLimitExceeded
from topo_verify.robot.simulator import Misuse
from topo_verify.world.validation import RANGE, is_in_range, map_parts, optional_part

R = TypeVar("R")

_PACKAGE = Path(errors.__file__).resolve().parent

DEBUG = "; a debugger needs --in-process --move-timeout 9999 --world-timeout 9999"
"""What is added for a debugger in a process whose standard input is empty."""

WAS_AT = "; it was at "
"""Before the line at which a mapper was stopped; after a time limit another one each time."""

TEST_TOOLS = ("hypothesis", "_pytest", "pytest")
"""Their exceptions end a test, not the mapper in the same process."""


class Undelivered(NamedTuple):
    """Why a mapper delivered no map: it raised (`error`), or it returned something else."""

    why: str
    error: BaseException | None = None

    @property
    def kind(self) -> Literal["no-map", "out-of-memory"]:
        """Whether memory was short, which may be the machine's fault."""
        is_short = isinstance(self.error, MemoryError)
        return "out-of-memory" if is_short else "no-map"


def deliver(
    mapper: Callable[[R], object], robot: R, *, alone: bool = False
) -> Finish | Undelivered:
    """The mapper's map as the `finish` event, or why it delivers none.

    Args:
        alone: the mapper is alone in this process, so every exception is its own.
    Raises:
        MapperStopped: the robot or a limit stopped the mapper.
        KeyboardInterrupt: Ctrl-C, unless `alone`; also exceptions of test tools.
    """
    try:
        return _deliver(mapper, robot, alone)
    finally:
        interruption.check()  # a signal that the mapper caught, or took for an error of its own


def _deliver(
    mapper: Callable[[R], object],
    robot: R,
    alone: bool,  # noqa: FBT001  as in `deliver`
) -> Finish | Undelivered:
    __tracebackhide__ = True  # by pytest: the mapper's exception begins in the mapper
    try:
        result = mapper(robot)
    except BaseException as raised:
        if _passes(raised, alone):
            raise
        why = f"the mapper raised {exception_text(raised)}"
        return Undelivered(why + DEBUG * (alone and isinstance(raised, BdbQuit)), raised)
    try:
        return finish_of(result)
    except InputError as nonsense:
        return Undelivered(str(nonsense))
    except BaseException as raised:
        if _passes(raised, alone):
            raise
        return Undelivered(f"what was delivered cannot be read: {exception_text(raised)}", raised)


def _passes(error: BaseException, alone: bool) -> bool:  # noqa: FBT001  as in `deliver`
    # Of the bases, too: pytest names another module in those that it prints.
    homes = {kind.__module__.partition(".")[0] for kind in type(error).__mro__}
    of_tool = not isinstance(error, Exception) and not homes.isdisjoint(TEST_TOOLS)
    of_caller = of_tool or isinstance(error, KeyboardInterrupt)
    return isinstance(error, MapperStopped) or (of_caller and not alone)


def exception_text(error: BaseException) -> str:
    """Type, text, file and line of an exception; no text if that raises another."""
    return _text(error, _place(error))


def loading_text(error: BaseException) -> str:
    """The same of an exception while a mapper is loaded: only the user's lines matter."""
    return _text(error, users_line(_frames(error)))


def _text(error: BaseException, place: str) -> str:
    at = f" ({place})" if place else ""
    name = type(error).__name__
    try:
        return shown(f"{name}: {error}" if str(error) else name, limit=LINE) + at
    except Exception:  # noqa: BLE001  a mapper's exception may do anything
        return name + at


def _place(error: BaseException) -> str:
    """The innermost line of the user's files in a traceback, else one outside topo_verify."""
    frames = _frames(error)
    others = [frame for frame in frames if not Path(frame[0]).is_relative_to(_PACKAGE)]
    return users_line(frames) or (_line(*others[-1]) if others else "")


def _frames(error: BaseException) -> list[tuple[str, int]]:
    frames = traceback.extract_tb(error.__traceback__)
    return [(frame.filename, frame.lineno) for frame in frames if frame.lineno]


def users_line(frames: Iterable[tuple[str, int]]) -> str:
    """The last of these files and lines that is in a file or cell of the user's, or ""."""
    users = [
        (file, line)
        for file, line in frames
        if _is_cell(file) or (Path(file).is_file() and is_users(file))
    ]
    return _line(*users[-1]) if users else ""


def _is_cell(file: str) -> bool:
    return Path(file).parent.name.startswith("ipykernel_")


def _cell(file: str) -> str:
    """The cell by its number, as In[3], if IPython knows it."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    named = shell and shell.compile.format_code_name(file)
    return named[1] if named else "cell"


def _line(file: str, line: int) -> str:
    if _is_cell(file):
        return f"{_cell(file)}, line {line}"
    path = Path(file)
    with suppress(ValueError, OSError):
        path = path.relative_to(Path.cwd())
    return f"{os.fspath(path)}, line {line}"


def stop_text(stop: MapperStopped, line: Callable[[], str] | None = None) -> str:
    """Why a mapper was stopped, with the line at which it hung or misused the robot.

    Args:
        line: returns the line of a mapper in another process.
    """
    if not isinstance(stop, TimeLimitExceeded | Misuse):  # where it was then would be chance
        return str(stop)
    place = users_line(_frames(stop)) if line is None else line()
    return f"{stop}{WAS_AT}{place}" if place else str(stop)


def finish_of(result: object) -> Finish:
    """The `finish` event for a mapper's result.

    Raises:
        InputError: the result is no map, or its cost is no integer.
    """
    if isgenerator(result):
        raise InputError("the mapper returned a generator: it has a `yield`; return the map")
    if iscoroutine(result):
        result.close()  # else Python warns that it was never awaited
        raise InputError("the mapper is `async`: remove the word; the robot needs no `await`")
    vertices, edges, marker = map_parts(result)
    cost = optional_part(result, "cost")
    if cost is not None and (isinstance(cost, bool) or not hasattr(cost, "__index__")):
        raise InputError(
            f"the mapper reports the cost {cost!r}: expected a number of moves or None"
        )
    if cost is not None and not is_in_range(index(cost)):
        raise InputError(f"the mapper reports a cost that is not {RANGE}: expected its moves")
    delivered = MapData(tuple(map(tuple, vertices)), tuple(map(tuple, edges)), marker)
    return Finish(None if cost is None else index(cost), delivered)
