"""Worlds run again, alone and in another order: does the mapper remember the worlds before?

A mapper that keeps something from world to world (a default that it changes, a cache, a drawn
number) may be right or wrong for reasons that no one world shows. So the counterexample, up to
`MOST` more failing worlds and `MOST` others, drawn by a seed, are run again, each in a fresh
process. If none fails, `ROW` worlds, or all, are run in a row by one process, in an order
drawn by the seed: for workers share the worlds of a search, and none of them meets as many.

    a failing world passes alone    `not-deterministic`: only after other worlds
    another world fails alone       `not-deterministic`, too; and so in the row
    other doors, another cost       no finding, for a mapper may draw lots; but the verdict is open

What this does not show: a memory that none of the drawn worlds tells of. If a share p of the worlds
would come out otherwise alone, it is noticed with a probability of 1 - (1 - p)^MOST: of a tenth in
99.5 of 100 searches, of a hundredth in 39. A mapper that fails in its k-th world is noticed for
sure if k is at most the length of the row.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from itertools import islice
from random import Random

import msgspec

from topo_verify.algorithms import Algorithm, Steered
from topo_verify.checkers import Finding
from topo_verify.harness.judge import Report, judge
from topo_verify.harness.observed import Observation, run_hash, world_hash
from topo_verify.harness.run import explore
from topo_verify.harness.search.plan import Plan
from topo_verify.harness.tally import Failing, Failure, Tally, with_failure
from topo_verify.harness.targets import target_arguments
from topo_verify.programs.foreign import Foreign
from topo_verify.programs.loader import Target
from topo_verify.programs.program import PREFIX, Program, split
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.pruned import ranked_tables
from topo_verify.world.rooted_map import World

MOST = 50
"""How many failing worlds, and how many others, are run again."""

ROW = 1000
"""So many worlds stand in the row; where there are fewer, all of them."""

LONGEST = 64
"""So many worlds before a failing one are tried to make it fail again."""

NEAR = 2**14
"""In so many ranks before it these worlds are looked for; a class may have few of them."""

CLAIM = "not-deterministic"


class RunAgain(msgspec.Struct, frozen=True):
    """What came of the worlds that were run again.

    Attributes:
        worlds: how many were run alone, each in a fresh process.
        row: how many were run one after the other, in one process.
        failures: those with another verdict, in their order.
        others: those in which only doors or costs were other ones.
    """

    worlds: int = 0
    row: int = 0
    failures: tuple[Failure, ...] = ()
    others: tuple[str, ...] = ()


def can_run_again(mappers: Sequence[Target]) -> bool:
    """Whether a fresh process can be had: for what a TARGET names, outside of the catalogue."""
    return len(mappers) == 1 and not isinstance(mappers[0].mapper, Algorithm | Steered)


def run_again(plan: Plan, tally: Tally, beat: Callable[[int], None] | None = None) -> RunAgain:
    """Run some of the worlds of a search again, each in a fresh process, and then in a row.

    Args:
        tally: of the whole search.
        beat: called before each world: (how many were run).
    """
    failures: list[Failure] = []
    others: list[str] = []
    worlds = 0
    with closing(_Fresh(plan.targets[0])) as fresh:
        for seen in _chosen(tally):
            if beat is not None:
                beat(worlds)
            worlds += 1
            report, made = _run(plan, fresh.target(), seen)
            if report is None:
                continue
            if report.ok == seen.fails:
                # To look for a command that shows it takes long: once is enough.
                failures.append(_failure(plan, seen, report, tally, look=not failures))
            elif seen.runs and made != seen.runs:
                others.append(seen.world)
    if tally.failures or failures:  # refuted already
        return RunAgain(worlds, 0, tuple(failures), tuple(others))
    return _in_a_row(plan, tally, RunAgain(worlds, others=tuple(others)), beat)


def _in_a_row(
    plan: Plan, tally: Tally, alone: RunAgain, beat: Callable[[int], None] | None
) -> RunAgain:
    """What came of the worlds alone, and of others in a row, which ends where a claim fails."""
    known = {one.world: one for one in tally.sample}
    row = row_of(plan)
    others = list(alone.others)
    failures: tuple[Failure, ...] = ()
    place = 0
    with _program(plan.targets[0]) as program:
        program.start()
        for place, seen in enumerate(row, 1):
            if beat is not None:
                beat(alone.worlds + place - 1)
            report, made = _run(plan, program.target, seen)
            if report is not None and not report.ok:
                failures = (_failure_in_row(plan, row[:place], report),)
                break
            if report is not None and seen.world in known and made != known[seen.world].runs:
                others += [seen.world] if seen.world not in others else []
    return RunAgain(alone.worlds, place, failures, tuple(others))


def row_of(plan: Plan) -> list[Observation]:
    """Worlds of the class, in an order of their own."""
    lots = Random(f"{plan.seed} row")
    shards = list(plan.shards())
    row: list[Observation] = []
    for shard in lots.sample(shards, len(shards)):
        if len(row) >= ROW:
            break
        listed = ranked_tables(shard.edges, plan.world_class, shard.start, shard.stop)
        row += [Observation("", shard.edges, rank, fails=False, runs="") for rank, _ in listed]
    lots.shuffle(row)
    return row[:ROW]


def with_run_again(tally: Tally, again: RunAgain) -> Tally:
    """The tally of a search, with the findings of the worlds that were run again."""
    for failure in again.failures:
        known = {(one.edges, one.rank) for one in tally.failures}
        one = Tally(claims={CLAIM: Failing(1, failure)}, failures=(failure,))
        if (failure.edges, failure.rank) in known:
            kept = tuple(
                failure if (f.edges, f.rank) == (failure.edges, failure.rank) else f
                for f in tally.failures
            )
            tally = msgspec.structs.replace(tally, failures=kept)
            one = msgspec.structs.replace(one, failures=())
        tally = with_failure(tally, one)
    return tally


def _chosen(tally: Tally) -> Iterator[Observation]:
    """The counterexample, then the sample."""
    first = tally.failures[:1]
    sample = {(one.edges, one.rank): one for one in tally.sample}
    for failure in first:
        place = (failure.edges, failure.rank)
        # One that ran out of time was not observed: then its doors are not compared.
        unseen = Observation("", *place, fails=True, runs="")
        yield sample.pop(place, unseen)
    for fails in (True, False):
        yield from islice((one for one in sample.values() if one.fails == fails), MOST)


def _run(plan: Plan, target: Target, seen: Observation) -> tuple[Report | None, str]:
    """The report on a run and its hash; no report if the run is undecided."""
    run = explore(World.from_id(seen.world), target, limits=plan.limits)
    report = judge(run, options=plan.limits.options)
    if run.declined or run.limit == "world-timeout":
        return None, ""
    return report, world_hash([run_hash(run, report)])


class _Fresh:
    """A mapper that has played no world yet, again and again. Life cycle: `target`, `close`."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._program: Program | None = None
        if not text.startswith(PREFIX):
            self._program = Foreign(text, fresh=True)

    def target(self) -> Target:
        """The mapper, in a process that has played no world."""
        if not isinstance(self._program, Foreign):
            self.close()
            self._program = Program(split(self._text.removeprefix(PREFIX)))
        self._program.start()  # here, where no time limit counts it
        return self._program.target

    def close(self) -> None:
        """End the process in which worlds are run again."""
        if self._program is not None:
            self._program.close()


# ---------------------------------------------------------------- findings


def _failure(plan: Plan, seen: Observation, report: Report, tally: Tally, *, look: bool) -> Failure:
    """The finding in a world that came out otherwise when it was run again."""
    if seen.fails:
        known = (one for one in tally.failures if (one.edges, one.rank) == (seen.edges, seen.rank))
        was = next((f": {one.claim}, {one.message}" for one in known), "")
        message = f"a claim fails here only after other worlds, and alone none does{was}"
        replay = _reproduced(plan, seen.world, _before(plan, seen)) if look else None
        if look and replay is None:
            message += f". No row of up to {LONGEST} worlds before it made it fail again"
        replay = replay or _searching(plan)
    else:
        finding = report.findings[0]
        message = (
            f"it passed after other worlds, and alone it fails: {finding.claim}, {finding.message}"
        )
        replay = finding.replay
    return _unlike(plan, seen, message, replay)


def _failure_in_row(plan: Plan, row: Sequence[Observation], report: Report) -> Failure:
    """The finding in the last world of a row."""
    seen, finding = row[-1], report.findings[0]
    message = (
        f"it passed in the search, and fails as number {len(row)} of a row of worlds that one"
        f" process played: {finding.claim}, {finding.message}"
    )
    replay = _reproduced(plan, seen.world, [one.world for one in row[:-1]])
    if replay is None:
        message += f". The last {LONGEST} worlds before it did not make it fail again"
    return _unlike(plan, seen, message, replay or _searching(plan))


def _unlike(plan: Plan, seen: Observation, message: str, replay: str) -> Failure:
    found = Finding(CLAIM, None, "the same each time", None, message, None, seen.world, replay)
    return Failure(seen.edges, seen.rank, plan.targets[0], (found,))


def _reproduced(plan: Plan, world: str, before: Sequence[str]) -> str | None:
    """A command that makes a world fail behind others in one process; None if none was found."""
    number = 1
    while before and number <= LONGEST:
        row = [*before[-number:], world]
        if _fails_last(plan, row):
            words = ["topo-verify", "explore", *row]
            target = target_arguments(plan.targets[0])
            words += target if len(target) > 1 else ("--algorithm", *target)
            return shlex.join([*words, *plan.limits.options])
        if number >= len(before):
            break
        number *= 2
    return None


def _before(plan: Plan, seen: Observation) -> list[str]:
    """The last worlds of the class before one, in their order."""
    worlds: list[str] = []
    for edges in range(seen.edges, 0, -1):
        stop = seen.rank if edges == seen.edges else rank_order.count(edges)
        listed = ranked_tables(edges, plan.world_class, max(0, stop - NEAR), stop)
        worlds = [f"m{edges}/{rank}" for rank, _ in listed] + worlds
        if len(worlds) >= LONGEST:
            break
    return worlds[-LONGEST:]


def _fails_last(plan: Plan, row: Sequence[str]) -> bool:
    """Whether a claim fails in the last of some worlds, played one after the other."""
    with _program(plan.targets[0]) as program:
        program.start()
        runs = [explore(World.from_id(w), program.target, limits=plan.limits) for w in row]
        return not judge(runs[-1]).ok


def _program(text: str) -> Program:
    """The mapper in one process for all worlds."""
    return Program(split(text.removeprefix(PREFIX))) if text.startswith(PREFIX) else Foreign(text)


def _searching(plan: Plan) -> str:
    words = ["topo-verify", "search", *target_arguments(plan.targets[0])]
    words += ["--edges", str(plan.edges), "--class", plan.kind, "--workers", "0"]
    return shlex.join([*words, *plan.limits.options])
