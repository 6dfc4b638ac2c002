"""`topo-verify compare`: what has changed since a baseline was recorded."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from fractions import Fraction

import click
import msgspec

from topo_verify.cli import options
from topo_verify.cli.layout import Block, Bullets, Command, Table, Text
from topo_verify.cli.output import Output, Result
from topo_verify.cli.output import options as output_options
from topo_verify.cli.record import Opening, mapper_options
from topo_verify.harness.baseline import file
from topo_verify.harness.baseline.compare import KINDS, Change, ChangeKind, Comparison, Group
from topo_verify.harness.baseline.compare import compare as run_all
from topo_verify.programs.loading import Target
from topo_verify.robot.events import Policies
from topo_verify.text import plural

TITLES: dict[ChangeKind, str] = {
    "wrong": "a claim fails",
    "dearer": "dearer",
    "cheaper": "cheaper",
    "other_decisions": "other decisions at the same cost",
    "newly_right": "right now, and not in the baseline",
    "undecided": "not decided",
    "equal": "equal",
}
"""Each kind in words."""

SHORT: dict[ChangeKind, str] = {
    "wrong": "fails",
    "dearer": "dearer",
    "cheaper": "cheaper",
    "other_decisions": "other",
    "newly_right": "newly right",
    "undecided": "not decided",
}
"""The same as titles of columns."""

SHOWN = 5
"""Of each kind so many worlds are shown."""


class Costs(msgspec.Struct, frozen=True):
    """Edge traversals where the mapper is right then and now, summed up."""

    before: int
    after: int


class Recording(msgspec.Struct, frozen=True):
    """The baseline: its mapper, and the corpus that it was recorded in."""

    file: str
    target: str
    tool: str
    policies: Policies | None
    corpus: str
    digest: str


class Compared(msgspec.Struct, frozen=True):
    """One comparison: an entry of `results`; docs/commands.md.

    Attributes:
        worlds: all of the baseline; the sum of the seven numbers behind it.
        tolerance: in percent, as it was given.
        beyond: in how many worlds the cost exceeds the tolerance.
        groups: the same numbers by class of worlds.
        examples: of each kind but `equal`; the largest changes of cost first, else the smallest
            worlds.
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
    cost: Costs
    baseline: Recording
    groups: tuple[Group, ...]
    examples: tuple[Change, ...]


def _percent(_context: click.Context, _option: click.Parameter, value: str) -> str:
    """A number of percent, kept as text so as to be exact."""
    if not re.fullmatch(r"[0-9]{1,6}(\.[0-9]{1,6})?", value):
        raise click.BadParameter(f"{value!r} is no number of percent as 5 or 2.5")
    return value


@click.command(
    short_help="What has changed since a baseline was recorded.",
    epilog=options.epilog(
        "compare baseline.jsonl.gz my_mapper.py:explore",
        "compare baseline.jsonl.gz my_mapper.py:explore --tolerance 5 --format markdown",
    ),
)
@click.argument("baseline", metavar="BASELINE")
@mapper_options
@click.option(
    "--tolerance",
    default="0",
    show_default=True,
    callback=_percent,
    metavar="PERCENT",
    help="By so much each world may be dearer; one that is dearer still is a regression.",
)
@output_options
def compare(output: Output, *, baseline: str, mapper: Opening, tolerance: str) -> int:
    """Run a mapper in the worlds of a BASELINE, under its limits, and say what has changed.

    Exit 1: in some world a claim fails, or the cost exceeds the tolerance. An algorithm of the
    catalogue runs with the policies of the baseline, unless others are asked for.
    """

    def compared() -> Iterator[Result[Compared]]:
        then = file.load(baseline)
        with mapper(then.header.policies) as target:
            found = run_all(
                then,
                target,
                tolerance=Fraction(tolerance),
                name=baseline,
                tell=output.progress,
            )
        entry = _entry(found, target, then.header, baseline, tolerance)
        regressed = found.kinds["wrong"] > 0 or found.beyond > 0
        yield Result(entry, failed=regressed, incomplete=entry.undecided > 0)

    return output.run("compare", compared, _show)


def _entry(
    found: Comparison, target: Target, header: file.Header, name: str, tolerance: str
) -> Compared:
    kinds = found.kinds
    return Compared(
        target=target.text,
        worlds=sum(kinds.values()),
        **kinds,
        tolerance=tolerance,
        beyond=found.beyond,
        cost=Costs(found.before, found.after),
        baseline=Recording(
            name, header.target, header.tool, header.policies, header.corpus, header.digest
        ),
        groups=found.groups,
        examples=found.examples,
    )


# ---------------------------------------------------------------- for people


def _show(entries: Sequence[Compared]) -> Iterator[Block]:
    for entry in entries:
        then = entry.baseline
        yield Text(
            f"{entry.target} against {then.file}: {then.target} in {plural(entry.worlds, 'world')}"
            f" ({then.corpus}), recorded with topo-verify {then.tool}"
        )
        yield _summary(entry)
        before, after = entry.cost.before, entry.cost.after
        yield Text(f"cost where right in both: {_costs(before, after)}")
        changed = [group for group in entry.groups if group.changed]
        if changed:
            yield Text("")
            yield _table(changed)
        for kind in KINDS:
            yield from _examples(kind, entry)
        yield Text("")
        yield Text(_upshot(entry))


def _summary(entry: Compared) -> Table:
    rows = [(TITLES[kind], f"{_count(entry, kind):,}") for kind in KINDS]
    return Table(("", ">worlds"), rows)


def _count(entry: Compared, kind: ChangeKind) -> int:
    number: int = getattr(entry, kind)
    return number


def _table(groups: Sequence[Group]) -> Table:
    """The classes; a kind that no world is of has no column."""
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
    return Table(columns, rows, title="by class of worlds, where something has changed")


def _percentage(before: int, after: int) -> str:
    return f"{100 * (after - before) / before:+.1f}" if before else "-"


def _examples(kind: ChangeKind, entry: Compared) -> Iterator[Block]:
    changes = [change for change in entry.examples if change.kind == kind][:SHOWN]
    if not changes:
        return
    yield Text("")
    first = "largest" if kind in ("dearer", "cheaper") else "smallest worlds"
    yield Text(f"{TITLES[kind]}: {_count(entry, kind):,}, {first} first")
    yield Bullets(tuple(map(_line, changes)))
    yield Command(changes[0].replay, "again: ")


def _line(change: Change) -> str:
    """World, what it costs, what is wrong."""
    name = change.world if len(change.world) < 40 else f"{change.world[:36]}…"
    if change.message:
        return f"{name}: {change.message}"
    if change.before is None or change.after is None:
        return name
    beyond = ", beyond the tolerance" if change.beyond else ""
    return f"{name}: {_costs(change.before, change.after)}{beyond}"


def _costs(before: int, after: int) -> str:
    return f"{before:,} → {after:,} edge traversals ({_percentage(before, after)} %)"


def _upshot(entry: Compared) -> str:
    bad: list[str] = []
    if entry.wrong:
        bad.append(f"in {plural(entry.wrong, 'world')} a claim fails")
    if entry.beyond:
        bad.append(f"{plural(entry.beyond, 'world')} dearer by more than {entry.tolerance} %")
    if bad:
        return f"A regression: {', '.join(bad)}."
    rest = f"; {plural(entry.undecided, 'world')} not decided" if entry.undecided else ""
    return f"No regression in {entry.worlds - entry.undecided:,} of {entry.worlds:,} worlds{rest}."
