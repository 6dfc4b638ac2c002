"""The verdict on one run: status and share of each claim.

Twin of checkers/claims.py and coverage.py.
"""

from __future__ import annotations

from topo_verify.extra.fast.kernels.judging.entailed import fold_history, start_history
from topo_verify.extra.fast.kernels.judging.fold import find_dart, find_node, lay_out, tidy_up
from topo_verify.extra.fast.kernels.judging.justified import cites_in_vain
from topo_verify.extra.fast.kernels.judging.layout import *
from topo_verify.extra.fast.kernels.judging.truth import replay, start_replay
from topo_verify.extra.fast.kernels.kernel import entry, inlined, kernel
from topo_verify.extra.fast.kernels.names import Words
from topo_verify.extra.fast.kernels.pruning import bit_count
from topo_verify.extra.fast.kernels.workspace import *

FIRST_PART, LAST_PART = 1, 2


@kernel
def judge(run: RunWords, case: CaseWords) -> int:
    """Judge the run: a mask of the failing claims; -1: open."""
    start_replay(run.world, case)
    replay(run, case)
    if is_history(case) and (case.level >= 9 or case.cited > 0):
        start_history(run, case, 1 if case.level >= 10 or case.cited > 0 else 0)
        if not fold_history(run, case):
            case.full = 1  # impossible: the world shows this history
    return settle_verdict(run, case)


@entry
def judge_part(run: RunWords, case: CaseWords, part: int, asked: int) -> int:
    """Judge the next part of a trace: 0; after the last one, or if the verdict is open, `judge`.

    Args:
        part: `FIRST_PART`, `LAST_PART`, both (their sum), or 0.
        asked: whether a rejection anywhere cites a contradiction; 2: one by the rule `planar`.
    """
    if part & FIRST_PART != 0:
        start_replay(run.world, case)
        start_history(run, case, 1 if case.level >= 10 or asked > 0 else 0)
        case.saw_planar = 1 if asked > 1 else 0
    replay(run, case)
    if is_history(case) and case.full == 0:
        tidy_up(case)
        if not fold_history(run, case):
            case.full = 1
    if case.full != 0:
        return -1
    return settle_verdict(run, case) if part & LAST_PART != 0 else 0


@inlined
def is_history(case: CaseWords) -> bool:
    """Whether the world shows all percepts so far, and has all doors."""
    return case.legal != 0 and case.true != 0


@kernel
def settle_verdict(run: RunWords, case: CaseWords) -> int:
    """The verdict at the end of the trace."""
    judge_delivery(run, case)
    is_true = is_history(case)
    if case.cited > 0 and (not is_true or cites_in_vain(case)):
        case.wrong |= 1 << 7
    if case.level >= 9 and (not is_true or case.delivered == 0 or not proves_map(run.chart, case)):
        case.wrong |= 1 << 8
    if case.level >= 10 and (not is_true or case.drawn.unproved != 0):
        case.wrong |= 1 << 9
    share_out(case)
    wrong = 0
    for k in range(case.level):
        wrong |= settle_status(case, k) << k
    return -1 if case.full != 0 else wrong


@inlined
def judge_delivery(run: RunWords, case: CaseWords) -> None:
    """Judge the end of a run by claims 5, 6 and 7."""
    cost = case.cost
    delivered = case.delivered != 0
    if case.spoiled != 0 or not delivered:
        case.wrong |= 1 << 4
    else:
        unexplored = 0
        for d in range(case.size):
            if case.alpha[d] < 0:
                unexplored += 1
        if (case.legal != 0 and 0 < unexplored < case.size) or not is_world(run, case):
            case.wrong |= 1 << 4
    if delivered and case.reported not in (ABSENT, cost):
        case.wrong |= 1 << 5
    if cost > case.bound or (delivered and cost < case.darts // 2):
        case.wrong |= 1 << 6


@inlined
def is_chart(chart: ChartWords, darts: int, vertices: int) -> bool:
    if chart.darts != darts or chart.vertices != vertices:
        return False
    for d in range(darts):
        if (
            not 0 <= chart.alpha[d] < darts
            or chart.alpha[chart.alpha[d]] != d
            or chart.alpha[d] == d
        ):
            return False
        if not 0 <= chart.vertex[d] < vertices:
            return False
        if (
            not chart.first[chart.vertex[d]]
            <= d
            < chart.first[chart.vertex[d]] + chart.degree[chart.vertex[d]]
        ):
            return False
    return True


@kernel
def is_world(run: RunWords, case: CaseWords) -> bool:
    world = run.world
    if not is_chart(run.chart, case.darts, case.vertices):
        return False
    return is_same_map(
        run.chart,
        case,
        run,
        world.place_of("alpha"),
        world.place_of("vertex"),
        world.place_of("first"),
        world.place_of("degree"),
        0,
    )


@kernel
def proves_map(chart: ChartWords, case: CaseWords) -> bool:
    """Is no dart of the fold open, and is the fold the delivered map?"""
    fold = case.fold
    if lay_out(fold) != 0:  # it is the world, and has room
        return False
    darts = fold.size
    vertices = 0
    for d in range(darts):
        if fold.number[fold.vertex[d]] == d:
            vertices += 1
    if not is_chart(chart, darts, vertices):
        return False
    root = fold.number[find_node(fold, 0)] + find_dart(fold, 0, 0)
    return is_same_map(
        chart,
        case,
        case,
        fold.place_of("alpha"),
        fold.place_of("vertex"),
        fold.place_of("number"),
        fold.place_of("degree"),
        root,
    )


@inlined
def is_same_map(
    chart: ChartWords,
    case: CaseWords,
    M: Words,
    alpha: int,
    vertex: int,
    first: int,
    degree: int,
    root: int,
) -> bool:
    """Is the delivered map isomorphic to that in M (W or J), dart 0 to the root?

    The image of a dart decides all others. A map of as many darts, onto a connected one, is one to
    one.
    """
    darts = chart.darts
    for d in range(darts):
        case.image[d] = -1
    v = M[vertex + root]
    if not place_image(chart, case, 0, root, M[first + v], M[degree + v]):
        return False
    for d in range(darts):
        if case.image[d] < 0:
            case.full = 1
            return False
        other = chart.alpha[d]
        image = M[alpha + case.image[d]]
        if case.image[other] < 0:
            v = M[vertex + image]
            if not place_image(chart, case, other, image, M[first + v], M[degree + v]):
                return False
        elif case.image[other] != image:
            return False
    return True


@inlined
def place_image(
    chart: ChartWords, case: CaseWords, d: int, image: int, first: int, degree: int
) -> bool:
    """Map the vertex of d to that of `image`; False: other degrees."""
    v = chart.vertex[d]
    if chart.degree[v] != degree:
        return False
    begin = chart.first[v]
    for k in range(degree):
        dart = d + k if d + k < begin + degree else d + k - degree
        case.image[dart] = image + k if image + k < first + degree else image + k - degree
    return True


@inlined
def share(case: CaseWords, claim: int, judged: int, of: int) -> None:
    case.judged[claim - 1] = judged
    case.of[claim - 1] = of


@kernel
def share_out(case: CaseWords) -> None:
    """Write the coverage of each claim."""
    edges = 0
    posed = 0
    grown = 0
    unsettled = 0
    undecided = 0
    missing = 0
    loops = 0
    for d in range(case.darts):
        fate = case.fate[d]
        was_crossed = case.crossed[d]
        edges += was_crossed
        grown += was_crossed & case.grown[d]
        unsettled += was_crossed
        if fate == 0:
            continue
        rest = 0
        for word in range(d * JUDGE_SET, d * JUDGE_SET + JUDGE_SET):
            if case.left[word] != 0:
                rest += bit_count(case.left[word]) + bit_count(case.left[word] >> 32)
        undecided += rest
        posed += was_crossed
        if fate in (FATE_LOOP, FATE_NEW):
            missing += rest
            unsettled -= was_crossed
            if fate == FATE_LOOP:
                loops += 1
    rejections = case.rejections
    confirmations = case.confirmations
    decisions = rejections + confirmations + case.augmentations
    ended = case.delivered
    reported = 1 if ended != 0 and case.reported != ABSENT else 0
    share(case, 1, case.followed, 1 + case.cost)
    share(case, 2, posed, edges)
    share(case, 3, case.posed - undecided, case.posed + unsettled)
    share(case, 4, confirmations, max(confirmations, loops) + unsettled)
    share(case, 5, ended, 1)
    share(case, 6, reported, reported)
    share(case, 7, 1, 1)
    share(case, 8, rejections, rejections + missing + unsettled)
    share(case, 9, ended, 1)
    share(case, 10, decisions, decisions + edges - grown)


@inlined
def settle_status(case: CaseWords, k: int) -> int:
    """The status of claim k + 1; 1 if it fails."""
    declared = True
    if k == 1:
        declared = case.saw[POSE] != 0
    elif k in (2, 7):
        declared = case.saw[POSE] != 0 or case.saw[REJECT] != 0
    elif k == 3:
        declared = case.saw[POSE] != 0 or case.saw[CONFIRM] != 0
    elif k == 8:
        declared = case.delivered != 0
    elif k == 9:
        declared = case.saw[REJECT] != 0 or case.saw[CONFIRM] != 0 or case.saw[AUGMENT] != 0
    if not declared:
        case.judged[k] = 0
        case.status[k] = NOT_DECLARED
        return 0
    if (case.wrong >> k) & 1 != 0:
        case.status[k] = FAILED
        return 1
    judged = case.judged[k]
    if judged == case.of[k]:
        case.status[k] = OK
    else:
        case.status[k] = PARTIAL if judged != 0 else NOT_DECLARED
    return 0
