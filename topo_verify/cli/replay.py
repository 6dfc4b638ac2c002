"""`topo-verify replay`: run a mapper again in one world, or judge a trace again."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import cast

import click
import msgspec

from topo_verify.checkers import Finding, Judgement, Status
from topo_verify.cli import options
from topo_verify.cli.layout import Block, Bullets, Text
from topo_verify.cli.output import Output, Result
from topo_verify.cli.output import options as output_options
from topo_verify.cli.runs import NamedWorld, finding_line, judged, named_world, unjudged
from topo_verify.errors import InputError
from topo_verify.harness.judge import Report, in_words, judge_trace, strict_option
from topo_verify.harness.run import explore as run_mapper
from topo_verify.harness.targets import one_target, target_text
from topo_verify.robot.events import Start, read_trace
from topo_verify.robot.limits import Limits
from topo_verify.text import plural
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import World


class ReplayEntry(msgspec.Struct, frozen=True):
    """The judgement of one run: an entry of `results`; docs/commands.md.

    Attributes:
        trace: the file of the trace; None if the target was run.
        claims: the status of each claim.
        judgements: the same, with how much of the run each status rests on.
        stopped: why the mapper delivered no map, or None.
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


@click.command(
    short_help="Show a counterexample again, or judge a trace again.",
    epilog=options.epilog(
        "replay m5/17 --target enhancement-ii",
        "replay m2/9 --target my_mapper.py:explore",
        "replay trace.jsonl",
    ),
)
@click.argument("what", metavar="FILE|WORLD")
@click.option("--target", metavar="TARGET", help="The mapper to run in WORLD.  [default: basic]")
@options.program
@options.in_process
@options.policies
@options.marker
@click.option(
    "--world", "world_text", metavar="WORLD", help="The world in which the trace was recorded."
)
@options.strict
@options.limits
@output_options
def replay(  # noqa: PLR0913  an argument an option
    output: Output,
    *,
    what: str,
    target: str | None,
    command: str | None,
    in_process: bool,
    pick: str | None,
    order: str | None,
    marker: int | None,
    world_text: str | None,
    strict: bool,
    limits: Limits,
) -> int:
    """Judge a trace again, or run a mapper again in one world.

    FILE holds a trace, as explore --trace writes it; it is judged in the world that it names, or in
    that of --world. In a WORLD the mapper of --target is run.
    """

    def replayed() -> Iterator[Result[ReplayEntry]]:
        data = _bytes(what)
        if data is not None and _is_trace(data):
            # A trace has its mapper and limits behind it: an option would be ignored in silence.
            given = {"--target": target, "--cmd": command, "--pick": pick, "--order": order}
            words = [name for name, value in given.items() if value is not None]
            _require_none((*words, *limits.options), what)
            yield _judged(output, what, data, world_text, marker, strict=strict)
            return
        if world_text is not None:
            raise InputError(
                f"--world {world_text}: expected a trace, got {what}; leave --world out"
            )
        at = named_world(what, marker, data)
        text = target_text(target, command, "basic")
        mapper = one_target(text, pick=pick, order=order, in_process=in_process)
        output.progress(f"{mapper.text} in {at.name}", 0, 1)
        run = run_mapper(at.world, mapper, limits=limits)
        report, incomplete = judged(run, at, limits, strict=strict)
        yield _result(report, at, None, run.stopped, incomplete=incomplete)

    return output.run("replay", replayed, _show, in_process=in_process)


def _require_none(given: Sequence[str], what: str) -> None:
    if given:
        raise InputError(
            f"{given[0]} with the trace {what}: a trace is judged as it stands; leave the option"
            " out, or name a WORLD to run a mapper in"
        )


def _bytes(what: str) -> bytes | None:
    """The bytes of the file or of standard input; None if the argument names neither."""
    if what == "-":
        return files.read_stream(files.standard_input(), name="standard input")
    try:
        there = Path(what).is_file()
    except (OSError, ValueError):  # a name that no file can have
        there = False
    return files.read(what) if there else None


def _is_trace(data: bytes) -> bool:
    """True if the first line is an event, which has a `type`; a world file has none."""
    head = data.lstrip().split(b"\n", 1)[0]
    try:
        first = msgspec.json.decode(head)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        return False
    return isinstance(first, dict) and "type" in cast("dict[str, object]", first)


def _judged(
    output: Output,
    what: str,
    data: bytes,
    world_text: str | None,
    marker: int | None,
    *,
    strict: bool,
) -> Result[ReplayEntry]:
    """The judgement of a trace in its world."""
    name = "standard input" if what == "-" else what
    trace = read_trace(data, name=name)
    start = trace[0]
    assert isinstance(start, Start), "read_trace refuses any other first event"
    at = (
        named_world(world_text, marker)
        if world_text is not None
        else _own_world(name, start, marker)
    )
    output.progress(f"judging {name}", 0, 1)
    words = ("--world", at.argument, *at.options, *strict_option(at.world, strict=strict))
    replay_command = shlex.join(["topo-verify", "replay", what, *words])
    target = start.algorithm or "unknown"
    report = judge_trace(
        at.world,
        trace,
        target=target,
        where=at.argument,
        replay_command=replay_command,
        strict=strict,
    )
    if report.claims["percepts-true"] == "failed":
        output.note(
            f"{name} diverges from {at.argument}: it was recorded in another world (name it with"
            " --world) or by another version, or it was edited"
        )
    return _result(report, at, what, None, incomplete=report.ok and report.undecided)


def _own_world(name: str, start: Start, marker: int | None) -> NamedWorld:
    """The world that a trace names by its id.

    Only ids are accepted: a trace may come from anyone, and must not choose which file is read.
    """
    if start.world is None:
        raise InputError(f"{name} does not name its world; name it with --world")
    try:
        World.from_id(start.world)
    except InputError as error:
        raise InputError(f"{name}, line 1: {error}; name the world with --world") from error
    return named_world(start.world, marker)


def _result(
    report: Report,
    at: NamedWorld,
    trace: str | None,
    stopped: str | None,
    *,
    incomplete: bool = False,
) -> Result[ReplayEntry]:
    entry = ReplayEntry(
        world=at.name,
        target=report.target,
        ok=not report.findings and not incomplete,
        cost=report.cost,
        findings=report.findings,
        trace=trace,
        claims=report.claims,
        judgements=report.judgements,
        stopped=stopped,
    )
    return Result(entry, failed=bool(report.findings), incomplete=incomplete)


def _show(entries: Sequence[ReplayEntry]) -> Iterator[Block]:
    for entry in entries:
        words = f"{entry.target} in {entry.world}, {plural(entry.cost, 'edge traversal')}: "
        if entry.stopped is not None and not entry.ok and not entry.findings:
            yield Text(f"{words}not decided, {entry.stopped}")
            continue
        yield Text(words + in_words(entry.claims, "claims hold"))
        yield from unjudged(entry.target, entry.world, entry.judgements)
        yield Bullets(tuple(map(finding_line, entry.findings)))
