"""The speeds that the project promises, measured here and now: `make bench`.

Three things on one core, each beside what is required of it: listing worlds, all small worlds
through all algorithms with and without traces and checkers, and one large lattice.
"""

from __future__ import annotations

import platform
from collections.abc import Callable, Iterator
from time import perf_counter

from topo_verify import CATALOGUE, World, examine, families
from topo_verify.checkers import cost_bound
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.world import counting

EDGES = range(1, 6)


def seconds(work: Callable[[], object]) -> float:
    """How long some work takes."""
    start = perf_counter()
    work()
    return perf_counter() - start


def enumeration(edges: int) -> float:
    """Worlds a second, as bare tables; the completions that are tabulated once are made before."""
    for _ in counting.tables(edges - 1):
        pass
    took = seconds(lambda: sum(1 for _ in counting.tables(edges)))
    return counting.count(edges) / took


def small_worlds() -> Iterator[World]:
    """Every world with 1-5 edges."""
    for edges in EDGES:
        yield from map(World.from_code, counting.tables(edges))


def explore_all() -> None:
    """All of them through every algorithm, and nothing else."""
    for world in small_worlds():
        budget = cost_bound(world)
        for algorithm in CATALOGUE.values():
            algorithm(SimulatedRobot(world, budget))


def examine_all() -> None:
    """All of them through every algorithm, with traces, limits, and every checker."""
    for world in small_worlds():
        for name in CATALOGUE:
            report = examine(name, world)
            assert report.ok, str(report)


def row(what: str, measured: str, required: str = "") -> None:
    """One line of the table."""
    print(f"{what:<58}{measured:>18}{required:>18}")


def main() -> None:
    """Measure and print."""
    print(f"{platform.python_implementation()} {platform.python_version()}, one core\n")
    row("", "measured", "required")
    row(
        f"worlds listed, {counting.count(6):,} with 6 edges",
        f"{enumeration(6):,.0f} /s",
        ">= 500,000 /s",
    )
    worlds = sum(map(counting.count, EDGES))
    what = f"{worlds:,} worlds with 1-5 edges x {len(CATALOGUE)} algorithms"
    row(what, f"{seconds(explore_all):.1f} s")
    row("  the same with traces and all checkers", f"{seconds(examine_all):.1f} s", "< 40 s")

    lattice = families.lattice(20, 20, holes=0.2, seed=7)
    vertices, edges = len(lattice.vertices), len(lattice.edges)
    print(f"\n{lattice.name}, {vertices} vertices, {edges} edges")
    for name, algorithm in CATALOGUE.items():
        robot = SimulatedRobot(lattice, cost_bound(lattice))
        took = seconds(lambda: algorithm(robot))  # noqa: B023  called at once
        row(f"  {name}, {robot.cost:,} edge traversals", f"{took:.2f} s", "< 2 s")


if __name__ == "__main__":
    main()
