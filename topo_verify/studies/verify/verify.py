"""The main job: six parts, each with its own verdict, in about a minute.

`counts` and `proofs` do not depend on the mapper, so they are left out for a user's.

| part | content | quick |
| --- | --- | --- |
| `counts` | the numbers of worlds of 1 to 6 edges equal those of formulas | 1 to 5 |
| `small-worlds` | every world of 1 to 5 edges, with numba to 6; every mapper and claim | 1 to 3 |
| `proofs` | theorems on worlds of any size; negatives and mutants | the first |
| `sampled-worlds` | 200 worlds of 6 to 30 edges, drawn uniformly among those of a size | 40 |
| `generated-worlds` | 160 worlds as property tests draw them, 20 of each strategy | 40 |
| `street-network` | a real street network, and the cost of each mapper there | the same |

For algorithms of the catalogue all processors work from the start: theorems, the compiled engine
and the drawing of worlds in processes of their own (`Beside`), the runs in worker processes.

Uniformly drawn worlds have few vertices and many handles. Lattices, trees and worlds with many
similar places are rare among them; the strategies draw these on purpose.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack
from functools import cache, partial
from random import Random

import msgspec

from topo_verify.algorithms import CATALOGUE
from topo_verify.campaign.progress import Progress, no_progress
from topo_verify.campaign.targets import targets as targets_of
from topo_verify.campaign.work import processors
from topo_verify.compiled import available
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.studies.beside import Beside
from topo_verify.studies.corpus import STRATEGIES, drawn
from topo_verify.studies.verify.parts import Part, PartJob, Proofs, WorldCounts
from topo_verify.studies.verify.trials import (
    MAX_TIMEOUTS,
    CostTrial,
    EngineCounts,
    SmallWorlds,
    Together,
    Trials,
    engine_counts,
    with_ids,
)
from topo_verify.world.enumeration import rank_order
from topo_verify.world.resolve import resolve_world
from topo_verify.world.rooted_map import Code, World

SEED = 0

LARGEST = 5
"""Most edges of the small worlds, without the size that the compiled engine adds."""

EACH = 20
"""Worlds drawn from each strategy."""


def verify(
    targets: Sequence[Target],
    *,
    quick: bool = False,
    seed: int = SEED,
    limits: Limits | None = None,
    tell: Progress | None = None,
) -> Iterator[Part]:
    """The parts, each yielded when these mappers were checked in it.

    On KeyboardInterrupt the current part is yielded with its results so far; then the exception is
    raised again.

    Args:
        quick: use the smaller sizes.
        seed: of the sampled worlds.
        limits: of each run of a mapper.
    """
    with ExitStack() as stack:
        beside = None
        if not quick and all(CATALOGUE.get(one.text) == one.mapper for one in targets):
            names = ",".join(target.text for target in targets)
            calls = Beside(
                task_result, TASKS, (names, seed), result=BesideResult, workers=len(TASKS)
            )
            beside = stack.enter_context(calls)
        for job in _jobs(targets, seed, limits or Limits(), beside, quick=quick):
            try:
                job.work(tell or no_progress)
            except KeyboardInterrupt:
                yield job.part(interrupted=True)
                raise
            yield job.part()


def left_out(targets: Sequence[Target]) -> tuple[str, ...]:
    """The parts that are not done for these mappers: none if one is of the catalogue."""
    ours = any(CATALOGUE.get(target.text) == target.mapper for target in targets)
    return () if ours else ("counts", "proofs")


def _jobs(
    targets: Sequence[Target],
    seed: int,
    limits: Limits,
    beside: Beside[BesideResult] | None,
    *,
    quick: bool,
) -> Iterable[PartJob]:
    others = left_out(targets)
    if "counts" not in others:
        yield WorldCounts(5 if quick else LARGEST + 1)
    if beside is None:
        yield SmallWorlds(3 if quick else LARGEST, targets, limits)
    else:
        further = partial(_counts, beside) if available() and limits == Limits() else None
        yield SmallWorlds(LARGEST, targets, limits, further=further, workers=processors())
    if "proofs" not in others:
        yield Proofs(quick=quick) if beside is None else ProofsBeside(beside)
    trials = partial(Trials, targets=targets, limits=limits, max_failing=MAX_TIMEOUTS)
    number = 40 if quick else 200
    drawn = with_ids(sampled_worlds(number, seed))
    sampled = trials("sampled-worlds", " drawn with 6 to 30 edges", number, drawn)
    street = CostTrial("street-network", "nyc", resolve_world("nyc"), targets, limits)
    if beside is None:
        yield sampled
    # Drawing takes seconds: this generator gets here only when the parts above are done.
    if beside is None:
        worlds = generated_worlds(5 if quick else EACH, seed)
    else:
        worlds = tuple(map(World.from_code, beside.result("drawing").codes))
    about = " generated by the strategies of property tests"
    generated = trials("generated-worlds", about, len(worlds), with_ids(worlds))
    if beside is None:
        yield from (generated, street)
        return
    # The longest task first: it must not be the last to end.
    with Together((street, sampled, generated)) as together:
        for part in (sampled, generated, street):
            part.together = together
            yield part


def sampled_worlds(number: int, seed: int) -> Iterator[World]:
    """Worlds of 6 to 30 edges, smallest first."""
    random = Random(seed)
    drawn = [rank_order.sample(random.randint(6, 30), random) for _ in range(number)]
    drawn.sort(key=lambda table: (len(table[1]), rank_order.rank(table)))
    return map(World.from_code, drawn)


@cache
def generated_worlds(each: int, seed: int) -> tuple[World, ...]:
    """`each` worlds of every strategy, smallest first."""
    worlds = [world for text in STRATEGIES for world in drawn("verify", text, each, seed)]
    return tuple(sorted(worlds, key=lambda world: (len(world.edges), world.code)))


# ---------------------------------------------------------------- beside the main process


class BesideResult(msgspec.Struct, frozen=True):
    """The result of a task: one of the three fields."""

    part: Part | None = None
    counts: EngineCounts | None = None
    codes: tuple[Code, ...] = ()


TASKS = ("engine", "proofs", "drawing")
"""The tasks that need no other part first, each done in its own process."""


def task_result(task: str, targets: str, seed: int) -> BesideResult:
    """The result of one of the `TASKS` for these algorithms and this seed of drawn worlds."""
    if task == "proofs":
        job = Proofs()
        job.work(no_progress)
        return BesideResult(part=job.part())
    if task == "drawing":
        return BesideResult(codes=tuple(world.code for world in generated_worlds(EACH, seed)))
    counts = engine_counts(LARGEST + 1, targets_of(targets)) if available() else None
    return BesideResult(counts=counts)


def _counts(beside: Beside[BesideResult]) -> EngineCounts:
    counts = beside.result("engine").counts
    assert counts is not None, "the engine is installed"
    return counts


class ProofsBeside:
    """The part `proofs`, proved in another process. A `PartJob`."""

    def __init__(self, beside: Beside[BesideResult]) -> None:
        self._beside = beside

    def work(self, tell: Progress) -> None:
        """Wait for its end."""
        tell("proofs", 0, 1)
        self._beside.result("proofs")

    def part(self, *, interrupted: bool = False) -> Part:
        """The result; nothing, if it was interrupted."""
        part = self._beside.result("proofs").part if not interrupted else None
        return part or Proofs().part(interrupted=True)
