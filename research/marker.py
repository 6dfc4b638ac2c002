"""Where to put the marker: how much a good place saves, and whether a rule of thumb predicts it.

    .venv/bin/python -m research.marker        # a few minutes in two processes

In each world the marker lies at every dart, and every run is judged. Costs are shares of the mean
over all darts of the world; a row is the mean over a family, ± its standard error. A rule is judged
by the mean over the darts that fit it:

- `centre`: darts at vertices of least eccentricity, the greatest distance to any other vertex;
- `high degree`: darts at vertices of the greatest degree;
- `dead end`: darts at vertices of degree 1, which point out of the dead end.

`r` is the correlation (Spearman) of cost with eccentricity and with degree.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from math import sqrt
from statistics import mean, stdev
from typing import Any

import networkx as nx
import scipy.stats  # type: ignore[import-untyped]  # pyright: ignore[reportMissingTypeStubs]

from topo_verify import World, examine
from topo_verify.world.resolve import resolve_world

ALGORITHMS = ("basic", "folding")
SEEDS = range(10)

FAMILIES = (
    "lattice(6,6,holes=0.2,seed={})",
    "lattice(3,12,holes=0.1,seed={})",
    "king(4,5,holes=0.2,seed={})",
    "regular(16,5,holes=0.2,seed={})",
    "random_tree(30,seed={})",
    "random_planar(30,seed={})",
    "random_genus(30,2,seed={})",
)

spearman: Any = scipy.stats.spearmanr  # pyright: ignore[reportUnknownMemberType, reportUnknownVariableType]

RULES = ("centre", "high degree", "dead end")


def eccentricities(world: World) -> list[int]:
    graph = nx.Graph((world.vertex_of[a], world.vertex_of[b]) for a, b in world.edges)
    return [
        max(nx.single_source_shortest_path_length(graph, vertex).values())
        for vertex in range(len(world.vertices))
    ]


def costs(world: World, algorithm: str) -> list[int]:
    known: dict[object, int] = {}
    for dart in range(len(world.alpha)):
        there = world.with_marker(dart)
        if there.code not in known:
            report = examine(algorithm, there)
            assert report.ok, str(report)
            assert {*report.claims.values()} == {"ok"}, str(report)
            known[there.code] = report.cost
    return [known[world.with_marker(dart).code] for dart in range(len(world.alpha))]


def measured(family: str, algorithm: str, seed: int) -> dict[str, float | None]:
    """Shares of the mean cost, and correlations, in one world; None where no dart fits a rule."""
    world = resolve_world(f"family:{family.format(seed)}")
    cost_at = costs(world, algorithm)
    average, far = mean(cost_at), eccentricities(world)
    at = world.vertex_of
    degrees = world.degrees
    fits: dict[str, Callable[[int], bool]] = {
        "centre": lambda vertex: far[vertex] == min(far),
        "high degree": lambda vertex: degrees[vertex] == max(degrees),
        "dead end": lambda vertex: degrees[vertex] == 1,
    }
    shares: dict[str, float | None] = {
        "best": min(cost_at) / average,
        "worst": max(cost_at) / average,
    }
    for rule in RULES:
        fitting = [cost for dart, cost in enumerate(cost_at) if fits[rule](at[dart])]
        shares[rule] = mean(fitting) / average if fitting else None
    for name, values in (("r ecc.", far), ("r degree", degrees)):
        row = [values[vertex] for vertex in at]
        even = len(set(row)) == 1 or len(set(cost_at)) == 1
        shares[name] = None if even else float(spearman(row, cost_at).statistic)
    return shares


def cell(values: Sequence[float | None], *, share: bool) -> str:
    known = [value for value in values if value is not None]
    if len(known) < 2:
        return "-"
    error = stdev(known) / sqrt(len(known))
    if share:
        return f"{mean(known) * 100:.0f} ± {error * 100:.0f} %"
    return f"{mean(known):+.2f} ± {error:.2f}"


def rows() -> Iterator[tuple[str, ...]]:
    jobs = [(f, a, s) for f in FAMILIES for a in ALGORITHMS for s in SEEDS]
    with ProcessPoolExecutor() as pool:
        measurements = dict(zip(jobs, pool.map(measured, *zip(*jobs, strict=True)), strict=True))
    for family in FAMILIES:
        for algorithm in ALGORITHMS:
            shares = [measurements[family, algorithm, seed] for seed in SEEDS]
            name = family.replace(",seed={}", "")
            yield (
                f"`{name}`",
                algorithm,
                *(cell([s[key] for s in shares], share=True) for key in ("best", "worst", *RULES)),
                *(cell([s[key] for s in shares], share=False) for key in ("r ecc.", "r degree")),
            )


def main() -> None:
    ask = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    ask.parse_args()
    print("| family | algorithm | best | worst | centre | high degree | dead end |", end="")
    print(" r eccentricity | r degree |")
    print("| --- | --- |" + " ---: |" * 7)
    for row in rows():
        print(f"| {' | '.join(row)} |", flush=True)


if __name__ == "__main__":
    main()
