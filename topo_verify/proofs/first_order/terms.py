"""Formulas of many-sorted first-order logic.

    Var     x, bound by a quantifier or free         App   f(a, b), also `and`, `=>`, `=`, ...
    Symbol  a function: name, sorts, result           Forall for all x ...: body

One term is written as SMT-LIB 2, expanded over tiny domains (`finite_models.py`), and evaluated in
a `Structure`, so the proved and the tested formula are the same. The elements of a sort are the
integers from 0.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import product

BOOL = "Bool"


@dataclass(frozen=True, slots=True)
class Symbol:
    """A function symbol; call it to apply it."""

    name: str
    arguments: tuple[str, ...]
    result: str

    def __call__(self, *arguments: Term) -> App:
        sorts = tuple(argument.sort for argument in arguments)
        if sorts != self.arguments:
            raise TypeError(f"{self.name} takes {self.arguments}, not {sorts}")
        return App(self, arguments)


@dataclass(frozen=True, slots=True)
class Var:
    name: str
    sort: str


@dataclass(frozen=True, slots=True)
class App:
    symbol: Symbol
    arguments: tuple[Term, ...] = ()

    @property
    def sort(self) -> str:
        return self.symbol.result


@dataclass(frozen=True, slots=True)
class Forall:
    """The body holds for all values; `patterns` tell a solver where to instantiate."""

    variables: tuple[Var, ...]
    body: Term
    patterns: tuple[tuple[Term, ...], ...] = ()

    @property
    def sort(self) -> str:
        return BOOL


Term = Var | App | Forall


def conj(*parts: Term) -> Term:
    return parts[0] if len(parts) == 1 else _connect("and", *parts)


def disj(*parts: Term) -> Term:
    return parts[0] if len(parts) == 1 else _connect("or", *parts)


def neg(part: Term) -> Term:
    return _connect("not", part)


def implies(*parts: Term) -> Term:
    """The last holds if all others do."""
    return _connect("=>", conj(*parts[:-1]), parts[-1])


def eq(one: Term, other: Term) -> Term:
    """Equal terms, equivalent formulas."""
    if one.sort != other.sort:
        raise TypeError(f"= between {one.sort} and {other.sort}")
    # One symbol `=` for each sort, so sorts are checked.
    return App(Symbol("=", (one.sort, one.sort), BOOL), (one, other))


def differ(one: Term, other: Term) -> Term:
    return neg(eq(one, other))


def forall(
    variables: Var | tuple[Var, ...], *parts: Term, tried_at: tuple[tuple[Term, ...], ...] = ()
) -> Term:
    """For all values of the variables, the last part holds if all others do."""
    row = (variables,) if isinstance(variables, Var) else variables
    return Forall(row, parts[0] if len(parts) == 1 else implies(*parts), tried_at)


def _connect(name: str, *parts: Term) -> Term:
    return Symbol(name, (BOOL,) * len(parts), BOOL)(*parts)


def constant(name: str, sort: str) -> App:
    return Symbol(name, (), sort)()


def symbols(term: Term) -> Iterator[Symbol]:
    """Yield the symbols that need a declaration, with repetitions."""
    match term:
        case Var():
            pass
        case Forall(_, body, patterns):
            yield from symbols(body)
            for group in patterns:
                for hint in group:
                    yield from symbols(hint)
        case App(symbol, arguments):
            if symbol.name not in CONNECTIVES:
                yield symbol
            for argument in arguments:
                yield from symbols(argument)


def sorts_of(term: Term) -> set[str]:
    match term:
        case Var(_, sort):
            return {sort}
        case Forall(variables, body):
            return {v.sort for v in variables} | sorts_of(body)
        case App(symbol, arguments):
            own = set[str]() if symbol.name in CONNECTIVES else {*symbol.arguments, symbol.result}
            return own.union(*map(sorts_of, arguments))


def substitute(term: Term, values: dict[Term, Term]) -> Term:
    """Replace free variables or constants by closed terms."""
    if term in values:
        return values[term]
    match term:
        case Var():
            return term
        case Forall(variables, body, patterns):
            inner = {old: new for old, new in values.items() if old not in variables}
            hints = tuple(tuple(substitute(p, inner) for p in group) for group in patterns)
            return Forall(variables, substitute(body, inner), hints)
        case App(symbol, arguments):
            return App(symbol, tuple(substitute(argument, values) for argument in arguments))


def text(term: Term) -> str:
    """The term in SMT-LIB 2."""
    match term:
        case Var(name):
            return name
        case Forall(variables, body, patterns):
            bound = " ".join(f"({v.name} {v.sort})" for v in variables)
            hints = "".join(f" :pattern ({' '.join(map(text, group))})" for group in patterns)
            return f"(forall ({bound}) {f'(! {text(body)}{hints})' if hints else text(body)})"
        case App(symbol, ()):
            return symbol.name
        case App(symbol, arguments):
            return f"({symbol.name} {' '.join(map(text, arguments))})"


_WORDS = {"and": " ∧ ", "or": " or ", "=>": " → ", "=": " = "}


def shown(term: Term, *, inner: bool = False) -> str:
    """The term in mathematical notation."""
    words = ""
    match term:
        case Var(name):
            return name
        case Forall(variables, body):
            words = f"∀{','.join(v.name for v in variables)}: {shown(body)}"
        case App(Symbol("not"), (App(Symbol("="), (one, other)),)):
            return f"{shown(one, inner=True)} ≠ {shown(other, inner=True)}"
        case App(Symbol("not"), (part,)):
            return f"¬{shown(part, inner=True)}"
        case App(symbol, arguments) if symbol.name in _WORDS:
            words = _WORDS[symbol.name].join(shown(a, inner=True) for a in arguments)
        case App(symbol, arguments):
            row = ", ".join(shown(a) for a in arguments)
            return f"{symbol.name}({row})" if arguments else symbol.name
    return f"({words})" if inner else words


def declarations(terms: Iterator[Term] | list[Term]) -> list[str]:
    """The declarations of all sorts and symbols, sorted, so the same terms give the same text.

    Raises:
        TypeError: two symbols have one name.
    """
    known: dict[str, Symbol] = {}
    sorts: set[str] = set()
    for term in terms:
        sorts |= sorts_of(term)
        for symbol in symbols(term):
            if known.setdefault(symbol.name, symbol) != symbol:
                raise TypeError(f"two symbols are called {symbol.name}")
    lines = [f"(declare-sort {sort} 0)" for sort in sorted(sorts - {BOOL})]
    return lines + [
        f"(declare-fun {symbol.name} ({' '.join(symbol.arguments)}) {symbol.result})"
        for symbol in sorted(known.values(), key=lambda symbol: symbol.name)
    ]


def script(assertions: dict[str, Term], *, logic: str = "UF") -> str:
    """The SMT-LIB 2 script that asks whether all these formulas can hold.

    Raises:
        TypeError: a name is also that of a symbol.
    """
    used = {symbol.name for term in assertions.values() for symbol in symbols(term)}
    if clash := sorted(used & assertions.keys()):
        raise TypeError(f"{', '.join(clash)}: an assertion is called like a symbol")
    lines = [f"(set-logic {logic})", *declarations(list(assertions.values()))]
    lines += [f"(assert (! {text(term)} :named {name}))" for name, term in assertions.items()]
    return "\n".join([*lines, "(check-sat)", ""])


Value = int | bool
Function = Callable[..., Value]


@dataclass(frozen=True, slots=True)
class Structure:
    """The meaning of the symbols, and the number of elements of each quantified sort."""

    sizes: Mapping[str, int]
    functions: Mapping[str, Function]

    def holds(self, term: Term, **values: Value) -> bool:
        """Is the formula true for these values of its free variables?"""
        return bool(self.value(term, values))

    def value(self, term: Term, values: Mapping[str, Value]) -> Value:
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
    "=>": lambda row: not next(row) or next(row),
    "=": lambda row: next(row) == next(row),
}
"""The symbols that need no declaration."""


def of_tables(
    sizes: Mapping[str, int], tables: Mapping[str, Mapping[tuple[int, ...], Value]]
) -> Structure:

    def reading(table: Mapping[tuple[int, ...], Value]) -> Function:
        return lambda *arguments: table[arguments]

    return Structure(sizes, {name: reading(table) for name, table in tables.items()})
