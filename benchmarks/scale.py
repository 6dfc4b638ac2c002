"""What a large search takes: the table of docs/extra/fast.md.

    .venv/bin/python benchmarks/scale.py [--worlds N]

A slice of N worlds from the middle of each size is examined by the compiled engine with 8, 9 and 10
claims, and searched as `search --engine compiled` does it. Processor time of one process.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from time import process_time

from topo_verify.campaign.campaign import Shard
from topo_verify.campaign.targets import targets
from topo_verify.extra.fast.shard import examine_compiled, warm
from topo_verify.extra.fast.snapshots import examine_range
from topo_verify.studies.search.search import search_campaign
from topo_verify.world.enumeration import rank_order

ALGORITHMS = ("basic", "enhancement-iii-all+i", "folding")
CORES = (2, 64, 1000)


def taken(do: Callable[[], object]) -> float:
    begin = process_time()
    do()
    return process_time() - begin


def duration(seconds: float) -> str:
    for unit, size in (("days", 86400), ("h", 3600), ("min", 60)):
        if seconds >= 2 * size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds:.0f} s"


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--worlds", type=int, default=50_000)
    worlds = parser.parse_args().worlds
    print("| algorithm | m | claims 1-8 | 1-9 | all ten | and the checkers |")
    print("| --- | ---: | ---: | ---: | ---: | ---: |")
    whole: dict[tuple[str, int], float] = {}
    for algorithm in ALGORITHMS:
        mappers = targets(algorithm)
        campaign = search_campaign(mappers, edges=9, engine="compiled")
        warm(campaign)
        for edges in (7, 8, 9):
            start = rank_order.count(edges) // 2
            row = [
                taken(
                    lambda c=c, m=edges, a=algorithm, s=start: examine_range(
                        [a], m, "any", s, s + worlds, claims=c
                    )
                )
                for c in (8, 9, 10)
            ]
            shard = Shard(edges, start, start + worlds)
            row.append(
                taken(
                    lambda c=campaign, m=mappers, s=shard: examine_compiled(c, m, s, lambda _: None)
                )
            )
            whole[algorithm, edges] = row[-1] / worlds
            cells = " | ".join(f"{1e6 * seconds / worlds:.2f}" for seconds in row)
            print(f"| {algorithm} | {edges} | {cells} |", flush=True)
    print(f"\n| algorithm | m | worlds | {' | '.join(f'{n} cores' for n in CORES)} |")
    print("| --- | ---: | ---: | ---: | ---: | ---: |")
    for algorithm in ALGORITHMS:
        for edges in (8, 9, 10):
            # One size more costs as much more for each world as the last one did.
            grown = whole[algorithm, 9] ** 2 / whole[algorithm, 8]
            seconds = whole.get((algorithm, edges), grown) * rank_order.count(edges)
            cells = " | ".join(duration(seconds / cores) for cores in CORES)
            print(f"| {algorithm} | {edges} | {rank_order.count(edges):,} | {cells} |")


if __name__ == "__main__":
    main()
