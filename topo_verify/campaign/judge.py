"""Judges one run by every claim.

report = examine(my_mapper, world)             # -> Report: ok, claims, findings
assert_maps(my_mapper, world)                  # raises ClaimFailed with the report
"""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import cached_property, lru_cache
from itertools import groupby
from operator import attrgetter
from typing import TYPE_CHECKING, NamedTuple

import msgspec

from topo_verify.algorithms import NAMED
from topo_verify.campaign.engine import Checks
from topo_verify.campaign.run import EngineMapper, Exploration, explore
from topo_verify.campaign.targets import is_found_again, target_arguments
from topo_verify.checkers import CLAIMS, Finding, Judgement, Status, check
from topo_verify.checkers.claims import LARGE
from topo_verify.errors import (
    LINE,
    ClaimFailed,
    ClaimUndecided,
    ExaminationInterrupted,
    InputError,
    InternalError,
    plural,
    shown,
)
from topo_verify.programs.loader import Mapper, Target
from topo_verify.programs.program import OPTIONS
from topo_verify.robot.events import Event, MapData, Move, Policies
from topo_verify.robot.limits import Limits
from topo_verify.world import io
from topo_verify.world.enumeration import rank_order
from topo_verify.world.least_cost import least_cost
from topo_verify.world.resolve import resolve_world
from topo_verify.world.rooted_map import World

if TYPE_CHECKING:
    from topo_verify.pictures.scenes import Playback


class JudgedRun(NamedTuple):
    """A world, a trace in it, and why the run ended without a map, or None."""

    world: World
    trace: Sequence[Event]
    stopped: str | None


_RUN = "_run"

_LONG_ID = 30
"""Characters of an id, in place of which a headline has the world's name."""


class Report(msgspec.Struct, frozen=True, dict=True):
    """The judgement of every claim on one run; its text shows the walk to the first finding.

    Attributes:
        world, target: the world and the mapper, as the command line names them.
        ok: no claim failed. (Only the status `ok` is a success.)
        cost: edge traversals.
        claims: the status of each claim by name.
        findings: all violations, each with the command line that shows it again.
        judgements: the status of each claim, and how much of the run it rests on.
    """

    world: str
    target: str
    ok: bool
    cost: int
    claims: dict[str, Status]
    findings: tuple[Finding, ...]
    judgements: tuple[Judgement, ...]

    @property
    def undecided(self) -> bool:
        """Whether a claim was neither proved nor refuted."""
        return "undecided" in self.claims.values()

    @property
    def run(self) -> JudgedRun | None:
        """The judged run; None for a report that was read from a file."""
        return self.__dict__.get(_RUN)

    @cached_property
    def playback(self) -> Playback | None:
        """The run event by event, with its findings, or None."""
        from topo_verify.pictures.scenes import Playback

        if self.run is None:
            return None
        return Playback(self.run.world, self.run.trace, self.judgements, self.run.stopped)

    def walk(self) -> list[str]:
        """The lines of the walk to the first finding; may be empty."""
        from topo_verify.pictures import walk

        if not self.findings or self.playback is None:
            return []
        return ["", *walk.lines(self.playback), ""]

    def of(self, run: JudgedRun | None) -> Report:
        """This report, with the run that it judges."""
        # Not a field: JSON and equality leave it out, and the trace may be long.
        vars(self)[_RUN] = run
        return self

    def with_findings(self, findings: Sequence[Finding]) -> Report:
        """A copy of this report with other findings."""
        judgements = tuple(
            msgspec.structs.replace(
                judgement,
                findings=tuple(f for f in findings if f.claim == judgement.claim),
            )
            for judgement in self.judgements
        )
        changed = msgspec.structs.replace(self, findings=tuple(findings), judgements=judgements)
        return changed.of(self.run)

    def to_json(self) -> str:
        """The report as one JSON object."""
        return msgspec.json.encode(self).decode()

    @property
    def head(self) -> str:
        """World, mapper, cost, and how many claims hold."""
        name = "" if self.run is None else self.run.world.name
        no_id = self.world in {f"{name}.json", f"family:{name}"}  # by `world_argument`
        world = name if name and (no_id or len(self.world) > _LONG_ID) else self.world
        ran = f"{self.target} in {world}, {plural(self.cost, 'edge traversal')}"
        idle = sum(judgement.status == "ok" and not judgement.of for judgement in self.judgements)
        hold = f"claims hold ({idle} with nothing to judge)" if idle else "claims hold"
        return f"{ran}: {in_words(self.claims, hold)}"

    def __repr__(self) -> str:
        return f"<Report: {shown(self.head, limit=LINE)}>"

    def _repr_html_(self) -> str:
        from topo_verify.pictures import cards

        again = self.findings[0].replay if self.findings else ""
        playback = self.playback if self.findings else None
        return cards.report_card(self.head, self.judgements, playback, again)

    def __str__(self) -> str:
        lines = [self.head]
        lines += [f"  {line}" for line in shortfalls(self.judgements)]
        for claim, (finding, *more) in groupby(self.findings, attrgetter("claim")):
            place = "" if finding.event is None else f" (event {finding.event})"
            lines.append(f"  {claim}{place}: {finding.message}")
            lines += [f"    … and {len(more)} more"] if more else []
        lines += self.walk()
        if self.findings and self.findings[0].replay:
            lines.append(f"  again: {self.findings[0].replay}")
            if self.run is not None and self.world == file_of(self.run.world):
                lines.append(f"  (write the file first: world.save({self.world!r}))")
        return "\n".join(shown(line, limit=LINE) for line in lines)


def _card(finding: Finding) -> str:
    from topo_verify.pictures.cards import finding_card

    return finding_card(finding)


setattr(Finding, "_repr_html_", _card)  # noqa: B010  undeclared

_WORDS: dict[Status, str] = {
    "failed": "fail",
    "partial": "partial",
    "undecided": "undecided",
    "not-declared": "not declared",
    "not-asked": "not asked",
}


def in_words(claims: Mapping[str, Status], hold: str) -> str:
    """How many claims hold, and how many have each other status."""
    counts = Counter(claims.values())
    words = [f"{counts['ok']} of {len(claims)} {hold}"]
    return ", ".join(
        words + [f"{counts[status]} {word}" for status, word in _WORDS.items() if counts[status]]
    )


def shortfalls(judgements: Sequence[Judgement]) -> list[str]:
    """A line for each claim that was judged only in part."""
    return [
        f"{judgement.claim}: {_WORDS[judgement.status]}, {judgement.judged} of {judgement.of}"
        for judgement in judgements
        if judgement.status in ("partial", "undecided")
    ]


def examine(
    mapper: Mapper | str | Target,
    world: World | str,
    *,
    pick: str | None = None,
    order: str | None = None,
    limits: Limits | None = None,
    where: str | None = None,
    strict: bool = False,
) -> Report:
    """Run a mapper in a world and judge the run by every claim.

    If another world shows the same trace, the mapper also runs there, so it may print twice.

    Args:
        where: the world's name in findings; default: its id.
        strict: judge claim 10 also in worlds with more than 2,000 edges.
    Raises:
        InputError: there is no such mapper or policy.
        ExaminationInterrupted: Ctrl-C, a KeyboardInterrupt.
    """
    try:
        run = explore(world, mapper, pick=pick, order=order, limits=limits)
        return judge(run, where=where, options=limits.options if limits else (), strict=strict)
    except KeyboardInterrupt as ctrl_c:
        stopped = ExaminationInterrupted("the mapper is not judged")
        raise stopped.with_traceback(ctrl_c.__traceback__) from None


def assert_maps(
    mapper: Mapper | str | Target,
    world: World | str,
    *,
    pick: str | None = None,
    order: str | None = None,
    limits: Limits | None = None,
    strict: bool = False,
) -> None:
    """Assert that every claim holds of a mapper in a world, e.g. in a property test.

    The run ends at its first false `augment`, since no later decision is judged: a faulty mapper
    may go on for a minute.

    Args:
        strict: judge claim 10 also in worlds with more than 2,000 edges.
    Raises:
        ClaimFailed: a claim fails. An AssertionError whose text is the report; its cause is the
            mapper's exception, if any.
        ClaimUndecided: no claim fails, but one is undecided. An AssertionError, too.
        InputError: there is no such mapper or policy.
    """
    run = explore(world, mapper, pick=pick, order=order, limits=limits, stop_if_false=True)
    report = judge(run, options=limits.options if limits else (), strict=strict)
    if not report.ok:
        # The report, not its text: Hypothesis repeats a failing example, and the text takes time.
        raise ClaimFailed(report) from run.error
    if report.undecided:
        names = ", ".join(name for name, status in report.claims.items() if status == "undecided")
        raise ClaimUndecided(f"nothing is refuted, and {names} is not decided: {report}")


class CheckedTraces:
    """Checks each distinct trace in a world once: mappers in small worlds often leave the same.

    The checkers read only the percept of a `start`; the rest is compared as bytes.
    """

    def __init__(self) -> None:
        self._known: dict[object, list[Judgement]] = {}

    def __call__(
        self, world: World, trace: Sequence[Event], stopped: str | None = None, *, strict: bool
    ) -> list[Judgement]:
        """Judge as `check` does."""
        start, *events = trace
        kinds = tuple(map(type, trace))
        try:
            encoded = _encoder.encode((getattr(start, "percept", None), events))
        except (TypeError, ValueError, OverflowError):
            return check(world, trace, stopped, strict=strict)
        key = world, kinds, encoded, stopped, strict
        if key not in self._known:
            self._known[key] = check(world, trace, stopped, strict=strict)
        return self._known[key]


_encoder = msgspec.msgpack.Encoder()


def judge(
    run: Exploration,
    *,
    where: str | None = None,
    options: Sequence[str] = (),
    strict: bool = False,
    known: Checks | None = None,
) -> Report:
    """Judge a run by every claim; the arguments are those of `examine` and `judge_trace`.

    Of a run that `is_for_engine`, the engine's judge replaces `check`.
    If the history does not entail the map, the mapper also runs in the witness world, where a
    deterministic mapper makes the same moves. Of a run without a trace only `TRACELESS` are
    judged.
    """
    where = where or world_argument(run.world)
    words = (*options, *strict_option(run.world, strict=strict))
    replay_command = replay_line(where, run.algorithm, run.policies, words)
    if not run.trace:
        return _judge_result(run, where, replay_command)
    if known is None and is_for_engine(run, strict=strict):
        assert isinstance(run.mapper, EngineMapper)
        known = run.mapper.checks()
    report = judge_trace(
        run.world,
        run.trace,
        run.stopped,
        target=run.algorithm,
        where=where,
        replay_command=replay_command,
        strict=strict,
        known=known,
    )
    report = _with_count(report, run.cost, replay_command)
    if not report.findings:
        return report
    lucky = report.claims["map-isomorphic"] == "ok"
    return report.with_findings(
        [_with_run_in_witness(finding, run, words, lucky=lucky) for finding in report.findings]
    )


def is_for_engine(run: Exploration, *, strict: bool) -> bool:
    """Whether an engine judges its own run, and the checkers only what it does not pass."""
    return isinstance(run.mapper, EngineMapper) and run.mapper.judges(run.world, strict=strict)


TRACELESS = ("map-isomorphic", "cost-within-bound")
"""The claims that are judged without a trace."""


def _judge_result(run: Exploration, where: str, replay_command: str) -> Report:
    world = run.world
    held = (run.map is not None and _is_map_of(world, run.map), run.cost <= world.cost_bound)
    wrong = {
        claim: Finding(
            claim, None, "it holds", None, run.stopped or "it fails", None, where, replay_command
        )
        for claim, holds in zip(TRACELESS, held, strict=True)
        if not holds
    }
    statuses: dict[str, Status] = dict.fromkeys(CLAIMS, "not-asked")
    statuses |= {claim: "failed" if claim in wrong else "ok" for claim in TRACELESS}
    judgements = tuple(
        Judgement(claim, status, (asked := int(claim in TRACELESS)), asked)
        for claim, status in statuses.items()
    )
    report = Report(where, run.algorithm, not wrong, run.cost, statuses, (), judgements)
    return _with_least(report.with_findings([*wrong.values()]), world, replay_command)


def _is_map_of(world: World, delivered: MapData) -> bool:
    try:
        return World.from_map(delivered).code == world.code
    except InputError:
        return False


def judge_trace(  # noqa: PLR0913  an argument an option
    world: World,
    trace: Sequence[Event],
    stopped: str | None = None,
    *,
    target: str,
    where: str | None = None,
    replay_command: str | None = None,
    strict: bool = False,
    known: Checks | None = None,
) -> Report:
    """Judge a trace of any origin in its world.

    Args:
        target: the mapper, as the command line names it.
        where: the world's name in findings; default: its id.
        replay_command: default: `replay` of the target in the world.
        known: replaces `check`.
    Raises:
        InputError: the trace does not begin with its only `start`, or goes on after `finish`.
        InternalError: a catalogue algorithm is right at a cost below that of any proof.
    """
    where = where or world_argument(world)
    replay_command = replay_command or replay_line(where, target)
    judgements = (known or check)(world, trace, stopped, strict=strict)
    findings = tuple(
        msgspec.structs.replace(
            finding,
            world=where,
            replay=replay_command,
            message=shown(finding.message, limit=LINE),  # it may quote an exception
        )
        for judgement in judgements
        for finding in judgement.findings
    )
    cost = len([event for event in trace if isinstance(event, Move)])
    statuses: dict[str, Status] = {judgement.claim: judgement.status for judgement in judgements}
    report = Report(where, target, not findings, cost, statuses, (), tuple(judgements))
    report = report.of(JudgedRun(world, trace, stopped))
    if findings:
        report = report.with_findings(findings)
    return _with_least(report, world, replay_command)


def _with_least(report: Report, world: World, replay_command: str) -> Report:
    """The report; `cost-within-bound` fails if a right run costs less than any proof of the map."""
    if not report.ok or report.cost >= (least := least_cost(world.code)):
        return report
    message = f"no claim fails at a cost of {report.cost}, and the least cost of a proof is {least}"
    if report.target in NAMED:
        raise InternalError(f"{report.world}, {report.target}: {message}")
    message = f"{message}: somebody changed the checkers, as a mapper in the same process can"
    claim = "cost-within-bound"
    wrong = Finding(claim, None, f"at least {least}", report.cost, message, None, report.world)
    return _failing(report, msgspec.structs.replace(wrong, replay=replay_command), report.cost)


def _with_count(report: Report, moves: int, replay_command: str) -> Report:
    """The report; `cost-honest` fails unless the trace holds as many moves as the robot made."""
    if report.cost == moves:
        return report
    claim = "cost-honest"
    message = (
        f"the robot made {moves} moves and the trace holds {report.cost}: somebody changed the"
        " trace, as a mapper in the same process can"
    )
    wrong = Finding(
        claim, None, moves, report.cost, message, world=report.world, replay=replay_command
    )
    return _failing(report, wrong, moves)


def _failing(report: Report, wrong: Finding, cost: int) -> Report:
    claim = wrong.claim
    judgements = tuple(
        msgspec.structs.replace(known, status="failed") if known.claim == claim else known
        for known in report.judgements
    )
    claims: dict[str, Status] = {**report.claims, claim: "failed"}
    changed = msgspec.structs.replace(
        report, ok=False, cost=cost, claims=claims, judgements=judgements
    )
    return changed.of(report.run).with_findings([wrong, *report.findings])


def undecided(run: Exploration, report: Report) -> bool:
    """Whether no claim is refuted, but one is undecided or a map is missing without a fault.

    The latter: the time ran out during moves, or a program declined the world.
    """
    if not report.findings:
        return report.undecided
    lost = all(f.claim == "map-isomorphic" and f.event is None for f in report.findings)
    return (run.limit == "world-timeout" or run.declined) and lost


def _with_run_in_witness(
    finding: Finding, run: Exploration, options: Sequence[str], *, lucky: bool
) -> Finding:
    """The finding, with the mapper's run in the witness world that it names, if any."""
    if finding.claim != "map-entailed" or finding.witness is None or run.mapper is None:
        return finding
    witness = io.from_text(finding.witness)
    if witness.is_isomorphic(run.world):  # the wrong map is another finding
        return finding
    there = explore(witness, Target(run.algorithm, run.mapper), limits=run.limits)
    failed = {j.claim for j in check(witness, there.trace, there.stopped) if j.status == "failed"}
    wrong = "map-isomorphic" in failed
    result = "the mapper is wrong" if wrong else "the mapper was lucky again"
    result = str(there.stopped) if there.limit is not None else result
    name, again = (
        finding.witness,
        replay_line(finding.witness, run.algorithm, run.policies, options),
    )
    if len(name) >= 200:
        name = f"of {len(witness.edges)} edges (the field `witness` of the JSON has it)"
        again = ""
    luck = "; the map is right here by luck, for another world shows the same" if lucky else ""
    message = f"{finding.message}{luck}; witness {name}: run there, {result}"
    message += f": {again}" if again else ""
    return msgspec.structs.replace(finding, message=message)


def world_argument(world: World) -> str:
    """The world as an argument of a command: its id, else its family, else a file."""
    if len(world.edges) <= rank_order.MAX_ID_EDGES:
        return world.id
    if "(" in world.name:
        with suppress(InputError):
            text = f"family:{world.name}"
            if resolve_world(text).code == world.code:
                return text
    return file_of(world)


def file_of(world: World) -> str:
    """The file that a user may write a world into."""
    return f"{world.name or 'world'}.json"


def strict_option(world: World, *, strict: bool) -> tuple[str, ...]:
    """The option `--strict`, if it matters in this world."""
    return ("--strict",) if strict and len(world.edges) > LARGE else ()


def replay_line(
    where: str, target: str, policies: Policies | None = None, options: Sequence[str] = ()
) -> str:
    """The command line that shows a run again; empty if none finds the mapper."""
    words = _words_after_world(target, policies, tuple(options))
    return words and f"topo-verify replay {shlex.quote(where)} {words}"


@lru_cache(maxsize=64)  # asked for in each world
def _words_after_world(target: str, policies: Policies | None, options: tuple[str, ...]) -> str:
    own_option = target.startswith(OPTIONS)
    if not (own_option or is_found_again(target)):
        return ""
    words = [*target_arguments(target)] if own_option else ["--target", target]
    for name, default in (("pick", "nearest"), ("order", "shortest")):
        value = getattr(policies, name, default)
        words += [f"--{name}", value] if value != default else []
    return shlex.join([*words, *options])
