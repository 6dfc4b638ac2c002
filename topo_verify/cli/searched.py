"""The results of `topo-verify search`: their fields, and how people see them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import msgspec

from topo_verify.checkers import Judgement
from topo_verify.cli.runs import unjudged
from topo_verify.harness.search.again import RunAgain
from topo_verify.harness.tally import CostComparison
from topo_verify.report.blocks import Block, Bullets, Command, Text, TextTable
from topo_verify.text import plural

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


class Lost(msgspec.Struct, frozen=True):
    """A world in which a worker was lost, and how; tried again, nothing went wrong there."""

    world: str
    how: str


class EveryCost(msgspec.Struct, frozen=True):
    """With --policies every: what any policy of pick and order can cost; docs/commands.md.

    Attributes:
        worlds: those in which no claim fails, whatever is chosen; the rest is about them.
        states, choices: the number of states with more than one way, and of their ways.
        cheapest, reference, dearest: sums of costs, in edge traversals: the least and the most
            that a run can cost in each world, and what the reference policies cost.
        most_saved: where the cheapest run saves the greatest share of the reference cost.
        judged_by: what judged the choices.
    """

    worlds: int
    states: int
    choices: int
    cheapest: int
    reference: int
    dearest: int
    most_saved: MostSaved | None
    judged_by: str


class MostSaved(msgspec.Struct, frozen=True):
    """A world, what the reference policies cost in it, and the least that a run costs."""

    world: str
    reference: int
    cheapest: int


class ByEdges(msgspec.Struct, frozen=True):
    """The worlds of one size; docs/commands.md.

    Attributes:
        checked, total, failing, undecided: numbers of worlds.
        runs: the number of runs in which no claim fails; the costs are theirs.
        max_cost, total_cost: their highest cost and the sum, in edge traversals.
        attained: the number of worlds with the highest cost.
        worst: the first of these worlds.
        compare: with --compare, where A costs more than B, and where less.
        every: with --policies every, the range of the costs.
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
    every: EveryCost | None


class SearchEntry(msgspec.Struct, frozen=True, rename={"kind": "class"}):
    """One search: an entry of `results`; docs/commands.md.

    Attributes:
        from_ledger: in how many of the checked worlds mappers ran before; in the others, now.
        lost: worlds in which a worker was lost that a stranger may have killed.
        run_again: what came of the worlds that were run again, alone and in a row.
        engine: what ran and judged; judged_by: the same in words.
        by_checkers: in how many worlds the checkers judged.
    """

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
    judgements: tuple[Judgement, ...]
    from_ledger: int
    lost: tuple[Lost, ...]
    run_again: RunAgain | None
    engine: str
    judged_by: str
    by_checkers: int


# ---------------------------------------------------------------- for people


def show(entry: SearchEntry, *, worst: bool) -> Iterator[Block]:
    """One search, for people: a table, the verdict, the counterexample."""
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
    yield from _every(entry, worst=worst)
    yield Text("")
    yield Text(f"{entry.verdict}: {_conclusion(entry)}")
    if entry.lost:
        yield Text(
            "A worker was lost, which a stranger may have killed; tried again, nothing failed:"
        )
        yield Bullets(tuple(f"{one.world}: {one.how}" for one in entry.lost[:SHOWN]))
    if entry.run_again is not None and entry.run_again.others:
        others = entry.run_again.others
        yield Text(
            "Run again, alone or in another order, it takes other doors in"
            f" {_some(others, len(others))}: it draws lots, or keeps something from world to world."
            " Seed it anew in each world, and the verdict can stand."
        )
    if entry.engine != "reference":
        yield Text(f"judged by {entry.judged_by}: {plural(entry.by_checkers, 'world')}")
    yield from _counterexamples(entry)
    if entry.verdict != "REFUTED":
        yield from unjudged(entry.target, "these worlds", entry.judgements)


def _every(entry: SearchEntry, *, worst: bool) -> Iterator[Block]:
    """The states and choices of --policies every; with --worst the range of the costs, too."""
    sizes = [(e.edges, e.every) for e in entry.by_edges if e.every is not None and e.every.worlds]
    if not sizes:
        return
    rows = [(str(m), str(e.states), str(e.choices), e.judged_by) for m, e in sizes]
    yield Text("")
    yield TextTable((">edges", ">states", ">choices", "judged by"), rows)
    if not worst:
        return
    costs = [
        (str(m), *map(str, (e.cheapest, e.reference, e.dearest)), *_saved(e)) for m, e in sizes
    ]
    yield Text("")
    columns = (">edges", ">cheapest", ">reference", ">dearest", ">saves", ">at most", "in")
    yield TextTable(columns, costs, "sums of costs: the least, of the reference, the most")
    low, reference = (sum(getattr(e, name) for _, e in sizes) for name in ("cheapest", "reference"))
    yield Text("")
    yield Text(
        f"No policy of pick and order saves more than {1 - low / reference:.1%} of what the"
        " reference policies cost in these worlds together."
    )


def _saved(entry: EveryCost) -> tuple[str, ...]:
    """The share that the cheapest runs save together, and where one saves most."""
    together = f"{1 - entry.cheapest / entry.reference:.1%}"
    one = entry.most_saved
    if one is None or one.reference == one.cheapest:
        return together, "-", "-"
    return together, f"{1 - one.cheapest / one.reference:.1%}", one.world


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
    worlds = f"{entry.checked} of {plural(entry.total, 'world')} checked"
    if entry.from_ledger:
        now = sum(size.checked + size.undecided for size in entry.by_edges) - entry.from_ledger
        worlds += f" ({entry.from_ledger} from the ledger, {now} now)"
    failing = sum(size.failing for size in entry.by_edges)
    undecided = sum(size.undecided for size in entry.by_edges)
    late = f"; {undecided} more not decided (out of time, or declined)" if undecided else ""
    if entry.verdict == "REFUTED":
        return f"{worlds}, a claim fails in {failing}{late}"
    if entry.verdict == "UNKNOWN":
        return f"{worlds}, no claim failed there{late}"
    return f"{worlds}, no claim failed{late}"


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
