"""A world as `kernel.py` takes it, and the kernel's result. numba and NumPy are loaded late."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, NamedTuple

from topo_verify.algorithms import Algorithm
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.motion import overlap, retrace
from topo_verify.algorithms.rules import HistoryRule, NoRule, PrefixRule
from topo_verify.errors import InternalError
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import exit_dart, percepts
from topo_verify.studies.search.states.script import ChoicePoint
from topo_verify.world.rooted_map import Dart, World

if TYPE_CHECKING:
    from collections.abc import Sequence

    from research.every.best import RunOrder, Tables

RULES: tuple[object, ...] = (NoRule, PrefixRule, HistoryRule)
"""In the order of the kernel's numbers."""


class KernelFound(NamedTuple):
    """The kernel's result for one world.

    Attributes:
        wrong: what is wrong in some state, as a number of `kernel.py`; 0: nothing.
        cheap, costly: runs with the least and the highest cost.
    """

    wrong: int
    states: int
    choices: int
    cheapest: int
    dearest: int
    cheap: RunOrder
    costly: RunOrder


def is_known(algorithm: Algorithm) -> bool:
    """Whether the kernel knows the rule and the motion of an algorithm."""
    return algorithm.rule in RULES and algorithm.motion in (overlap, retrace)


def found_in(
    world: World, algorithm: Algorithm, shown: Sequence[Percept] | None = None
) -> KernelFound:
    """The kernel's result for a world whose darts are numbered as in its code.

    `shown` are the percepts with each dart as the reference dart; default: the true ones.
    """
    size, tables = len(world.alpha), _tables()
    assert world.root == 0, "a world whose darts are numbered as in its code"
    table = tables.world
    for dart, percept in enumerate(shown or percepts(world)):
        table[0, dart], table[1, dart] = world.alpha[dart], world.vertex_of[dart]
        table[2, dart] = 32 * percept.degree + (-1 if percept.marker is None else percept.marker)
    for vertex, rotation in enumerate(world.vertices):
        table[3, vertex], table[4, vertex] = rotation[0], len(rotation)
    tables.search(size, RULES.index(algorithm.rule), overlap=algorithm.motion is overlap)
    wrong, states, choices, least, most = map(int, tables.found[:5])
    from research.every.kernel import FULL

    if wrong == FULL:
        raise InternalError(f"{world.text} has too many states for the kernel")
    cheap, costly = ((), ()) if wrong else (tables.order(0), tables.order(1))
    return KernelFound(wrong, states, choices, least, most, cheap, costly)


@cache
def _tables() -> Tables:
    from research.every.best import Tables

    return Tables()


class Ordered:
    """Makes the choices of a `RunOrder` in its world, for one run of the mapper."""

    def __init__(self, world: World, order: RunOrder) -> None:
        self._world, self._order = world, order

    def __call__(self, moment: ChoicePoint) -> int:
        """The place of the dart in the order; 0 if the order has none."""
        darts = world_darts(moment.chart, self._world)
        if darts is None:
            return 0
        settled = sum(other is not None for other in moment.chart.alpha) // 2
        e, *tried = self._order[settled]
        ways = [darts[dart] for dart in moment.ways]
        wanted = [e] if moment.e is None else tried
        return next((ways.index(dart) for dart in wanted if dart in ways), 0)


def world_darts(chart: Chart, world: World) -> list[Dart] | None:
    """The world's dart for each dart of S; None if S is no part of the world."""
    assert world.root is not None, "the world has an edge"
    darts: list[Dart | None] = [None] * len(chart.alpha)
    entries = {0: world.root}
    for v, _, back in chart.outward(0):
        if back is not None:
            up = chart.across(back)
            at = darts[up]
            assert at is not None, "the search goes outward"
            entries[v] = exit_dart(world, world.alpha[at], chart.first[v] - back)
        if world.degrees[world.vertex_of[entries[v]]] != chart.degree[v]:
            return None
        for door, dart in enumerate(chart.darts(v)):
            darts[dart] = exit_dart(world, entries[v], door)
    placed = [dart for dart in darts if dart is not None]
    if len(set(placed)) < len(darts):  # a vertex is out of reach, or stands in S twice
        return None
    pairs = ((placed[d], other) for d, other in enumerate(chart.alpha) if other is not None)
    return placed if all(world.alpha[dart] == placed[other] for dart, other in pairs) else None
