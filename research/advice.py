"""What the advice of `certify` costs: followed from the start, beside `homing` and the least cost.

    .venv/bin/python -m research.advice

25 random worlds of each family. For the column *after a stroll* the robot first takes 50 random
moves, free of charge.
"""

from __future__ import annotations

import argparse
from random import Random
from statistics import mean

import topo_verify as tv
from topo_verify.robot.events import Event, Start
from topo_verify.robot.simulator import exit_dart, first_percept
from topo_verify.studies.log_report import certify
from topo_verify.studies.map_check import moves
from topo_verify.world.resolve import resolve_world

STROLL = 50


def followed(world: tv.World, stroll: int, random: Random) -> tuple[int, int]:
    """The moves after the stroll until the map is proved, and the number of questions."""
    at = world.root or 0
    log: list[Event] = [Start(percept=first_percept(world))]

    def go(doors: tuple[int, ...]) -> None:
        nonlocal at
        log.extend(moves(world, at, doors))
        for door in doors:
            at = world.alpha[exit_dart(world, at, door)]

    for _ in range(stroll):
        go((random.randrange(world.degrees[world.vertex_of[at]]),))
    rounds = 0
    while (way := certify(log).advice) is not None:
        go(way.walk)
        rounds += 1
    return len(log) - 1 - stroll, rounds


def main() -> None:
    ask = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    ask.parse_args()
    names = (
        "random_tree(20)",
        "random_planar(26)",
        "lattice(5,5,holes=0.2)",
        "random_genus(26,1)",
    )
    print("| worlds, 25 each | edges | least cost | homing | advice | after a stroll | rounds |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: |")
    for name in names:
        rows: list[tuple[int, ...]] = []
        for seed in range(25):
            world, random = resolve_world(f"family:{name[:-1]},seed={seed})"), Random(seed)
            cost, rounds = followed(world, 0, random)
            later, _ = followed(world, STROLL, random)
            homing = tv.explore(world, "homing").cost
            rows.append((len(world.edges), world.least_cost(), homing, cost, later, rounds))
        columns = " | ".join(f"{mean(column):.1f}" for column in zip(*rows, strict=True))
        print(f"| `{name}` | {columns} |")


if __name__ == "__main__":
    main()
