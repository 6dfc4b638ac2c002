"""`topo-verify compare`: what has changed since a baseline was recorded."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

import click
import msgspec

from topo_verify.campaign.judge import judge
from topo_verify.campaign.run import explore
from topo_verify.checkers.findings import Verdict
from topo_verify.cli import options
from topo_verify.cli.kept_runs import opened, stored_rows
from topo_verify.cli.options import Mappers
from topo_verify.cli.output import Output, Result, entry_of
from topo_verify.cli.runs import exhibit_of
from topo_verify.errors import plural
from topo_verify.programs.loader import Target
from topo_verify.report import account as acc
from topo_verify.report.blocks import Block, Bullets, Command, Text, TextTable
from topo_verify.robot.events import Policies
from topo_verify.studies.baseline import file
from topo_verify.studies.baseline.compare import (
    KINDS,
    BaselineWorlds,
    Change,
    ChangeKind,
    Comparison,
    Group,
)
from topo_verify.studies.baseline.compare import compare as join
from topo_verify.studies.baseline.record import baseline_runs
from topo_verify.world.rooted_map import World

TITLES: dict[ChangeKind, str] = {
    "wrong": "a claim fails",
    "dearer": "dearer",
    "cheaper": "cheaper",
    "other_decisions": "other decisions at the same cost",
    "newly_right": "right now, and not in the baseline",
    "undecided": "not decided",
    "equal": "equal",
}
"""The title of each kind of change."""

SHORT: dict[ChangeKind, str] = {
    "wrong": "fails",
    "dearer": "dearer",
    "cheaper": "cheaper",
    "other_decisions": "other",
    "newly_right": "newly right",
    "undecided": "not decided",
}
"""The title of each kind above a column."""

SHOWN = 5
"""The number of worlds shown of each kind; JSON has more."""


class CostChange(msgspec.Struct, frozen=True):
    """Total edge traversals over the worlds in which the mapper is right then and now.

    Attributes:
        before, after: in the baseline, and now.
    """

    before: int
    after: int


class BaselineSummary(msgspec.Struct, frozen=True):
    """The baseline: its file, its mapper and its corpus.

    Attributes:
        tool: the version of topo-verify that recorded it.
        policies: those of the recording; null: the mapper had none.
        corpus, digest: the worlds, in words and as a digest.
    """

    file: str
    target: str
    tool: str
    policies: Policies | None
    corpus: str
    digest: str


class CompareEntry(msgspec.Struct, frozen=True):
    """One comparison: an entry of `results`.

    Attributes:
        worlds: those of the baseline; the sum of the seven numbers that follow.
        tolerance: in percent, as given.
        beyond: the number of worlds whose cost exceeds the tolerance.
        groups: the same numbers by class of worlds.
        examples: of each kind but `equal`; the largest changes of cost first, else the smallest
            worlds.
        wrong: where a claim fails.
        dearer, cheaper: where the cost has changed.
        other_decisions: where the cost is equal and a decision is not.
        equal: where nothing has changed.
        newly_right: where a claim failed in the baseline.
        undecided: where the run was not decided.
    """

    target: str
    worlds: int
    equal: int
    wrong: int
    dearer: int
    cheaper: int
    other_decisions: int
    newly_right: int
    undecided: int
    tolerance: str
    beyond: int
    cost: CostChange
    baseline: BaselineSummary
    groups: tuple[Group, ...]
    examples: tuple[Change, ...]


def _percent(_context: click.Context, _option: click.Parameter, value: str) -> str:
    """A percentage, kept as text: the comparison is exact."""
    if not re.fullmatch(r"[0-9]{1,6}(\.[0-9]{1,6})?", value):
        raise click.BadParameter(f"expected a percentage such as 5 or 2.5, got {value!r}")
    return value


@options.command(
    "compare baseline.jsonl.gz my_mapper.py:explore",
    "compare baseline.jsonl.gz my_mapper.py:explore --tolerance 5 --format markdown",
    reports=True,
)
@click.argument("baseline", metavar="BASELINE")
@options.mappers(with_policies=True)
@options.workers(0)
@options.store
@click.option(
    "--tolerance",
    default="0",
    show_default=True,
    callback=_percent,
    metavar="PERCENT",
    help="How much dearer each world may be; a larger increase is a regression.",
)
def compare(
    output: Output,
    *,
    baseline: str,
    mappers: Mappers,
    workers: int,
    store: str | None,
    tolerance: str,
) -> int:
    """Run a mapper in the worlds of a BASELINE, under its limits, and show what has changed.

    Exit 1: in some world a claim fails, or the cost exceeds the tolerance. An algorithm of the
    catalogue runs with the policies of the baseline, unless others are asked for.
    """

    def compared() -> Iterator[Result[CompareEntry]]:
        then = file.load(baseline)
        named, limits = BaselineWorlds(then, baseline), then.header.limits
        with opened(store) as kept, mappers.opened(then.header.policies) as target:
            made = baseline_runs(target, named, len(then.entries), limits=limits, store=kept)
            rows = stored_rows(output, [made], workers, kept)
            # An exact number: a float may put a world on the wrong side.
            found = join(then, target, rows, tolerance=Fraction(tolerance))
            if output.exhibits:
                _run_again(output, then, target, found)
        entry = _entry(found, target, then.header, baseline, tolerance)
        regressed = found.kinds["wrong"] > 0 or found.beyond > 0
        yield Result(entry, failed=regressed, incomplete=entry.undecided > 0)

    return output.run("compare", compared, _show, account=_account, in_process=mappers.in_process)


def _run_again(output: Output, then: file.Baseline, target: Target, found: Comparison) -> None:
    """Keep the runs of the mapper where a claim fails, and where it is dearer than allowed."""
    texts = {entry.called: entry.world for entry in then.entries}
    for change in found.examples:
        if change.kind == "wrong" or change.beyond:
            run = explore(World.from_text(texts[change.world]), target, limits=then.header.limits)
            report = judge(run, where=change.world)
            exhibit = exhibit_of(report)
            if exhibit is not None:
                note = (_line(change),) if change.beyond else exhibit.notes
                output.found.show(replace(exhibit, notes=note, again=change.replay))


def _entry(
    found: Comparison, target: Target, header: file.Header, name: str, tolerance: str
) -> CompareEntry:
    kinds = found.kinds
    return CompareEntry(
        target=target.text,
        worlds=sum(kinds.values()),
        # Each kind is a field of the entry under its own name.
        **kinds,
        tolerance=tolerance,
        beyond=found.beyond,
        cost=CostChange(found.before, found.after),
        baseline=entry_of(BaselineSummary, header, file=name),
        groups=found.groups,
        examples=found.examples,
    )


# ---------------------------------------------------------------- for people


def _show(entries: Sequence[CompareEntry]) -> Iterator[Block]:
    for entry in entries:
        then = entry.baseline
        yield Text(
            f"{entry.target} against {then.file}: {then.target} in {plural(entry.worlds, 'world')}"
            f" ({then.corpus}), recorded with topo-verify {then.tool}"
        )
        rows = [(TITLES[kind], f"{_count(entry, kind):,}") for kind in KINDS]
        yield TextTable(("", ">worlds"), rows)
        before, after = entry.cost.before, entry.cost.after
        yield Text(f"cost where right in both: {_costs(before, after)}")
        changed = [group for group in entry.groups if group.changed]
        if changed:
            yield Text("")
            yield _table(changed)
        for kind in KINDS:
            yield from _examples(kind, entry)
        yield Text("")
        yield Text(_conclusion(entry))


def _count(entry: CompareEntry, kind: ChangeKind) -> int:
    number: int = getattr(entry, kind)
    return number


def _table(groups: Sequence[Group]) -> TextTable:
    """The table of classes; a kind without worlds has no column."""
    kinds: list[ChangeKind] = [
        k for k in KINDS if k != "equal" and any(group.kinds[k] for group in groups)
    ]
    rows = [
        (
            group.value if group.by == "shape" else f"{group.by} {group.value}",
            f"{group.worlds:,}",
            *(f"{group.kinds[kind]:,}" for kind in kinds),
            f"{group.before:,}",
            f"{group.after:,}",
            _percentage(group.before, group.after),
        )
        for group in groups
    ]
    columns = ("class", ">worlds", *(f">{SHORT[k]}" for k in kinds), ">cost then", ">now", ">%")
    return TextTable(columns, rows, title="by class of worlds, where something has changed")


def _percentage(before: int, after: int) -> str:
    return f"{100 * (after - before) / before:+.1f}" if before else "-"


def _examples(kind: ChangeKind, entry: CompareEntry) -> Iterator[Block]:
    changes = [change for change in entry.examples if change.kind == kind][:SHOWN]
    if not changes:
        return
    yield Text("")
    # The order that studies/baseline/compare.py chose.
    first = "largest" if kind in ("dearer", "cheaper") else "smallest worlds"
    yield Text(f"{TITLES[kind]}: {_count(entry, kind):,}, {first} first")
    yield Bullets(tuple(map(_line, changes)))
    yield Command(changes[0].replay, "again: ")


def _line(change: Change) -> str:
    """One changed world: its name, then both costs or the finding."""
    name = change.world if len(change.world) < 40 else f"{change.world[:36]}…"
    if change.message:
        return f"{name}: {change.message}"
    if change.before is None or change.after is None:
        return name
    beyond = ", beyond the tolerance" if change.beyond else ""
    return f"{name}: {_costs(change.before, change.after)}{beyond}"


def _costs(before: int, after: int) -> str:
    traversals = "edge traversal" if after == 1 else "edge traversals"
    return f"{before:,} → {after:,} {traversals} ({_percentage(before, after)} %)"


def _conclusion(entry: CompareEntry) -> str:
    bad: list[str] = []
    if entry.wrong:
        bad.append(f"in {plural(entry.wrong, 'world')} a claim fails")
    if entry.beyond:
        bad.append(f"{plural(entry.beyond, 'world')} dearer by more than {entry.tolerance} %")
    if bad:
        return f"A regression: {', '.join(bad)}."
    rest = f"; {plural(entry.undecided, 'world')} not decided" if entry.undecided else ""
    return f"No regression in {entry.worlds - entry.undecided:,} of {entry.worlds:,} worlds{rest}."


# ---------------------------------------------------------------- for page, JUnit and badge


def _account(entries: Sequence[CompareEntry]) -> acc.Account:
    """The account of a comparison: a suite a baseline, a case for each question."""
    checked = sum(entry.worlds - entry.undecided for entry in entries)
    total = sum(entry.worlds for entry in entries)
    regressed = sum(entry.wrong + entry.beyond for entry in entries)
    verdict: Verdict = "SAMPLED" if checked == total and entries else "UNKNOWN"
    if regressed:
        verdict = "REFUTED"
    things = f"{acc.worlds(total)} without regression" if verdict == "SAMPLED" else ""
    said = acc.extent(verdict, checked, total, regressed, things)
    if regressed:
        said = replace(said, words=f"a regression in {regressed:,} of {checked:,} worlds")
    return acc.Account(
        ", ".join(f"{entry.target} against {entry.baseline.file}" for entry in entries),
        said,
        acc.suites((entry.baseline.file, _cases(entry)) for entry in entries),
    )


def _cases(entry: CompareEntry) -> Iterator[acc.JudgedCase]:
    decided = entry.worlds - entry.undecided
    wrong = next((one for one in entry.examples if one.kind == "wrong"), None)
    dearer = next((one for one in entry.examples if one.beyond), None)
    late = next((one for one in entry.examples if one.kind == "undecided"), None)
    for name, number, of, first, bad in (
        ("no claim fails", entry.wrong, decided, wrong, "failed"),
        (f"no world dearer by over {entry.tolerance} %", entry.beyond, decided, dearer, "failed"),
        ("every world decided", entry.undecided, entry.worlds, late, "undecided"),
    ):
        outcome: acc.Outcome = (
            "passed" if not number else "failed" if bad == "failed" else "undecided"
        )
        yield acc.JudgedCase(
            name=name,
            verdict="ok" if outcome == "passed" else outcome,
            outcome=outcome,
            judged=f"{of - number:,} of {of:,}",
            message="" if first is None else _line(first),
            again="" if first is None else first.replay,
        )
