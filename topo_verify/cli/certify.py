"""`topo-verify certify`: what a log of percepts and doors proves, with no world at all."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import click
import msgspec

from topo_verify.campaigns.parts import plural
from topo_verify.certificate import Certificate
from topo_verify.certificate import certify as judge
from topo_verify.checkers import Finding
from topo_verify.cli import options
from topo_verify.cli.layout import Block, Bullets, Table, Text
from topo_verify.cli.output import Output, Result
from topo_verify.cli.output import options as output_options
from topo_verify.cli.runs import finding_line
from topo_verify.errors import InputError
from topo_verify.robot.events import read_trace
from topo_verify.world.counting import MAX_ID_EDGES
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import World


class Tally(msgspec.Struct, frozen=True):
    """How many of the declared decisions follow from the log before them."""

    entailed: int
    total: int


class Certified(msgspec.Struct, frozen=True):
    """One log: an entry of `results`; docs/commands.md.

    Attributes:
        verdict: PROVED, or REFUTED: more than one world shows the log, or none.
        vertices, edges: of the proved map; of the smaller witness if there is none.
        witnesses: the two worlds that tell: the file if one was written, else the id.
    """

    trace: str
    verdict: str
    vertices: int
    edges: int
    open_darts: int
    decisions: Tally
    witnesses: tuple[str, ...]
    findings: tuple[Finding, ...]


@click.command(
    short_help="Judge a log with no world: is its map proved?",
    epilog=options.epilog(
        "certify log.jsonl", "certify log.jsonl -o map.json", "certify log.jsonl --witness worlds"
    ),
)
@click.argument("traces", nargs=-1, required=True, metavar="TRACE...")
@click.option("-o", "map_file", metavar="MAP", help="Write the proved map of the one log.")
@click.option("--witness", "folder", metavar="DIR", help="Write the worlds that tell there.")
@output_options
def certify(
    output: Output, *, traces: tuple[str, ...], map_file: str | None, folder: str | None
) -> int:
    """Judge logs of percepts and doors, with no world at all.

    TRACE is a file in JSON Lines, or - for standard input: a `start` with the first percept, then a
    `move` with door and percept for each edge that was crossed. PROVED: one world alone shows this
    log, and it is the map. REFUTED: two different worlds show it, or none does.
    """

    def certified() -> Iterator[Result[Certified]]:
        if map_file is not None and len(traces) != 1:
            raise InputError(f"-o {map_file}: a map is of one log, these are {len(traces)}")
        for number, trace in enumerate(traces):
            output.progress(f"folding {trace}", number, len(traces))
            certificate = judge(read_trace(_bytes(trace), name=_name(trace)))
            if map_file is not None and certificate.map is not None:
                files.write(map_file, certificate.map.to_json() + "\n")
            yield _result(trace, certificate, folder)

    return output.run("certify", certified, _show)


def _name(trace: str) -> str:
    return "standard input" if trace == "-" else trace


def _bytes(trace: str) -> bytes:
    if trace == "-":
        return files.read_stream(sys.stdin.buffer, name="standard input")
    return files.read(trace)


def _result(trace: str, certificate: Certificate, folder: str | None) -> Result[Certified]:
    worlds = certificate.witnesses
    names = tuple(
        _written(folder, f"{Path(trace).stem}-witness-{number}.json", world)
        if folder is not None
        else _told(world)
        for number, world in enumerate(worlds, 1)
    )
    again = shlex.join(["topo-verify", "certify", trace])
    findings = tuple(
        msgspec.structs.replace(finding, replay=again) for finding in certificate.findings
    )
    shown = certificate.map or (worlds[0] if worlds else None)
    entry = Certified(
        trace=trace,
        verdict="REFUTED" if findings else "PROVED",
        vertices=len(shown.vertices) if shown else 0,
        edges=len(shown.edges) if shown else 0,
        open_darts=certificate.open_darts,
        decisions=Tally(certificate.entailed, certificate.decisions),
        witnesses=names,
        findings=findings,
    )
    return Result(entry, failed=bool(findings))


def _written(folder: str, name: str, world: World) -> str:
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(
            f"--witness {folder}: no such folder can be made: {error.strerror}"
        ) from error
    path = str(Path(folder) / name)
    files.write(path, world.to_json() + "\n")
    return path


def _told(world: World) -> str:
    if len(world.edges) <= MAX_ID_EDGES:
        return world.id
    return f"a world of {len(world.edges)} edges (--witness DIR writes it)"


def _show(entries: Sequence[Certified]) -> Iterator[Block]:
    rows = [
        (e.trace, e.verdict, str(e.vertices), str(e.edges), str(e.open_darts), _decisions(e))
        for e in entries
    ]
    columns = ("log", "verdict", ">vertices", ">edges", ">open darts", "decisions that follow")
    yield Table(columns, rows)
    for entry in entries:
        if entry.findings:
            yield Text("")
            yield Text(f"{entry.trace}:")
            yield Bullets(tuple(map(finding_line, entry.findings[:5])))
        if entry.witnesses:
            yield Text(f"{plural(len(entry.witnesses), 'world')} that show this log and differ:")
            yield Bullets(entry.witnesses)


def _decisions(entry: Certified) -> str:
    if not entry.decisions.total:
        return "none declared"
    return f"{entry.decisions.entailed} of {entry.decisions.total}"
