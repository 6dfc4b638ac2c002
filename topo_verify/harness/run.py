"""The one way to run a mapper in a world: `explore`; what judges the run is `judge.py`.

A **mapper** is any callable that takes a robot and returns a map: an object with the attributes, or
a mapping with the keys, `vertices`, `edges`, `marker`, and optionally `cost`. It is not trusted: if
it raises, returns something else, exceeds its budget or loops without moving, that is a finding.

    run = explore(world, "enhancement-ii")         # -> Exploration: map, cost, trace

What this does not show: a mapper in the same process can be stopped only if it runs Python code and
does not catch BaseException in a loop; see `topo_verify.robot.limits`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from operator import index

from topo_verify.algorithms import Algorithm
from topo_verify.errors import InputError
from topo_verify.harness.targets import one_target
from topo_verify.programs.loader import Mapper, Target
from topo_verify.programs.program import Misbehaved, Program
from topo_verify.robot.events import (
    Confirm,
    Finish,
    MapData,
    Policies,
    Reject,
    Start,
    Trace,
)
from topo_verify.robot.limits import Limit, Limits, MapperStopped, within
from topo_verify.robot.simulator import SimulatedRobot, first_percept
from topo_verify.world.enumeration import rank_order
from topo_verify.world.rooted_map import World
from topo_verify.world.validation import map_parts, optional_part


@dataclass(frozen=True, slots=True)
class Exploration:
    """One run of a mapper in a world.

    Attributes:
        world: the world in which the mapper ran.
        algorithm: the mapper's name, as a TARGET of the command line.
        policies: its policies, or None where they are not known.
        trace: all events, in order; together with the world it is a certificate.
        map: the map that it delivered, or None.
        stopped: why it delivered none, or None.
        error: the exception that it raised, if it did.
        cost: the number of moves, in edge traversals, as counted by the simulator.
        limit: the limit that stopped it, if one did.
        mapper: the mapper itself; a program's process lives as long as it.
        limits: the moves and the time that it was allowed.
        misbehaved: what a program, or a mapper in a process of its own, did in place of a map.
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
    def declined(self) -> bool:
        """Whether a program skipped the world or gave it up, as the protocol lets it."""
        return self.misbehaved is not None and self.misbehaved.kind in ("skip", "error")

    @property
    def rejected_free(self) -> int:
        """How many hypotheses were rejected without motion."""
        return sum(isinstance(e, Reject) and e.rule != "motion" for e in self.trace)

    @property
    def rejected_moving(self) -> int:
        """How many hypotheses were rejected by motion."""
        return sum(isinstance(e, Reject) and e.rule == "motion" for e in self.trace)

    @property
    def confirmed(self) -> int:
        """How many hypotheses were confirmed."""
        return sum(isinstance(e, Confirm) for e in self.trace)


def explore(
    world: World,
    mapper: Mapper | str | Target = "basic",
    *,
    pick: str | None = None,
    order: str | None = None,
    limits: Limits | None = None,
) -> Exploration:
    """Run a mapper in a world.

    Args:
        mapper: a callable, a name of the catalogue, or any other TARGET of one mapper.
        pick, order: policies, for algorithms of the catalogue; default: the reference policies.
        limits: moves and seconds; default: the bound of claim 7, 5 s between moves, 60 s in all.
    Returns:
        The run, also of a mapper that delivers no map: then `map` is None and `stopped` says why.
    Raises:
        InputError: there is no such mapper or policy.
    """
    target = one_target(mapper, pick=pick, order=order)
    limits = limits or Limits()
    budget = world.cost_bound if limits.budget is None else limits.budget
    robot = SimulatedRobot(world, budget)
    known = len(world.edges) <= rank_order.MAX_ID_EDGES
    policies = target.mapper.policies if isinstance(target.mapper, Algorithm) else None
    start = Start(
        algorithm=target.text,
        policies=policies,
        world=world.id if known else None,
        percept=first_percept(world),
    )
    finish, stopped, error, limit = _run(target.mapper, robot, limits)
    misbehaved = None
    if isinstance(target.mapper, Program):
        misbehaved = target.mapper.misbehaved
        # Here and not in the next run: ending a process takes time that no limit should count.
        target.mapper.settle()
    trace = (start, *robot.events)
    return Exploration(
        world,
        target.text,
        policies,
        trace if finish is None else (*trace, finish),
        None if finish is None else finish.map,
        stopped,
        error,
        robot.cost,
        limit,
        target.mapper,
        limits,
        misbehaved,
    )


def _run(
    mapper: Mapper, robot: SimulatedRobot, limits: Limits
) -> tuple[Finish | None, str | None, BaseException | None, Limit | None]:
    """The delivered map; or why there is none, what the mapper raised and which limit struck."""
    finish: Finish | None = None
    why: str | None = None
    error: BaseException | None = None

    def survey() -> tuple[Finish | None, str | None, Exception | None]:
        result = mapper(robot)
        try:
            # Read it within the limits: attributes of a foreign object may run code.
            return _finish(result), None, None
        except InputError as nonsense:
            return None, str(nonsense), None
        except Exception as raised:  # noqa: BLE001  an attribute may raise anything
            return None, f"what was delivered cannot be read: {_exception_text(raised)}", raised

    try:
        finish, why, error = within(limits, lambda: robot.cost, survey)
    except MapperStopped as stop:
        stop = robot.stopped or stop
        return None, str(stop), None, stop.limit
    except (Exception, SystemExit) as raised:  # noqa: BLE001  any exception is a finding
        error = raised
    # A mapper that swallows the robot's exception and goes on is still stopped by the first limit.
    if robot.stopped is not None:
        return None, str(robot.stopped), error, robot.stopped.limit
    if error is not None:
        return None, why or f"the mapper raised {_exception_text(error)}", error, None
    return finish, why, None, None


def _exception_text(error: BaseException) -> str:
    """The type and the text of an exception; its type alone if the text raises another one."""
    try:
        return f"{type(error).__name__}: {error}"
    except Exception:  # noqa: BLE001  a mapper's exception may do anything
        return type(error).__name__


def _finish(result: object) -> Finish:
    """The `finish` event of what a mapper returned.

    Raises:
        InputError: the result is no map, or its cost is no integer.
    """
    vertices, edges, marker = map_parts(result)
    cost = optional_part(result, "cost")
    if cost is not None and (isinstance(cost, bool) or not hasattr(cost, "__index__")):
        raise InputError(
            f"the mapper reports the cost {cost!r}: expected a number of moves or None"
        )
    if cost is not None and index(cost).bit_length() > 64:
        # msgspec writes 64 bits; no run has so many moves.
        raise InputError("the mapper reports a cost of more than 64 bits: expected its moves")
    rotations = tuple(map(tuple, vertices))
    delivered = MapData(rotations, tuple(map(tuple, edges)), marker)
    return Finish(None if cost is None else index(cost), delivered)
