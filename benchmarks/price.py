"""The price of not knowing the map, and each rule's gap: means over 30 seeded worlds a family.

`least` is the least cost of a proof with the map in hand; every other column is a mean cost in edge
traversals. `gap` is the share of the false hypotheses that were walked although the history before
the walk had refuted them. Run it: `.venv/bin/python benchmarks/price.py`.
"""

from __future__ import annotations

from collections.abc import Callable
from statistics import mean

from topo_verify import World, explore, families
from topo_verify.harness.gap import gap

ALGORITHMS = ("basic", "enhancement-i", "enhancement-ii", "enhancement-iii-all+i", "folding")
SEEDS = range(30)

FAMILIES: dict[str, Callable[[int], World]] = {
    "lattice(10,10,holes=0.2)": lambda seed: families.lattice(10, 10, holes=0.2, seed=seed),
    "lattice(20,20,holes=0.2)": lambda seed: families.lattice(20, 20, holes=0.2, seed=seed),
    "regular(80,8,holes=0.2)": lambda seed: families.regular(80, 8, holes=0.2, seed=seed),
}


def main() -> None:
    """Print both tables, as Markdown."""
    gaps: dict[str, list[str]] = {}
    print(f"| family | m | least | {' | '.join(ALGORITHMS)} |")
    print("| --- |" + " ---: |" * (2 + len(ALGORITHMS)))
    for name, make in FAMILIES.items():
        worlds = [make(seed) for seed in SEEDS]
        row = [mean(len(world.edges) for world in worlds), mean(w.least_cost() for w in worlds)]
        gaps[name] = []
        for algorithm in ALGORITHMS:
            runs = [explore(world, algorithm) for world in worlds]
            row.append(mean(run.cost for run in runs))
            shares = [gap(run.trace).share for run in runs] if len(worlds[0].edges) < 200 else []
            gaps[name].append(f"{mean(shares):.1%}" if shares else "-")
        print(f"| `{name}` | {' | '.join(f'{figure:.0f}' for figure in row)} |", flush=True)
    print(f"\n| gap | {' | '.join(ALGORITHMS)} |")
    print("| --- |" + " ---: |" * len(ALGORITHMS))
    for name, shares_of in gaps.items():
        if "-" not in shares_of:
            print(f"| `{name}` | {' | '.join(shares_of)} |")


if __name__ == "__main__":
    main()
