"""The list of worlds that is proved and the enumeration that runs are one.

Coq proves of its own list (coq/Listed.v, coq/ListedOnce.v) that it holds every rooted map exactly
once, and of its ranks (coq/Ranks.v) that they are the places of that list. Both are extracted to
OCaml. Here they are compared with `world/enumeration/rank_order.py`, which numbers the worlds.

What this does not show: that the two agree on worlds with more than 6 edges which are not drawn.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from random import Random

import pytest

from tests.proofs.mechanised.conftest import LIMIT, extracted
from topo_verify import World
from topo_verify.proofs.mechanised import toolchain
from topo_verify.world.enumeration.rank_order import Table, count, tables, unrank


@pytest.fixture(scope="module")
def listing(library: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The extracted list."""
    return extracted(library, tmp_path_factory.mktemp("worlds"), "Worlds", "listing")


def answers(listing: Path, requests: Iterable[str]) -> list[str]:
    ran = toolchain.run([str(listing)], listing.parent, timeout=LIMIT, stdin="\n".join(requests))
    assert ran.accepted, ran.output
    return ran.output.splitlines()


def shown(table: Table) -> str:
    """A table as the program prints the world: the next dart of each dart, and its partner."""
    world = World.from_code(table)
    return " ".join(map(str, (*world.sigma, *world.alpha)))


def random_ranks(draws: int) -> Iterator[tuple[int, int]]:
    """From 7 to 30 edges in turn: the first ranks, the last ones, then drawn ones."""
    random = Random(29)
    for i in range(draws):
        edges = 7 + i % 24
        last = count(edges) - 1
        yield edges, (0, last)[i // 24] if i < 48 else random.randint(0, last)


def test_both_list_the_same_worlds_to_6_edges_in_the_same_order(listing: Path) -> None:
    rows = answers(listing, (f"list {edges}" for edges in range(1, 7)))
    assert len(rows) == 119_364
    assert rows == [shown(table) for edges in range(1, 7) for table in tables(edges)]


def test_both_give_the_same_world_to_a_rank_and_the_same_rank_to_a_world(listing: Path) -> None:
    drawn = list(random_ranks(1_000))
    rows = answers(listing, (f"at {edges} {rank:b}" for edges, rank in drawn))
    assert rows == [f"{shown(unrank(edges, rank))} {rank:b}" for edges, rank in drawn]


def test_a_world_at_another_place_is_seen(listing: Path) -> None:
    first, second, *others = answers(listing, ["list 3"])
    assert [second, first, *others] != [shown(table) for table in tables(3)]
    assert answers(listing, ["at 9 101"]) != [f"{shown(unrank(9, 6))} 101"]
