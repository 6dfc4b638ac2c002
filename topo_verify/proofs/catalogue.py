"""Every theorem there is, in one order; choosing among them.

Inductive ones first, then mechanised, bounded, negatives, mutants. Names are unique; scripts may
use them.
"""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from functools import cache

from topo_verify.errors import InputError, InternalError
from topo_verify.proofs.bounded import mutants as bounded_mutants
from topo_verify.proofs.bounded.theorems import MOST_EDGES, bounded
from topo_verify.proofs.first_order import mutants
from topo_verify.proofs.first_order.theorems import AXIOM_MUTANTS, INDUCTIVE
from topo_verify.proofs.mechanised.theorems import MECHANISED
from topo_verify.proofs.theorem import Theorem, TheoremKind

QUICK: tuple[TheoremKind, ...] = ("inductive", "negative", "mutant")
"""The kinds that are done in seconds."""


@cache
def catalogue(edges: int | None = None) -> tuple[Theorem, ...]:
    """All theorems.

    Args:
        edges: the size up to which the bounded ones speak; default: as far as is quick.
    Raises:
        InputError: too many edges.
    """
    theorems = (
        *INDUCTIVE,
        *MECHANISED,
        *bounded(MOST_EDGES if edges is None else edges),
        *bounded_mutants.negative(),
        mutants.PLANAR,
        *AXIOM_MUTANTS,
        *mutants.MUTANTS,
        *bounded_mutants.mutants(),
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
    """The theorems with these names, or of these kinds, or all; long ones only if asked for.

    Args:
        edges: bounded theorems up to this size; of negatives and mutants those within it.
        deep: also the long ones. A theorem that is named is chosen, long or not; the mechanised
            ones, which need Coq, also where their kind is asked for.
    Raises:
        InputError: no such theorem, no theorem of these kinds with that name, too many edges.
    """
    everything = catalogue(edges)
    known = {theorem.name: theorem for theorem in everything}
    for name in names:
        if name not in known:
            close = get_close_matches(name, known, n=3)
            mend = f"do you mean {' or '.join(close)}? " if close else ""
            raise InputError(f"no theorem {name!r}: {mend}topo-verify prove --list lists them")
    chosen = tuple(known[name] for name in dict.fromkeys(names)) or tuple(
        theorem
        for theorem in everything
        if deep or not theorem.deep or (theorem.kind == "mechanised" and "mechanised" in kinds)
    )
    found = tuple(
        theorem
        for theorem in chosen
        if (not kinds or theorem.kind in kinds)
        and (edges is None or theorem.edges is None or theorem.edges <= edges)
    )
    if not found:
        what = f"of kind {' or '.join(kinds)}" if kinds else "of any kind"
        size = "" if edges is None else f" with at most {edges} edges"
        raise InputError(
            f"no theorem {what}{size} among {', '.join(names) or 'all'}: topo-verify prove --list"
            " lists them with their kinds and edges"
        )
    return found
