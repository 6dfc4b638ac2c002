"""`topo-verify faults`: mappers with one mistake each, and which check finds which."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import click

from topo_verify.campaign.run import Engine
from topo_verify.campaign.work import processors
from topo_verify.cli import options, version
from topo_verify.cli.output import Live, Output, Result
from topo_verify.errors import InputError, plural
from topo_verify.report import account as acc
from topo_verify.report.blocks import Block, Bullets, Command, Text, TextTable
from topo_verify.studies import faults as study

COLUMNS = ("fault", "claim", "m: worlds", ">tests", "ok")
WIDTHS = (29, 21, 13, 5, 3)
"""Eighty columns have no room for the part: it is printed above its first fault."""


@options.command(
    "faults",
    "faults restores-with-the-wrong-sign",
    "faults --by properties --format markdown",
    reports=True,
)
@click.argument("names", nargs=-1, metavar="[NAME...]")
@click.option(
    "--by",
    "checks",
    default=",".join(study.CHECKS),
    show_default=True,
    metavar="CHECKS",
    help="The checks to run, with commas.",
)
@options.workers()
@options.engine
@click.option(
    "--thorough",
    is_flag=True,
    help="Count the failing worlds of 6 and 7 edges, too, and try the harmless differences in all"
    f" worlds of {study.LARGEST_THOROUGH} edges: an hour.",
)
def faults(
    output: Output,
    *,
    names: tuple[str, ...],
    checks: str,
    workers: int | None,
    engine: Engine,
    thorough: bool,
) -> int:
    """Try the checks on mappers with one mistake each, and on some that differ harmlessly.

    Every check must catch every fault and no harmless difference: the search goes up to the
    first size with a failing world, and the property tests have Hypothesis's default number of
    examples. NAME is a fault; by default all are tried.
    """

    def tried() -> Iterator[Result[study.Caught]]:
        processes = processors() if workers is None else workers
        chosen = study.named_faults(names)
        if engine == "compiled":
            study.warm(chosen)
        # The first fault may take a minute.
        output.progress(chosen[0].name, 0, len(chosen))
        entries = study.try_faults(
            chosen,
            by=_checks(checks),
            workers=processes,
            thorough=thorough,
            engine=engine,
            tell=output.progress,
        )
        for done, entry in enumerate(entries, 1):
            if output.exhibits and entry.search is not None and entry.search.world is not None:
                _run_again(output, entry, entry.search.world)
            yield Result(entry, failed=not (entry.ok or entry.undecided), incomplete=not entry.ok)
            output.progress(entry.name, done, len(chosen))

    parts_shown: set[str] = set()

    def live(entry: study.Caught) -> Iterator[Block]:
        part = _part(entry)
        if part not in parts_shown:
            parts_shown.add(part)
            yield Text(f"{part}:")
        yield TextTable(COLUMNS, [_row(entry)], widths=WIDTHS, headed=False)

    head = (Text(_head(names, thorough=thorough)), TextTable(COLUMNS, [], widths=WIDTHS))
    return output.run(
        "faults",
        tried,
        _show,
        live=Live(head, live, _end),
        account=lambda entries: _account(entries, checks),
        walk=False,
        by=checks,
        engine=engine,
    )


def _run_again(output: Output, entry: study.Caught, world: str) -> None:
    assert entry.search is not None
    if claim := next(iter(entry.search.claims), None):
        output.found.run_again(
            (study.mapper_of(entry),), world, claim, study.A_SECOND, entry.search.message
        )


def _part(entry: study.Caught) -> str:
    return "harmless" if entry.harmless else entry.part


def _checks(text: str) -> list[study.Check]:
    asked = [word.strip() for word in text.split(",")]
    unknown = [word for word in asked if word not in study.CHECKS]
    if unknown:
        raise InputError(
            f"--by {text}: expected checks out of {', '.join(study.CHECKS)}, got {unknown[0]!r}"
        )
    return [check for check in study.CHECKS if check in asked]


# ---------------------------------------------------------------- the account


def _account(entries: Sequence[study.Caught], checks: str) -> acc.Account:
    suites: dict[str, list[acc.JudgedCase]] = {}
    for entry in entries:
        suites.setdefault(_part(entry), []).append(_case(entry, checks))
    asked = [entry for entry in entries if entry.asked]
    mappers = "mapper" if len(asked) == 1 else "mappers"
    right = acc.counted(sum(e.ok for e in asked), len(asked), f"{mappers} told right from wrong")
    return acc.Account(
        plural(len(entries), "faulty mapper"),
        acc.JudgedExtent("SAMPLED" if asked else "UNKNOWN", right),
        acc.suites(suites.items()),
    )


def _case(entry: study.Caught, checks: str) -> acc.JudgedCase:
    outcome: acc.CaseOutcome = (
        "passed" if entry.ok else "undecided" if entry.undecided else "failed"
    )
    words = {"passed": "caught", "failed": "missed", "undecided": "undecided"}
    if entry.harmless:
        words |= {"passed": "not flagged", "failed": "flagged"}
    search, where = entry.search, ""
    if search is not None and search.failing:
        where = f"fails in {plural(search.failing, 'world')} of {plural(search.edges, 'edge')}; "
    return acc.JudgedCase(
        name=entry.name,
        verdict=words[outcome] if entry.asked else "not asked",
        outcome=outcome if entry.asked else "not-judged",
        judged="" if search is None else f"{search.checked:,} of {search.total:,}",
        message=f"{where}{entry.why}",
        again=f"topo-verify faults {entry.name} --by {checks}",
    )


# ---------------------------------------------------------------- for people


def _head(names: Sequence[str], *, thorough: bool) -> str:
    harmless = study.LARGEST_THOROUGH if thorough else study.LARGEST_HARMLESS
    return (
        f"topo-verify {version()}: {plural(len(study.named_faults(names)), 'mapper')};"
        f" every world up to {study.LARGEST} edges ({harmless} for the harmless ones),"
        f" {study.EXAMPLES} examples of {' and of '.join(study.STRATEGIES)}"
    )


def _show(entries: Sequence[study.Caught]) -> Iterator[Block]:
    rows = [
        (
            *(entry.name, entry.part, *_row(entry)[1:-1]),
            _ok(entry),
        )
        for entry in entries
    ]
    yield TextTable(("fault", "part", *COLUMNS[1:-1], "ok"), rows)
    yield from _end(entries)


def _row(entry: study.Caught) -> tuple[str, ...]:
    return entry.name, entry.claim or "-", _worlds(entry), _examples(entry), _ok(entry)


def _ok(entry: study.Caught) -> str:
    if not entry.asked:
        return "-"
    if entry.ok:
        return "ok"
    return "?" if entry.undecided else "no"


def _worlds(entry: study.Caught) -> str:
    """`3: 4 of 74`: of 74 worlds with 3 edges 4 fail. `6: rank 8990`: the search stopped there."""
    smallest = entry.search
    if smallest is None:
        return "-"
    if smallest.world is None:
        return f"{smallest.edges}: none"
    if smallest.checked < smallest.total and not smallest.undecided:
        return f"{smallest.edges}: rank {smallest.world.split('/')[1]}"
    return f"{smallest.edges}: {smallest.failing} of {smallest.total}"


def _examples(entry: study.Caught) -> str:
    """The median; an asterisk if only the second strategy finds it with every seed."""
    drawn = entry.properties
    if drawn is None:
        return "-"
    if drawn.median_examples is None:
        return "none"
    return f"{drawn.median_examples}{'*' * (drawn.strategy != study.STRATEGIES[0])}"


def _end(entries: Sequence[study.Caught]) -> Iterator[Block]:
    yield Text("")
    wrong = [entry for entry in entries if not entry.ok]
    for entry in wrong:
        yield Text(f"{entry.name}: {entry.why}.")
        if entry.harmless and entry.search and entry.search.failing:
            yield Bullets((entry.search.message,))
            yield Command(entry.search.replay, "again: ")
    asked = [entry for entry in entries if entry.asked]
    faults = [entry for entry in asked if not entry.harmless]
    harmless = [entry for entry in asked if entry.harmless]
    caught = sum(entry.ok for entry in faults)
    flagged = sum(not (entry.ok or entry.undecided) for entry in harmless)
    alone = sum(entry.search is not None and bool(entry.search.convicting) for entry in faults)
    words = f"{caught} of {plural(len(faults), 'fault')} caught"
    words += f", {flagged} of {plural(len(harmless), 'harmless difference')} flagged"
    if any(entry.search for entry in faults):
        words += f". Convicted by one run, judged without its world: {alone} of the faults"
    yield Text(words + ".")
    if any(entry.undecided for entry in entries):
        yield Text("?: not decided, because a time limit ended a run.")
