"""The worlds with which tests of formats that hold every world go there and back."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

import topo_verify as tv
from topo_verify.errors import LINE, InputError
from topo_verify.world import World, families
from topo_verify.world.resolve import resolve_world

HOSTILE = ("", " a\tb\nc ", "</data><node id='0'/>", '"];alert(1)//', "\u2028\u202e\x85é𝄞", "&#0;")
"""Names that a careless writer or reader would change."""


def every_kind() -> Iterator[World]:
    """All worlds of up to 3 edges; loops, parallel edges, genera 0 to 3; names and positions."""
    for edges in range(4):
        yield from tv.worlds(edges=edges)
    yield families.torus(3, 4)
    yield families.lattice(4, 5, holes=0.2, seed=2)
    yield World.from_id("m6/110409")
    yield resolve_world("nyc")
    yield named()
    # Vertices in another order than their darts, each beginning elsewhere than at its least dart.
    yield World.from_rotations([[5, 2, 4], [1, 3, 0]], [[0, 5], [1, 2], [3, 4]], 4)


def world_or_sentence(read: Callable[[], World]) -> World | None:
    """The world that is read; None if it is refused with one sentence."""
    try:
        return read()
    except InputError as refusal:
        assert str(refusal).isprintable()  # noqa: PT017
        assert len(str(refusal)) <= LINE  # noqa: PT017
        return None


def sentence_of(read: Callable[[], object], start: str) -> str:
    """The one sentence that refuses what is read."""
    with pytest.raises(InputError) as refusal:
        read()
    sentence = str(refusal.value)
    assert sentence.isprintable()
    assert sentence.startswith(start)
    assert len(sentence) < 600
    return sentence


def named(names: tuple[str, ...] = HOSTILE) -> World:
    """A path with these names, and positions that only exact floats bring back."""
    length = len(names)
    rotations = [[0], *([2 * v - 1, 2 * v] for v in range(1, length - 1)), [2 * length - 3]]
    return World.from_rotations(
        rotations,
        [(2 * v, 2 * v + 1) for v in range(length - 1)],
        3,
        vertex_names=names,
        positions=tuple((v / 3, 1e300 * v) for v in range(length)),
        name=names[2],
        source=names[3],
        licence=names[4],
    )


def is_same(one: World, other: World) -> bool:
    """Is the other world the one, with all that it carries and its vertices in their order?"""
    return one == other and one.to_json() == other.to_json()


def simple_planar(edges: int) -> list[World]:
    """Every simple planar world of this size."""
    return list(tv.worlds(edges=edges, cls="simple,planar"))
