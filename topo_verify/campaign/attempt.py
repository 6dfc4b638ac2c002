"""An attempt: runs a mapper in a world, judges every claim, and makes the row.

A mapper that lost its process or stood still is tried again in the world; loss.py says what the two
tries mean.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from time import process_time
from typing import Any

import msgspec

from topo_verify.campaign.engine import Checks
from topo_verify.campaign.judge import Report, judge, replay_line, undecided
from topo_verify.campaign.loss import How, Loss, SecondTry
from topo_verify.campaign.row import OUTSIDE, SECOND_TRY, Judged, PolicyCosts, Row, hashed
from topo_verify.campaign.run import Exploration, explore
from topo_verify.checkers import Finding
from topo_verify.errors import InputError
from topo_verify.programs.loader import Target
from topo_verify.programs.program import Program, TranscriptLine
from topo_verify.robot import events as ev
from topo_verify.robot.limits import Limits, MoveTimeout
from topo_verify.robot.stopwatch import tasks_of
from topo_verify.world.least_cost import least_cost
from topo_verify.world.rooted_map import World

KEPT_FINDINGS = 5
"""Most findings of each claim in a row."""


@dataclass(frozen=True, slots=True)
class Attempt:
    """A run and its judgement.

    Attributes:
        seconds: processor time of mapper and robot, if it was measured.
        lines: the transcript of a program that records one.
        loss: of a first try that lost its process or stood still.
        lost: the same in words, if it leaves the world undecided.
        choices: as in a `Row`.
    """

    run: Exploration
    report: Report
    seconds: float = 0.0
    lines: tuple[TranscriptLine, ...] | None = None
    loss: Loss | None = None
    lost: str | None = None
    choices: PolicyCosts | None = None

    @property
    def is_lost(self) -> bool:
        """Whether the loss of a process leaves the world undecided."""
        return self.loss is not None and self.loss.meaning == "undecided"

    @property
    def lost_why(self) -> str | None:
        """Why an earlier try leaves the world undecided, if it does."""
        return self.lost and f"{self.lost}, {OUTSIDE}"


Look = Callable[[Attempt], Any]
"""What a study notes about a run, as JSON."""


def attempt(  # noqa: PLR0913  an argument an option
    world: World,
    target: Target,
    limits: Limits,
    *,
    where: str,
    strict: bool = False,
    witness: bool = True,
    known: Checks | None = None,
    timed: bool = False,
    beat: Callable[[], None] = lambda: None,
    before_judging: Callable[[Exploration], Exploration] = lambda run: run,
) -> Attempt:
    """Run a mapper in a world, again if it was killed or stood still, and judge the run.

    Args:
        where: the world's name on the command line.
        witness: also run the mapper in the witness world of a wrong map.
        known: replaces `check`.
        timed: measure the processor time of mapper and robot, which takes a tenth of a run.
        beat: called before each run and each judgement.
        before_judging: returns the run that is judged.
    """

    def once() -> Attempt:
        beat()
        if program is not None:
            program.start()
        begin = _processor_seconds(program) if timed else 0.0
        run = before_judging(explore(world, target, limits=limits))
        seconds = max(0.0, _processor_seconds(program) - begin) if timed else 0.0
        lines = tuple(program.lines) if program is not None and program.record else None
        beat()
        asked = run if witness else replace(run, mapper=None)
        report = judge(asked, where=where, options=limits.options, strict=strict, known=known)
        if program is not None:
            program.settle()  # it may have been run in a witness world, too
        return Attempt(run, report, seconds, lines)

    program = target.mapper if isinstance(target.mapper, Program) else None
    first = once()
    how = _lost_how(first.run)
    if how is None:
        return first
    second = once()
    loss = Loss("process", how, _shown_by(second))
    if loss.meaning == "undecided":
        return replace(second, loss=loss, lost=_how_in_words(first.run))
    if loss.again != "right":
        return first
    run = replace(first.run, stopped=f"{first.run.stopped}{SECOND_TRY}")
    report = judge(run, where=where, options=limits.options)
    return replace(first, run=run, report=report, loss=loss)


def _lost_how(run: Exploration) -> How | None:
    """How a run lost the mapper's process, or that it stood still; None: neither."""
    if run.limit == MoveTimeout.limit:
        return "silent"
    if run.misbehaved is None or run.misbehaved.signal is None:
        return None
    return "killed" if run.misbehaved.maybe_external else "crashed"


def _shown_by(second: Attempt) -> SecondTry:
    if second.report.ok:
        return "right"
    return "open" if undecided(second.run, second.report) else "wrong"


def _how_in_words(run: Exploration) -> str | None:
    if run.misbehaved is None or run.limit == MoveTimeout.limit:
        return run.stopped
    return f"its process was ended by {run.misbehaved.signal}"


def _processor_seconds(program: Program | None) -> float:
    """Processor seconds used by this process and the present ones of a program."""
    seconds = process_time()
    if program is not None and program.process is not None:
        for task in tasks_of(program.process):
            with suppress(OSError):
                account = Path(f"/proc/{task}/schedstat").read_text(encoding="ascii")
                seconds += int(account.split()[0]) / 1e9
    return seconds


def row_of(judged: Attempt, where: str, place: int, turn: int = 0, look: Look | None = None) -> Row:
    """The row of a run; `place`, `turn` and `note` (by `look`) are as in `Row`."""
    run, report = judged.run, judged.report
    why = judged.lost_why
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
        least=least_cost(run.world.code),
        mapper=run.algorithm,
        policies=run.policies,
        cost=run.cost,
        free=free,
        moving=rejected - free,
        confirmed=confirmed,
        claims=tuple([Judged(j.status, j.judged, j.of) for j in report.judgements]),
        findings=_first(report.findings),
        undecided=why,
        ended=run.ended,
        stopped=run.stopped,
        loss=judged.loss,
        lost=judged.lost,
        moves=hashed(doors),
        decisions=hashed(decisions) if decisions else None,
        map=_map(run, report),
        timed_out=run.limit in ("move-timeout", "world-timeout"),
        seconds=judged.seconds,
        note=None if look is None else look(judged),
        choices=judged.choices,
    )
    if row.findings or row.note is not None:  # only these hold objects of a mapper
        return _decoder.decode(msgspec.json.encode(row, enc_hook=repr))
    return row


_decoder = msgspec.json.Decoder(Row)


def lost_row(
    world: World, place: int, where: str, mapper: str, limits: Limits, cause: str, loss: Loss
) -> Row:
    """The row of a run that took its process with it; `cause` says in words how."""
    bare = Row(
        world=where,
        vertices=len(world.vertices),
        edges=len(world.edges),
        place=place,
        least=least_cost(world.code),
        mapper=mapper,
        ended="worker-lost",
        stopped=cause,
        loss=loss,
    )
    if loss.meaning == "undecided":
        return msgspec.structs.replace(bare, undecided=cause, lost=cause)
    replay = replay_line(where, mapper, None, limits.options)
    message = f"no map was delivered: {cause}"
    finding = Finding("map-isomorphic", None, "a map", None, message, None, where, replay)
    return msgspec.structs.replace(bare, findings=(finding,))


def _first(findings: Sequence[Finding]) -> tuple[Finding, ...]:
    numbers: dict[str, int] = {}
    kept: list[Finding] = []
    for finding in findings:
        numbers[finding.claim] = numbers.get(finding.claim, 0) + 1
        if numbers[finding.claim] <= KEPT_FINDINGS:
            kept.append(finding)
    return tuple(kept)


def _counted(trace: Sequence[ev.Event]) -> tuple[list[int], list[object], int, int, int]:
    """Doors, declared decisions, rejections, those without motion, confirmations.

    A decision leaves out evidence and purposes: they explain it and do not change it.
    """
    doors: list[int] = []
    decisions: list[object] = []
    rejected = free = confirmed = 0
    before: type[ev.Event] = ev.Start
    for event in trace:  # by type: `match` takes three times as long
        if type(event) is ev.Move:
            doors.append(event.door)
        elif type(event) is ev.Pose:
            decisions.append((len(doors), "pose", event.edge, event.hypotheses))
        elif type(event) is ev.Reject:
            rejected += 1
            free += before is not ev.Move
            decisions.append((len(doors), "reject", event.edge, event.hypothesis, event.rule))
        elif type(event) is ev.Confirm:
            confirmed += 1
            decisions.append((len(doors), "confirm", event.edge, event.hypothesis, event.rule))
        elif type(event) is ev.Augment:
            grown = (event.edge, event.kind, event.dart, event.degree)
            decisions.append((len(doors), "augment", *grown))
        before = type(event)
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
    return drawn.known_id or f"sha256:{hashed(drawn.code)}"
