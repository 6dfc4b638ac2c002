"""The verdict on one run: status and share of each claim.

Mirrors: checkers/claims.py, `check`, and coverage.py. `judge` leaves `J_STATUS`, `J_JUDGED` and
`J_OF` of each claim, and returns the mask of the claims that fail; -1: the verdict is open.
"""

from __future__ import annotations

from topo_verify.compiled.judging.entailed import fold_history
from topo_verify.compiled.judging.fold import find_dart, find_node, lay_out
from topo_verify.compiled.judging.justified import cites_in_vain
from topo_verify.compiled.judging.layout import *
from topo_verify.compiled.judging.truth import replay
from topo_verify.compiled.kernel import Words, entry, inlined, kernel
from topo_verify.compiled.pruning import bit_count
from topo_verify.compiled.workspace import *


@entry
def judge(W: Words, J: Words) -> int:
    """Judge the run in the workspace: a mask of the claims that fail; -1: the verdict is open."""
    J[J_FULL] = 0
    J[J_WRONG] = 0
    replay(W, J)
    judge_delivery(W, J)
    is_history = J[J_LEGAL] != 0 and J[J_TRUE] != 0
    if not is_history:
        if J[J_CITED] > 0:
            J[J_WRONG] |= 1 << 7
    elif J[J_LEVEL] >= 9 or J[J_CITED] > 0:
        if not fold_history(W, J):
            J[J_FULL] = 1  # the world shows this history, so the fold cannot contradict it
        if cites_in_vain(J):
            J[J_WRONG] |= 1 << 7
    if J[J_LEVEL] >= 9 and (not is_history or J[J_DELIVERED] == 0 or not proves_map(W, J)):
        J[J_WRONG] |= 1 << 8
    if J[J_LEVEL] >= 10 and (not is_history or J[S_UNPROVED] != 0):
        J[J_WRONG] |= 1 << 9
    share_out(J)
    wrong = 0
    for k in range(J[J_LEVEL]):
        wrong |= settle_status(J, k) << k
    return -1 if J[J_FULL] != 0 else wrong


@inlined
def judge_delivery(W: Words, J: Words) -> None:
    """Claims 5, 6 and 7, at the end of the run."""
    cost = J[J_COST]
    delivered = J[J_DELIVERED] != 0
    if J[J_SPOILED] != 0 or not delivered:
        J[J_WRONG] |= 1 << 4
    else:
        left = 0
        for d in range(J[J_SIZE]):
            if J[J_ALPHA + d] < 0:
                left += 1
        if (J[J_LEGAL] != 0 and 0 < left < J[J_SIZE]) or not is_world(W, J):
            J[J_WRONG] |= 1 << 4
    if delivered and J[J_REPORTED] not in (-1, cost):
        J[J_WRONG] |= 1 << 5
    if cost > J[J_BOUND] or (delivered and cost < J[J_DARTS] // 2):
        J[J_WRONG] |= 1 << 6


# ---------------------------------------------------------------- the delivered map


@inlined
def is_chart(W: Words, darts: int, vertices: int) -> bool:
    """Whether the delivered map is a map of this size, its darts in range."""
    if W[NDARTS] != darts or W[NV] != vertices:
        return False
    for d in range(darts):
        if not 0 <= W[CA + d] < darts or W[CA + W[CA + d]] != d or W[CA + d] == d:
            return False
        if not 0 <= W[CV + d] < vertices:
            return False
        if not W[CF + W[CV + d]] <= d < W[CF + W[CV + d]] + W[CD + W[CV + d]]:
            return False
    return True


@kernel
def is_world(W: Words, J: Words) -> bool:
    """Whether the delivered map is the world, the marker on the marker."""
    if not is_chart(W, J[J_DARTS], J[J_VERTICES]):
        return False
    return is_same_map(W, J, W, AL, VT, ST, DG, 0)


@kernel
def proves_map(W: Words, J: Words) -> bool:
    """Whether no dart of the fold is open, and the fold is the delivered map."""
    if lay_out(J) != 0:  # without an open dart it is the world, for which there is room
        return False
    darts = J[F_SIZE]
    vertices = 0
    for d in range(darts):
        if J[F_NUMBER + J[F_VERTEX + d]] == d:
            vertices += 1
    if not is_chart(W, darts, vertices):
        return False
    root = J[F_NUMBER + find_node(J, 0)] + find_dart(J, 0, 0)
    return is_same_map(W, J, J, F_ALPHA, F_VERTEX, F_NUMBER, F_DEGREE, root)


@inlined
def is_same_map(
    W: Words, J: Words, M: Words, alpha: int, vertex: int, first: int, degree: int, root: int
) -> bool:
    """Whether the delivered map is isomorphic to the one in M, its dart 0 being the root there.

    The image of a dart decides that of all darts of its vertex and of its other end. A map of as
    many darts, onto a connected one, is one to one.

    Args:
        M: W or J. In it are, from these places on: of each dart its other end and its vertex; of
            each vertex its first dart and its degree.
    """
    darts = W[NDARTS]
    for d in range(darts):
        J[J_IMAGE + d] = -1
    v = M[vertex + root]
    if not place_image(W, J, 0, root, M[first + v], M[degree + v]):
        return False
    for d in range(darts):
        if J[J_IMAGE + d] < 0:
            J[J_FULL] = 1  # S numbers its darts in the order of discovery; this map does not
            return False
        other = W[CA + d]
        image = M[alpha + J[J_IMAGE + d]]
        if J[J_IMAGE + other] < 0:
            v = M[vertex + image]
            if not place_image(W, J, other, image, M[first + v], M[degree + v]):
                return False
        elif J[J_IMAGE + other] != image:
            return False
    return True


@inlined
def place_image(W: Words, J: Words, d: int, image: int, first: int, degree: int) -> bool:
    """Map the vertex of d to that of `image`, whose first dart is `first`; False: other degrees."""
    v = W[CV + d]
    if W[CD + v] != degree:
        return False
    begin = W[CF + v]
    for k in range(degree):
        dart = d + k if d + k < begin + degree else d + k - degree
        J[J_IMAGE + dart] = image + k if image + k < first + degree else image + k - degree
    return True


# ---------------------------------------------------------------- shares and status


@inlined
def share(J: Words, claim: int, judged: int, of: int) -> None:
    """How much a claim judged; claims count from 1."""
    J[J_JUDGED + claim - 1] = judged
    J[J_OF + claim - 1] = of


@kernel
def share_out(J: Words) -> None:
    """What `coverage` says of each claim."""
    crossed = J[J_CROSSED]
    edges = bit_count(crossed)
    posed = 0
    unsettled = edges
    left = 0
    missing = 0
    loops = 0
    for d in range(J[J_DARTS]):
        fate = J[J_FATE + d]
        if fate == 0:
            continue
        rest = bit_count(J[J_LEFT + d]) + bit_count(J[J_LEFT + d] >> 32)
        left += rest
        was_crossed = (crossed >> d) & 1
        posed += was_crossed
        if fate in (FATE_LOOP, FATE_NEW):
            missing += rest
            unsettled -= was_crossed
            if fate == FATE_LOOP:
                loops += 1
    rejections = J[J_REJECTIONS]
    confirmations = J[J_CONFIRMATIONS]
    decisions = rejections + confirmations + J[J_AUGMENTATIONS]
    ended = J[J_DELIVERED]
    reported = 1 if ended != 0 and J[J_REPORTED] >= 0 else 0
    share(J, 1, J[J_FOLLOWED], 1 + J[J_COST])
    share(J, 2, posed, edges)
    share(J, 3, J[J_POSED] - left, J[J_POSED] + unsettled)
    share(J, 4, confirmations, max(confirmations, loops) + unsettled)
    share(J, 5, ended, 1)
    share(J, 6, reported, reported)
    share(J, 7, 1, 1)
    share(J, 8, rejections, rejections + missing + unsettled)
    share(J, 9, ended, 1)
    share(J, 10, decisions, decisions + bit_count(crossed & ~J[J_GROWN]))


@inlined
def settle_status(J: Words, k: int) -> int:
    """The status of claim k + 1; 1 if it fails."""
    declared = True
    if k == 1:
        declared = J[J_SAW_POSE] != 0
    elif k in (2, 7):
        declared = J[J_SAW_POSE] != 0 or J[J_SAW_REJECT] != 0
    elif k == 3:
        declared = J[J_SAW_POSE] != 0 or J[J_SAW_CONFIRM] != 0
    elif k == 8:
        declared = J[J_DELIVERED] != 0
    elif k == 9:
        declared = J[J_SAW_REJECT] != 0 or J[J_SAW_CONFIRM] != 0 or J[J_SAW_AUGMENT] != 0
    if not declared:
        J[J_JUDGED + k] = 0
        J[J_STATUS + k] = NOT_DECLARED
        return 0
    if (J[J_WRONG] >> k) & 1 != 0:
        J[J_STATUS + k] = FAILED
        return 1
    judged = J[J_JUDGED + k]
    if judged == J[J_OF + k]:
        J[J_STATUS + k] = OK
    else:
        J[J_STATUS + k] = PARTIAL if judged != 0 else NOT_DECLARED
    return 0
