"""The part `counts`: the number of enumerated worlds against three formulas.

Every exhaustive result rests on the enumeration: a world that it omits is never tried. So this part
counts its worlds, different ones only, and compares three numbers that are computed otherwise: the
sum of completions F, a recurrence in the number of edges, and Tutte's number of planar worlds.
"""

from __future__ import annotations

from topo_verify.checkers import Finding
from topo_verify.checkers.findings import Verdict
from topo_verify.harness.progress import Progress
from topo_verify.harness.verify.parts import Part
from topo_verify.text import plural
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.classes import WorldClass

_PLANAR = WorldClass.parse("planar")


class Counts:
    """Enumerates and counts every world of 1 to `edges` edges. A `PartJob`."""

    def __init__(self, edges: int) -> None:
        self.edges = edges
        self.total = sum(map(rank_order.count_by_recurrence, range(1, edges + 1)))
        self.listed = 0
        self.wrong: list[Finding] = []

    def work(self, tell: Progress) -> None:
        """Enumerate the worlds, by their number of edges, and compare the numbers."""
        before = 0
        for edges in range(1, self.edges + 1):
            different: set[rank_order.Table] = set()  # a set: a table that comes twice counts once
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

    def _compare(self, edges: int, source: str, expected: int, seen: int) -> None:
        if expected != seen:
            self.wrong.append(
                Finding(
                    claim="counts",
                    event=None,
                    expected=expected,
                    seen=seen,
                    message=f"with {plural(edges, 'edge')} {seen} worlds are listed, {source} says"
                    f" {expected}",
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
