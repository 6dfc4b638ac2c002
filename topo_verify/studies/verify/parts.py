"""The parts of `verify`: their results, and the two that run no mapper.

**counts.** Exhaustive results rest on the enumeration. So this part counts the different worlds
and compares the number with the sum of completions F, a recurrence in the number of edges, and
Tutte's number of planar worlds.

**proofs.** The inductive theorems, about the rules of the catalogue; and two controls, false
statements that must be refuted.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING, Protocol

import msgspec

from topo_verify.campaign.progress import Progress
from topo_verify.checkers.findings import Finding, Judgement, Verdict
from topo_verify.errors import plural
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.classes import WorldClass

if TYPE_CHECKING:
    from topo_verify.proofs.theorem import Theorem, TheoremResult


class MapperCost(msgspec.Struct, frozen=True):
    """The cost of one mapper in one world.

    Attributes:
        ratio: relative to the cost of `basic`; null if a claim fails in this world.
        of_least: relative to the least cost of a proof.
        rejected_free: hypotheses rejected without a move since the decision before.
        rejected_moving: hypotheses rejected by a move.
        confirmed: hypotheses confirmed.
        reference: a catalogue algorithm beside a user's mapper.
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
        verdict: PROVED: of worlds of any size. EXHAUSTED: every world of a finite class.
        ok: there is no finding, and every world was judged.
        checked, total: the worlds that were decided, and all worlds of the part.
        summary: one sentence.
        claims: for each claim, the number of runs with each status.
        judgements: for each claim, how much was judged in all runs together, and the findings.
        findings: of the first failing runs, in the smallest worlds.
        costs: of each mapper, for a part of one world.
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
    """The work on one part: `work`, then `part`, also if `work` was interrupted."""

    def work(self, tell: Progress) -> None:
        """Do the whole work."""
        ...

    def part(self, *, interrupted: bool = False) -> Part:
        """The result so far."""
        ...


# ---------------------------------------------------------------- the numbers of worlds

_PLANAR = WorldClass.parse("planar")


class WorldCounts:
    """Enumerates and counts every world of 1 to `edges` edges. A `PartJob`."""

    def __init__(self, edges: int) -> None:
        self.edges = edges
        self.total = sum(map(rank_order.count_by_recurrence, range(1, edges + 1)))
        self.listed = 0
        self.wrong: list[Finding] = []

    def work(self, tell: Progress) -> None:
        """Enumerate the worlds of each size, and compare the numbers."""
        before = 0
        for edges in range(1, self.edges + 1):
            different: set[rank_order.Table] = set()
            planar = 0
            for table in rank_order.tables(edges):
                different.add(table)
                planar += _PLANAR.admits(table)
                if len(different) % 1000 == 0:
                    self.listed = before + len(different)
                    tell("counts", self.listed, self.total)
            self.listed = before = before + len(different)
            self._compare(edges, "the sum of completions", rank_order.count(edges), len(different))
            number = rank_order.count_by_recurrence(edges)
            self._compare(edges, "the recurrence", number, len(different))
            self._compare(edges, "the planar formula", rank_order.count_planar(edges), planar)

    def _compare(self, edges: int, source: str, expected: int, number: int) -> None:
        if expected != number:
            self.wrong.append(
                Finding(
                    claim="counts",
                    event=None,
                    expected=expected,
                    seen=number,
                    message=f"with {plural(edges, 'edge')} {number} worlds are listed,"
                    f" {source} says {expected}",
                    world=f"m{edges}",
                    replay=f"topo-verify world count --edges {edges}",
                )
            )

    def part(self, *, interrupted: bool = False) -> Part:
        """The result so far."""
        verdict: Verdict = "EXHAUSTED"
        how = "two formulas agree, and Tutte's on the planar ones"
        if self.wrong:
            verdict, how = "REFUTED", self.wrong[0].message
        elif interrupted:
            verdict, how = "UNKNOWN", "interrupted"
        size = f"{self.listed} of {self.total} worlds of 1 to {self.edges} edges listed"
        return Part(
            part="counts",
            verdict=verdict,
            ok=verdict == "EXHAUSTED",
            checked=self.listed,
            total=self.total,
            summary=f"{size}: {how}",
            findings=tuple(self.wrong),
        )


# ---------------------------------------------------------------- theorems

TIMEOUT = 20.0
"""Seconds for each question to Z3."""


class Proofs:
    """Proves the theorems that take seconds; `quick`: the inductive ones alone. A `PartJob`."""

    def __init__(self, theorems: Iterable[Theorem] | None = None, *, quick: bool = False) -> None:
        self._quick = quick
        self._given = None if theorems is None else tuple(theorems)
        self.total = 0
        self.done: list[tuple[Theorem, TheoremResult]] = []

    def work(self, tell: Progress) -> None:
        """Prove the theorems one by one."""
        from topo_verify.proofs.catalogue import QUICK, choose
        from topo_verify.proofs.theorem import Budget

        kinds = ("inductive",) if self._quick else QUICK
        theorems = choose(kinds=kinds) if self._given is None else self._given
        self.total = len(theorems)
        for theorem in theorems:
            tell("proofs", len(self.done), self.total)
            self.done.append((theorem, theorem.prove(Budget(timeout=TIMEOUT))))

    def part(self, *, interrupted: bool = False) -> Part:
        """The result so far."""
        standings = Counter(theorem.status(outcome) for theorem, outcome in self.done)
        # No theorem proves nothing.
        whole = len(self.done) == self.total > 0 and not interrupted
        verdict: Verdict = "UNKNOWN"
        if standings["failed"]:
            verdict = "REFUTED"
        elif whole and not standings["open"]:
            verdict = "PROVED"
        return Part(
            part="proofs",
            verdict=verdict,
            ok=verdict == "PROVED",
            checked=standings["ok"],
            total=self.total,
            summary=self._summary(interrupted=interrupted),
            failing=standings["failed"],
            findings=tuple(
                _finding(theorem, outcome)
                for theorem, outcome in self.done
                if theorem.status(outcome) == "failed"
            ),
        )

    def _summary(self, *, interrupted: bool) -> str:
        ok = Counter[str](theorem.kind for theorem, outcome in self.done if theorem.ok(outcome))
        all_of = Counter[str](theorem.kind for theorem, _ in self.done)
        replays = [outcome.replayed for _, outcome in self.done if outcome.replayed is not None]
        confirmed, models = (
            sum(replay[0] for replay in replays),
            sum(replay[1] for replay in replays),
        )
        forms: dict[str, tuple[str, ...]] = {
            "theorems proved for any size": ("inductive",),
            "controls refuted": ("negative", "mutant"),
        }
        words = [
            f"{sum(ok[kind] for kind in kinds)} of {number} {form}"
            for form, kinds in forms.items()
            if (number := sum(all_of[kind] for kind in kinds))
        ]
        words += [f"{confirmed} of {plural(models, 'model')} replayed"] if models else []
        undecided = [t.name for t, outcome in self.done if t.status(outcome) == "open"]
        if undecided:
            words.append(f"not decided: {', '.join(undecided[:3])}")
        if interrupted:
            words.append("interrupted")
        return "; ".join(words)


def _finding(theorem: Theorem, outcome: TheoremResult) -> Finding:
    return Finding(
        claim=theorem.claims[0] if theorem.claims else "proofs",
        event=None,
        expected=theorem.expected,
        seen=outcome.verdict,
        message=f"theorem {theorem.name} is {outcome.verdict}, not {theorem.expected}:"
        f" {theorem.words}",
        world=outcome.counterexample or "",
        replay=f"topo-verify prove {theorem.name}",
    )
