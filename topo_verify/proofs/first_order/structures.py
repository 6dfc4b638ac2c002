"""Concrete structures, in which formulas are evaluated without a solver.

A structure gives the number of elements of each sort and a function for each symbol; elements are
the integers from 0. Every model that a solver finds is evaluated here before it counts, and tests
evaluate the formulas of the theory in real worlds and real runs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import product

from topo_verify.proofs.first_order.terms import App, Forall, Term, Var

Value = int | bool
Function = Callable[..., Value]


@dataclass(frozen=True, slots=True)
class Structure:
    """The meaning of the symbols.

    Attributes:
        sizes: the number of elements of each sort that is quantified over.
        functions: the function of each symbol; a constant takes no arguments.
    """

    sizes: Mapping[str, int]
    functions: Mapping[str, Function]

    def holds(self, term: Term, **values: Value) -> bool:
        """Whether a formula is true, with these values for its free variables."""
        return bool(self.value(term, values))

    def value(self, term: Term, values: Mapping[str, Value]) -> Value:
        """The value of a term."""
        match term:
            case Var(name):
                return values[name]
            case Forall(variables, body):
                return self._all(variables, body, values)
            case App(symbol, arguments):
                return self._apply(symbol.name, arguments, values)

    def _all(self, variables: tuple[Var, ...], body: Term, values: Mapping[str, Value]) -> bool:
        ranges = [range(self.sizes[v.sort]) for v in variables]
        names = [v.name for v in variables]
        return all(
            self.value(body, {**values, **dict(zip(names, row, strict=True))})
            for row in product(*ranges)
        )

    def _apply(self, name: str, arguments: tuple[Term, ...], values: Mapping[str, Value]) -> Value:
        row = (self.value(part, values) for part in arguments)  # lazy: `and`, `or` stop early
        if (connective := CONNECTIVES.get(name)) is not None:
            return connective(row)
        return self.functions[name](*row)


CONNECTIVES: Mapping[str, Callable[[Iterator[Value]], Value]] = {
    "true": lambda _: True,
    "not": lambda row: not next(row),
    "and": all,
    "or": any,
    # Two arguments each: terms.py makes no others.
    "=>": lambda row: not next(row) or next(row),
    "=": lambda row: next(row) == next(row),
}


def of_tables(
    sizes: Mapping[str, int], tables: Mapping[str, Mapping[tuple[int, ...], Value]]
) -> Structure:
    """The structure whose symbols are given by tables."""

    def reading(table: Mapping[tuple[int, ...], Value]) -> Function:
        return lambda *arguments: table[arguments]

    return Structure(sizes, {name: reading(table) for name, table in tables.items()})
