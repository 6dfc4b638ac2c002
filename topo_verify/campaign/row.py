"""A row: what one mapper did in one world, judged by every claim, as frozen data.

It holds no object of a mapper: it is what another process would send.
"""

from __future__ import annotations

from collections.abc import Iterator
from hashlib import sha256
from typing import Any

import msgspec

from topo_verify.checkers import CLAIMS, Finding, Judgement, Status
from topo_verify.robot import events as ev

SECOND_TRY = "; at the second try it delivered one"
"""The end of `stopped` if a first try lost its process and a second one passed."""


class Judged(msgspec.Struct, frozen=True, array_like=True):
    """The status of a claim in a run, and how much of the run it rests on."""

    status: Status
    judged: int
    of: int


class MostSaved(msgspec.Struct, frozen=True):
    """A world, what the reference policies cost in it, and the least that a run costs."""

    world: str
    reference: int
    cheapest: int

    @property
    def share(self) -> float:
        """The part of the reference cost that is saved."""
        return 1 - self.cheapest / self.reference


class PolicyCosts(msgspec.Struct, frozen=True):
    """What any choices of a mapper can cost, in edge traversals.

    Attributes:
        worlds: in how many worlds; those in which no claim fails, whatever is chosen.
        states, choices: the number of states with more than one way, and of their ways.
        cheapest, reference, dearest: sums of costs: the least that a run can cost in each world,
            the cost of the reference policies, the most.
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
            max(saved, key=lambda one: one.share, default=None),
        )


class Row(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """What one mapper did in one world.

    Attributes:
        world: its name, as the command line names it.
        vertices, edges: the size of the world.
        place: its rank among the worlds of its size, or its place in a list.
        turn: the number of runs in the same world before this one.
        least: the least cost of a proof in it, in edge traversals.
        mapper: the TARGET.
        policies: `pick` and `order` of an algorithm of the catalogue; None: it has none.
        cost: edge traversals.
        free, moving: hypotheses rejected without motion, and with motion.
        confirmed: hypotheses confirmed.
        claims: the judgement of each claim, in the order of `CLAIMS`; empty if there was no run.
        findings: what is wrong, at most `KEPT_FINDINGS` of each claim.
        undecided: why the run decides nothing, or None.
        ended: `map`, or how it ended without one: a limit, a misbehaviour, `no-map`,
            `worker-lost`.
        stopped: the same in words, or None.
        lost: how an earlier try was ended, perhaps by nothing that the mapper did; or None.
        moves, decisions, map: digests of the doors, of the declared decisions (None: there are
            none) and of the delivered map (its id; None: there is no valid one).
        timed_out: a limit of time struck, whatever the run is said to have ended by.
        seconds: processor time of mapper and robot. It is in no result but `timing`.
        note: what the study's `Look` noted about the run.
        choices: what any choices can cost there, if this is the last of the runs that try them.
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
    ended: str = "map"
    stopped: str | None = None
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
        """Whether it was cut off without a map and without any other finding."""
        return self.undecided is not None and bool(self.findings)

    @property
    def failed(self) -> tuple[str, ...]:
        """The claims that fail."""
        if self.undecided or not self.findings:
            return ()
        return tuple(dict.fromkeys(f.claim for f in self.findings))

    @property
    def by_chance(self) -> bool:
        """Whether its process was lost, and may not be lost when it is run again."""
        return self.lost is not None or (self.stopped or "").endswith(SECOND_TRY)

    @property
    def right(self) -> bool:
        """Whether no claim fails; an undecided claim is no failure."""
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
        """A hash of what happened, the same in another process if the mapper is deterministic.

        It covers the status of every claim, the cost and the doors; of a run out of time, whose
        length depends on the machine, only that. It covers neither evidence nor the numbering of
        the map.
        """
        if self.ended == "world-timeout":
            return hashed([self.mapper, "out of time"])
        return hashed([self.mapper, [one.status for one in self.claims], self.cost, self.moves])


def hashed(value: object) -> str:
    """The first sixteen hexadecimal digits of a hash."""
    return sha256(msgspec.json.encode(value)).hexdigest()[:16]
