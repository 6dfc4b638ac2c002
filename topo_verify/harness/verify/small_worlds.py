"""The part `small-worlds`: exhaustive search with every mapper in every world up to a size.

Where the compiled engine is installed, it goes one size further for algorithms of the catalogue.
It also does the sizes that the checkers judged, and must count there what they counted: the status
of each claim and its share, costs, worst worlds. A difference is a bug of ours.

Only algorithms of the catalogue run in workers. A user's mapper runs in this process, so that
Ctrl-C reaches it; its few thousand runs take seconds.
"""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from topo_verify.algorithms import CATALOGUE
from topo_verify.compiled import available
from topo_verify.errors import InternalError
from topo_verify.harness.progress import Progress
from topo_verify.harness.search.exhaustive import Search, SearchResult
from topo_verify.harness.search.plan import Plan
from topo_verify.harness.tally import joint_judgements
from topo_verify.harness.verify.parts import Part
from topo_verify.harness.verify.trials import MAX_TIMEOUTS, claims_in_words, part_claims
from topo_verify.harness.work import processors
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.text import plural

WORTH = 4
"""From so many edges on workers are used: smaller worlds take less time than to start one."""


class SmallWorlds:
    """Runs every mapper in every world of 1 … `edges` edges, judges every claim. A `PartJob`.

    Args:
        further: one size more by the compiled engine, where it is installed.
    """

    def __init__(
        self, edges: int, targets: Sequence[Target], limits: Limits, *, further: bool = False
    ) -> None:
        ours = all(CATALOGUE.get(target.text) == target.mapper for target in targets)
        plan = Plan(
            targets=tuple(target.text for target in targets),
            edges=edges,
            keep_going=True,
            max_timeouts=MAX_TIMEOUTS,
            limits=limits,
        )
        workers = processors() if ours and edges >= WORTH else 0
        self.search = Search(plan, targets, workers=workers)
        self.further: Search | None = None
        if ours and further and available() and limits == Limits():
            plan = msgspec.structs.replace(plan, edges=edges + 1, engine="compiled")
            plan = msgspec.structs.replace(plan, max_timeouts=None)
            self.further = Search(plan, targets, workers=workers)

    def work(self, tell: Progress) -> None:
        """Search every world of each size.

        Raises:
            InternalError: the compiled engine counts something else than the checkers.
        """
        self.search.work(lambda _what, done, total: tell("small-worlds", done, total))
        if self.further is not None and self.search.found().verdict == "EXHAUSTED":
            self.further.work(lambda _what, done, total: tell("small-worlds", done, total))
            self._require_same(self.further)

    def _require_same(self, further: Search) -> None:
        for edges, tally in self.search.tallies.items():
            other = further.tallies[edges]
            for name in ("worlds", "failing", "undecided", "statuses", "shares", "costs"):
                ours, theirs = getattr(tally, name), getattr(other, name)
                if ours != theirs:
                    raise InternalError(
                        f"in the worlds of {plural(edges, 'edge')} the engines disagree on {name}:"
                        f" {ours} by the checkers, {theirs} by the compiled engine"
                    )

    def part(self, *, interrupted: bool = False) -> Part:
        """The part's result so far."""
        found = self.search.found()
        if self.further is not None and found.verdict == "EXHAUSTED":
            found = self.further.found()
        tally = found.tally
        claims = part_claims(tally.statuses)
        findings = tuple(finding for failure in tally.failures for finding in failure.findings)
        return Part(
            part="small-worlds",
            verdict=found.verdict,
            ok=found.verdict == "EXHAUSTED" and not interrupted,
            checked=tally.worlds,
            total=found.total,
            summary=_summary(found, claims, interrupted=interrupted),
            failing=tally.failing,
            claims=claims,
            judgements=joint_judgements(tally.statuses, tally.shares, findings),
            findings=findings,
        )


def _summary(found: SearchResult, claims: dict[str, dict[str, int]], *, interrupted: bool) -> str:
    tally, targets = found.tally, found.plan.targets
    words = f"{tally.worlds} of {plural(found.total, 'world')}"
    words += f" of 1 to {plural(found.plan.edges, 'edge')}"
    words += f" × {len(targets)} mappers: " if len(targets) > 1 else ": "
    if tally.failing:
        failed = ", ".join(claim for claim, seen in claims.items() if seen["failed"])
        worlds = plural(tally.failing, "of them refutes", "of them refute")
        words += f"{worlds} {failed}, first {tally.failures[0].world}"
    else:
        words += claims_in_words(claims)
    if tally.undecided:
        words += f"; {plural(tally.undecided, 'run')} not decided"
    if found.plan.engine == "compiled":
        words += (
            f"; those of {plural(found.plan.edges, 'edge')} by the compiled engine, and"
            f" {plural(tally.by_checkers, 'world')} by both"
        )
    if interrupted:
        return words + "; interrupted"
    if tally.worlds < found.total:
        words += f"; stopped after {tally.timeouts} time-outs"
    return words
