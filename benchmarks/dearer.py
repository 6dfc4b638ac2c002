"""In how many worlds a stronger algorithm costs more than a weaker one: every world up to N edges.

    python benchmarks/dearer.py 6

Only costs are compared, so nothing is judged here and it is ten times faster than
`topo-verify search --compare A,B`, which says the same of one pair and judges every run.
"""

from __future__ import annotations

import sys
from itertools import combinations

from topo_verify import CATALOGUE, World
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.world.enumeration import rank_order

NAMES = [name for name, algorithm in CATALOGUE.items() if algorithm.assumes is None]
"""From the weakest to the strongest."""


def costs(world: World) -> dict[str, int]:
    """What each algorithm costs in a world, in edge traversals."""
    found: dict[str, int] = {}
    for name in NAMES:
        robot = SimulatedRobot(world, world.cost_bound)
        CATALOGUE[name](robot)
        found[name] = robot.cost
    return found


def main(largest: int) -> None:
    """Print a row for each pair in which the stronger is dearer somewhere."""
    worlds: dict[tuple[str, str], list[tuple[str, int]]] = {}
    total = 0
    for edges in range(1, largest + 1):
        for rank, table in enumerate(rank_order.tables(edges)):
            cost = costs(World.from_code(table))
            total += 1
            for weaker, stronger in combinations(NAMES, 2):
                if cost[stronger] > cost[weaker]:
                    excess = cost[stronger] - cost[weaker]
                    worlds.setdefault((stronger, weaker), []).append((f"m{edges}/{rank}", excess))
    print(f"{total} worlds of 1 to {largest} edges\n")
    print("| A | costs more than B | in worlds | at most by | first |")
    print("| --- | --- | ---: | ---: | --- |")
    for (stronger, weaker), dear in worlds.items():
        most = max(excess for _, excess in dear)
        print(f"| {stronger} | {weaker} | {len(dear)} | {most} | {dear[0][0]} |")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
