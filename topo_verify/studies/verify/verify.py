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

from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from functools import cache, partial
from math import inf
from random import Random
from typing import Self

import msgspec

from topo_verify.algorithms import CATALOGUE
from topo_verify.campaign.pool import Pool
from topo_verify.campaign.progress import Progress, no_progress
from topo_verify.campaign.targets import targets as targets_of
from topo_verify.campaign.work import Loss, Work, processors
from topo_verify.campaign.worker import Handler
from topo_verify.compiled import available
from topo_verify.errors import InternalError
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
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
        if not quick and _are_ours(targets):
            beside = stack.enter_context(Beside(targets, seed))
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


def _are_ours(targets: Sequence[Target]) -> bool:
    return all(CATALOGUE.get(target.text) == target.mapper for target in targets)


def _jobs(
    targets: Sequence[Target], seed: int, limits: Limits, beside: Beside | None, *, quick: bool
) -> Iterable[PartJob]:
    others = left_out(targets)
    if "counts" not in others:
        yield WorldCounts(5 if quick else LARGEST + 1)
    if beside is None:
        yield SmallWorlds(3 if quick else LARGEST, targets, limits)
    else:
        further = beside.counts if available() and limits == Limits() else None
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
    worlds = generated_worlds(5 if quick else EACH, seed) if beside is None else beside.worlds()
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


class BesideJob(msgspec.Struct, frozen=True):
    """What a worker gets before its task: the algorithms, and the seed of drawn worlds."""

    targets: str
    seed: int


class BesideResult(msgspec.Struct, frozen=True):
    """The result of a task: one of the three fields."""

    part: Part | None = None
    counts: EngineCounts | None = None
    codes: tuple[Code, ...] = ()


BESIDE: dict[str, Callable[[BesideJob], BesideResult]] = {
    "engine": lambda job: BesideResult(
        counts=engine_counts(LARGEST + 1, targets_of(job.targets)) if available() else None
    ),
    "proofs": lambda _job: BesideResult(part=proved()),
    "drawing": lambda job: BesideResult(
        codes=tuple(world.code for world in generated_worlds(EACH, job.seed))
    ),
}
"""The tasks that need no other part first, each done in its own process."""


@contextmanager
def serve_beside(job: bytes) -> Generator[Handler]:
    """Do tasks of `BESIDE`, in a worker."""
    asked = msgspec.json.decode(job, type=BesideJob)
    yield lambda task, _beat: BESIDE[msgspec.json.decode(task, type=str)](asked)


class Beside:
    """Worker processes that do the tasks of `BESIDE` while the main process does the parts.

    Life cycle: `with` it, which starts them; then each method waits for its result.
    """

    def __init__(self, targets: Sequence[Target], seed: int) -> None:
        work = Work(
            serve=f"{__name__}:{serve_beside.__name__}",
            job=BesideJob(",".join(target.text for target in targets), seed),
            result=BesideResult,
            lost=_lost,
            silence=inf,
        )
        self._pool = Pool(work, len(BESIDE))
        self._finished = self._pool.run(BESIDE)
        self._results: dict[str, BesideResult] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self._pool.__exit__()

    def _result(self, task: str) -> BesideResult:
        while task not in self._results:
            name, result = next(self._finished)
            self._results[name] = result
        return self._results[task]

    def counts(self) -> EngineCounts:
        """The counts of the compiled engine, which must be installed."""
        counts = self._result("engine").counts
        assert counts is not None, "the engine is installed"
        return counts

    def proofs(self) -> Part:
        """The part `proofs`."""
        part = self._result("proofs").part
        assert part is not None
        return part

    def worlds(self) -> tuple[World, ...]:
        """The worlds that the strategies of property tests draw."""
        return tuple(map(World.from_code, self._result("drawing").codes))


def proved() -> Part:
    """The part `proofs`, proved in this process."""
    job = Proofs()
    job.work(no_progress)
    return job.part()


class ProofsBeside:
    """The part `proofs`, proved in another process. A `PartJob`."""

    def __init__(self, beside: Beside) -> None:
        self._beside = beside

    def work(self, tell: Progress) -> None:
        """Wait for its end."""
        tell("proofs", 0, 1)
        self._beside.proofs()

    def part(self, *, interrupted: bool = False) -> Part:
        """The result; nothing, if it was interrupted."""
        return Proofs().part(interrupted=True) if interrupted else self._beside.proofs()


def _lost(task: str, loss: Loss) -> BesideResult:
    raise InternalError(f"in a worker, which was to do the task {task}: {loss}")
