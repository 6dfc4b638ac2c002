"""An implementation in every world of a corpus, tallied level by level.

Outcomes are tallied in corpus order, so the tally does not depend on the number of workers. After
`MAX_TIMEOUTS` time-outs the rest of the corpus is not tried: each may cost a whole time limit.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass, field

import msgspec

from topo_verify.checkers import CLAIMS, Judgement
from topo_verify.checkers.findings import Verdict
from topo_verify.harness.conform.batch import BatchExaminer
from topo_verify.harness.conform.examiner import Examiner
from topo_verify.harness.conform.order import DrawnOrder, Examine, Placed
from topo_verify.harness.conform.outcome import (
    LEVELS,
    RESULT,
    ConformJob,
    Level,
    WorldFinding,
    WorldResult,
)
from topo_verify.harness.conform.parallel import parallel_examine
from topo_verify.harness.corpus import Corpus
from topo_verify.harness.progress import Progress
from topo_verify.harness.tally import joint_judgements

MAX_TIMEOUTS = 20
"""After so many time-outs the rest of the corpus is not tried."""

KEPT = 10
"""How many failing worlds of each kind have their findings kept."""


class CostRatio(msgspec.Struct, frozen=True):
    """Edge traversals summed up over the worlds that the implementation maps correctly.

    Attributes:
        ratio: the implementation's cost relative to that of the reference; None if that is 0.
    """

    mapper: int
    reference: int
    ratio: float | None


class WorldCost(msgspec.Struct, frozen=True):
    """Edge traversals in one world that the implementation maps correctly."""

    world: str
    mapper: int
    reference: int
    ratio: float | None


def _ratio(mapper: int, reference: int) -> float | None:
    return round(mapper / reference, 4) if reference else None


class LevelResult(msgspec.Struct, frozen=True, kw_only=True):
    """The result of an implementation on one level, over all worlds of a corpus.

    Attributes:
        target: the implementation.
        like: the algorithm that its decisions and its cost are compared with.
        level: result, claims, decisions or cost.
        worlds: how many there are; each is counted in one of the next seven numbers.
        passed, failed: judged on this level.
        skipped, errored: the program declined the world, or gave it up.
        undecided: out of time though it moved on; or no map, and so nothing to judge on this level.
        not_declared: the same moves, but no decisions to compare.
        not_tried: the work ended before, after too many time-outs or by an interrupt.
        kinds: in how many worlds each kind of finding is met.
        claims: for each claim of this level, in how many runs it has which status.
        judgements: of each claim of this level: how much was judged in all runs, of how much.
        findings: of the first failing worlds of each kind.
        cost: over all worlds; priced: on level `cost`, world by world.
        why: of the first worlds that are not decided, why.
    """

    target: str
    like: str
    level: Level
    worlds: int
    passed: int
    failed: int
    skipped: int
    errored: int
    undecided: int
    not_declared: int
    not_tried: int
    verdict: Verdict
    kinds: dict[str, int]
    claims: dict[str, dict[str, int]]
    judgements: tuple[Judgement, ...]
    findings: tuple[WorldFinding, ...]
    cost: CostRatio
    priced: tuple[WorldCost, ...] = ()
    why: tuple[str, ...] = ()


@dataclass
class _LevelCounts:
    """Counts the states of worlds on one level, and keeps the first findings of each kind."""

    states: Counter[str] = field(default_factory=Counter[str])
    kinds: Counter[str] = field(default_factory=Counter[str])
    findings: list[WorldFinding] = field(default_factory=list[WorldFinding])
    whys: list[str] = field(default_factory=list[str])

    def enter(self, made: WorldResult, level: Level) -> None:
        """Count the outcome of one world."""
        self.states[made.states[level]] += 1
        found = made.findings.get(level, ())
        for kind in dict.fromkeys(one.kind for one in found):
            self.kinds[kind] += 1
            if self.kinds[kind] <= KEPT:
                self.findings += [one for one in found if one.kind == kind]
        if made.why is not None and level == "result" and len(self.whys) < KEPT:
            self.whys.append(f"{made.world}: {made.why}")


class ConformTally:
    """Counts the outcomes of one implementation.

    Life cycle: `enter` outcomes in the order of the corpus, `level_results` at any time.
    """

    def __init__(self, job: ConformJob, corpus: Corpus) -> None:
        self.job, self.total, self.finite = job, corpus.total, corpus.finite
        self.levels: dict[Level, _LevelCounts] = {
            level: _LevelCounts()
            for level in LEVELS
            if job.like is not None or level != "decisions"
        }
        self.claims = {claim: Counter[str]() for claim in CLAIMS}
        self.shares: dict[str, tuple[int, int]] = dict.fromkeys(CLAIMS, (0, 0))
        self.priced: list[WorldCost] = []
        self.timeouts = self.tried = 0

    def enter(self, made: WorldResult) -> None:
        """Count the outcome of one world."""
        self.tried += 1
        self.timeouts += made.timeout
        for level, counts in self.levels.items():
            counts.enter(made, level)
        for one in made.judgements:
            self.claims[one.claim][one.status] += 1
            judged, of = self.shares[one.claim]
            self.shares[one.claim] = judged + one.judged, of + one.of
        if made.states["cost"] == "passed":
            ratio = _ratio(made.cost, made.reference)
            self.priced.append(WorldCost(made.world, made.cost, made.reference, ratio))

    @property
    def timed_out(self) -> bool:
        """Were there so many time-outs that the rest is not to be tried?"""
        return self.timeouts >= MAX_TIMEOUTS

    def level_results(self) -> Iterator[LevelResult]:
        """The result on each level, of the worlds that were entered so far."""
        mapper = sum(one.mapper for one in self.priced)
        paid = sum(one.reference for one in self.priced)
        total = CostRatio(mapper, paid, _ratio(mapper, paid))
        for level, counts in self.levels.items():
            numbers = {name: counts.states[name] for name in _STATES}
            claims = {
                claim: dict(seen)
                for claim, seen in self.claims.items()
                if level in ("result", "claims") and (claim in RESULT) == (level == "result")
            }
            judgements = joint_judgements(claims, self.shares, ())
            yield LevelResult(
                target=self.job.target,
                like=self.job.reference,
                level=level,
                worlds=self.total,
                **{name.replace("-", "_"): number for name, number in numbers.items()},
                not_tried=self.total - self.tried,
                verdict=self._verdict(numbers),
                kinds=dict(counts.kinds),
                claims=claims,
                judgements=judgements,
                findings=tuple(counts.findings),
                cost=total,
                priced=tuple(self.priced) if level == "cost" else (),
                why=tuple(counts.whys),
            )

    def _verdict(self, numbers: dict[str, int]) -> Verdict:
        if numbers["failed"]:
            return "REFUTED"
        if numbers["passed"] < self.total:
            return "UNKNOWN"
        return "EXHAUSTED" if self.finite else "SAMPLED"


_STATES = ("passed", "failed", "skipped", "errored", "undecided", "not-declared")


def conform(
    job: ConformJob,
    corpus: Corpus,
    tally: ConformTally,
    *,
    workers: int = 0,
    batch: bool = False,
    seed: int = 0,
    tell: Progress | None = None,
) -> None:
    """Try an implementation in every world of a corpus, and enter each outcome into a tally.

    Args:
        tally: what each outcome is entered into; it is complete up to where an interrupt came.
        workers: so many processes; 0: this one alone.
        batch: the program reads worlds and writes runs; one process of it at a time.
        seed: of the order in which the implementation meets the worlds; in batch mode it is given
            them in the order of the corpus.
        tell: the progress callback.
    Raises:
        InputError: there is no such mapper, program, algorithm or policy.
    """
    with ExitStack() as stack:
        found: Iterable[WorldResult]
        if batch:
            found = stack.enter_context(BatchExaminer(job)).examine(corpus)
        else:
            examine = stack.enter_context(_examining(job, corpus, workers))
            drawn = DrawnOrder(corpus, seed, _telling(examine, job, corpus, tell), MAX_TIMEOUTS)
            found = stack.enter_context(closing(drawn.results()))
        for made in found:
            tally.enter(made)
            if batch and tell is not None:
                tell(job.target, tally.tried, corpus.total)
            if tally.timed_out:
                break


@contextmanager
def _examining(job: ConformJob, corpus: Corpus, workers: int) -> Generator[Examine]:
    """Examines worlds here or in other processes."""
    if workers:
        with parallel_examine(job, min(workers, corpus.total)) as examine:
            yield examine
        return
    with Examiner(job) as examiner:
        yield lambda worlds, _room: ((place, examiner.examine(at)) for place, at in worlds)


def _telling(examine: Examine, job: ConformJob, corpus: Corpus, tell: Progress | None) -> Examine:
    """The same, telling of each world that is finished."""

    def told(
        worlds: Iterator[Placed], room: Callable[[], bool]
    ) -> Iterator[tuple[int, WorldResult]]:
        for number, result in enumerate(examine(worlds, room), 1):
            if tell is not None:
                tell(job.target, number, corpus.total)
            yield result

    return told
