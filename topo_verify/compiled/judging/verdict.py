"""The verdict on one run: status and share of each claim.

Twin of checkers/claims.py and coverage.py.
"""

from __future__ import annotations

from topo_verify.compiled.judging.entailed import fold_history
from topo_verify.compiled.judging.fold import find_dart, find_node, lay_out
from topo_verify.compiled.judging.justified import cites_in_vain
from topo_verify.compiled.judging.layout import *
from topo_verify.compiled.judging.truth import replay
from topo_verify.compiled.kernel import entry, inlined, kernel
from topo_verify.compiled.names import Words
from topo_verify.compiled.pruning import bit_count
from topo_verify.compiled.workspace import *


@entry
def judge(run: RunWords, case: CaseWords) -> int:
    """Judge the run: a mask of the failing claims; -1: open."""
    case.full = 0
    case.wrong = 0
    replay(run, case)
    judge_delivery(run, case)
    is_history = case.legal != 0 and case.true != 0
    if not is_history:
        if case.cited > 0:
            case.wrong |= 1 << 7
    elif case.level >= 9 or case.cited > 0:
        if not fold_history(run, case):
            case.full = 1
        if cites_in_vain(case):
            case.wrong |= 1 << 7
    if case.level >= 9 and (
        not is_history or case.delivered == 0 or not proves_map(run.chart, case)
    ):
        case.wrong |= 1 << 8
    if case.level >= 10 and (not is_history or case.drawn.unproved != 0):
        case.wrong |= 1 << 9
    share_out(case)
    wrong = 0
    for k in range(case.level):
        wrong |= settle_status(case, k) << k
    return -1 if case.full != 0 else wrong


@inlined
def judge_delivery(run: RunWords, case: CaseWords) -> None:
    """Claims 5, 6 and 7, at the end."""
    cost = case.cost
    delivered = case.delivered != 0
    if case.spoiled != 0 or not delivered:
        case.wrong |= 1 << 4
    else:
        left = 0
        for d in range(case.size):
            if case.alpha[d] < 0:
                left += 1
        if (case.legal != 0 and 0 < left < case.size) or not is_world(run, case):
            case.wrong |= 1 << 4
    if delivered and case.reported not in (-1, cost):
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
    crossed = case.crossed
    edges = bit_count(crossed)
    posed = 0
    unsettled = edges
    left = 0
    missing = 0
    loops = 0
    for d in range(case.darts):
        fate = case.fate[d]
        if fate == 0:
            continue
        rest = bit_count(case.left[d]) + bit_count(case.left[d] >> 32)
        left += rest
        was_crossed = (crossed >> d) & 1
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
    reported = 1 if ended != 0 and case.reported >= 0 else 0
    share(case, 1, case.followed, 1 + case.cost)
    share(case, 2, posed, edges)
    share(case, 3, case.posed - left, case.posed + unsettled)
    share(case, 4, confirmations, max(confirmations, loops) + unsettled)
    share(case, 5, ended, 1)
    share(case, 6, reported, reported)
    share(case, 7, 1, 1)
    share(case, 8, rejections, rejections + missing + unsettled)
    share(case, 9, ended, 1)
    share(case, 10, decisions, decisions + bit_count(crossed & ~case.grown))


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
