"""The table of a suite as blocks, and everything as CSV.

What differs from run to run (time, memory) stands in columns of its own, which the files of a
folder leave out: they are the same, byte for byte, whenever the same runs are made again.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Mapping, Sequence
from io import StringIO

from topo_verify.harness.arena.interval import MeanInterval
from topo_verify.harness.arena.league import LeagueBehind, LeagueEntry
from topo_verify.harness.arena.rows import ArenaRun
from topo_verify.harness.arena.suites import Suite
from topo_verify.harness.judge import in_words
from topo_verify.report.blocks import Block, Bullets, Cell, Command, Text, TextTable
from topo_verify.text import plural

Memory = Callable[[LeagueEntry], float | None]
"""The mebibytes that a mapper took in its dearest world of a suite, if they are known."""


def suite_blocks(
    suite: Suite, entries: Sequence[LeagueEntry], seed: int, memory: Memory | None
) -> Iterator[Block]:
    """The table of a suite, the families in it, and what kept mappers from a place.

    Args:
        entries: of this suite.
        memory: for the columns of time and memory; None: without them.
    """
    ranked = [entry for entry in entries if entry.place is not None]
    if ranked:
        yield _league(suite, ranked, seed, memory)
        if len(suite.families) > 1:
            yield Text("")
            yield _families(ranked)
    else:
        yield Text(f"{suite.name}: no mapper has a place")
    late = [entry for entry in entries if entry.place is None and entry.counterexample is None]
    for entry in late:
        gone = entry.total - entry.worlds
        yield Text("")
        yield Text(
            f"{entry.mapper} has no place in {suite.name}: {plural(gone, 'world')} of {entry.total}"
            " not decided"
        )
        if entry.why:
            yield Bullets(entry.why)


def _league(
    suite: Suite, ranked: Sequence[LeagueEntry], seed: int, memory: Memory | None
) -> TextTable:
    varying = (">ms/move", ">MiB") if memory is not None else ()
    columns = (">#", "mapper", ">cost/LB", ">behind", ">free", *varying, "claims")
    drawn = "" if suite.exact else f", seed {seed}"
    title = f"{suite.name}: {suite.about}, {plural(ranked[0].total, 'world')}{drawn}"
    rows = [
        (
            str(entry.place),
            entry.mapper,
            _figure(entry.ratio),
            _figure(entry.behind, sign="+"),
            _free(entry),
            *(() if memory is None else _varying(entry, memory(entry))),
            claims_in_words(entry),
        )
        for entry in ranked
    ]
    return TextTable(columns, rows, title)


def _families(ranked: Sequence[LeagueEntry]) -> TextTable:
    """cost / LB of each mapper, a row a family."""
    rows = [
        (of_family[0].family, f"{of_family[0].edges:.0f}", *(_figure(f.ratio) for f in of_family))
        for of_family in zip(*(entry.families for entry in ranked), strict=True)
    ]
    return TextTable(("family", ">edges", *(f">{entry.mapper}" for entry in ranked)), rows)


def claims_in_words(entry: LeagueEntry) -> str:
    """How many claims hold, and how many of them were judged in part or not at all."""
    if {*entry.claims.values()} == {"ok"}:
        return f"{len(entry.claims)} hold"
    return in_words(entry.claims, "hold")


def _figure(found: MeanInterval | LeagueBehind | None, sign: str = "") -> str:
    """A mean and how far its interval reaches to each side; JSON has more digits."""
    if found is None:
        return "-"
    mean = f"{found.mean:{sign}.2f}"
    if found.high is None:
        return mean
    reach = found.high - found.mean
    return f"{mean} ± {reach:.2f}" if reach else f"{mean} exact"


def _free(entry: LeagueEntry) -> str:
    rejected = entry.rejected_free + entry.rejected_moving
    return f"{entry.rejected_free / rejected:.0%}" if rejected else "-"


def _varying(entry: LeagueEntry, memory: float | None) -> tuple[str, str]:
    """What differs from run to run: milliseconds a move, mebibytes."""
    time = "-" if entry.ms_per_move is None else f"{entry.ms_per_move:.3f}"
    return time, "-" if memory is None else f"{memory:.0f}"


def broken_blocks(entries: Sequence[LeagueEntry]) -> Iterator[Block]:
    """The mappers that broke a claim: no place, only the counterexample."""
    broken = {e.mapper: e.counterexample for e in entries if e.counterexample is not None}
    if broken:
        rows = [
            (mapper, Cell(found.claim, tone="failed"), found.world, found.suite)
            for mapper, found in broken.items()
        ]
        yield Text("")
        columns = ("mapper", "claim that fails", "world", "suite")
        yield TextTable(columns, rows, title="No place, for a claim fails")
    for mapper, found in broken.items():
        yield Text("")
        yield Text(f"{mapper} in {found.world}:")
        yield Bullets((f"{found.claim}: {found.message}",))
        if found.replay:
            yield Command(found.replay, "again: ")


# ---------------------------------------------------------------- CSV

TABLE = (
    *("place", "mapper", "suite", "family", "worlds", "edges", "least", "cost"),
    *("ratio", "low", "high", "behind", "behind_low", "behind_high"),
    *("rejected_free", "rejected_moving", "claims", "counterexample"),
)
"""The columns of `table_csv`."""


def table_csv(entries: Sequence[LeagueEntry]) -> str:
    """A row a mapper and suite, then a row a family of it, where there are several."""
    return _csv(TABLE, [row for entry in entries for row in _rows(entry)])


def _rows(entry: LeagueEntry) -> Iterator[Sequence[object]]:
    ratio, behind = entry.ratio, entry.behind
    found = entry.counterexample
    one = entry.families[0] if len(entry.families) == 1 else None
    yield (
        *(entry.place, entry.mapper, entry.suite, one.family if one else "", entry.worlds),
        *((one.edges, one.least, one.cost) if one else (None, None, None)),
        *((ratio.mean, ratio.low, ratio.high) if ratio else (None, None, None)),
        *((behind.mean, behind.low, behind.high) if behind else (None, None, None)),
        *(entry.rejected_free, entry.rejected_moving, claims_in_words(entry)),
        f"{found.claim} in {found.world}" if found else None,
    )
    for family in entry.families if one is None else ():
        mean = family.ratio
        yield (
            *(None, entry.mapper, entry.suite, family.family, family.worlds),
            *(family.edges, family.least, family.cost, mean.mean, mean.low, mean.high),
            *(None,) * (len(TABLE) - 11),
        )


RUNS = (
    *("mapper", "suite", "world", "edges", "least", "cost", "ratio"),
    *("rejected_free", "rejected_moving"),
)
"""The columns of `runs_csv`."""


def runs_csv(runs: Mapping[tuple[str, str], Sequence[ArenaRun]]) -> str:
    """A row a run, by mapper and suite."""
    return _csv(
        RUNS,
        [
            (
                *(mapper, suite, run.world, run.edges, run.least, run.cost, round(run.ratio, 6)),
                *(run.rejected_free, run.rejected_moving),
            )
            for (mapper, suite), made in runs.items()
            for run in made
        ],
    )


def _csv(columns: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    out = StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(rows)
    return out.getvalue()
