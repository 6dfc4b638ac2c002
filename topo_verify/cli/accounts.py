"""What the results of each judging command come to: its `Account`, for page, JUnit and badge.

A verdict here is the weakest that counts: a refutation, else what is undecided, else what was
sampled. `output.py` replaces it by that of the exit code.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from topo_verify.cli.walks import FoundRuns
from topo_verify.report.account import (
    Account,
    Exhibit,
    JudgedCase,
    JudgedExtent,
    JudgedSuite,
    claim_cases,
    counted,
    extent,
    joint_verdict,
    outcome_of,
    worlds,
)
from topo_verify.report.blocks import Block
from topo_verify.studies.arena.league import LeagueEntry
from topo_verify.studies.conform.conform import LevelResult
from topo_verify.studies.search.search import SearchEntry
from topo_verify.text import plural

# ---------------------------------------------------------------- search


def search_account(
    entries: Sequence[SearchEntry], blocks: Iterable[Block], found: FoundRuns
) -> Account:
    """The account of `search`: a suite a search; its verdict, and a case a claim."""
    verdict = joint_verdict([entry.verdict for entry in entries])
    failing = sum(size.failing for entry in entries for size in entry.by_edges)
    checked, total = sum(e.checked for e in entries), sum(e.total for e in entries)
    return Account(
        about=", ".join(entry.target for entry in entries),
        extent=extent(verdict, checked, total, failing),
        suites=tuple(JudgedSuite(_search_name(e), tuple(_search_cases(e))) for e in entries),
        blocks=tuple(blocks),
        exhibits=found.exhibits,
        left_out=found.left_out,
    )


def _search_name(entry: SearchEntry) -> str:
    kind = "" if entry.kind == "any" else f", {entry.kind}"
    return f"{entry.target}: worlds of 1 to {plural(entry.edges, 'edge')}{kind}"


def _search_cases(entry: SearchEntry) -> Iterator[JudgedCase]:
    first = entry.counterexample
    yield JudgedCase(
        name="every world of the class",
        verdict=entry.verdict,
        outcome=outcome_of(entry.verdict),
        judged=f"{entry.checked:,} of {entry.total:,}",
        message="" if first is None else f"{first.claim} in {first.world}: {first.message}",
        again="" if first is None else first.replay,
    )
    wrong = {one.claim: one for one in entry.claims}
    for case in claim_cases(entry.judgements):
        if (one := wrong.pop(case.name, None)) is None:
            yield case
        else:
            yield _failing(case.name, one.failing, one.smallest.message, one.smallest.replay)
    for claim, one in wrong.items():
        yield _failing(claim, one.failing, one.smallest.message, one.smallest.replay)


def _failing(claim: str, number: int, message: str, again: str) -> JudgedCase:
    where = f"in {plural(number, 'world')}; {message}"
    return JudgedCase(claim, "failed", "failed", message=where, again=again)


# ---------------------------------------------------------------- conform


def conform_account(
    levels: Sequence[LevelResult], blocks: Iterable[Block], found: FoundRuns
) -> Account:
    """The account of `conform`: a suite a mapper, a case a level and a claim of it."""
    names = list(dict.fromkeys(level.target for level in levels))
    verdict = joint_verdict([level.verdict for level in levels])
    whole = [level for level in levels if level.verdict == verdict]
    failed = max((level.failed for level in whole), default=0)
    passed = min((level.passed for level in levels), default=0)
    total = levels[0].worlds if levels else 0
    words = counted(passed, total, f"{worlds(total)} conform")
    if verdict == "REFUTED":
        words = counted(failed, total, f"{worlds(total)} fail")
    return Account(
        about=", ".join(names),
        extent=JudgedExtent(verdict, words),
        suites=tuple(
            JudgedSuite(name, tuple(_conform_cases([one for one in levels if one.target == name])))
            for name in names
        ),
        blocks=tuple(blocks),
        exhibits=found.exhibits,
        left_out=found.left_out,
    )


def _conform_cases(levels: Sequence[LevelResult]) -> Iterator[JudgedCase]:
    for level in levels:
        first = level.findings[0] if level.findings else None
        yield JudgedCase(
            name=f"level {level.level}",
            verdict=level.verdict,
            outcome=outcome_of(level.verdict),
            judged=f"{level.passed:,} of {level.worlds:,}",
            message=(level.why or ("",))[0] if first is None else f"{first.world}: {first.message}",
            again="" if first is None else first.replay,
        )
        for case in claim_cases(level.judgements):
            found = next((one for one in level.findings if one.claim == case.name), None)
            if found is None:
                yield case
            else:
                yield JudgedCase(
                    case.name, case.verdict, case.outcome, case.judged, found.message, found.replay
                )


# ---------------------------------------------------------------- arena


def arena_account(
    table: Sequence[LeagueEntry],
    blocks: Iterable[Block],
    found: FoundRuns,
    dearest: Sequence[Exhibit],
    *,
    exact: bool,
) -> Account:
    """The account of `arena`: a suite of worlds and a mapper a suite, a case a claim.

    Args:
        dearest: the ranked mappers in their dearest worlds.
        exact: the worlds are all those of finite classes.
    """
    mappers = list(dict.fromkeys(entry.mapper for entry in table))
    broken = {entry.mapper for entry in table if entry.counterexample is not None}
    runs, planned = sum(e.worlds for e in table), sum(e.total for e in table)
    judged = JudgedExtent("EXHAUSTED" if exact else "SAMPLED", counted(runs, planned, "runs"))
    if runs < planned:
        judged = JudgedExtent("UNKNOWN", counted(runs, planned, "runs"))
    if broken:
        words = counted(len(broken), len(mappers), "mappers break a claim")
        judged = JudgedExtent("REFUTED", words)
    return Account(
        about=mappers[0] if len(mappers) == 1 else plural(len(mappers), "mapper"),
        extent=judged,
        suites=tuple(
            JudgedSuite(f"{entry.mapper} in {entry.suite}", tuple(_arena_cases(entry)))
            for entry in table
        ),
        blocks=tuple(blocks),
        exhibits=found.exhibits,
        left_out=found.left_out,
        others=tuple(dearest),
    )


def _arena_cases(entry: LeagueEntry) -> Iterator[JudgedCase]:
    broken, late = entry.counterexample, entry.worlds < entry.total
    yield JudgedCase(
        name="every world of the suite",
        verdict="REFUTED" if broken else "UNKNOWN" if late else "SAMPLED",
        outcome="failed" if broken else "undecided" if late else "passed",
        judged=f"{entry.worlds:,} of {entry.total:,}",
        message=f"{broken.claim} in {broken.world}: {broken.message}"
        if broken
        else "; ".join(entry.why),
        again=broken.replay if broken else "",
    )
    yield from claim_cases(entry.judgements)
