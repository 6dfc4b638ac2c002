"""The price of not knowing the map: mean costs over seeded worlds, as a ratio to the least cost.

`least` is the least cost of a proof with the map in hand. Other columns are a mapper's mean cost
over the mean least cost, with the standard error of this ratio. A wrong map stops the script.

    .venv/bin/python -m research.price
    .venv/bin/python -m research.price --mappers homing,planner --families torus --seeds 5 --ms
    .venv/bin/python -m research.price --mappers folding,homing --against folding --runs runs.csv
    .venv/bin/python -m research.price --gap

`--against M` prints a second table of differences in the same worlds: cost minus the cost of M,
over the mean least cost; and the mean cost as a multiple of that of M. `--runs FILE` keeps finished
runs in a CSV file, and does not see that a mapper has changed.
"""

from __future__ import annotations

import argparse
import csv
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from math import sqrt
from pathlib import Path
from statistics import mean
from typing import NamedTuple

from topo_verify import World, explore
from topo_verify.campaign.run import Exploration
from topo_verify.robot.limits import Limits
from topo_verify.studies.gap import gap
from topo_verify.world.resolve import resolve_world

MAPPERS = "basic,enhancement-iii-all+i,folding,homing,planner"

FAMILIES = (
    "lattice(10,10,holes=0.2)",
    "lattice(20,20,holes=0.2)",
    "king(10,10)",
    "king(10,10,holes=0.2)",
    "king_torus(10,10)",
    "king_torus(10,10,holes=0.2)",
    "torus(10,10)",
    "regular(80,8,holes=0.2)",
)


PATIENT = Limits(move_timeout=3600, world_timeout=36000)


class Job(NamedTuple):
    """One mapper in one world of a family."""

    family: str
    seed: int
    mapper: str


class Run(NamedTuple):
    """The world's m and least cost, the run's cost and processor time."""

    m: int
    least: int
    cost: int
    ms: float


def drawn(family: str, seed: int) -> World:
    seeded = "" if family.startswith("torus") else f",seed={seed}"
    return resolve_world(f"family:{family[:-1]}{seeded})")


def priced(job: Job) -> Run:
    world = drawn(job.family, job.seed)
    began = time.process_time()
    run = explore(world, job.mapper, limits=PATIENT)
    seconds = time.process_time() - began
    require_right(run, job)
    return Run(len(world.edges), world.least_cost(), run.cost, round(1000 * seconds, 1))


def require_right(run: Exploration, job: Job) -> None:
    delivered = run.map
    right = delivered is not None and run.world.is_isomorphic(
        World.from_rotations(delivered.vertices, delivered.edges, delivered.marker)
    )
    if not right:
        raise SystemExit(f"{job}: {run.stopped or 'the map is not that of the world'}")


class Store:
    """The finished runs, in a CSV file if one is named."""

    def __init__(self, path: Path | None) -> None:
        self.path = path
        self.runs: dict[Job, Run] = {}
        if path is not None and path.exists():
            with path.open(newline="") as file:
                for line in csv.DictReader(file):
                    job = Job(line["family"], int(line["seed"]), line["mapper"])
                    m, least, cost = (int(line[name]) for name in ("m", "least", "cost"))
                    self.runs[job] = Run(m, least, cost, float(line["ms"]))

    def make(
        self, jobs: Sequence[Job], pool: ProcessPoolExecutor, play: Callable[[Job], Run] = priced
    ) -> list[Run]:
        """The runs of these jobs; missing ones are made."""
        missing = [job for job in jobs if job not in self.runs]
        for job, run in zip(missing, pool.map(play, missing), strict=True):
            self.runs[job] = run
            self._append(job, run)
        return [self.runs[job] for job in jobs]

    def _append(self, job: Job, run: Run) -> None:
        if self.path is None:
            return
        is_new = not self.path.exists()
        with self.path.open("a", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            if is_new:
                writer.writerow((*Job._fields, *Run._fields))
            writer.writerow((*job, *run))


def with_error(costs: Sequence[float], least: Sequence[int], *, sign: str = "") -> str:
    """The ratio of two means with the error of the ratio estimator; of one world, no error."""
    n, ratio = len(costs), sum(costs) / sum(least)
    if n < 2:
        return f"{ratio:{sign}.3f}"
    squares = sum((cost - ratio * bound) ** 2 for cost, bound in zip(costs, least, strict=True))
    return f"{ratio:{sign}.3f} ± {sqrt(squares / (n * (n - 1))) / mean(least):.3f}"


def ratio(runs: Sequence[Run]) -> str:
    return with_error([run.cost for run in runs], [run.least for run in runs])


def difference(runs: Sequence[Run], base: Sequence[Run]) -> str:
    """The mean difference in the same worlds over the mean least cost; and the multiple."""
    paired = [one.cost - other.cost for one, other in zip(runs, base, strict=True)]
    times = sum(run.cost for run in runs) / sum(run.cost for run in base)
    return f"{with_error(paired, [run.least for run in runs], sign='+')}, {times:.3f} ×"


def head(columns: Sequence[str], *, texts: int = 1) -> str:
    rule = "| --- " * texts + "| ---: " * (len(columns) - texts)
    return f"| {' | '.join(columns)} |\n{rule}|"


def gaps(seeds: int) -> None:
    """Print the share of false hypotheses walked although the history refuted them."""
    names = ("basic", "enhancement-i", "enhancement-ii", "enhancement-iii-all+i", "folding")
    family = FAMILIES[0]
    worlds = [drawn(family, seed) for seed in range(seeds)]
    shares = [mean(gap(explore(world, name).trace).share for world in worlds) for name in names]
    print(head(["gap", *names]))
    print(f"| `{family}` | {' | '.join(f'{share:.1%}' for share in shares)} |")


def asked() -> argparse.Namespace:
    ask = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    ask.add_argument("--mappers", default=MAPPERS, help="names, with commas")
    ask.add_argument("--families", nargs="+", default=[""], help="those whose text begins so")
    ask.add_argument("--also", nargs="+", default=[], help="families more, without their seed")
    ask.add_argument("--seeds", type=int, default=30, help="how many (torus: one world)")
    ask.add_argument("--first", type=int, default=0, help="the first seed")
    ask.add_argument("--workers", type=int, default=2, help="processes")
    ask.add_argument("--runs", type=Path, help="keep finished runs in this CSV file")
    ask.add_argument("--against", metavar="MAPPER", help="also the differences to this mapper")
    ask.add_argument("--ms", action="store_true", help="also milliseconds a move")
    ask.add_argument("--costs", action="store_true", help="mean costs, no ratios; also m")
    ask.add_argument("--gap", action="store_true", help="instead: the gap of the paper's rules")
    return ask.parse_args()


def main() -> None:
    args = asked()
    if args.gap:
        gaps(args.seeds)
        return
    mappers, store, paired = args.mappers.split(","), Store(args.runs), list[str]()
    chosen = [family for family in FAMILIES if family.startswith(tuple(args.families))]
    print(head(["family", "worlds", *["m"] * args.costs, "least", *mappers]))
    with ProcessPoolExecutor(args.workers) as pool:
        for family in [*chosen, *args.also]:
            number = 1 if family.startswith("torus") else args.seeds
            seeds = range(args.first, args.first + number)
            runs_of = {
                mapper: store.make([Job(family, seed, mapper) for seed in seeds], pool)
                for mapper in mappers
            }
            cells: list[str] = []
            for runs in runs_of.values():
                moves = sum(run.cost for run in runs)
                speed = f", {sum(run.ms for run in runs) / moves:.1f} ms" if args.ms else ""
                shown = f"{moves / len(runs):.0f}" if args.costs else ratio(runs)
                cells.append(shown + speed)
            runs = runs_of[mappers[0]]
            about = [f"{mean(run.m for run in runs):.0f}"] * args.costs
            about.append(f"{mean(run.least for run in runs):.0f}")
            print(f"| `{family}` | {len(seeds)} | {' | '.join([*about, *cells])} |", flush=True)
            if args.against:
                base = runs_of[args.against]
                others = [difference(runs_of[m], base) for m in mappers if m != args.against]
                paired.append(f"| `{family}` | {' | '.join(others)} |")
    if args.against:
        print(f"\n{head(['family', *[m for m in mappers if m != args.against]])}")
        print("\n".join(paired))


if __name__ == "__main__":
    main()
