"""The cheapest and the dearest run of a world, by dynamic programming over its states.

From the end backwards: the least that a state can still cost is the least, over its ways, of the
cost of the way and the least cost of the state behind it. The same with "most". States form no
circle, since behind e hypotheses only become fewer and between edges S only grows.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from topo_verify.harness.search.states.graph import END, ChoiceState, StateGraph


class CostRange(NamedTuple):
    """What a mapper can cost in one world, in edge traversals, by what is chosen.

    Attributes:
        states, choices: how many states have more than one way, and how many ways they have.
        cheapest, dearest: the least and the most that any run costs.
        cheap, dear: choices that make them.
    """

    states: int
    choices: int
    cheapest: int
    dearest: int
    cheap: tuple[int, ...]
    dear: tuple[int, ...]


class _Best(NamedTuple):
    cost: int
    way: int
    to: int


Prefer = Callable[[Sequence[_Best]], _Best]


def cost_range(graph: StateGraph) -> CostRange:
    """The range of the costs of a graph all of whose ways were taken."""
    assert graph.start is not None, "the mapper was run"
    ends: list[tuple[int, tuple[int, ...]]] = []
    for prefer in (_least, _most):
        best = _bests(graph.nodes, prefer)
        cost, to, row = graph.start.cost, graph.start.to, list[int]()
        cost += best[to].cost if to != END else 0
        while to != END:
            row.append(best[to].way)
            to = best[to].to
        ends.append((cost, tuple(row)))
    (cheapest, cheap), (dearest, dear) = ends
    return CostRange(len(graph.nodes), graph.choices, cheapest, dearest, cheap, dear)


def _least(ways: Sequence[_Best]) -> _Best:
    return min(ways, key=lambda way: way.cost)


def _most(ways: Sequence[_Best]) -> _Best:
    return max(ways, key=lambda way: way.cost)


def _bests(nodes: Sequence[ChoiceState], prefer: Prefer) -> dict[int, _Best]:
    """The preferred way of each state, with all that is still to be paid from there on."""
    best: dict[int, _Best] = {}
    waiting = list(range(len(nodes)))
    while waiting:
        number = waiting[-1]
        ways = [way for way in nodes[number].ways if way is not None]
        missing = [way.to for way in ways if way.to != END and way.to not in best]
        if missing:
            waiting += missing
            continue
        waiting.pop()
        left = [0 if way.to == END else best[way.to].cost for way in ways]
        best[number] = prefer(
            [
                _Best(way.cost + more, place, way.to)
                for place, (way, more) in enumerate(zip(ways, left, strict=True))
            ]
        )
    return best


def costs_of_all(graph: StateGraph) -> frozenset[int]:
    """Every cost that some run has; for comparison with runs that were made one by one."""
    assert graph.start is not None, "the mapper was run"
    costs: dict[int, frozenset[int]] = {END: frozenset([0])}
    waiting = list(range(len(graph.nodes)))
    while waiting:
        number = waiting[-1]
        ways = [way for way in graph.nodes[number].ways if way is not None]
        missing = [way.to for way in ways if way.to not in costs]
        if not missing:
            rows = ((way.cost + left for left in costs[way.to]) for way in ways)
            costs[number] = frozenset(cost for row in rows for cost in row)
            waiting.pop()
        else:
            waiting += missing
    return frozenset(graph.start.cost + left for left in costs[graph.start.to])
