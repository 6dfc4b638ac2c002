"""The part `small-worlds`: exhaustive search with every mapper in every world up to a size.

Only algorithms of the catalogue run in workers. A user's mapper runs in this process, so that
Ctrl-C reaches it; its few thousand runs take seconds.
"""

from __future__ import annotations

from collections.abc import Sequence

from topo_verify.algorithms import CATALOGUE
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
    """Runs every mapper in every world of 1 … `edges` edges, judges every claim. A `PartJob`."""

    def __init__(self, edges: int, targets: Sequence[Target], limits: Limits) -> None:
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

    def work(self, tell: Progress) -> None:
        """Search every world of each size."""
        self.search.work(lambda _what, done, total: tell("small-worlds", done, total))

    def part(self, *, interrupted: bool = False) -> Part:
        """The part's result so far."""
        found = self.search.found()
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
    if interrupted:
        return words + "; interrupted"
    if tally.worlds < found.total:
        words += f"; stopped after {tally.timeouts} time-outs"
    return words
