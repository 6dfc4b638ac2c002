"""How fast the strategies draw worlds of 30 edges, beside graphs from hypothesis-networkx.

Both draw in one process, so the ratio holds elsewhere. hypothesis-networkx draws connected graphs
of 25 vertices and 30 edges, without embedding. Shrinking is not timed.
"""

from __future__ import annotations

from collections.abc import Callable
from time import process_time
from typing import Any

import networkx as nx
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis.strategies import SearchStrategy, integers
from hypothesis_networkx import graph_builder

from topo_verify import strategies

DRAWS = 1000

EDGES = {"min_edges": 30, "max_edges": 30}

WORLDS: dict[str, SearchStrategy[Any]] = {
    "worlds": strategies.worlds(**EDGES),
    "planar_worlds": strategies.planar_worlds(**EDGES),
    "nonplanar_worlds": strategies.nonplanar_worlds(**EDGES),
    "tree_worlds": strategies.tree_worlds(**EDGES),
    "lattices": strategies.lattices(**EDGES),
    "dense_worlds": strategies.dense_worlds(**EDGES),
    "symmetric_worlds": strategies.symmetric_worlds(**EDGES),
    "uniform_worlds": strategies.uniform_worlds(edges=30),
    "worlds, simple": strategies.worlds(**EDGES, simple=True),
}

GRAPHS = graph_builder(graph_type=nx.Graph, min_nodes=25, max_nodes=25, min_edges=30, max_edges=30)


def draws(strategy: SearchStrategy[Any]) -> float:
    """Draws a second."""
    drawn = 0

    @settings(
        max_examples=DRAWS,
        phases=[Phase.generate],
        database=None,
        deadline=None,
        derandomize=True,
        suppress_health_check=[HealthCheck.too_slow],
    )
    @given(strategy)
    def draw(_: object) -> None:
        nonlocal drawn
        drawn += 1

    start = process_time()
    draw()
    return drawn / (process_time() - start)


def table(row: Callable[[str, str, str], None]) -> None:
    row("worlds of 30 edges, as Hypothesis draws them", "", "")
    beside = draws(GRAPHS)
    for name, strategy in WORLDS.items():
        rate = draws(strategy)
        row(f"  {name} ({rate / beside:.0f} times)", f"{rate:,.0f} /s", ">= 500 /s")
    row("  hypothesis-networkx (once)", f"{beside:,.0f} /s", "")
    row("  one integer: Hypothesis alone", f"{draws(integers()):,.0f} /s", "")
