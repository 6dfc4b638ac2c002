"""Tries an implementation in every world of a corpus and counts the results on four levels.

    result      the map is the world, the cost is honest and within the bound
    claims      the declared decisions are sound and justified, and the history proves the map
    decisions   the run equals that of the reference, event for event
    cost        the cost relative to that of the reference

A run without a map has one finding, on level `result`. A world is undecided if the
implementation skips it, gives it up, or exceeds its time while it still moves, or if something
else may have ended its process.
"""

from __future__ import annotations

import re
import shlex
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any, Literal, NamedTuple, get_args

import msgspec
from msgspec.structs import asdict, replace

from topo_verify.campaign import campaign as c
from topo_verify.campaign.attempt import Attempt, Look, row_of
from topo_verify.campaign.progress import Progress
from topo_verify.campaign.row import Row
from topo_verify.campaign.run import explore
from topo_verify.campaign.tally import Counts
from topo_verify.campaign.targets import one_target
from topo_verify.checkers import Judgement
from topo_verify.checkers.findings import Verdict
from topo_verify.programs.loader import Target
from topo_verify.robot.events import write_trace
from topo_verify.studies.conform.likeness import Difference, Likeness, declares, first_difference
from topo_verify.studies.corpus import Corpus, CorpusWorlds
from topo_verify.world.formats import files

Level = Literal["result", "claims", "decisions", "cost"]

LEVELS: tuple[Level, ...] = get_args(Level)

LevelState = Literal["passed", "failed", "skipped", "errored", "undecided", "not-declared"]
"""Of a world on one level."""

RESULT = ("percepts-true", "map-isomorphic", "cost-honest", "cost-within-bound")
"""The claims of level `result`; all others belong to `claims`."""

KEPT_OF_WORLD, KEPT_OF_KIND = 5, 10
"""Findings of a world and a level; worlds of a kind of finding."""


class WorldFinding(msgspec.Struct, frozen=True, kw_only=True):
    """A `Finding` with its kind.

    Attributes:
        kind: what the program did instead of delivering a map (docs/oracle.md), `move-timeout`,
            `budget`, `no-map`, `decisions`; else the claim.
        difference: on level `decisions`, the first difference of the runs.
    """

    claim: str
    kind: str
    world: str
    event: int | None = None
    expected: Any = None
    seen: Any = None
    message: str
    witness: str | None = None
    replay: str = ""
    difference: Difference | None = None


@dataclass(frozen=True, slots=True)
class WorldOutcome:
    """The outcome of a row on each level; `why` if the world is undecided."""

    states: dict[Level, LevelState]
    findings: dict[Level, tuple[WorldFinding, ...]]
    why: str | None
    cost: int
    reference: int


def outcome_of(row: Row, like: str) -> WorldOutcome:
    """The outcome in one world; `like` is the algorithm to follow, if any."""
    note = None if row.note is None else msgspec.convert(row.note, Likeness)
    lost = row.ended != "map" and row.map is None
    open_ended = _open_ended(row)
    findings = [WorldFinding(kind=finding.claim, **asdict(finding)) for finding in row.findings]
    result = [finding for finding in findings if finding.claim in RESULT]
    claims = [finding for finding in findings if finding.claim not in RESULT]
    if row.ended != "map":
        result = [] if row.is_lost or open_ended else [_loss(row, note)]
    if lost:
        claims = [
            finding
            for finding in claims
            if finding.event is not None and finding.claim != "map-entailed"
        ]
    unproved = lost or any(finding.status == "undecided" for finding in row.claims)
    states: dict[Level, LevelState] = {
        "result": open_ended or ("failed" if result else "passed"),
        "claims": "failed" if claims else open_ended or ("undecided" if unproved else "passed"),
    }
    kept: dict[Level, tuple[WorldFinding, ...]] = {
        "result": tuple(result[:KEPT_OF_WORLD]),
        "claims": tuple(claims[:KEPT_OF_WORLD]),
    }
    if like:
        difference = None if note is None else note.difference
        states["decisions"] = _likeness(note, open_ended, lost=lost)
        failed = states["decisions"] == "failed"
        kept["decisions"] = (_parted(row, like, difference),) if difference and failed else ()
    states["cost"] = "passed" if not (lost or result) else open_ended or "undecided"
    why = row.stopped if open_ended else None
    if row.is_lost and "failed" not in states.values():
        for level in states:
            states[level] = "undecided"
        why = row.undecided
    return WorldOutcome(states, kept, why, row.cost, 0 if note is None else note.reference)


def _open_ended(row: Row) -> LevelState | None:
    if row.ended in ("skip", "error"):
        return "skipped" if row.ended == "skip" else "errored"
    # A run stopped by another limit stands still or walks for ever.
    late = row.ended == "world-timeout" or (row.timed_out and row.undecided is not None)
    return "undecided" if late else None


def _loss(row: Row, note: Likeness | None) -> WorldFinding:
    detail = "" if note is None else note.detail
    return WorldFinding(
        claim="map-isomorphic",
        kind=row.ended,
        world=row.world,
        expected="a map",
        message=f"no map was delivered: {row.stopped}{detail}",
    )


def _likeness(note: Likeness | None, open_ended: LevelState | None, *, lost: bool) -> LevelState:
    if note is None:
        return "undecided"
    if note.difference is None:
        return "not-declared" if note.silent else "passed"
    if note.difference.seen is None and lost:
        return open_ended or "undecided"
    return "failed"


def _parted(row: Row, like: str, difference: Difference) -> WorldFinding:
    ours, theirs = (side or "does nothing more" for side in (difference.expected, difference.seen))
    return WorldFinding(
        claim="decisions",
        kind="decisions",
        world=row.world,
        event=difference.event,
        expected=difference.expected,
        seen=difference.seen,
        message=f"{like} {ours}; the mapper {theirs}",
        difference=difference,
    )


# ---------------------------------------------------------------- what is noted of a run

TRANSCRIPT = {"format": "topo-verify/transcript", "version": 1}
"""The head of a transcript."""


class Asked(NamedTuple):
    """What is asked about a run, as texts for other processes.

    Attributes:
        like: the algorithm whose decisions it should make, or empty.
        pick, order: policies of the reference.
        transcript: a folder, or empty.
    """

    like: str = ""
    pick: str = "nearest"
    order: str = "shortest"
    transcript: str = ""

    @property
    def name(self) -> str:
        """The algorithm that costs and decisions are compared with."""
        return self.like or "basic"

    @property
    def reference(self) -> Target:
        """The same, ready to run; InputError if there is no such algorithm or policy."""
        return one_target(self.name, pick=self.pick, order=self.order)


def look(*texts: str) -> Look:
    """Note how runs differ from the reference's; `texts` are the fields of `Asked`."""
    asked = Asked(*texts)
    reference = asked.reference

    def noted(attempt: Attempt) -> Likeness:
        run, world = attempt.run, attempt.run.world
        like = explore(world, reference)
        note = Likeness(
            like.cost,
            bool(world.edges) and not declares(run.trace),
            first_difference(like.trace, run.trace) if asked.like else None,
            "" if run.misbehaved is None else run.misbehaved.detail,
        )
        if asked.transcript:
            row = replace(row_of(attempt, attempt.report.world, 0), note=note)
            outcome = outcome_of(row, asked.like)
            if any(outcome.findings.values()):
                _keep(asked.transcript, attempt, outcome)
        return note

    return noted


def _keep(folder: str, attempt: Attempt, outcome: WorldOutcome) -> None:
    world, run = attempt.report.world, attempt.run
    if attempt.lines is None:
        text = write_trace(run.kept_trace)
    else:
        head = {**TRANSCRIPT, "world": world, "target": run.algorithm, "stopped": run.stopped}
        rows: list[object] = [head]
        rows += [
            {"to" if way == ">" else "from": line.decode(errors="backslashreplace")}
            for way, line in attempt.lines
        ]
        rows += [
            {"found": finding.message} for level in outcome.findings.values() for finding in level
        ]
        text = msgspec.json.Encoder().encode_lines(rows)
    files.write(Path(folder) / f"{file_name(world)}.jsonl", text)


def file_name(world: str) -> str:
    """A file name for a world, valid everywhere and unique."""
    name = re.sub(r"[^A-Za-z0-9_.=,()-]", "-", world)
    plain = re.fullmatch(r"m[0-9]+/[0-9]+", world) or name == world
    tag = "" if plain and len(name) <= 80 else f"-{sha256(world.encode()).hexdigest()[:8]}"
    return name[:80] + tag


# ---------------------------------------------------------------- many worlds

MOST_TIMEOUTS = 20
"""Time-outs after which the rest of the corpus is not tried."""


class CostRatio(msgspec.Struct, frozen=True):
    """Edge traversals summed up over the worlds that the implementation maps correctly.

    Attributes:
        ratio: relative to the reference; null if its cost is 0.
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
        like: the algorithm that its decisions and its cost are compared with.
        level: result, claims, decisions or cost.
        worlds: their number; each counts in one of the next seven.
        passed, failed: judged on this level.
        skipped, errored: the program declined the world, or gave it up.
        undecided: out of time though it moved on, or nothing to judge on this level.
        not_declared: the same moves, but no decisions to compare.
        not_tried: time-outs or an interrupt ended the work before.
        kinds: the number of worlds with each kind of finding.
        claims, judgements: of this level, over all runs.
        findings: of the first failing worlds of each kind.
        cost: over all worlds; priced: on level `cost`, world by world.
        why: the reasons of the first undecided worlds.
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


class Conform:
    """An implementation in every world of a corpus: `work`, then `level_results` in any case.

    `again` is the command line that repeats this, without the world. InputError: there is no
    such algorithm or policy to compare with.
    """

    def __init__(
        self, campaign: c.Campaign, corpus: Corpus, asked: Asked, again: Sequence[str] = ()
    ) -> None:
        look(*asked)
        self.campaign = replace(
            campaign,
            worlds=c.ListedWorlds(corpus.total),
            record=bool(asked.transcript),
            stop=c.Stop(timeouts=MOST_TIMEOUTS, still=c.MAX_TIMEOUTS),
            look=f"{__name__}:{look.__name__}",
            asked=tuple(asked),
        )
        self.corpus, self.asked, self.again = corpus, asked, again
        levels: list[Level] = [level for level in LEVELS if asked.like or level != "decisions"]
        states: dict[Level, Counter[LevelState]] = {level: Counter() for level in levels}
        self._states = states
        self._kinds = {level: Counter[str]() for level in levels}
        self._findings = {level: list[WorldFinding]() for level in levels}
        self._whys: list[str] = []
        self._counts = Counts()
        self.priced: list[WorldCost] = []
        self.tried = 0
        self._worlds = CorpusWorlds(corpus)

    @property
    def target(self) -> str:
        """The implementation under test."""
        return self.campaign.mappers[0]

    def work(self, backend: c.Backend, tell: Progress | None = None) -> None:
        """Try the implementation in every world, or as far as the campaign goes.

        After Ctrl-C, `level_results` has the worlds before it.
        """
        for _, result in c.results(self.campaign, backend, CorpusWorlds(self.corpus), tell=tell):
            for row in result.rows:
                self.enter(row)

    def enter(self, row: Row) -> None:
        """Count one world; places must not decrease."""
        self.tried += 1
        outcome = outcome_of(row, self.asked.like)
        for level, state in outcome.states.items():
            self._states[level][state] += 1
            findings = outcome.findings.get(level, ())
            self._kinds[level].update([*dict.fromkeys(finding.kind for finding in findings)])
            for finding in findings:
                if self._kinds[level][finding.kind] <= KEPT_OF_KIND:
                    words = (*self.again, *self._worlds.at(row.place).replay_arguments)
                    self._findings[level].append(replace(finding, replay=shlex.join(words)))
        if outcome.why is not None and len(self._whys) < KEPT_OF_KIND:
            self._whys.append(f"{row.world}: {outcome.why}")
        if row.claims and outcome.states["result"] in ("passed", "failed"):
            self._counts.enter([row])
        if outcome.states["cost"] == "passed":
            ratio = _ratio(outcome.cost, outcome.reference)
            self.priced.append(WorldCost(row.world, outcome.cost, outcome.reference, ratio))

    def level_results(self) -> Iterator[LevelResult]:
        """The result on each level, of the worlds so far."""
        mapper = sum(price.mapper for price in self.priced)
        paid = sum(price.reference for price in self.priced)
        total = CostRatio(mapper, paid, _ratio(mapper, paid))
        tally = self._counts.tally()
        for level, states in self._states.items():
            numbers = {name: states[name] for name in get_args(LevelState)}
            claims = {
                claim: runs
                for claim, runs in tally.statuses.items()
                if level == ("result" if claim in RESULT else "claims")
            }
            yield LevelResult(
                target=self.target,
                like=self.asked.name,
                level=level,
                worlds=self.corpus.total,
                **{name.replace("-", "_"): number for name, number in numbers.items()},
                not_tried=self.corpus.total - self.tried,
                verdict=self._verdict(numbers),
                kinds=dict(self._kinds[level]),
                claims=claims,
                judgements=replace(tally, statuses=claims).judgements(),
                findings=tuple(self._findings[level]),
                cost=total,
                priced=tuple(self.priced) if level == "cost" else (),
                why=tuple(self._whys) if level == "result" else (),
            )

    def _verdict(self, numbers: dict[LevelState, int]) -> Verdict:
        if numbers["failed"]:
            return "REFUTED"
        if numbers["passed"] < self.corpus.total:
            return "UNKNOWN"
        return "EXHAUSTED" if self.corpus.finite else "SAMPLED"
