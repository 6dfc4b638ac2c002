"""The main job: what can be checked in under a minute, in four parts, each with its own verdict.

| part | what | quick |
| --- | --- | --- |
| `counts` | every world of 1 to 6 edges is listed; their numbers are the known ones | 1 to 5 |
| `small-worlds` | every world of 1 to 4 edges, every mapper, every claim | 1 to 3 |
| `sampled-worlds` | 200 worlds of 6 to 30 edges, drawn uniformly among those of a size | 40 |
| `street-network` | a real street network, and what each mapper pays there | the same |

Nothing is printed here: parts are yielded as they are done.

What this does not show: anything about worlds beyond those that each part names.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from random import Random

from topo_verify.campaigns.counts import Counts
from topo_verify.campaigns.parts import Job, Part, Tell
from topo_verify.campaigns.trials import PATIENCE, Costs, Trials
from topo_verify.robot.limits import Limits
from topo_verify.targets import Target
from topo_verify.world import counting
from topo_verify.world.naming import world_from
from topo_verify.world.rooted_map import World

SEED = 0
"""The default seed of the sampled worlds."""


def verify(
    targets: Sequence[Target],
    *,
    quick: bool = False,
    seed: int = SEED,
    limits: Limits | None = None,
    tell: Tell | None = None,
) -> Iterator[Part]:
    """Check these mappers, part by part.

    On KeyboardInterrupt the part at work is yielded as far as it came (its verdict is UNKNOWN, or
    REFUTED if it found something); then the exception goes on.

    Args:
        quick: smaller sizes.
        seed: of the sampled worlds.
        limits: of each run of a mapper.
    """
    for job in _jobs(targets, seed, limits or Limits(), quick=quick):
        try:
            job.work(tell or _silence)
        except KeyboardInterrupt:
            yield job.part(interrupted=True)
            raise
        yield job.part()


def _silence(_part: str, _done: int, _total: int) -> None:
    """Tell nobody."""


def _jobs(targets: Sequence[Target], seed: int, limits: Limits, *, quick: bool) -> Iterable[Job]:
    largest, sampled = (3, 40) if quick else (4, 200)
    yield Counts(5 if quick else 6)
    yield Trials(
        name="small-worlds",
        about=f" of 1 to {largest} edges",
        total=sum(map(counting.count, range(1, largest + 1))),
        worlds=lambda: _all_worlds(largest),
        targets=targets,
        limits=limits,
        finite=True,
    )
    yield Trials(
        name="sampled-worlds",
        about=" drawn with 6 to 30 edges",
        total=sampled,
        worlds=lambda: sampled_worlds(sampled, seed),
        targets=targets,
        limits=limits,
        patience=PATIENCE,
    )
    yield Costs("street-network", "nyc", world_from("nyc"), targets, limits)


def _all_worlds(edges: int) -> Iterator[World]:
    for m in range(1, edges + 1):
        yield from map(World.from_code, counting.tables(m))


def sampled_worlds(number: int, seed: int) -> Iterator[World]:
    """Worlds of 6 to 30 edges, smallest first."""
    random = Random(seed)
    drawn = [counting.sample(random.randint(6, 30), random) for _ in range(number)]
    drawn.sort(key=lambda table: (len(table[1]), counting.rank(table)))
    return map(World.from_code, drawn)
