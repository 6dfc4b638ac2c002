"""One mapper in every world of 1 to N edges, with a verdict for each claim.

| verdict | meaning |
| --- | --- |
| `holds`, `fails` | the claim holds in every world; it fails in at least one |
| `undecided` | it fails in none, but a world, a run or a claim was not decided |
| `not-declared` | in some world the mapper did not declare all decisions that the claim is about |
"""

from __future__ import annotations

import traceback
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from topo_verify.campaign.attempt import Attempt
from topo_verify.campaign.judge import Report, undecided
from topo_verify.campaign.progress import no_progress
from topo_verify.checkers import Finding
from topo_verify.errors import LINE, shown
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.studies.corpus import CorpusWorlds, corpus_from
from topo_verify.studies.verify.parts import Part
from topo_verify.studies.verify.trials import Trials

ClaimVerdict = Literal["holds", "fails", "undecided", "not-declared"]


@dataclass(frozen=True, slots=True)
class ClaimResults:
    """The results of one mapper in every world of 1 to `edges` edges.

    Attributes:
        first: the first finding of each claim that fails.
        raised: by the world of such a finding: the line at which the mapper raised an exception.
        reports: by the world of such a finding.
    """

    edges: int
    part: Part
    first: dict[str, Finding]
    raised: dict[str, str]
    reports: dict[str, Report]

    def verdict(self, claim: str) -> ClaimVerdict:
        """The verdict on one claim."""
        runs = self.part.claims[claim]
        if runs["failed"]:
            return "fails"
        # Fewer runs than worlds if a run was undecided.
        if sum(runs.values()) < self.part.total or runs["undecided"]:
            return "undecided"
        return "holds" if runs["ok"] == self.part.total else "not-declared"

    def text(self, claim: str) -> str:
        """The verdict in words."""
        runs, worlds = self.part.claims[claim], self.part.total
        match self.verdict(claim):
            case "fails":
                return self._failure(claim, runs["failed"])
            case "undecided" if self.first:
                tried = f"{self.part.checked:,} of {worlds:,} worlds were tried"
                return f"{claim} is undecided: {tried}; see {', '.join(self.first)}, which fails"
            case "undecided":
                return shown(f"{claim} is undecided: {self.part.summary}", limit=LINE)
            case "not-declared" if not runs["ok"] + runs["partial"]:
                return f"{claim}: not judged, since the mapper declares none of its decisions"
            case "not-declared":
                some = f"in {runs['ok']:,} of {worlds:,} worlds, where it holds"
                return f"{claim}: the mapper declares its decisions {some}, and not all in others"
            case "holds":
                return f"{claim} holds in {worlds:,} worlds of 1 to {self.edges} edges"

    def properties(self, target: str) -> list[tuple[str, object]]:
        """What a test's report carries to another process and to a JUnit file."""
        part = self.part
        facts: dict[str, object] = {
            "target": target,
            "edges": self.edges,
            "verdict": part.verdict,
            "checked": part.checked,
            "total": part.total,
            "failing": part.failing,
        }
        if part.findings:
            facts |= {"world": part.findings[0].world, "replay": part.findings[0].replay}
        elif not part.ok:
            facts["why"] = part.summary
        return [(f"topo_{name}", fact) for name, fact in facts.items()]

    def _failure(self, claim: str, failed: int) -> str:
        finding = self.first[claim]
        event = "" if finding.event is None else f" (event {finding.event})"
        worlds = f"{failed:,} of {self.part.checked:,} worlds of 1 to {self.edges} edges"
        message = shown(finding.message, limit=1000)
        lines = [f"{claim} fails in {worlds}, first in {finding.world}{event}: {message}"]
        if finding.world in self.raised:
            lines.append(f"  raised at: {self.raised[finding.world]}")
        lines.append(f"  world: {finding.world}")
        lines += self.reports[finding.world].walk()
        lines += [f"  again: {finding.replay}"] * bool(finding.replay)
        return "\n".join(shown(line, limit=LINE) for line in lines)


def summary(facts: Mapping[str, Any]) -> Iterator[str]:
    """The lines that sum up the tests of one mapper, from their properties."""
    checked, total, failing = (facts[f"topo_{name}"] for name in ("checked", "total", "failing"))
    line = f"{facts['topo_target']}: {checked:,} of {total:,} worlds of 1 to {facts['topo_edges']}"
    line += f" edges, {failing:,} counterexample{'' if failing == 1 else 's'}"
    if "topo_world" in facts:
        yield shown(f"{line}, first {facts['topo_world']}", limit=LINE)
        if facts["topo_replay"]:  # empty if no command line finds the mapper again
            yield shown(f"  again: {facts['topo_replay']}", limit=LINE)
    else:
        why = f"; not decided: {facts['topo_why']}" if "topo_why" in facts else ""
        yield shown(line + why, limit=LINE)


def by_claim(target: Target, edges: int, limits: Limits) -> ClaimResults:
    """Run the mapper in every world of 1 to `edges` edges; a few time-outs end this early."""
    corpus = corpus_from([f"edges<={edges}"])
    first: dict[str, Finding] = {}
    raised: dict[str, str] = {}
    reports: dict[str, Report] = {}

    def look(attempt: Attempt) -> None:
        for finding in () if undecided(attempt.run, attempt.report) else attempt.report.findings:
            if first.setdefault(finding.claim, finding) is finding:
                reports.setdefault(finding.world, attempt.report)
                if attempt.run.error is not None:
                    last = traceback.extract_tb(attempt.run.error.__traceback__)[-1]
                    raised[finding.world] = f"{last.filename}:{last.lineno}"

    trials = Trials(
        name=target.text,
        about=f" of 1 to {edges} edges",
        total=corpus.total,
        worlds=CorpusWorlds(corpus),
        targets=[target],
        limits=limits,
        finite=True,
        look=look,
    )
    trials.work(no_progress)
    return ClaimResults(edges, trials.part(), first, raised, reports)
