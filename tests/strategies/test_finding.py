"""What the strategies find within 100 examples, Hypothesis's default: all that they can have."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from tests.strategies import features
from tests.strategies.features import Condition
from topo_verify import World, strategies
from topo_verify.strategies.sample import drawing_no_literals

FEATURES: dict[str, Condition] = {
    "loop": features.has_loop,
    "parallel edges": features.has_parallel_edges,
    "bridge": features.has_bridge,
    "genus 0": lambda world: world.genus == 0,
    "genus 1": lambda world: world.genus == 1,
    "genus 2": lambda world: world.genus == 2,
    "equal signatures": features.has_equal_signatures,
    "closing at distance 3": features.closes_far_away,
}

STRATEGIES: dict[str, tuple[SearchStrategy[World], set[str]]] = {
    "worlds": (strategies.worlds(), set()),
    "planar_worlds": (strategies.planar_worlds(), {"genus 1", "genus 2"}),
    "nonplanar_worlds": (strategies.nonplanar_worlds(), {"genus 0"}),
    "tree_worlds": (
        strategies.tree_worlds(),
        set(FEATURES) - {"bridge", "genus 0", "equal signatures"},
    ),
    "dense_worlds": (strategies.dense_worlds(), set()),
    "lattices": (strategies.lattices(), {"loop", "parallel edges", "genus 1", "genus 2"}),
    "symmetric_worlds": (strategies.symmetric_worlds(), set()),
    "uniform_worlds": (strategies.uniform_worlds(edges=7), {"closing at distance 3"}),
}
"""Each strategy, and what its worlds cannot have.

Evenly drawn worlds have few vertices, all near the marker; and the more edges, the more handles.
"""


def found(strategy: SearchStrategy[World], *, examples: int) -> set[str]:
    """The features of the worlds among so many examples, the same ones every time."""
    seen: set[str] = set()

    @settings(max_examples=examples, derandomize=True, deadline=None)
    @given(strategy)
    def look(world: World) -> None:
        seen.update(name for name, has in FEATURES.items() if name not in seen and has(world))

    with drawing_no_literals():  # or what is found would depend on the modules that are loaded
        look()
    return seen


@pytest.mark.parametrize("name", STRATEGIES)
def test_a_hundred_examples_have_all_that_there_can_be(name: str) -> None:
    strategy, impossible = STRATEGIES[name]
    assert found(strategy, examples=100) == set(FEATURES) - impossible


TIGHT: dict[str, SearchStrategy[World]] = {
    "cubic of genus 2, as small as can be": strategies.worlds(
        min_genus=2, max_degree=3, max_edges=9
    ),
    "cubic of genus 3": strategies.nonplanar_worlds(genus=3, max_degree=3, max_edges=18),
    "simple of genus 1, as small as can be": strategies.worlds(
        simple=True, min_genus=1, max_edges=5
    ),
    "simple of genus 2": strategies.nonplanar_worlds(
        genus=2, simple=True, max_degree=4, max_edges=12
    ),
    "a leaf and genus 2": strategies.worlds(marker="leaf", min_genus=2, max_degree=4, max_edges=9),
    "dense, simple, nonplanar": strategies.dense_worlds(simple=True, min_genus=1, max_edges=10),
    "simple necklaces": strategies.symmetric_worlds(simple=True, marker="leaf", max_degree=4),
    "a lattice with 23 edges": strategies.lattices(min_edges=23, max_edges=23),
}


@pytest.mark.parametrize("name", [*STRATEGIES, *TIGHT])
def test_nine_of_ten_draws_are_kept(name: str) -> None:
    drawn = kept = 0
    strategy = TIGHT[name] if name in TIGHT else STRATEGIES[name][0]

    @st.composite
    def counted(draw: st.DrawFn) -> World:
        nonlocal drawn
        drawn += 1
        return draw(strategy)

    @settings(max_examples=200, derandomize=True, deadline=None)
    @given(counted())
    def look(world: World) -> None:
        nonlocal kept
        kept += bool(world.faces)

    look()
    assert kept >= 0.9 * drawn
