"""Examines a range of worlds by the compiled engine: enumeration, run and judgement in one kernel.

    (counts,) = examine_range(["basic"], 7, "any", 0, 10_000)
    counts.failing, counts.claims["map-isomorphic"]

The checkers judge a trace whose verdict the kernel leaves open (`judging/`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

import msgspec

from topo_verify.campaign.compiled_checks import ALL_CLAIMS, STATUSES
from topo_verify.checkers import CLAIMS, Status, check
from topo_verify.compiled import require, tally
from topo_verify.compiled import workspace as ws
from topo_verify.compiled.enumeration import prepare
from topo_verify.compiled.explore import (
    KERNELS,
    CompiledJob,
    CompiledRun,
    require_kernel,
    run_world,
)
from topo_verify.compiled.faults import PLANTED
from topo_verify.compiled.judging import layout
from topo_verify.compiled.judging.truth import HASH_PRIME
from topo_verify.compiled.kernel import compiled
from topo_verify.compiled.names import Words
from topo_verify.errors import InputError
from topo_verify.robot.events import Event, Move, Start
from topo_verify.robot.simulator import first_percept
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.rooted_map import World

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from topo_verify.compiled.native_run import NativeCalls

    Numbers = NDArray[np.int64]


class DearerWorld(NamedTuple):
    """A world in which the first algorithm costs more than the second."""

    rank: int
    cost: int
    other: int


class ShardCounts(msgspec.Struct, frozen=True):
    """The counts of one algorithm in a range of worlds.

    Attributes:
        claims: for each claim, the number of failing worlds and the rank of the first; -1: none.
        newly_failing, newly_failing_claims: worlds where a claim, or this claim, fails for it
            and for no algorithm before it.
        statuses: for each claim, number of runs by status.
        shares: for each claim, how many cases were judged, of how many.
        total, most, attained: costs without a failing claim: sum, highest, its number of runs.
        worst, failing_ranks: the first ranks of those, and of failing worlds.
        digest: a 64-bit hash of ranks, verdicts, costs and doors; digests add up.
        dearer, cheaper, excess, dearer_worlds: the first of two algorithms against the second.
    """

    algorithm: str
    worlds: int
    failing: int
    claims: dict[str, tuple[int, int]]
    newly_failing: int
    newly_failing_claims: dict[str, int]
    undecided: int
    statuses: dict[str, dict[str, int]]
    shares: dict[str, tuple[int, int]]
    total: int
    most: int
    attained: int
    worst: tuple[int, ...]
    failing_ranks: tuple[int, ...]
    digest: int
    dearer: int = 0
    cheaper: int = 0
    excess: int = 0
    dearer_worlds: tuple[DearerWorld, ...] = ()


class Snapshot(NamedTuple):
    """The counts of each algorithm from the start of the range to this rank; -1: none."""

    rank: int
    counts: tuple[ShardCounts, ...]


def examine_range(  # noqa: PLR0913  all that is asked of the engine
    algorithms: Sequence[str],
    edges: int,
    kind: str = "any",
    start: int = 0,
    stop: int | None = None,
    *,
    claims: int = ALL_CLAIMS,
    stop_at_first: bool = False,
    faults: Mapping[str, str] | None = None,
    room: int = ws.TRACE,
) -> tuple[ShardCounts, ...]:
    """Run algorithms in every world of a range, and return the counts of each.

    Args:
        kind: the class of worlds; ranks are those of class `any`.
        claims: the number of claims judged: 8, 9 or 10.
        faults: the mistake to plant, by name; these names may be any text.
        room: words of trace, at most `TRACE`; longer traces are made again, with the same counts.
    Raises:
        InputError: numba is missing, no such algorithm or fault, too many edges, or a faulty
            mapper needs too much room.
    """
    require("the compiled engine")
    shard = _Shard(
        algorithms, edges, kind, start, stop, claims, stop_at_first=stop_at_first, faults=faults
    )
    shard.space[shard.layout.at("task.room")] = min(room, ws.TRACE)
    (end,) = shard.examine(())
    return end.counts


def examine_steps(  # noqa: PLR0913  all that is asked of the engine
    algorithms: Sequence[str],
    edges: int,
    kind: str,
    start: int,
    stop: int,
    *,
    steps: Iterable[int],
    stop_at_first: bool = False,
    faults: Mapping[str, str] | None = None,
    calls: NativeCalls | None = None,
) -> Iterator[Snapshot]:
    """`examine_range`, with a snapshot after each step; `steps` are numbers of worlds.

    A native mapper, `calls`, has the only one of the names.
    """
    require("the compiled engine")
    shard = _Shard(
        algorithms,
        edges,
        kind,
        start,
        stop,
        stop_at_first=stop_at_first,
        faults=faults,
        calls=calls,
    )
    return shard.examine(steps)


class _Shard:
    def __init__(  # noqa: PLR0913  as `examine_steps`
        self,
        algorithms: Sequence[str],
        edges: int,
        kind: str,
        start: int,
        stop: int | None,
        claims: int = ALL_CLAIMS,
        *,
        stop_at_first: bool,
        faults: Mapping[str, str] | None,
        calls: NativeCalls | None = None,
    ) -> None:
        import numpy as np

        if claims not in (8, 9, 10):
            raise InputError(f"expected the first 8, 9 or 10 claims, got {claims}")
        self.names, self.faults = tuple(algorithms), faults or {}
        self.layout: ws.WordLayout = ws.FAULTY if faults else ws.SMALL
        self.worlds = prepare(edges, WorldClass.parse(kind), start, stop)
        self.space = np.zeros(self.layout.at("SIZE"), np.int64)
        self.space[self.layout.at("task.room")] = ws.TRACE
        self.judge = np.zeros(layout.JUDGE_SIZE, np.int64)
        self.control = np.zeros(tally.CONTROL.size, np.int64)
        self.walk = tally.ControlWords(self.control)
        self.walk.level, self.walk.stop_at_first, self.walk.rank = claims, stop_at_first, -1
        self.table = np.zeros(len(self.names) * tally.COLUMNS, np.int64)
        self.undecided = [0] * len(self.names)
        for row, name in enumerate(self.names):
            counts = tally.CountWords(self.table, row * tally.COLUMNS)
            if calls is not None:
                counts.rule = ws.RULE_NATIVE
                continue
            counts.fault, algorithm = self._fault(name)
            counts.rule, counts.motion = KERNELS[algorithm]
        self.claims = tuple(CLAIMS)[:claims]
        self.calls = calls
        if calls is not None:
            self.space = calls.space("walk")
            self.space[self.layout.at("task.room")] = ws.TRACE
            self.space[self.layout.at("native.first")] = calls.first
            for name in ("worlds", "judge", "control", "table"):
                setattr(self, name, calls.guarded.row(name, getattr(self, name)))
            self.walk = tally.ControlWords(self.control)

    def _fault(self, name: str) -> tuple[int, str]:
        fault = self.faults.get(name)
        require_kernel(name if fault is None else "basic", fault)
        return (0, name) if fault is None else PLANTED[fault]

    def examine(self, steps: Iterable[int]) -> Iterator[Snapshot]:
        for step in chain(steps, (0,)):
            self.walk.pause = step
            if self._walk() != tally.PAUSED:
                break
            yield self._snapshot()
        yield self._snapshot()

    def _walk(self) -> int:
        """Examine worlds until the walk pauses or ends; return which."""
        walk, rows = compiled(tally.examine_worlds, self.layout), len(self.names)
        while True:
            state: int = walk(self.space, self.worlds, self.judge, self.control, self.table, rows)
            if self.calls is not None:
                self.calls.require_whole()
            if state == tally.OPEN:
                self._judge_by_checkers()
                enter = compiled(tally.enter_open, self.layout)
                state = enter(self.judge, self.control, self.table, rows)
            if state != tally.GO_ON:
                return state

    def _judge_by_checkers(self) -> None:
        row, case = int(self.walk.row), layout.CaseWords(self.judge)
        world, name = self._world(), self.names[row]
        run = self._run_again(world, name, row)
        case.cost, case.doors_hash = run.cost, doors_hash(run.events)
        events = (Start(percept=first_percept(world)), *run.events)
        judgements = check(world, events, run.stopped)[: len(self.claims)]
        for k, judgement in enumerate(judgements):
            case.status[k] = STATUSES.index(judgement.status)
            case.judged[k], case.of[k] = judgement.judged, judgement.of
        statuses = {judgement.status for judgement in judgements}
        self.undecided[row] += "undecided" in statuses and "failed" not in statuses

    def _run_again(self, world: World, name: str, row: int) -> CompiledRun:
        """The last run, made again with more room if it did not fit."""
        if self.calls is not None:
            from topo_verify.compiled.native_run import is_open, made_by

            run = made_by(self.space, world)
            if is_open(self.space):
                run, decides = self.calls.run(world)
                self.undecided[row] += not decides
            return run
        algorithm, fault = self._fault(name)[1], self.faults.get(name, "")
        if self.space[self.layout.at("stop")] < ws.STOP_FULL:
            job = CompiledJob(world, algorithm, trace=True, budget=world.cost_bound, fault=fault)
            return job.result(self.space, self.layout)
        return run_world(world, algorithm, trace=True, fault=fault)

    def _world(self) -> World:
        first, ends = self.layout.at("world.degree"), self.layout.at("world.alpha")
        degrees = self.space[first : first + int(ws.WalkWords(self.worlds).vertices)].tolist()
        alpha = self.space[ends : ends + sum(degrees)].tolist()
        return World.from_code((tuple(degrees), tuple(alpha)))

    def _snapshot(self) -> Snapshot:
        words = self.table.tolist()
        counts = tuple(
            self._counts(name, tally.CountWords(words, row * tally.COLUMNS), self.undecided[row])
            for row, name in enumerate(self.names)
        )
        return Snapshot(int(self.walk.rank), counts)

    def _counts(self, name: str, row: tally.CountWords, undecided: int) -> ShardCounts:
        def kept(ranks: Words, number: int) -> tuple[int, ...]:
            return tuple(ranks[k] for k in range(min(number, tally.KEPT_RANKS)))

        places = list(enumerate(self.claims))
        statuses: dict[str, dict[str, int]] = {
            claim: {
                status: row.status[k * tally.STATUS_COUNT + number]
                for number, status in enumerate(STATUSES)
            }
            for k, claim in places
        }
        failing = {
            claim: (row.claim_failing[k], row.claim_first[k]) if row.claim_failing[k] else (0, -1)
            for k, claim in places
        }
        dearer = (row.more_ranks, row.more_costs, row.more_others)
        return ShardCounts(
            algorithm=name,
            worlds=row.worlds,
            failing=row.failing,
            claims=failing,
            newly_failing=row.newly_failing,
            newly_failing_claims={claim: row.claim_newly_failing[k] for k, claim in places},
            undecided=undecided,
            statuses=statuses,
            shares={claim: (row.judged[k], row.of[k]) for k, claim in places},
            total=row.total,
            most=row.most,
            attained=row.attained,
            worst=kept(row.worst, row.attained),
            failing_ranks=kept(row.failing_ranks, row.failing),
            digest=row.digest % (1 << 64),
            dearer=row.more,
            cheaper=row.less,
            excess=row.excess,
            dearer_worlds=tuple(map(DearerWorld, *(kept(ranks, row.more) for ranks in dearer))),
        )


def doors_hash(events: Iterable[Event]) -> int:
    """The hash of a run's doors, signed, 64 bits: `follow` of judging/truth.py."""
    mixed = 0
    for event in events:
        if isinstance(event, Move):
            mixed = (mixed ^ event.door) * HASH_PRIME % (1 << 64)
    return mixed - (1 << 64 if mixed >> 63 else 0)


def run_digest(rank: int, cost: int, statuses: Iterable[Status], events: Iterable[Event]) -> int:
    """What one run adds to its algorithm's digest: `enter` in tally.py."""
    mixed = (doors_hash(events) ^ cost) * tally.MIXED
    for status in statuses:
        mixed = (mixed ^ STATUSES.index(status)) * HASH_PRIME
    mixed = (mixed ^ rank) * tally.MIXED % (1 << 64)
    return mixed ^ mixed >> 31
