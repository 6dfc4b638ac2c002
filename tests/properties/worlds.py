"""What the property tests run in: worlds of each strategy, m0/0 included, of a small size."""

from __future__ import annotations

from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from topo_verify import Exploration, World, explore, strategies
from topo_verify.strategies import mappers, observe

STRATEGIES: dict[str, SearchStrategy[World]] = {
    "worlds": strategies.worlds(min_edges=0, max_edges=16),
    "planar_worlds": strategies.planar_worlds(min_edges=0, max_edges=16),
    "nonplanar_worlds": strategies.nonplanar_worlds(max_edges=16),
    "tree_worlds": strategies.tree_worlds(min_edges=0, max_edges=20),
    "dense_worlds": strategies.dense_worlds(min_edges=0, max_edges=16),
    "lattices": strategies.lattices(min_edges=0, max_edges=24),
    "symmetric_worlds": strategies.symmetric_worlds(min_edges=0, max_edges=16),
    "uniform_worlds": strategies.uniform_worlds(edges=9),
}


@st.composite
def runs(draw: st.DrawFn, worlds: SearchStrategy[World]) -> Exploration:
    """A run of any algorithm that is right in all worlds, with any policies, in one of these."""
    run = explore(draw(worlds), draw(mappers()))
    observe(run)
    return run
