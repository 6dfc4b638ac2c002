"""The one way to run a mapper in a world: `explore` runs it, `examine` runs and judges it.

A **mapper** is any callable that takes a robot and returns a map: an object with the attributes, or
a mapping with the keys, `vertices`, `edges`, `marker`, and optionally `cost`. It is not trusted: if
it raises, returns something else, exceeds its budget or loops without moving, that is a finding.

    run    = explore(world, "enhancement-ii")      # -> Exploration: map, cost, trace
    report = examine(my_mapper, world)             # -> Report: ok, claims, findings
    assert_maps(my_mapper, world)                  # raises ClaimFailed with the report

What this does not show: a mapper in the same process can be stopped only if it runs Python code and
does not catch BaseException in a loop; see `topo_verify.robot.limits`.
"""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from dataclasses import dataclass, field
from operator import index

import msgspec

from topo_verify.algorithms import Algorithm
from topo_verify.checkers import Finding, Status, check
from topo_verify.errors import ClaimFailed, InputError
from topo_verify.harness.targets import one_target
from topo_verify.programs.loader import Mapper, Target
from topo_verify.programs.program import PREFIX, Program
from topo_verify.robot.events import (
    Confirm,
    Event,
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


class Report(msgspec.Struct, frozen=True):
    """The judgement of every claim on one run.

    Attributes:
        world, target: the world and the mapper, as the command line names them.
        ok: no claim failed. (`not-declared` and `not-asked` are neither failures nor successes.)
        cost: edge traversals.
        claims: the status of each claim by name.
        findings: all violations, each with the command line that shows it again.
    """

    world: str
    target: str
    ok: bool
    cost: int
    claims: dict[str, Status]
    findings: tuple[Finding, ...]

    def to_json(self) -> str:
        """The report as one JSON object."""
        return msgspec.json.encode(self).decode()

    def __str__(self) -> str:
        held = sum(status == "ok" for status in self.claims.values())
        failed = sum(status == "failed" for status in self.claims.values())
        unasked = sum(status == "not-asked" for status in self.claims.values())
        silent = list(self.claims.values()).count("not-declared")
        head = f"{self.target} in {self.world}, {self.cost} edge traversals: "
        head += f"{held} of {len(self.claims)} claims hold"
        head += f", {failed} fail" if failed else ""
        head += f", {silent} not declared" if silent else ""
        head += f", {unasked} not asked" if unasked else ""
        lines = [head]
        for finding in self.findings:
            place = "" if finding.event is None else f" (event {finding.event})"
            lines.append(f"  {finding.claim}{place}: {finding.message}")
        if self.findings:
            lines.append(f"  again: {self.findings[0].replay}")
        return "\n".join(lines)


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
    if isinstance(target.mapper, Program):
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
    )


def examine(
    mapper: Mapper | str | Target,
    world: World,
    *,
    pick: str | None = None,
    order: str | None = None,
    limits: Limits | None = None,
    where: str | None = None,
    strict: bool = False,
) -> Report:
    """Run a mapper in a world and judge the run by every claim.

    Args:
        where: the world as the command line names it, for the findings; default: its id.
        strict: judge claim 10 also in worlds with more than 100 edges.
    Raises:
        InputError: there is no such mapper or policy.
    """
    run = explore(world, mapper, pick=pick, order=order, limits=limits)
    return judge(run, where=where, options=limits.options if limits else (), strict=strict)


def assert_maps(
    mapper: Mapper | str | Target,
    world: World,
    *,
    pick: str | None = None,
    order: str | None = None,
    limits: Limits | None = None,
    strict: bool = False,
) -> None:
    """Assert that every claim holds of a mapper in a world: the one line of a property test.

    Args:
        strict: judge claim 10 also in worlds with more than 100 edges.
    Raises:
        ClaimFailed: a claim fails. It is an AssertionError whose text is the report; its cause is
            the exception that the mapper raised, if it did.
        InputError: there is no such mapper or policy.
    """
    run = explore(world, mapper, pick=pick, order=order, limits=limits)
    report = judge(run, options=limits.options if limits else (), strict=strict)
    if not report.ok:
        raise ClaimFailed(str(report)) from run.error


def judge(
    run: Exploration,
    *,
    where: str | None = None,
    options: Sequence[str] = (),
    strict: bool = False,
) -> Report:
    """Judge a run by every claim; see `examine`.

    If the history does not entail the map, the mapper also runs in the witness world, with the same
    limits. (A deterministic mapper makes the same moves there, since its percepts are the same.)

    Args:
        options: the options that the replay command needs besides world and target.
    """
    where = where or world_argument(run.world)
    replay_command = replay_line(where, run.algorithm, run.policies, options)
    report = judge_trace(
        run.world,
        run.trace,
        run.stopped,
        target=run.algorithm,
        where=where,
        replay_command=replay_command,
        strict=strict,
    )
    findings = tuple(_with_run_in_witness(finding, run) for finding in report.findings)
    return msgspec.structs.replace(report, findings=findings)


def undecided(run: Exploration, report: Report) -> bool:
    """Whether the run only exceeded its time while it still moved: then no claim is refuted."""
    lost = all(f.claim == "map-isomorphic" and f.event is None for f in report.findings)
    return run.limit == "world-timeout" and lost


def _with_run_in_witness(finding: Finding, run: Exploration) -> Finding:
    """The finding; if it names a witness of a wrong map, with what the same mapper does there."""
    if finding.claim != "map-entailed" or finding.witness is None or run.mapper is None:
        return finding
    witness = World.from_text(finding.witness)
    there = explore(witness, Target(run.algorithm, run.mapper), limits=run.limits)
    failed = {j.claim for j in check(witness, there.trace, there.stopped) if j.status == "failed"}
    wrong = "map-isomorphic" in failed
    result = "the mapper is wrong" if wrong else "the mapper was lucky again"
    result = str(there.stopped) if there.limit is not None else result
    message = f"{finding.message}; witness {_short(finding.witness)}: run there, {result}"
    return msgspec.structs.replace(finding, message=message)


def _short(witness: str) -> str:
    return witness if len(witness) < 200 else "as given"


def judge_trace(
    world: World,
    trace: Sequence[Event],
    stopped: str | None = None,
    *,
    target: str,
    where: str | None = None,
    replay_command: str | None = None,
    strict: bool = False,
) -> Report:
    """Judge a trace of any origin in its world.

    Args:
        target: the mapper that left the trace, as the command line names it.
        where: the world as the command line names it; default: its id.
        replay_command: the command line that shows the findings again; default: `replay` of the
            target in the world.
    Raises:
        InputError: the trace does not begin with its only `start`, or goes on after `finish`.
    """
    where = where or world_argument(world)
    replay_command = replay_command or replay_line(where, target)
    judgements = check(world, trace, stopped, strict=strict)
    findings = tuple(
        msgspec.structs.replace(finding, world=where, replay=replay_command)
        for judgement in judgements
        for finding in judgement.findings
    )
    cost = sum(event.__class__.__name__ == "Move" for event in trace)
    statuses: dict[str, Status] = {judgement.claim: judgement.status for judgement in judgements}
    return Report(where, target, not findings, cost, statuses, findings)


def world_argument(world: World) -> str:
    """The argument that names this world: its id; if it is too large for one, a file to save."""
    return (
        world.id if len(world.edges) <= rank_order.MAX_ID_EDGES else f"{world.name or 'world'}.json"
    )


def replay_line(
    where: str, target: str, policies: Policies | None = None, options: Sequence[str] = ()
) -> str:
    """The command line that shows a run again."""
    words = ["topo-verify", "replay", where]
    program = target.startswith(PREFIX)
    words += ["--cmd", target.removeprefix(PREFIX)] if program else ["--target", target]
    for name, default in (("pick", "nearest"), ("order", "shortest")):
        value = getattr(policies, name, default)
        words += [f"--{name}", value] if value != default else []
    return shlex.join([*words, *options])


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
