"""`explore --marker all`: the cost of the marker at every place, in every direction.

Two darts from which the world looks the same make one rooted map, so one run serves both: its entry
is repeated, and `same_as` says so.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from statistics import mean
from typing import Literal

import click
import msgspec

from topo_verify.campaign.run import explore
from topo_verify.cli.explored import ExploreEntry, explore_result
from topo_verify.cli.output import Output, Result
from topo_verify.cli.runs import NamedWorld, claims_cell, finding_blocks, judged
from topo_verify.cli.walks import FoundRuns
from topo_verify.errors import InputError
from topo_verify.programs.loader import Target
from topo_verify.report.blocks import Block, Text, TextTable
from topo_verify.robot.limits import Limits
from topo_verify.text import plural
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import Code

All = Literal["all"]


def _dart_or_all(
    _context: click.Context, _option: click.Parameter, value: str | None
) -> int | All | None:
    """The number in the text, or `all`."""
    if value is None or value == "all":
        return "all" if value else None
    try:
        return int(value)
    except ValueError:
        raise click.BadParameter(f"expected a dart (a number) or all, got {value!r}") from None


option = click.option(
    "--marker",
    callback=_dart_or_all,
    metavar="DART|all",
    help="Let the marker point at this DART instead; all: at each dart in turn, best and worst"
    " named, with --svg as a heat map.",
)


def require_alone(others: Mapping[str, object]) -> None:
    """Raise InputError if one of the options that are for one run is given."""
    for name, value in others.items():
        if value:
            raise InputError(
                f"{name} is for one marker: leave it out, or name one with --marker DART"
            )


def results(
    output: Output,
    starts: Sequence[NamedWorld],
    found: Sequence[Target],
    limits: Limits,
    walk: FoundRuns,
    *,
    strict: bool,
    svg: str | None,
) -> Iterator[Result[ExploreEntry]]:
    """An entry for each world, algorithm and dart, in this order.

    Raises:
        InputError: a world has no dart; or a heat map is asked for, of more than one algorithm.
    """
    for at in starts:
        if not at.world.alpha:
            raise InputError(f"--marker all: {at.name} has no edge that a marker could point at")
    if svg is not None and (svg == "-" or len(starts) * len(found) != 1):
        raise InputError(
            f"--svg {svg}: expected the name of a file, one WORLD and one algorithm, with"
            " --target, since a heat map shows one cost for each place"
        )
    total = len(found) * sum(len(at.world.alpha) for at in starts)
    done = 0
    for at in starts:
        for target in found:
            entries: list[ExploreEntry] = []
            for result in _of_each_dart(at, target, limits, walk, strict=strict):
                done += 1
                output.progress(f"{target.text} in {at.name}", done, total)
                entries.append(result.entry)
                yield result
            if svg is None:
                continue
            if all(entry.ok for entry in entries):
                _write_heat(svg, at, entries)
            else:
                output.note(f"--svg {svg}: not written, since not every run delivered a true map")


def _of_each_dart(
    at: NamedWorld, target: Target, limits: Limits, walk: FoundRuns, *, strict: bool
) -> Iterator[Result[ExploreEntry]]:
    known: dict[Code, Result[ExploreEntry]] = {}
    for dart in range(len(at.world.alpha)):
        there = replace(at.world.with_marker(dart), name=at.name)
        first = known.get(there.code)
        if first is not None:
            entry = msgspec.structs.replace(
                first.entry,
                marker=dart,
                place=there.vertex_of[dart],
                same_as=first.entry.marker,
            )
            yield replace(first, entry=entry)
            continue
        placed = NamedWorld(there, at.text, dart)
        run = explore(there, target, limits=limits)
        report, incomplete = judged(run, placed, limits, strict=strict)
        walk.keep(report)
        known[there.code] = explore_result(run, placed, report, incomplete=incomplete)
        yield known[there.code]


def _write_heat(svg: str, at: NamedWorld, entries: Sequence[ExploreEntry]) -> None:
    from topo_verify.world.drawing.heat import heat_svg

    costs = [entry.cost for entry in entries]
    files.write(svg, heat_svg(at.world, costs, title=f"{entries[0].algorithm} in {at.name}"))


# ---------------------------------------------------------------- for people


def show(entries: Sequence[ExploreEntry]) -> Iterator[Block]:
    """A table a world: the best and the worst place for each algorithm."""
    groups: dict[tuple[str, str], list[ExploreEntry]] = {}
    for entry in entries:
        groups.setdefault((entry.world, entry.algorithm), []).append(entry)
    for number, world in enumerate(dict.fromkeys(entry.world for entry in entries)):
        of_world = [group for (name, _), group in groups.items() if name == world]
        if number:
            yield Text("")
        yield TextTable(_COLUMNS, [_row(group) for group in of_world], _title(of_world[0]))
    yield Text("")
    yield Text(
        "At: the vertex where the marker lies, and the dart that it points at, as the world's file"
        " numbers them (of equal places the first). Saved: what the best place saves of the mean"
        " over all darts."
    )
    for (world, algorithm), group in groups.items():
        for entry in group:
            if entry.findings and entry.same_as is None:
                about = f"{algorithm} in {world}, marker at dart {entry.marker}"
                yield from finding_blocks(entry.findings, about)
            elif entry.stopped is not None and entry.same_as is None:
                where = f"{algorithm} in {world}, marker at dart {entry.marker}"
                yield Text(f"{where}, is not decided: {entry.stopped}")


_COLUMNS = ("algorithm", ">mean", ">best", ">at", ">worst", ">at", ">saved", "claims")


def _title(group: Sequence[ExploreEntry]) -> str:
    one = group[0]
    size = f"{plural(one.vertices, 'vertex', 'vertices')}, {plural(one.edges, 'edge')}"
    kinds = sum(entry.same_as is None for entry in group)
    return (
        f"{one.world}: {size}, genus {one.genus}, the marker at each of"
        f" {plural(len(group), 'dart')}, {kinds} of them different"
    )


def _row(group: Sequence[ExploreEntry]) -> tuple[str, ...]:
    decided = [entry for entry in group if entry.ok]
    bad = next((entry for entry in group if not entry.ok), None)
    claims = claims_cell((bad or group[0]).claims, incomplete=bad is not None and not bad.findings)
    if not decided:
        return (group[0].algorithm, "-", "-", "-", "-", "-", "-", claims)
    average = mean(entry.cost for entry in decided)
    best, worst = (pick(decided, key=_cost) for pick in (min, max))
    saved = f"{1 - best.cost / average:.0%}" if average else "-"
    return (
        group[0].algorithm,
        f"{average:.0f}",
        *(str(best.cost), _where(best), str(worst.cost), _where(worst)),
        saved,
        claims,
    )


def _cost(entry: ExploreEntry) -> int:
    return entry.cost


def _where(entry: ExploreEntry) -> str:
    return f"{entry.place}:{entry.marker}"
