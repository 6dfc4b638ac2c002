"""All theorems in one order, and the choice among them.

Names are unique and never change. Each engine has its tables:

    kind        table                                          an entry
    inductive   first_order/obligations/<theme>.OBLIGATIONS    an `Obligation`
    mechanised  coq/theorems.csv                               a theorem of coq/
    bounded     bounded/statements.py                          a `BoundedStatement`
    negative    bounded/mutants.SMALLEST                       a `Negative`
    mutant      `needs` of an obligation                       a dropped premise
                first_order/mutants/<theme>.py                 a `RuleMutant`
                bounded/mutants.py                             a rule with a `RuleFault`
"""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from functools import cache

from topo_verify.errors import InputError, InternalError
from topo_verify.proofs.bounded import mutants as bounded_mutants
from topo_verify.proofs.bounded.theorems import MOST_EDGES, bounded
from topo_verify.proofs.first_order import theorems as first_order
from topo_verify.proofs.mechanised.theorems import MECHANISED, STATEMENTS
from topo_verify.proofs.theorem import Theorem, TheoremKind

QUICK: tuple[TheoremKind, ...] = ("inductive", "negative", "mutant")


@cache
def catalogue(edges: int | None = None) -> tuple[Theorem, ...]:
    """All theorems; bounded ones for worlds of up to `edges`.

    Raises:
        InputError: no edges, or more than are feasible.
    """
    theorems = (
        *first_order.INDUCTIVE,
        *MECHANISED,
        *bounded(MOST_EDGES if edges is None else edges),
        *bounded_mutants.NEGATIVES,
        first_order.PLANAR,
        *first_order.AXIOM_MUTANTS,
        *first_order.FAULTY_RULES,
        *bounded_mutants.MUTANTS,
    )
    names = [theorem.name for theorem in theorems]
    if doubled := sorted({name for name in names if names.count(name) > 1}):
        raise InternalError(f"two theorems are called {', '.join(doubled)}")
    return theorems


def choose(
    names: Sequence[str] = (),
    *,
    kinds: Sequence[str] = (),
    edges: int | None = None,
    deep: bool = False,
) -> tuple[Theorem, ...]:
    """The theorems with these names, of these kinds, with at most these edges.

    Args:
        names: none: all that take seconds. One in Coq is also found by its name there.
        deep: also those that take minutes; named ones are always chosen, mechanised ones by kind.
    Raises:
        InputError: no such theorem, or too many edges.
    """
    everything = catalogue(edges)
    known = {theorem.name: theorem for theorem in everything}
    in_coq = {f"{row.file}.{row.theorem}": row.name for row in STATEMENTS}
    in_coq |= {row.theorem: row.name for row in STATEMENTS}
    names = [name if name in known else in_coq.get(name, name) for name in names]
    for name in names:
        if name not in known:
            close = get_close_matches(name, known, n=3)
            mend = f"do you mean {' or '.join(close)}? " if close else ""
            raise InputError(
                f"no theorem {name!r} in the catalogue: {mend}topo-verify prove --list lists them;"
                " other lemmas of Coq are in topo_verify/proofs/coq"
            )
    chosen = tuple(known[name] for name in dict.fromkeys(names)) or tuple(
        theorem
        for theorem in everything
        if deep or not theorem.deep or (theorem.kind == "mechanised" and "mechanised" in kinds)
    )
    selection = tuple(
        theorem
        for theorem in chosen
        if (not kinds or theorem.kind in kinds)
        and (edges is None or theorem.edges is None or theorem.edges <= edges)
    )
    if not selection:
        kind = f"of kind {' or '.join(kinds)}" if kinds else "of any kind"
        size = "" if edges is None else f" with at most {edges} edges"
        raise InputError(
            f"no theorem {kind}{size} among {', '.join(names) or 'all'}: topo-verify prove --list"
            " lists them with their kinds and edges"
        )
    return selection
