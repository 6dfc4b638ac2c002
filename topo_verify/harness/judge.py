"""The judgement of one run by every claim: `examine` runs a mapper and judges it, `judge` a run.

report = examine(my_mapper, world)             # -> Report: ok, claims, findings
assert_maps(my_mapper, world)                  # raises ClaimFailed with the report
"""

from __future__ import annotations

import shlex
from collections.abc import Sequence

import msgspec

from topo_verify.checkers import Finding, Status, check
from topo_verify.errors import ClaimFailed
from topo_verify.harness.run import Exploration, explore
from topo_verify.programs.loader import Mapper, Target
from topo_verify.programs.program import PREFIX
from topo_verify.robot.events import Event, Policies
from topo_verify.robot.limits import Limits
from topo_verify.world.enumeration import rank_order
from topo_verify.world.rooted_map import World


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


def undecided(run: Exploration, report: Report) -> bool:
    """Whether all that is wrong with the run is that a map is missing, for which none is convicted.

    That is a run that exceeded its time while it still moved, or whose program declined the world.
    """
    lost = all(f.claim == "map-isomorphic" and f.event is None for f in report.findings)
    return (run.limit == "world-timeout" or run.declined) and lost


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
