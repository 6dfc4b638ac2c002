"""What any choices can cost `basic` in worlds of 5 (20 s) and 6 edges (6 minutes).

    python -m research.every 5 6

`search --policies every` goes to 4 edges, where the mapper makes each choice. Here a compiled model
makes them, for algorithms that remember nothing (extra `fast`). It judges claims 3 and 4 in each
state, and joins more states than `search` does. The mapper makes the cheapest, the most expensive
and the reference run of each world, which every claim judges. The script ends with an error if a
claim fails, or if a run costs something else than in the model.

Costs are sums over the worlds. The last columns: what the cheapest choices save of what the
reference policies cost, together and at most in one world.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import partial

from research.every import table
from topo_verify import CATALOGUE, World, extras
from topo_verify.campaign.judge import judge
from topo_verify.campaign.row import MostSaved, PolicyCosts
from topo_verify.campaign.run import explore
from topo_verify.errors import InternalError
from topo_verify.programs.loader import Target
from topo_verify.studies.search.states.script import scripted
from topo_verify.world.enumeration import rank_order

MOST_EDGES = 6

KNOWN = [name for name, algorithm in CATALOGUE.items() if table.is_known(algorithm)]

COLUMNS = (
    *("edges", "worlds", "states", "choices", "cheapest", "reference", "dearest"),
    *("the cheapest save", "at most", "in"),
)


def costs_in(name: str, world_id: str) -> PolicyCosts:
    """What any choices can cost an algorithm in one world.

    Raises:
        InternalError: a claim fails, or the model and the mapper differ.
    """
    world, algorithm = World.from_id(world_id), CATALOGUE[name]
    found = table.found_in(world, algorithm)
    if found.wrong:
        raise InternalError(f"the model of {name} finds a claim false in {world_id}")
    for order, expected in ((found.cheap, found.cheapest), (found.costly, found.dearest)):
        mapper = scripted(algorithm, table.Ordered(world, order))
        cost = judged_cost(world, Target(name, mapper))
        if cost != expected:
            raise InternalError(f"{name} in {world_id} costs {cost}, in the model {expected}")
    reference = judged_cost(world, Target(name, algorithm))
    saved = MostSaved(world_id, reference, found.cheapest)
    return PolicyCosts(
        1, found.states, found.choices, found.cheapest, reference, found.dearest, saved
    )


def judged_cost(world: World, target: Target) -> int:
    run = explore(world, target)
    if not (report := judge(run)).ok:
        raise InternalError(f"a claim of {target.text} fails: {report.findings[0].message}")
    return run.cost


def costs(name: str, edges: int, pool: ProcessPoolExecutor) -> PolicyCosts:
    """The sums over all worlds with this many edges."""
    ids = (f"m{edges}/{rank}" for rank in range(rank_order.count(edges)))
    return sum(pool.map(partial(costs_in, name), ids, chunksize=100), PolicyCosts())


def cells(edges: int, total: PolicyCosts) -> Iterator[str]:
    yield from map(str, (edges, total.worlds, total.states, total.choices))
    yield from map(str, (total.cheapest, total.reference, total.dearest))
    yield f"{100 * (1 - total.cheapest / total.reference):.1f} %"
    assert total.most_saved is not None
    yield f"{100 * total.most_saved.share:.1f} %"
    yield f"`{total.most_saved.world}`"


def main() -> None:
    ask = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    ask.add_argument("edges", type=int, nargs="+", choices=range(1, MOST_EDGES + 1))
    ask.add_argument("--mapper", choices=KNOWN, default="basic")
    ask.add_argument("--workers", type=int, default=2, help="processes")
    args = ask.parse_args()
    if extras.missing_packages("fast"):
        sys.exit("research.every needs numba: install topo-verify with the extra `fast`")
    print(f"| {' | '.join(COLUMNS)} |")
    print(f"| {' | '.join(['---:'] * (len(COLUMNS) - 1))} | --- |")
    with ProcessPoolExecutor(args.workers) as pool:
        for edges in args.edges:
            row = cells(edges, costs(args.mapper, edges, pool))
            print(f"| {' | '.join(row)} |", flush=True)


if __name__ == "__main__":
    main()
