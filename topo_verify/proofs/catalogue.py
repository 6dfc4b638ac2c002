"""All theorems in one order, and the choice among them.

Names are unique and never change. Each engine has its tables:

    kind        table                                          an entry
    inductive   first_order/obligations/<theme>.OBLIGATIONS    an `Obligation`
    mechanised  coq/theorems.csv                               a theorem of coq/
    bounded     bounded/statements.py                          a `BoundedStatement`
    negative    bounded/confirmations.CONTROL                  a false claim
    mutant      first_order/theorems.CONTROL                   a theorem without one premise

The last two are controls: a solver that does not refute them is not to be believed. Tests refute
all other negatives, a mutant of each inductive theorem, and rules with one mistake
(tests/proofs/).
"""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from functools import cache

from topo_verify.errors import InputError, InternalError
from topo_verify.proofs.bounded import confirmations
from topo_verify.proofs.bounded.theorems import MOST_EDGES, bounded
from topo_verify.proofs.first_order import theorems as first_order
from topo_verify.proofs.mechanised.theorems import MECHANISED, STATEMENTS
from topo_verify.proofs.theorem import Theorem, TheoremKind

QUICK: tuple[TheoremKind, ...] = ("inductive", "negative", "mutant")

CONTROLS: tuple[Theorem, ...] = (confirmations.CONTROL, first_order.CONTROL)

# fmt: off
FORMER = {
    "confirm-before-home", "confirm-undirected", "confirm-unmarked", "confirm-unturned",
    "conclude-the-last", "fold-ghost-known", "fold-marker-undirected", "fold-next-partner",
    "fold-without-offset", "history-absolute-door", "history-forgets-to-cross",
    "history-next-door", "history-shifted-by-one", "history-through-unexplored",
    "loop-at-first-dart", "marker-from-first-dart", "motion-forgets-turning",
    "motion-shifted-by-one", "new-numbered-late", "new-though-known", "none-any", "none-loopless",
    "none-simple", "planar-keeps", "posed-by-first-dart", "posed-not-at-vk", "prefix-one-too-far",
    "records-read-late", "records-stale-root", "records-written-early", "undirected-loopless",
    "undirected-simple", "words-confirm-none", "words-confirm-undirected",
    "words-history-absolute-doors", "words-history-shifted", "words-history-through-unexplored",
    "words-prefix-one-more", "words-records-all-first-dart", "words-records-one-first-dart",
    "words-trace-shifted", "words-trace-turned",
}
# fmt: on
"""What version 0.4 dropped, beside `…-without-…`: false statements, which are tests now."""


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
        *CONTROLS,
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
            if name in FORMER or name.partition("-without-")[0] in known:
                raise InputError(
                    f"no theorem {name!r} in the catalogue: since version 0.4 false statements are"
                    " tests in tests/proofs/, which `make test` runs in a checkout; two remain as"
                    f" controls, {' and '.join(theorem.name for theorem in CONTROLS)}"
                )
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
