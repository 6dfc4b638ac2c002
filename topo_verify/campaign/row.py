"""A row: what one mapper did in one world, judged by every claim, as frozen data.

    attempt(world, target, ...)    runs the mapper and judges the run     -> Attempt
    row_of(attempt, ...)           the same as data                       -> Row
    lost_row(...)                  the run that took its process with it  -> Row

Every command that reports about runs reads rows. A row never holds an object of a mapper's: it is
what another process would have sent.

**The second try.** A program, or a mapper in a process of its own, may be killed by what it does or
by something else: a system without memory sends SIGKILL. So the world is tried again. If the mapper
fails again, the first run counts. If it passes, a crash is still a finding, and SIGKILL leaves the
world undecided.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from hashlib import sha256
from typing import Any

import msgspec

from topo_verify.campaign.judge import Report, judge, replay_line, undecided
from topo_verify.campaign.run import Exploration, explore
from topo_verify.checkers import CLAIMS, Finding, Judgement, Status
from topo_verify.errors import InputError
from topo_verify.programs.loader import Target
from topo_verify.programs.program import Program, TranscriptLine
from topo_verify.robot import events as ev
from topo_verify.robot.limits import Limits
from topo_verify.robot.stopwatch import Stopwatch
from topo_verify.world.enumeration import rank_order
from topo_verify.world.rooted_map import World

OUTSIDE = "perhaps for a reason outside; the second try passed"
"""What is said of a run that was lost once."""

KEPT_FINDINGS = 5
"""The most findings of each claim that a row keeps."""

SECOND_TRY = "; at the second try it delivered one"
"""How `stopped` ends if a first try lost its process and a second one passed."""


class Judged(msgspec.Struct, frozen=True, array_like=True):
    """The status of a claim in a run, and how much of the run it rests on."""

    status: Status
    judged: int
    of: int


class PolicyCosts(msgspec.Struct, frozen=True):
    """What any choices of a mapper can cost, in edge traversals.

    Attributes:
        worlds: in how many worlds; those in which no claim fails, whatever is chosen.
        states, choices: the number of states with more than one way, and of their ways.
        cheapest, reference, dearest: sums of costs: the least that a run can cost in each world,
            what the reference policies cost, the most.
        most_saved: where the cheapest run saves the greatest share: world, reference, cheapest.
    """

    worlds: int = 0
    states: int = 0
    choices: int = 0
    cheapest: int = 0
    reference: int = 0
    dearest: int = 0
    most_saved: tuple[str, int, int] | None = None

    def __add__(self, other: PolicyCosts) -> PolicyCosts:
        saved = [costs.most_saved for costs in (self, other) if costs.most_saved is not None]
        return PolicyCosts(
            self.worlds + other.worlds,
            self.states + other.states,
            self.choices + other.choices,
            self.cheapest + other.cheapest,
            self.reference + other.reference,
            self.dearest + other.dearest,
            max(saved, key=lambda one: 1 - one[2] / one[1], default=None),
        )


class Row(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """What one mapper did in one world.

    Attributes:
        world: its name, as the command line names it.
        vertices, edges: the size of the world.
        place: its rank among the worlds of its size, or its place in a list.
        turn: the number of runs in the same world before this one.
        least: the least cost of a proof in it, in edge traversals.
        mapper: the TARGET.
        policies: `pick` and `order` of an algorithm of the catalogue; None: it has none.
        cost: edge traversals.
        free, moving: hypotheses rejected without motion, and with motion.
        confirmed: hypotheses confirmed.
        claims: the judgement of each claim, in the order of `CLAIMS`; empty if there was no run.
        findings: what is wrong, at most `KEPT_FINDINGS` of each claim.
        undecided: why the run decides nothing, or None.
        ended: `map`, or how it ended without one: a limit, a misbehaviour, `no-map`,
            `worker-lost`.
        stopped: the same in words, or None.
        lost: how an earlier try was ended, perhaps by nothing that the mapper did; or None.
        moves, decisions, map: digests of the doors, of the declared decisions (None: there are
            none) and of the delivered map (its id; None: there is no valid one).
        timed_out: a limit of time struck, whatever the run is said to have ended by.
        seconds: processor time of mapper and robot. It is in no result but `timing`.
        note: what the study's `Look` noted about the run.
        choices: what any choices can cost there, if this is the last of the runs that try them.
    """

    world: str
    vertices: int = 0
    edges: int
    place: int
    turn: int = 0
    least: int
    mapper: str
    policies: ev.Policies | None = None
    cost: int = 0
    free: int = 0
    moving: int = 0
    confirmed: int = 0
    claims: tuple[Judged, ...] = ()
    findings: tuple[Finding, ...] = ()
    undecided: str | None = None
    ended: str = "map"
    stopped: str | None = None
    lost: str | None = None
    moves: str = ""
    decisions: str | None = None
    map: str | None = None
    timed_out: bool = False
    seconds: float = 0.0
    note: Any = None
    choices: PolicyCosts | None = None

    @property
    def late(self) -> bool:
        """Whether it was cut off: it lacks a map, is undecided for that, and says nothing else."""
        return self.undecided is not None and bool(self.findings)

    @property
    def failed(self) -> tuple[str, ...]:
        """The claims that fail."""
        return () if self.undecided else tuple(dict.fromkeys(f.claim for f in self.findings))

    @property
    def by_chance(self) -> bool:
        """Whether its process was lost and need not be lost when it is run again."""
        return self.lost is not None or (self.stopped or "").endswith(SECOND_TRY)

    @property
    def right(self) -> bool:
        """Whether no claim fails; an undecided claim is no failure."""
        return not self.findings and bool(self.claims)

    @property
    def ratio(self) -> float:
        """The cost as a multiple of the least cost of a proof."""
        return self.cost / self.least

    @property
    def judgements(self) -> Iterator[Judgement]:
        """The judgement of each claim, without its findings."""
        for claim, judged in zip(CLAIMS, self.claims, strict=bool(self.claims)):
            yield Judgement(claim, judged.status, judged.judged, judged.of)

    @property
    def digest(self) -> str:
        """A hash of what happened, the same in another process if the mapper is deterministic.

        It covers the status of every claim, the cost and the doors. How far a run came that was
        out of time depends on the machine, so of such a run it covers no more than that. It does
        not cover the evidence of decisions and the numbering of the map.
        """
        if self.ended == "world-timeout":
            return hashed([self.mapper, "out of time"])
        return hashed([self.mapper, [one.status for one in self.claims], self.cost, self.moves])


# ---------------------------------------------------------------- a run


@dataclass(frozen=True, slots=True)
class Attempt:
    """A run of a mapper in a world, and its judgement.

    Attributes:
        seconds: processor time of mapper and robot.
        lines: the transcript of a program that records one.
        lost: the signal that ended an earlier try, perhaps by nothing that the mapper did.
        choices: as in a `Row`.
    """

    run: Exploration
    report: Report
    seconds: float = 0.0
    lines: tuple[TranscriptLine, ...] | None = None
    lost: str | None = None
    choices: PolicyCosts | None = None


Look = Callable[[Attempt], Any]
"""What a study notes about a run beside what every row has: JSON."""


def attempt(
    world: World,
    target: Target,
    limits: Limits,
    *,
    where: str,
    strict: bool = False,
    witness: bool = True,
    beat: Callable[[], None] = lambda: None,
) -> Attempt:
    """Run a mapper in a world, again if its process was killed, and judge the run.

    Args:
        where: the world, as the command line names it.
        strict: judge claim 10 also in worlds with more than 2,000 edges.
        witness: also run the mapper in the witness world of a wrong map.
        beat: called before each run and each judgement.
    """

    def once() -> Attempt:
        beat()
        if program is not None:
            program.start()  # the seconds of a run are not those of a start
        clock = Stopwatch()
        run = explore(world, target, limits=limits)
        seconds = clock.seconds()
        lines = tuple(program.lines) if program is not None and program.record else None
        beat()
        asked = run if witness else replace(run, mapper=None)
        report = judge(asked, where=where, options=limits.options, strict=strict)
        if program is not None:
            program.settle()  # it may have been run in a witness world, too
        return Attempt(run, report, seconds, lines)

    program = target.mapper if isinstance(target.mapper, Program) else None
    first = once()
    signal = first.run.misbehaved and first.run.misbehaved.signal
    if signal is None:
        return first
    second = once()
    if not second.report.ok:
        return first
    if signal == "SIGKILL":
        return replace(second, lost=signal)
    run = replace(first.run, stopped=f"{first.run.stopped}{SECOND_TRY}")
    return replace(first, run=run, report=judge(run, where=where, options=limits.options))


def row_of(made: Attempt, where: str, place: int, turn: int = 0, look: Look | None = None) -> Row:
    """The row of a run.

    Args:
        where: the world, as the command line names it.
        place: its rank among the worlds of its size, or its place in a list.
        turn: the number of runs in the same world before this one.
        look: what the study notes.
    """
    run, report = made.run, made.report
    why = None
    if made.lost is not None:
        why = f"its process was ended by {made.lost}, {OUTSIDE}"
    if undecided(run, report):
        open_claims = [name for name, status in report.claims.items() if status == "undecided"]
        why = run.stopped or f"undecided: {', '.join(open_claims)}"
    doors, decisions, rejected, free, confirmed = _counted(run.trace)
    row = Row(
        world=where,
        vertices=len(run.world.vertices),
        edges=len(run.world.edges),
        place=place,
        turn=turn,
        least=run.world.least_cost(),
        mapper=run.algorithm,
        policies=run.policies,
        cost=run.cost,
        free=free,
        moving=rejected - free,
        confirmed=confirmed,
        claims=tuple([Judged(j.status, j.judged, j.of) for j in report.judgements]),
        findings=_first(report.findings),
        undecided=why,
        ended=_ended(run),
        stopped=run.stopped,
        lost=made.lost,
        moves=hashed(doors),
        decisions=hashed(decisions) if decisions else None,
        map=_map(run, report),
        timed_out=run.limit in ("move-timeout", "world-timeout"),
        seconds=made.seconds,
        note=None if look is None else look(made),
        choices=made.choices,
    )
    if row.findings or row.note is not None:  # only these hold what a mapper made
        return _decoder.decode(msgspec.json.encode(row, enc_hook=repr))
    return row


_decoder = msgspec.json.Decoder(Row)


def lost_row(
    world: World, place: int, where: str, mapper: str, limits: Limits, cause: str, *, external: bool
) -> Row:
    """The row of a run that took its process with it.

    Args:
        cause: what became of the process, in words.
        external: the mapper may have had no part in it; then the world is undecided.
    """
    bare = Row(
        world=where,
        vertices=len(world.vertices),
        edges=len(world.edges),
        place=place,
        least=world.least_cost(),
        mapper=mapper,
        ended="worker-lost",
        stopped=cause,
    )
    if external:
        return msgspec.structs.replace(bare, undecided=cause, lost=cause)
    replay = replay_line(where, mapper, None, limits.options)
    message = f"no map was delivered: {cause}"
    finding = Finding("map-isomorphic", None, "a map", None, message, None, where, replay)
    return msgspec.structs.replace(bare, findings=(finding,))


def _first(findings: Sequence[Finding]) -> tuple[Finding, ...]:
    """The first findings of each claim."""
    numbers: dict[str, int] = {}
    kept: list[Finding] = []
    for finding in findings:
        numbers[finding.claim] = numbers.get(finding.claim, 0) + 1
        if numbers[finding.claim] <= KEPT_FINDINGS:
            kept.append(finding)
    return tuple(kept)


def _ended(run: Exploration) -> str:
    if run.map is not None:
        return "map"
    return run.misbehaved.kind if run.misbehaved is not None else run.limit or "no-map"


def _counted(trace: Sequence[ev.Event]) -> tuple[list[int], list[object], int, int, int]:
    """Doors; declared decisions; how many rejections, and how many without motion; confirmations.

    A decision counts with the number of moves before it: edge, hypotheses, rule, kind, dart. The
    evidence of a rejection and the purpose of a move say why, not what, and are left out.
    """
    doors: list[int] = []
    decisions: list[object] = []
    rejected = free = confirmed = 0
    before: type[ev.Event] = ev.Start
    for event in trace:  # by type: `match` takes three times as long
        kind = type(event)
        if isinstance(event, ev.Move):
            doors.append(event.door)
        elif isinstance(event, ev.Pose):
            decisions.append((len(doors), "pose", event.edge, event.hypotheses))
        elif isinstance(event, ev.Reject):
            rejected += 1
            free += before is not ev.Move
            decisions.append((len(doors), "reject", event.edge, event.hypothesis, event.rule))
        elif isinstance(event, ev.Confirm):
            confirmed += 1
            decisions.append((len(doors), "confirm", event.edge, event.hypothesis, event.rule))
        elif isinstance(event, ev.Augment):
            grown = (event.edge, event.kind, event.dart, event.degree)
            decisions.append((len(doors), "augment", *grown))
        before = kind
    return doors, decisions, rejected, free, confirmed


def _map(run: Exploration, report: Report) -> str | None:
    """The id of the delivered map, or a hash of its code; None without a valid one."""
    if run.map is None:
        return None
    try:
        # If no claim fails the map is the world, so there is nothing to build.
        drawn = run.world if report.ok else World.from_map(run.map)
    except InputError:
        return None
    # The id is canonical, so the mapper's numbering of darts does not matter.
    small = len(drawn.edges) <= rank_order.MAX_ID_EDGES
    return drawn.id if small else f"sha256:{hashed(drawn.code)}"


def hashed(value: object) -> str:
    """The first sixteen hexadecimal digits of a hash."""
    return sha256(msgspec.json.encode(value)).hexdigest()[:16]
