"""One mapper in every world of 1 to N edges, and a verdict of its own for each claim.

The mapper runs once in each world, and all claims are judged on that run. Of every claim that fails
the first world is kept, which is the smallest: not only of the first failing runs, as in a report.

| status | what it means |
| --- | --- |
| `holds` | in every world |
| `fails` | in one at least |
| `undecided` | it fails in none, but not every world was tried, or a run was out of time |
| `not-declared` | the mapper did not declare, in every world, what the claim speaks of |
"""

from __future__ import annotations

import traceback
from dataclasses import dataclass
from typing import Literal

from topo_verify.checkers import Finding
from topo_verify.harness.corpus import corpus_from
from topo_verify.harness.run import Exploration, Report, undecided
from topo_verify.harness.verify.parts import Part
from topo_verify.harness.verify.trials import Trials
from topo_verify.programs.loading import Target
from topo_verify.robot.limits import Limits
from topo_verify.text import shown

ClaimVerdict = Literal["holds", "fails", "undecided", "not-declared"]


@dataclass(frozen=True, slots=True)
class ClaimResults:
    """What became of a mapper.

    Attributes:
        edges: it was run in every world of 1 to so many edges.
        part: all claims together.
        first: of each claim that fails, where it does so first.
        raised: by world, for these: the line at which the mapper raised an exception, if it did.
    """

    edges: int
    part: Part
    first: dict[str, Finding]
    raised: dict[str, str]

    def status(self, claim: str) -> ClaimVerdict:
        """What became of one claim."""
        seen = self.part.claims[claim]
        if seen["failed"]:
            return "fails"
        if self.part.checked < self.part.total or sum(seen.values()) < self.part.checked:
            return "undecided"
        return "holds" if seen["ok"] == self.part.checked else "not-declared"

    def text(self, claim: str) -> str:
        """The same in words: how often, where first, why, and how to see it again."""
        seen, checked = self.part.claims[claim], self.part.checked
        match self.status(claim):
            case "fails":
                return self._failure(claim, seen["failed"])
            case "undecided":
                return f"{claim} is not decided: {self.part.summary}"
            case "not-declared" if not seen["ok"]:
                return f"{claim}: not judged, for the mapper declares nothing on it"
            case "not-declared":
                some = f"in {seen['ok']:,} of {checked:,} worlds, where it holds"
                return f"{claim}: the mapper declares something on it {some}, and not in the others"
            case "holds":
                return f"{claim} holds in {checked:,} worlds of 1 to {self.edges} edges"

    def _failure(self, claim: str, failed: int) -> str:
        finding = self.first[claim]
        event = "" if finding.event is None else f" (event {finding.event})"
        worlds = f"{failed:,} of {self.part.checked:,} worlds of 1 to {self.edges} edges"
        message = shown(finding.message, limit=1000)
        lines = [f"{claim} fails in {worlds}, first in {finding.world}{event}: {message}"]
        if finding.world in self.raised:
            lines.append(f"  raised at: {self.raised[finding.world]}")
        lines += [f"  world: {finding.world}", f"  again: {finding.replay}"]
        return "\n".join(lines)


def by_claim(target: Target, edges: int, limits: Limits) -> ClaimResults:
    """Run the mapper in every world of 1 to so many edges; after a few time-outs that is enough.

    Raises:
        InputError: more edges than worlds are enumerated with.
    """
    corpus = corpus_from([f"edges<={edges}"])
    first: dict[str, Finding] = {}
    raised: dict[str, str] = {}

    def note(run: Exploration, report: Report) -> None:
        for finding in () if undecided(run, report) else report.findings:
            if first.setdefault(finding.claim, finding) is finding and run.error is not None:
                raised[finding.world] = _place(run.error)

    trials = Trials(
        name=target.text,
        about=f" of 1 to {edges} edges",
        total=corpus.total,
        worlds=lambda: (at.world for at in corpus),
        targets=[target],
        limits=limits,
        finite=True,
        note=note,
    )
    trials.work(lambda _name, _done, _total: None)
    return ClaimResults(edges, trials.part(), first, raised)


def _place(error: BaseException) -> str:
    """Where an exception was raised: file and line."""
    frames = traceback.extract_tb(error.__traceback__)
    return f"{frames[-1].filename}:{frames[-1].lineno}"
