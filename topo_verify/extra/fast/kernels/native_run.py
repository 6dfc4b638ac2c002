"""Rows in guarded memory, and the robot, for a native mapper in this process.

    calls = NativeCalls(address, beats)
    calls.run(world)                            # -> CompiledRun, ...: of one world
    CompiledRange(..., calls=calls)             # of a range of worlds

Each row ends at a page without access and begins behind a fence; the robot is read-only. The system
ends a mapper that runs over a row's end; the kernels (native.py) end one that writes before it or
over the world. Other stray writes are not noticed.
"""

from __future__ import annotations

import ctypes
import mmap
import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from topo_verify.extra.fast.kernels import native, tally
from topo_verify.extra.fast.kernels import workspace as ws
from topo_verify.extra.fast.kernels.events import ABSENT, decoded
from topo_verify.extra.fast.kernels.explore import CompiledRun, map_of, place_world, write
from topo_verify.extra.fast.kernels.kernel import address_of, compiled
from topo_verify.robot.events import MapData
from topo_verify.robot.limits import BudgetExceeded
from topo_verify.world.rooted_map import World

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Row = NDArray[np.int64]

NAMES = ("look", "move", "pose", "reject", "confirm", "augment", "deliver", "skip")
"""The callbacks, in the order of the header."""

VERSION = 1

ROOM = 1 << 16

MOST_ROOM = 1 << 24

STOPPED: Mapping[int, str] = {
    ws.STOP_DOOR: "the mapper asked for a door that is not there",
    ws.STOP_MAP: "the mapper delivered what is no map",
    ws.STOP_EVENT: "the mapper declared what is no decision",
    ws.STOP_SKIP: "the mapper skips this world",
}

_at = ws.SMALL.at

_PAGE = mmap.PAGESIZE
_NO_ACCESS, _READ_ONLY = 0, 1


class Guarded:
    """Rows of words between pages without access."""

    def __init__(self) -> None:
        self._rows: dict[tuple[object, ...], Row] = {}
        self._fences: list[Row] = []
        self._kept: list[mmap.mmap] = []
        self._system: Any = ctypes.CDLL(None)

    def row(self, name: str, given: Row) -> Row:
        key = (name, *given.shape)
        if key not in self._rows:
            self._rows[key] = self._made(given)
        self._rows[key][...] = given
        return self._rows[key]

    def _made(self, given: Row) -> Row:
        import numpy as np

        size = -(-8 * (given.size + native.FENCE_WORDS) // _PAGE) * _PAGE
        memory = mmap.mmap(-1, size + 2 * _PAGE, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
        self._kept.append(memory)
        words = np.frombuffer(memory, np.int64)
        first = words.ctypes.data
        for page in (first, first + _PAGE + size):
            self._protect(page, _NO_ACCESS)
        end = (_PAGE + size) // 8
        fence = words[_PAGE // 8 : end - given.size]
        fence[:] = native.FENCE
        self._fences.append(fence)
        return words[end - given.size : end].reshape(given.shape)

    def lock(self, row: Row) -> None:
        self._protect(row.ctypes.data // _PAGE * _PAGE, _READ_ONLY)

    @property
    def torn(self) -> bool:
        return any((fence != native.FENCE).any() for fence in self._fences)

    def _protect(self, page: int, mode: int) -> None:
        done = self._system.mprotect(ctypes.c_void_p(page), ctypes.c_size_t(_PAGE), mode)
        assert done == 0, "a whole page of our own"


class NativeCalls:
    """A native mapper, as this process calls it.

    Args:
        beats: the address of two words: worlds of the shard finished, and a heartbeat.
    """

    def __init__(self, function: Any, beats: int) -> None:
        self._function, self._beats = ctypes.cast(function, ctypes.c_void_p).value or 0, beats
        self.first = self.worlds = 0
        self.guarded = Guarded()
        self._end = ctypes.cast(ctypes.CDLL(None)._exit, ctypes.c_void_p).value or 0  # noqa: SLF001  its name in C
        self._spaces: dict[tuple[str, int], Row] = {}

    def space(self, use: str, room: int = ws.TRACE) -> Row:
        if (use, room) not in self._spaces:
            import numpy as np

            row = self.guarded.row(f"space {use}", np.zeros(_at("trace.word") + room, np.int64))
            self._prepare(row, f"robot {use} {room}")
            self._spaces[use, room] = row
        return self._spaces[use, room]

    def _prepare(self, space: Row, robot_name: str) -> None:
        import numpy as np

        here = space.ctypes.data
        robot = self.guarded.row(robot_name, np.array([VERSION, here, *_addresses()], np.int64))
        self.guarded.lock(robot)
        addresses = {"mapper": self._function, "robot": robot.ctypes.data, "self": here}
        write(space, ws.SMALL, "native", **addresses, beats=self._beats, exit=self._end)

    def require_whole(self) -> None:
        """End this process if the mapper wrote before a row."""
        if self.guarded.torn:
            os._exit(native.WROTE)

    def run(self, world: World) -> tuple[CompiledRun, bool]:
        """The run in one world of the small layout, and whether it decides anything."""
        room = ROOM
        while True:
            space = self.space("run", room)
            place_world(space, ws.SMALL, world)
            write(space, ws.SMALL, "task", budget=world.cost_bound, tracing=1, room=room)
            write(space, ws.SMALL, "native", rank=self.worlds, first=0)  # the shard is done
            run = compiled(native.run_native, ws.SMALL)
            run(space, len(world.alpha), len(world.vertices))
            if space[_at("stop")] < ws.STOP_FULL or room >= MOST_ROOM:
                return made_by(space, world), not is_open(space)
            room *= 4


def _addresses() -> list[int]:
    return [address_of(getattr(native, f"native_{name}"), ws.SMALL) for name in NAMES]


def warm() -> None:
    for function in (tally.examine_worlds, tally.enter_open, native.run_native):
        compiled(function, ws.SMALL)
    _addresses()


def has_declined(space: Row) -> bool:
    return bool(space[_at("stop")] == ws.STOP_SKIP)


def is_open(space: Row) -> bool:
    """Did the mapper decline, or had it no room?"""
    return bool(space[_at("stop")] >= ws.STOP_SKIP)


def made_by(space: Row, world: World) -> CompiledRun:
    stop, reported = int(space[_at("stop")]), int(space[_at("native.reported")])
    is_map = stop == 0 and space[_at("native.delivered")] != 0
    why: str | None = None
    if not is_map:
        why = STOPPED.get(stop, "the mapper delivered no map")
        if stop == ws.STOP_BUDGET:
            why = str(BudgetExceeded(world.cost_bound))
    delivered = None
    if is_map:
        delivered = (
            map_of(space, ws.SMALL) if space[_at("chart.darts")] >= 0 else MapData((), (), None)
        )
    words = space[_at("trace.word") : _at("trace.word") + int(space[_at("trace.size")])]
    return CompiledRun(
        int(space[_at("robot.cost")]),
        delivered,
        why,
        tuple(decoded(words.tolist())),
        None if reported == ABSENT else reported,
    )
