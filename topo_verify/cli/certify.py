"""`topo-verify certify`: what a log of percepts and doors proves, with no world at all."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import IO

import click
import msgspec

from topo_verify.checkers import Finding
from topo_verify.cli import options
from topo_verify.cli.kernel_check import (
    CertificateEntry,
    KernelCheck,
    checked_certificate,
    checking,
    prove,
    show_proof,
    show_received,
)
from topo_verify.cli.output import Output, Result
from topo_verify.cli.output import options as output_options
from topo_verify.cli.runs import finding_line
from topo_verify.errors import InputError
from topo_verify.harness.log_report import Certificate
from topo_verify.harness.log_report import certify as judge
from topo_verify.harness.open_doors import OpenDoor, open_doors
from topo_verify.report.blocks import Block, Bullets, Text, TextTable
from topo_verify.robot.events import Trace, read_events
from topo_verify.robot.limits import MOST_SECONDS
from topo_verify.text import plural
from topo_verify.world.enumeration.rank_order import MAX_ID_EDGES
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import World

MOST_OPEN_DOORS = 100
"""So many open doors of a log are listed, the nearest; more would not help who has to walk them."""


class DecisionCount(msgspec.Struct, frozen=True):
    """How many of the declared decisions follow from the log before them."""

    entailed: int
    total: int


class CertifyEntry(msgspec.Struct, frozen=True):
    """One log: an entry of `results`; docs/commands.md.

    Attributes:
        verdict: PROVED. UNKNOWN: the log is incomplete, true of several worlds. REFUTED: no world
            shows it, or a map or decision in it does not follow.
        vertices, edges: of the proved map; of the smaller witness if there is none.
        open_doors: those of an incomplete log, nearest to its end first; at most 100.
        witnesses: two worlds that show this log and differ: the files if written, else the ids.
        kernel: the certificate for Coq; null without --kernel.
    """

    trace: str
    verdict: str
    vertices: int
    edges: int
    open_darts: int
    open_doors: tuple[OpenDoor, ...]
    decisions: DecisionCount
    witnesses: tuple[str, ...]
    findings: tuple[Finding, ...]
    kernel: KernelCheck | None


@click.command(
    short_help="Judge a log with no world: is its map proved?",
    epilog=options.epilog(
        "certify log.jsonl",
        "certify log.jsonl -o map.json",
        "certify log.jsonl --witness worlds",
        "certify log.jsonl --kernel",
        "certify --check certificate_log.cert --log log.jsonl",
    ),
)
@click.argument("traces", nargs=-1, metavar="TRACE...")
@click.option("-o", "map_file", metavar="MAP", help="Write the proved map (one TRACE only).")
@click.option(
    "--witness", "folder", metavar="DIR", help="Write two worlds that show the log to DIR."
)
@click.option("--kernel", "proving", is_flag=True, help="Write a certificate for Coq and check it.")
@click.option("--check", "received", metavar="CERTIFICATE", help="Check a certificate with Coq.")
@click.option("--log", "about", metavar="LOG", help="With --check: it must be about this log.")
@click.option(
    "--timeout",
    type=click.IntRange(1, MOST_SECONDS),
    default=600,
    show_default=True,
    metavar="SECONDS",
    help="Time limit of each program that checks a certificate.",
)
@output_options
def certify(  # noqa: PLR0913  an argument an option
    output: Output,
    *,
    traces: tuple[str, ...],
    map_file: str | None,
    folder: str | None,
    proving: bool,
    received: str | None,
    about: str | None,
    timeout: int,
) -> int:
    """Judge logs of percepts and doors, with no world at all.

    TRACE is a file in JSON Lines, or - for standard input: a `start` with the first percept, then a
    `move` with door and percept for each edge that was crossed. PROVED: one world alone shows this
    log, and it is the map. UNKNOWN (exit code 3): the log is incomplete, several worlds show it;
    the doors that it left open are named, each with a way there. REFUTED (1): no world shows it, or
    a map or decision that it delivers does not follow. With --kernel the same is stated in Coq for
    that very log, in a file certificate_LOG.cert, and proved by computation. So are the delivered
    map, and each declared decision that follows from the log before it. Where something cannot be
    checked the exit code is 3.

    With --check a certificate that you received is checked by Coq: accepted (0), refused (1), not
    readable as a certificate (2), or not checked, for want of Coq or of time (3).
    """
    _require_one_task(traces, received, about, others=bool(map_file or folder or proving))
    if received is not None:

        def checked() -> Iterator[Result[CertificateEntry]]:
            with checking(output, timeout) as check:
                log = None if about is None else _read(about)
                yield checked_certificate(received, log, check)

        return output.run("certify", checked, show_received)

    def certified() -> Iterator[Result[CertifyEntry]]:
        if map_file is not None and len(traces) != 1:
            raise InputError(f"-o {map_file}: expected one TRACE, got {len(traces)}")
        with checking(output, timeout) as check:
            for number, trace in enumerate(traces):
                output.progress(f"folding {trace}", number, len(traces))
                log = _read(trace)
                certificate = _judged(log, _name(trace))
                if map_file is not None and certificate.map is not None:
                    files.write(map_file, certificate.map.to_json() + "\n")
                proof = prove(traces, number, log, certificate, check) if proving else None
                yield _result(trace, certificate, folder, proof)

    return output.run("certify", certified, _show)


def _name(trace: str) -> str:
    return "standard input" if trace == "-" else trace


def _require_one_task(
    traces: tuple[str, ...], received: str | None, about: str | None, *, others: bool
) -> None:
    """Raise UsageError unless logs are judged or a certificate is checked, and not both."""
    if received is None:
        if not traces:
            raise click.UsageError("Missing argument 'TRACE...'.")
        if about is not None:
            raise click.UsageError("--log LOG goes with --check CERTIFICATE: give both")
    elif traces or others:
        raise click.UsageError(
            "--check CERTIFICATE takes --log LOG and --timeout, and no TRACE or other option"
        )


def _read(trace: str) -> Trace:
    with _opened(trace) as stream:
        return tuple(read_events(files.lines(stream, name=_name(trace)), name=_name(trace)))


def _opened(trace: str) -> AbstractContextManager[IO[bytes]]:
    return nullcontext(files.standard_input()) if trace == "-" else files.opened(trace)


def _judged(log: Trace, name: str) -> Certificate:
    try:
        return judge(log)
    except InputError as error:
        raise InputError(f"{name}: {error}") from error


def _result(
    trace: str, certificate: Certificate, folder: str | None, proof: KernelCheck | None
) -> Result[CertifyEntry]:
    replay_command = shlex.join(["topo-verify", "certify", trace])
    findings = tuple(
        msgspec.structs.replace(finding, replay=replay_command) for finding in certificate.findings
    )
    entry = CertifyEntry(
        trace=trace,
        verdict=certificate.verdict,
        vertices=certificate.vertices,
        edges=certificate.edges,
        open_darts=certificate.open_darts,
        open_doors=tuple(open_doors(certificate, MOST_OPEN_DOORS)),
        decisions=DecisionCount(certificate.entailed, certificate.decisions),
        witnesses=_witnesses(trace, certificate, folder),
        findings=findings,
        kernel=proof,
    )
    # A log that is proved but not certified is no failure of the mapper: exit 3, not 1.
    unchecked = proof is not None and proof.incomplete
    incomplete = unchecked or certificate.verdict == "UNKNOWN"
    return Result(entry, failed=bool(findings), incomplete=incomplete)


def _witnesses(trace: str, certificate: Certificate, folder: str | None) -> tuple[str, ...]:
    """The two worlds that show an incomplete log: the files, or the ids, or how large they are."""
    if certificate.map is not None or certificate.fold is None:
        return ()
    sizes = (certificate.edges, certificate.edges + certificate.open_darts)
    # A world is made where it is asked for, or small: it may have a million exits.
    if folder is None and max(sizes) > MAX_ID_EDGES:
        return tuple(f"a world of {size} edges (--witness DIR writes it)" for size in sizes)
    if folder is None:
        return tuple(world.id for world in certificate.witnesses)
    return tuple(
        _written(folder, f"{Path(trace).stem}-witness-{number}.json", world)
        for number, world in enumerate(certificate.witnesses, 1)
    )


def _written(folder: str, name: str, world: World) -> str:
    path = str(options.make_folder(folder, "--witness") / name)
    files.write(path, world.to_json() + "\n")
    return path


def _show(entries: Sequence[CertifyEntry]) -> Iterator[Block]:
    rows = [
        (e.trace, e.verdict, str(e.vertices), str(e.edges), str(e.open_darts), _decisions(e))
        for e in entries
    ]
    columns = ("log", "verdict", ">vertices", ">edges", ">open darts", "decisions that follow")
    yield TextTable(columns, rows)
    for entry in entries:
        if entry.findings:
            yield Text("")
            yield Text(f"{entry.trace}:")
            yield Bullets(tuple(map(finding_line, entry.findings[:5])))
        if entry.open_doors:
            yield Text("")
            yield Text(f"{entry.trace}: {_incomplete(entry)}")
            yield Bullets(tuple(map(_door_line, entry.open_doors[:5])))
        if entry.witnesses:
            yield Text(f"{plural(len(entry.witnesses), 'world')} that show this log and differ:")
            yield Bullets(entry.witnesses)
        if entry.kernel is not None:
            yield from show_proof(entry.kernel)


def _incomplete(entry: CertifyEntry) -> str:
    """The sentence above the open doors."""
    doors = plural(entry.open_darts, "door")
    nearest = ", the nearest five" if entry.open_darts > 5 else ""
    return f"incomplete, true of several worlds, with {doors} never crossed{nearest}:"


def _door_line(door: OpenDoor) -> str:
    """Where to find an open door, and how to get there."""
    way = ", ".join(map(str, door.walk))
    doors = "door" if len(door.walk) == 1 else "doors"
    return (
        f"door {door.door} of the place reached at event {door.event}: from where the log ends,"
        f" take {doors} {way}"
    )


def _decisions(entry: CertifyEntry) -> str:
    if not entry.decisions.total:
        return "none declared"
    return f"{entry.decisions.entailed} of {entry.decisions.total}"
