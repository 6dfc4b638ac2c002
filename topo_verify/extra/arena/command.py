"""`topo-verify arena`: mappers in named suites of worlds, ranked by cost; only sound ones."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import click
import msgspec

from topo_verify.campaign.campaign import close
from topo_verify.campaign.judge import JudgedRun, Report
from topo_verify.campaign.targets import each_text
from topo_verify.campaign.targets import targets as targets_of
from topo_verify.campaign.work import processors
from topo_verify.checkers.findings import Verdict
from topo_verify.cli import options
from topo_verify.cli.output import Output, Result
from topo_verify.cli.runs import judged, named_world, target_title, unjudged
from topo_verify.errors import InputError, WriteError, plural
from topo_verify.extra.arena import folder as files
from topo_verify.extra.arena.league import League, LeagueEntry
from topo_verify.extra.arena.match import matches, measure, not_shown
from topo_verify.extra.arena.suites import DEFAULT, SUITES, chosen_suites, own_suite
from topo_verify.programs.library import LIBRARY
from topo_verify.programs.loaded import watch
from topo_verify.programs.loader import Target
from topo_verify.programs.program import PREFIX, Program
from topo_verify.report import account as acc
from topo_verify.report.blocks import Block, PictureBlock, Text
from topo_verify.robot.limits import Limits


@options.command(
    "arena basic,folding",
    "arena basic,folding my_mapper.py:explore --suite lattices,regular",
    "arena basic,folding --worlds 'drawn:30:king(6,6)' --worlds worlds/",
    "arena all --cmd './mapper --fast' --name './mapper --fast=Team A' --seed 20261 --out league",
    reports=True,
)
@click.argument("texts", nargs=-1, metavar="[TARGET]...")
@click.option(
    "--cmd",
    "commands",
    multiple=True,
    metavar="'PROGRAM ARGS'",
    help="Also rank this program; may be repeated.",
)
@click.option(
    "--library",
    "libraries",
    multiple=True,
    metavar="FILE[:SYMBOL]",
    help="Also rank this native mapper; may be repeated.",
)
@options.titles
@options.in_process
@click.option(
    "--suite",
    metavar="NAMES",
    help=f"Named worlds: {', '.join(SUITES)}, several with commas, or all. [default: {DEFAULT}]",
)
@click.option(
    "--worlds",
    multiple=True,
    metavar="WORLDS",
    help="Worlds of your own, as in conform: the suite `own`; may be repeated.",
)
@options.seed("Of the drawn worlds; 0: the public ones, any other: drawn anew.")
@click.option(
    "--out", metavar="DIR", help="Write tables, plots and a page to DIR; resume from its runs."
)
@options.workers()
@options.limits
def arena(
    output: Output,
    *,
    texts: tuple[str, ...],
    commands: tuple[str, ...],
    libraries: tuple[str, ...],
    titles: tuple[str, ...],
    in_process: bool,
    suite: str | None,
    worlds: tuple[str, ...],
    seed: int,
    out: str | None,
    workers: int | None,
    limits: Limits,
) -> int:
    """Rank mappers by what they pay for a map, as a multiple of the least cost of a proof (LB).

    Every run is judged by every claim. A mapper that breaks one plays no further: it has no
    place, only its counterexample. Intervals are at 95 %; `behind` compares with the first of the
    table in the same worlds. The same call gives the same figures, except for time and memory.
    """
    own = [own_suite(worlds, seed)] if worlds else []
    if own and seed and own[0].exact:
        output.note("--seed draws nothing in --worlds without drawn: and generated:")
    suites = (*own, *(chosen_suites(suite or DEFAULT) if suite or not own else ()))
    asked = _asked(texts, commands, libraries)
    folder = None if out is None else options.make_folder(out, "--out")
    if folder is not None:
        watch()  # before a mapper is loaded
        output.ask(report=str(folder / files.REPORT))
    mappers, broken = _loaded(output, asked, in_process=in_process)
    names = options.names_of(titles, [*(mapper.text for mapper in mappers), *broken])
    league = League(mappers, suites, seed, limits, names, broken)
    _require_players(league)
    played: list[acc.Exhibit] = []

    def entries() -> Iterator[Result[LeagueEntry]]:
        try:
            _play(output, league, folder, processors() if workers is None else workers)
        except (KeyboardInterrupt, WriteError):
            yield from map(_result, league.entries())
            raise
        table = league.entries()
        _add_timing(output, league, table)
        yield from map(_result, table)
        # An interruption from here on keeps the table.
        _run_again(output, league, table)
        if output.exhibits:
            output.progress("playing runs for the pages", 0, 1)
            played.extend(files.exhibits(league, table))
        if folder is not None:
            files.write_folder(folder, league, table, played, output.found.exhibits)
        close(mappers)

    def account(table: Sequence[LeagueEntry]) -> acc.Account:
        blocks = _show(league, table, memory=None, pictures=True)
        return _account(table, blocks, played, exact=all(s.exact for s in suites))

    close(mappers)
    show = partial(_show, league, memory=league.memory)
    words = [chosen.name for chosen in suites]
    return output.run(
        "arena",
        entries,
        show,
        account=account,
        extent=lambda _: acc.counted(len(league.rows), league.planned, "runs"),
        suite=words,
        seed=seed,
        in_process=in_process,
    )


def _asked(texts: Sequence[str], commands: Sequence[str], libraries: Sequence[str]) -> list[str]:
    asked = [*texts, *(PREFIX + command for command in commands)]
    asked += [LIBRARY + library for library in libraries]
    if not asked:
        raise InputError("name the TARGETs that take part, or programs with --cmd 'program args'")
    return asked


def _loaded(
    output: Output, asked: Sequence[str], *, in_process: bool
) -> tuple[tuple[Target, ...], dict[str, str]]:
    """The mappers; and for each TARGET that cannot be loaded or started, why."""
    texts: list[str] = []
    loaded: list[Target] = []
    broken: dict[str, str] = {}
    for text in (name for entrants in asked for name in each_text(entrants)):
        try:
            (target,) = targets_of(text, in_process=in_process)
            if isinstance(target.mapper, Program):
                target.mapper.start()
            loaded.append(target)
        except InputError as error:
            broken[text] = str(error)
        texts.append(text if text in broken else loaded[-1].text)
    twice = next((text for text in texts if texts.count(text) > 1), None)
    if twice is not None:
        close(loaded)
        raise InputError(f"target {twice!r} takes part twice: name each mapper once")
    if not loaded:
        raise InputError(next(iter(broken.values())))
    for why in broken.values():
        output.note(f"no place: {why}")
    return tuple(loaded), broken


def _require_players(league: League) -> None:
    for mapper in league.mappers:
        if not any(league.plays(mapper, suite) for suite in league.suites):
            raise InputError(
                f"target {mapper.text!r} assumes planar worlds, and --suite"
                f" {','.join(s.name for s in league.suites)} has others: add --suite"
                f" {','.join(s.name for s in SUITES.values() if s.planar)}"
            )


def _result(entry: LeagueEntry) -> Result[LeagueEntry]:
    broken = entry.counterexample is not None
    return Result(entry, failed=broken, incomplete=not broken and entry.worlds < entry.total)


def _play(output: Output, league: League, folder: Path | None, workers: int) -> None:
    for mapper in league.mappers:
        for suite in league.suites:
            if not league.plays(mapper, suite):
                output.note(f"{mapper.text} assumes planar worlds: left out of {suite.name}")
    with options.open_store(folder) as store:
        campaigns = matches(league, store, output.note)
        if store is not None and (others := not_shown(campaigns, store)):
            league.remarks.append(others)
        for row in options.stored_rows(output, campaigns, workers, store):
            league.rows[row.mapper, row.world] = row
        measure(league, store, output.progress)


def _run_again(output: Output, league: League, table: Sequence[LeagueEntry]) -> None:
    broken = {e.mapper: e.counterexample for e in table if e.counterexample is not None}
    for mapper in league.mappers:
        if (first := broken.get(mapper.text)) is not None:
            at = named_world(first.world)
            failure = league.rows[mapper.text, first.world]
            limits = league.limits_of_failure(failure)
            _, report, undecided = judged(mapper, at, limits)
            title = target_title(league.name(mapper.text), at.text)
            if any(finding.claim == first.claim for finding in report.findings):
                named = msgspec.structs.replace(report, target=league.name(mapper.text))
                named = named.of(report.run)
                if limits is not league.limits and report.run is not None:
                    why = f"{CUT}; the whole run: {failure.findings[0].replay}"
                    named = _cut(named, report.run._replace(stopped=why))
                    league.remarks.append(f"{title}: {why}")
                output.found.keep(named)
                continue
            output.found.show(acc.Exhibit(title, at.world, at.text, (first.message,)))
            if not undecided:
                league.remarks.append(
                    f"{title}, run once more: {first.claim} holds. The mapper does not do the same"
                    " each time; the first run counts."
                )


CUT = "cut here, soon after the failing claim"


def _cut(report: Report, run: JudgedRun) -> Report:
    """The report without the finding that a run which we cut delivered no map."""
    findings = [f for f in report.findings if (f.claim, f.event) != ("map-isomorphic", None)]
    cut = report.with_findings(findings)
    judgements = tuple(
        msgspec.structs.replace(judgement, status="undecided")
        if judgement.status == "failed" and not judgement.findings
        else judgement
        for judgement in cut.judgements
    )
    return msgspec.structs.replace(cut, judgements=judgements).of(run)


def _add_timing(output: Output, league: League, table: Sequence[LeagueEntry]) -> None:
    time, memory = defaultdict[str, Any](dict), defaultdict[str, Any](dict)
    for entry in table:
        if entry.place is not None:
            time[entry.suite][entry.name] = entry.ms_per_move
            memory[entry.suite][entry.name] = league.memory(entry)
    output.timing.update(ms_per_move=dict(time), memory_mib=dict(memory))


# ---------------------------------------------------------------- for people


def _show(
    league: League,
    table: Sequence[LeagueEntry],
    *,
    memory: files.Memory | None,
    pictures: bool = False,
) -> Iterator[Block]:
    for number, suite in enumerate(league.suites):
        if number:
            yield Text("")
        yield files.standings(suite, table, league.seed, memory)
    if pictures:
        limits = league.limits
        moves = "the bound of claim 7" if limits.budget is None else limits.budget
        yield Text(
            f"{files.LEGEND} Limits of a run: moves, {moves}; {limits.move_timeout:g} s without a"
            f" move, {limits.world_timeout:g} s in all."
        )
    for remark in league.remarks:
        yield Text("")
        yield Text(remark)
    if memory is not None and any(entry.place is not None for entry in table):
        yield Text("")
        yield Text(files.VARYING)
    for suite in league.suites:
        yield from files.suite_blocks(suite, table)
        if pictures and (plot := files.plot_of(league, suite, table)):
            alt = f"cost / LB by family in suite {suite.name}"
            yield PictureBlock(plot, alt)
    ranked = {entry.mapper: entry for entry in table if entry.place is not None}
    for mapper, entry in ranked.items():
        for sentence in unjudged(mapper, "these worlds", entry.judgements):
            yield Text("")
            yield sentence
    yield from files.broken_blocks(table)


# ---------------------------------------------------------------- the account


def _account(
    table: Sequence[LeagueEntry],
    blocks: Iterable[Block],
    played: Sequence[acc.Exhibit],
    *,
    exact: bool,
) -> acc.Account:
    mappers = list(dict.fromkeys(entry.name for entry in table))
    broken = {e.name: e.counterexample for e in table if e.counterexample is not None}
    over = sum(example.over_budget for example in broken.values())
    runs, planned = sum(e.worlds for e in table), sum(e.total for e in table)
    verdict: Verdict = "UNKNOWN" if runs < planned else "EXHAUSTED" if exact else "SAMPLED"
    first: dict[str, list[str]] = {}
    for entry in table:
        if entry.place == 1:
            first.setdefault(entry.suite, []).append(entry.name)
    words = [f"first in {suite}: {' = '.join(names)}" for suite, names in first.items()]
    if broken:
        verdict = "REFUTED"
        unloaded = sum(not example.world for example in broken.values())
        wrong = len(broken) - over - unloaded
        late = {e.name for e in table if e.undecided} - broken.keys()
        kinds = [(wrong, "break a claim"), (over, "are over budget")]
        for number, what in (*kinds, (unloaded, "cannot be loaded"), (len(late), "out of time")):
            words += [acc.counted(number, len(mappers), f"mappers {what}")] if number else []
    else:
        words.append(acc.counted(runs, planned, "runs"))
    judged = acc.JudgedExtent(verdict, "; ".join(words))
    return acc.Account(
        mappers[0] if len(mappers) == 1 else plural(len(mappers), "mapper"),
        judged,
        acc.suites((f"{entry.name} in {entry.suite}", _cases(entry)) for entry in table),
        tuple(blocks),
        others=tuple(played),
        results_first=True,
    )


def _cases(entry: LeagueEntry) -> Iterator[acc.JudgedCase]:
    broken, late = entry.counterexample, entry.worlds < entry.total
    yield acc.verdict_case(
        "every world of the suite",
        "REFUTED" if broken else "UNKNOWN" if late else "SAMPLED",
        judged=f"{entry.worlds:,} of {entry.total:,}",
        message=f"{broken.where}: {broken.message}" if broken else "; ".join(entry.why),
        again=broken.replay if broken else "",
    )
    yield from acc.claim_cases(entry.judgements)
