"""The results of `topo-verify search`, as people see them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from topo_verify.cli.runs import unjudged
from topo_verify.report.blocks import Block, Bullets, Command, Text, TextTable
from topo_verify.studies.search.search import ByEdges, CostComparison, EveryCost, SearchEntry
from topo_verify.text import plural

SHOWN = 3
"""The number of worlds shown in one cell; JSON has more."""


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
            "A worker was lost, which another program may have killed, or lacked memory; tried"
            " again, nothing failed:"
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
    rows = [(str(m), str(e.states), str(e.choices), e.decided_by, e.judged_by) for m, e in sizes]
    yield Text("")
    yield TextTable((">edges", ">states", ">choices", "decided by", "judged by"), rows)
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
    if entry.verdict == "SAMPLED":
        models = [
            e for e in entry.by_edges if e.every is not None and e.every.decided_by == "model"
        ]
        sizes = " and ".join(str(e.edges) for e in models)
        return (
            f"{worlds}, no claim failed{late}; the worlds of {sizes} edges are decided by a model"
            " of the mapper, which itself made three runs in each"
        )
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
