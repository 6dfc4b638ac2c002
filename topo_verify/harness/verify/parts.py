"""The result of one part of `verify`, and the protocol of the jobs that work the parts off."""

from __future__ import annotations

from typing import Protocol

import msgspec

from topo_verify.checkers.findings import Finding, Judgement, Verdict
from topo_verify.harness.progress import Progress


class MapperCost(msgspec.Struct, frozen=True):
    """The cost of one mapper in one world.

    Attributes:
        cost: edge traversals.
        ratio: the cost relative to that of `basic`; None if a claim fails in this world.
        of_least: the cost relative to the least cost at which a walk can prove the map.
        rejected_free, rejected_moving: hypotheses rejected without and by motion.
        confirmed: hypotheses confirmed.
        reference: an algorithm of the catalogue, shown for comparison with a mapper of the user's.
    """

    algorithm: str
    cost: int
    ratio: float | None
    of_least: float
    rejected_free: int
    rejected_moving: int
    confirmed: int
    reference: bool


class Part(msgspec.Struct, frozen=True):
    """The result of one part.

    Attributes:
        part: its name.
        verdict: PROVED: of worlds of any size. EXHAUSTED: every world of a finite class, `checked`
            equals `total`.
        ok: there is no finding, and every world was judged.
        checked, total: the worlds that were judged, and all worlds of the part.
        summary: one sentence.
        failing: in how many of the checked worlds a claim fails.
        claims: for each claim, the number of runs with each status.
        judgements: for each claim, how much was judged in all runs together, and the findings.
        findings: those of the first failing runs, which are in the smallest worlds.
        costs: the cost of each mapper, for a part of one world.
    """

    part: str
    verdict: Verdict
    ok: bool
    checked: int
    total: int
    summary: str
    failing: int = 0
    claims: dict[str, dict[str, int]] = {}
    judgements: tuple[Judgement, ...] = ()
    findings: tuple[Finding, ...] = ()
    costs: tuple[MapperCost, ...] = ()


class PartJob(Protocol):
    """The work on one part. Life cycle: `work`, then `part`, also if `work` was interrupted."""

    def work(self, tell: Progress) -> None:
        """Do the whole work."""
        ...

    def part(self, *, interrupted: bool = False) -> Part:
        """The result so far."""
        ...
