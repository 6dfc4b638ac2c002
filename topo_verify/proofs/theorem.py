"""What all engines share: a theorem, the budget of its proof, and its result.

    kind        about                                          expected verdict
    inductive   worlds of any size                             PROVED
    mechanised  worlds of any size, in Coq                     PROVED
    bounded     every world with m edges, every reachable map  EXHAUSTED
    negative    a false claim, at its smallest size            REFUTED, with a world
    mutant      a theorem with one thing changed               REFUTED, with what breaks

The catalogue has one negative and one mutant, its **controls**; the others are tests.

A theorem whose premises cannot all hold is **vacuous**: reported as UNKNOWN.
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
"""Compare with `==`: as strings, all count as true."""

ResultStatus = Literal["ok", "failed", "open"]
"""`failed`: a definite but unexpected verdict. `open`: no verdict."""

TheoremProgress = Callable[[str, int, int], None]
"""(name of the theorem, steps done, steps in all)."""


def no_progress(_theorem: str, _done: int, _total: int) -> None:
    pass


ClauseCertifier = Callable[..., "RefutationCertificate | str"]
"""(clauses, seconds=...): a certificate that they contradict, or the reason why none was made."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Budget:
    """The limits of a proof.

    Attributes:
        timeout: seconds for each query.
        rlimit: Z3's deterministic resource units for each query; 0: no limit.
        certify: makes and checks certificates of bounded theorems; None: there are none.
        together: the names of all theorems to prove; Coq compiles their files at once.
    """

    timeout: float = 60.0
    rlimit: int = 0
    seed: int = 0
    certify: ClauseCertifier | None = None
    progress: TheoremProgress = no_progress
    together: tuple[str, ...] = ()

    @property
    def milliseconds(self) -> int:
        """At least 1, since 0 means no limit."""
        return max(1, round(self.timeout * 1000))


@dataclass(frozen=True, slots=True)
class Query:
    """An SMT-LIB 2 script as a question."""

    name: str
    smt2: str
    expected: SolverAnswer


def one_query(
    name: str, smt2: Callable[[], str], expected: SolverAnswer
) -> Callable[[], Iterator[Query]]:
    """The `queries` of a theorem with one question; `smt2` writes its script on demand."""
    return lambda: iter([Query(name, smt2(), expected)])


@dataclass(frozen=True, slots=True, kw_only=True)
class RefutationCertificate:
    """A refutation of clauses, judged by a checker that calls no solver.

    Attributes:
        format: such as "drup".
        checker: name and version.
        checked: did the checker accept the proof?
        clauses, steps: their numbers.
        why: why it was refused, or "".
    """

    format: str
    checker: str
    checked: bool
    clauses: int = 0
    steps: int = 0
    why: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class TheoremResult:
    """The result of trying to prove a theorem.

    Attributes:
        verdict: UNKNOWN for a time-out.
        premises_satisfiable: can all premises hold? None: unknown, or not asked.
        core: the premises that the proof used, if known.
        replayed: models replayed without a solver, of how many.
        checked, total: for EXHAUSTED, worlds judged and in all.
        counterexample: the id of the refuting world, or the structure in one line.
        history: the doors of a walk that shows it.
        note: one sentence, such as the reason for UNKNOWN.
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
    """Add the seconds to the result."""

    def with_seconds(budget: Budget) -> TheoremResult:
        begin = perf_counter()
        return replace(prove(budget), seconds=perf_counter() - begin)

    return with_seconds


@dataclass(frozen=True, slots=True, kw_only=True)
class Theorem:
    """A statement, the claims that rest on it, and its proof.

    Attributes:
        claims: of docs/semantics.md, section 9.
        words, symbols: the statement in words, and for the solver.
        argued: the steps in words, by their names in docs/proofs.md.
        assumed: statements that are not proved here.
        prove: a time-out is a result, never an exception.
        queries: the questions, for export and a second solver.
        edges: for a bounded theorem, the most edges of its worlds.
        of: for a mutant, the changed theorem.
        deep: it takes minutes; proved with `--deep` or by name.
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
        """Is the verdict the expected one, and beyond doubt?"""
        return outcome.verdict == self.expected != "UNKNOWN" and not self._doubt(outcome)

    def reported(self, outcome: TheoremResult) -> TheoremResult:
        """The result, but UNKNOWN with the reason if the expected verdict is in doubt."""
        if outcome.verdict != self.expected or not (doubt := self._doubt(outcome)):
            return outcome
        note = "; ".join(filter(None, (outcome.note, doubt)))
        return replace(outcome, verdict="UNKNOWN", note=note)

    def _doubt(self, outcome: TheoremResult) -> str:
        """Why the expected verdict does not stand, or ""."""
        replayed, certificate = outcome.replayed, outcome.certificate
        # A counterexample is a model of the premises.
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
        """The status of this outcome."""
        if self.ok(outcome):
            return "ok"
        return "open" if outcome.verdict in ("UNKNOWN", self.expected) else "failed"
