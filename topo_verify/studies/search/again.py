"""Runs worlds again, alone and in another order: does the mapper remember earlier worlds?

The counterexample (not if it was out of time, and the search tried it in a fresh process then), up
to `SAMPLE` more failing worlds and `SAMPLE` others, drawn by a seed, are run again, once: the
counterexample in a new process, the others each in a fork of a process that has loaded the mapper
and run no world (a mapper with threads: in a new process). If none fails, one process runs `ROW`
worlds in a shuffled order, until `MOST_ENDED` of them are undecided. No run replaces an earlier
one: each world that is run again is one of

    same        every run ended as in the search, with the same doors and cost
    other       another verdict, other doors, another cost; or it was declined in one run only
    undecided   the machine may have ended a run: a signal from outside, or a time limit

and only `same` leaves a search EXHAUSTED. Of the others

    a failing world passes alone    `not-deterministic`
    another world fails alone       `not-deterministic`, too; likewise in the row
    otherwise                       no finding, since mappers may draw lots; the verdict is open

The smallest such world is repeated `REPEATS` times. Only what is the same each time is named as
the cause: that the world fails alone, or that it passes alone and fails after certain worlds. If
the mapper tosses a fair coin, a world is named alone in 3 of 100 searches.

What this does not show: a memory that none of the drawn worlds reveals. If a share p of the
worlds would differ alone, it is noticed with probability 1 - (1 - p)^SAMPLE: a tenth in 99.5 of
100 searches, a hundredth in 39. Of a run by the compiled engine only those doors and costs are
compared that the checkers saw.
"""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from contextlib import closing
from itertools import chain
from typing import Literal

import msgspec

from topo_verify.campaign import campaign as c
from topo_verify.campaign.backend import here
from topo_verify.campaign.drawn_row import ROW, drawn_row
from topo_verify.campaign.engine import engine_of
from topo_verify.campaign.examiner import examiner_of
from topo_verify.campaign.progress import Progress, no_progress
from topo_verify.campaign.row import Row
from topo_verify.campaign.tally import SAMPLE, Tally, sample_key
from topo_verify.campaign.targets import target_arguments
from topo_verify.checkers import Finding
from topo_verify.programs.foreign import Foreign
from topo_verify.programs.program import PREFIX, Program, split
from topo_verify.world.enumeration import rank_order
from topo_verify.world.rooted_map import World

MOST = SAMPLE

MOST_ENDED = 20
"""Undecided worlds after which the row ends: the verdict is open, and each may take seconds."""

REPEATS = 5
"""Runs in which a world does the same before a cause is named."""

VARIES = (
    "it fails in some runs and passes in others: it draws lots, or keeps something; repeat"
    " `again:` several times"
)

LONGEST = 64
"""Worlds before a failing one that are tried to make it fail again."""

NEAR = 2**14
"""How many ranks back to look for them; a class may have few."""

CLAIM = "not-deterministic"


class Unlike(msgspec.Struct, frozen=True):
    """A world with another verdict when it was run again.

    Attributes:
        rank: of the world among those of its edges.
    """

    edges: int
    rank: int
    target: str
    findings: tuple[Finding, ...]


class RunAgain(msgspec.Struct, frozen=True):
    """The result of the worlds that were run again.

    Attributes:
        worlds: number of worlds run alone, each in a fresh process.
        row: number of worlds run one after the other in one process.
        same, other, undecided: number of worlds in which every run ended as in the search; in
            which one ended differently; in which the machine may have ended one.
        failures: those of the other worlds with another verdict.
        others: the rest of them: other doors, another cost, or declined in one run only.
        undecided_worlds: their ids.
        whole: no repetition that was due is missing.
    """

    worlds: int = 0
    row: int = 0
    same: int = 0
    other: int = 0
    undecided: int = 0
    failures: tuple[Unlike, ...] = ()
    others: tuple[str, ...] = ()
    undecided_worlds: tuple[str, ...] = ()
    whole: bool = True

    @property
    def is_same(self) -> bool:
        """Whether every repetition was made and ended as in the search."""
        return self.whole and not (self.other or self.undecided)

    @property
    def rows(self) -> tuple[Row, ...]:
        """The failures as failing rows."""
        return tuple(
            Row(
                world=f"m{failure.edges}/{failure.rank}",
                edges=failure.edges,
                place=failure.rank,
                least=0,
                mapper=failure.target,
                findings=failure.findings,
            )
            for failure in self.failures
        )


Sameness = Literal["same", "other", "undecided"]


class Repetition:
    """Worlds of a search that are run again: `run`, once; `result` at any time.

    Args:
        rows: the notable rows of the search.
        tally: its sums over all worlds.
    """

    def __init__(self, campaign: c.Campaign, rows: Sequence[Row], tally: Tally) -> None:
        self._campaign, self._rows, self._tally = campaign, rows, tally
        self._known = {row.world: row for row in rows}
        self._outcomes: dict[str, Sameness] = {}
        self._failures: dict[str, Unlike] = {}
        self._alone: set[str] = set()
        self._in_row = 0
        self._is_whole = False

    def result(self) -> RunAgain:
        """What the runs show so far."""
        failures = sorted(self._failures.values(), key=lambda unlike: (unlike.edges, unlike.rank))
        worlds: dict[Sameness, list[str]] = {"same": [], "other": [], "undecided": []}
        for world, outcome in self._outcomes.items():
            worlds[outcome].append(world)
        return RunAgain(
            worlds=len(self._alone),
            row=self._in_row,
            same=len(worlds["same"]),
            other=len(worlds["other"]),
            undecided=len(worlds["undecided"]),
            failures=tuple(failures),
            others=tuple(world for world in worlds["other"] if world not in self._failures),
            undecided_worlds=tuple(worlds["undecided"]),
            whole=self._is_whole,
        )

    def run(self, tell: Progress | None = None) -> None:
        """Run the worlds again."""
        tell = tell or no_progress

        def report(_work: str, done: int, _total: int) -> None:
            tell(f"{self._campaign.mappers[0]}, worlds run again", done, 2 * MOST + 1 + ROW)

        self._run_alone(report)
        if not self._failures and not any(row.failed for row in self._rows):  # else refuted
            self._run_row(report)
        self._is_whole = True

    def _run_alone(self, report: Progress) -> None:
        campaign = self._campaign
        drawn = _drawn(self._rows, campaign)
        unlike: dict[str, tuple[Row, Row]] = {}
        names = [row.world for row in drawn]
        first = int(bool(drawn) and bool(drawn[0].failed))
        again = chain(
            _runs(campaign, names[:first], _once, report),
            _runs(campaign, names[first:], _alone, report),
        )
        for row, now in zip(drawn, again, strict=True):
            self._alone.add(row.world)
            if bool(row.failed) != bool(now.failed) and not now.undecided:
                unlike[row.world] = row, now
                self._failures[row.world] = _unrepeated(campaign, row, now)
                self._note(row.world, "other")
            else:
                self._note(row.world, compared(row, row.digest, now))
        if unlike:
            row, now = min(unlike.values(), key=lambda pair: (pair[0].edges, pair[0].place))
            self._failures[row.world] = _failure(campaign, row, now)

    def _run_row(self, report: Progress) -> None:
        campaign, known = self._campaign, self._known
        lost = {row.world for row in self._rows if row.is_lost}
        names = [name for name in [*drawn_row(campaign)][:ROW] if name not in lost]
        stop = c.Stop(failing=1, timeouts=MOST_ENDED, lost=MOST_ENDED)
        for now in _runs(campaign, names, _one_process, report, stop):
            self._in_row += 1
            if now.failed:
                self._note(now.world, "other")
                before = names[: self._in_row]
                self._failures[now.world] = _failure_in_row(campaign, before, now)
                return
            row = known.get(now.world)
            digest = self._tally.first_runs.get(now.world)
            if digest is None and row is not None:
                digest = row.digest
            if digest is None and now.undecided and not self._tally.undecided:
                self._note(now.world, "undecided" if _by_machine(now) else "other")
            else:
                self._note(now.world, compared(row, digest, now))

    def _note(self, world: str, outcome: Sameness) -> None:
        known = self._outcomes.get(world, "same")
        if known != "other":
            self._outcomes[world] = known if outcome == "same" else outcome


def compared(row: Row | None, digest: str | None, now: Row) -> Sameness:
    """What a second run of a mapper in a world is beside the first one.

    Args:
        row: of the first run, if it was kept.
        digest: of the first run, if it is known.
    """
    if _by_machine(now) or (row is not None and _by_machine(row)):
        is_failing = row is not None and row.failed and now.failed
        return "same" if is_failing else "undecided"
    if digest is None:  # a claim is not decided, or the world is right as it was
        return "undecided" if now.undecided else "same"
    return "same" if now.digest == digest else "other"


def _by_machine(row: Row) -> bool:
    """Whether something else than the mapper may have ended a run."""
    return row.is_lost or row.timed_out


def _drawn(rows: Sequence[Row], campaign: c.Campaign) -> list[Row]:
    """The counterexample, then the sample, without worlds known to vary."""
    rows = [row for row in rows if not row.by_chance]
    first = [row for row in rows if row.failed][:1]
    if not campaign.in_process:
        first = [row for row in first if not row.timed_out]
    drawn = sorted(
        (row for row in rows if not row.timed_out),
        key=lambda row: sample_key(campaign.seed, row.world),
    )
    for fails in (True, False):
        alike = [row for row in drawn if bool(row.failed) == fails][:MOST]
        first += [row for row in alike if row not in first]
    if examiner_of(campaign).runs_ends_again:
        ends = (row for row in (rows[:1] + rows[-1:]) if not row.timed_out)
        first += [row for row in ends if row not in first]
    return first


# ---------------------------------------------------------------- runs


def _runs(
    campaign: c.Campaign,
    worlds: Sequence[str],
    backend: c.Backend,
    tell: Progress = no_progress,
    stop: c.Stop | None = None,
) -> Iterator[Row]:
    """The rows, each as soon as it is made."""
    listed = c.ListedWorlds(len(worlds))
    once = msgspec.structs.replace(campaign, worlds=listed, keep="all", stop=stop or c.Stop())
    named = [(name, World.from_id(name)) for name in worlds]
    with closing(c.results(once, backend, named, tell=tell)) as results:
        for _, result in results:
            yield from result.rows


def _once(campaign: c.Campaign, shards: Iterator[c.Shard], in_flight: c.InFlight) -> c.ShardResults:
    """Run a failing world: whether it fails again, not what its witness shows."""
    yield from _alone(campaign, shards, in_flight, once=True)


def _alone(
    campaign: c.Campaign,
    shards: Iterator[c.Shard],
    _in_flight: c.InFlight,
    *,
    once: bool = False,
) -> c.ShardResults:
    text, witness = campaign.mappers[0], not once
    if text.startswith(PREFIX):
        for shard in shards:
            with _program(text) as program:
                program.start()  # before any time limit
                yield shard, c.examine(campaign, (program.target,), shard, witness=witness)
        return
    with Foreign(text, fresh=True, once=once) as program:
        for shard in shards:
            program.start()
            yield shard, c.examine(campaign, (program.target,), shard, witness=witness)


def _one_process(
    campaign: c.Campaign, shards: Iterator[c.Shard], in_flight: c.InFlight
) -> c.ShardResults:
    with _program(campaign.mappers[0]) as program:
        program.start()
        checks = engine_of(campaign.engine).checks()
        if checks is not None:
            for shard in shards:
                yield shard, c.examine(campaign, (program.target,), shard, known=checks)
            return
        yield from here((program.target,))(campaign, shards, in_flight)


def _program(text: str) -> Program:
    return Program(split(text.removeprefix(PREFIX))) if text.startswith(PREFIX) else Foreign(text)


# ---------------------------------------------------------------- findings


def _failure(campaign: c.Campaign, row: Row, now: Row) -> Unlike:
    if row.failed:
        how = "a claim fails here only after other worlds, and alone none does"
        return _after_others(campaign, row, how, _before(campaign, row))
    always = all(again.failed for again in _repeated_alone(campaign, row.world))
    how = "it passed after other worlds, and alone it fails" if always else VARIES
    return _unlike(campaign, row, how, now.findings[0])


def _unrepeated(campaign: c.Campaign, row: Row, now: Row) -> Unlike:
    if row.failed:
        return _unlike(campaign, row, "it failed in the search, and passed alone", row.findings[0])
    return _unlike(campaign, row, "it passed in the search, and failed alone", now.findings[0])


def _failure_in_row(campaign: c.Campaign, names: Sequence[str], now: Row) -> Unlike:
    how = (
        f"it passed in the search, and fails as number {len(names)} of a row of worlds that one"
        " process played"
    )
    return _after_others(campaign, now, how, names[:-1])


def _after_others(campaign: c.Campaign, row: Row, how: str, before: Sequence[str]) -> Unlike:
    """A world that failed after others, `how` if that can be repeated, and passed alone."""
    finding = row.findings[0]
    if any(again.failed for again in _repeated_alone(campaign, row.world)):
        return _unlike(campaign, row, VARIES, finding)
    replay = _reproduced(campaign, row.world, before)
    if replay is not None:
        return _unlike(campaign, row, how, msgspec.structs.replace(finding, replay=replay))
    finding = msgspec.structs.replace(
        finding,
        message=f"{finding.message}. No row of up to {LONGEST} worlds before it made it fail again",
        replay=_searching(campaign),
    )
    return _unlike(campaign, row, VARIES, finding)


def _repeated_alone(campaign: c.Campaign, world: str) -> list[Row]:
    return [*_runs(campaign, [world] * REPEATS, _alone)]


def _unlike(campaign: c.Campaign, row: Row, how: str, failure: Finding) -> Unlike:
    message = f"{how}: {failure.claim}, {failure.message}"
    finding = Finding(
        CLAIM, None, "the same each time", None, message, None, row.world, failure.replay
    )
    rank = int(row.world.partition("/")[2])
    return Unlike(row.edges, rank, campaign.mappers[0], (finding,))


def _reproduced(campaign: c.Campaign, world: str, before: Sequence[str]) -> str | None:
    """A command that makes a world fail each time after others in one process, or None."""
    number = 1
    while before and number <= LONGEST:
        row = [*before[-number:], world]
        if all([*_runs(campaign, row, _one_process)][-1].failed for _ in range(REPEATS)):
            words = ["topo-verify", "explore", *row]
            target = target_arguments(campaign.mappers[0])
            words += target if len(target) > 1 else ("--target", *target)
            return shlex.join([*words, *campaign.limits.options])
        if number >= len(before):
            break
        number *= 2
    return None


def _before(campaign: c.Campaign, row: Row) -> list[str]:
    assert isinstance(campaign.worlds, c.Ranks)
    worlds: list[str] = []
    for edges in range(row.edges, 0, -1):
        stop = row.place if edges == row.edges else rank_order.count(edges)
        near = c.Shard(edges, max(0, stop - NEAR), stop)
        worlds = [name for _, name, _ in campaign.worlds.worlds(near)] + worlds
        if len(worlds) >= LONGEST:
            break
    return worlds[-LONGEST:]


def _searching(campaign: c.Campaign) -> str:
    assert isinstance(campaign.worlds, c.Ranks)
    words = ["topo-verify", "search", *target_arguments(campaign.mappers[0])]
    words += ["--edges", str(campaign.worlds.edges), "--class", campaign.worlds.kind]
    return shlex.join([*words, "--workers", "0", *campaign.limits.options])
