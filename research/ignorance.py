"""The price of ignorance: the cost of a mapper that a truthful oracle tells a part of the truth.

The oracle answers when an edge e is crossed. `homing` and `planner` take its answers for proved,
and prove the rest. The columns are what it tells:

    -          nothing
    new        that the place behind e is new, if it is: e is settled for nothing
    true       which hypothesis is true, if one is: the others are refuted for nothing
    new, 1     both
    new, k     `new`; and if the place is known, the true hypothesis and k-1 others remain

A cell is the mean cost over the mean least cost of a proof, with the standard error of this ratio.
A wrong map stops the script.

    .venv/bin/python -m research.ignorance --families 'lattice(10' 'king(10,10,holes'
    .venv/bin/python -m research.ignorance --mappers homing --seeds 4 --runs runs.csv

S, e, h: as in algorithms/beyond/history.py; phi: dart of S -> the dart of the world that it is.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Collection
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from random import Random
from statistics import mean

from research.price import FAMILIES, PATIENT, Job, Run, Store, drawn, head, ratio, require_right
from topo_verify import World, explore
from topo_verify.algorithms.beyond.history import History
from topo_verify.algorithms.beyond.homing import homing
from topo_verify.algorithms.beyond.places import Places
from topo_verify.algorithms.beyond.planner import planner
from topo_verify.algorithms.chart import Survey
from topo_verify.algorithms.exploration import Refutation
from topo_verify.robot.events import Evidence, MapDart, Robot

MAPPERS = {"homing": homing, "planner": planner}

ORACLES: dict[str, tuple[bool, int | None]] = {
    "-": (False, None),
    "new": (True, None),
    "true": (False, 1),
    "new, 1": (True, 1),
    "new, 2": (True, 2),
    "new, 8": (True, 8),
}
"""Whether it tells that a place is new; how many hypotheses it leaves, if one is true."""

TOLD = Refutation("folding", Evidence(0, contradiction="the oracle says so"))


class ToldHistory(History):
    """A History that the oracle tells the truth about each crossed edge."""

    def __init__(self, robot: Robot, *, world: World, oracle: str) -> None:
        super().__init__(robot)
        self.tells_new, self.most = ORACLES[oracle]
        self.world = world
        self.phi: list[int] = []
        self.map_dart_of: dict[int, MapDart] = {}
        self.left: dict[MapDart, Collection[MapDart]] = {}
        self.told_new: set[MapDart] = set()
        assert world.root is not None, "the world has an edge"
        self._add_vertex(world.root)

    def _add_vertex(self, entry: int) -> None:
        while entry not in self.map_dart_of:
            self.map_dart_of[entry] = len(self.phi)
            self.phi.append(entry)
            entry = self.world.sigma[entry]

    def leads_to_new(self, e: MapDart) -> bool:
        return self.world.alpha[self.phi[e]] not in self.map_dart_of

    def tell_new(self, e: MapDart) -> None:
        self.told_new.add(e)
        self.crossed[e].possible = None
        self._settle()

    def suppose(self, e: MapDart, h: MapDart) -> Places | None:
        """The places if a crossed e ends in h; None if no world or the oracle forbids it."""
        if h in self._allowed(e):
            return super().suppose(e, h)
        self.crossed[e].refuted[h] = TOLD
        return None

    def _allowed(self, e: MapDart) -> Collection[MapDart]:
        true = self.map_dart_of.get(self.world.alpha[self.phi[e]])
        if true is None:
            return () if self.tells_new or e in self.told_new else self.chart.unexplored
        if self.most is None:
            return self.chart.unexplored
        if e not in self.left:
            others = [
                h for h in self.alike(e) if h != true and super(ToldHistory, self).suppose(e, h)
            ]
            drawn_others = Random(e).sample(others, min(self.most - 1, len(others)))
            self.left[e] = {true, *drawn_others}
        return self.left[e]

    def _settle_new(self, e: MapDart) -> None:
        super()._settle_new(e)
        self._add_vertex(self.world.alpha[self.phi[e]])


def told(job: Job) -> Run:
    """The cost of a mapper with an oracle; `job.mapper` is `homing: new, 2`."""
    name, _, oracle = job.mapper.partition(": ")
    world = drawn(job.family, job.seed)

    def mapper(robot: Robot) -> Survey:
        return MAPPERS[name](robot, history_of=partial(ToldHistory, world=world, oracle=oracle))

    began = time.process_time()
    run = explore(world, mapper, limits=PATIENT)
    seconds = time.process_time() - began
    require_right(run, job)
    return Run(len(world.edges), world.least_cost(), run.cost, round(1000 * seconds, 1))


def main() -> None:
    ask = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    ask.add_argument("--mappers", default="homing,planner", help="names, with commas")
    ask.add_argument("--families", nargs="+", default=[""], help="those whose text begins so")
    ask.add_argument("--seeds", type=int, default=10, help="0 … N-1 (torus: one world)")
    ask.add_argument("--workers", type=int, default=2, help="processes")
    ask.add_argument("--runs", type=Path, help="keep finished runs in this CSV file")
    args = ask.parse_args()
    store = Store(args.runs)
    print(head(["family", "mapper", "worlds", "least", *ORACLES], texts=2))
    with ProcessPoolExecutor(args.workers) as pool:
        for family in FAMILIES:
            if not family.startswith(tuple(args.families)):
                continue
            seeds = range(1 if family.startswith("torus") else args.seeds)
            for name in args.mappers.split(","):
                columns = [
                    store.make([Job(family, s, f"{name}: {o}") for s in seeds], pool, play=told)
                    for o in ORACLES
                ]
                least = f"{mean(run.least for run in columns[0]):.0f}"
                cells = [name, str(len(seeds)), least, *map(ratio, columns)]
                print(f"| `{family}` | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
