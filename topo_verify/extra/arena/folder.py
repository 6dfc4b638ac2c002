"""The standings of `arena`, and the files of `arena --out DIR` beside store and page.

    table.md, table.csv      the tables
    runs.csv                 every run of the ranked mappers
    results.json             the entries
    timing.json              milliseconds a move, memory
    ratio-SUITE.svg          cost / LB by family
    players/MAPPER.html      a ranked mapper where it loses most, beside the first
    counterexamples/         of a mapper without a place: the world, drawn, and its run

All but `timing.json` and the pages are equal, byte for byte, for equal runs.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from operator import attrgetter
from pathlib import Path

import msgspec

from topo_verify.campaign.campaign import MAX_TIMEOUTS
from topo_verify.campaign.judge import replay_line
from topo_verify.campaign.run import explore
from topo_verify.checkers import check
from topo_verify.cli import version
from topo_verify.cli.runs import claims_in_words, target_title
from topo_verify.errors import plural
from topo_verify.extra.arena import league as lg
from topo_verify.extra.arena.plot import ratio_plot
from topo_verify.extra.arena.suites import Suite
from topo_verify.pictures.page import player_page
from topo_verify.pictures.recording import PlayedRun
from topo_verify.programs.loader import Target
from topo_verify.report.account import Exhibit
from topo_verify.report.blocks import Block, Bullets, Cell, Command, Text, TextTable
from topo_verify.report.csv_table import csv_text
from topo_verify.report.markdown import markdown
from topo_verify.robot.events import Event, Move
from topo_verify.robot.percept import Purpose
from topo_verify.studies.conform.conform import file_name
from topo_verify.world.formats import files
from topo_verify.world.resolve import resolve_world

REPORT = "report.html"

VARIES = ("ms_per_move",)


# ---------------------------------------------------------------- for people

Memory = Callable[[lg.LeagueEntry], float | None]
"""The mebibytes of a mapper in its most expensive world of a suite, if known."""


LEGEND = (
    "LB: the least cost of a proof of the map. behind: the mean difference to the first of the"
    " table, in the same worlds, in LB. ±: half of a 95 % confidence interval; exact: every world"
    " was played. =: a shared place, for the difference is not significant. free: hypotheses"
    " rejected without motion."
)

VARYING = (
    "CPU ms and MiB depend on the machine: milliseconds of processor time a move, of mapper and"
    " robot (wall-clock time would depend on what else runs), and the most memory in the"
    " mapper's most expensive world."
)


NO_PLACE = "No place: a claim fails, --budget is exceeded, or it cannot be loaded"


def standings(
    suite: Suite, table: Sequence[lg.LeagueEntry], seed: int, memory: Memory | None
) -> Block:
    """The ranked mappers of a suite; a shared place is followed by `=`.

    `memory` adds columns of time and memory.
    """
    ranked = ranked_in(suite, table)
    if not ranked:
        return Text(f"{suite.name}: no mapper has a place")
    varying = (">CPU ms", ">MiB") if memory is not None else ()
    columns = (">#", "mapper", ">cost/LB", ">behind", ">free", *varying, "claims")
    drawn = "" if suite.exact else f", seed {seed}"
    title = f"{suite.name}: {suite.about}, {plural(ranked[0].total, 'world')}{drawn}"
    places = Counter(entry.place for entry in ranked)
    rows = [
        (
            f"{entry.place}{'=' * (places[entry.place] > 1)}",
            entry.name,
            _figure(entry.ratio, exact=suite.exact),
            _figure(entry.behind, exact=suite.exact, sign="+"),
            _free(entry),
            *(() if memory is None else _varying(entry, memory(entry))),
            claims_in_words(entry.claims),
        )
        for entry in ranked
    ]
    return TextTable(columns, rows, title)


def suite_blocks(suite: Suite, table: Sequence[lg.LeagueEntry]) -> Iterator[Block]:
    """Why mappers lost in a suite, its families, and why others have no place."""
    ranked = ranked_in(suite, table)
    yield from _loss_blocks(suite, ranked)
    if ranked and len(suite.families) > 1:
        yield Text("")
        yield _families(suite, ranked)
    for entry in table:
        if entry.suite == suite.name and entry.place is None and entry.counterexample is None:
            missing = entry.total - entry.worlds - entry.undecided
            late = " after three time-outs" if entry.undecided >= MAX_TIMEOUTS else ""
            worlds = plural(entry.undecided, "world")
            why = [
                *([f"{missing} of {entry.total} worlds not played{late}"] if missing else ()),
                *(
                    [f"{worlds} of {entry.total} not decided (--world-timeout)"]
                    if entry.undecided
                    else ()
                ),
            ]
            yield Text("")
            yield Text(f"{entry.name} has no place in {suite.name}: {', '.join(why)}")
            if entry.why:
                yield Bullets(entry.why)


def _loss_blocks(suite: Suite, ranked: Sequence[lg.LeagueEntry]) -> Iterator[Block]:
    rows = [
        (
            *(entry.name, lost.world, str(lost.edges), str(lost.cost), str(lost.other)),
            f"+{lost.excess:.2f}",
        )
        for entry in ranked
        for lost in entry.losses
    ]
    if rows:
        best = ranked[0].name
        columns = ("mapper", "world", ">edges", ">cost", f">{best}", ">behind")
        title = f"{suite.name}: where each loses most against {best}"
        yield Text("")
        yield TextTable(columns, rows, title)
        for entry in ranked:
            if entry.losses:
                yield Command(entry.losses[0].show, "side by side: ")


def _families(suite: Suite, ranked: Sequence[lg.LeagueEntry]) -> TextTable:
    rows = [
        (
            *(family.name, f"{costs[0].edges:.0f}"),
            *(_figure(cost.ratio, exact=family.exact) for cost in costs),
        )
        for family, *costs in zip(
            suite.families, *(entry.families for entry in ranked), strict=True
        )
    ]
    columns = ("family", ">mean edges", *(f">{entry.name}" for entry in ranked))
    return TextTable(columns, rows, f"{suite.name}: cost/LB by family")


def _figure(
    figure: lg.MeanInterval | lg.LeagueBehind | None, *, exact: bool, sign: str = ""
) -> str:
    if figure is None:
        return "-"
    mean = f"{figure.mean:{sign}.2f}"
    if figure.high is None:
        return mean
    reach = figure.high - figure.mean
    return f"{mean} exact" if exact else f"{mean} ±{reach:.2f}"


def _free(entry: lg.LeagueEntry) -> str:
    rejected = entry.rejected_free + entry.rejected_moving
    return f"{entry.rejected_free / rejected:.0%}" if rejected else "-"


def _varying(entry: lg.LeagueEntry, memory: float | None) -> tuple[str, str]:
    time = "-" if entry.ms_per_move is None else f"{entry.ms_per_move:.3f}"
    return time, "-" if memory is None else f"{memory:.0f}"


def ranked_in(suite: Suite, table: Sequence[lg.LeagueEntry]) -> list[lg.LeagueEntry]:
    """The entries of the mappers that have a place in a suite."""
    return [entry for entry in table if entry.suite == suite.name and entry.place is not None]


def plot_of(league: lg.League, suite: Suite, table: Sequence[lg.LeagueEntry]) -> str:
    """The plot of a suite; "" if no mapper has a place in it."""
    ranked = ranked_in(suite, table)
    ratios = {
        entry.name: [
            [run.ratio for run in runs]
            for _, runs in lg.split(suite, league.runs(entry.mapper, suite))
        ]
        for entry in ranked
    }
    return ratio_plot(suite, ranked, ratios) if ranked else ""


def broken_blocks(entries: Sequence[lg.LeagueEntry]) -> Iterator[Block]:
    """The mappers that broke a claim, each with its counterexample."""
    broken = {e.name: e.counterexample for e in entries if e.counterexample is not None}
    if broken:
        totals = Counter[str](), Counter[str]()
        for entry in entries:
            for total, worlds in zip(totals, (entry.worlds, entry.total), strict=True):
                total[entry.name] += worlds
        rows = [
            (
                *(mapper, _failure(example), example.ended),
                *(example.world or "-", example.suite or "-"),
                " of ".join(str(total[mapper]) for total in totals),
            )
            for mapper, example in broken.items()
        ]
        yield Text("")
        columns = ("mapper", "claim that fails", "ended by", "world", "suite", ">played")
        yield TextTable(columns, rows, title=NO_PLACE)
    for mapper, example in broken.items():
        yield Text("")
        yield Text(f"{mapper}:")
        yield Bullets((f"{example.where}: {example.message}",))
        if example.replay:
            yield Command(example.replay, "again: ")


def _failure(example: lg.LeagueCounterexample) -> Cell:
    if example.over_budget:
        return Cell("over budget", tone="open")
    return Cell(example.claim, tone="failed")


# ---------------------------------------------------------------- the files


def exhibits(league: lg.League, table: Sequence[lg.LeagueEntry]) -> Iterator[Exhibit]:
    """Each ranked mapper, run once more where it loses most, beside the first of the table.

    One that loses nowhere is shown alone, in its most expensive world.
    """
    targets = {mapper.text: mapper for mapper in league.mappers}
    for text, mapper in targets.items():
        entries = [e for e in table if e.mapper == text and e.place is not None]
        lost = [(e.losses[0], e.behind.mapper) for e in entries if e.losses and e.behind]
        if lost:
            loss, best = max(lost, key=lambda pair: pair[0].excess)
            words = f"loses most: {loss.cost} edge traversals, {league.name(best)} {loss.other}"
            yield _exhibit(league, loss, [targets[best], mapper], words, loss.show)
        elif entries:
            worst = max((e.dearest for e in entries if e.dearest), key=attrgetter("ratio"))
            words = f"most expensive: {worst.cost} edge traversals, {worst.ratio:.2f} × LB"
            again = replay_line(worst.world, text, None, league.limits.options)
            yield _exhibit(league, worst, [mapper], words, again)


def _exhibit(
    league: lg.League,
    at: lg.LostWorld | lg.MostExpensiveWorld,
    mappers: Sequence[Target],
    words: str,
    again: str,
) -> Exhibit:
    world = resolve_world(at.world)
    runs: list[PlayedRun] = []
    for mapper in mappers:
        run = explore(world, mapper, limits=league.limits)
        judgements = check(world, run.trace, run.stopped)
        name = league.name(mapper.text)
        runs.append(PlayedRun(name, run.trace, tuple(judgements), run.stopped))
    return Exhibit(
        title=target_title(league.name(mappers[-1].text), at.world),
        world=world,
        name=at.world,
        notes=(f"{words}, LB {at.least}", *(_purposes(r.name, r.trace) for r in runs)),
        runs=tuple(runs),
        again=again,
        whole=True,
    )


def _purposes(name: str, trace: Sequence[Event]) -> str:
    """The purposes of a run's moves, in words."""
    moves = Counter(event.purpose for event in trace if isinstance(event, Move))
    spent = [f"{word} {moves[purpose]}" for purpose, word in PURPOSES.items() if moves[purpose]]
    return f"{name}: {', '.join(spent)}"


PURPOSES: dict[Purpose | None, str] = {
    "walk": "walking to an edge",
    "cross": "crossing a new edge",
    "validate": "testing",
    "retrace": "going back",
    None: "for no declared purpose",
}


def write_folder(
    folder: Path,
    league: lg.League,
    table: Sequence[lg.LeagueEntry],
    played: Sequence[Exhibit],
    counterexamples: Sequence[Exhibit],
) -> None:
    """Write all files of the league but its page into the folder, and remove an old page."""
    (folder / REPORT).unlink(missing_ok=True)
    files.write(folder / "table.csv", table_csv(table))
    files.write(folder / "runs.csv", runs_csv(league, table))
    files.write(folder / "results.json", _results(league, table))
    files.write(folder / "timing.json", _timing(league, table))
    for suite in league.suites:
        if plot := plot_of(league, suite, table):
            files.write(folder / f"ratio-{suite.name}.svg", plot)
    for exhibit in played:
        _write_player(folder / "players", exhibit)
    for exhibit in counterexamples:
        _write_player(folder / "counterexamples", exhibit)
        name = _stem(exhibit)
        files.write(folder / "counterexamples" / f"{name}.svg", exhibit.world.draw())
    files.write(folder / "table.md", _table(league, table, played, counterexamples))


def _write_player(folder: Path, exhibit: Exhibit) -> None:
    folder.mkdir(exist_ok=True)
    if exhibit.runs:
        page = player_page(exhibit.world, exhibit.runs, name=exhibit.name)
        files.write(folder / f"{_stem(exhibit)}.html", page)


def _stem(exhibit: Exhibit) -> str:
    # A program's TARGET begins with dashes.
    return file_name(exhibit.runs[-1].name if exhibit.runs else exhibit.title).lstrip("-")


def _results(league: lg.League, table: Sequence[lg.LeagueEntry]) -> str:
    entries = [
        {name: value for name, value in entry.items() if name not in VARIES}
        for entry in msgspec.to_builtins(table)
    ]
    suites = [suite.name for suite in league.suites]
    head = {"format": "topo-verify/arena", "version": 1, "tool": version()}
    whole = {**head, "suite": suites, "seed": league.seed, "results": entries}
    return json.dumps(whole, indent=1) + "\n"


def _timing(league: lg.League, table: Sequence[lg.LeagueEntry]) -> str:
    rows = [
        {
            "mapper": entry.mapper,
            "name": entry.name,
            "suite": entry.suite,
            "ms_per_move": entry.ms_per_move,
            "memory_mib": league.memory(entry),
        }
        for entry in table
    ]
    return json.dumps(rows, indent=1) + "\n"


def _table(
    league: lg.League,
    table: Sequence[lg.LeagueEntry],
    played: Sequence[Exhibit],
    counterexamples: Sequence[Exhibit],
) -> str:
    parts = ["# The arena\n"]
    parts.append(markdown(standings(suite, table, league.seed, None) for suite in league.suites))
    parts += [markdown([Text(remark)]) for remark in league.remarks]
    for suite in league.suites:
        parts.append(f"## {suite.name}\n")
        parts.append(markdown(suite_blocks(suite, table)))
        if ranked_in(suite, table):
            parts.append(f"![cost / LB in {suite.name}](ratio-{suite.name}.svg)\n")
    if played:
        parts.append("## Where each loses most\n")
        for exhibit in played:
            words = Text(f"{exhibit.title}, {'; '.join(exhibit.notes)}")
            parts.append(markdown([words, Command(exhibit.again, "again: ")]))
            parts.append(f"[Step by step](<players/{_stem(exhibit)}.html>)\n")
    if broken := list(broken_blocks(table)):
        parts.append("## No place\n")
        parts.append(markdown(broken))
    for exhibit in counterexamples:
        parts.append(f"![The counterexample](<counterexamples/{_stem(exhibit)}.svg>)\n")
        if exhibit.runs:
            parts.append(f"[The run, step by step](<counterexamples/{_stem(exhibit)}.html>)\n")
    return "\n".join(parts)


# ---------------------------------------------------------------- CSV

TABLE = (
    *("place", "mapper", "suite", "family", "worlds", "edges", "least", "cost"),
    *("ratio", "low", "high", "behind", "behind_low", "behind_high"),
    *("rejected_free", "rejected_moving", "claims", "counterexample"),
)


def table_csv(entries: Sequence[lg.LeagueEntry]) -> str:
    """A row for each mapper and suite, then one for each of several families."""
    return csv_text(TABLE, [row for entry in entries for row in _rows(entry)])


def _rows(entry: lg.LeagueEntry) -> Iterator[Sequence[object]]:
    ratio, behind = entry.ratio, entry.behind
    broken = entry.counterexample
    alone = entry.families[0] if len(entry.families) == 1 else None
    yield (
        *(entry.place, entry.name, entry.suite, alone.family if alone else "", entry.worlds),
        *((alone.edges, alone.least, alone.cost) if alone else (None, None, None)),
        *((ratio.mean, ratio.low, ratio.high) if ratio else (None, None, None)),
        *((behind.mean, behind.low, behind.high) if behind else (None, None, None)),
        *(entry.rejected_free, entry.rejected_moving, claims_in_words(entry.claims)),
        broken.where if broken else None,
    )
    for family in entry.families if alone is None else ():
        mean = family.ratio
        yield (
            *(None, entry.name, entry.suite, family.family, family.worlds),
            *(family.edges, family.least, family.cost, mean.mean, mean.low, mean.high),
            *(None,) * (len(TABLE) - 11),
        )


RUNS = (
    *("mapper", "suite", "world", "edges", "least", "cost", "ratio"),
    *("rejected_free", "rejected_moving"),
)


def runs_csv(league: lg.League, table: Sequence[lg.LeagueEntry]) -> str:
    """A row for each run of a ranked mapper, by suite and mapper."""
    return csv_text(
        RUNS,
        [
            (
                *(entry.name, suite.name, run.world, run.edges, run.least, run.cost),
                *(round(run.ratio, 6), run.free, run.moving),
            )
            for suite in league.suites
            for entry in ranked_in(suite, table)
            for run in league.runs(entry.mapper, suite)
        ],
    )
