"""A native mapper: a function of machine code, called with the robot of `topo_verify.h`.

That robot is a row of callbacks into Python. After a refusal they do nothing; when the function
returns, the exception that stopped the robot is raised.

What this does not show: that the function keeps to its own memory.
"""

from __future__ import annotations

import ctypes
import mmap
import os
import resource
from collections.abc import Callable
from pathlib import Path
from typing import Any, get_args

from topo_verify.errors import InputError, shown
from topo_verify.robot.events import Robot, RuleName
from topo_verify.robot.limits import MapperStopped
from topo_verify.robot.percept import PURPOSES, Percept

LIBRARY = "--library "
"""The beginning of a TARGET that is a native mapper."""

SYMBOL = "map_world"

VERSION = 1

MEMORY = 4 << 30
"""Bytes of address space that a native mapper may add to its process's own."""

MOST_DARTS = 1 << 20
"""Most vertices, and darts, of a delivered map."""

REFUSED = -1

_READ_ONLY = 1
"""PROT_READ."""

CONTRADICTIONS = (
    None,
    "two degrees, or the marker and its absence, at one place",
    "a vertex would be itself, turned",
    "a dart would be its own other end",
    "two vertices of S would be one",
    "it lies on another face than e",
)
"""Meanings of `TV_UNLIKE` and so on; docs/semantics.md, section 13."""

_RULES = get_args(RuleName)
_KINDS = (None, "new", "loop")

_int = ctypes.c_int64
_row = ctypes.POINTER(ctypes.c_int64)
_world = ctypes.c_void_p
_TYPES: dict[str, Any] = {
    "look": (),
    "move": (_int, _int),
    "pose": (_int, _int, _row),
    "reject": (_int, _int, _int, _row, _int, _row),
    "confirm": (_int, _int, _int),
    "augment": (_int, _int, _int, _int),
    "deliver": (_int, _row, _row, _int, _int),
    "skip": (ctypes.c_char_p,),
}
_CALLBACKS: dict[str, Any] = {
    name: ctypes.CFUNCTYPE(_int, _world, *types) for name, types in _TYPES.items()
}


class _NativeRobot(ctypes.Structure):
    """`tv_robot`, without a world."""

    _fields_ = [("version", _int), ("world", _world), *_CALLBACKS.items()]


class Skipped(MapperStopped):
    """The mapper declines this world."""


def header_text() -> str:
    """The text of `topo_verify.h`."""
    return (Path(__file__).parent / "topo_verify.h").read_text(encoding="utf-8")


def library_file(text: str) -> tuple[str, str]:
    """File and symbol of a TARGET `--library PATH[:SYMBOL]`."""
    place = text.removeprefix(LIBRARY)
    path, _, symbol = place.rpartition(":")
    return (path, symbol) if path and not os.path.isfile(place) else (place, SYMBOL)  # noqa: PTH113


def library_function(text: str) -> Any:
    """The function of a shared library. Opening a library runs its code.

    Raises:
        InputError: there is no such library or symbol.
    """
    path, symbol = library_file(text)
    where = f"--library {text.removeprefix(LIBRARY)}"
    confine()
    if not os.path.isfile(path):  # noqa: PTH113
        raise InputError(f"{where}: there is no file {path!r}: name a shared library")
    try:
        library = ctypes.CDLL(os.path.abspath(path))  # noqa: PTH100
    except OSError as error:
        raise InputError(
            f"{where}: cannot open it ({error}): build it with cc -shared -fPIC"
        ) from error
    try:
        function = library[symbol]
    except AttributeError:
        raise InputError(
            f"{where}: it has no function {symbol!r}: name one that it exports, as in"
            f" --library {path}:SYMBOL"
        ) from None
    function.restype, function.argtypes = None, (ctypes.c_void_p,)
    return function


def confine() -> None:
    """Limit this process's memory, and forbid core files and `fork`, which would share the pipe."""
    used = int(_first_word("/proc/self/statm")) * resource.getpagesize()
    _, most = resource.getrlimit(resource.RLIMIT_AS)
    wanted = used + MEMORY
    limit = wanted if most == resource.RLIM_INFINITY else min(wanted, most)
    resource.setrlimit(resource.RLIMIT_AS, (limit, most))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    register = getattr(ctypes.CDLL(None), "__register_atfork", None)
    if register is not None and not _before_fork:
        _before_fork.append(ctypes.CFUNCTYPE(None)(_end_before_fork))
        register(_before_fork[0], None, None, None)


_before_fork: list[Any] = []
"""The callback, kept alive as long as the process."""


def _end_before_fork() -> None:
    os.write(2, b"the mapper called fork\n")
    os.abort()


def _first_word(path: str) -> str:
    try:
        return Path(path).read_text(encoding="ascii").split()[0]
    except OSError:
        return "0"


class NativeMapper:
    """A native mapper; one call at a time."""

    def __init__(self, function: Any) -> None:
        self._function = function
        system: Any = ctypes.CDLL(None)
        self._flush = system.fflush
        self._callbacks = {
            name: kind(self._guarded(getattr(self, f"_{name}")))
            for name, kind in _CALLBACKS.items()
        }
        # Read-only, as in the compiled engine: a mapper that writes there is ended.
        self._page = mmap.mmap(-1, mmap.PAGESIZE, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
        self._native = _NativeRobot.from_buffer(self._page)
        self._native.version = VERSION
        for name, callback in self._callbacks.items():
            setattr(self._native, name, callback)
        address = ctypes.c_void_p(ctypes.addressof(self._native))
        locked = system.mprotect(address, ctypes.c_size_t(mmap.PAGESIZE), _READ_ONLY)
        assert locked == 0, "a whole page of our own"

    def __call__(self, robot: Robot) -> object:
        """Run the function; return the map that it delivered."""
        self._robot = robot
        self._stopped: BaseException | None = None
        self._map: dict[str, object] | None = None
        self._function(ctypes.byref(self._native))
        self._flush(None)
        if self._stopped is not None:
            raise self._stopped
        return self._map

    def _guarded(self, work: Callable[..., int]) -> Callable[..., int]:

        def called(_world: int | None, *given: Any) -> int:
            if self._stopped is not None or self._map is not None:
                return REFUSED
            try:
                return work(*given)
            except BaseException as why:  # noqa: BLE001  it cannot pass through native code
                self._stopped = why
                return REFUSED

        return called

    # ------------------------------------------------------------ the callbacks, as in the header

    def _look(self) -> int:
        return _word(self._robot.percept)

    def _move(self, door: int, purpose: int) -> int:
        meant = PURPOSES[purpose] if 0 <= purpose < len(PURPOSES) else None
        return _word(self._robot.move(door, meant))

    def _pose(self, edge: int, count: int, hypotheses: Any) -> int:
        return self._declare("pose", edge, hypotheses=_words(hypotheses, count))

    def _reject(
        self, edge: int, hypothesis: int, rule: int, words: Any, count: int, doors: Any
    ) -> int:
        step, expected, observed, sequence, at, record, contradiction = words[:7]
        evidence: dict[str, object] = {
            "step": step,
            "expected": _seen(expected),
            "observed": _seen(observed),
            "sequence": None if sequence == REFUSED else sequence,
            "at": None if at == REFUSED else at,
            "contradiction": _named(CONTRADICTIONS, contradiction),
        }
        way = _words(doors, count)
        if record != REFUSED or way is None:
            evidence["record"] = {"dart": record, "doors": way}
        named = _named(_RULES, rule)
        return self._declare("reject", edge, hypothesis=hypothesis, rule=named, evidence=evidence)

    def _confirm(self, edge: int, hypothesis: int, rule: int) -> int:
        return self._declare("confirm", edge, hypothesis=hypothesis, rule=_named(_RULES, rule))

    def _augment(self, edge: int, kind: int, dart: int, degree: int) -> int:
        named = _named(_KINDS, kind)
        return self._declare("augment", edge, kind=named, dart=dart, degree=degree)

    def _declare(self, event_type: str, edge: int, **fields: object) -> int:
        event: Any = {"type": event_type, "edge": edge, **fields}
        self._robot.declare(event)
        return 0

    def _deliver(self, vertices: int, degrees: Any, ends: Any, marker: int, cost: int) -> int:
        if not 0 <= vertices <= MOST_DARTS:
            raise InputError(f"the mapper delivered a map of {vertices} vertices")
        rows: list[list[int]] = []
        darts = 0
        for degree in degrees[:vertices]:
            if not 0 <= degree <= MOST_DARTS - darts:
                raise InputError(f"the mapper delivered a map with a vertex of degree {degree}")
            rows.append(list(range(darts, darts + degree)))
            darts += degree
        others = ends[:darts]
        for dart, other in enumerate(others):
            if not 0 <= other < darts or other == dart or others[other] != dart:
                raise InputError(
                    f"the mapper delivered {other} as the other end of dart {dart}: expected"
                    " another dart, whose other end that one is"
                )
        self._map = {
            "vertices": rows,
            "edges": [(d, o) for d, o in enumerate(others) if d < o],
            "marker": None if marker == REFUSED else marker,
            "cost": None if cost == REFUSED else cost,
        }
        return 0

    def _skip(self, why: bytes | None) -> int:
        reason = shown((why or b"").decode(errors="backslashreplace"))
        words = f": {reason}" if reason else " and gives no reason"
        raise Skipped(f"the mapper skips this world{words}")


def _word(percept: Percept) -> int:
    return percept.degree * 65536 + (0 if percept.marker is None else percept.marker + 1)


def _seen(word: int) -> dict[str, int | None] | None:
    if word == REFUSED:
        return None
    return {"degree": word >> 16, "marker": (word & 65535) - 1 if word & 65535 else None}


def _words(row: Any, count: int) -> list[int] | None:
    return None if not 0 <= count <= MOST_DARTS else row[:count] if count else []


def _named(names: tuple[str | None, ...], number: int) -> str | None:
    return names[number] if 0 <= number < len(names) else f"number {number}"
