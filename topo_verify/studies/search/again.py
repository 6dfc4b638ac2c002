"""Runs worlds again, alone and in another order: does the mapper remember earlier worlds?

The counterexample (`REPEATS` times; once if it was out of time, and not if the search tried it
in a fresh process then), up to `SAMPLE` more failing worlds and `SAMPLE` others, drawn by a seed,
are run again, each in a fresh process. If none fails, one process runs `ROW` worlds in a shuffled
order.

    a failing world passes alone    `not-deterministic`
    another world fails alone       `not-deterministic`, too; likewise in the row
    other doors, another cost       no finding, since mappers may draw lots; the verdict is open

The smallest such world is repeated `REPEATS` times. Only what is the same each time is named as
the cause: that the world fails alone, or that it passes alone and fails after certain worlds. If
the mapper tosses a fair coin, a world is named alone in 3 of 100 searches.

What this does not show: a memory that none of the drawn worlds reveals. If a share p of the
worlds would differ alone, it is noticed with probability 1 - (1 - p)^SAMPLE: a tenth in 99.5 of
100 searches, a hundredth in 39.
"""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from random import Random

import msgspec

from topo_verify.campaign import campaign as c
from topo_verify.campaign.backend import calls_native, here
from topo_verify.campaign.progress import Progress, no_progress
from topo_verify.campaign.row import Row
from topo_verify.campaign.tally import SAMPLE, sample_key
from topo_verify.campaign.targets import target_arguments
from topo_verify.checkers import Finding
from topo_verify.programs.foreign import Foreign
from topo_verify.programs.program import PREFIX, Program, split
from topo_verify.world.enumeration import rank_order
from topo_verify.world.rooted_map import World

MOST = SAMPLE

ROW = 1000

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
        failures: those with another verdict.
        others: those where only doors or costs differed.
    """

    worlds: int = 0
    row: int = 0
    failures: tuple[Unlike, ...] = ()
    others: tuple[str, ...] = ()

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


def run_again(campaign: c.Campaign, rows: Sequence[Row], tell: Progress | None = None) -> RunAgain:
    """Run some worlds of a search again, given its notable rows."""
    before = _drawn(rows, campaign)
    tell = tell or no_progress

    def report(_work: str, done: int, _total: int) -> None:
        tell(f"{campaign.mappers[0]}, worlds run again", done, 2 * MOST + REPEATS + ROW)

    repeated = [row for row in before[:1] if row.failed and not row.timed_out]
    runs = repeated * (REPEATS - 1) + before
    alone = _rows(campaign, [row.world for row in runs], _alone, report)
    unlike: dict[str, tuple[Row, Row]] = {}
    others: list[str] = []
    for row, now in zip(runs, alone, strict=True):
        if now.late or now.lost:
            continue
        if bool(row.failed) != bool(now.failed):
            unlike[row.world] = row, now
        elif not row.timed_out and now.digest != row.digest:
            others += [row.world] if row.world not in others else []
    smallest_first = sorted(unlike.values(), key=lambda pair: (pair[0].edges, pair[0].place))
    failures = [
        _failure(campaign, row, now, repeat=not number)
        for number, (row, now) in enumerate(smallest_first)
    ]
    if failures or any(row.failed for row in rows):  # refuted already
        return RunAgain(len(before), 0, tuple(failures), tuple(others))
    known = {row.world: row for row in rows}
    lost = {row.world for row in rows if row.lost}
    names = [name for name in row_of(campaign) if name not in lost]
    in_row = _rows(campaign, names, _one_process, report, stop=c.Stop(failing=1))
    for number, now in enumerate(in_row, 1):
        if now.failed:
            failures.append(_failure_in_row(campaign, names[:number], now))
        elif now.undecided is None and now.digest != known.get(now.world, now).digest:
            others += [now.world] if now.world not in others else []
    return RunAgain(len(before), len(in_row), tuple(failures), tuple(others))


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
    if calls_native(campaign):
        ends = (row for row in (rows[:1] + rows[-1:]) if not row.timed_out)
        first += [row for row in ends if row not in first]
    return first


def row_of(campaign: c.Campaign) -> list[str]:
    """Shuffled worlds of the class, the same for either engine."""
    assert isinstance(campaign.worlds, c.Ranks)
    lots = Random(f"{campaign.seed} row")
    # The reference's shards: the engine's are too large to list.
    shards = list(c.Ranks(campaign.worlds.edges, campaign.worlds.kind).shards())
    row: list[str] = []
    for shard in lots.sample(shards, len(shards)):
        if len(row) >= ROW:
            break
        row += [name for _, name, _ in campaign.worlds.worlds(shard)]
    lots.shuffle(row)
    return row[:ROW]


# ---------------------------------------------------------------- runs


def _rows(
    campaign: c.Campaign,
    worlds: Sequence[str],
    backend: c.Backend,
    tell: Progress = no_progress,
    stop: c.Stop | None = None,
) -> list[Row]:
    listed = c.ListedWorlds(len(worlds))
    once = msgspec.structs.replace(campaign, worlds=listed, keep="all", stop=stop or c.Stop())
    named = [(name, World.from_id(name)) for name in worlds]
    return [row for _, result in c.results(once, backend, named, tell=tell) for row in result.rows]


def _alone(
    campaign: c.Campaign, shards: Iterator[c.Shard], _in_flight: c.InFlight
) -> c.ShardResults:
    text = campaign.mappers[0]
    if text.startswith(PREFIX):
        for shard in shards:
            with _program(text) as program:
                program.start()  # before any time limit
                yield shard, c.examine(campaign, (program.target,), shard)
        return
    with Foreign(text, fresh=True) as program:
        for shard in shards:
            program.start()
            yield shard, c.examine(campaign, (program.target,), shard)


def _one_process(
    campaign: c.Campaign, shards: Iterator[c.Shard], in_flight: c.InFlight
) -> c.ShardResults:
    with _program(campaign.mappers[0]) as program:
        program.start()
        if campaign.engine == "compiled":
            from topo_verify.campaign.compiled_checks import CompiledChecks

            checks = CompiledChecks()
            for shard in shards:
                yield shard, c.examine(campaign, (program.target,), shard, known=checks)
            return
        yield from here((program.target,))(campaign, shards, in_flight)


def _program(text: str) -> Program:
    return Program(split(text.removeprefix(PREFIX))) if text.startswith(PREFIX) else Foreign(text)


# ---------------------------------------------------------------- findings


def _failure(campaign: c.Campaign, row: Row, now: Row, *, repeat: bool) -> Unlike:
    if row.failed:
        if repeat:
            how = "a claim fails here only after other worlds, and alone none does"
            return _after_others(campaign, row, how, _before(campaign, row))
        return _unlike(campaign, row, "it failed in the search, and passed alone", row.findings[0])
    how = "it passed in the search, and failed alone"
    if repeat:
        always = all(again.failed for again in _repeated_alone(campaign, row.world))
        how = "it passed after other worlds, and alone it fails" if always else VARIES
    return _unlike(campaign, row, how, now.findings[0])


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
    return _rows(campaign, [world] * REPEATS, _alone)


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
        if all(_rows(campaign, row, _one_process)[-1].failed for _ in range(REPEATS)):
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
