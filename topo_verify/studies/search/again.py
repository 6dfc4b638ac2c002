"""Runs worlds again, alone and in another order: does the mapper remember earlier worlds?

The counterexample, up to `SAMPLE` more failing worlds and `SAMPLE` others, drawn by a seed, are
run again, each in a fresh process. If none fails, one process runs `ROW` worlds in a shuffled
order.

    a failing world passes alone    `not-deterministic`: it fails only after other worlds
    another world fails alone       `not-deterministic`, too; likewise in the row
    other doors, another cost       no finding, since mappers may draw lots; the verdict is open

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
from topo_verify.campaign.campaign import Progress, no_progress
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
        tell(f"{campaign.mappers[0]}, again", done, 2 * MOST + 1 + ROW)

    worlds = [row.world for row in before]
    alone = _rows(campaign, worlds, _alone, report)
    failures: list[Unlike] = []
    others: list[str] = []
    for row, now in zip(before, alone, strict=True):
        if now.late or now.lost:
            continue
        if bool(row.failed) != bool(now.failed):
            failures.append(_failure(campaign, row, now, search=not failures))
        elif not row.timed_out and now.digest != row.digest:
            others.append(row.world)
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


def _failure(campaign: c.Campaign, row: Row, now: Row, *, search: bool) -> Unlike:
    if not row.failed:
        finding = now.findings[0]
        message = (
            f"it passed after other worlds, and alone it fails: {finding.claim}, {finding.message}"
        )
        return _unlike(campaign, row, message, finding.replay)
    first = row.findings[0]
    message = (
        "a claim fails here only after other worlds, and alone none does:"
        f" {first.claim}, {first.message}"
    )
    replay = _reproduced(campaign, row.world, _before(campaign, row)) if search else None
    if search and replay is None:
        message += f". No row of up to {LONGEST} worlds before it made it fail again"
    return _unlike(campaign, row, message, replay or _searching(campaign))


def _failure_in_row(campaign: c.Campaign, names: Sequence[str], now: Row) -> Unlike:
    finding = now.findings[0]
    message = (
        f"it passed in the search, and fails as number {len(names)} of a row of worlds that one"
        f" process played: {finding.claim}, {finding.message}"
    )
    replay = _reproduced(campaign, now.world, names[:-1])
    if replay is None:
        message += f". The last {LONGEST} worlds before it did not make it fail again"
    return _unlike(campaign, now, message, replay or _searching(campaign))


def _unlike(campaign: c.Campaign, row: Row, message: str, replay: str) -> Unlike:
    finding = Finding(CLAIM, None, "the same each time", None, message, None, row.world, replay)
    rank = int(row.world.partition("/")[2])
    return Unlike(row.edges, rank, campaign.mappers[0], (finding,))


def _reproduced(campaign: c.Campaign, world: str, before: Sequence[str]) -> str | None:
    """A command that makes a world fail after others in one process, or None."""
    number = 1
    while before and number <= LONGEST:
        row = [*before[-number:], world]
        if _rows(campaign, row, _one_process)[-1].failed:
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
