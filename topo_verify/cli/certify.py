"""`topo-verify certify`: what a log proves with no world at all; certificates for Coq."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path
from typing import Protocol

import click
import msgspec

from topo_verify import extras
from topo_verify.checkers import Finding
from topo_verify.checkers.folding import TURNED
from topo_verify.cli import options
from topo_verify.cli.output import Output, Result, entry_of
from topo_verify.cli.runs import finding_line
from topo_verify.errors import InputError, plural
from topo_verify.report.blocks import Block, Bullets, Text, TextTable
from topo_verify.robot.events import Move, Trace
from topo_verify.studies.advice import Advice
from topo_verify.studies.log_file import line_of, read_log
from topo_verify.studies.log_report import Certificate, OpenDoor, said_of_readings
from topo_verify.studies.log_report import certify as judge
from topo_verify.world.enumeration.rank_order import MAX_ID_EDGES
from topo_verify.world.formats import files

MOST_OPEN_DOORS = 100
"""Most open doors of a log that are listed."""

LONGEST_WALK = 20
"""Most doors of a walk that people are shown."""


class DecisionCount(msgspec.Struct, frozen=True):
    """How many of the declared decisions follow from the log before them."""

    entailed: int
    total: int


class CertifiedDecisions(msgspec.Struct, frozen=True):
    """How many of the entailed decisions Coq accepted.

    Attributes:
        by: the checker; "" if nothing was checked.
        why: why some are not certified; "" if all are.
    """

    certified: int
    entailed: int
    by: str
    why: str


class KernelCheck(msgspec.Struct, frozen=True):
    """The Coq certificate of a log, and the answer of its checker.

    Attributes:
        statement: map, undetermined or impossible.
        file: the certificate.
        accepted: null if nothing checked the certificate.
        by: the checker.
        why: why nothing was checked.
        command: checks it again, in the folder of the certificate.
        delivered: Coq accepted that the delivered map is the world.
        decisions: the certified ones among those that follow.
    """

    statement: str
    file: str
    accepted: bool | None
    by: str
    why: str
    command: str
    delivered: bool
    decisions: CertifiedDecisions

    @property
    def incomplete(self) -> bool:
        """Whether the certificate, or a decision that follows, was left unchecked."""
        return self.accepted is None or bool(self.decisions.entailed and not self.decisions.by)


class CertifyEntry(msgspec.Struct, frozen=True):
    """What one log proves.

    Attributes:
        verdict: PROVED. UNKNOWN: several worlds show the log. REFUTED: no world shows it, or a
            map or decision in it does not follow.
        vertices, edges: of the proved map; where it is UNKNOWN of the smaller witness, in which
            each open door leads to a vertex of degree 1; 0 where it is REFUTED.
        genus: of the proved map; null unless it is proved.
        moves: of the log, in edge traversals.
        least_cost: of a proof of this map, in edge traversals; null unless it is proved.
        apart: the events of two readings of one place that differ; null unless that refutes it.
        places: where the robot is after each event, by the number of places reached before; [] if
            no world shows the log.
        place: where the log ends, the last of `places`; null if no world shows it.
        open_doors: at most 100, nearest to the end of the log first.
        advice: how to go on to prove the map; null: nothing is left to walk.
        witnesses: two different worlds that show this log: files if written, else ids.
        kernel: the certificate for Coq; null without --kernel.
        trace: the file of the log.
        open_darts: the number of known darts that the log does not cross.
    """

    trace: str
    verdict: str
    vertices: int
    edges: int
    genus: int | None
    moves: int
    least_cost: int | None
    open_darts: int
    apart: tuple[int, int] | None
    places: tuple[int, ...]
    place: int | None
    open_doors: tuple[OpenDoor, ...]
    advice: Advice | None
    decisions: DecisionCount
    witnesses: tuple[str, ...]
    findings: tuple[Finding, ...]
    kernel: KernelCheck | None


Prover = Callable[[int, Trace, Certificate], KernelCheck]
"""Proves what the log of this number shows; `InternalError` if Coq says otherwise."""


class LogCertifier(Protocol):
    """What an extra brings with its options: certificates of logs, made and checked."""

    def check(self, output: Output, *, alone: bool) -> int | None:
        """Check a received certificate: the exit code, or None if none is named.

        Args:
            alone: whether no log and no option of another task is given.
        """
        ...

    def prover(
        self, output: Output, traces: Sequence[str]
    ) -> AbstractContextManager[Prover | None]:
        """What proves these logs; None if that is not asked for."""
        ...

    def show(self, proof: KernelCheck) -> Iterator[Block]:
        """A certificate for people."""
        ...


@options.command(
    "certify log.jsonl",
    "certify log.jsonl -o map.json",
    "certify log.jsonl --draw known.svg",
    "certify log.jsonl --witness worlds",
    "certify log.jsonl --kernel",
    "certify --check certificate_log.cert --log log.jsonl",
)
@click.argument("traces", nargs=-1, metavar="TRACE...")
@click.option("-o", "map_file", metavar="MAP", help="Write the proved map (one TRACE only).")
@click.option("--draw", "picture", metavar="FILE", help="Draw what the log shows (one TRACE only).")
@click.option(
    "--witness", "folder", metavar="DIR", help="Write two worlds that show the log to DIR."
)
@extras.options("certify")
def certify(
    output: Output,
    *,
    traces: tuple[str, ...],
    map_file: str | None,
    picture: str | None,
    folder: str | None,
    coq: LogCertifier,
) -> int:
    """Judge logs of percepts and doors, with no world at all.

    TRACE is a file, or - for standard input: JSON Lines with a `start` and a `move` for each
    edge crossed, or a CSV table with the columns door, degree, marker (no door in its first
    row). PROVED: exactly one world shows this log, and it is the map. UNKNOWN (exit code 3):
    several worlds show it; the open doors are named, and where to go next. REFUTED (1): no world
    shows it, or a map or decision in it does not follow.

    --kernel proves the same in Coq, in a file certificate_LOG.cert; 3 if a part is not checked.
    --check has Coq check a received certificate: accepted (0), refused (1), not readable (2),
    not checked, or silent about a part of the log (3).
    """
    checked = coq.check(output, alone=not (traces or map_file or picture or folder))
    if checked is not None:
        return checked
    if not traces:
        raise click.UsageError("Missing argument 'TRACE...'.")

    def certified() -> Iterator[Result[CertifyEntry]]:
        for option, file in (("-o", map_file), ("--draw", picture)):
            if file is not None and len(traces) != 1:
                raise InputError(f"{option} {file}: expected one TRACE, got {len(traces)}")
        if picture is not None:
            from topo_verify.pictures.drawing import format_of

            format_of(picture)  # refused before the work
        with coq.prover(output, traces) as prove:
            for number, trace in enumerate(traces):
                output.progress(f"folding {trace}", number, len(traces))
                log = read_log(trace)
                try:
                    certificate = judge(log)
                except InputError as error:
                    raise InputError(
                        f"{'standard input' if trace == '-' else trace}: {error}"
                    ) from error
                if map_file is not None and certificate.map is not None:
                    certificate.known.save(map_file)
                elif map_file is not None:
                    output.note(f"-o {map_file}: not written, for the log proves no map")
                drawn = picture is None or _draw(output, certificate, picture)
                proof = None if prove is None else prove(number, log, certificate)
                result = _result(trace, certificate, folder, proof)
                yield result if drawn else replace(result, incomplete=True)

    return output.run("certify", certified, lambda entries: _show(entries, coq))


def _draw(output: Output, certificate: Certificate, picture: str) -> bool:
    if not certificate.shown:
        output.note(f"--draw {picture}: not written, for no world shows the log")
        return False
    try:
        certificate.draw(picture, doors=True)
    except InputError as error:  # the verdict is not lost
        output.note(f"--draw {picture}: not written: {error}")
        return False
    return True


def _result(
    trace: str, certificate: Certificate, folder: str | None, proof: KernelCheck | None
) -> Result[CertifyEntry]:
    replay_command = shlex.join(["topo-verify", "certify", trace])
    findings = tuple(
        msgspec.structs.replace(finding, replay=replay_command) for finding in certificate.findings
    )
    entry = entry_of(
        CertifyEntry,
        certificate,
        trace=trace,
        moves=sum(isinstance(event, Move) for event in certificate.log),
        genus=None if certificate.map is None else certificate.map.genus,
        least_cost=None if certificate.map is None else certificate.map.least_cost(),
        open_doors=tuple(certificate.open_doors(MOST_OPEN_DOORS)),
        advice=certificate.advice,
        decisions=DecisionCount(certificate.entailed, certificate.decisions),
        witnesses=_witnesses(trace, certificate, folder),
        findings=findings,
        kernel=proof,
    )
    # Proved but not certified is not the mapper's failure: exit 3, not 1.
    unchecked = proof is not None and proof.incomplete
    incomplete = unchecked or certificate.verdict == "UNKNOWN"
    return Result(entry, failed=bool(findings), incomplete=incomplete)


def _witnesses(trace: str, certificate: Certificate, folder: str | None) -> tuple[str, ...]:
    if certificate.map is not None or certificate.fold is None:
        return ()
    sizes = (certificate.edges, certificate.edges + certificate.open_darts)
    # A large world is made only on request: it may have a million exits.
    if folder is None and max(sizes) > MAX_ID_EDGES:
        return tuple(f"a world of {size} edges (--witness DIR writes it)" for size in sizes)
    if folder is None:
        return tuple(world.id for world in certificate.witnesses)
    place = options.make_folder(folder, "--witness")
    written: list[str] = []
    for number, world in enumerate(certificate.witnesses, 1):
        written.append(str(place / f"{Path(trace).stem}-witness-{number}.json"))
        files.write(written[-1], world.to_json() + "\n")
    return tuple(written)


def _show(entries: Sequence[CertifyEntry], coq: LogCertifier) -> Iterator[Block]:
    rows = [(e.trace, e.verdict, *_sizes(e), _decisions(e)) for e in entries]
    columns = ("log", "verdict", ">vertices", ">edges", ">open darts", "decisions that follow")
    yield TextTable(columns, rows)
    for entry in entries:
        if entry.findings:
            yield Text("")
            yield Text(f"{entry.trace}:")
            yield Bullets(tuple(map(finding_line, entry.findings[:5])))
            event = entry.findings[0].event
            if event is not None and (line := line_of(entry.trace, event)):
                yield Text(f"Event {event} is {line} of {entry.trace}.")
            if entry.apart is not None:
                yield Text(said_of_readings(entry.trace, entry.apart, event))
            elif any(TURNED in finding.message for finding in entry.findings):
                yield Text(
                    "Two visits to one place differ in which door is which: perhaps the marker"
                    " pointed at another door, or a door was counted from another edge."
                )
            if entry.place is None:  # else the map that was delivered does not follow
                yield Text(
                    "There it shows; the wrong reading may be an earlier one. If you have a map:"
                    " topo-verify tour MAP --against LOG names the first reading that does not fit."
                )
        if entry.least_cost is not None:
            yield Text(
                f"{entry.trace}: {plural(entry.moves, 'move')}; a proof of this map takes at least"
                f" {entry.least_cost}."
            )
        if entry.genus:
            yield Text(
                f"This map does not fit in the plane (genus {entry.genus}). Of one floor that means"
                " that doors were counted in a wrong order somewhere, or corridors cross."
            )
        if entry.advice is not None:
            yield from _show_open(entry, entry.advice)
        if entry.witnesses:
            files = "" if entry.witnesses[0].endswith(".json") else " (--witness DIR writes both)"
            yield Text(f"Two of the worlds that show this log; infinitely many do{files}:")
            yield Bullets(entry.witnesses)
        if entry.kernel is not None:
            yield from coq.show(entry.kernel)


def _sizes(entry: CertifyEntry) -> tuple[str, str, str]:
    """Vertices and edges of the proved map, and the open darts if a world shows the log."""
    known = entry.verdict == "PROVED"
    vertices, edges = (str(entry.vertices), str(entry.edges)) if known else ("-", "-")
    return vertices, edges, "-" if entry.verdict == "REFUTED" else str(entry.open_darts)


def _show_open(entry: CertifyEntry, advice: Advice) -> Iterator[Block]:
    yield Text("")
    nearest = ", the nearest five" if entry.open_darts > 5 else ""
    yield Text(
        f"{entry.trace}: {plural(entry.moves, 'move')}; true of several worlds, with"
        f" {plural(entry.open_darts, 'door')} not known to have been crossed{nearest}:"
    )
    yield Bullets(
        tuple(
            f"door {door.door} of {_place(door)}: from where the log ends, take {_doors(door.walk)}"
            for door in entry.open_doors[:5]
        )
    )
    home = f"take {_doors(advice.home)}" if advice.home else "it is here"
    if advice.walk:
        yield Text(
            f"Next, from where the log ends (place {entry.place}): take {_doors(advice.walk)}, and"
            " certify the longer log. A robot that goes on in this way proves the map in the end."
        )
    else:
        yield Text("Next: go back to the marker, and certify the longer log from there.")
    yield Text(f"Back to the marker, from where the log ends: {home}.")
    yield Text(
        "A wrong reading may leave doors open, too. If you have a map: topo-verify tour MAP"
        " --against LOG."
    )


def _place(door: OpenDoor) -> str:
    at = f"reached at event {door.event}" if door.event else "the first"
    return f"place {door.place} ({at})"


def _doors(walk: Sequence[int]) -> str:
    more = len(walk) - LONGEST_WALK
    shown = ", ".join(map(str, walk[:LONGEST_WALK]))
    rest = f" and {more} more (--format json has all)" if more > 0 else ""
    return f"door{'s'[: len(walk) > 1]} {shown}{rest}"


def _decisions(entry: CertifyEntry) -> str:
    if not entry.decisions.total:
        return "none declared"
    return f"{entry.decisions.entailed} of {entry.decisions.total}"
