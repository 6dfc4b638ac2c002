"""What the results of each judging command come to: its `Account`, for page, JUnit and badge.

The letter on a badge is the weakest verdict that counts: a refutation, else what is undecided, else
what was sampled. `verify` names its finite class and its samples apart.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from topo_verify.checkers.findings import Verdict
from topo_verify.cli.searched import SearchEntry
from topo_verify.cli.theorems import KINDS, ProveEntry
from topo_verify.cli.walks import FoundRuns
from topo_verify.harness.arena.league import LeagueEntry
from topo_verify.harness.conform.conform import LevelResult
from topo_verify.harness.faults.checks import Smallest
from topo_verify.harness.faults.detection import Caught
from topo_verify.harness.verify.parts import Part
from topo_verify.report.account import (
    Account,
    Exhibit,
    JudgedCase,
    JudgedExtent,
    JudgedSuite,
    Outcome,
    claim_cases,
    counted,
    joint_verdict,
    outcome_of,
)
from topo_verify.report.blocks import Block
from topo_verify.text import plural

WORLDLESS = {"counts": "numbers of worlds", "proofs": "theorems"}
"""The parts of `verify` that run no mapper, and what they count."""


def worlds(number: int) -> str:
    """The noun behind a number of worlds."""
    return "world" if number == 1 else "worlds"


def extent(
    verdict: Verdict, checked: int, total: int, failing: int, things: str = ""
) -> JudgedExtent:
    """The extent of a search or of trials, by its verdict."""
    if verdict == "REFUTED":
        things = things or worlds(checked)
        return JudgedExtent(verdict, counted(failing, checked, f"{things} fail"))
    return JudgedExtent(verdict, counted(checked, total, things or worlds(total)))


# ---------------------------------------------------------------- verify


def verify_account(
    who: str, parts: Sequence[Part], blocks: Iterable[Block], found: FoundRuns
) -> Account:
    """The account of `verify`: a suite a part, a case a claim."""
    return Account(
        about=who,
        extent=_verify_extent(parts),
        suites=tuple(JudgedSuite(part.part, tuple(_part_cases(part))) for part in parts),
        blocks=tuple(blocks),
        exhibits=found.exhibits,
        left_out=found.left_out,
    )


def _part_cases(part: Part) -> Iterator[JudgedCase]:
    first = part.findings[0].replay if part.findings else ""
    yield JudgedCase(
        name="the part as a whole",
        verdict=part.verdict,
        outcome=outcome_of(part.verdict),
        judged=f"{part.checked:,} of {part.total:,}",
        message=part.summary,
        again=first,
    )
    for case in claim_cases(part.judgements):
        failing = part.claims.get(case.name, {}).get("failed", 0)
        counted = f"fails in {plural(failing, 'run')}" if failing else ""
        yield replace(case, message="; ".join(filter(None, (counted, case.message))))


def _verify_extent(parts: Sequence[Part]) -> JudgedExtent:
    """The worlds of the finite class, and the sampled ones; theorems have a table of their own."""
    tried = [part for part in parts if part.part not in WORLDLESS]
    verdict = joint_verdict([part.verdict for part in parts])
    checked, total = sum(p.checked for p in tried), sum(p.total for p in tried)
    if verdict == "REFUTED":
        failing = sum(part.failing for part in tried)
        if not failing:
            wrong = ", ".join(part.part for part in parts if part.verdict == "REFUTED")
            return JudgedExtent(verdict, f"{wrong}: see the report")
        return extent(verdict, checked, total, failing)
    if verdict == "UNKNOWN":
        return extent(verdict, checked, total, 0)
    finite = [part for part in tried if part.verdict == "EXHAUSTED"]
    sampled = sum(part.checked for part in tried if part.verdict == "SAMPLED")
    if not finite:
        return extent("SAMPLED", checked, total, 0)
    number = sum(part.checked for part in finite)
    words = counted(number, sum(part.total for part in finite), worlds(number))
    return JudgedExtent("EXHAUSTED", f"{words}, {sampled:,} sampled" if sampled else words)


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


# ---------------------------------------------------------------- faults


def faults_account(
    entries: Sequence[Caught], checks: str, blocks: Iterable[Block], found: FoundRuns
) -> Account:
    """The account of `faults`: a suite a part of the mapper, a case a fault."""
    parts: dict[str, list[JudgedCase]] = {}
    for entry in entries:
        place = "harmless" if entry.harmless else entry.part
        parts.setdefault(place, []).append(_fault_case(entry, checks))
    asked = [entry for entry in entries if entry.asked]
    wrong = sum(not entry.ok and not entry.undecided for entry in asked)
    late = any(entry.undecided for entry in asked)
    verdict: Verdict = "REFUTED" if wrong else "UNKNOWN" if late or not asked else "SAMPLED"
    things = "mapper" if len(asked) == 1 else "mappers"
    right = sum(entry.ok for entry in asked)
    return Account(
        about=plural(len(entries), "faulty mapper"),
        extent=JudgedExtent(verdict, counted(right, len(asked), f"{things} told right from wrong")),
        suites=tuple(JudgedSuite(part, tuple(cases)) for part, cases in parts.items()),
        blocks=tuple(blocks),
        exhibits=found.exhibits,
        left_out=found.left_out,
    )


def _fault_case(entry: Caught, checks: str) -> JudgedCase:
    outcome: Outcome = "passed" if entry.ok else "undecided" if entry.undecided else "failed"
    words = {"passed": "caught", "failed": "missed", "undecided": "undecided"}
    if entry.harmless:
        words |= {"passed": "not flagged", "failed": "flagged"}
    search = entry.search
    return JudgedCase(
        name=entry.name,
        verdict=words[outcome] if entry.asked else "not asked",
        outcome=outcome if entry.asked else "not-judged",
        judged="" if search is None else f"{search.checked:,} of {search.total:,}",
        message=f"{_where(search)}{entry.why}",
        again=f"topo-verify faults {entry.name} --by {checks}",
    )


def _where(search: Smallest | None) -> str:
    """In how many of the judged worlds, those of the smallest size, a claim fails."""
    if search is None or not search.failing:
        return ""
    return f"fails in {plural(search.failing, 'world')} of {plural(search.edges, 'edge')}; "


# ---------------------------------------------------------------- prove


def prove_account(
    entries: Sequence[ProveEntry], options: str, blocks: Iterable[Block], found: FoundRuns
) -> Account:
    """The account of `prove`: a suite a kind, a case a theorem.

    Args:
        options: what the command that proves one theorem again needs besides its name.
    """
    kinds = [(kind, [entry for entry in entries if entry.kind == kind]) for kind in KINDS]
    cases = [_theorem_case(entry, options) for entry in entries]
    right = sum(case.outcome == "passed" for case in cases)
    positive = joint_verdict(
        [e.verdict for e in entries if e.expected != "REFUTED"] or ["EXHAUSTED"]
    )
    verdict: Verdict = "PROVED" if joint_verdict(positive) == "PROVED" else "EXHAUSTED"
    if any(case.outcome == "undecided" for case in cases) or not cases:
        verdict = "UNKNOWN"
    if any(case.outcome == "failed" for case in cases):
        verdict = "REFUTED"
    things = "theorem" if len(cases) == 1 else "theorems"
    return Account(
        about=plural(len(cases), "theorem"),
        extent=JudgedExtent(verdict, counted(right, len(cases), f"{things} as expected")),
        suites=tuple(
            JudgedSuite(kind, tuple(_theorem_case(entry, options) for entry in mine))
            for kind, mine in kinds
            if mine
        ),
        blocks=tuple(blocks),
        exhibits=found.exhibits,
        left_out=found.left_out,
    )


def _theorem_case(entry: ProveEntry, options: str) -> JudgedCase:
    outcome: Outcome = "passed"
    if not entry.ok:
        # As the exit code has it: only a definite verdict that is not the expected one fails.
        definite = entry.verdict not in ("UNKNOWN", entry.expected)
        outcome = "failed" if definite else "undecided"
    whole = entry.checked is not None and entry.total is not None
    return JudgedCase(
        name=entry.name,
        verdict=entry.verdict,
        outcome=outcome,
        judged=f"{entry.checked:,} of {entry.total:,}" if whole else "",
        message=f"{entry.words.removesuffix('.')}; {entry.note}" if entry.note else entry.words,
        again=f"topo-verify prove {entry.name}{options}",
    )


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
