"""The part `proofs`: the theorems that Z3 proves, and the false statements that it must refute.

The part covers the inductive theorems, the negatives and the mutants; `topo-verify prove` covers
the bounded theorems, which take longer. The theorems are about the rules of the catalogue, not
about a user's mapper. Tests compare the algorithms with these rules, decision by decision.

What this does not show: docs/proofs.md lists what is argued in words, what is assumed, and what is
not established.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING

from topo_verify.checkers import Finding
from topo_verify.checkers.findings import Verdict
from topo_verify.harness.progress import Progress
from topo_verify.harness.verify.parts import Part

if TYPE_CHECKING:
    from topo_verify.proofs.theorem import Theorem, TheoremResult

TIMEOUT = 20.0
"""Seconds for each question to Z3; each takes less than one."""


class Proofs:
    """Proves the theorems that take seconds. A `PartJob`.

    Args:
        theorems: the theorems; default: all inductive ones, negatives and mutants.
        quick: only the inductive ones, which take two seconds.
    """

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
        # No theorem at all (an interrupt before the first) is not a proof of anything.
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
        came, found = sum(one[0] for one in replays), sum(one[1] for one in replays)
        forms = {
            "inductive": "{} of {} theorems proved for any size",
            "bounded": "{} of {} exhausted",
            "negative": "{} of {} negatives refuted",
            "mutant": "{} of {} mutants refuted",
        }
        words = [form.format(ok[kind], n) for kind, form in forms.items() if (n := all_of[kind])]
        words += [f"{came} of {found} models replayed"] if found else []
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
