"""One run of a compiled algorithm in one world: its cost and map, and the trace when asked.

    run = run_world(world, "enhancement-ii", trace=True)     # -> CompiledRun

Worlds of up to 12 edges run in the small layout, others in the large one, which takes up to 65,536
edges. A run whose trace is longer than there is room for is made again with four times the room; a
run that needs more of anything else than the small layout has, in the large one. Between rounds of
the loop a run can be interrupted (Ctrl-C).

What this does not show: whether the run is the reference's. tests/compiled compares the two.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from topo_verify.compiled import require
from topo_verify.compiled.events import decoded
from topo_verify.compiled.exploration import explore_rounds
from topo_verify.compiled.faults import PLANTED
from topo_verify.compiled.kernel import compiled
from topo_verify.compiled.workspace import (
    CAPACITIES,
    FAULTY,
    FULL_TRACE,
    LARGE,
    RULE_ALL,
    RULE_FOLDING,
    RULE_HISTORY,
    RULE_NONE,
    RULE_ONE,
    RULE_PLANAR,
    RULE_PREFIX,
    SMALL,
    STOP_BUDGET,
    STOP_DOOR,
    STOP_FULL,
    P,
    WordLayout,
)
from topo_verify.errors import InputError
from topo_verify.robot.events import Event, Finish, MapData
from topo_verify.world.rooted_map import World

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Workspace = NDArray[np.int64]

RETRACE, OVERLAP = 0, 1


class Kernel(NamedTuple):
    """What an algorithm of the catalogue is to the kernels: its rule and its motion."""

    rule: int
    motion: int


KERNELS = {
    "basic": Kernel(RULE_NONE, RETRACE),
    "enhancement-i": Kernel(RULE_PREFIX, OVERLAP),
    "enhancement-ii": Kernel(RULE_HISTORY, RETRACE),
    "enhancement-ii+i": Kernel(RULE_HISTORY, OVERLAP),
    "enhancement-iii-one": Kernel(RULE_ONE, RETRACE),
    "enhancement-iii-one+i": Kernel(RULE_ONE, OVERLAP),
    "enhancement-iii-all": Kernel(RULE_ALL, RETRACE),
    "enhancement-iii-all+i": Kernel(RULE_ALL, OVERLAP),
    "folding": Kernel(RULE_FOLDING, OVERLAP),
    "folding+planar": Kernel(RULE_PLANAR, OVERLAP),
}
"""Every algorithm of the catalogue."""

KEPT = (
    "the map S",
    "the sequences behind one edge",
    "the records T",
    "the places that were seen",
    "the trace",
)
"""What a full buffer keeps, by the number of `FULL_…`."""

MOST_EDGES = 1 << 16
"""The most edges of a world that the large layout has room for."""

TRACE_ROOM = 1 << 20
"""Words of trace for which the large layout has room at first."""

ROUNDS = 64
"""Edges that are explored before Python is asked whether to go on."""


@dataclass(frozen=True, slots=True)
class CompiledRun:
    """A run of a compiled algorithm.

    Attributes:
        cost: edge traversals.
        map: what it delivered, or None.
        stopped: why it delivered none, or None.
        trace: the words of its trace (events.py), if they were asked for.
    """

    cost: int
    map: MapData | None
    stopped: str | None
    trace: tuple[int, ...] | None

    @property
    def events(self) -> tuple[Event, ...]:
        """The events from the first move on, with the map at the end; none without a trace."""
        if self.trace is None:
            return ()
        found = tuple(decoded(self.trace))
        return found if self.map is None else (*found, Finish(self.cost, self.map))


def run_world(
    world: World,
    algorithm: str = "basic",
    *,
    trace: bool = False,
    budget: int | None = None,
    fault: str = "",
) -> CompiledRun:
    """Run a compiled algorithm of the catalogue, with the reference policies, in a world.

    Args:
        budget: how many moves are allowed; default: the bound of claim 7.
        fault: a mistake to plant, by its name in `PLANTED`.
    Raises:
        InputError: numba is not installed, there is no such algorithm or mistake, or the world or
            the run is too large.
    """
    require("the compiled engine")
    if algorithm not in KERNELS:
        known = ", ".join(KERNELS)
        raise InputError(f"expected an algorithm of the catalogue, got {algorithm!r}: {known}")
    if fault and fault not in PLANTED:
        known = ", ".join(PLANTED)
        raise InputError(f"expected a fault that has a kernel, got {fault!r}: {known}")
    _require_room(world)
    job = CompiledJob(
        world, algorithm, trace, world.cost_bound if budget is None else budget, fault
    )
    small = len(world.alpha) <= CAPACITIES["WORLD_DARTS"]
    if fault and not small:
        most = CAPACITIES["WORLD_DARTS"] // 2
        raise InputError(f"faults are planted in worlds of up to {most} edges, not in this one")
    layout, room = LARGE, TRACE_ROOM
    if small:
        layout, room = FAULTY if fault else SMALL, CAPACITIES["TRACE"]
    while True:
        space = job.run(layout, room if trace else 1)
        stop = space[layout.at("STOP")]
        if stop == STOP_FULL + FULL_TRACE:
            room *= 4
        elif stop >= STOP_FULL and layout is SMALL:
            layout = LARGE
        else:
            return job.result(space, layout)


def _require_room(world: World) -> None:
    """Raise an InputError unless the large layout has room for the world."""
    if len(world.edges) > MOST_EDGES or max(world.degrees) >= P - 1:
        raise InputError(
            f"the compiled engine explores worlds of up to {MOST_EDGES} edges with degrees below"
            f" {P - 1}; this one has {len(world.edges)} edges: use the reference engine"
        )


class CompiledJob(NamedTuple):
    """What is asked of one run: an algorithm in a world, with a budget and perhaps a mistake."""

    world: World
    algorithm: str
    trace: bool
    budget: int
    fault: str

    def run(self, layout: WordLayout, room: int) -> Workspace:
        """The workspace after the run, with room for so many words of trace."""
        explore: Callable[[Workspace, int, int], int] = compiled(explore_rounds, layout)
        space = workspace(layout, room)
        place_world(space, layout, self.world)
        kernel = KERNELS[self.algorithm]
        space[layout.at("RULE")] = kernel.rule
        space[layout.at("MOTION")] = kernel.motion
        space[layout.at("FAULT")] = PLANTED[self.fault][0] if self.fault else 0
        space[layout.at("BUDGET")] = self.budget
        space[layout.at("TRACING")] = self.trace
        space[layout.at("ROOM")] = room
        open_darts, stop = layout.at("NU"), layout.at("STOP")
        at = -1
        while at < 0 or (space[open_darts] > 0 and space[stop] == 0):
            at = explore(space, at, ROUNDS)
        return space

    def result(self, space: Workspace, layout: WordLayout) -> CompiledRun:
        """What a finished workspace says."""
        stop = int(space[layout.at("STOP")])
        if stop >= STOP_FULL:
            raise InputError(
                f"the run of {self.fault or self.algorithm} needs more room than the compiled"
                f" engine has for {KEPT[stop - STOP_FULL]}: use the reference engine"
            )
        trace = layout.at("TR")
        words = space[trace : trace + int(space[layout.at("NTR")])] if self.trace else None
        return CompiledRun(
            int(space[layout.at("COST")]),
            None if stop else map_of(space, layout),
            {
                0: None,
                STOP_BUDGET: f"the mapper asked for more than {self.budget} moves",
                STOP_DOOR: "the mapper asked for a door that is not there",
            }[stop],
            None if words is None else tuple(words.tolist()),
        )


def workspace(layout: WordLayout, room: int) -> Workspace:
    """A workspace with room for so many words of trace; what is never touched takes no memory."""
    import numpy as np

    return np.zeros(layout.at("TR") + room, np.int64)


def place_world(space: Workspace, layout: WordLayout, world: World) -> None:
    """Write a world into a workspace, its darts in the order of discovery."""
    import numpy as np

    degrees, alpha = world.code
    first = np.concatenate(([0], np.cumsum(degrees)))[:-1]
    vertex = np.repeat(np.arange(len(degrees)), degrees)
    for name, row in (("AL", alpha), ("VT", vertex), ("ST", first), ("DG", degrees)):
        space[layout.at(name) : layout.at(name) + len(row)] = row


def map_of(space: Workspace, layout: WordLayout) -> MapData:
    """The map S in a workspace."""

    def field(name: str, length: int) -> list[int]:
        at = layout.at(name)
        row: list[int] = space[at : at + length].tolist()
        return row

    darts, vertices = (int(space[layout.at(name)]) for name in ("NDARTS", "NV"))
    firsts, degrees = field("CF", vertices), field("CD", vertices)
    return MapData(
        tuple(tuple(range(f, f + d)) for f, d in zip(firsts, degrees, strict=True)),
        tuple((d, o) for d, o in enumerate(field("CA", darts)) if d < o),
        0 if darts else None,
    )
