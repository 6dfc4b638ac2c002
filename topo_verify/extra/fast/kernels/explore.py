"""One run of a compiled algorithm in one world: its cost and map, and its trace.

Worlds of up to 12 edges run in the small layout, others in the large one, whose words of trace
become events between rounds. A round that fills the trace is repeated with four times the room, up
to half of the free memory; no other buffer of the large layout grows.
"""

from __future__ import annotations

import mmap
import os
import resource
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from topo_verify import extras
from topo_verify.errors import InputError, plural
from topo_verify.extra.fast.kernels import workspace as ws
from topo_verify.extra.fast.kernels.events import decoded, words
from topo_verify.extra.fast.kernels.exploration import explore_rounds
from topo_verify.extra.fast.kernels.faults import PLANTED
from topo_verify.extra.fast.kernels.kernel import compiled
from topo_verify.robot.events import Event, Finish, MapData
from topo_verify.robot.limits import BudgetExceeded
from topo_verify.world.rooted_map import World

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Workspace = NDArray[np.int64]

RETRACE, OVERLAP = 0, 1


class Kernel(NamedTuple):
    rule: int
    motion: int


KERNELS = {
    "basic": Kernel(ws.RULE_NONE, RETRACE),
    "enhancement-i": Kernel(ws.RULE_PREFIX, OVERLAP),
    "enhancement-ii": Kernel(ws.RULE_HISTORY, RETRACE),
    "enhancement-ii+i": Kernel(ws.RULE_HISTORY, OVERLAP),
    "enhancement-iii-one": Kernel(ws.RULE_ONE, RETRACE),
    "enhancement-iii-one+i": Kernel(ws.RULE_ONE, OVERLAP),
    "enhancement-iii-all": Kernel(ws.RULE_ALL, RETRACE),
    "enhancement-iii-all+i": Kernel(ws.RULE_ALL, OVERLAP),
    "folding": Kernel(ws.RULE_FOLDING, OVERLAP),
    "folding+planar": Kernel(ws.RULE_PLANAR, OVERLAP),
}

KEPT = (
    "the map S",
    "the sequences behind one edge",
    "the records T",
    "the places that were seen",
    "the trace",
)
"""What a full buffer keeps, by the number of `FULL_…`."""

MOST_EDGES = 1 << 16

TRACE_ROOM = 1 << 20

WORD_BYTES = 40
"""Bytes for a word of trace as an event; 3 (moves) to 36 (poses) are needed."""

MOVE_WORDS = 4

ROUNDS = 64
"""Edges explored between checks for an interrupt."""


@dataclass(frozen=True, slots=True)
class CompiledRun:
    """A run; `decoded` has moves and decisions, if traced."""

    cost: int
    map: MapData | None
    stopped: str | None
    decoded: Sequence[Event] | None
    reported: int | None

    @property
    def trace(self) -> tuple[int, ...] | None:
        return None if self.decoded is None else tuple(words(self.decoded))

    @property
    def events(self) -> tuple[Event, ...]:
        """The events from the first move to the map."""
        return self.events_after()

    def events_after(self, *start: Event) -> tuple[Event, ...]:
        """The events behind a start, in one copy, since there may be millions."""
        finish = () if self.map is None else (Finish(self.reported, self.map),)
        return () if self.decoded is None else tuple(chain(start, self.decoded, finish))


def run_world(
    world: World,
    algorithm: str = "basic",
    *,
    trace: bool = False,
    budget: int | None = None,
    fault: str = "",
) -> CompiledRun:
    """Run an algorithm of the catalogue, with the reference policies, in a world.

    Args:
        budget: number of moves; default: the bound of claim 7.
        fault: a mistake to plant, by its name in `PLANTED`.
    Raises:
        InputError: numba is missing, a name is unknown, the world, the run or the trace is too
            large.
    """
    extras.require("fast")
    require_kernel(algorithm, fault or None)
    _require_room(world)
    job = CompiledJob(
        world, algorithm, trace, world.cost_bound if budget is None else budget, fault
    )
    small = len(world.alpha) <= ws.CAPACITIES["WORLD_DARTS"]
    if fault and not small:
        most = ws.CAPACITIES["WORLD_DARTS"] // 2
        raise InputError(f"faults are planted in worlds of up to {most} edges, not in this one")
    layout, room = ws.LARGE, TRACE_ROOM
    if small:
        layout, room = ws.FAULTY if fault else ws.SMALL, ws.CAPACITIES["TRACE"]
    while True:
        space = job.run(layout, room if trace else 1)
        stop = space[layout.at("stop")]
        if stop == ws.STOP_FULL + ws.FULL_TRACE:
            del space
            room = _more_room(job, layout, room)
        elif stop >= ws.STOP_FULL and layout is ws.SMALL:
            layout = ws.LARGE
        else:
            return job.result(space, layout)
        job.events.clear()


def require_kernel(algorithm: str, fault: str | None) -> None:
    """Raise an InputError unless the algorithm, and the fault if any, have kernels."""
    if algorithm not in KERNELS:
        known = ", ".join(KERNELS)
        raise InputError(f"expected an algorithm of the catalogue, got {algorithm!r}: {known}")
    if fault is not None and fault not in PLANTED:
        known = ", ".join(PLANTED)
        raise InputError(f"expected a fault that has a kernel, got {fault!r}: {known}")


def _more_room(job: CompiledJob, layout: ws.WordLayout, room: int) -> int:
    most, needed = free_memory() // 2 // WORD_BYTES, room + 1
    if needed <= most:
        bare = replace(job, trace=False).run(layout, 1)
        needed = max(needed, MOVE_WORDS * int(bare[layout.at("robot.cost")]))
    if needed > most:
        raise InputError(
            f"the trace of {job.fault or job.algorithm} in this world of"
            f" {plural(len(job.world.edges), 'edge')} needs at least"
            f" {needed * WORD_BYTES / 2**30:.2f} GiB, and it may take half of the memory that is"
            f" free, {most * WORD_BYTES / 2**30:.2f} GiB: explore a smaller world, or have no trace"
            " (from Python, explore with trace=False)"
        )
    return min(4 * room, most)


def free_memory() -> int:
    """Bytes that machine, control group (version 1 or 2) and limit of address space leave."""
    rows = [line.split() for line in _lines("/proc/meminfo")]
    available = [int(row[1]) << 10 for row in rows if row[0] == "MemAvailable:"]
    free = available or [os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")]
    for line in _lines("/proc/self/cgroup"):
        _, controllers, group = line.split(":", 2)
        if controllers == "":
            folder, most, used = f"/sys/fs/cgroup{group}", "memory.max", "memory.current"
        elif "memory" in controllers.split(","):
            folder = f"/sys/fs/cgroup/memory{group}"
            most, used = "memory.limit_in_bytes", "memory.usage_in_bytes"
        else:
            continue
        limit, usage = _lines(f"{folder}/{most}"), _lines(f"{folder}/{used}")
        if limit and usage and limit[0].isdecimal():
            stat = dict(row.split() for row in _lines(f"{folder}/memory.stat"))
            cache = stat.get("total_inactive_file", stat.get("inactive_file", "0"))
            free.append(int(limit[0]) - int(usage[0]) + int(cache))
    limit_of_space, _ = resource.getrlimit(resource.RLIMIT_AS)
    if limit_of_space != resource.RLIM_INFINITY:
        pages = int(_lines("/proc/self/statm")[0].split()[0]) if _lines("/proc/self/statm") else 0
        free.append(limit_of_space - pages * os.sysconf("SC_PAGE_SIZE"))
    return max(0, min(free))


def _lines(path: str) -> list[str]:
    try:
        return Path(path).read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return []


def _require_room(world: World) -> None:
    if len(world.edges) > MOST_EDGES or max(world.degrees) >= ws.P - 1:
        raise InputError(
            f"the compiled engine explores worlds of up to {MOST_EDGES} edges with degrees below"
            f" {ws.P - 1}; this one has {len(world.edges)} edges: use the reference engine"
        )


@dataclass(frozen=True, slots=True)
class CompiledJob:
    """One run; `events` are those taken out of the workspace so far."""

    world: World
    algorithm: str
    trace: bool
    budget: int
    fault: str
    events: list[Event] = field(default_factory=list[Event])

    def run(self, layout: ws.WordLayout, room: int) -> Workspace:
        explore: Callable[[Workspace, int, int], int] = compiled(explore_rounds, layout)
        space = workspace(layout, room)
        place_world(space, layout, self.world)
        kernel = KERNELS[self.algorithm]
        fault = PLANTED[self.fault][0] if self.fault else 0
        write(space, layout, "task", rule=kernel.rule, motion=kernel.motion, fault=fault)
        write(space, layout, "task", budget=self.budget, tracing=self.trace, room=room)
        open_darts, stop = layout.at("chart.unexplored"), layout.at("stop")
        size, at, taken, most = layout.at("trace.size"), -1, 0, room
        while at < 0 or (space[open_darts] > 0 and space[stop] == 0):
            at = explore(space, at, ROUNDS)
            if layout is ws.LARGE and self.trace and space[stop] < ws.STOP_FULL:
                taken += int(space[size])
                if taken > most:
                    most = _more_room(self, layout, taken)
                self.events.extend(decoded(trace_of(space, layout)))
                space[size] = 0
        return space

    def result(self, space: Workspace, layout: ws.WordLayout) -> CompiledRun:
        stop = int(space[layout.at("stop")])
        if stop >= ws.STOP_FULL:
            raise InputError(
                f"the run of {self.fault or self.algorithm} needs more room than the compiled"
                f" engine has for {KEPT[stop - ws.STOP_FULL]}: use the reference engine"
            )
        if self.trace:
            self.events.extend(decoded(trace_of(space, layout)))
        return CompiledRun(
            int(space[layout.at("robot.cost")]),
            None if stop else map_of(space, layout),
            {
                0: None,
                ws.STOP_BUDGET: str(BudgetExceeded(self.budget)),
                ws.STOP_DOOR: "the mapper asked for a door that is not there",
            }[stop],
            self.events if self.trace else None,
            int(space[layout.at("robot.cost")]),
        )


def workspace(layout: ws.WordLayout, room: int) -> Workspace:
    """A workspace with `room` words of trace."""
    return zeros(layout.at("trace.word") + room)


def zeros(size: int) -> Workspace:
    """An array of words, which takes memory where it is written.

    Raises:
        InputError: there is no address space for it.
    """
    import numpy as np

    try:
        memory = mmap.mmap(-1, 8 * size)
    except OSError:
        raise InputError(
            f"the compiled engine needs {size * 8 / 2**30:.2f} GiB of address space for this run"
            " and gets none: raise the limit (ulimit -v), or use the reference engine"
        ) from None
    # numpy asks for pages of 2 MiB, and most fields have few words.
    if hasattr(mmap, "MADV_NOHUGEPAGE"):
        memory.madvise(mmap.MADV_NOHUGEPAGE)
    return np.frombuffer(memory, np.int64)


def write(space: Workspace, layout: ws.WordLayout, part: str, **words: int) -> None:
    for name, word in words.items():
        space[layout.at(f"{part}.{name}")] = word


def trace_of(space: Workspace, layout: ws.WordLayout) -> list[int]:
    at = layout.at("trace.word")
    row: list[int] = space[at : at + int(space[layout.at("trace.size")])].tolist()
    return row


def place_world(space: Workspace, layout: ws.WordLayout, world: World) -> None:
    """Write a world into a workspace, darts in order of discovery."""
    degrees, alpha = world.code
    _place(space, layout, "world", degrees, alpha)


def _place(
    space: Workspace,
    layout: ws.WordLayout,
    part: str,
    degrees: Sequence[int],
    alpha: Sequence[int],
) -> None:
    import numpy as np

    first = np.concatenate(([0], np.cumsum(degrees)))[:-1]
    vertex = np.repeat(np.arange(len(degrees)), degrees)
    for name, row in (("first", first), ("degree", degrees), ("vertex", vertex), ("alpha", alpha)):
        at = layout.at(f"{part}.{name}")
        space[at : at + len(row)] = row


def place_map(space: Workspace, layout: ws.WordLayout, delivered: MapData) -> bool:
    """Write a delivered map into a workspace as S; False if its darts are not numbered so."""
    degrees = [len(darts) for darts in delivered.vertices]
    size = sum(degrees)
    numbered = [dart for darts in delivered.vertices for dart in darts] == list(range(size))
    most = layout.constants["CHART_DARTS"]
    is_whole = numbered and 2 * len(delivered.edges) == size <= most
    if not is_whole or delivered.marker != (0 if size else None):
        return False
    alpha = [-1] * size
    for one, other in delivered.edges:
        if not (0 <= one < size and 0 <= other < size):
            return False
        alpha[one], alpha[other] = other, one
    _place(space, layout, "chart", degrees, alpha)
    space[layout.at("chart.vertices")], space[layout.at("chart.darts")] = len(degrees), size
    return True


def map_of(space: Workspace, layout: ws.WordLayout) -> MapData:

    def row_of(name: str, length: int) -> list[int]:
        at = layout.at(f"chart.{name}")
        row: list[int] = space[at : at + length].tolist()
        return row

    darts, vertices = (int(space[layout.at(f"chart.{name}")]) for name in ("darts", "vertices"))
    firsts, degrees = row_of("first", vertices), row_of("degree", vertices)
    return MapData(
        tuple(tuple(range(f, f + d)) for f, d in zip(firsts, degrees, strict=True)),
        tuple((d, o) for d, o in enumerate(row_of("alpha", darts)) if d < o),
        0 if darts else None,
    )
