"""Worlds listed by the kernel: the same worlds and ranks, in the same order, as the reference's."""

from __future__ import annotations

from random import Random

import pytest

pytest.importorskip("numba", reason="the compiled engine needs numba")

import numpy as np

from tests.extra.fast.kernels.plain import plain
from tests.world.enumeration.test_pruned import CLASSES as REFERENCE
from topo_verify.errors import InputError
from topo_verify.extra.fast.kernels import pruning
from topo_verify.extra.fast.kernels.enumeration import (
    count_worlds,
    list_worlds,
    prepare,
    ranked_tables,
)
from topo_verify.extra.fast.kernels.kernel import compiled
from topo_verify.extra.fast.kernels.workspace import SMALL, WORLD_DARTS
from topo_verify.world.enumeration import pruned, rank_order
from topo_verify.world.enumeration.classes import WorldClass

CLASSES = (*REFERENCE, "genus:9", "genus<=9", "genus<=1,simple,max-degree:5")


def counted(kind: str, edges: int) -> int:
    space = np.zeros(SMALL.at("SIZE"), np.int64)
    return int(compiled(count_worlds, SMALL)(space, prepare(edges, WorldClass.parse(kind))))


@pytest.mark.parametrize("text", CLASSES)
@pytest.mark.parametrize("edges", range(1, 6))
def test_every_world_and_rank_is_the_reference_s(text: str, edges: int) -> None:
    kind = WorldClass.parse(text)
    assert list(ranked_tables(edges, kind)) == list(pruned.ranked_tables(edges, kind))


@pytest.mark.parametrize("text", CLASSES)
@pytest.mark.parametrize("edges", [4, 8, 9, 10])
def test_a_shard_anywhere_is_that_of_the_reference(text: str, edges: int) -> None:
    kind, random = WorldClass.parse(text), Random(f"{text} {edges}")
    for _ in range(4):
        start = random.randrange(rank_order.count(edges))
        stop = start + random.randrange(300)
        listed = list(ranked_tables(edges, kind, start, stop))
        assert listed == list(pruned.ranked_tables(edges, kind, start, stop))


@pytest.mark.parametrize("edges", [1, 3, 8])
def test_a_range_that_ends_beyond_the_last_world_ends_with_it(edges: int) -> None:
    total = rank_order.count(edges)
    last = list(ranked_tables(edges, None, total - 2, total + 5))
    assert last == list(pruned.ranked_tables(edges, None, max(0, total - 2), total))
    assert not list(ranked_tables(edges, None, total, total + 5))
    assert not list(ranked_tables(edges, WorldClass.parse("planar"), total, total + 5))
    assert not list(ranked_tables(edges, None, 1, 1))


@pytest.mark.parametrize(
    ("text", "edges"),
    [
        *(("any", 7), ("planar", 8), ("genus:1", 7), ("genus:3", 7), ("genus<=1", 7)),
        pytest.param("genus:2", 8, marks=pytest.mark.long),
        *(("simple", 10), ("loopless", 8), ("max-degree:4", 8)),
        ("simple,max-degree:3", 10),
    ],
)
def test_there_are_as_many_as_the_reference_counts(text: str, edges: int) -> None:
    assert counted(text, edges) == WorldClass.parse(text).count(edges)


def test_the_simple_worlds_with_ten_edges_are_as_many_as_is_known() -> None:
    assert counted("simple", 10) == 1_980_911


def first_rows(kind: str, edges: int, most: int = 400) -> list[list[int]]:
    """The first worlds, listed by the kernel as plain Python, with every index checked."""
    space, state = [0] * SMALL.at("SIZE"), prepare(edges, WorldClass.parse(kind)).tolist()
    rows = np.full((most, 3 + 3 * edges), -1)
    found: list[list[int]] = rows[: plain(list_worlds)(space, state, rows, most)].tolist()
    return found


@pytest.mark.parametrize("text", ["any", "genus:1", "genus<=1", "simple", "planar,loopless"])
def test_as_plain_python_the_kernel_lists_the_same(text: str) -> None:
    rows = first_rows(text, 4)
    expected = [
        [rank, len(degrees), *degrees, *alpha]
        for rank, (degrees, alpha) in pruned.ranked_tables(4, WorldClass.parse(text))
    ]
    assert [row[: len(want)] for row, want in zip(rows, expected, strict=False)] == expected[:400]


def never(*_words: object) -> int:
    return 0


def test_a_pruner_that_forgets_what_it_undid_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    right = first_rows("simple", 5)
    monkeypatch.setattr(pruning, "neighbours_undo_join", never)
    assert first_rows("simple", 5) != right


def test_a_pruner_that_miscounts_a_word_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    right = first_rows("genus<=1", 4)
    monkeypatch.setattr(pruning, "word_is_odd", never)
    assert first_rows("genus<=1", 4) != right


@pytest.mark.parametrize("edges", [0, -1, WORLD_DARTS // 2 + 1])
def test_more_edges_than_there_is_room_for_are_refused_with_the_range(edges: int) -> None:
    with pytest.raises(InputError, match=rf"1 … {WORLD_DARTS // 2} edges, got {edges}"):
        prepare(edges)
