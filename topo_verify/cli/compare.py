"""`topo-verify compare`: what has changed since a baseline was recorded."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial

import click

from topo_verify.campaign.judge import judge
from topo_verify.campaign.run import explore
from topo_verify.checkers.findings import Verdict
from topo_verify.cli import options
from topo_verify.cli.output import Output, Result, Rows
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
from topo_verify.world import io

TITLES: dict[ChangeKind, str] = {
    "wrong": "a claim fails",
    "dearer": "costs more",
    "cheaper": "cheaper",
    "other_decisions": "other moves or decisions, same cost",
    "newly_right": "right now, and not in the baseline",
    "undecided": "not decided",
    "equal": "equal",
}

SHORT: dict[ChangeKind, str] = {
    "wrong": "fails",
    "dearer": "costs more",
    "cheaper": "cheaper",
    "other_decisions": "other",
    "newly_right": "newly right",
    "undecided": "not decided",
}

SHOWN = 5


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
    help="How much more each world may cost; a larger increase is a regression.",
)
def compare(
    output: Output,
    *,
    baseline: str,
    mappers: options.Mappers,
    workers: int,
    store: str | None,
    tolerance: str,
) -> int:
    """Run a mapper in the worlds of a BASELINE, under its limits, and show what has changed.

    Exit 1: in some world a claim fails, the cost exceeds the tolerance, or nothing is declared
    where the baseline declares decisions. An algorithm of the
    catalogue runs with the policies of the baseline unless others are given.
    """

    def compared() -> Iterator[Result[Comparison]]:
        then = file.load(baseline)
        named, limits = BaselineWorlds(then, baseline), then.header.limits
        with options.opened(store) as kept, mappers.opened(then.header.policies) as target:
            runs = baseline_runs(target, named, len(then.entries), limits=limits, store=kept)
            rows = options.stored_rows(output, [runs], workers, kept)
            entry = join(then, target, rows, tolerance=tolerance, name=baseline)
            yield Result(entry, failed=entry.regressed, incomplete=entry.undecided > 0)
            if output.exhibits:
                _run_again(output, then, target, entry)

    return output.run("compare", compared, _show, account=_account, in_process=mappers.in_process)


def _run_again(output: Output, then: file.Baseline, target: Target, changes: Comparison) -> None:
    texts = {entry.called: entry.world for entry in then.entries}
    for change in changes.examples:
        if change.kind == "wrong" or change.beyond:
            run = explore(io.from_text(texts[change.world]), target, limits=then.header.limits)
            report = judge(run, where=change.world)
            exhibit = exhibit_of(report)
            if exhibit is not None:
                note = (_line(change),) if change.beyond else exhibit.notes
                output.found.show(replace(exhibit, notes=note, again=change.replay))


# ---------------------------------------------------------------- for people


def _show(entries: Sequence[Comparison]) -> Iterator[Block]:
    for entry in entries:
        then = entry.baseline
        yield Text(
            f"{then.file}: {then.target}{_policies(then.policies)} in"
            f" {plural(entry.worlds, 'world')} ({then.corpus}), recorded with topo-verify"
            f" {then.tool}; now {entry.target}"
        )
        rows = [(TITLES[kind], f"{entry.kinds[kind]:,}") for kind in KINDS]
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


def _policies(policies: Policies | None) -> str:
    return "" if policies is None else f" (--pick {policies.pick} --order {policies.order})"


def _table(groups: Sequence[Group]) -> TextTable:
    """The table of classes; a kind without worlds has no column."""
    shown: list[ChangeKind] = [k for k in KINDS if any(group.kinds[k] for group in groups)]
    by_kind = [(f">{SHORT[kind]}", partial(_in_kind, kind)) for kind in shown if kind != "equal"]
    return Rows(groups).table(
        ("class", lambda g: g.value if g.by == "shape" else f"{g.by} {g.value}"),
        (">worlds", lambda g: f"{g.worlds:,}"),
        *by_kind,
        (">cost then", lambda g: f"{g.before:,}"),
        (">now", lambda g: f"{g.after:,}"),
        (">%", lambda g: _percentage(g.before, g.after)),
        title="by class of worlds, where something has changed",
    )


def _in_kind(kind: ChangeKind, group: Group) -> str:
    return f"{group.kinds[kind]:,}"


def _percentage(before: int, after: int) -> str:
    return f"{100 * (after - before) / before:+.1f}" if before else "-"


def _examples(kind: ChangeKind, entry: Comparison) -> Iterator[Block]:
    changes = [change for change in entry.examples if change.kind == kind][:SHOWN]
    if not changes:
        return
    yield Text("")
    first = "largest" if kind in ("dearer", "cheaper") else "smallest worlds"
    yield Text(f"{TITLES[kind]}: {entry.kinds[kind]:,}, {first} first")
    yield Bullets(tuple(map(_line, changes)))
    yield Command(changes[0].replay, "again: ")


def _line(change: Change) -> str:
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


def _conclusion(entry: Comparison) -> str:
    bad = [f"in {plural(entry.wrong, 'world')} a claim fails"] if entry.wrong else []
    if entry.beyond:
        verb = "exceeds" if entry.beyond == 1 else "exceed"
        bad.append(f"{plural(entry.beyond, 'world')} {verb} the tolerance of {entry.tolerance} %")
    if entry.undeclared:
        bad.append(
            f"in {plural(entry.undeclared, 'world')} the mapper declares nothing and the baseline"
            " does, so that claims about decisions are not judged"
        )
    if bad:
        return f"A regression: {', '.join(bad)}."
    rest = f"; {plural(entry.undecided, 'world')} not decided" if entry.undecided else ""
    return f"No regression in {entry.worlds - entry.undecided:,} of {entry.worlds:,} worlds{rest}."


# ---------------------------------------------------------------- for page, JUnit and badge


def _account(entries: Sequence[Comparison]) -> acc.Account:
    checked = sum(entry.worlds - entry.undecided for entry in entries)
    total = sum(entry.worlds for entry in entries)
    regressed = sum(entry.wrong + entry.beyond + entry.undeclared for entry in entries)
    verdict: Verdict = "SAMPLED" if checked == total and entries else "UNKNOWN"
    things = f"{acc.worlds(total)} without regression" if verdict == "SAMPLED" else ""
    extent = acc.extent(verdict, checked, total, regressed, things)
    if regressed:
        words = f"a regression in {regressed:,} of {checked:,} worlds"
        extent = acc.JudgedExtent("REFUTED", words)
    return acc.Account(
        ", ".join(f"{entry.target} against {entry.baseline.file}" for entry in entries),
        extent,
        acc.suites((entry.baseline.file, _cases(entry)) for entry in entries),
    )


def _cases(entry: Comparison) -> Iterator[acc.JudgedCase]:
    def case(
        name: str, number: int, of: int, first: Change | None, outcome: acc.CaseOutcome = "failed"
    ) -> acc.JudgedCase:
        return acc.JudgedCase(
            name,
            outcome if number else "ok",
            outcome if number else "passed",
            judged=f"{of - number:,} of {of:,}",
            message=_line(first) if first else "",
            again=first.replay if first else "",
        )

    decided = entry.worlds - entry.undecided
    wrong, late = (
        next((change for change in entry.examples if change.kind == kind), None)
        for kind in ("wrong", "undecided")
    )
    beyond = next((change for change in entry.examples if change.beyond), None)
    yield case("no claim fails", entry.wrong, decided, wrong)
    yield case(
        f"no cost exceeds the tolerance of {entry.tolerance} %", entry.beyond, decided, beyond
    )
    silent = next((change for change in entry.examples if change.undeclared), None)
    yield case("decisions declared as in the baseline", entry.undeclared, decided, silent)
    yield case("every world decided", entry.undecided, entry.worlds, late, "undecided")
