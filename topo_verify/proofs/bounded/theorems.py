"""The bounded theorems: they hold in every world with m edges, on every reachable map.

    one-door   one door at any place, m = 1 … 6
    words      whole words of up to m doors, m = 1 … 3; with --deep m = 4, where feasible
    below      without the marker's direction, no false confirmation below certain sizes
               (`confirmations.py`)
    worlds     the worlds of the encoding are the canonical codes, each once

"Every world" is checked: with S = v0 the models are compared with the codes of `world.enumeration`:
2, 10, 74, 706, 8162 with 1 … 5 edges.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cache, partial
from itertools import accumulate

from topo_verify.checkers.findings import Verdict
from topo_verify.errors import InputError
from topo_verify.proofs import theorem as th
from topo_verify.proofs.bounded import confirmations
from topo_verify.proofs.bounded.cnf import REFUTED, Formula, SatResult, SolverGaveUp, models, solve
from topo_verify.proofs.bounded.encoding import Worlds
from topo_verify.proofs.bounded.replay import decode_table, decode_world
from topo_verify.proofs.bounded.statements import (
    ONE_DOOR_STATEMENTS,
    WHOLE_WORD_STATEMENTS,
    BoundedStatement,
)
from topo_verify.proofs.solvers.z3_solver import z3_result
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.enumeration.rank_order import Table

LISTED_EDGES = 4
"""Up to this size encoded worlds are counted one by one; beyond, by formulas."""


def every_world(edges: int, world_class: str = "any") -> Worlds:
    world = Worlds(edges)
    world.restrict(world_class)
    world.number_the_rest()
    return world


def codes(edges: int, world_class: str = "any", budget: th.Budget | None = None) -> Iterator[Table]:
    world = every_world(edges, world_class)
    over = (*world.first, *world.joined.values())
    for model in models(world, over, budget or th.Budget()):
        yield decode_table(world, model)


def missing_and_spurious(
    edges: int, world_class: str = "any", budget: th.Budget | None = None
) -> tuple[int, list[Table], list[Table]]:
    """The number of models; codes without a model; models that are repeated or no code."""
    kind = WorldClass.parse(world_class)
    wanted = {table for table in rank_order.tables(edges) if kind.admits(table)}
    spurious: list[Table] = []
    number = 0
    for code in codes(edges, world_class, budget):
        number += 1
        if code in wanted:
            wanted.remove(code)  # a second model with this code is spurious
        else:
            spurious.append(code)
    return number, sorted(wanted), spurious


def another_world(edges: int) -> Worlds:
    """The clauses of a world without a canonical code: they must contradict."""
    world = every_world(edges)
    for degrees, alpha in rank_order.tables(edges):
        # For each code: other vertices, or an edge less.
        firsts = {0, *accumulate(degrees[:-1])}
        numbers = [-world.first[d] if d in firsts else world.first[d] for d in world.darts]
        joined = [-world.edge(d, other) for d, other in enumerate(alpha) if d < other]
        world.add(REFUTED, *numbers, *joined)
    return world


@cache
def worlds_encoded(edges: int, world_class: str = "any") -> int | None:
    """The number of encoded worlds; None: the solver gave up."""
    if edges > LISTED_EDGES:
        return WorldClass.parse(world_class).count(edges)
    try:
        number, _, spurious = missing_and_spurious(edges, world_class)
    except SolverGaveUp:
        return None
    return number - len(spurious)


MOST_EDGES = 6
"""The largest size of the one-door theorems: a few seconds."""

WORD_EDGES, DEEP_WORD_EDGES = 3, 4
"""The largest sizes of whole words; 4 edges take a minute each or longer."""


def bounded(edges: int = MOST_EDGES) -> tuple[th.Theorem, ...]:
    """All bounded theorems; one-door ones up to this size.

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
            theorem(statement, deep, name=f"{statement.name}-deep", deep=True)
            for statement in WHOLE_WORD_STATEMENTS
            if not statement.name.startswith("words-records")
        ),
        *(_below(negative) for negative in confirmations.SMALLEST),
        worlds_theorem("bounded-worlds", range(1, 5)),
        worlds_theorem("bounded-worlds-deep", range(1, 6), deep=True),
    )


def theorem(
    statement: BoundedStatement, sizes: range, *, name: str | None = None, deep: bool = False
) -> th.Theorem:
    name = name or statement.name
    sizes = range(max(sizes[0], statement.least), sizes[-1] + 1)
    return th.Theorem(
        name=name,
        kind="bounded",
        claims=statement.claims,
        words=statement.words,
        symbols=statement.symbols,
        solver_part=f"all of it, in every world with {_span(sizes)}",
        argued=statement.argued,
        assumed=("the encoding",),
        expected="EXHAUSTED",
        prove=th.timed(partial(_prove, name, statement, sizes)),
        queries=partial(_questions, name, statement.refuted, sizes),
        edges=sizes[-1],
        deep=deep,
    )


def _below(negative: confirmations.Negative) -> th.Theorem:

    def refuted(edges: int) -> Worlds:
        kind, marker = negative.world_class, negative.marker
        return confirmations.false_confirmation(edges, kind, marker).world

    statement = BoundedStatement(
        name=f"{negative.name}-below",
        claims=("no-false-confirm",),
        words=f"{negative.statement} With fewer edges there is no such world.",
        symbols="every percept on a shortest way home as expected ⇒ h = alpha(e)",
        refuted=refuted,
        premises=partial(confirmations.premises, world_class=negative.world_class),
        world_class=negative.world_class,
    )
    return theorem(statement, range(1, negative.edges))


def _prove(
    name: str, statement: BoundedStatement, sizes: range, budget: th.Budget
) -> th.TheoremResult:
    cores: set[str] = set()
    premises: list[bool | None] = []
    attempts: list[th.RefutationCertificate | str] = []
    checked = 0
    total = sum(WorldClass.parse(statement.world_class).count(m) for m in sizes)

    def outcome(
        verdict: Verdict, note: str = "", counterexample: str | None = None
    ) -> th.TheoremResult:
        known = None if None in premises else all(premises)
        certificate, without = _one_certificate(attempts, sizes)
        return z3_result(
            verdict=verdict,
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
        # Unsatisfiable premises would make any conclusion hold.
        alone = formula.premises() if statement.premises is None else statement.premises(m)
        premises.append({"sat": True, "unsat": False, "unknown": None}[solve(alone, budget).answer])
        worlds = worlds_encoded(m, statement.world_class)
        if worlds is None:
            return outcome("UNKNOWN", f"the worlds with {m} edges could not be counted")
        checked += worlds
        if budget.certify and not any(isinstance(attempt, str) for attempt in attempts):
            attempts.append(budget.certify(formula, seconds=budget.timeout))
    return outcome("EXHAUSTED")


def _not_proved(formula: Worlds, result: SatResult, m: int) -> tuple[Verdict, str, str | None]:
    if result.model is not None:
        world = decode_world(formula, result.model).id
        return "REFUTED", f"it is false in {world}: `--smt2` writes the question", world
    note = f"m = {m}: {result.why}; more time: --timeout, fewer edges: --edges"
    return "UNKNOWN", note, None


def _one_certificate(
    attempts: list[th.RefutationCertificate | str], sizes: range
) -> tuple[th.RefutationCertificate | None, str]:
    certificates = [
        attempt for attempt in attempts if isinstance(attempt, th.RefutationCertificate)
    ]
    # A refused certificate is a bug, so it is always shown.
    if not attempts or any(not attempt.checked for attempt in certificates):
        return (joint_certificate(certificates) if certificates else None), ""
    if len(certificates) == len(sizes):
        return joint_certificate(certificates), ""
    for m, attempt in zip(sizes, attempts, strict=False):
        if isinstance(attempt, str):
            checked = f"certificates checked for {len(certificates)} of {len(sizes)} sizes"
            return None, f"{checked}; m = {m}: {attempt}"
    return None, ""


def joint_certificate(certificates: Sequence[th.RefutationCertificate]) -> th.RefutationCertificate:
    """One certificate for several formulas, with sums."""
    return replace(
        certificates[0],
        checked=all(part.checked for part in certificates),
        clauses=sum(part.clauses for part in certificates),
        steps=sum(part.steps for part in certificates),
        why=next((part.why for part in certificates if part.why), ""),
    )


def _questions(
    name: str, refuted: Callable[[int], Formula], sizes: Iterable[int]
) -> Iterator[th.Query]:
    for m in sizes:
        yield th.Query(f"{name}-m{m}", refuted(m).smt2() + "(check-sat)\n", "unsat")


def worlds_theorem(name: str, sizes: range, *, deep: bool = False) -> th.Theorem:
    """The models of the encoding are exactly the canonical codes, each once."""

    def prove(budget: th.Budget) -> th.TheoremResult:
        found, wrong = 0, ""
        attempts: list[th.RefutationCertificate | str] = []
        verdict: Verdict = "EXHAUSTED"
        try:
            for done, m in enumerate(sizes):
                budget.progress(name, done, len(sizes))
                models, missing, spurious = missing_and_spurious(m, budget=budget)
                found += models
                if missing or spurious:
                    verdict, wrong = "REFUTED", str((missing or spurious)[0])
                elif budget.certify:
                    attempts.append(budget.certify(another_world(m), seconds=budget.timeout))
        except SolverGaveUp as gave_up:
            verdict, wrong = "UNKNOWN", str(gave_up)
        certificate, without = _one_certificate(attempts, sizes)
        return z3_result(
            verdict=verdict,
            premises_satisfiable=found > 0,
            checked=found,
            total=sum(map(rank_order.count, sizes)),
            counterexample=wrong if verdict == "REFUTED" else None,
            certificate=certificate,
            note=wrong or without,
        )

    return th.Theorem(
        name=name,
        kind="bounded",
        claims=(),
        words="The worlds of the encoding are the canonical codes, each of them once.",
        symbols="{models} = {codes of rooted maps with m edges}",
        solver_part=f"lists all models with {_span(sizes)}; they are compared with the enumeration",
        assumed=("the encoding",),
        expected="EXHAUSTED",
        prove=th.timed(prove),
        queries=partial(_questions, name, another_world, sizes),
        edges=sizes[-1],
        deep=deep,
    )


def _span(sizes: range) -> str:
    many = f"{sizes[0]} to {sizes[-1]} edges" if len(sizes) > 1 else f"{sizes[0]} edge"
    return many if sizes[-1] == 1 or len(sizes) > 1 else f"{many}s"
