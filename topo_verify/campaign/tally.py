"""A `Tally`, the sums of rows, and `notable`, which chooses the rows kept as examples.

Worlds can be grouped in any way that keeps their order:

    tally + tally
    notable(notable(rows) + notable(rows)) == notable(rows + rows)
"""

from __future__ import annotations

from bisect import insort
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import sha256
from operator import add, attrgetter, itemgetter
from typing import TypeVar

import msgspec

from topo_verify.campaign.row import PolicyCosts, Row
from topo_verify.checkers import CLAIMS, Finding, Judgement, Status

KEPT_FAILING, KEPT_WORST, KEPT_PAIRS, SAMPLE = 3, 10, 10, 50
"""Most rows kept of each kind and size of worlds; `SAMPLE`: of all sizes together."""


class Costs(msgspec.Struct, frozen=True):
    """Costs of one mapper's runs without a failing claim; `attained`: worlds with the highest."""

    runs: int = 0
    total: int = 0
    most: int = 0
    attained: int = 0

    def __add__(self, other: Costs) -> Costs:
        most = max(self.most, other.most)
        attained = sum(costs.attained for costs in (self, other) if costs.most == most)
        return Costs(self.runs + other.runs, self.total + other.total, most, attained)


class Pairs(msgspec.Struct, frozen=True):
    """Worlds where the first of two right mappers costs more, and less; its largest excess."""

    dearer: int = 0
    cheaper: int = 0
    most: int = 0

    def __add__(self, other: Pairs) -> Pairs:
        most = max(self.most, other.most)
        return Pairs(self.dearer + other.dearer, self.cheaper + other.cheaper, most)


class Tally(msgspec.Struct, frozen=True, omit_defaults=True):
    """The sums over the rows of some worlds.

    Attributes:
        timeouts: runs that a time limit ended, or that lost their worker each time.
        late: runs that a time limit ended and that show nothing else.
        lost: worlds in which a worker was lost, perhaps not by a mapper's fault.
        statuses: for each claim, the number of runs with each status.
        shares: for each claim, how many cases were judged, of how many.
        claims: for each failing claim, the number of worlds.
        digest: a hash of all results, whatever the order of the worlds.
        by_checkers: worlds that the checkers judged again after another engine.
        first_runs: the digest of the run in each world that is to be run again in a row.
    """

    worlds: int = 0
    failing: int = 0
    undecided: int = 0
    timeouts: int = 0
    late: int = 0
    lost: int = 0
    statuses: dict[str, dict[str, int]] = {}
    shares: dict[str, tuple[int, int]] = {}
    claims: dict[str, int] = {}
    costs: dict[str, Costs] = {}
    pairs: Pairs = Pairs()
    digest: str = ""
    by_checkers: int = 0
    choices: PolicyCosts = PolicyCosts()
    first_runs: dict[str, str] = {}

    def __add__(self, other: Tally) -> Tally:
        return Tally(
            worlds=self.worlds + other.worlds,
            failing=self.failing + other.failing,
            undecided=self.undecided + other.undecided,
            timeouts=self.timeouts + other.timeouts,
            late=self.late + other.late,
            lost=self.lost + other.lost,
            statuses=_merge(self.statuses, other.statuses, _add_counts),
            shares=_merge(self.shares, other.shares, _add_shares),
            claims=_add_counts(self.claims, other.claims),
            costs=_merge(self.costs, other.costs, add),
            pairs=self.pairs + other.pairs,
            digest=_add_digests(self.digest, other.digest),
            by_checkers=self.by_checkers + other.by_checkers,
            choices=self.choices + other.choices,
            first_runs={**self.first_runs, **other.first_runs},
        )

    def amended(self, row: Row) -> Tally:
        """The tally once one of its runs turned out to have lost its worker."""
        if row.is_lost:
            return self + Tally(undecided=1, lost=1)
        return self + Tally(failing=1, claims=dict.fromkeys(row.failed, 1))

    def judgements(self, findings: Sequence[Finding] = ()) -> tuple[Judgement, ...]:
        """The joint judgement of each claim: `ok` only if it is `ok` in every run."""
        return tuple(
            Judgement(
                claim,
                joint_status(self.statuses[claim]),
                *self.shares.get(claim, (0, 0)),
                tuple(finding for finding in findings if finding.claim == claim),
            )
            for claim in CLAIMS
            if any(self.statuses.get(claim, {}).values())
        )


V = TypeVar("V")


def _merge(a: Mapping[str, V], b: Mapping[str, V], add_two: Callable[[V, V], V]) -> dict[str, V]:
    """The entries of both, added where both have one."""
    return {**a, **b, **{key: add_two(a[key], b[key]) for key in a if key in b}}


def _add_counts(a: Mapping[str, int], b: Mapping[str, int]) -> dict[str, int]:
    return _merge(a, b, add)


def _add_shares(a: tuple[int, int], b: tuple[int, int]) -> tuple[int, int]:
    return a[0] + b[0], a[1] + b[1]


def _add_digests(a: str, b: str) -> str:
    """The sum of two digests, as hexadecimal digits: JSON has no integers of 256 bits."""
    if not (a and b):
        return a or b
    return f"{(int(a, 16) + int(b, 16)) % (1 << 256):064x}"


def joint_status(runs: Mapping[str, int]) -> Status:
    """The status of a claim in many runs, given the runs with each status."""
    statuses = {status for status, number in runs.items() if number}
    worst: tuple[Status, ...] = ("failed", "undecided")
    alike: tuple[Status, ...] = ("ok", "not-declared", "not-asked")
    for status in worst:
        if status in statuses:
            return status
    for status in alike:
        if statuses == {status}:
            return status
    return "partial"


@dataclass
class Counts:
    """Counts rows world by world: faster than adding a `Tally` for each world."""

    worlds: int = 0
    failing: int = 0
    undecided: int = 0
    timeouts: int = 0
    late: int = 0
    lost: int = 0
    # Counting whole rows of statuses is faster than counting ten claims in each run.
    _rows: Counter[tuple[Status, ...]] = field(default_factory=Counter[tuple[Status, ...]])
    _lost_claims: Counter[str] = field(default_factory=Counter[str])
    _judged: list[int] = field(default_factory=lambda: [0] * len(CLAIMS))
    _of: list[int] = field(default_factory=lambda: [0] * len(CLAIMS))
    _claims: Counter[str] = field(default_factory=Counter[str])
    _costs: dict[str, list[int]] = field(default_factory=dict[str, list[int]])
    _pairs: Pairs = field(default_factory=Pairs)
    _digest: int = 0
    _choices: PolicyCosts = field(default_factory=PolicyCosts)

    def enter(self, rows: Sequence[Row]) -> None:
        """Count one world, given the rows of all mappers in it."""
        failed: dict[str, None] = {}
        paid: dict[str, int] = {}
        digests = sha256()
        for row in rows:
            digests.update(row.digest.encode())
            # A lost worker may have hung for a whole time limit.
            self.timeouts += row.timed_out or row.ended == "worker-lost"
            self.lost += row.is_lost
            if row.choices is not None:
                self._choices += row.choices
            if row.late:
                self.late += 1
                continue
            self._judge(row)
            failed |= dict.fromkeys(row.failed)
            if row.right:
                self._pay(row)
                paid[row.mapper] = row.cost
        self.worlds += 1
        self.failing += bool(failed)
        self.undecided += not failed and any(row.undecided for row in rows)
        self._claims.update(failed.keys())
        if len(paid) == 2:
            first, second = paid.values()
            self._pairs += Pairs(first > second, first < second, max(0, first - second))
        text = f"{rows[0].world} {bool(failed)} {digests.hexdigest()}"
        self._digest += int(sha256(text.encode()).hexdigest(), 16)

    def _judge(self, row: Row) -> None:
        if not row.claims:  # a lost worker: nothing was judged but that there is no map
            self._lost_claims.update(row.failed)
            return
        statuses: list[Status] = [judged.status for judged in row.claims]
        self._rows[tuple(statuses)] += 1
        for place, judged in enumerate(row.claims):
            self._judged[place] += judged.judged
            self._of[place] += judged.of

    def _pay(self, row: Row) -> None:
        costs = self._costs.setdefault(row.mapper, [0, 0, 0, 0, -1])
        costs[0] += 1
        costs[1] += row.cost
        if row.cost > costs[2] or costs[0] == 1:
            costs[2:] = [row.cost, 1, row.place]
        elif row.cost == costs[2] and row.place != costs[4]:
            costs[3:] = [costs[3] + 1, row.place]

    def tally(self) -> Tally:
        """The numbers so far."""
        statuses: dict[str, dict[str, int]] = {claim: {} for claim in CLAIMS}
        for row, runs in self._rows.items():
            for claim, status in zip(CLAIMS, row, strict=True):
                statuses[claim][status] = statuses[claim].get(status, 0) + runs
        for claim, runs in self._lost_claims.items():
            statuses[claim]["failed"] = statuses[claim].get("failed", 0) + runs
        return Tally(
            self.worlds,
            self.failing,
            self.undecided,
            self.timeouts,
            self.late,
            self.lost,
            statuses,
            dict(zip(CLAIMS, zip(self._judged, self._of, strict=True), strict=True)),
            dict(self._claims),
            {mapper: Costs(*costs[:4]) for mapper, costs in self._costs.items()},
            self._pairs,
            f"{self._digest % (1 << 256):064x}" if self.worlds else "",
            choices=self._choices,
        )


# ---------------------------------------------------------------- which rows are kept


@dataclass
class Notable:
    """Chooses the rows to keep, among them a sample drawn by `seed`.

    First and last of each size, failing, lost, undecided, most expensive, and more expensive than
    the other mapper's. The choice depends only on the worlds of one size. Call `enter` in the order
    of the worlds.
    """

    seed: int = 0
    _kept: dict[tuple[str, int], list[Row]] = field(
        default_factory=dict[tuple[str, int], list[Row]]
    )
    _claims: dict[tuple[int, str], Row] = field(default_factory=dict[tuple[int, str], Row])
    _worst: dict[tuple[int, str], list[Row]] = field(
        default_factory=dict[tuple[int, str], list[Row]]
    )
    _sample: dict[bool, list[tuple[str, Row]]] = field(
        default_factory=dict[bool, list[tuple[str, Row]]]
    )

    def enter(self, rows: Sequence[Row]) -> None:
        """Consider the rows of one world."""
        for row in rows:
            self._keep("first", row, 1)
            self._kept["last", row.edges] = [row]
            if row.failed:
                self._keep("failing", row, KEPT_FAILING)
                for claim in row.failed:
                    self._claims.setdefault((row.edges, claim), row)
            if row.is_lost:
                self._keep("lost", row, SAMPLE)
            elif row.undecided:
                self._keep("undecided", row, 1)
            if not row.timed_out:  # it may be in time when it is run again
                self._draw(row)
            if row.right:
                self._enter_cost(row)
        if len(rows) == 2 and all(row.right for row in rows) and rows[0].cost > rows[1].cost:
            for row in rows:
                self._keep("pairs", row, 2 * KEPT_PAIRS)

    def _keep(self, kind: str, row: Row, most: int) -> None:
        rows = self._kept.setdefault((kind, row.edges), [])
        if len(rows) < most:
            rows.append(row)

    def _draw(self, row: Row) -> None:
        drawn = self._sample.setdefault(bool(row.failed), [])
        key = sample_key(self.seed, row.world)
        if len(drawn) < SAMPLE or key < drawn[-1][0]:
            insort(drawn, (key, row), key=itemgetter(0))
            del drawn[SAMPLE:]

    def _enter_cost(self, row: Row) -> None:
        worst = self._worst.setdefault((row.edges, row.mapper), [row])
        if row.cost > worst[0].cost:
            worst[:] = [row]
        elif row.cost == worst[0].cost and len(worst) < KEPT_WORST and row.place != worst[-1].place:
            worst.append(row)

    def rows(self) -> tuple[Row, ...]:
        """The rows kept so far, in the order of their worlds."""
        kept = [*self._claims.values()]
        for rows in (*self._kept.values(), *self._worst.values()):
            kept += rows
        for drawn in self._sample.values():
            kept += [row for _, row in drawn]
        once = {id(row): row for row in kept}
        return tuple(sorted(once.values(), key=attrgetter("edges", "place", "turn")))


def sample_key(seed: int, world: str) -> str:
    """A key, drawn by the seed, that orders worlds alike in every process."""
    return sha256(f"{seed} {world}".encode()).hexdigest()[:12]


def notable(rows: Iterable[Row], seed: int = 0) -> tuple[Row, ...]:
    """The rows worth keeping, in the order of their worlds; see `Notable`."""
    kept = Notable(seed)
    worlds: dict[tuple[int, int], list[Row]] = {}
    for row in rows:
        worlds.setdefault((row.edges, row.place), []).append(row)
    for key in sorted(worlds):
        kept.enter(worlds[key])
    return kept.rows()
