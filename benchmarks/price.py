"""The price of not knowing the map: mean costs over seeded worlds, as a ratio to the least cost.

`least` is the least cost of a proof with the map in hand. Each other column is the mean cost of one
mapper divided by the mean least cost, with the standard error of that mean; every run delivered the
right map, or the script stops. Run it:

    .venv/bin/python benchmarks/price.py
    .venv/bin/python benchmarks/price.py --mappers homing,planner --families torus --seeds 5 --ms
    .venv/bin/python benchmarks/price.py --gap
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from math import sqrt
from statistics import mean, stdev

from topo_verify import World, explore, families
from topo_verify.harness.gap import gap
from topo_verify.harness.run import Exploration

MAPPERS = "basic,enhancement-iii-all+i,folding,homing,planner"

FAMILIES: dict[str, Callable[[int], World]] = {
    "lattice(10,10,holes=0.2)": lambda seed: families.lattice(10, 10, holes=0.2, seed=seed),
    "lattice(20,20,holes=0.2)": lambda seed: families.lattice(20, 20, holes=0.2, seed=seed),
    "king(10,10)": lambda seed: families.king(10, 10, seed=seed),
    "king(10,10,holes=0.2)": lambda seed: families.king(10, 10, holes=0.2, seed=seed),
    "king_torus(10,10)": lambda seed: families.king_torus(10, 10, seed=seed),
    "king_torus(10,10,holes=0.2)": lambda seed: families.king_torus(10, 10, holes=0.2, seed=seed),
    "torus(10,10)": lambda _: families.torus(10, 10),
    "regular(80,8,holes=0.2)": lambda seed: families.regular(80, 8, holes=0.2, seed=seed),
}

Job = tuple[str, int, str]
"""Family, seed, mapper."""


def priced(job: Job) -> tuple[int, int, float, int]:
    """The cost of a run, the least cost of its world, seconds of the processor, and m.

    Raises:
        SystemExit: the map that was delivered is not that of the world.
    """
    family, seed, mapper = job
    world = FAMILIES[family](seed)
    began = time.process_time()
    run = explore(world, mapper)
    seconds = time.process_time() - began
    require_right(run, job)
    return run.cost, world.least_cost(), seconds, len(world.edges)


def require_right(run: Exploration, job: Job) -> None:
    """Stop unless the delivered map is the world."""
    found = run.map
    right = found is not None and run.world.is_isomorphic(
        World.from_rotations(found.vertices, found.edges, found.marker)
    )
    if not right:
        raise SystemExit(f"{job}: the map is not that of the world")


def cell(costs: Sequence[int], least: Sequence[int]) -> str:
    """The mean cost as a ratio to the mean least cost, with its standard error."""
    scale = mean(least)
    ratios = [cost / scale for cost in costs]
    error = stdev(ratios) / sqrt(len(ratios)) if len(ratios) > 1 else 0
    return f"{mean(ratios):.3f} ± {error:.3f}"


def gaps(seeds: int) -> None:
    """Print which share of the false hypotheses was walked although the history refuted them."""
    names = ("basic", "enhancement-i", "enhancement-ii", "enhancement-iii-all+i", "folding")
    family = "lattice(10,10,holes=0.2)"
    worlds = [FAMILIES[family](seed) for seed in range(seeds)]
    shares = [mean(gap(explore(world, name).trace).share for world in worlds) for name in names]
    print(f"| gap | {' | '.join(names)} |")
    print("| --- |" + " ---: |" * len(names))
    print(f"| `{family}` | {' | '.join(f'{share:.1%}' for share in shares)} |")


def main() -> None:
    """Print the table, as Markdown."""
    ask = argparse.ArgumentParser(description="mean cost / least cost, mappers x families")
    ask.add_argument("--mappers", default=MAPPERS, help="names, with commas")
    ask.add_argument("--families", default="", help="only those whose text begins so, with commas")
    ask.add_argument("--seeds", type=int, default=30, help="0 … N-1 (torus: one world)")
    ask.add_argument("--workers", type=int, default=2, help="processes")
    ask.add_argument("--ms", action="store_true", help="also milliseconds a move")
    ask.add_argument("--costs", action="store_true", help="mean costs, no ratios; also m")
    ask.add_argument("--gap", action="store_true", help="instead: the gap of the paper's rules")
    asked = ask.parse_args()
    if asked.gap:
        gaps(asked.seeds)
        return
    mappers = asked.mappers.split(",")
    print(f"| family | worlds | {'m | ' * asked.costs}least | {' | '.join(mappers)} |")
    print("| --- |" + " ---: |" * (2 + asked.costs + len(mappers)))
    with ProcessPoolExecutor(asked.workers) as pool:
        for family in FAMILIES:
            if not family.startswith(tuple(asked.families.split(","))):
                continue
            seeds = range(1 if family.startswith("torus") else asked.seeds)
            jobs = [(family, seed, mapper) for mapper in mappers for seed in seeds]
            found = list(pool.map(priced, jobs))
            cells: list[str] = []
            for start in range(0, len(found), len(seeds)):
                runs = found[start : start + len(seeds)]
                costs, least, seconds, _ = zip(*runs, strict=True)
                speed = f", {1000 * sum(seconds) / sum(costs):.1f} ms" if asked.ms else ""
                shown = f"{mean(costs):.0f}" if asked.costs else cell(costs, least)
                cells.append(shown + speed)
            shown = f"{mean(least for _, least, _, _ in found):.0f}"
            if asked.costs:
                shown = f"{mean(m for _, _, _, m in found):.0f} | {shown}"
            print(f"| `{family}` | {len(seeds)} | {shown} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
