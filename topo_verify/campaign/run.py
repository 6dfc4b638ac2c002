"""Runs a mapper in a world: `explore`. judge.py judges the run.

A **mapper** is any callable that takes a robot and returns a map: an object with the attributes,
or a mapping with the keys, `vertices`, `edges`, `marker`, and optionally `cost`.

    run = explore(world, "enhancement-ii")         # -> Exploration: map, cost, trace

Another engine (engine.py) may run catalogue algorithms. It is given the world and is not trusted:
its runs are judged like any other.

What this does not show: a mapper in this process can find world and trace, and can be stopped
only if it runs Python code and does not catch BaseException in a loop
(`topo_verify.robot.limits`). A mapper in its own process can do neither.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from html import escape
from itertools import pairwise
from os import PathLike
from typing import TYPE_CHECKING

import msgspec

from topo_verify.algorithms import NAMED, Algorithm
from topo_verify.campaign.engine import Checks, on_engine
from topo_verify.campaign.targets import one_target
from topo_verify.checkers import check
from topo_verify.checkers.map_in_world import MapInWorld
from topo_verify.errors import ExaminationInterrupted, InputError, InternalError, plural, shown
from topo_verify.programs.delivery import Undelivered, deliver, stop_text
from topo_verify.programs.loader import Mapper, Target, is_library
from topo_verify.programs.misbehaviour import Misbehaved, RunEnd
from topo_verify.programs.program import PREFIX, Program
from topo_verify.robot.events import (
    Augment,
    Confirm,
    Decision,
    Finish,
    MapData,
    Move,
    Policies,
    Reject,
    Robot,
    Start,
    Trace,
)
from topo_verify.robot.limits import (
    Limit,
    Limits,
    MapperStopped,
    given_limits,
    within,
)
from topo_verify.robot.simulator import SimulatedRobot, first_percept
from topo_verify.world.resolve import resolve_world
from topo_verify.world.rooted_map import World

if TYPE_CHECKING:
    from topo_verify.pictures.recording import PlayedRun


MOST_SHOWN = 10_000
"""Most events of a run that a notebook plays: about two seconds."""


@dataclass(frozen=True, slots=True)
class Exploration:
    """One run of a mapper in a world.

    Attributes:
        algorithm: the mapper's name, as a TARGET.
        trace: all events; together with the world it is a certificate.
        map: the delivered map, or None.
        stopped: why it delivered none, or None.
        error: the exception that it raised, or None.
        cost: moves counted by the simulator, in edge traversals.
        limit: the limit that stopped it, or None.
        mapper: the mapper; a program's process lives as long as it.
        limits: the moves and the time that it was allowed.
        misbehaved: what a program did in place of a map.
    """

    world: World
    algorithm: str
    policies: Policies | None
    trace: Trace = field(repr=False)
    map: MapData | None = field(repr=False)
    stopped: str | None = None
    error: BaseException | None = None
    cost: int = 0
    limit: Limit | None = None
    mapper: Mapper | None = field(default=None, repr=False)
    limits: Limits = field(default_factory=Limits)
    misbehaved: Misbehaved | None = field(default=None, repr=False)

    @property
    def kept_trace(self) -> Trace:
        """The trace for a file: its `start` says why the run ended without a map, if it did."""
        start, *rest = self.trace
        if self.stopped is None or not isinstance(start, Start):
            return self.trace
        return (msgspec.structs.replace(start, stopped=self.stopped), *rest)

    @property
    def ended(self) -> RunEnd:
        """How the run ended, as data; `stopped` says it in words."""
        if self.map is not None:
            return "map"
        if self.misbehaved is not None:
            return self.misbehaved.kind
        return self.limit or Undelivered("", self.error).kind

    @property
    def declined(self) -> bool:
        """Whether a program skipped the world or gave it up."""
        return self.ended in ("skip", "error")

    @property
    def rejected_free(self) -> int:
        """Number of hypotheses rejected without a move since the last decision."""
        return sum(isinstance(e, Reject) for e in self.trace) - self.rejected_moving

    @property
    def rejected_moving(self) -> int:
        """Number of hypotheses rejected after moves, whatever rule they name."""
        return sum(
            isinstance(before, Move) and isinstance(event, Reject)
            for before, event in pairwise(self.trace)
        )

    @property
    def confirmed(self) -> int:
        """Number of hypotheses confirmed."""
        return sum(isinstance(e, Confirm) for e in self.trace)

    def save(self, path: str | PathLike[str], *, beside: Exploration | None = None) -> None:
        """Write a page (HTML) that plays this run in a browser, findings included.

        Args:
            beside: another run in the same world, to play beside this one.
        Raises:
            InputError: the file cannot be written, or its name ends in .pdf or alike; no trace was
                kept, or the other run has another world.
        """
        from topo_verify.pictures.page import player_page, require_page
        from topo_verify.world.formats import files

        require_page(path)
        runs = [self] if beside is None else [self, beside]
        if any(run.world != self.world for run in runs):
            raise InputError("beside: a run in another world; explore this run's world with both")
        if not all(run.trace for run in runs):
            raise InputError("trace=False keeps nothing to play: explore without it, then save")
        played = [*map(Exploration._played, runs)]
        files.write(path, player_page(self.world, played, name=self.world.name))

    def _repr_html_(self) -> str:
        from topo_verify.pictures.page import framed

        reason = ""
        if not self.trace:
            reason = f"no trace was kept: cost {self.cost}"
        elif len(self.trace) > MOST_SHOWN:
            reason = (
                f"over {MOST_SHOWN:,} events take long to show;"
                " <code>run.save('run.html')</code> does it"
            )
        if reason:
            run = f"{self.algorithm} in {self.world.name or 'a world'}"
            return f"<p>{escape(shown(run))}: {reason}.</p>"
        return framed(self.world, self._played())

    def _played(self) -> PlayedRun:
        from topo_verify.pictures.recording import PlayedRun

        judgements = check(self.world, self.trace, self.stopped)
        return PlayedRun(self.algorithm, self.trace, judgements, self.stopped)


@dataclass(frozen=True, slots=True)
class EngineMapper:
    """A mapper that another engine than the reference runs: that engine is given the world.

    Attributes:
        name: the algorithm's name in the catalogue.
        trace: keep the trace of a run; False: only cost and map.
    """

    name: str
    trace: bool = True

    @property
    def policies(self) -> Policies | None:
        """The policies that it runs with."""
        raise NotImplementedError

    def explore(self, world: World, start: Start, limits: Limits) -> Exploration:
        """Run in a world; `start` becomes the first event."""
        raise NotImplementedError

    def judges(self, world: World, *, strict: bool) -> bool:
        """Whether this engine judges its own run there, and the checkers what it does not pass."""
        raise NotImplementedError

    def checks(self) -> Checks:
        """What judges such a run."""
        raise NotImplementedError

    def __call__(self, robot: Robot) -> object:
        """Raise an InternalError: the engine needs the world, which a robot hides."""
        raise InternalError(f"the mapper {self.name} of an engine got a robot: {robot!r}")


def _picture(delivered: MapData) -> str | None:
    """The picture of a delivered map in a notebook; None, so that it shows the text: no map."""
    from topo_verify.pictures.drawing import notebook

    try:
        return notebook(World.from_map(delivered))
    except InputError:
        return None


setattr(MapData, "_repr_html_", _picture)  # noqa: B010  the record knows no picture

HUNG = (
    "an endless loop, an answer that was not flushed, or it waits for an answer to a message that"
    " has none"
)
"""Why a program may have stood still; the harness cannot tell them apart."""

NATIVE_HUNG = "gdb names the line: docs/tutorials/native.md, 'To debug a crash'"
"""The next step where a native mapper stood still."""


def explore(  # noqa: PLR0913  an argument an option
    world: World | str,
    mapper: Mapper | str | Target = "basic",
    *,
    pick: str | None = None,
    order: str | None = None,
    limits: Limits | None = None,
    engine: str = "reference",
    trace: bool = True,
    stop_if_false: bool = False,
) -> Exploration:
    """Run a mapper in a world.

    Args:
        world: a world, or a text as on the command line: m5/17, nyc, a file.
        mapper: a callable, a name of the catalogue, or any other TARGET of one mapper.
        pick, order: policies of a catalogue algorithm; default: the reference policies.
        limits: moves and seconds; default: the bound of claim 7, 5 s between moves, 60 s in all.
        engine: runs a catalogue algorithm, "reference" or "compiled".
        trace: keep the trace; False, for another engine than the reference: only cost and map.
        stop_if_false: end the run at its first false `augment`: no later decision is judged.
    Returns:
        The run. If the mapper delivers no map, `map` is None and `stopped` says why.
    Raises:
        InputError: there is no such world, mapper or policy; the engine cannot run it.
        ExaminationInterrupted: Ctrl-C, a KeyboardInterrupt.
    """
    world = _resolved(world, mapper)
    limits = given_limits(limits)
    target = _on(engine, one_target(mapper, pick=pick, order=order), limits, trace=trace)
    policies = policies_of(target)
    start = _start(world, target, policies)
    if isinstance(target.mapper, EngineMapper):
        return target.mapper.explore(world, start, limits)
    budget = world.cost_bound if limits.budget is None else limits.budget
    robot = SimulatedRobot(world, budget, _objection(world) if stop_if_false else None)
    if isinstance(target.mapper, Program):
        target.mapper.start()  # before the run, whose limits do not count it
    finish, stopped, error, limit = _run(target.mapper, robot, limits)
    if limit in ("move-timeout", "world-timeout"):
        robot.settle()
    if limit == "move-timeout" and target.text.startswith(PREFIX):
        stopped = f"{stopped}; {HUNG}"
    elif limit == "move-timeout" and is_library(target):
        stopped = f"{stopped}; {NATIVE_HUNG}"
    misbehaved = None
    if isinstance(target.mapper, Program):
        misbehaved = target.mapper.misbehaved
        # Here, not in the next run, whose limits would count the time.
        target.mapper.settle()
    events = (start, *robot.events)
    return Exploration(
        world,
        target.text,
        policies,
        events if finish is None else (*events, finish),
        None if finish is None else finish.map,
        stopped,
        error,
        robot.cost,
        limit,
        target.mapper,
        limits,
        misbehaved,
    )


def _objection(world: World) -> Callable[[int, Decision], str]:
    """Objects to the first augmentation that is false in this world."""
    true_map = MapInWorld(world)

    def objection(when: int, event: Decision) -> str:
        if not isinstance(event, Augment) or true_map.grow(when, event):
            return ""
        return f"its 'augment' at event {when} is false: the run ended there (a replay goes on)"

    return objection


def _resolved(world: object, mapper: object) -> World:
    """The world, or the one that a text names as on the command line."""
    if isinstance(mapper, World) or callable(world) or (isinstance(world, str) and world in NAMED):
        raise InputError(
            "world and mapper have changed places: write explore(world, mapper),"
            " examine(mapper, world) and assert_maps(mapper, world)"
        )
    if isinstance(world, World):
        return world
    if isinstance(world, str):
        return resolve_world(world)
    mend = "; give its .world" if hasattr(world, "world") else ""
    expected = "expected a World or a text that names one, as m5/17 or nyc"
    raise InputError(f"{expected}, got {world!r}{mend}")


def _on(engine: str, target: Target, limits: Limits, *, trace: bool) -> Target:
    (target,) = on_engine(engine, (target,), limits)
    if trace:
        return target
    if not isinstance(target.mapper, EngineMapper):
        raise InputError("trace=False: the reference engine always keeps the trace; leave it out")
    return Target(target.text, replace(target.mapper, trace=False))


WITH_POLICIES = Algorithm, EngineMapper
"""The kinds of mappers that have policies. (A tuple: a union would be made for each run.)"""


def policies_of(target: Target) -> Policies | None:
    """The policies of a catalogue algorithm; None for other mappers."""
    mapper = target.mapper
    return mapper.policies if isinstance(mapper, WITH_POLICIES) else None


def _start(world: World, target: Target, policies: Policies | None) -> Start:
    return Start(
        algorithm=target.text,
        policies=policies,
        world=world.known_id,
        percept=first_percept(world),
    )


def _run(
    mapper: Mapper, robot: SimulatedRobot, limits: Limits
) -> tuple[Finish | None, str | None, BaseException | None, Limit | None]:
    """The delivered map; or why there is none, the exception and the limit that struck."""

    def survey() -> Finish | Undelivered:
        # A program gets only text, so it may be given the robot itself.
        return mapper(robot) if isinstance(mapper, Program) else deliver(mapper, robot.handle)

    try:
        result = within(limits, lambda: robot.cost, survey)
    except MapperStopped as stop:
        line = mapper.line if isinstance(mapper, Program) else None
        limit = (robot.stopped or stop).limit  # no name for the stop, which holds this frame
        return None, stop_text(robot.stopped or stop, line), None, limit
    except KeyboardInterrupt as ctrl_c:
        moves = plural(robot.cost, "move")
        interrupted = ExaminationInterrupted(f"after {moves}; the run is not kept")
        raise interrupted.with_traceback(ctrl_c.__traceback__) from None
    error = result.error if isinstance(result, Undelivered) else None
    # The first limit counts, even if the mapper swallowed the robot's exception.
    if robot.stopped is not None:
        return None, stop_text(robot.stopped), error, robot.stopped.limit
    if isinstance(result, Undelivered):
        return None, result.why, error, None
    return result, None, None, None
