"""The worlds that `verify` draws by strategies: each has its share, and smaller come first."""

from __future__ import annotations

from topo_verify.strategies.sample import WORLDS
from topo_verify.studies.corpus import STRATEGIES
from topo_verify.studies.verify.verify import generated_worlds


def test_every_strategy_has_its_share() -> None:
    assert [text.partition("(")[0] for text in STRATEGIES] == list(WORLDS)
    worlds = generated_worlds(5, 0)
    assert len(worlds) == 5 * len(STRATEGIES)
    assert sum(len(world.vertices) == len(world.edges) + 1 for world in worlds) >= 5  # the trees
    assert sum(world.genus > 0 for world in worlds) >= 5


def test_they_come_smallest_first_and_the_seed_decides_which() -> None:
    sizes = [len(world.edges) for world in generated_worlds(5, 3)]
    assert sizes == sorted(sizes)
    assert sizes[0] > 0
    assert generated_worlds(5, 3) != generated_worlds(5, 4)
