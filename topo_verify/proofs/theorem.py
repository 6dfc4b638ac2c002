"""What a theorem is, and what becomes of it: types and nothing else.

A **theorem** says something about every world of some kind, and says of itself which part of it a
solver proves and which part is argued in words. Solvers answer three things, so a theorem that was
expected to be proved and came back unknown is not proved, and nothing here turns one into the
other.

    kind        about                                          verdict if all is well
    inductive   worlds of any size                             PROVED
    mechanised  worlds of any size, proved in Coq              PROVED
    bounded     every world with m edges, every reachable map  EXHAUSTED
    negative    a claim that is false, at its smallest size    REFUTED, with a world
    mutant      a theorem with one thing changed               REFUTED, with what breaks

A theorem whose premises cannot all hold proves nothing: its outcome is **vacuous**, which is never
`ok`, whatever the verdict.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal

from topo_verify.checkers.findings import Verdict

TheoremKind = Literal["inductive", "mechanised", "bounded", "negative", "mutant"]


SolverAnswer = Literal["sat", "unsat", "unknown"]
"""What a solver says. Compare it with ==: every answer is a non-empty text."""

ResultStatus = Literal["ok", "failed", "open"]

TheoremProgress = Callable[[str, int, int], None]
"""Called as work goes on: (theorem, how much of it is done, how much there is)."""


def no_progress(_theorem: str, _done: int, _total: int) -> None:
    """Tell nobody."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Budget:
    """What a proof may cost, and how it is to be looked for.

    Attributes:
        timeout: seconds for each query.
        rlimit: Z3's deterministic resource units for each query; 0: no limit but the time.
        seed: of the solver.
        certify: also make certificates and have them checked, where there are any.
        tell: is told of the progress.
    """

    timeout: float = 60.0
    rlimit: int = 0
    seed: int = 0
    certify: bool = False
    progress: TheoremProgress = no_progress

    @property
    def milliseconds(self) -> int:
        """The time limit of one query as solvers take it; at least 1, since 0 means no limit."""
        return max(1, round(self.timeout * 1000))


@dataclass(frozen=True, slots=True)
class Query:
    """One question to a solver, as an SMT-LIB 2 script that begins with its `set-logic`.

    Attributes:
        name: of the question; a file name without its suffix.
        expected: the answer on which the theorem's expected verdict rests.
    """

    name: str
    smt2: str
    expected: SolverAnswer


@dataclass(frozen=True, slots=True, kw_only=True)
class RefutationCertificate:
    """A proof object, and what a checker that calls no solver said of it.

    Attributes:
        format: of the proof, as "drup".
        checker: the name and version of the checker.
        checked: it was accepted.
        clauses, steps: of the problem, of the proof.
        why: why there is none, or why it was not accepted; "" if it was.
    """

    format: str
    checker: str
    checked: bool
    clauses: int = 0
    steps: int = 0
    why: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class TheoremResult:
    """What became of one theorem.

    Attributes:
        verdict: UNKNOWN for time-outs and whatever else is neither one nor the other.
        solver: its name and version.
        seconds: wall-clock time; no result, only shown.
        premises_satisfiable: can all premises hold at once? None: not known (a time-out), or there
            are no premises to ask for, as where a model was found.
        core: the premises that the proof used, as far as the solver named them.
        replayed: of the models found, how many were replayed without a solver, and of how many.
        checked, total: worlds, for EXHAUSTED.
        counterexample: the world (its id) or the structure that refutes it.
        history: doors that show it in that world.
        certificate: of an unsatisfiable query, where one was asked for.
        note: one sentence more: what was unknown, what is shown.
    """

    verdict: Verdict
    solver: str
    seconds: float = 0.0
    premises_satisfiable: bool | None = None
    core: tuple[str, ...] = ()
    replayed: tuple[int, int] | None = None
    checked: int | None = None
    total: int | None = None
    counterexample: str | None = None
    history: tuple[int, ...] | None = None
    certificate: RefutationCertificate | None = None
    note: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Theorem:
    """A statement, how it is proved, and what it is good for.

    Attributes:
        name: lower case with dashes; in all rooms the same for the same thing.
        kind: see the head of this file.
        claims: the claims of docs/semantics.md, section 9, that rest on it, by their names.
        words, symbols: the statement in words, and as it is given to the solver.
        solver_part: what the solver proves.
        argued: the steps that are argued in words, by their names in docs/proofs.md.
        assumed: what nobody proves here.
        expected: the verdict if all is well.
        prove: has it proved or refuted; never raises for a time-out.
        queries: the questions put to the solver, for other solvers and for export.
        edges: the number of edges, for what is bounded; the largest if there are several.
        of: for a mutant, the theorem that it changes.
        deep: too long for every day: only with `--deep`, or by name.
    """

    name: str
    kind: TheoremKind
    claims: tuple[str, ...]
    words: str
    symbols: str
    solver_part: str
    argued: tuple[str, ...] = ()
    assumed: tuple[str, ...] = ()
    expected: Verdict
    prove: Callable[[Budget], TheoremResult]
    queries: Callable[[], Iterator[Query]]
    edges: int | None = None
    of: str | None = None
    deep: bool = False

    def ok(self, outcome: TheoremResult) -> bool:
        """Is the outcome what it must be? Vacuous, unknown, not replayed: none of these is."""
        replayed = outcome.replayed
        certificate = outcome.certificate
        return (
            outcome.verdict == self.expected != "UNKNOWN"
            and (self.expected == "REFUTED" or outcome.premises_satisfiable is True)
            and (replayed is None or replayed[0] == replayed[1] > 0)
            and (outcome.checked == outcome.total)
            and (certificate is None or certificate.checked)
        )

    def status(self, outcome: TheoremResult) -> ResultStatus:
        """`ok`; `failed`: decided, and not as it must be; `open`: all else, which is no pass."""
        if self.ok(outcome):
            return "ok"
        return "open" if outcome.verdict in ("UNKNOWN", self.expected) else "failed"
