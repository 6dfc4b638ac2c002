"""Models over tiny domains, found by expanding the quantifiers.

With quantifiers Z3 finds contradictions, but no models. So each sort gets a few named elements, and
each `for all` becomes a conjunction. Each formula is evaluated in the model again without Z3.

What this does not show: that there is no larger model.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product

from topo_verify.errors import InternalError
from topo_verify.proofs.first_order import terms
from topo_verify.proofs.solvers import z3_solver
from topo_verify.proofs.theorem import Budget, SolverAnswer

SIZES = ((1, 1), (2, 1), (2, 2), (3, 2), (3, 3), (4, 4))
"""The number of darts of the world and of elements of other sorts, in order."""


@dataclass(frozen=True, slots=True)
class FiniteModel:
    """The answer to a search, with the structure and its tables if `sat`."""

    answer: SolverAnswer
    structure: terms.Structure | None = None
    tables: Mapping[str, Mapping[tuple[int, ...], terms.Value]] | None = None
    why: str = ""


def smallest(assertions: Mapping[str, terms.Term], budget: Budget) -> FiniteModel:
    """A model of the first of `SIZES` that has one."""
    formulas = list(assertions.values())
    last = FiniteModel("unknown", why="no size was tried")
    for darts, others in SIZES:
        last = model(formulas, _sizes(formulas, darts, others), budget)
        # After `unknown` a larger model may not be the smallest.
        if last.answer != "unsat":
            return last
    return last


def _sizes(formulas: Sequence[terms.Term], darts: int, others: int) -> dict[str, int]:
    sorts = sorted(set[str]().union(*map(terms.sorts_of, formulas)) - {terms.BOOL})
    return {sort: darts if sort == "W" else others for sort in sorts}


def model(formulas: Sequence[terms.Term], sizes: Mapping[str, int], budget: Budget) -> FiniteModel:
    """A model with these numbers of elements, if any.

    Raises:
        InternalError: a formula fails in the solver's model.
    """
    entries = list(_entries(formulas, sizes))
    wanted = (*_elements(sizes), *(alias for alias, _, _, _ in entries))
    sorts = {constant.symbol.name: constant.sort for constant in wanted}
    reply = z3_solver.find_values(grounded(formulas, sizes), sorts, budget)
    if reply.answer != "sat":
        return FiniteModel(reply.answer, why=reply.why)
    number = {
        sort: {reply.values[element(sort, n).symbol.name]: n for n in range(size)}
        for sort, size in sizes.items()
    }
    rows: dict[str, dict[tuple[int, ...], terms.Value]] = {}
    for alias, symbol, row, _ in entries:
        value = reply.values[alias.symbol.name]
        known = value == "True" if symbol.result == terms.BOOL else number[symbol.result][value]
        rows.setdefault(symbol.name, {})[row] = known
    named: dict[str, dict[tuple[int, ...], terms.Value]] = {
        element(sort, n).symbol.name: {(): n} for sort, size in sizes.items() for n in range(size)
    }
    structure = terms.of_tables(sizes, {**rows, **named})
    for formula in formulas:
        if not structure.holds(formula):
            raise InternalError(f"{formula} does not hold in the model that Z3 found for it")
    return FiniteModel("sat", structure, rows)


def element(sort: str, number: int) -> terms.App:
    return terms.Symbol(f"{sort}!{number}", (), sort)()


def ground(term: terms.Term, sizes: Mapping[str, int]) -> terms.Term:
    match term:
        case terms.Var():
            return term
        case terms.App(symbol, arguments):
            return terms.App(symbol, tuple(ground(part, sizes) for part in arguments))
        case terms.Forall(variables, body):
            cases: list[dict[terms.Term, terms.Term]] = [
                {v: element(v.sort, n) for v, n in zip(variables, row, strict=True)}
                for row in product(*(range(sizes[v.sort]) for v in variables))
            ]
            return terms.conj(*(ground(terms.substitute(body, case), sizes) for case in cases))


def _elements(sizes: Mapping[str, int]) -> Iterator[terms.App]:
    for sort, size in sizes.items():
        yield from (element(sort, number) for number in range(size))


FunctionValue = tuple[terms.App, terms.Symbol, tuple[int, ...], terms.App]
"""The constant that names a value, its symbol, arguments and term."""


def _entries(formulas: Sequence[terms.Term], sizes: Mapping[str, int]) -> Iterator[FunctionValue]:
    declared = {symbol.name: symbol for formula in formulas for symbol in terms.symbols(formula)}
    named = {element(sort, n).symbol.name for sort, size in sizes.items() for n in range(size)}
    for name in sorted(declared.keys() - named):
        symbol = declared[name]
        for row in product(*(range(sizes[sort]) for sort in symbol.arguments)):
            alias = terms.Symbol(f"{name}!{'!'.join(map(str, row))}", (), symbol.result)()
            pairs = zip(symbol.arguments, row, strict=True)
            yield alias, symbol, row, symbol(*(element(sort, number) for sort, number in pairs))


def _domains(entries: Sequence[FunctionValue], sizes: Mapping[str, int]) -> Iterator[terms.Term]:
    for sort, size in sizes.items():
        for one, other in combinations(range(size), 2):
            yield terms.differ(element(sort, one), element(sort, other))
    # The alias makes Z3 name the value in its model.
    for alias, symbol, _, applied in entries:
        yield terms.eq(alias, applied)
        if symbol.result != terms.BOOL:
            values = (element(symbol.result, n) for n in range(sizes[symbol.result]))
            yield terms.disj(*(terms.eq(alias, value) for value in values))


def question(assertions: Mapping[str, terms.Term]) -> str:
    """The SMT-LIB script for the last of `SIZES`."""
    formulas = list(assertions.values())
    return grounded(formulas, _sizes(formulas, *SIZES[-1]))


def grounded(formulas: Sequence[terms.Term], sizes: Mapping[str, int]) -> str:
    entries = list(_entries(formulas, sizes))
    rows = [*(ground(formula, sizes) for formula in formulas), *_domains(entries, sizes)]
    # No symbol is called c0, c1, ...
    return terms.script({f"c{number}": term for number, term in enumerate(rows)}, logic="QF_UF")


def described(model: FiniteModel) -> str:
    """The structure in one line: sizes, then values in the order of arguments."""
    assert model.structure is not None
    assert model.tables is not None
    sizes = ", ".join(f"{size} {sort}" for sort, size in model.structure.sizes.items())
    rows = " ".join(
        f"{name}={','.join(str(int(value)) for value in table.values())}"
        for name, table in sorted(model.tables.items())
    )
    return f"{sizes}: {rows}"
