"""`topo-verify search`: find the smallest counterexample among all worlds of up to N edges."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import nullcontext
from dataclasses import dataclass

import click
import msgspec

from topo_verify.cli import options
from topo_verify.cli.failures import version
from topo_verify.cli.layout import Block, Bullets, Command, Text, TextTable
from topo_verify.cli.output import Output, Result
from topo_verify.cli.output import options as output_options
from topo_verify.cli.runs import undeclared
from topo_verify.errors import InputError
from topo_verify.harness.ledger import Ledger
from topo_verify.harness.pool import processors
from topo_verify.harness.search.exhaustive import Search, SearchResult, Size
from topo_verify.harness.search.plan import CHOICES, Choices, Plan
from topo_verify.harness.tally import CostComparison, CostTotals, Failure
from topo_verify.harness.targets import target_text, targets
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.text import plural
from topo_verify.world.enumeration.classes import WorldClass

SHOWN = 3
"""The number of worlds shown in one cell; JSON has more."""


class Counterexample(msgspec.Struct, frozen=True):
    """A world in which a claim fails, and the command that shows it again."""

    world: str
    edges: int
    claim: str
    message: str
    replay: str


class FailingClaim(msgspec.Struct, frozen=True):
    """The number of checked worlds in which a claim fails, and the smallest of them."""

    claim: str
    failing: int
    smallest: Counterexample


class ByEdges(msgspec.Struct, frozen=True):
    """The worlds of one size; docs/commands.md.

    Attributes:
        checked, total, failing, undecided: numbers of worlds.
        runs: the number of runs in which no claim fails; the costs are theirs.
        max_cost, total_cost: their highest cost and the sum, in edge traversals.
        attained: the number of worlds with the highest cost.
        worst: the first of these worlds.
        compare: with --compare, where A costs more than B, and where less.
    """

    edges: int
    checked: int
    total: int
    failing: int
    undecided: int
    runs: int
    max_cost: int
    total_cost: int
    attained: int
    worst: tuple[str, ...]
    compare: CostComparison | None


class SearchEntry(msgspec.Struct, frozen=True, rename={"kind": "class"}):
    """One search: an entry of `results`; docs/commands.md."""

    target: str
    kind: str
    edges: int
    policies: str
    checked: int
    total: int
    verdict: str
    counterexample: Counterexample | None
    by_edges: tuple[ByEdges, ...]
    claims: tuple[FailingClaim, ...]
    not_declared: tuple[str, ...]


@dataclass(frozen=True)
class _SearchOptions:
    """The options of one call."""

    edges: int
    kind: WorldClass
    workers: int
    ledger: str | None
    keep_going: bool
    policies: Choices
    worst: bool
    compare: bool
    limits: Limits


@click.command(
    short_help="Find the smallest counterexample among all worlds of up to N edges.",
    epilog=options.epilog(
        "search basic --edges 5",
        "search my_mapper.py:explore --class planar --keep-going",
        "search enhancement-i --edges 6 --ledger FILE --worst",
        "search --compare enhancement-ii,enhancement-i --edges 5",
    ),
)
@options.target
@options.program
@click.option(
    "--edges",
    type=click.IntRange(min=1),
    default=5,
    show_default=True,
    metavar="N",
    help="Worlds of 1 to N edges.",
)
@options.world_class
@click.option(
    "--workers",
    type=click.IntRange(min=0),
    metavar="N",
    help="Number of worker processes; 0: only this one.  [default: one per processor]",
)
@click.option("--ledger", metavar="FILE", help="Keep finished work in FILE and resume from it.")
@click.option("--keep-going", is_flag=True, help="Do not stop at the first counterexample.")
@click.option(
    "--policies",
    type=click.Choice(CHOICES),
    default="reference",
    show_default=True,
    help="Use the reference policies, all named ones, or every possible choice.",
)
@click.option("--worst", is_flag=True, help="Show the highest costs and the worlds that have them.")
@click.option("--compare", metavar="A,B", help="Show where A costs more than B.")
@options.limits
@output_options
def search(  # noqa: PLR0913  an argument an option
    output: Output,
    *,
    target: str | None,
    command: str | None,
    edges: int,
    kind: str,
    workers: int | None,
    ledger: str | None,
    keep_going: bool,
    policies: Choices,
    worst: bool,
    compare: str | None,
    limits: Limits,
) -> int:
    """Examine a mapper in every world of 1 to N edges, smallest first.

    The search stops at the smallest counterexample (REFUTED) or after the last world (EXHAUSTED).
    TARGET is a name of the catalogue, several with commas, all, module:attribute or
    file.py:attribute.
    """

    def searches() -> Iterator[Result[SearchEntry]]:
        asked = _SearchOptions(
            edges=edges,
            kind=WorldClass.parse(kind),
            workers=processors() if workers is None else workers,
            ledger=ledger,
            keep_going=keep_going,
            policies=policies,
            worst=worst,
            compare=compare is not None,
            limits=limits,
        )
        for mappers in _mappers(target, command, compare, ledger):
            yield from _searched(output, mappers, asked)

    def show(entries: Sequence[SearchEntry]) -> Iterator[Block]:
        for entry in entries:
            yield from _show(entry, worst=worst)

    return output.run("search", searches, show)


def _mappers(
    target: str | None, command: str | None, compare: str | None, ledger: str | None
) -> list[tuple[Target, ...]]:
    """The mappers of each search: one, or the two that are compared."""
    if (target is None and command is None) == (compare is None):
        raise InputError("expected either a TARGET or two mappers with --compare A,B")
    if compare is not None:
        pair = targets(compare)
        if len(pair) != 2 or pair[0] == pair[1]:
            raise InputError(
                f"--compare {compare}: expected two different algorithms of the catalogue, as A,B"
            )
        return [pair]
    text = target_text(target, command)
    found: list[tuple[Target, ...]] = [(mapper,) for mapper in targets(text)]
    if ledger is not None and len(found) != 1:
        raise InputError(
            f"--ledger {ledger}: expected one TARGET, got {len(found)}; search them one by one"
        )
    return found


def _searched(
    output: Output, mappers: tuple[Target, ...], asked: _SearchOptions
) -> Iterator[Result[SearchEntry]]:
    """The result of one search; after Ctrl-C, of the worlds done so far."""
    plan = Plan(
        targets=tuple(mapper.text for mapper in mappers),
        edges=asked.edges,
        kind=str(asked.kind),
        choices=asked.policies,
        keep_going=asked.keep_going,
        limits=asked.limits,
    )
    opened = None if asked.ledger is None else Ledger(asked.ledger, plan, mappers, version())
    with opened or nullcontext():
        work = Search(plan, mappers, workers=asked.workers, ledger=opened)
        try:
            work.work(output.progress)
        except KeyboardInterrupt:
            # Yield before raising: `Output` prints what it has and then exits 3.
            yield _result(work.found(), asked)
            raise
        yield _result(work.found(), asked)


def _result(found: SearchResult, asked: _SearchOptions) -> Result[SearchEntry]:
    first = found.counterexample
    tally = found.tally
    # A claim that some runs were judged on is not listed, even if others declared nothing.
    silent = (
        c for c, seen in tally.statuses.items() if not seen.keys() & {"ok", "failed"} and seen
    )
    entry = SearchEntry(
        target=",".join(found.plan.targets),
        kind=found.plan.kind,
        edges=found.plan.edges,
        policies=found.plan.choices,
        checked=found.checked,
        total=found.total,
        verdict=found.verdict,
        counterexample=None if first is None else _counterexample(first),
        by_edges=tuple(_by_edges(size, found.plan, asked) for size in found.by_edges),
        claims=tuple(
            FailingClaim(claim, failing.worlds, _counterexample(failing.smallest))
            for claim, failing in found.claims.items()
        ),
        not_declared=tuple(silent),
    )
    return Result(entry, failed=found.verdict == "REFUTED", incomplete=found.verdict == "UNKNOWN")


def _counterexample(failure: Failure) -> Counterexample:
    return Counterexample(
        failure.world, failure.edges, failure.claim, failure.message, failure.replay
    )


def _by_edges(size: Size, plan: Plan, asked: _SearchOptions) -> ByEdges:
    costs = size.tally.costs.get(plan.targets[0], CostTotals())
    return ByEdges(
        edges=size.edges,
        checked=size.checked,
        total=size.total,
        failing=size.failing,
        undecided=size.tally.undecided,
        runs=costs.runs,
        max_cost=costs.most,
        total_cost=costs.total,
        attained=costs.attained,
        worst=costs.worst,
        compare=size.tally.compared if asked.compare else None,
    )


# ---------------------------------------------------------------- for people


def _show(entry: SearchEntry, *, worst: bool) -> Iterator[Block]:
    kind = "" if entry.kind == "any" else f", class {entry.kind}"
    policies = "" if entry.policies == "reference" else f", policies {entry.policies}"
    title = f"{_who(entry)}: worlds of 1 to {plural(entry.edges, 'edge')}{kind}{policies}"
    rows = [
        (str(e.edges), str(e.checked), str(e.total), str(e.failing), *(_costs(e) if worst else ()))
        for e in entry.by_edges
    ]
    costs = (">max cost", ">mean", ">in worlds", "which") if worst else ()
    yield TextTable((">edges", ">checked", ">total", ">failing", *costs), rows, title)
    pairs = [_compared(e.edges, e.compare) for e in entry.by_edges if e.compare is not None]
    if pairs:
        yield Text("")
        yield TextTable(
            (">edges", ">A dearer", ">at most by", ">B dearer", "A dearer, first"), pairs
        )
    yield Text("")
    yield Text(f"{entry.verdict}: {_conclusion(entry)}")
    yield from _counterexamples(entry)
    if entry.not_declared and entry.verdict != "REFUTED":
        yield Text(undeclared(entry.target, entry.not_declared))


def _who(entry: SearchEntry) -> str:
    if all(e.compare is None for e in entry.by_edges):
        return entry.target
    first, _, second = entry.target.partition(",")
    return f"A {first}, B {second}"


def _costs(entry: ByEdges) -> tuple[str, ...]:
    mean = f"{entry.total_cost / entry.runs:.2f}" if entry.runs else "-"
    worst = _some(entry.worst, entry.attained)
    return str(entry.max_cost), mean, str(entry.attained), worst


def _compared(edges: int, pair: CostComparison) -> tuple[str, ...]:
    first = [f"{world.world} ({world.cost}, {world.other})" for world in pair.first]
    row = map(str, (edges, pair.dearer, pair.most, pair.cheaper))
    return (*row, _some(first, pair.dearer))


def _some(names: Sequence[str], number: int) -> str:
    """The first names; an ellipsis if there are more."""
    shown = ", ".join(names[:SHOWN])
    return f"{shown} …" if number > SHOWN else shown or "-"


def _conclusion(entry: SearchEntry) -> str:
    worlds = f"{entry.checked} of {plural(entry.total, 'world')}"
    failing = sum(size.failing for size in entry.by_edges)
    undecided = sum(size.undecided for size in entry.by_edges)
    late = f"; in {plural(undecided, 'more', 'more')} a run was out of time" if undecided else ""
    if entry.verdict == "REFUTED":
        return f"{worlds} checked, a claim fails in {failing}{late}"
    if entry.verdict == "UNKNOWN":
        return f"{worlds} checked, no claim failed there{late}"
    return f"{worlds} checked, no claim failed{late}"


def _counterexamples(entry: SearchEntry) -> Iterator[Block]:
    """The smallest counterexample, and the smallest for each claim."""
    first = entry.counterexample
    if first is None:
        return
    yield Text(f"smallest counterexample: {first.world}")
    yield Bullets((f"{first.claim}: {first.message}",))
    yield Command(first.replay, "again: ")
    if sum(size.failing for size in entry.by_edges) > 1:
        rows = [(c.claim, str(c.failing), c.smallest.world) for c in entry.claims]
        yield Text("")
        yield TextTable(("claim that fails", ">in worlds", "smallest"), rows)
