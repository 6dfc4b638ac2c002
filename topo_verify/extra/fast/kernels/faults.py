"""Mistakes to plant in the compiled mapper: some of those of topo_verify/faults, by number.

`if planted(task, SETS_OUT_UNTURNED)` is decided at compilation, and costs nothing outside `FAULTY`.
"""

from __future__ import annotations

from topo_verify.extra.fast.kernels.kernel import kernel
from topo_verify.extra.fast.kernels.workspace import FAULTS, TaskWords

(
    LEAVES_OUT_THE_DARTS_OF_VK,
    LEAVES_OUT_THE_DARTS_OF_V0,
    TRIES_ONLY_THE_NEAREST_TWO,
    CONFIRMS_WHAT_IS_ALONE,
    FORGETS_ITS_ORIENTATION,
    RESTORES_WITH_THE_WRONG_SIGN,
    SETS_OUT_UNTURNED,
    RETRACES_IN_THE_WRONG_ORDER,
    RETRACES_ONE_EDGE_SHORT,
    GOES_ON_AS_IF_JUST_COME_IN,
    IGNORES_DIRECTION_AT_THE_END,
    IGNORES_DIRECTION_BEHIND_E,
    COUNTS_DOORS_ANTICLOCKWISE,
    COMPARES_BEFORE_THE_DOOR,
    TRACES_THROUGH_THE_UNEXPLORED,
    TRACES_FROM_THE_FIRST_DART,
    TAKES_UNKNOWN_FOR_A_MISMATCH,
    RECORDS_A_LOOP_FROM_DART_0,
    RECORDS_FROM_THE_NEAR_END,
    TAKES_EACH_PLACE_FOR_KNOWN,
    IDENTIFIES_WITHOUT_TURNING,
    FORGETS_THAT_VU_MAY_BE_NEW,
) = range(1, 23)

PLANTED: dict[str, tuple[int, str]] = {
    "leaves-out-the-darts-of-vk": (LEAVES_OUT_THE_DARTS_OF_VK, "basic"),
    "leaves-out-the-darts-of-v0": (LEAVES_OUT_THE_DARTS_OF_V0, "basic"),
    "tries-only-the-nearest-two": (TRIES_ONLY_THE_NEAREST_TWO, "basic"),
    "confirms-what-is-alone": (CONFIRMS_WHAT_IS_ALONE, "basic"),
    "forgets-its-orientation": (FORGETS_ITS_ORIENTATION, "basic"),
    "restores-with-the-wrong-sign": (RESTORES_WITH_THE_WRONG_SIGN, "basic"),
    "sets-out-unturned": (SETS_OUT_UNTURNED, "basic"),
    "retraces-in-the-wrong-order": (RETRACES_IN_THE_WRONG_ORDER, "basic"),
    "retraces-one-edge-short": (RETRACES_ONE_EDGE_SHORT, "basic"),
    "goes-on-as-if-just-come-in": (GOES_ON_AS_IF_JUST_COME_IN, "basic"),
    "ignores-direction-at-the-end": (IGNORES_DIRECTION_AT_THE_END, "basic"),
    "ignores-direction-behind-e": (IGNORES_DIRECTION_BEHIND_E, "basic"),
    "counts-doors-anticlockwise": (COUNTS_DOORS_ANTICLOCKWISE, "basic"),
    "compares-before-the-door": (COMPARES_BEFORE_THE_DOOR, "enhancement-i"),
    "traces-through-the-unexplored": (TRACES_THROUGH_THE_UNEXPLORED, "enhancement-ii"),
    "traces-from-the-first-dart": (TRACES_FROM_THE_FIRST_DART, "enhancement-ii"),
    "takes-unknown-for-a-mismatch": (TAKES_UNKNOWN_FOR_A_MISMATCH, "enhancement-ii"),
    "records-a-loop-from-dart-0": (RECORDS_A_LOOP_FROM_DART_0, "enhancement-iii-all"),
    "records-from-the-near-end": (RECORDS_FROM_THE_NEAR_END, "enhancement-iii-all"),
    "takes-each-place-for-known": (TAKES_EACH_PLACE_FOR_KNOWN, "folding"),
    "identifies-without-turning": (IDENTIFIES_WITHOUT_TURNING, "folding"),
    "forgets-that-vu-may-be-new": (FORGETS_THAT_VU_MAY_BE_NEW, "folding"),
}
"""The number of each mistake, and its algorithm."""


@kernel
def planted(task: TaskWords, number: int) -> bool:
    return FAULTS != 0 and task.fault == number
