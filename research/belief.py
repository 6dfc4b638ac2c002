"""How far belief could carry: `planner` with an oracle that confirms what it already believes.

Each hypothesis for an unsettled edge e has odds (algorithms/beyond/homing.py, planner.py); the rest
is the belief that the place behind e is new. The oracle of column `p` settles e if that is true and
believed with p or more. It never speaks where the belief is wrong, so this is about the most that
acting on such beliefs could save.

    .venv/bin/python -m research.belief --families 'lattice(10' 'king(10,10,holes'
    .venv/bin/python -m research.belief --calibration --families 'lattice(10'

`--calibration` prints how often a place believed to be new was new.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from math import prod
from pathlib import Path
from statistics import mean

from research.ignorance import ToldHistory
from research.price import FAMILIES, PATIENT, Job, Run, Store, drawn, head, ratio, require_right
from topo_verify import World, explore
from topo_verify.algorithms.beyond.folding import NodeDart
from topo_verify.algorithms.beyond.history import History
from topo_verify.algorithms.beyond.homing import UNSEEN, degree_shares
from topo_verify.algorithms.beyond.next_edge import outward_edge
from topo_verify.algorithms.beyond.planner import FAR, Habits
from topo_verify.algorithms.beyond.steering import explore as steer
from topo_verify.algorithms.chart import Survey
from topo_verify.robot.events import MapDart, Robot

SHARES = (2.0, 0.99, 0.95, 0.9, 0.8, 0.5, 0.0)
"""The beliefs from which on the oracle speaks; 2 is never, 0 is always."""

LEAST_NEW = 0.02


class Believer:
    """The policies of `planner`, and an oracle for what it believes."""

    def __init__(self, world: World, share: float) -> None:
        self.world = world
        self.share = share
        self.habits = Habits()
        self.seen: Counter[tuple[int, bool]] = Counter()  # belief in hundredths, whether new

    def __call__(self, robot: Robot) -> Survey:
        return steer(robot, edge=outward_edge, door=self.door, history_of=self._history)

    def _history(self, robot: Robot) -> History:
        return ToldHistory(robot, world=self.world, oracle="-")

    def door(self, history: History, e: MapDart) -> NodeDart:
        """The door of `planner`, or towards the next edge where the oracle settles e."""
        assert isinstance(history, ToldHistory), "made by _history"
        chosen = self.habits.door(history, e)
        belief, is_new = self.belief(history, e), history.leads_to_new(e)
        self.seen[int(100 * belief), is_new] += 1
        if belief < self.share or not is_new:
            return chosen
        history.tell_new(e)
        if not history.chart.unexplored:
            return history.at  # any: the map is complete
        e = outward_edge(history)
        goal = history.behind(e) if e in history.crossed else history.node_dart(e)
        return next(iter([*history.way(goal), goal]))

    def belief(self, history: History, e: MapDart) -> float:
        """How likely the place behind e is new, by the odds of `planner`."""
        usual, asked = degree_shares(history), self.habits.asked[e]
        known = sum(
            self.habits.rate(asked.get(h, (FAR, FAR)))
            / prod(usual.get(degree, UNSEEN) for degree in places.coincidences())
            for h, places in history.hypotheses(e)
        )
        new = max(LEAST_NEW, 1 - sum(map(self.habits.rate, asked.values())))
        return new / (new + known)


def believing(job: Job) -> Run:
    """The cost of a believer; `job.mapper` is the share from which on the oracle speaks."""
    world = drawn(job.family, job.seed)
    began = time.process_time()
    run = explore(world, Believer(world, float(job.mapper)), limits=PATIENT)
    seconds = time.process_time() - began
    require_right(run, job)
    return Run(len(world.edges), world.least_cost(), run.cost, round(1000 * seconds, 1))


def calibration(families: list[str], seeds: int) -> None:
    print(head(["family", *(f"{ten * 10}-{ten * 10 + 9} %" for ten in range(10))]))
    for family in families:
        counts: Counter[tuple[int, bool]] = Counter()
        for seed in range(seeds):
            world = drawn(family, seed)
            believer = Believer(world, SHARES[0])
            explore(world, believer, limits=PATIENT)
            for (hundredth, is_new), times in believer.seen.items():
                counts[min(hundredth // 10, 9), is_new] += times
        cells = [
            f"{counts[ten, True] / times:.0%} of {times}"
            if (times := counts[ten, True] + counts[ten, False])
            else "-"
            for ten in range(10)
        ]
        print(f"| `{family}` | {' | '.join(cells)} |", flush=True)


def main() -> None:
    ask = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    ask.add_argument("--families", nargs="+", default=[""], help="those whose text begins so")
    ask.add_argument("--seeds", type=int, default=10, help="0 … N-1")
    ask.add_argument("--workers", type=int, default=2, help="processes")
    ask.add_argument("--runs", type=Path, help="keep finished runs in this CSV file")
    ask.add_argument("--calibration", action="store_true", help="instead: how true beliefs are")
    args = ask.parse_args()
    chosen = [family for family in FAMILIES if family.startswith(tuple(args.families))]
    if args.calibration:
        calibration(chosen, args.seeds)
        return
    store = Store(args.runs)
    names = ["-", *(f"{share:.0%}" for share in SHARES[1:])]
    print(head(["family", "worlds", "least", *names]))
    with ProcessPoolExecutor(args.workers) as pool:
        for family in chosen:
            jobs = [[Job(family, s, str(share)) for s in range(args.seeds)] for share in SHARES]
            columns = [store.make(column, pool, play=believing) for column in jobs]
            cells = [f"{mean(run.least for run in columns[0]):.0f}", *map(ratio, columns)]
            print(f"| `{family}` | {args.seeds} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
