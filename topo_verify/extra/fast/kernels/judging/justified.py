"""Claim 8: the evidence that a rejection cites, recomputed.

Twin of checkers/excursions.py and "what justifies a rejection" of checkers/claims.py. Differs:
sequences lie in one arena, and a record points into it. Records are true in the world, so any that
reaches far enough will do.
"""

from __future__ import annotations

from topo_verify.extra.fast.kernels.events import *
from topo_verify.extra.fast.kernels.judging.layout import *
from topo_verify.extra.fast.kernels.judging.layout import exit_of, shown
from topo_verify.extra.fast.kernels.kernel import inlined, kernel
from topo_verify.extra.fast.kernels.workspace import *


@inlined
def unjustified(run: RunWords, case: CaseWords, rejection: RejectionWords) -> bool:
    """Twin of `_unjustified` of claims.py."""
    e = rejection.edge
    h = rejection.h
    rule = rejection.rule
    if e < 0 or case.pose_edge != e:
        return True
    if e >= case.size or h < 0 or h >= case.size or case.posed_by[h] != case.poses:
        return True
    if case.alpha[e] >= 0 or case.alpha[h] >= 0:
        return True
    if rule in (BY_FOLDING, BY_PLANAR):
        return unmet(run, case, rejection)
    return rejection.contradiction != 0 or percepts_agree(run, case, rejection)


@kernel
def unmet(run: RunWords, case: CaseWords, rejection: RejectionWords) -> bool:
    """Twin of `_unmet`: is more cited than a contradiction?"""
    expected = rejection.expected
    observed = rejection.observed
    if expected not in (ABSENT, shown(run.world, case.phi[rejection.h])):
        return True
    if observed not in (ABSENT, shown(run.world, run.world.alpha[case.phi[rejection.edge]])):
        return True
    if (
        rejection.step != 0
        or rejection.sequence != ABSENT
        or rejection.at != ABSENT
        or rejection.record != ABSENT
    ):
        return True
    if case.rejections >= JUDGE_STEPS:
        case.full = 1
        return True
    case.cited_by[case.cited] = case.rejections
    case.cited += 1
    return False


@kernel
def cites_in_vain(case: CaseWords) -> bool:
    for k in range(case.cited):  # noqa: SIM110  numba knows no such generator
        if case.drawn.met[case.cited_by[k]] == 0:
            return True
    return False


@kernel
def percepts_agree(run: RunWords, case: CaseWords, rejection: RejectionWords) -> bool:
    step = rejection.step
    number = rejection.sequence
    steps = case.place_of("word_step")
    size = case.word_size
    if number == ABSENT:
        if rejection.rule != BY_MOTION:
            return True
    else:
        if number < 0 or number >= case.sequences:
            return True
        steps = case.place_of("arena_step") + case.sequence_at[number]
        size = case.sequence_size[number]
    if step < 0 or step > size:
        return True
    observed = (
        shown(run.world, run.world.alpha[case.phi[rejection.edge]])
        if step == 0
        else case[steps + step - 1] >> SHIFT
    )
    at = rejection.h
    for k in range(step):
        exit_dart = case.number[exit_of(run.world, case.phi[at], case[steps + k] & MASK)]
        if case.alpha[exit_dart] < 0:
            return beyond_s(run, case, rejection, exit_dart, steps + k + 1, step - k - 1, observed)
        at = case.alpha[exit_dart]
    expected = shown(run.world, case.phi[at])
    return (
        rejection.record != ABSENT
        or rejection.at not in (ABSENT, at)
        or rejection.observed != observed
        or rejection.expected != expected
        or expected == observed
    )


@kernel
def beyond_s(
    run: RunWords,  # noqa: ARG001  it has the rejection's words
    case: CaseWords,
    rejection: RejectionWords,
    dart: int,
    steps: int,
    rest: int,
    observed: int,
) -> bool:
    """`percepts_agree` where the word leaves S, with `rest` doors to go."""
    if rejection.record != dart or rejection.doors != rest or rejection.at not in (ABSENT, dart):
        return True
    for k in range(rest):
        if rejection.door[k] != case[steps + k] & MASK:
            return True
    record = case.record_of[dart]
    while record >= 0:
        begin = case.record_at[record]
        k = 0
        if case.record_rest[record] >= rest:
            while k < rest and (case.arena_step[begin + 1 + k] ^ case[steps + k]) & MASK == 0:
                k += 1
            if k == rest:
                expected = case.arena_step[begin + rest] >> SHIFT
                return (
                    rejection.observed != observed
                    or rejection.expected != expected
                    or expected == observed
                )
        record = case.record_before[record]
    return True


@inlined
def keep_sequence(case: CaseWords) -> None:
    s = case.sequences
    begin = case.arena
    size = case.word_size
    if s >= JUDGE_SEQUENCES or begin + size > JUDGE_ARENA:
        case.full = 1
        return
    case.sequence_at[s] = begin
    case.sequence_size[s] = size
    for k in range(size):
        case.arena_step[begin + k] = case.word_step[k]
    case.sequences = s + 1
    case.arena = begin + size


@inlined
def record_sequences(world: WorldWords, case: CaseWords, start: int) -> None:
    """Record what the sequences show behind the first unexplored dart; keep no more of them."""
    for s in range(case.sequences):
        at = start
        begin = case.sequence_at[s]
        end = begin + case.sequence_size[s]
        for k in range(begin, end):
            exit_dart = case.number[exit_of(world, case.phi[at], case.arena_step[k] & MASK)]
            if case.alpha[exit_dart] < 0:
                record_rest(case, exit_dart, k, end)
                break
            at = case.alpha[exit_dart]


@inlined
def record_rest(case: CaseWords, exit_dart: int, begin: int, end: int) -> None:
    """Record these words of the arena behind a dart, and move them to the others on record."""
    record = case.records
    if record >= JUDGE_SEQUENCES:
        case.full = 1
        return
    to = case.recorded
    case.record_at[record] = to
    case.record_rest[record] = end - begin - 1
    case.record_before[record] = case.record_of[exit_dart]
    case.record_of[exit_dart] = record
    case.records = record + 1
    for k in range(begin, end):
        case.arena_step[to] = case.arena_step[k]
        to += 1
    case.recorded = to
