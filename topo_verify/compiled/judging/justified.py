"""Claim 8: the evidence that a rejection cites, recomputed.

Mirrors: checkers/excursions.py and the part "what justifies a rejection" of checkers/claims.py.
Differs: sequences lie in one arena, and a record points into it. What is recorded behind a dart is
true in the world, so of several records that reach as far any one will do.
"""

from __future__ import annotations

from topo_verify.compiled.events import ABSENT, BY_FOLDING, BY_MOTION, BY_PLANAR
from topo_verify.compiled.judging.layout import *
from topo_verify.compiled.judging.layout import exit_of, shown
from topo_verify.compiled.kernel import Words, inlined, kernel
from topo_verify.compiled.workspace import AL


@inlined
def unjustified(W: Words, J: Words, i: int) -> bool:
    """Whether the rejection at i is not justified: `_unjustified` of claims.py."""
    e = W[i + 1]
    h = W[i + 2]
    rule = W[i + 4]
    at = J[J_POSE_AT]
    if at < 0 or J[J_POSE_EDGE] != e:
        return True
    is_posed = False
    for k in range(at + 3, at + 3 + W[at + 2]):
        if W[k] == h:
            is_posed = True
    if not is_posed or e < 0 or e >= J[J_SIZE] or h < 0 or h >= J[J_SIZE]:
        return True
    if J[J_ALPHA + e] >= 0 or J[J_ALPHA + h] >= 0:
        return True
    if rule in (BY_FOLDING, BY_PLANAR):
        return unmet(W, J, i)
    return W[i + 11] != 0 or percepts_agree(W, J, i)


@kernel
def unmet(W: Words, J: Words, i: int) -> bool:
    """Whether more is cited than a contradiction: `_unmet`. Whether that follows is asked later."""
    expected = W[i + 6]
    observed = W[i + 7]
    if expected not in (ABSENT, shown(W, J[J_PHI + W[i + 2]])):
        return True
    if observed not in (ABSENT, shown(W, W[AL + J[J_PHI + W[i + 1]]])):
        return True
    if W[i + 5] != 0 or W[i + 8] != ABSENT or W[i + 9] != ABSENT or W[i + 10] != ABSENT:
        return True
    if J[J_REJECTIONS] >= JUDGE_STEPS:  # `J_CITED` is less
        J[J_FULL] = 1
        return True
    J[J_CITED_BY + J[J_CITED]] = J[J_REJECTIONS]
    J[J_CITED] += 1
    return False


@kernel
def cites_in_vain(J: Words) -> bool:
    """Whether some contradiction that was cited does not follow, once the history is folded."""
    for k in range(J[J_CITED]):  # noqa: SIM110  numba knows no such generator
        if J[S_MET + J[J_CITED_BY + k]] == 0:
            return True
    return False


@kernel
def percepts_agree(W: Words, J: Words, i: int) -> bool:
    """Whether the two percepts that are cited do not disagree as they are said to."""
    step = W[i + 5]
    number = W[i + 8]
    doors = J_WORD_DOOR
    percepts = J_WORD_PERCEPT
    size = J[J_WORD_SIZE]
    if number == ABSENT:
        if W[i + 4] != BY_MOTION:
            return True
    else:
        if number < 0 or number >= J[J_SEQUENCES] - J[J_FIRST_SEQUENCE]:
            return True
        s = J[J_FIRST_SEQUENCE] + number
        doors = J_ARENA_DOOR + J[J_SEQUENCE_AT + s]
        percepts = J_ARENA_PERCEPT + J[J_SEQUENCE_AT + s]
        size = J[J_SEQUENCE_SIZE + s]
    if step < 0 or step > size:
        return True
    observed = shown(W, W[AL + J[J_PHI + W[i + 1]]]) if step == 0 else J[percepts + step - 1]
    # Trace the word from the hypothesis on S, up to the first unexplored dart.
    at = W[i + 2]
    for k in range(step):
        exit_dart = J[J_NUMBER + exit_of(W, J[J_PHI + at], J[doors + k])]
        if J[J_ALPHA + exit_dart] < 0:
            return beyond_s(W, J, i, exit_dart, doors + k + 1, step - k - 1, observed)
        at = J[J_ALPHA + exit_dart]
    expected = shown(W, J[J_PHI + at])
    return (
        W[i + 10] != ABSENT
        or W[i + 9] not in (ABSENT, at)
        or W[i + 7] != observed
        or W[i + 6] != expected
        or expected == observed
    )


@kernel
def beyond_s(W: Words, J: Words, i: int, dart: int, doors: int, rest: int, observed: int) -> bool:
    """`percepts_agree` where the word leaves S at a dart, with so many doors to go."""
    if W[i + 10] != dart or W[i + 12] != rest or W[i + 9] not in (ABSENT, dart):
        return True
    for k in range(rest):
        if W[i + 13 + k] != J[doors + k]:
            return True
    record = J[J_RECORD_OF + dart]
    while record >= 0:
        begin = J[J_RECORD_AT + record]
        k = 0
        if J[J_RECORD_REST + record] >= rest:
            while k < rest and J[J_ARENA_DOOR + begin + 1 + k] == J[doors + k]:
                k += 1
            if k == rest:
                expected = J[J_ARENA_PERCEPT + begin + rest]
                return W[i + 7] != observed or W[i + 6] != expected or expected == observed
        record = J[J_RECORD_BEFORE + record]
    return True


@inlined
def keep_sequence(J: Words) -> None:
    """The word at a mismatch in motion becomes a sequence."""
    s = J[J_SEQUENCES]
    begin = J[J_ARENA]
    size = J[J_WORD_SIZE]
    if s >= JUDGE_SEQUENCES or begin + size > JUDGE_ARENA:
        J[J_FULL] = 1
        return
    J[J_SEQUENCE_AT + s] = begin
    J[J_SEQUENCE_SIZE + s] = size
    for k in range(size):
        J[J_ARENA_DOOR + begin + k] = J[J_WORD_DOOR + k]
        J[J_ARENA_PERCEPT + begin + k] = J[J_WORD_PERCEPT + k]
    J[J_SEQUENCES] = s + 1
    J[J_ARENA] = begin + size


@inlined
def record_sequences(W: Words, J: Words, start: int) -> None:
    """Keep what the sequences from a dart of S show, each behind the first unexplored dart."""
    for s in range(J[J_FIRST_SEQUENCE], J[J_SEQUENCES]):
        at = start
        begin = J[J_SEQUENCE_AT + s]
        size = J[J_SEQUENCE_SIZE + s]
        for k in range(size):
            exit_dart = J[J_NUMBER + exit_of(W, J[J_PHI + at], J[J_ARENA_DOOR + begin + k])]
            if J[J_ALPHA + exit_dart] < 0:
                record = J[J_RECORDS]  # a sequence leaves one record at most, so there is room
                J[J_RECORD_AT + record] = begin + k
                J[J_RECORD_REST + record] = size - k - 1
                J[J_RECORD_BEFORE + record] = J[J_RECORD_OF + exit_dart]
                J[J_RECORD_OF + exit_dart] = record
                J[J_RECORDS] = record + 1
                break
            at = J[J_ALPHA + exit_dart]
