"""What `arena --out DIR` writes, beside the store of its runs and its page.

    table.md, table.csv      the tables, without time and memory
    runs.csv                 every run of the ranked mappers
    results.json             the entries, without what differs from run to run
    timing.json              that: milliseconds a move, memory
    ratio-SUITE.svg          cost / LB against the number of edges
    players/MAPPER.html      a ranked mapper in its dearest world
    counterexamples/         of a mapper without a place: the world, drawn, and its run

All but `timing.json` and the page are the same, byte for byte, whenever the same runs are made.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path

import msgspec

from topo_verify.campaign.run import explore
from topo_verify.checkers import check
from topo_verify.cli.failures import version
from topo_verify.cli.walks import target_title
from topo_verify.player.page import player_page
from topo_verify.player.recording import PlayedRun
from topo_verify.report.account import Exhibit
from topo_verify.report.blocks import Text
from topo_verify.report.league import broken_blocks, ratio_plot, runs_csv, suite_blocks, table_csv
from topo_verify.report.markdown import markdown
from topo_verify.robot.limits import Limits
from topo_verify.studies.arena.league import DearestWorld, League, LeagueEntry
from topo_verify.studies.conform.outcome import file_name
from topo_verify.world.formats import files
from topo_verify.world.resolve import resolve_world

REPORT = "report.html"
"""The page of the run."""

VARIES = ("ms_per_move",)
"""The fields of an entry that differ from run to run."""


def dearest_exhibits(league: League, limits: Limits) -> Iterator[Exhibit]:
    """Each ranked mapper in its dearest world of all suites, run once more."""
    dearest: dict[str, DearestWorld] = {}
    for entry in league.entries():
        one, other = entry.dearest, dearest.get(entry.mapper)
        if entry.place is not None and one is not None:
            dearest[entry.mapper] = one if other is None or one.ratio > other.ratio else other
    for mapper in league.mappers:
        if (one := dearest.get(mapper.text)) is None:
            continue
        world = resolve_world(one.world)
        run = explore(world, mapper, limits=limits)
        judgements = check(world, run.trace, run.stopped)
        yield Exhibit(
            title=target_title(mapper.text, one.world),
            world=world,
            name=one.world,
            notes=(f"dearest: {one.cost} edge traversals, {one.ratio:.2f} × LB = {one.least}",),
            runs=(PlayedRun(mapper.text, run.trace, tuple(judgements), run.stopped),),
            whole=True,
        )


def write_folder(
    folder: Path,
    league: League,
    table: Sequence[LeagueEntry],
    dearest: Sequence[Exhibit],
    counterexamples: Sequence[Exhibit],
) -> None:
    """Write all files of the league into the folder.

    Raises:
        InputError: one of them cannot be written.
    """
    files.write(folder / "table.csv", table_csv(table))
    runs = {
        (entry.mapper, suite.name): league.runs(entry.mapper, suite)
        for suite in league.suites
        for entry in table
        if entry.suite == suite.name and entry.place is not None
    }
    files.write(folder / "runs.csv", runs_csv(runs))
    files.write(folder / "results.json", _results(league, table))
    files.write(folder / "timing.json", _timing(league, table))
    for suite in league.suites:
        ranked = [e for e in table if e.suite == suite.name and e.place is not None]
        if ranked:
            made = {entry.mapper: runs[entry.mapper, suite.name] for entry in ranked}
            files.write(folder / f"ratio-{suite.name}.svg", ratio_plot(suite, ranked, made))
    for exhibit in dearest:
        _write_player(folder / "players", exhibit)
    for exhibit in counterexamples:
        _write_player(folder / "counterexamples", exhibit)
        name = _stem(exhibit)
        files.write(folder / "counterexamples" / f"{name}.svg", exhibit.world.draw())
    files.write(folder / "table.md", _table(league, table, dearest, counterexamples))


def _write_player(folder: Path, exhibit: Exhibit) -> None:
    folder.mkdir(exist_ok=True)
    if exhibit.runs:
        page = player_page(exhibit.world, exhibit.runs, name=exhibit.name)
        files.write(folder / f"{_stem(exhibit)}.html", page)


def _stem(exhibit: Exhibit) -> str:
    # A program's TARGET begins with dashes, which a shell takes for an option.
    return file_name(exhibit.runs[0].name if exhibit.runs else exhibit.title).lstrip("-")


def _results(league: League, table: Sequence[LeagueEntry]) -> str:
    entries = [
        {name: value for name, value in entry.items() if name not in VARIES}
        for entry in msgspec.to_builtins(table)
    ]
    suites = [suite.name for suite in league.suites]
    head = {"format": "topo-verify/arena", "version": 1, "tool": version()}
    whole = {**head, "suite": suites, "seed": league.seed, "results": entries}
    return json.dumps(whole, indent=1) + "\n"


def _timing(league: League, table: Sequence[LeagueEntry]) -> str:
    rows = [
        {
            "mapper": entry.mapper,
            "suite": entry.suite,
            "ms_per_move": entry.ms_per_move,
            "memory_mib": league.memory(entry),
        }
        for entry in table
    ]
    return json.dumps(rows, indent=1) + "\n"


def _table(
    league: League,
    table: Sequence[LeagueEntry],
    dearest: Sequence[Exhibit],
    counterexamples: Sequence[Exhibit],
) -> str:
    """All tables as Markdown, with the plots and the worlds."""
    parts = ["# The arena\n"]
    for suite in league.suites:
        mine = [entry for entry in table if entry.suite == suite.name]
        parts.append(f"## {suite.name}\n")
        parts.append(markdown(suite_blocks(suite, mine, league.seed, None)))
        if any(entry.place is not None for entry in mine):
            parts.append(f"![cost / LB in {suite.name}](ratio-{suite.name}.svg)\n")
    if dearest:
        parts.append("## The dearest worlds\n")
        for one in dearest:
            parts.append(markdown([Text(f"{one.title}, {one.notes[0]}")]))
            parts.append(f"[The run, step by step](<players/{_stem(one)}.html>)\n")
    if broken := list(broken_blocks(table)):
        parts.append("## No place\n")
        parts.append(markdown(broken))
    for one in counterexamples:
        parts.append(f"![The counterexample](<counterexamples/{_stem(one)}.svg>)\n")
        if one.runs:
            parts.append(f"[The run, step by step](<counterexamples/{_stem(one)}.html>)\n")
    return "\n".join(parts)
