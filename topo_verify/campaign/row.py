"""A row: what one mapper did in one world, as data that another process can send."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from hashlib import sha256
from operator import attrgetter
from typing import Any

import msgspec

from topo_verify.campaign.loss import Loss
from topo_verify.checkers import CLAIMS, Finding, Judgement, Status
from topo_verify.programs.misbehaviour import RunEnd
from topo_verify.robot import events as ev

SECOND_TRY = "; at the second try it delivered one"
"""Said of a first try that lost its process, if a second one passed."""

OUTSIDE = "perhaps for a reason outside; the second try passed"


class Judged(msgspec.Struct, frozen=True, array_like=True):
    """The status of one claim in a run, and how many of its cases were judged."""

    status: Status
    judged: int
    of: int


class MostSaved(msgspec.Struct, frozen=True):
    """A world, its cost under the reference policies, and the least cost of a run."""

    world: str
    reference: int
    cheapest: int

    @property
    def share(self) -> float:
        """The part of the reference cost that is saved."""
        return 1 - self.cheapest / self.reference


class PolicyCosts(msgspec.Struct, frozen=True):
    """What a mapper can cost whatever its policies choose, in edge traversals.

    Attributes:
        worlds: where no claim fails, whatever is chosen.
        states, choices: the number of states with more than one way, and of their ways.
        cheapest, reference, dearest: summed over the worlds.
        most_saved: where the cheapest run saves the greatest share.
    """

    worlds: int = 0
    states: int = 0
    choices: int = 0
    cheapest: int = 0
    reference: int = 0
    dearest: int = 0
    most_saved: MostSaved | None = None

    def __add__(self, other: PolicyCosts) -> PolicyCosts:
        saved = [costs.most_saved for costs in (self, other) if costs.most_saved is not None]
        return PolicyCosts(
            self.worlds + other.worlds,
            self.states + other.states,
            self.choices + other.choices,
            self.cheapest + other.cheapest,
            self.reference + other.reference,
            self.dearest + other.dearest,
            max(saved, key=attrgetter("share"), default=None),
        )


class Row(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """What one mapper did in one world.

    Attributes:
        place: the world's rank among those of its size, or its place in a list.
        turn: number of runs in the same world before this one.
        least: least cost of a proof in the world, in edge traversals.
        free, moving: hypotheses rejected without motion, and with motion.
        claims: judgements in the order of `CLAIMS`; empty without a run.
        findings: at most `KEPT_FINDINGS` of each claim.
        undecided: why the run decides nothing, or None.
        ended: how the run ended, as in `Exploration`; or `worker-lost`.
        stopped: the same in words, or None.
        loss: of a run that lost its process: what was lost, and what the second try shows.
        lost: the same in words, if the mapper is perhaps not at fault; or None.
        moves, decisions, map: digests of doors, declared decisions and a valid map.
        timed_out: a time limit struck, however the run ended.
        seconds: processor time of mapper and robot, if it was measured; for `timing` only.
        note: what the study's `Look` returned.
        choices: in the last of the runs that try all choices.
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
    ended: RunEnd = "map"
    stopped: str | None = None
    loss: Loss | None = None
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
        """Whether a time limit cut it off and nothing else is wrong."""
        return self.undecided is not None and bool(self.findings)

    @property
    def failed(self) -> tuple[str, ...]:
        """The claims that fail."""
        if self.undecided or not self.findings:
            return ()
        return tuple(dict.fromkeys(f.claim for f in self.findings))

    @property
    def by_chance(self) -> bool:
        """Whether it lost a process, so another run may end differently."""
        return self.loss is not None and self.loss.is_by_chance

    @property
    def is_lost(self) -> bool:
        """Whether the loss of a process leaves its world undecided."""
        return self.loss is not None and self.loss.meaning == "undecided"

    @property
    def right(self) -> bool:
        """Whether it was judged and no claim fails."""
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
        """A hash of claim statuses, cost and doors; a deterministic mapper has the same each time.

        Evidence and the map's numbering do not matter. Runs out of time hash alike: their length
        depends on the machine.
        """
        if self.ended == "world-timeout":
            return hashed([self.mapper, "out of time"])
        return hashed(
            [self.mapper, [judged.status for judged in self.claims], self.cost, self.moves]
        )


def with_lost(rows: Iterable[Row], lost: Row) -> list[Row]:
    """The rows with that of a lost worker, in the place of the run that passed."""
    kept: list[Row] = []
    for row in rows:
        if (row.place, row.mapper, row.turn) != (lost.place, lost.mapper, lost.turn):
            kept.append(row)
        elif not lost.is_lost:
            lost = msgspec.structs.replace(
                row,
                ended=lost.ended,
                stopped=lost.stopped,
                loss=lost.loss,
                findings=lost.findings,
            )
        else:
            why = f"its worker was lost ({lost.lost}), {OUTSIDE}"
            lost = msgspec.structs.replace(row, undecided=why, loss=lost.loss, lost=lost.lost)
    return sorted([*kept, lost], key=attrgetter("edges", "place", "turn"))


def hashed(value: object) -> str:
    """The first sixteen hexadecimal digits of the value's SHA-256."""
    return sha256(msgspec.json.encode(value)).hexdigest()[:16]
