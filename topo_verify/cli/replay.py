"""`topo-verify replay`: run a mapper again in one world, or judge a trace again."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol, cast

import click
import msgspec

from topo_verify import extras
from topo_verify.campaign.judge import Report, in_words, judge_trace, strict_option
from topo_verify.checkers import Finding, Judgement, Status
from topo_verify.cli import options, runs
from topo_verify.cli.output import Output, Result, entry_of
from topo_verify.errors import InputError, plural
from topo_verify.pictures.recording import PlayedRun
from topo_verify.pictures.walk import Extent
from topo_verify.programs.loader import Target
from topo_verify.report.blocks import Block, Text
from topo_verify.robot.events import Finish, Move, Start, read_trace
from topo_verify.robot.limits import Limits
from topo_verify.studies.log_file import read_log
from topo_verify.studies.log_report import certify
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import World

OF_A_MAPPER = ("--target", "--cmd", "--library", "--pick", "--order")
"""Options that have no meaning for a trace."""

MAP = "map-isomorphic"
"""The claim that a log need not meet."""


@dataclass(frozen=True, slots=True)
class ProvedOpinion:
    """The judgement of the judge that is proved in Coq.

    Attributes:
        by: what judged; "" if Coq or OCaml is not installed.
        judgements: of the claims that Coq defines.
        why: why the run was not judged, or "".
    """

    by: str
    judgements: tuple[Judgement, ...] = ()
    why: str = ""


class SecondJudge(Protocol):
    """What an extra brings with --kernel: another judge of the same run."""

    def opinion(self, output: Output, report: Report) -> ProvedOpinion:
        """Its judgement; InternalError if it differs from the checkers'."""
        ...

    def words(self, opinion: ProvedOpinion) -> str:
        """A sentence for people."""
        ...


class ReplayEntry(msgspec.Struct, frozen=True):
    """The judgement of one run.

    Attributes:
        trace: the file of the trace; null if the target was run.
        kernel: null without --kernel.
    """

    world: str
    target: str
    ok: bool
    cost: int
    findings: tuple[Finding, ...]
    trace: str | None
    claims: dict[str, Status]
    judgements: tuple[Judgement, ...]
    stopped: str | None
    kernel: ProvedOpinion | None


@options.command(
    "replay m5/17 --target enhancement-ii",
    "replay m2/9 --target my_mapper.py:explore --all",
    "replay trace.jsonl",
    "replay trace.jsonl --kernel",
)
@click.argument("subject", metavar="FILE|WORLD")
@options.mappers("basic", meaning="The mapper to run in WORLD.", with_policies=True)
@options.marker
@click.option(
    "--world", "world_text", metavar="WORLD", help="The world in which the trace was recorded."
)
@click.option("--all", "everything", is_flag=True, help="Show the whole walk.")
@options.number(
    "--from",
    "first",
    metavar="K",
    meaning="Show the walk from event K on.  [default: the last moves before the first finding]",
)
@options.player
@extras.options("replay")
@options.strict
@options.limits
def replay(
    output: Output,
    *,
    subject: str,
    mappers: options.Mappers,
    marker: int | None,
    world_text: str | None,
    everything: bool,
    first: int | None,
    player: str | None,
    second: SecondJudge | None,
    strict: bool,
    limits: Limits,
) -> int:
    """Judge a trace again, or run a mapper again in one world, and show the walk.

    A trace from explore --trace is judged in the world that it names, or in that of --world; the
    log of a robot in that of --world, where it need not deliver a map. In a WORLD the mapper of
    --target is run. The last moves before the first finding are shown: where the robot really was,
    what the mapper decided and why, and its map beside the world. With --kernel the judge that is
    proved in Coq judges the run as well; exit code 3: Coq or OCaml is missing.
    """
    reports: list[Report] = []

    def replayed() -> Iterator[Result[ReplayEntry]]:
        runs.require_one_world(player, 1)
        data = _bytes(subject)
        is_log = world_text is not None and data is not None and subject != "-"
        if data is not None and (is_log or _is_trace(data)):
            # These options would be ignored silently.
            words = [name for name in options.given() if name in OF_A_MAPPER]
            if words := [*words, *limits.options]:
                raise InputError(
                    f"{words[0]} with the trace {subject}: a trace is judged as it stands; leave"
                    " the option out, or name a WORLD to run a mapper in"
                )
            report, stopped = _judged(output, subject, data, world_text, marker, strict=strict)
            trace, incomplete = subject, report.ok and report.undecided
        else:
            if world_text is not None:
                raise InputError(
                    f"--world {world_text}: expected a trace or a log in a file, got {subject};"
                    " leave --world out"
                )
            mapper = mappers.load_one()
            trace, at = None, runs.named_world(subject, marker, data)
            report, stopped, incomplete = _ran(output, at, mapper, limits, strict=strict)
        events = len(report.run.trace) if report.run else 1
        if first is not None and first >= events:
            raise InputError(f"--from {first}: expected an event of the run, 0 to {events - 1}")
        kernel = None if second is None else second.opinion(output, report)
        if trace is not None and _is_log(report):
            report = _of_a_log(report, "the log" if subject == "-" else Path(subject).name)
        reports.append(report)
        ok = not report.findings and not incomplete
        incomplete = incomplete or (kernel is not None and bool(kernel.why))
        entry = entry_of(ReplayEntry, report, ok=ok, trace=trace, stopped=stopped, kernel=kernel)
        yield Result(entry, failed=bool(report.findings), incomplete=incomplete)
        if player is not None and report.run is not None:
            run = report.run
            played = PlayedRun(report.target, tuple(run.trace), report.judgements, run.stopped)
            runs.write_page(player, run.world, report.world, [played])

    asked = Extent(0, to_end=True) if everything else Extent(first, to_end=first is not None)
    return output.run(
        "replay",
        replayed,
        lambda entries: _show(entries, reports, asked, second),
        in_process=mappers.in_process,
    )


def _bytes(subject: str) -> bytes | None:
    if subject == "-":
        name = "standard input"
        return files.unpacked(files.read_stream(files.standard_input(), name=name), name)
    try:
        there = Path(subject).is_file()
    except (OSError, ValueError):  # no possible file name
        there = False
    data = files.read(subject) if there else None
    # a mapper may be packed otherwise, as a .pyz
    return files.unpacked(data, subject) if data and data.startswith(files.GZIP) else data


def _is_trace(data: bytes) -> bool:
    head = data.lstrip().split(b"\n", 1)[0]
    try:
        first = msgspec.json.decode(head)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        return False
    return isinstance(first, dict) and "type" in cast("dict[str, object]", first)


def _judged(
    output: Output,
    subject: str,
    data: bytes,
    world_text: str | None,
    marker: int | None,
    *,
    strict: bool,
) -> tuple[Report, str | None]:
    name = "standard input" if subject == "-" else subject
    trace = read_trace(data, name=name) if _is_trace(data) else read_log(subject)
    start = trace[0]
    assert isinstance(start, Start), "any other first event was refused"
    at = (
        runs.named_world(world_text, marker)
        if world_text is not None
        else _own_world(name, start, marker)
    )
    output.progress(f"judging {name}", 0, 1)
    words = ("--world", at.argument, *at.options, *strict_option(at.world, strict=strict))
    replay_command = shlex.join(["topo-verify", "replay", subject, *words])
    stopped = (start.stopped or None) if not isinstance(trace[-1], Finish) else None
    report = judge_trace(
        at.world,
        trace,
        stopped,
        target=start.algorithm or "unknown",
        where=at.argument,
        replay_command=replay_command,
        strict=strict,
    )
    if report.claims["percepts-true"] == "failed":
        other = "another world" if world_text else "another world (name it with --world)"
        output.note(
            f"{name} diverges from {at.argument}: it was recorded in {other} or by another version,"
            " or it was edited"
        )
    return msgspec.structs.replace(report, world=at.name).of(report.run), stopped


def _is_log(report: Report) -> bool:
    trace = () if report.run is None else report.run.trace
    if not trace or not isinstance(start := trace[0], Start):
        return False
    no_mapper = start.algorithm is None and not start.stopped
    return no_mapper and all(isinstance(event, Move) for event in trace[1:])


def _of_a_log(report: Report, name: str) -> Report:
    """The report on the log of a robot, which is no mapper and need not deliver a map."""
    findings = [finding for finding in report.findings if finding.claim != MAP]
    run, report = report.run, report.with_findings(findings)
    judged = {judgement.claim: judgement for judgement in report.judgements}
    judged[MAP] = msgspec.structs.replace(judged[MAP], status="not-declared")
    claims = {claim: judgement.status for claim, judgement in judged.items()}
    changes = {"claims": claims, "judgements": tuple(judged.values())}
    return msgspec.structs.replace(report, target=name, ok=not findings, **changes).of(run)


def _own_world(name: str, start: Start, marker: int | None) -> runs.NamedWorld:
    """The world that a trace names by its id: a trace must not choose which file is read."""
    if start.world is None:
        raise InputError(f"{name} does not name its world; name it with --world")
    try:
        World.from_id(start.world)
    except InputError as error:
        raise InputError(f"{name}, line 1: {error}; name the world with --world") from error
    return runs.named_world(start.world, marker)


def _ran(
    output: Output, at: runs.NamedWorld, mapper: Target, limits: Limits, *, strict: bool
) -> tuple[Report, str | None, bool]:
    output.progress(f"{mapper.text} in {at.name}", 0, 1)
    run, report, incomplete = runs.judged(mapper, at, limits, strict=strict)
    return msgspec.structs.replace(report, world=at.name).of(report.run), run.stopped, incomplete


def _show(
    entries: Sequence[ReplayEntry],
    reports: Sequence[Report],
    asked: Extent,
    second: SecondJudge | None,
) -> Iterator[Block]:
    for entry, report in zip(entries, reports, strict=True):
        words = f"{entry.target} in {entry.world}, {plural(entry.cost, 'edge traversal')}: "
        undecided = entry.stopped is not None and not entry.ok and not entry.findings
        reason = f"not decided, {entry.stopped}"
        yield Text(words + (reason if undecided else in_words(entry.claims, "claims hold")))
        is_log = entry.claims[MAP] == "not-declared"
        if not undecided and not is_log:
            yield from runs.unjudged(entry.target, entry.world, entry.judgements)
        if second is not None and entry.kernel is not None:
            yield Text(second.words(entry.kernel))
        if is_log and report.run is not None and entry.ok:
            proved = certify(report.run.trace).verdict == "PROVED"
            unproved = "It does not prove its map yet: certify says where to go next."
            yield Text("The log proves its map." if proved else unproved)
        if not entry.ok or asked.to_end:
            yield Text("")
            yield from runs.walk_view(report, asked)
            yield from runs.other_findings(report, asked)
        elif not undecided:
            yield Text("Nothing is wrong; --all shows the walk.")
