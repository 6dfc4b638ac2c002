"""What the paper leaves open, and what it costs: policies, ways home, and how long records live.

    .venv/bin/python -m research.left_open        # one to three minutes

Means over 30 graphs of a family of the paper, and by how much one mapper costs more than another
one, ± the standard error of the difference. Of each family two tables:

- pairs of policies: the paper's algorithms, II against I, and `basic` whose ways home follow the
  discovery tree, in which each vertex hangs on the vertex from which it was discovered;
- Enhancement III: one level, all levels, and all levels with records that outlive their dart. What
  was seen behind the dart then moves to the unexplored darts of the place that is known now.

Of each run only the sizes of the map are checked; `topo-verify explore` judges the claims.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from math import sqrt
from statistics import mean, stdev

from topo_verify import CATALOGUE, World
from topo_verify.algorithms.chart import Chart, Survey, Tree
from topo_verify.algorithms.exploration import explore
from topo_verify.algorithms.motion import Executed, retrace
from topo_verify.algorithms.policies import nearest, order_policy, pick_policy, shortest
from topo_verify.algorithms.rules import NoRule, RecordsRule, Seen
from topo_verify.extra.figures.figures import GRAPHS, PAIRS, PolicyPair
from topo_verify.extra.figures.words import LADDER
from topo_verify.robot.events import MapDart, Robot
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.world.resolve import resolve_world

FAMILIES = ("lattice(10,10,holes=0.2,seed={})", "regular(40,8,holes=0.2,seed={})")

Mapper = Callable[[Robot], Survey]


def costs(mapper: Mapper, worlds: Sequence[World]) -> list[int]:
    return [cost(mapper, world) for world in worlds]


def cost(mapper: Mapper, world: World) -> int:
    robot = SimulatedRobot(world, world.cost_bound)
    survey = mapper(robot)
    assert len(survey.edges) == len(world.edges)
    assert len(survey.vertices) == len(world.vertices)
    return robot.cost


def along_discovery(robot: Robot, pair: PolicyPair) -> Survey:
    """`basic` with ways home along the discovery tree."""
    ordered = order_policy(pair.order)

    def order(darts: Iterable[MapDart], chart: Chart, tree: Tree) -> list[MapDart]:
        # the loop takes the ways home from this tree; a vertex was entered by its first dart
        for v, entry in enumerate(chart.first[1:], 1):
            tree.parent[v] = entry
            tree.depth[v] = tree.depth[chart.vertex[chart.across(entry)]] + 1
        return ordered(darts, chart, tree)

    return explore(robot, rule=NoRule(), motion=retrace, pick=pick_policy(pair.pick), order=order)


class LastingRecords(RecordsRule):
    """All-level Enhancement III whose records outlive their dart."""

    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        explored = {dart: self.records.get(dart) for dart in (e, entry)}
        super().learn(chart, e, entry, sequences)
        for dart, place in explored.items():
            if place is not None:
                self._move(chart, chart.across(dart), place)

    def _move(self, chart: Chart, arrival: MapDart, place: Seen) -> None:
        for door, behind in place.behind.items():
            exit_dart = chart.turn(arrival, door)
            if chart.alpha[exit_dart] is None:
                merge(self.records.setdefault(exit_dart, behind), behind)
            else:
                self._move(chart, chart.across(exit_dart), behind)


def merge(known: Seen, other: Seen) -> None:
    """Add to a trie what another trie of the same place holds."""
    for door, place in other.behind.items():
        if place is not known.behind.setdefault(door, place):
            merge(known.behind[door], place)


def lasting_records(robot: Robot) -> Survey:
    return explore(robot, rule=LastingRecords(), motion=retrace, pick=nearest, order=shortest)


def excess(costs: Sequence[int], reference: Sequence[int]) -> str:
    """By how much costs exceed a reference in the mean, and in how many worlds."""
    differences = [a - b for a, b in zip(costs, reference, strict=True)]
    error = stdev(differences) / sqrt(len(differences))
    return f"{mean(differences):+.1f} ± {error:.1f}, more in {sum(d > 0 for d in differences)}"


def policies(worlds: Sequence[World]) -> Iterator[tuple[str, ...]]:
    yield "pick", "order", *LADDER, "II against I", "basic, discovery tree"
    for pair in PAIRS:
        cost_of = {
            name: costs(CATALOGUE[name].with_policies(pick=pair.pick, order=pair.order), worlds)
            for name in LADDER
        }
        yield (
            *(pair.pick, pair.order),
            *(f"{mean(row):,.0f}" for row in cost_of.values()),
            excess(cost_of["enhancement-ii"], cost_of["enhancement-i"]),
            f"{mean(costs(partial(along_discovery, pair=pair), worlds)):,.0f}",
        )


def records(worlds: Sequence[World]) -> Iterator[tuple[str, ...]]:
    yield "Enhancement III", "mean", "against all levels"
    cost_of = {
        "one level": costs(CATALOGUE["enhancement-iii-one"], worlds),
        "all levels": costs(CATALOGUE["enhancement-iii-all"], worlds),
        "all levels, lasting": costs(lasting_records, worlds),
    }
    for name, row in cost_of.items():
        yield name, f"{mean(row):,.1f}", excess(row, cost_of["all levels"])


def main() -> None:
    ask = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    ask.parse_args()
    for family in FAMILIES:
        worlds = [resolve_world(f"family:{family.format(seed)}") for seed in range(GRAPHS)]
        for table in (policies, records):
            print(f"\n{family.format(f'0 to {GRAPHS - 1}')}\n")
            for at, row in enumerate(table(worlds)):
                print(f"| {' | '.join(row)} |", flush=True)
                if at == 0:
                    print("|" + " --- |" * len(row))


if __name__ == "__main__":
    main()
