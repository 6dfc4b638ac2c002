"""The rule of the run, by its number: what `Rule` is in algorithms/exploration.py.

Mirrors: the calls of `rule.arrive`, `observe`, `refute`, `conclude` and `learn` there. Differs: a
number selects, because a kernel that is handed a function is compiled anew in every process.

Source: docs/semantics.md, section 7.
"""

from __future__ import annotations

from topo_verify.compiled.events import BY_FOLDING, BY_HISTORY, BY_PLANAR, BY_PREFIX, BY_RECORDS
from topo_verify.compiled.folding import (
    arrive_fold,
    learn_fold,
    observe_fold,
    refute_by_folding,
    start_fold,
)
from topo_verify.compiled.history import refute_by_history
from topo_verify.compiled.kernel import Words, kernel
from topo_verify.compiled.planar import face, refute_by_face
from topo_verify.compiled.prefix import refute_by_prefix
from topo_verify.compiled.records import learn_records, observe_sequence
from topo_verify.compiled.workspace import (
    EV_RECORD,
    NREC,
    RULE,
    RULE_FOLDING,
    RULE_ONE,
    RULE_PLANAR,
    RULE_PREFIX,
)


@kernel
def start_rule(W: Words) -> None:
    """Forget the run before."""
    W[NREC] = 0
    if W[RULE] >= RULE_FOLDING:
        start_fold(W)


@kernel
def arrive(W: Words, e: int, percept: int) -> None:
    """Take note that the robot has crossed e and senses this percept at vu."""
    if W[RULE] >= RULE_FOLDING:
        if W[RULE] == RULE_PLANAR:
            face(W, e)
        arrive_fold(W, e, percept)


@kernel
def observe(W: Words) -> None:
    """Take note of a sequence that was executed and ended in a mismatch."""
    if W[RULE] >= RULE_FOLDING:
        observe_fold(W)
    elif W[RULE] >= RULE_ONE:
        observe_sequence(W)


@kernel
def refute(W: Words, h: int) -> int:
    """The rule that shows the hypothesis to be false, one of BY_…; 0: it may be true."""
    rule = W[RULE]
    if rule == RULE_PREFIX:
        return BY_PREFIX if refute_by_prefix(W, h) else 0
    if rule < RULE_FOLDING:
        if not refute_by_history(W, h):
            return 0
        return BY_HISTORY if W[EV_RECORD] < 0 else BY_RECORDS
    if rule == RULE_PLANAR and refute_by_face(W, h):
        return BY_PLANAR
    return BY_FOLDING if refute_by_folding(W, h) else 0


@kernel
def learn(W: Words, e: int, entry: int, new: int) -> None:
    """Take note that S has grown: the robot crossed e and came in by dart `entry`."""
    if W[RULE] >= RULE_FOLDING:
        learn_fold(W, entry, new)
    elif W[RULE] >= RULE_ONE:
        learn_records(W, e, entry)
