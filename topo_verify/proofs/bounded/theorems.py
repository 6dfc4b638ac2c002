"""The bounded theorems: they hold in every world with m edges, on every reachable map of it.

    one-door   one arbitrary door at an arbitrary place, m = 1 … 6; words of any length by induction
    words      whole words of up to m doors, m = 1 … 3; with --deep m = 4, where that is feasible
    below      no false confirmation without the marker's direction, below the sizes of `negatives`
    worlds     the worlds of the encoding are the canonical codes, each of them once

A theorem is EXHAUSTED if its clauses are unsatisfiable for each m; the worlds are counted in the
encoding (`model_count.py`) and by the formulas. Its premises alone must be satisfiable for each m.
If the clauses are satisfiable, the model is decoded to a world that makes the theorem REFUTED.

Source: docs/semantics.md, sections 4 to 10.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from time import perf_counter

from topo_verify.checkers.findings import Verdict
from topo_verify.errors import InputError
from topo_verify.proofs.bounded import drup, negatives
from topo_verify.proofs.bounded.cnf import Formula
from topo_verify.proofs.bounded.decode import decode_world
from topo_verify.proofs.bounded.encoding import Worlds
from topo_verify.proofs.bounded.model_count import (
    another_world,
    missing_and_spurious,
    worlds_encoded,
)
from topo_verify.proofs.bounded.solve import SatResult, SolverGaveUp, solve
from topo_verify.proofs.bounded.statements import (
    ONE_DOOR_STATEMENTS,
    WHOLE_WORD_STATEMENTS,
    BoundedStatement,
)
from topo_verify.proofs.solvers.z3_solver import name as solver_name
from topo_verify.proofs.theorem import Budget, Query, RefutationCertificate, Theorem, TheoremResult
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.classes import WorldClass

MOST_EDGES = 6
"""The largest size of the one-door theorems: a few seconds in all."""

WORD_EDGES, DEEP_WORD_EDGES = 3, 4
"""The largest sizes of whole words: 4 edges take a minute each, and records longer."""


def bounded(edges: int = MOST_EDGES) -> tuple[Theorem, ...]:
    """All bounded theorems; the one-door ones speak of worlds up to this size.

    Raises:
        InputError: no edges, or too many to be feasible.
    """
    if not 1 <= edges <= MOST_EDGES:
        raise InputError(
            f"--edges {edges}: bounded theorems are proved for 1 to {MOST_EDGES} edges (beyond,"
            " the inductive ones speak of worlds of any size)"
        )
    small = range(1, min(edges, WORD_EDGES) + 1)
    deep = range(1, DEEP_WORD_EDGES + 1)
    return (
        *(theorem(statement, range(1, edges + 1)) for statement in ONE_DOOR_STATEMENTS),
        *(
            theorem(statement, small)
            for statement in WHOLE_WORD_STATEMENTS
            if statement.least <= edges
        ),
        *(
            # Whatever `edges` is: `catalogue.choose` leaves out what is larger than asked for.
            theorem(statement, deep, name=f"{statement.name}-deep", deep=True)
            for statement in WHOLE_WORD_STATEMENTS
            if not statement.name.startswith("words-records")
        ),
        *(_below(negative) for negative in negatives.SMALLEST),
        worlds_theorem("bounded-worlds", range(1, 5)),
        worlds_theorem("bounded-worlds-deep", range(1, 6), deep=True),
    )


def theorem(
    statement: BoundedStatement, sizes: range, *, name: str | None = None, deep: bool = False
) -> Theorem:
    """The statement as a theorem about worlds with these numbers of edges."""
    name = name or statement.name
    sizes = range(max(sizes[0], statement.least), sizes[-1] + 1)
    return Theorem(
        name=name,
        kind="bounded",
        claims=statement.claims,
        words=statement.words,
        symbols=statement.symbols,
        solver_part=f"all of it, in every world with {_span(sizes)}",
        argued=statement.argued,
        assumed=("the encoding",),
        expected="EXHAUSTED",
        prove=partial(_prove, name, statement, sizes),
        queries=partial(_questions, name, statement.refuted, sizes),
        edges=sizes[-1],
        deep=deep,
    )


def _below(negative: negatives.Negative) -> Theorem:
    """The theorem that a negative has no counterexample below its smallest size."""

    def refuted(edges: int) -> Worlds:
        kind, marker = negative.world_class, negative.marker
        return negatives.false_confirmation(edges, kind, marker).world

    statement = BoundedStatement(
        name=f"{negative.name}-below",
        claims=("no-false-confirm",),
        words=f"{negative.statement} With fewer edges there is no such world.",
        symbols="every percept on a shortest way home as expected ⇒ h = alpha(e)",
        refuted=refuted,
        premises=partial(negatives.premises, world_class=negative.world_class),
        world_class=negative.world_class,
    )
    return theorem(statement, range(1, negative.edges))


# ------------------------------------------------------------------ proving them


def _prove(name: str, statement: BoundedStatement, sizes: range, budget: Budget) -> TheoremResult:
    """The result over all sizes; the first size with an unexpected answer decides it."""
    if budget.certify:
        drup.require_tools()
    began = perf_counter()
    cores: set[str] = set()
    premises: list[bool | None] = []
    attempts: list[RefutationCertificate | str] = []
    checked = 0
    total = sum(WorldClass.parse(statement.world_class).count(m) for m in sizes)

    def outcome(
        verdict: Verdict, note: str = "", counterexample: str | None = None
    ) -> TheoremResult:
        known = None if None in premises else all(premises)
        certificate, without = _one_certificate(attempts, sizes)
        return TheoremResult(
            verdict=verdict,
            solver=solver_name(),
            seconds=perf_counter() - began,
            premises_satisfiable=False if False in premises else known,
            core=tuple(sorted(cores)),
            checked=checked,
            total=total,
            counterexample=counterexample,
            certificate=certificate,
            note=note or without,
        )

    for done, m in enumerate(sizes):
        budget.progress(name, done, len(sizes))
        formula = statement.refuted(m)
        result = solve(formula, budget)
        if result.answer != "unsat":
            return outcome(*_not_proved(formula, result, m))
        cores |= set(result.core)
        # Unsatisfiable premises would make any conclusion hold, so they are asked for each size.
        alone = formula.premises() if statement.premises is None else statement.premises(m)
        premises.append({"sat": True, "unsat": False, "unknown": None}[solve(alone, budget).answer])
        worlds = worlds_encoded(m, statement.world_class)
        if worlds is None:
            return outcome("UNKNOWN", f"the worlds with {m} edges could not be counted")
        checked += worlds
        # After one size without a certificate there can be none for the theorem: stop making them.
        if budget.certify and not any(isinstance(attempt, str) for attempt in attempts):
            attempts.append(drup.certify(formula, seconds=budget.timeout))
    return outcome("EXHAUSTED")


def _not_proved(formula: Worlds, result: SatResult, m: int) -> tuple[Verdict, str, str | None]:
    """Verdict, note and counterexample if the clauses of one size were not unsatisfiable."""
    if result.model is not None:
        world = decode_world(formula, result.model).id
        return "REFUTED", f"it is false in {world}: `--smt2` writes the question", world
    note = f"m = {m}: {result.why}; more time: --timeout, fewer edges: --edges"
    return "UNKNOWN", note, None


def _one_certificate(
    attempts: list[RefutationCertificate | str], sizes: range
) -> tuple[RefutationCertificate | None, str]:
    """The certificates of all sizes as one; or, if a size has none, a note that says why."""
    made = [attempt for attempt in attempts if isinstance(attempt, RefutationCertificate)]
    # A certificate that the checker refused is a bug, so it is shown whatever the others are.
    if not attempts or any(not attempt.checked for attempt in made):
        return (drup.together(made) if made else None), ""
    if len(made) == len(sizes):
        return drup.together(made), ""
    for m, attempt in zip(sizes, attempts, strict=False):
        if isinstance(attempt, str):
            return (
                None,
                f"certificates checked for {len(made)} of {len(sizes)} sizes; m = {m}: {attempt}",
            )
    return None, ""


def _questions(
    name: str, refuted: Callable[[int], Formula], sizes: Iterable[int]
) -> Iterator[Query]:
    for m in sizes:
        yield Query(f"{name}-m{m}", refuted(m).smt2() + "(check-sat)\n", "unsat")


def worlds_theorem(name: str, sizes: range, *, deep: bool = False) -> Theorem:
    """The models of the encoding are the canonical codes, each once.

    The exported and certified question is that there is no other model; the list shows that there
    is one for each code.
    """

    def prove(budget: Budget) -> TheoremResult:
        if budget.certify:
            drup.require_tools()
        began = perf_counter()
        found, wrong = 0, ""
        attempts: list[RefutationCertificate | str] = []
        verdict: Verdict = "EXHAUSTED"
        try:
            for done, m in enumerate(sizes):
                budget.progress(name, done, len(sizes))
                models, missing, spurious = missing_and_spurious(m, budget=budget)
                found += models
                if missing or spurious:
                    verdict, wrong = "REFUTED", str((missing or spurious)[0])
                elif budget.certify:
                    attempts.append(drup.certify(another_world(m), seconds=budget.timeout))
        except SolverGaveUp as gave_up:
            verdict, wrong = "UNKNOWN", str(gave_up)
        certificate, without = _one_certificate(attempts, sizes)
        return TheoremResult(
            verdict=verdict,
            solver=solver_name(),
            seconds=perf_counter() - began,
            premises_satisfiable=found > 0,
            checked=found,
            total=sum(map(rank_order.count, sizes)),
            counterexample=wrong if verdict == "REFUTED" else None,
            certificate=certificate,
            note=wrong or without,
        )

    return Theorem(
        name=name,
        kind="bounded",
        claims=(),
        words="The worlds of the encoding are the canonical codes, each of them once.",
        symbols="{models} = {codes of rooted maps with m edges}",
        solver_part=f"lists all models with {_span(sizes)}; they are compared with the enumeration",
        assumed=("the encoding",),
        expected="EXHAUSTED",
        prove=prove,
        queries=partial(_questions, name, another_world, sizes),
        edges=sizes[-1],
        deep=deep,
    )


def _span(sizes: range) -> str:
    many = f"{sizes[0]} to {sizes[-1]} edges" if len(sizes) > 1 else f"{sizes[0]} edge"
    return many if sizes[-1] == 1 or len(sizes) > 1 else f"{many}s"
