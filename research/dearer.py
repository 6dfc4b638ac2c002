"""In how many worlds a stronger algorithm costs more than a weaker one: every world up to N edges.

    python -m research.dearer 6                 # every pair of the catalogue, by the reference
    python -m research.dearer 8 --compiled      # the enhancements against what they enhance

Only costs are compared; `topo-verify search --compare A,B` also judges every run. `--compiled`
needs the extra `fast`; it stops if one of claims 1 to 8 fails.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from itertools import combinations

from topo_verify import CATALOGUE, World
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.world.enumeration import rank_order

NAMES = [name for name, algorithm in CATALOGUE.items() if algorithm.assumes is None]
"""From the weakest to the strongest."""

SHARD = 500_000

Pair = tuple[str, str]

Row = tuple[int, int, str]
"""In how many worlds the first costs more, by how much at most, and the first such world."""


def costs(world: World) -> dict[str, int]:
    cost_of: dict[str, int] = {}
    for name in NAMES:
        robot = SimulatedRobot(world, world.cost_bound)
        CATALOGUE[name](robot)
        cost_of[name] = robot.cost
    return cost_of


def by_reference(largest: int) -> Iterator[tuple[Pair, Row]]:
    rows: dict[Pair, Row] = {}
    for edges in range(1, largest + 1):
        for rank, table in enumerate(rank_order.tables(edges)):
            cost = costs(World.from_code(table))
            for weaker, stronger in combinations(NAMES, 2):
                if (excess := cost[stronger] - cost[weaker]) > 0:
                    number, most, first = rows.get((stronger, weaker), (0, 0, f"m{edges}/{rank}"))
                    rows[stronger, weaker] = number + 1, max(most, excess), first
    yield from rows.items()


def enhanced() -> Iterator[Pair]:
    """Each algorithm with `basic`, and each that walks on with the one that goes back."""
    names = [name for name in NAMES if name not in ("basic", "folding")]
    yield from ((name, "basic") for name in names)
    yield from ((name, name.removesuffix("+i")) for name in names if name.endswith("+i"))


def compared(task: tuple[Pair, int, int]) -> tuple[int, int, int]:
    """A pair in one range of ranks: worlds that cost more, the largest excess, the first rank."""
    from topo_verify.extra.fast.snapshots import examine_range

    pair, edges, start = task
    stop = min(start + SHARD, rank_order.count(edges))
    end = examine_range(pair, edges, "any", start, stop, claims=8)
    if end.tally.failing:
        raise SystemExit(f"a claim fails: {task}")
    first = min((world.rank for world in end.named[0].dearer), default=-1)
    return end.tally.pairs.dearer, end.tally.pairs.most, first


def by_engine(largest: int) -> Iterator[tuple[Pair, Row]]:
    sizes = range(1, largest + 1)
    shards = [(m, start) for m in sizes for start in range(0, rank_order.count(m), SHARD)]
    compared((("basic", "enhancement-i"), 1, 0))  # compiles the kernels once, for all processes
    with ProcessPoolExecutor() as pool:
        for pair in enhanced():
            results = pool.map(compared, [(pair, *shard) for shard in shards])
            rows = [(m, *row) for (m, _), row in zip(shards, results, strict=True) if row[0]]
            if rows:
                first = f"m{rows[0][0]}/{rows[0][3]}"
                yield pair, (sum(row[1] for row in rows), max(row[2] for row in rows), first)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("edges", type=int, nargs="?", default=5)
    parser.add_argument("--compiled", action="store_true", help="by the compiled engine")
    chosen = parser.parse_args()
    total = sum(rank_order.count(edges) for edges in range(1, chosen.edges + 1))
    print(f"{total} worlds of 1 to {chosen.edges} edges\n")
    print("| A | costs more than B | in worlds | at most by | first |")
    print("| --- | --- | ---: | ---: | --- |")
    rows = by_engine(chosen.edges) if chosen.compiled else by_reference(chosen.edges)
    for (stronger, weaker), (number, most, first) in rows:
        print(f"| {stronger} | {weaker} | {number} | {most} | {first} |", flush=True)


if __name__ == "__main__":
    main()
