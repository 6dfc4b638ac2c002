"""An implementation in every world of a corpus: how it stands on each level.

Outcomes are taken to the books in the order of the corpus, so the books are the same for any number
of workers. After some time-outs enough is seen: what is left is not tried.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import ExitStack, closing
from dataclasses import dataclass, field

import msgspec

from topo_verify.checkers import CLAIMS
from topo_verify.checkers.findings import Verdict
from topo_verify.harness.conform.batch import BatchExaminer
from topo_verify.harness.conform.examiner import Examiner
from topo_verify.harness.conform.outcome import LEVELS, RESULT, Found, Job, Level, Outcome
from topo_verify.harness.conform.parallel import outcomes
from topo_verify.harness.corpus import Corpus
from topo_verify.harness.progress import Progress

PATIENCE = 20
"""After so many time-outs enough is seen."""

KEPT = 10
"""Of so many failing worlds of each kind the findings are kept."""


class Cost(msgspec.Struct, frozen=True):
    """Edge traversals, over the worlds that the implementation maps rightly.

    Attributes:
        ratio: what it pays for each edge traversal of the reference's.
    """

    mapper: int
    reference: int
    ratio: float | None


class Priced(msgspec.Struct, frozen=True):
    """What the implementation pays in one world."""

    world: str
    mapper: int
    reference: int
    ratio: float | None


def _ratio(mapper: int, reference: int) -> float | None:
    return round(mapper / reference, 4) if reference else None


class Standing(msgspec.Struct, frozen=True, kw_only=True):
    """How an implementation stands on one level.

    Attributes:
        target: the implementation.
        like: the algorithm that its decisions and its cost are compared with.
        level: result, claims, decisions or cost.
        worlds: how many there are; each is in one of the next seven numbers.
        skipped, errored: the program said so.
        undecided: out of time though it moved on; or no map, and so nothing to judge on this level.
        not_declared: the same moves, but no decisions to compare.
        not_tried: after too many time-outs, or an interrupt.
        kinds: in how many worlds each kind of finding is met.
        claims: of the claims of this level, in how many runs each was ok, failed, not-declared …
        findings: of the first failing worlds.
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
    findings: tuple[Found, ...]
    cost: Cost
    priced: tuple[Priced, ...] = ()
    why: tuple[str, ...] = ()


@dataclass
class _Level:
    """The books of one level."""

    states: dict[str, int] = field(default_factory=dict[str, int])
    kinds: dict[str, int] = field(default_factory=dict[str, int])
    findings: list[Found] = field(default_factory=list[Found])
    whys: list[str] = field(default_factory=list[str])

    def enter(self, made: Outcome, level: Level) -> None:
        state = made.states[level]
        self.states[state] = self.states.get(state, 0) + 1
        found = made.findings.get(level, ())
        for kind in dict.fromkeys(one.kind for one in found):
            self.kinds[kind] = self.kinds.get(kind, 0) + 1
            if self.kinds[kind] <= KEPT:
                self.findings += [one for one in found if one.kind == kind]
        if made.why is not None and level == "result" and len(self.whys) < KEPT:
            self.whys.append(f"{made.world}: {made.why}")


class Books:
    """The books of a run. Life cycle: `enter` outcomes in their order, `standings` at any time."""

    def __init__(self, job: Job, corpus: Corpus) -> None:
        self.job, self.total, self.finite = job, corpus.total, corpus.finite
        self.levels: dict[Level, _Level] = {
            level: _Level() for level in LEVELS if job.like is not None or level != "decisions"
        }
        self.claims: dict[str, dict[str, int]] = {claim: {} for claim in CLAIMS}
        self.priced: list[Priced] = []
        self.timeouts = self.tried = 0

    def enter(self, made: Outcome) -> None:
        """One world."""
        self.tried += 1
        self.timeouts += made.timeout
        for level, books in self.levels.items():
            books.enter(made, level)
        for claim, status in made.claims.items():
            self.claims[claim][status] = self.claims[claim].get(status, 0) + 1
        if made.states["cost"] == "passed":
            ratio = _ratio(made.cost, made.reference)
            self.priced.append(Priced(made.world, made.cost, made.reference, ratio))

    @property
    def enough(self) -> bool:
        """Is enough seen?"""
        return self.timeouts >= PATIENCE

    def standings(self) -> Iterator[Standing]:
        """What stands in the books, level by level."""
        mapper = sum(one.mapper for one in self.priced)
        paid = sum(one.reference for one in self.priced)
        total = Cost(mapper, paid, _ratio(mapper, paid))
        for level, books in self.levels.items():
            numbers = {name: books.states.get(name, 0) for name in _STATES}
            claims = {
                claim: seen
                for claim, seen in self.claims.items()
                if level in ("result", "claims") and (claim in RESULT) == (level == "result")
            }
            yield Standing(
                target=self.job.target,
                like=self.job.reference,
                level=level,
                worlds=self.total,
                **{name.replace("-", "_"): number for name, number in numbers.items()},
                not_tried=self.total - self.tried,
                verdict=self._verdict(numbers),
                kinds=books.kinds,
                claims=claims,
                findings=tuple(books.findings),
                cost=total,
                priced=tuple(self.priced) if level == "cost" else (),
                why=tuple(books.whys),
            )

    def _verdict(self, numbers: dict[str, int]) -> Verdict:
        if numbers["failed"]:
            return "REFUTED"
        if numbers["passed"] < self.total:
            return "UNKNOWN"
        return "EXHAUSTED" if self.finite else "SAMPLED"


_STATES = ("passed", "failed", "skipped", "errored", "undecided", "not-declared")


def conform(
    job: Job,
    corpus: Corpus,
    books: Books,
    *,
    workers: int = 0,
    batch: bool = False,
    tell: Progress | None = None,
) -> None:
    """Take what becomes of every world of the corpus to the books.

    Args:
        workers: so many processes; 0: this one alone.
        batch: the program reads worlds and writes runs; one process does it.
        tell: told how far the work is.
    Raises:
        InputError: there is no such mapper, program, algorithm or policy.
    """
    with ExitStack() as stack:
        found: Iterable[Outcome]
        if batch:
            found = stack.enter_context(BatchExaminer(job)).examine(corpus)
        elif workers:
            parallel = outcomes(job, corpus, min(workers, corpus.total))
            found = stack.enter_context(closing(parallel))
        else:
            examiner = stack.enter_context(Examiner(job))
            found = map(examiner.examine, corpus)
        for made in found:
            books.enter(made)
            if tell is not None:
                tell(job.target, books.tried, corpus.total)
            if books.enough:
                break
