"""The account of a run of a command: what was judged, how much of it, and what to look at.

A command that judges says it once, as an `Account`; the page, the JUnit file and the badge are
three forms of it. It holds no time and no date, so the same run has the same account.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any, Literal, NamedTuple

from topo_verify.checkers import Judgement, Status
from topo_verify.checkers.findings import Verdict
from topo_verify.player.recording import PlayedRun
from topo_verify.report.blocks import Block, Tone
from topo_verify.world.rooted_map import World

Outcome = Literal["passed", "failed", "undecided", "not-judged"]
"""`undecided`: nothing is refuted, and it is no pass. `not-judged`: it was not asked, or not of
all; that is neither a pass nor a failure."""

TONE_OF: dict[Outcome, Tone | None] = {
    "passed": "held",
    "failed": "failed",
    "undecided": "open",
    "not-judged": None,
}


@dataclass(frozen=True)
class JudgedCase:
    """One thing that was judged.

    Attributes:
        name: of a claim, a part, a theorem, a fault.
        verdict: the word for the result: a verdict, or the status of a claim.
        judged: how much of how much it rests on, as `3 of 5`; empty where nothing is counted.
        message: what is wrong, or why it was not judged.
        again: the command line that shows this case; empty: that of the suite does.
    """

    name: str
    verdict: str
    outcome: Outcome
    judged: str = ""
    message: str = ""
    again: str = ""

    @property
    def tone(self) -> Tone | None:
        """A passed SAMPLED is sampled; else the outcome says it."""
        if self.outcome == "passed" and self.verdict == "SAMPLED":
            return "sampled"
        return TONE_OF[self.outcome]


UNFINISHED = JudgedCase(
    "came to its end", "UNKNOWN", "undecided", message="interrupted: the rest was not judged"
)
"""The case of a run that was interrupted."""


class JudgedSuite(NamedTuple):
    """Cases that belong together."""

    name: str
    cases: tuple[JudgedCase, ...]


def suites(named: Iterable[tuple[str, Iterable[JudgedCase]]]) -> tuple[JudgedSuite, ...]:
    """The suites with these names and cases."""
    return tuple(JudgedSuite(name, tuple(cases)) for name, cases in named)


@dataclass(frozen=True)
class JudgedExtent:
    """The verdict on all, and how much was checked: `8,954 of 8,954 worlds`."""

    verdict: Verdict
    words: str


@dataclass(frozen=True)
class Exhibit:
    """A world to be looked at, mostly because something is wrong in it.

    Attributes:
        title: which mapper, in which world.
        world: the world.
        name: what the command line calls it.
        notes: what is wrong there, a sentence each.
        runs: to be played, the first one first; none: the world is shown alone.
        again: the command line that shows it again.
        whole: it is drawn and played however large it is.
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
    """The outcome of a run of a command.

    Attributes:
        about: what was checked, in a few words.
        extent: the verdict on all of it.
        suites: everything that was judged.
        blocks: what the command says about it; none: what it prints.
        exhibits: the counterexamples that are shown.
        left_out: how many more there are.
        others: worlds in which nothing is wrong, to be looked at.
        results_first: a page shows the results before what was judged.
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
    """How a run of a command ended: what its account leaves out.

    Attributes:
        command: of topo-verify, as `verify`.
        again: the command line that repeats the run.
        code: the exit code.
        finished: whether the work was completed.
        date: when the work ended, in UTC.
        seconds: how long it took.
        by_suite: how long each suite took, if that is known.
        timing: what else differs from run to run, by name; a value may be such a mapping.
        versions: of the package, of Python and of the libraries that take part.
    """

    command: str
    again: str
    code: int
    finished: bool
    date: datetime
    seconds: float
    by_suite: Sequence[float] = ()
    timing: Mapping[str, Any] = field(default_factory=dict[str, Any])
    versions: Mapping[str, str] = field(default_factory=dict[str, str])


_OUTCOMES: dict[Status, Outcome] = {
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
    """A case for each claim: its status, and how much of the runs it rests on."""
    for one in judgements:
        first = one.findings[0] if one.findings else None
        yield JudgedCase(
            name=one.claim,
            verdict=one.status,
            outcome=_OUTCOMES[one.status],
            judged=f"{one.judged:,} of {one.of:,}",
            message=_reason(one) if first is None else first.message,
            again="" if first is None else first.replay,
        )


def _reason(one: Judgement) -> str:
    """Why a claim without a finding was not fully judged; "" if it was."""
    if one.claim == "map-entailed" and one.status in ("partial", "not-declared"):
        return "the mapper delivers no map" + " in some worlds" * (one.status == "partial")
    return _REASONS.get(one.status, "")


def verdict_case(
    name: str, verdict: str, judged: str = "", message: str = "", again: str = ""
) -> JudgedCase:
    """A case with this verdict, where no REFUTED is expected."""
    outcomes: dict[str, Outcome] = {"REFUTED": "failed", "UNKNOWN": "undecided"}
    return JudgedCase(name, verdict, outcomes.get(verdict, "passed"), judged, message, again)


def joint_verdict(verdicts: Sequence[str]) -> Verdict:
    """The verdict on several things: a refutation, else the one that says least."""
    for verdict in _WEAKEST:
        if verdict in verdicts:
            return verdict
    return "UNKNOWN"


_WEAKEST: tuple[Verdict, ...] = ("REFUTED", "UNKNOWN", "SAMPLED", "EXHAUSTED", "PROVED")


def counted(number: int, total: int, things: str) -> str:
    """How many of how many: `8,954 of 8,954 worlds`."""
    return f"{number:,} of {total:,} {things}"


def worlds(number: int) -> str:
    """The noun behind a number of worlds."""
    return "world" if number == 1 else "worlds"


def extent(
    verdict: Verdict, checked: int, total: int, failing: int, things: str = ""
) -> JudgedExtent:
    """The extent of a search or of trials, by its verdict."""
    if verdict == "REFUTED":
        things = things or worlds(checked)
        return JudgedExtent(verdict, counted(failing, checked, f"{things} fail"))
    return JudgedExtent(verdict, counted(checked, total, things or worlds(total)))
