"""Examines a range of worlds by the compiled engine: enumeration, run and judgement in one kernel.

    end = examine_range(["basic"], 7, "any", 0, 10_000)
    end.tally.failing, end.named[0].first["map-isomorphic"]

The checkers judge a trace whose verdict the kernel leaves open (`judging/`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain, count, product
from typing import TYPE_CHECKING, NamedTuple

from topo_verify import extras
from topo_verify.campaign.tally import Costs, Pairs, Tally
from topo_verify.campaign.worker import native_code_runs
from topo_verify.checkers import CLAIMS, Status, check
from topo_verify.errors import InputError
from topo_verify.extra.fast.checks import ALL_CLAIMS, STATUSES
from topo_verify.extra.fast.kernels import tally
from topo_verify.extra.fast.kernels import workspace as ws
from topo_verify.extra.fast.kernels.enumeration import prepare
from topo_verify.extra.fast.kernels.explore import (
    KERNELS,
    CompiledJob,
    CompiledRun,
    require_kernel,
    run_world,
)
from topo_verify.extra.fast.kernels.faults import PLANTED
from topo_verify.extra.fast.kernels.judging import layout
from topo_verify.extra.fast.kernels.judging.truth import HASH_PRIME
from topo_verify.extra.fast.kernels.kernel import compiled
from topo_verify.extra.fast.kernels.names import Words
from topo_verify.robot.events import Event, Move, Start
from topo_verify.robot.simulator import first_percept
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.rooted_map import World

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from topo_verify.extra.fast.kernels.native_run import NativeCalls

    Numbers = NDArray[np.int64]


class DearerWorld(NamedTuple):
    """A world in which the first algorithm costs more than the second."""

    rank: int
    cost: int
    other: int


class NotableWorlds(NamedTuple):
    """The first worlds, by rank, in which one algorithm is notable; at most `KEPT_RANKS` a kind.

    Attributes:
        first: the first failing world of each failing claim.
        failing: those where a claim fails.
        worst: those with the highest cost without a failing claim.
        dearer: of the first of two algorithms, those where it costs more.
    """

    first: dict[str, int]
    failing: tuple[int, ...]
    worst: tuple[int, ...]
    dearer: tuple[DearerWorld, ...]


class Snapshot(NamedTuple):
    """The sums from the start of the range to this rank (-1: none), and each algorithm's worlds.

    `tally.undecided` counts runs; the tally's digest sums 64-bit hashes of ranks, verdicts, costs
    and doors. `without_room` counts undecided runs of a native mapper for which there was no room.
    """

    rank: int
    tally: Tally
    named: tuple[NotableWorlds, ...]
    without_room: int = 0


def examine_range(
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
) -> Snapshot:
    """Run algorithms in every world of a range.

    Args:
        kind: the class of worlds; ranks are those of class `any`.
        claims: the number of claims judged: 8, 9 or 10.
        faults: the mistake to plant, by name; these names may be any text.
        room: words of trace, at most `TRACE`; longer traces are made again, with the same counts.
    Raises:
        InputError: numba is missing, no such algorithm or fault, too many edges, or a faulty
            mapper needs too much room.
    """
    shard = CompiledRange(
        algorithms, edges, kind, start, stop, claims, stop_at_first=stop_at_first, faults=faults
    )
    shard.space[shard.layout.at("task.room")] = min(room, ws.TRACE)
    (end,) = shard.examine(())
    return end


class CompiledRange:
    """Algorithms in a range of worlds; the arguments are those of `examine_range`.

    A native mapper, `calls`, has the only one of the names.
    """

    def __init__(
        self,
        algorithms: Sequence[str],
        edges: int,
        kind: str,
        start: int,
        stop: int | None,
        claims: int = ALL_CLAIMS,
        *,
        stop_at_first: bool = False,
        faults: Mapping[str, str] | None = None,
        calls: NativeCalls | None = None,
    ) -> None:
        extras.require("fast")
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
        self.without_room = 0
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
        """A snapshot after each step, which is a number of worlds, and one at the end."""
        for step in chain(steps, (0,)):
            self.walk.pause = step
            if self._walk() != tally.PAUSED:
                break
            yield self._snapshot()
        yield self._snapshot()

    def _walk(self) -> int:
        """Examine worlds until the walk pauses or ends; return which."""
        walk, rows = compiled(tally.examine_worlds, self.layout), len(self.names)
        if self.calls is not None:
            native_code_runs()
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
        run = self._last_run(world, name, row)
        case.cost, case.doors_hash = run.cost, doors_hash(run.events)
        events = (Start(percept=first_percept(world)), *run.events)
        judgements = check(world, events, run.stopped)[: len(self.claims)]
        for k, judgement in enumerate(judgements):
            case.status[k] = STATUSES.index(judgement.status)
            case.judged[k], case.of[k] = judgement.judged, judgement.of
        statuses = {judgement.status for judgement in judgements}
        self.undecided[row] += "undecided" in statuses and "failed" not in statuses

    def _last_run(self, world: World, name: str, row: int) -> CompiledRun:
        """The last run; one that did not fit is made again with more room."""
        if self.calls is not None:
            from topo_verify.extra.fast.kernels.native_run import has_declined, is_open, made_by

            run = made_by(self.space, world)
            if has_declined(self.space):
                self.undecided[row] += 1
            elif is_open(self.space):
                known = run.events
                run, decides = self.calls.run(world)
                is_same = run.events[: len(known)] == known
                self.without_room += is_same and not decides
                self.undecided[row] += not (is_same and decides)
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
        rows = [tally.CountWords(words, row * tally.COLUMNS) for row in range(len(self.names))]
        total = sum(map(self._tally, count(), rows), Tally())
        named = tuple(map(self._named, rows))
        return Snapshot(int(self.walk.rank), total, named, self.without_room)

    def _tally(self, place: int, row: tally.CountWords) -> Tally:
        """What one algorithm adds: of failing worlds, those where none before it fails."""
        statuses: dict[str, dict[str, int]] = {claim: {} for claim in self.claims}
        for (k, claim), (number, status) in product(enumerate(self.claims), enumerate(STATUSES)):
            if runs := row.status[k * tally.STATUS_COUNT + number]:
                statuses[claim][status] = runs
        costs = Costs(row.worlds - row.failing, row.total, row.most, row.attained)
        failing = {claim: row.claim_newly_failing[k] for k, claim in enumerate(self.claims)}
        return Tally(
            worlds=row.worlds if place == 0 else 0,
            failing=row.newly_failing,
            undecided=self.undecided[place],
            statuses=statuses,
            shares={claim: (row.judged[k], row.of[k]) for k, claim in enumerate(self.claims)},
            claims={claim: worlds for claim, worlds in failing.items() if worlds},
            costs={self.names[place]: costs} if costs.runs else {},
            pairs=Pairs(row.more, row.less, row.excess),
            digest=as_digest(row.digest),
        )

    def _named(self, row: tally.CountWords) -> NotableWorlds:
        def kept(ranks: Words, number: int) -> list[int]:
            return [ranks[k] for k in range(min(number, tally.KEPT_RANKS))]

        dearer = (row.more_ranks, row.more_costs, row.more_others)
        return NotableWorlds(
            {c: row.claim_first[k] for k, c in enumerate(self.claims) if row.claim_failing[k]},
            tuple(kept(row.failing_ranks, row.failing)),
            tuple(kept(row.worst, row.attained)),
            tuple(map(DearerWorld, *(kept(words, row.more) for words in dearer))),
        )


def as_digest(digest: int) -> str:
    """A 64-bit digest in the highest of 256 bits, where sums wrap around as the engine's do."""
    return f"{digest % (1 << 64) << 192:064x}"


def doors_hash(events: Iterable[Event]) -> int:
    """The hash of a run's doors, signed, 64 bits: `follow` of judging/truth.py."""
    mixed = 0
    for event in events:
        if isinstance(event, Move):
            mixed = (mixed ^ event.door) * HASH_PRIME % (1 << 64)
    return mixed - (1 << 64 if mixed >> 63 else 0)


def run_digest(rank: int, cost: int, statuses: Iterable[Status], events: Iterable[Event]) -> int:
    """The summand of one run in its algorithm's digest: `enter` in tally.py."""
    mixed = (doors_hash(events) ^ cost) * tally.MIXED
    for status in statuses:
        mixed = (mixed ^ STATUSES.index(status)) * HASH_PRIME
    mixed = (mixed ^ rank) * tally.MIXED % (1 << 64)
    return mixed ^ mixed >> 31
