"""The speeds that the project promises, beside what is required: `make bench`.

Listing worlds; all small worlds through all algorithms, bare, with claims 1 to 8, and with ten
claims; drawing worlds; one large lattice. One core, processor time.
"""

from __future__ import annotations

import platform
from collections.abc import Callable, Iterator
from time import process_time
from unittest.mock import patch

import compiled
import drawing
import long_runs
import oracle
import search

from topo_verify import CATALOGUE, World, examine, families
from topo_verify.checkers import CLAIMS
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.world.enumeration import rank_order

EDGES = range(1, 6)

PAPER = [name for name in CATALOGUE if "folding" not in name]
"""The requirements are about these."""


def seconds(work: Callable[[], object]) -> float:
    start = process_time()
    work()
    return process_time() - start


def enumeration(edges: int) -> float:
    """Worlds a second, as bare tables, after the completions are tabulated."""
    for _ in rank_order.tables(edges - 1):
        pass
    took = seconds(lambda: sum(1 for _ in rank_order.tables(edges)))
    return rank_order.count(edges) / took


def small_worlds() -> Iterator[World]:
    for edges in EDGES:
        yield from map(World.from_code, rank_order.tables(edges))


def explore_all() -> None:
    for world in small_worlds():
        budget = world.cost_bound
        for name in PAPER:
            CATALOGUE[name](SimulatedRobot(world, budget))


def examine_all() -> None:
    for world in small_worlds():
        for name in PAPER:
            report = examine(name, world)
            assert report.ok, str(report)


def row(what: str, measured: str = "", required: str = "") -> None:
    print(f"{what:<58}{measured:>18}{required:>18}")


def main() -> None:
    print(f"{platform.python_implementation()} {platform.python_version()}, one core\n")
    row("", "measured", "required")
    row(
        f"worlds listed, {rank_order.count(6):,} with 6 edges",
        f"{enumeration(6):,.0f} /s",
        ">= 500,000 /s",
    )
    worlds = sum(map(rank_order.count, EDGES))
    label = f"{worlds:,} worlds with 1-5 edges x {len(PAPER)} algorithms"
    row(label, f"{seconds(explore_all):.1f} s")
    with patch.dict(CLAIMS, {name: CLAIMS[name] for name in tuple(CLAIMS)[:8]}, clear=True):
        row("  the same with traces and claims 1 to 8", f"{seconds(examine_all):.1f} s", "< 40 s")
    row("  the same with traces and all ten claims", f"{seconds(examine_all):.1f} s")

    print()
    drawing.table(row)

    print()
    search.table(row)

    print()
    compiled.table(lambda label, *rest: row(label[:57], *rest))

    print()
    oracle.table(row)

    print()
    long_runs.table(row)

    lattice = families.lattice(20, 20, holes=0.2, seed=7)
    vertices, edges = len(lattice.vertices), len(lattice.edges)
    print(f"\n{lattice.name}, {vertices} vertices, {edges} edges")
    for name, algorithm in CATALOGUE.items():
        robot = SimulatedRobot(lattice, lattice.cost_bound)
        took = seconds(lambda: algorithm(robot))  # noqa: B023  called at once
        row(f"  {name}, {robot.cost:,} edge traversals", f"{took:.2f} s", "< 2 s")


if __name__ == "__main__":
    main()
