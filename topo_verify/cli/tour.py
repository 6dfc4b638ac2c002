"""`topo-verify tour`: the cheapest walk that proves the map of a known world."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import click
import msgspec

from topo_verify.checkers import check
from topo_verify.cli import options, runs
from topo_verify.cli.output import Output, Result, entry_of
from topo_verify.errors import InputError, plural
from topo_verify.pictures.recording import PlayedRun
from topo_verify.report.blocks import Block, Text, TextTable
from topo_verify.robot.events import Event, Move, Start, Trace
from topo_verify.robot.percept import Door, Percept
from topo_verify.studies.log_file import line_of, read_log, write_log
from topo_verify.studies.map_check import check_map, tour_log
from topo_verify.world.rooted_map import Dart, World


class LogAgainstMap(msgspec.Struct, frozen=True):
    """The verdict of a log on the map.

    Attributes:
        log: the file.
        verdict: REFUTED: the map does not show the log. PROVED: only the map shows it. UNKNOWN:
            other worlds show it, too.
        event: the event that refutes the map, counted from 0 with `start`; else null.
        message: why it does; "" otherwise.
        moves: the edge traversals of the log.
        unproved: the edges that the log does not prove, by their two darts in the map.
    """

    log: str
    verdict: str
    event: int | None
    message: str
    moves: int
    unproved: tuple[tuple[Dart, Dart], ...]


class TourEntry(msgspec.Struct, frozen=True):
    """A walk that proves a map.

    Attributes:
        cost: the number of doors; without --against the least cost of the world.
        doors: those to take, from the start or from where the log of --against ends.
        seen: what should be seen behind each of these doors.
        against: the verdict of that log.
    """

    world: str
    cost: int
    doors: tuple[Door, ...]
    seen: tuple[Percept, ...]
    against: LogAgainstMap | None


@options.command(
    "tour nyc -o tour.jsonl",
    "tour 'family:lattice(4,4)' --player tour.html",
    "tour plan.json --against log.jsonl",
)
@click.argument("world", metavar="WORLD")
@options.marker
@click.option(
    "-o",
    "file",
    metavar="LOG",
    help="Write the walk as a log (.csv: a table), with what should be seen.",
)
@options.player
@click.option(
    "--against", "log", metavar="LOG", help="Judge the map by this log, and go on where it ends."
)
def tour(
    output: Output,
    *,
    world: str,
    marker: int | None,
    file: str | None,
    player: str | None,
    log: str | None,
) -> int:
    """Print the cheapest walk that proves the map of a known world: doors, and what should be seen.

    A robot that starts at the marker and sees all this has proved the map. It need not come back.

    With --against, WORLD is a map and LOG is what a robot has seen so far, as for certify.
    REFUTED (exit code 1): the event that refutes the map is named. PROVED (0). UNKNOWN (3): the
    edges not proved yet are named, with the cheapest of several ways to go on from where the log
    ends.
    """

    def toured() -> Iterator[Result[TourEntry]]:
        runs.require_one_world(player, 1)
        if file == "-":
            raise InputError("-o -: standard output is for the results; name a file")
        if world == log == "-":
            raise InputError("expected '-' once, since standard input holds one thing; name a file")
        at = runs.named_world(world, marker)
        if log is None:
            trace = tour_log(at.world)
            onward: Sequence[Event] = trace[1:]
            against: LogAgainstMap | None = None
        else:
            output.progress(f"folding {log}", 0, 1)
            trace, onward, against = _against(at.world, log)
        refuted = against is not None and against.verdict == "REFUTED"
        if file is not None and refuted:
            output.note(f"-o {file}: not written, since no walk proves a map that is refuted")
        elif file is not None:
            write_log(file, trace)
        if player is not None:
            marked = [j for j in check(at.world, trace) if j.claim == "percepts-true"]
            runs.write_page(player, at.world, at.name, [PlayedRun("tour", trace, marked)])
        moves = [event for event in onward if isinstance(event, Move)]
        entry = TourEntry(
            world=at.name,
            cost=len(moves),
            doors=tuple(event.door for event in moves),
            seen=tuple(event.percept for event in moves),
            against=against,
        )
        verdict = against.verdict if against is not None else "PROVED"
        yield Result(entry, failed=verdict == "REFUTED", incomplete=verdict == "UNKNOWN")

    return output.run("tour", toured, _show)


def _against(world: World, log: str) -> tuple[Trace, Sequence[Event], LogAgainstMap]:
    """The log with the way on after it, that way, and the verdict on the map."""
    name = "standard input" if log == "-" else log
    log_events = read_log(log)
    try:
        verdict_on_map = check_map(world, log_events)
    except InputError as error:
        raise InputError(f"{name}: {error}") from error
    walked = tuple(event for event in log_events if isinstance(event, Start | Move))
    against = entry_of(LogAgainstMap, verdict_on_map, log=log, moves=len(walked) - 1)
    trace = log_events if verdict_on_map.verdict == "REFUTED" else (*walked, *verdict_on_map.onward)
    return trace, verdict_on_map.onward, against


def _show(entries: Sequence[TourEntry]) -> Iterator[Block]:
    for entry in entries:
        yield Text(_sentence(entry))
        if entry.against is not None and entry.against.unproved:
            edges = ", ".join(f"{a}-{b}" for a, b in entry.against.unproved)
            yield Text(f"Not proved yet, by the darts of their two ends: {edges}.")
        if entry.doors:
            begun = entry.against.moves if entry.against is not None else 0
            walk = enumerate(zip(entry.doors, entry.seen, strict=True), begun + 1)
            yield TextTable(
                (">move", ">door", ">degree seen", ">marker seen at door"),
                [
                    (
                        str(n),
                        str(door),
                        str(percept.degree),
                        "-" if percept.marker is None else str(percept.marker),
                    )
                    for n, (door, percept) in walk
                ],
            )


def _sentence(entry: TourEntry) -> str:
    against, moves = entry.against, plural(entry.cost, "move")
    if against is None:
        return f"{entry.world}: this walk of {moves} proves the map; no walk proves it with fewer."
    head = f"{against.verdict}: {against.log} and the map {entry.world}:"
    match against.verdict:
        case "REFUTED":
            assert against.event is not None
            line = line_of(against.log, against.event)
            at = f"{against.event} ({line})" if line else f"{against.event}"
            mend = "If this reading is right, a door before it was another one."
            return f"{head} event {at} refutes the map: {against.message}. {mend}"
        case "PROVED":
            return f"{head} no other world shows this log of {plural(against.moves, 'move')}."
        case _:
            edges = plural(len(against.unproved), "edge")
            return f"{head} {edges} not proved yet; from where the log ends {moves} prove the map."
