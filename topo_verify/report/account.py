"""The account of a command's run: what was judged, how much of it, and what to look at.

It holds no time and no date, so the same run gives the same account.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any, Literal, NamedTuple

from topo_verify.checkers import Judgement, Status
from topo_verify.checkers.findings import Verdict
from topo_verify.pictures.recording import PlayedRun
from topo_verify.report.blocks import Block, Tone
from topo_verify.world.rooted_map import World

CaseOutcome = Literal["passed", "failed", "undecided", "not-judged"]
"""`undecided` is no pass; `not-judged` is neither pass nor failure."""

TONE_OF: dict[CaseOutcome, Tone | None] = {
    "passed": "held",
    "failed": "failed",
    "undecided": "open",
    "not-judged": None,
}


@dataclass(frozen=True)
class JudgedCase:
    """A claim, a part, a theorem or a fault, with its verdict.

    Attributes:
        verdict: a verdict, or the status of a claim.
        judged: how much it rests on, as `3 of 5`.
        message: what is wrong, or why it was not judged.
        again: the command line that shows this case; empty: that of the run.
    """

    name: str
    verdict: str
    outcome: CaseOutcome
    judged: str = ""
    message: str = ""
    again: str = ""

    @property
    def tone(self) -> Tone | None:
        """The outcome's tone; `sampled` for a passed SAMPLED."""
        if self.outcome == "passed" and self.verdict == "SAMPLED":
            return "sampled"
        return TONE_OF[self.outcome]


UNFINISHED = JudgedCase(
    "finished", "UNKNOWN", "undecided", message="interrupted: the rest was not judged"
)


class JudgedSuite(NamedTuple):
    """Cases that belong together."""

    name: str
    cases: tuple[JudgedCase, ...]


def suites(named: Iterable[tuple[str, Iterable[JudgedCase]]]) -> tuple[JudgedSuite, ...]:
    """Make a suite of each name with its cases."""
    return tuple(JudgedSuite(name, tuple(cases)) for name, cases in named)


@dataclass(frozen=True)
class JudgedExtent:
    """The verdict on everything, and how much was checked: `8,954 of 8,954 worlds`."""

    verdict: Verdict
    words: str


@dataclass(frozen=True)
class Exhibit:
    """A world to show, mostly because something is wrong in it.

    Attributes:
        name: the world, as the command line names it.
        notes: what is wrong, a sentence each.
        runs: to be played; none: the world is shown alone.
        whole: draw and play it whatever its size.
    """

    title: str
    world: World
    name: str
    notes: tuple[str, ...]
    runs: tuple[PlayedRun, ...] = ()
    again: str = ""
    whole: bool = False


@dataclass(frozen=True)
class Account:
    """The outcome of a command's run.

    Attributes:
        about: what was checked, in a few words.
        exhibits, left_out: the counterexamples shown, and the number of others.
        others: worlds to show in which nothing is wrong.
        results_first: a page shows the results before what was judged, and its headline says
            no REFUTED: in a ranking some wrong mappers are normal.
    """

    about: str
    extent: JudgedExtent
    suites: tuple[JudgedSuite, ...]
    blocks: tuple[Block, ...] = ()
    exhibits: tuple[Exhibit, ...] = ()
    left_out: int = 0
    others: tuple[Exhibit, ...] = ()
    results_first: bool = False


@dataclass(frozen=True)
class Ending:
    """How a command's run ended: what its account leaves out.

    Attributes:
        again: the command line that repeats the run.
        date: the end in UTC.
        unwritten: why files could not be written, a sentence each.
        by_suite: the seconds of each suite, if known.
        timing: other figures that differ from run to run, possibly nested.
    """

    command: str
    again: str
    code: int
    finished: bool
    date: datetime
    seconds: float
    unwritten: Sequence[str] = ()
    by_suite: Sequence[float] = ()
    timing: Mapping[str, Any] = field(default_factory=dict[str, Any])
    versions: Mapping[str, str] = field(default_factory=dict[str, str])

    @property
    def missing(self) -> list[JudgedCase]:
        """A case for each thing that keeps the run from its end."""
        unwritten = [
            JudgedCase("written", "UNKNOWN", "undecided", message=m) for m in self.unwritten
        ]
        return [*([] if self.finished else [UNFINISHED]), *unwritten]


_OUTCOMES: dict[Status, CaseOutcome] = {
    "ok": "passed",
    "failed": "failed",
    "undecided": "undecided",
    "partial": "not-judged",
    "not-declared": "not-judged",
    "not-asked": "not-judged",
}

_REASONS: dict[Status, str] = {
    "partial": "the mapper declares only some of the decisions that the claim speaks of",
    "not-declared": "the mapper declares nothing that the claim speaks of",
    "not-asked": "not asked in a world of this size without --strict",
    "undecided": "neither proved nor refuted",
}


def claim_cases(judgements: Iterable[Judgement]) -> Iterator[JudgedCase]:
    """A case for each claim."""
    for judgement in judgements:
        first = judgement.findings[0] if judgement.findings else None
        yield JudgedCase(
            name=judgement.claim,
            verdict=judgement.status,
            outcome=_OUTCOMES[judgement.status],
            judged=f"{judgement.judged:,} of {judgement.of:,}",
            message=_reason(judgement) if first is None else first.message,
            again="" if first is None else first.replay,
        )


def _reason(judgement: Judgement) -> str:
    if judgement.claim == "map-entailed" and judgement.status in ("partial", "not-declared"):
        where = " in some worlds" if judgement.status == "partial" else ""
        return f"the mapper delivers no map{where}"
    return _REASONS.get(judgement.status, "")


def verdict_case(
    name: str, verdict: str, judged: str = "", message: str = "", again: str = ""
) -> JudgedCase:
    """A case with this verdict, where REFUTED is a failure."""
    outcomes: dict[str, CaseOutcome] = {"REFUTED": "failed", "UNKNOWN": "undecided"}
    return JudgedCase(name, verdict, outcomes.get(verdict, "passed"), judged, message, again)


def joint_verdict(verdicts: Sequence[str]) -> Verdict:
    """The weakest of these verdicts; UNKNOWN if there are none."""
    weakest: list[Verdict] = [verdict for verdict in _WEAKEST if verdict in verdicts]
    return weakest[0] if weakest else "UNKNOWN"


_WEAKEST: tuple[Verdict, ...] = ("REFUTED", "UNKNOWN", "SAMPLED", "EXHAUSTED", "PROVED")


def counted(number: int, total: int, things: str) -> str:
    """`8,954 of 8,954 worlds`."""
    return f"{number:,} of {total:,} {things}"


def worlds(number: int) -> str:
    """The noun "world" or "worlds" for a number."""
    return "world" if number == 1 else "worlds"


def extent(
    verdict: Verdict, checked: int, total: int, failing: int, things: str = ""
) -> JudgedExtent:
    """The extent of a search or of trials."""
    if verdict == "REFUTED":
        things = things or worlds(checked)
        return JudgedExtent(verdict, counted(failing, checked, f"{things} fail"))
    return JudgedExtent(verdict, counted(checked, total, things or worlds(total)))
