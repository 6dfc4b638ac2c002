"""The statements of the bounded theorems, in words, in symbols, and as clauses.

Their clauses are in `door_steps.py` (one door) and `word_rules.py` (whole words); `theorems.py`
proves them. A new statement is one entry here.

    S, U        a map that can be reached; its unexplored darts         W     the world
    p, r        a dart of S, a reference dart of the robot              p'    behind the door
    e, h        the dart that is crossed; a hypothesis for its other end
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from topo_verify.proofs.bounded import door_steps, word_rules
from topo_verify.proofs.bounded.cnf import Formula
from topo_verify.proofs.bounded.encoding import Worlds


@dataclass(frozen=True, slots=True, kw_only=True)
class BoundedStatement:
    """A bounded theorem, for any number of edges.

    Attributes:
        refuted: given a number of edges, the clauses of a counterexample: they must contradict.
        premises: the clauses that must be satisfiable, or the statement is vacuous; None: those of
            `refuted` without the negated conclusion.
        least: the fewest edges with which it is not vacuous.
    """

    name: str
    claims: tuple[str, ...]
    words: str
    symbols: str
    refuted: Callable[[int], Worlds]
    premises: Callable[[int], Formula] | None = None
    least: int = 1
    world_class: str = "any"
    argued: tuple[str, ...] = ()


_BY_DOORS = ("doors",)
"""The induction from one door to words of any length, by its name in docs/proofs.md."""

ONE_DOOR_STATEMENTS = (
    BoundedStatement(
        name="bounded-pose",
        claims=("true-hypothesis-posed",),
        words="If e leads to a known vertex, its other end is unexplored and not e: a hypothesis.",
        symbols="alpha(e) ∈ S ⇒ alpha(e) ∈ U \\ {e}",
        refuted=door_steps.pose,
    ),
    BoundedStatement(
        name="bounded-door",
        claims=("true-hypothesis-kept", "map-isomorphic"),
        words="Through an explored door of S and the same door of the world, corresponding darts"
        " lead to corresponding darts, which show the same percept.",
        symbols="p = r, x = sigma^k(p) explored ⇒ p' = r' ∧ percept(p') = percept(r')",
        refuted=door_steps.door,
        argued=_BY_DOORS,
    ),
    BoundedStatement(
        name="bounded-confirm-final",
        claims=("no-false-confirm",),
        words="Two places that show v0's percept with the same marker direction are one dart.",
        symbols="p ∈ v0 ∧ percept(p) = percept(r) ⇒ p = r",
        refuted=door_steps.confirm_final,
    ),
    BoundedStatement(
        name="bounded-confirm-back",
        claims=("no-false-confirm",),
        words="Where a door of S and the same door of the world lead to one dart, they leave from"
        " one dart.",
        symbols="x = sigma^k(p) explored ∧ p' = r' ⇒ p = r",
        refuted=door_steps.confirm_back,
        argued=_BY_DOORS,
    ),
    BoundedStatement(
        name="bounded-record",
        claims=("true-hypothesis-kept",),
        words="The percept recorded behind an unexplored dart is seen there on any later map, too.",
        symbols="S ⊆ S', sigma^k(q) = sigma^l(p) = d ∈ U' ⇒ percept(q') = percept(p')",
        refuted=door_steps.record,
    ),
    BoundedStatement(
        name="bounded-new-vertex",
        claims=("map-isomorphic",),
        words="If e leads to no known dart, S knows no dart of the vertex behind it.",
        symbols="alpha(e) ∉ S ⇒ sigma^k(alpha(e)) ∉ S",
        refuted=door_steps.new_vertex,
    ),
    BoundedStatement(
        name="bounded-closed",
        claims=("map-isomorphic",),
        words="A map with no unexplored dart is the whole world.",
        symbols="U = ∅ ⇒ S = W",
        refuted=door_steps.closed,
    ),
)


def _word(build: Callable[[int, int], word_rules.EncodedCounterexample], edges: int) -> Worlds:
    # m doors are enough for any way home: it is simple, so it has at most n - 1 <= m.
    return build(edges, edges).world


WHOLE_WORD_STATEMENTS = (
    BoundedStatement(
        name="words-confirm",
        claims=("no-false-confirm",),
        words="A way home from h whose last percept is v0's as expected proves that e ends in h.",
        symbols="w ≤ m doors from h to v0 on S, percepts equal at its end ⇒ h = alpha(e)",
        refuted=partial(_word, word_rules.confirm),
    ),
    BoundedStatement(
        name="words-trace",
        claims=("true-hypothesis-kept",),
        words="On every way over explored edges the true hypothesis meets the percepts it expects.",
        symbols="h = alpha(e), w ≤ m doors on S ⇒ all percepts equal",
        refuted=partial(_word, word_rules.trace_way),
        # With one edge, which is e, S has explored nothing, so nothing would be compared.
        least=2,
    ),
    BoundedStatement(
        name="words-prefix",
        claims=("true-hypothesis-kept",),
        words="Rule prefix keeps the true hypothesis, whatever word was executed.",
        symbols="h = alpha(e), own way and executed word of ≤ m doors ⇒ equal on the common prefix",
        refuted=partial(_word, word_rules.prefix),
        least=2,
    ),
    BoundedStatement(
        name="words-history",
        claims=("true-hypothesis-kept",),
        words="Rule history keeps the true hypothesis, whatever word was executed.",
        symbols="h = alpha(e), any word of m doors ⇒ equal until it crosses an unexplored dart",
        refuted=partial(_word, word_rules.history),
        least=2,
    ),
    BoundedStatement(
        name="words-records-one",
        claims=("true-hypothesis-kept",),
        words="Rule records(1) keeps the true hypothesis, whatever was recorded on an earlier map.",
        symbols="as words-history, and T[d] equals the percept behind d",
        refuted=partial(_word, partial(word_rules.records, levels=1)),
        least=2,
    ),
    BoundedStatement(
        name="words-records-all",
        claims=("true-hypothesis-kept",),
        words="Rule records(∞) keeps the true hypothesis, whatever was recorded on an earlier map.",
        symbols="as words-history, and T[d] equals the percepts behind d as deep as doors agree",
        refuted=partial(_word, partial(word_rules.records, levels=None)),
        least=2,
    ),
)
