"""What a run in the arena came to, as data: for workers, the store and the table."""

from __future__ import annotations

import msgspec

from topo_verify.checkers import CLAIMS, Finding, Judgement, Status
from topo_verify.programs.loaded import Loaded
from topo_verify.robot.limits import Limits

KEPT_OF_RUN = 5
"""The most findings that are kept of one run."""


class ArenaTask(msgspec.Struct, frozen=True):
    """A run to be made.

    Attributes:
        mapper: the TARGET.
        world: the WORLD argument.
        memory: measure its memory instead: in a fresh process, unjudged.
    """

    mapper: str
    world: str
    memory: bool = False


class ClaimCount(msgspec.Struct, frozen=True, array_like=True):
    """The status of a claim in a run, and how much of the run it rests on."""

    status: Status
    judged: int
    of: int


class ArenaRun(msgspec.Struct, frozen=True, kw_only=True, tag="run"):
    """A run, judged by every claim.

    Attributes:
        edges: of the world.
        least: the least cost of a proof in it, in edge traversals.
        cost: of the run, in edge traversals.
        rejected_free, rejected_moving: hypotheses rejected without motion, and with.
        claims: of each claim, in their order; empty if there was no run to judge.
        findings: what is wrong, the first few.
        undecided: why nothing was decided, or None.
        seconds: that mapper and robot took.
    """

    mapper: str
    world: str
    edges: int
    least: int
    cost: int = 0
    rejected_free: int = 0
    rejected_moving: int = 0
    claims: tuple[ClaimCount, ...] = ()
    findings: tuple[Finding, ...] = ()
    undecided: str | None = None
    seconds: float = 0.0

    @property
    def task(self) -> ArenaTask:
        """What was to be done."""
        return ArenaTask(self.mapper, self.world)

    @property
    def ratio(self) -> float:
        """The cost as a multiple of the least cost of a proof."""
        return self.cost / self.least

    @property
    def judgements(self) -> tuple[Judgement, ...]:
        """The judgement of each claim, without its findings."""
        pairs = zip(CLAIMS, self.claims, strict=True) if self.claims else ()
        return tuple(Judgement(claim, one.status, one.judged, one.of) for claim, one in pairs)


class MemoryRun(msgspec.Struct, frozen=True, tag="memory"):
    """How much memory a mapper took at most, in a process of its own.

    Attributes:
        kibibytes: the peak of the resident set; None: the system does not tell.
    """

    mapper: str
    world: str
    kibibytes: int | None

    @property
    def task(self) -> ArenaTask:
        """What was to be done."""
        return ArenaTask(self.mapper, self.world, memory=True)


class KnownMapper(msgspec.Struct, frozen=True, tag="mapper"):
    """What a mapper rested on when its runs were made.

    Attributes:
        sources: a hash of the files that its TARGET names.
        loaded: what it had loaded until then.
    """

    mapper: str
    sources: str
    loaded: Loaded


class ArenaResult(msgspec.Struct, frozen=True):
    """What a worker says of a task: the run, and what the mapper has loaded if that is asked."""

    made: ArenaRun | MemoryRun
    loaded: Loaded | None = None


class ArenaJob(msgspec.Struct, frozen=True, kw_only=True):
    """What every worker is handed.

    Attributes:
        sources: for each mapper, a hash of topo_verify and the files that name it.
        limits: of each run.
        in_process: a mapper that is not of the catalogue shares the process of a worker.
        identify: results say what the mapper has loaded.
    """

    sources: dict[str, str]
    limits: Limits = Limits()
    in_process: bool = False
    identify: bool = False
