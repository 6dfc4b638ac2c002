"""What a part of a campaign says when it is done, and what the parts at work have in common."""

from __future__ import annotations

from typing import Protocol

import msgspec

from topo_verify.checkers.findings import Finding, Verdict
from topo_verify.harness.progress import Progress


class MapperCost(msgspec.Struct, frozen=True):
    """What one mapper pays in one world.

    Attributes:
        cost: edge traversals.
        ratio: the cost relative to that of `basic`; None if the mapper fails here.
        of_least: the cost relative to the least cost of a proof, map in hand.
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
    """What one part found.

    Attributes:
        part: its name.
        verdict: PROVED: of worlds of any size. EXHAUSTED: every world of a finite class, `checked`
            equals `total`.
        ok: nothing was found, and nothing left out.
        checked, total: worlds.
        summary: one sentence.
        failing: in how many of the checked worlds a claim fails.
        claims: of each claim, in how many runs it was ok, failed, not-declared.
        findings: of the first failing runs, which are in the smallest worlds.
        costs: what each mapper pays in the part's one world.
    """

    part: str
    verdict: Verdict
    ok: bool
    checked: int
    total: int
    summary: str
    failing: int = 0
    claims: dict[str, dict[str, int]] = {}
    findings: tuple[Finding, ...] = ()
    costs: tuple[MapperCost, ...] = ()


class PartJob(Protocol):
    """A part at work. Lives from `work` to `part`; `part` may be asked of work that was cut off."""

    def work(self, tell: Progress) -> None:
        """Do it all."""
        ...

    def part(self, *, interrupted: bool = False) -> Part:
        """What was found so far."""
        ...
