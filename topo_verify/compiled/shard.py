"""Examines a range of worlds by the compiled engine: enumeration, run and judgement in one kernel.

    (counts,) = examine_range(["basic"], 7, "any", 0, 10_000)
    counts.failing, counts.claims["map-isomorphic"]

Where the kernel leaves a verdict open (`judging/`), the reference's checkers judge the trace. A run
that did not fit into the workspace is made again before, in a larger one. Either is then counted
like any other.

What a run costs, without its trace and with nine and ten claims judged, is printed by

    .venv/bin/python benchmarks/compiled.py --only basic nine ten

What this does not show: that the kernels are right; tests hold them to the reference, and a search
has a sample judged by the checkers.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import msgspec

from topo_verify.checkers import CLAIMS, check
from topo_verify.compiled import require
from topo_verify.compiled.enumeration import prepare
from topo_verify.compiled.explore import KERNELS, CompiledJob, run_world
from topo_verify.compiled.faults import PLANTED
from topo_verify.compiled.growth import G_VERTICES
from topo_verify.compiled.judging.layout import (
    J_COST,
    J_DOORS_HASH,
    J_JUDGED,
    J_OF,
    J_STATUS,
    JUDGE_SIZE,
    STATUSES,
)
from topo_verify.compiled.judging.truth import HASH_PRIME
from topo_verify.compiled.kernel import compiled
from topo_verify.compiled.tally import (
    C_LEVEL,
    C_ROW,
    C_SIZE,
    C_STOP_AT_FIRST,
    KEPT_RANKS,
    STATUS_COUNT,
    T_ATTAINED,
    T_CHEAPER,
    T_CLAIM_FAILING,
    T_CLAIM_FIRST,
    T_CLAIM_NEWLY_FAILING,
    T_COLUMNS,
    T_DEARER,
    T_DEARER_COSTS,
    T_DEARER_OTHERS,
    T_DEARER_RANKS,
    T_DIGEST,
    T_EXCESS,
    T_FAILING,
    T_FAILING_RANKS,
    T_FAULT,
    T_JUDGED,
    T_MOST,
    T_MOTION,
    T_NEWLY_FAILING,
    T_OF,
    T_RULE,
    T_STATUS,
    T_TOTAL,
    T_WORLDS,
    T_WORST,
    enter_open,
    examine_worlds,
)
from topo_verify.compiled.workspace import FAULTY, SMALL, STOP_FULL, TRACE, WordLayout
from topo_verify.errors import InputError
from topo_verify.robot.events import Event, Move, Start
from topo_verify.robot.simulator import first_percept
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.rooted_map import World

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Numbers = NDArray[np.int64]

ALL_CLAIMS = len(CLAIMS)
"""The level of the judge at which it asks all claims."""


class DearerWorld(NamedTuple):
    """A world in which the first algorithm costs more than the second, by its rank."""

    rank: int
    cost: int
    other: int


class ShardCounts(msgspec.Struct, frozen=True):
    """What one algorithm came to in a range of worlds.

    Attributes:
        algorithm: its name.
        worlds, failing: in how many worlds it ran; in how many a claim fails.
        claims: of each claim, in how many worlds it fails, and the rank of the first; -1: none.
        newly_failing: in how many worlds a claim fails for it, and for no algorithm before it.
        newly_failing_claims: of each claim, in how many worlds it fails for this one and for no
            algorithm before it.
        undecided: runs with an undecided claim of which none fails.
        statuses: of each claim, how many runs have which status.
        shares: of each claim, how much was judged in all runs together, of how much.
        total, most, attained: costs of the runs in which no claim fails, in edge traversals: their
            sum, the highest, and how many runs cost that much.
        worst: the ranks of the first of those.
        failing_ranks: the ranks of the first failing worlds.
        digest: a hash of ranks, verdicts, costs and doors of all runs, 64 bits; digests add up.
        dearer, cheaper, excess: of the first of two algorithms: in how many worlds it costs more
            and less than the second, and by how much at most.
        dearer_worlds: the first worlds in which it costs more.
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
    room: int = TRACE,
) -> tuple[ShardCounts, ...]:
    """Run algorithms in every world of a range, and judge the runs: the counts of each.

    Args:
        kind: the class of worlds; ranks are those of class `any`.
        claims: only the first so many claims: 8, 9 or 10.
        stop_at_first: end behind the first world in which a claim fails.
        faults: for some of the names, the mistake to plant; the name may be any text then.
        room: for traces of so many words, at most `TRACE`; a longer one takes longer, for its run
            is made a second time. The counts do not depend on it.
    Raises:
        InputError: numba is not installed, there is no such algorithm or fault, so many edges
            cannot be listed, or a faulty mapper needs more room than any workspace has.
    """
    require("the compiled engine")
    shard = _Shard(algorithms, edges, kind, start, stop, claims, stop_at_first, faults or {})
    shard.space[shard.layout.at("ROOM")] = min(room, TRACE)
    shard.examine()
    return shard.counts()


class _Shard:
    """The arrays of one examination. Life cycle: `examine`, once; then `counts`."""

    def __init__(
        self,
        algorithms: Sequence[str],
        edges: int,
        kind: str,
        start: int,
        stop: int | None,
        claims: int,
        stop_at_first: bool,  # noqa: FBT001  only `examine_range` calls it
        faults: Mapping[str, str],
    ) -> None:
        import numpy as np

        if claims not in (8, 9, 10):
            raise InputError(f"expected the first 8, 9 or 10 claims, got {claims}")
        self.names, self.faults = tuple(algorithms), faults
        self.layout: WordLayout = FAULTY if faults else SMALL
        self.worlds = prepare(edges, WorldClass.parse(kind), start, stop)
        self.space = np.zeros(self.layout.at("SIZE"), np.int64)
        self.judge = np.zeros(JUDGE_SIZE, np.int64)
        self.control = np.zeros(C_SIZE, np.int64)
        self.control[C_LEVEL], self.control[C_STOP_AT_FIRST] = claims, stop_at_first
        self.table = np.zeros((len(self.names), T_COLUMNS), np.int64)
        self.undecided = [0] * len(self.names)
        for row, name in zip(self.table, self.names, strict=True):
            number, algorithm = self._fault(name)
            if algorithm not in KERNELS:
                known = ", ".join(KERNELS)
                raise InputError(f"expected an algorithm of the catalogue, got {name!r}: {known}")
            row[T_RULE], row[T_MOTION] = KERNELS[algorithm]
            row[T_FAULT] = number
        self.claims = tuple(CLAIMS)[:claims]

    def _fault(self, name: str) -> tuple[int, str]:
        """The number of the mistake, 0: none, and the algorithm. Raises InputError."""
        if name not in self.faults:
            return 0, name
        fault = self.faults[name]
        if fault not in PLANTED:
            known = ", ".join(PLANTED)
            raise InputError(f"expected a fault that has a kernel, got {fault!r}: {known}")
        return PLANTED[fault]

    def examine(self) -> None:
        """Examine all worlds of the range."""
        walk, rows = compiled(examine_worlds, self.layout), len(self.names)
        while walk(self.space, self.worlds, self.judge, self.control, self.table, rows):
            self._judge_by_checkers()
            if compiled(enter_open, self.layout)(self.judge, self.control, self.table, rows):
                return

    def _judge_by_checkers(self) -> None:
        """Put the verdict of the checkers on the last run into the judge's array."""
        row, J = int(self.control[C_ROW]), self.judge
        world, name = self._world(), self.names[row]
        algorithm, fault = self._fault(name)[1], self.faults.get(name, "")
        if self.space[self.layout.at("STOP")] < STOP_FULL:
            job = CompiledJob(world, algorithm, trace=True, budget=world.cost_bound, fault=fault)
            run = job.result(self.space, self.layout)
        else:
            run = run_world(world, algorithm, trace=True, fault=fault)
            J[J_COST], J[J_DOORS_HASH] = run.cost, doors_hash(run.events)
        events = (Start(percept=first_percept(world)), *run.events)
        judgements = check(world, events, run.stopped)[: len(self.claims)]
        for k, one in enumerate(judgements):
            J[J_STATUS + k], J[J_JUDGED + k] = STATUSES.index(one.status), one.judged
            J[J_OF + k] = one.of
        found = {one.status for one in judgements}
        self.undecided[row] += "undecided" in found and "failed" not in found

    def _world(self) -> World:
        """The world that lies in the workspace."""
        first, ends = self.layout.at("DG"), self.layout.at("AL")
        degrees = self.space[first : first + int(self.worlds[G_VERTICES])].tolist()
        alpha = self.space[ends : ends + sum(degrees)].tolist()
        return World.from_code((tuple(degrees), tuple(alpha)))

    # ------------------------------------------------------------ the counts

    def counts(self) -> tuple[ShardCounts, ...]:
        """The counts of each algorithm."""
        return tuple(
            self._counts(name, row.tolist(), undecided)
            for name, row, undecided in zip(self.names, self.table, self.undecided, strict=True)
        )

    def _counts(self, name: str, row: list[int], undecided: int) -> ShardCounts:
        def kept(column: int, number: int) -> tuple[int, ...]:
            return tuple(row[column : column + min(row[number], KEPT_RANKS)])

        columns = (T_DEARER_RANKS, T_DEARER_COSTS, T_DEARER_OTHERS)
        dearer = zip(*(kept(column, T_DEARER) for column in columns), strict=True)
        places = list(enumerate(self.claims))
        statuses: dict[str, dict[str, int]] = {
            claim: dict(zip(STATUSES, row[T_STATUS + k * STATUS_COUNT :], strict=False))
            for k, claim in places
        }
        failing = {
            claim: (row[T_CLAIM_FAILING + k], row[T_CLAIM_FIRST + k])
            if row[T_CLAIM_FAILING + k]
            else (0, -1)
            for k, claim in places
        }
        return ShardCounts(
            algorithm=name,
            worlds=row[T_WORLDS],
            failing=row[T_FAILING],
            claims=failing,
            newly_failing=row[T_NEWLY_FAILING],
            newly_failing_claims={c: row[T_CLAIM_NEWLY_FAILING + k] for k, c in places},
            undecided=undecided,
            statuses=statuses,
            shares={claim: (row[T_JUDGED + k], row[T_OF + k]) for k, claim in places},
            total=row[T_TOTAL],
            most=row[T_MOST],
            attained=row[T_ATTAINED],
            worst=kept(T_WORST, T_ATTAINED),
            failing_ranks=kept(T_FAILING_RANKS, T_FAILING),
            digest=row[T_DIGEST] % (1 << 64),
            dearer=row[T_DEARER],
            cheaper=row[T_CHEAPER],
            excess=row[T_EXCESS],
            dearer_worlds=tuple(DearerWorld(*one) for one in dearer),
        )


def doors_hash(events: Iterable[Event]) -> int:
    """The hash of the doors of a run, a signed integer of 64 bits: `follow` of judging/truth.py."""
    mixed = 0
    for event in events:
        if isinstance(event, Move):
            mixed = (mixed ^ event.door) * HASH_PRIME % (1 << 64)
    return mixed - (1 << 64 if mixed >> 63 else 0)
