"""The one way to run a mapper: `explore` runs it, `examine` runs and judges it.

A **mapper** is any callable that takes a robot and returns a map: an object with the attributes, or
a mapping with the keys, `vertices`, `edges`, `marker`, and optionally `cost`. It is not trusted: if
it raises, returns nonsense, walks past its budget or loops without moving, that is a finding.

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
from topo_verify.programs.loading import Mapper, Target
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
        world: where.
        algorithm: the mapper's name, as a TARGET of the command line.
        policies: its policies, or None where they are not known.
        trace: everything that happened; with the world it is a certificate.
        map: the map that it delivered, or None.
        stopped: why it delivered none, or None.
        cost: the number of moves, in edge traversals, as counted by the simulator.
        error: the exception that it raised, if it did.
        limit: which limit ended it, if one did.
        mapper: what was run.
        limits: what it was allowed.
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
    """What the checkers say of one run.

    Attributes:
        world, target: what was run where, as the command line names them.
        ok: no claim failed. (`not-declared` and `not-asked` are no failures, and no successes.)
        cost: edge traversals.
        claims: the status of each claim by name.
        findings: everything that is wrong, with the command line that shows it again.
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
        The run; also of a mapper that failed (then `map` is None and `stopped` says why).
    Raises:
        InputError: no such mapper or policy.
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
        where: how the command line names the world, for the findings; default: its id.
        strict: ask claim 10 also in worlds with more than 100 edges.
    Raises:
        InputError: no such mapper or policy.
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
    """Examine a mapper in a world; the one line of a property test.

    Args:
        strict: ask claim 10 also in worlds with more than 100 edges.
    Raises:
        ClaimFailed: a claim fails; an AssertionError whose text is the report. If the mapper
            raised, its exception is the cause.
        InputError: no such mapper or policy.
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
    """Judge a run that took place; see `examine`.

    A map that was not proved is put to the test: the mapper is run in the witness world, too, with
    the same limits. (The witness has the same history: there a mapper makes the same moves again.)

    Args:
        options: what the command line that shows the run again needs besides world and target.
    """
    where = where or world_argument(run.world)
    again = replay_line(where, run.algorithm, run.policies, options)
    report = judge_trace(
        run.world,
        run.trace,
        run.stopped,
        target=run.algorithm,
        where=where,
        again=again,
        strict=strict,
    )
    findings = tuple(_put_to_the_test(finding, run) for finding in report.findings)
    return msgspec.structs.replace(report, findings=findings)


def undecided(run: Exploration, report: Report) -> bool:
    """Did it only run out of time while it moved on? Then nobody knows whether it is right."""
    lost = all(f.claim == "map-isomorphic" and f.event is None for f in report.findings)
    return run.limit == "world-timeout" and lost


def _put_to_the_test(finding: Finding, run: Exploration) -> Finding:
    """A finding that names a witness of a wrong map, with what the same mapper does there."""
    if finding.claim != "map-entailed" or finding.witness is None or run.mapper is None:
        return finding
    witness = World.from_text(finding.witness)
    there = explore(witness, Target(run.algorithm, run.mapper), limits=run.limits)
    failed = {j.claim for j in check(witness, there.trace, there.stopped) if j.status == "failed"}
    wrong = "map-isomorphic" in failed
    told = "run there, the mapper is wrong" if wrong else "run there, the mapper was lucky again"
    told = f"run there, {there.stopped}" if there.limit is not None else told
    message = f"{finding.message}; witness {_short(finding.witness)}: {told}"
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
    again: str | None = None,
    strict: bool = False,
) -> Report:
    """Judge a trace, wherever it comes from, in its world.

    Args:
        target: the mapper that left the trace, as the command line names it.
        where: how the command line names the world; default: its id.
        again: the command line that shows the findings again; default: the target run anew.
    Raises:
        InputError: the trace does not begin with its only `start`, or goes on after `finish`.
    """
    where = where or world_argument(world)
    again = again or replay_line(where, target)
    judgements = check(world, trace, stopped, strict=strict)
    findings = tuple(
        msgspec.structs.replace(finding, world=where, replay=again)
        for judgement in judgements
        for finding in judgement.findings
    )
    cost = sum(event.__class__.__name__ == "Move" for event in trace)
    statuses: dict[str, Status] = {judgement.claim: judgement.status for judgement in judgements}
    return Report(where, target, not findings, cost, statuses, findings)


def world_argument(world: World) -> str:
    """How the command line names this world: its id; where it is too large, a file to be saved."""
    return (
        world.id if len(world.edges) <= rank_order.MAX_ID_EDGES else f"{world.name or 'world'}.json"
    )


def replay_line(
    where: str, target: str, policies: Policies | None = None, options: Sequence[str] = ()
) -> str:
    """The command line that shows a run again."""
    words = ["topo-verify", "replay", where]
    command = target.removeprefix("--cmd ")  # of a program; docs/oracle.md
    words += ["--target", target] if command == target else ["--cmd", command]
    for name, default in (("pick", "nearest"), ("order", "shortest")):
        value = getattr(policies, name, default)
        words += [f"--{name}", value] if value != default else []
    return shlex.join([*words, *options])


def _run(
    mapper: Mapper, robot: SimulatedRobot, limits: Limits
) -> tuple[Finish | None, str | None, BaseException | None, Limit | None]:
    """What the mapper delivered; or why nothing, what it raised and which limit stopped it."""
    finish: Finish | None = None
    why: str | None = None
    error: BaseException | None = None

    def survey() -> tuple[Finish | None, str | None, Exception | None]:
        result = mapper(robot)
        try:
            return _finish(result), None, None  # within the limits: a result may run code
        except InputError as nonsense:
            return None, str(nonsense), None
        except Exception as raised:  # noqa: BLE001  an object that does not let itself be read
            return None, f"what was delivered cannot be read: {_told(raised)}", raised

    try:
        finish, why, error = within(limits, lambda: robot.cost, survey)
    except MapperStopped as stop:
        stop = robot.stopped or stop
        return None, str(stop), None, stop.limit
    except (Exception, SystemExit) as raised:  # noqa: BLE001  whatever it is, it is a finding
        error = raised
    if robot.stopped is not None:  # the mapper swallowed the exception and went on
        return None, str(robot.stopped), error, robot.stopped.limit
    if error is not None:
        return None, why or f"the mapper raised {_told(error)}", error, None
    return finish, why, None, None


def _told(error: BaseException) -> str:
    """The exception in words; one whose words cannot be had, by its name alone."""
    try:
        return f"{type(error).__name__}: {error}"
    except Exception:  # noqa: BLE001  a mapper's exception may do anything
        return type(error).__name__


def _finish(result: object) -> Finish:
    """The `finish` event of what a mapper returned.

    Raises:
        InputError: it is no map, or its cost no integer.
    """
    vertices, edges, marker = map_parts(result)
    cost = optional_part(result, "cost")
    if cost is not None and (isinstance(cost, bool) or not hasattr(cost, "__index__")):
        raise InputError(f"the mapper reports the cost {cost!r}: it is a number of moves or None")
    if cost is not None and index(cost).bit_length() > 64:
        raise InputError("the mapper reports a cost of more than 64 bits: no run has so many moves")
    rotations = tuple(map(tuple, vertices))
    delivered = MapData(rotations, tuple(map(tuple, edges)), marker)
    return Finish(None if cost is None else index(cost), delivered)
