"""An implementation in every world of a corpus, counted level by level.

Each world is a row of a campaign, and what a level says of it is a view of that row. After
`MAX_TIMEOUTS` time-outs the rest of the corpus is not tried: each may cost a whole time limit.
"""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import get_args

import msgspec

from topo_verify.campaign.campaign import (
    Backend,
    Campaign,
    CorpusWorlds,
    ListedWorlds,
    Stop,
    results,
)
from topo_verify.campaign.corpus import Corpus
from topo_verify.campaign.progress import Progress
from topo_verify.campaign.row import Row
from topo_verify.campaign.tally import Tally
from topo_verify.checkers import CLAIMS, Judgement
from topo_verify.checkers.findings import Verdict
from topo_verify.studies.conform import outcome as levels
from topo_verify.studies.conform.outcome import (
    LEVELS,
    RESULT,
    Level,
    LevelState,
    WorldFinding,
    WorldOutcome,
    outcome_of,
)

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

    states: Counter[LevelState] = field(default_factory=Counter[LevelState])
    kinds: Counter[str] = field(default_factory=Counter[str])
    findings: list[WorldFinding] = field(default_factory=list[WorldFinding])
    whys: list[str] = field(default_factory=list[str])

    def enter(self, outcome: WorldOutcome, level: Level) -> list[WorldFinding]:
        """Count one world; the findings that are to be kept."""
        self.states[outcome.states[level]] += 1
        found = outcome.findings.get(level, ())
        self.kinds.update(dict.fromkeys((one.kind for one in found), 1))
        return [one for one in found if self.kinds[one.kind] <= KEPT]


class Conform:
    """An implementation in every world of a corpus.

    Life cycle: `work`, then `level_results`, also if the work was cut off.

    Args:
        campaign: one implementation, and how it is run.
        again: the command line that asks for this again, without the world.
    Raises:
        InputError: there is no such algorithm or policy to compare it with.
    """

    def __init__(
        self, campaign: Campaign, corpus: Corpus, asked: levels.Asked, again: Sequence[str] = ()
    ) -> None:
        levels.look(*asked)  # before anything is started: the message is then the first
        self.campaign = msgspec.structs.replace(
            campaign,
            worlds=ListedWorlds(corpus.total),
            record=bool(asked.transcript),
            stop=Stop(timeouts=MAX_TIMEOUTS),
            look=f"{levels.__name__}:{levels.look.__name__}",
            asked=tuple(asked),
        )
        self.corpus, self.asked, self.again = corpus, asked, again
        self.levels: dict[Level, _LevelCounts] = {
            level: _LevelCounts() for level in LEVELS if self.asked.like or level != "decisions"
        }
        self.claims = {claim: Counter[str]() for claim in CLAIMS}
        self.shares: dict[str, tuple[int, int]] = dict.fromkeys(CLAIMS, (0, 0))
        self.priced: list[WorldCost] = []
        self.tried = 0
        self._worlds = CorpusWorlds(corpus)

    @property
    def target(self) -> str:
        """The implementation."""
        return self.campaign.mappers[0]

    def work(self, backend: Backend, tell: Progress | None = None) -> None:
        """Try the implementation in every world, or as far as the campaign says.

        Raises:
            KeyboardInterrupt: Ctrl-C; `level_results` has what was found before.
            InputError: there is no such mapper or program.
        """
        for _, result in results(self.campaign, backend, CorpusWorlds(self.corpus), tell=tell):
            for row in result.rows:
                self.enter(row)

    def enter(self, row: Row) -> None:
        """Count one world; later ones have later places."""
        self.tried += 1
        outcome = outcome_of(row, self.asked.like)
        for level, counts in self.levels.items():
            for found in counts.enter(outcome, level):
                words = (*self.again, *self._worlds.at(row.place).replay_arguments)
                again = msgspec.structs.replace(found, replay=shlex.join(words))
                counts.findings.append(again)
        whys = self.levels["result"].whys
        if outcome.why is not None and len(whys) < KEPT:
            whys.append(f"{row.world}: {outcome.why}")
        # A run that was not decided decides no claim: it delivered no map, but nothing is wrong.
        decided = outcome.states["result"] in ("passed", "failed")
        for one in row.judgements if decided else ():
            self.claims[one.claim][one.status] += 1
            judged, of = self.shares[one.claim]
            self.shares[one.claim] = judged + one.judged, of + one.of
        if outcome.states["cost"] == "passed":
            ratio = _ratio(outcome.cost, outcome.reference)
            self.priced.append(WorldCost(row.world, outcome.cost, outcome.reference, ratio))

    def level_results(self) -> Iterator[LevelResult]:
        """The result on each level, of the worlds that were entered so far."""
        mapper = sum(one.mapper for one in self.priced)
        paid = sum(one.reference for one in self.priced)
        total = CostRatio(mapper, paid, _ratio(mapper, paid))
        for level, counts in self.levels.items():
            numbers = {name: counts.states[name] for name in get_args(LevelState)}
            claims = {
                claim: dict(seen)
                for claim, seen in self.claims.items()
                if level in ("result", "claims") and (claim in RESULT) == (level == "result")
            }
            judgements = Tally(statuses=claims, shares=self.shares).judgements()
            yield LevelResult(
                target=self.target,
                like=self.asked.name,
                level=level,
                worlds=self.corpus.total,
                **{name.replace("-", "_"): number for name, number in numbers.items()},
                not_tried=self.corpus.total - self.tried,
                verdict=self._verdict(numbers),
                kinds=dict(counts.kinds),
                claims=claims,
                judgements=judgements,
                findings=tuple(counts.findings),
                cost=total,
                priced=tuple(self.priced) if level == "cost" else (),
                why=tuple(counts.whys),
            )

    def _verdict(self, numbers: dict[LevelState, int]) -> Verdict:
        if numbers["failed"]:
            return "REFUTED"
        if numbers["passed"] < self.corpus.total:
            return "UNKNOWN"
        return "EXHAUSTED" if self.corpus.finite else "SAMPLED"
