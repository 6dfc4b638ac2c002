"""A theorem, the budget of its proof, and its result: the types that all engines share.

A **theorem** makes a statement about every world of some kind, and names which part of it a solver
proves and which part is argued in words. A solver gives one of three answers. A theorem that was
expected to be proved and came back `unknown` is not proved: no code turns one answer into another.

    kind        about                                          verdict if all is well
    inductive   worlds of any size                             PROVED
    mechanised  worlds of any size, proved in Coq              PROVED
    bounded     every world with m edges, every reachable map  EXHAUSTED
    negative    a claim that is false, at its smallest size    REFUTED, with a world
    mutant      a theorem with one thing changed               REFUTED, with what breaks

A theorem whose premises cannot all hold is **vacuous**: it is true, and says nothing. Its result is
never `ok`, and it is reported as UNKNOWN.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Literal

from topo_verify.checkers.findings import Verdict
from topo_verify.errors import plural

TheoremKind = Literal["inductive", "mechanised", "bounded", "negative", "mutant"]

SolverAnswer = Literal["sat", "unsat", "unknown"]
"""A solver's answer. Compare it with `==`: each is a non-empty text, so each counts as true."""

ResultStatus = Literal["ok", "failed", "open"]
"""`failed`: a definite but unexpected verdict. `open`: no verdict, which never counts as a pass."""

TheoremProgress = Callable[[str, int, int], None]
"""A progress callback: (name of the theorem, steps done, steps in all)."""


def no_progress(_theorem: str, _done: int, _total: int) -> None:
    """Does nothing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Budget:
    """The limits of a proof, and the options for its search.

    Attributes:
        timeout: seconds for each query.
        rlimit: Z3's deterministic resource units for each query; 0: no limit but the time.
        seed: of the solver's random choices.
        certify: also make certificates, and have them checked, where the engine can.
        progress: is called before each step of a long proof.
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
    """A question to a solver: an SMT-LIB 2 script that begins with its `set-logic`.

    Attributes:
        name: of the question, and of the file to which it is exported, without the suffix.
        expected: the answer that the theorem's expected verdict rests on.
    """

    name: str
    smt2: str
    expected: SolverAnswer


@dataclass(frozen=True, slots=True, kw_only=True)
class RefutationCertificate:
    """A refutation of clauses, and the judgement of a checker that calls no solver.

    Attributes:
        format: of the proof, such as "drup".
        checker: name and version of the checker.
        checked: did the checker accept the proof?
        clauses, steps: the number of clauses refuted, the number of steps of the proof.
        why: the reason why the checker refused it; "" if it accepted it.
    """

    format: str
    checker: str
    checked: bool
    clauses: int = 0
    steps: int = 0
    why: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class TheoremResult:
    """The result of trying to prove one theorem.

    Attributes:
        verdict: UNKNOWN for a time-out, and for any other answer that settles nothing.
        solver: name and version of the solver.
        seconds: wall-clock time; shown to people, never compared.
        premises_satisfiable: can all premises hold at once? None: unknown (a time-out), or not
            asked, since a model was found in which they hold.
        core: the premises that the proof used, as far as the solver named them.
        replayed: how many of the models found were replayed without a solver, and of how many.
        checked, total: for EXHAUSTED, the worlds judged and the worlds there are.
        counterexample: the id of the world that refutes the theorem, or the structure in one line.
        history: the doors of a walk that shows it in that world.
        certificate: of the unsatisfiable queries, where one was asked for.
        note: one sentence for people, such as the reason for UNKNOWN.
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


def timed(prove: Callable[[Budget], TheoremResult]) -> Callable[[Budget], TheoremResult]:
    """The same, and its result has the seconds that it took."""

    def with_seconds(budget: Budget) -> TheoremResult:
        begin = perf_counter()
        return replace(prove(budget), seconds=perf_counter() - begin)

    return with_seconds


@dataclass(frozen=True, slots=True, kw_only=True)
class Theorem:
    """A statement, the claims that rest on it, and the function that proves it.

    Attributes:
        name: lower case with dashes. Scripts use it, so it never changes.
        kind: one of the five in the table at the head of this file.
        claims: the claims of docs/semantics.md, section 9, that rest on it, by their names.
        words, symbols: the statement in words, and as it is given to the solver.
        solver_part: what the solver proves.
        argued: the steps that are argued in words, by their names in docs/proofs.md.
        assumed: statements that are not proved here.
        expected: the verdict if all is well.
        prove: tries to prove or to refute it. A time-out is a result, never an exception.
        queries: the questions behind it, for export and for a second solver.
        edges: for a bounded theorem, the largest number of edges of its worlds.
        of: for a mutant, the name of the theorem that it changes.
        deep: it takes minutes, and is proved only with `--deep` or by name.
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
        """Is this the expected result, with nothing vacuous, unknown, unreplayed or refused?"""
        # `expected` is never UNKNOWN; the chain makes sure that no slip there turns into a pass.
        return outcome.verdict == self.expected != "UNKNOWN" and not self._doubt(outcome)

    def reported(self, outcome: TheoremResult) -> TheoremResult:
        """The result as it is reported: UNKNOWN with the reason if the expected verdict fails."""
        if outcome.verdict != self.expected or not (doubt := self._doubt(outcome)):
            return outcome
        note = "; ".join(filter(None, (outcome.note, doubt)))
        return replace(outcome, verdict="UNKNOWN", note=note)

    def _doubt(self, outcome: TheoremResult) -> str:
        """Why the expected verdict would not stand; "" if it does."""
        replayed, certificate = outcome.replayed, outcome.certificate
        # What refutes a theorem is itself a model of the premises.
        if self.expected != "REFUTED" and outcome.premises_satisfiable is not True:
            if outcome.premises_satisfiable is None:
                return "its premises are not shown satisfiable"
            return "its premises cannot hold at once: vacuous"
        if replayed is not None and not replayed[0] == replayed[1] > 0:
            return f"the simulator replayed {replayed[0]} of {plural(replayed[1], 'model')}"
        # Both are None where no worlds are counted.
        if outcome.checked != outcome.total:
            return f"{outcome.checked} of {outcome.total} worlds were checked"
        if certificate is not None and not certificate.checked:
            return f"the checker refused the certificate: {certificate.why}"
        return ""

    def status(self, outcome: TheoremResult) -> ResultStatus:
        """Whether the result is `ok`; if not, whether it is a definite one (see `ResultStatus`)."""
        if self.ok(outcome):
            return "ok"
        return "open" if outcome.verdict in ("UNKNOWN", self.expected) else "failed"
