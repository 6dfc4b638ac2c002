"""Machinery that the tests share: small worlds, what is in a trace, doctored traces."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import msgspec
import pytest
from hypothesis import strategies as st

from topo_verify import World
from topo_verify.algorithms import CATALOGUE, NAMED, Algorithm
from topo_verify.algorithms.exploration import Rule
from topo_verify.algorithms.motion import Motion, retrace
from topo_verify.campaign.run import explore
from topo_verify.checkers import CLAIMS, Status, check
from topo_verify.programs.loader import Mapper
from topo_verify.robot.events import Event, MapData, Move, Reject, Trace
from topo_verify.robot.percept import Percept
from topo_verify.world.enumeration import rank_order

E = TypeVar("E", bound=Event)
T = TypeVar("T")

EMPTY = World((), (), None)
"""One vertex and nothing else: the legal world without a dart."""


EIGHT = {*list(CLAIMS)[:8]}
"""The claims that ask whether the mapper was right in this world."""


def some(value: T | None) -> T:
    """The value, which must be there."""
    assert value is not None
    return value


def typed(kind: type[T], value: object) -> T:
    """The value, which must be of this type."""
    assert isinstance(value, kind)
    return value


# ---------------------------------------------------------------- worlds


def worlds(edges: Iterable[int]) -> Iterator[World]:
    """Every world with these numbers of edges, in the order of their ids."""
    for m in edges:
        yield from _worlds(m)


@cache
def _worlds(edges: int) -> tuple[World, ...]:
    return tuple(map(World.from_code, rank_order.tables(edges)))


def any_world(*, max_edges: int = 8) -> st.SearchStrategy[World]:
    """Any world with 1 … max_edges edges, each as likely as another of its size."""

    def of_size(edges: int) -> st.SearchStrategy[World]:
        ranks = st.integers(0, rank_order.count(edges) - 1)
        return ranks.map(lambda rank: World.from_code(rank_order.unrank(edges, rank)))

    return st.integers(1, max_edges).flatmap(of_size)


def path(vertices: int, *, marker: int) -> World:
    """A path with the marker at one of its vertices, pointing at the lesser dart there."""
    darts = 2 * (vertices - 1)
    inner = [(dart, dart + 1) for dart in range(1, darts - 1, 2)]
    rotations = [(0,), *inner, (darts - 1,)]
    edges = [(dart, dart + 1) for dart in range(0, darts, 2)]
    return World.from_rotations(rotations, edges, rotations[marker][0])


# ---------------------------------------------------------------- traces


def trace_of(world: World | str, mapper: Mapper | str = "basic") -> Trace:
    """What happens when a mapper maps a world (or the world of this id)."""
    return explore(World.from_id(world) if isinstance(world, str) else world, mapper).trace


def fits(name: str, world: World) -> bool:
    """Does the world meet what the mapper of this name assumes?"""
    return NAMED[name].assumes != "planar" or world.is_planar


PAPER = [name for name in CATALOGUE if "folding" not in name]
"""The algorithms of the paper."""

SURE = [name for name, algorithm in CATALOGUE.items() if algorithm.assumes is None]
"""The algorithms that are right in every world."""


def variant(rule: Callable[[], Rule], motion: Motion = retrace) -> Algorithm:
    """An algorithm that is not in the catalogue."""
    return Algorithm("variant", rule, motion)


def of_type(kind: type[E], trace: Iterable[Event]) -> list[E]:
    """The events of one type, in their order."""
    return [event for event in trace if isinstance(event, kind)]


def doors(trace: Iterable[Event], *purposes: str) -> list[int]:
    """The doors of the moves for these purposes, or of all moves."""
    moves = of_type(Move, trace)
    return [move.door for move in moves if not purposes or move.purpose in purposes]


def sketch(trace: Iterable[Event]) -> list[str]:
    """What happens, a word an event: a move is its purpose and door, anything else its type."""
    return [
        f"{event.purpose} {event.door}" if isinstance(event, Move) else type(event).__name__.lower()
        for event in trace
    ]


def cited(reject: Reject) -> tuple[Percept, Percept]:
    """The two percepts that a rejection rests on: the expected one, and the observed one."""
    expected, observed = reject.evidence.expected, reject.evidence.observed
    assert expected is not None
    assert observed is not None
    return expected, observed


# ---------------------------------------------------------------- verdicts


def statuses(world: World, trace: Sequence[Event]) -> dict[str, Status]:
    """What becomes of each claim."""
    return {judgement.claim: judgement.status for judgement in check(world, trace)}


def failing(world: World, trace: Sequence[Event]) -> set[str]:
    """The claims that fail."""
    return {claim for claim, status in statuses(world, trace).items() if status == "failed"}


def edited(trace: Trace, index: int, **changes: Any) -> Trace:
    """The trace with other fields in one event."""
    index %= len(trace)
    event = msgspec.structs.replace(trace[index], **changes)
    return (*trace[:index], event, *trace[index + 1 :])


def place(trace: Trace, kind: type[Event], nth: int = 0) -> int:
    """Where the n-th event of a type stands (-1: the last)."""
    return [index for index, event in enumerate(trace) if isinstance(event, kind)][nth]


def with_darts(delivered: MapData, name: Callable[[int], int]) -> MapData:
    """The same map with other numbers for its darts."""
    vertices = tuple(tuple(map(name, vertex)) for vertex in delivered.vertices)
    edges = tuple(tuple(map(name, edge)) for edge in delivered.edges)
    return MapData(vertices, edges, None if delivered.marker is None else name(delivered.marker))


# ---------------------------------------------------------------- made once


def made_once(factory: pytest.TempPathFactory, name: str, make: Callable[[Path], object]) -> Path:
    """A folder of a session, made by the first of pytest's workers that asks for it."""
    base = factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        base = base.parent  # that of all workers
    folder, unfinished = base / name, base / f"{name}.part"
    with (base / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not folder.exists():
            unfinished.mkdir()
            make(unfinished)
            unfinished.rename(folder)
    return folder
