"""The exploration loop, which listings 1, 2 and 3 of the paper share.

Twin of algorithms/exploration.py, line by line, with its letters. Differs: H is a row of darts,
`remaining.dart`, with their number; only `folding` and `planar` are asked before the first motion.
Where the reference may raise, this looks at `stop`.
"""

from __future__ import annotations

from topo_verify.extra.fast.kernels.chart import *
from topo_verify.extra.fast.kernels.events import *
from topo_verify.extra.fast.kernels.evidence import *
from topo_verify.extra.fast.kernels.faults import *
from topo_verify.extra.fast.kernels.folding import *
from topo_verify.extra.fast.kernels.kernel import entry, inlined, kernel
from topo_verify.extra.fast.kernels.motion import *
from topo_verify.extra.fast.kernels.robot import *
from topo_verify.extra.fast.kernels.workspace import *


@kernel
def explore(run: RunWords) -> int:
    """Map the world: the cost in edge traversals; -1: see `stop`."""
    at = start(run)
    while run.chart.unexplored > 0 and run.stop == 0:  # A1.3 A2.3 A3.4
        at = settle(run, at)
    return run.robot.cost if run.stop == 0 else -1  # A1.20 A2.28 A3.30


@entry
def explore_rounds(run: RunWords, at: int, rounds: int) -> int:
    """At most `rounds` rounds of `explore`, after the part that returned `at` (-1: none).

    Returns the reference dart on S; it is over when U is empty or `stop` is set.
    """
    if at < 0:
        at = start(run)
    while rounds > 0 and run.chart.unexplored > 0 and run.stop == 0:
        at = settle(run, at)
        rounds -= 1
    return at


@kernel
def start(run: RunWords) -> int:
    robot = run.robot
    robot.dart = 0
    robot.cost = 0
    run.stop = 0
    run.trace.size = 0
    start_chart(run, sensed(run.world, 0))  # A1.1 A1.2 A2.1 A2.2 A3.1 A3.2
    start_rule(run)
    return 0


@inlined
def settle(run: RunWords, at: int) -> int:
    """Explore one edge; return the reference dart on S."""
    sequences = run.sequences
    e = nearest(run.chart, at)  # A1.4 A2.4 A3.5
    # No edge ends in its own dart.
    leave_u(run.chart, e)
    at = walk(run, at, run.chart.vertex[e])  # A1.5 A2.5 A3.6
    if run.stop != 0:
        return 0
    percept = cross(run, at, e)
    if run.stop != 0:
        return 0
    sequences.number = 0
    sequences.steps = 0
    remaining = hypotheses(run, e, percept)  # A1.6 A2.6 A3.7
    declare_pose(run, e, remaining)
    arrive(run, e, percept)
    h = validate(run, e, remaining)
    if run.stop != 0:
        return 0
    if h >= 0:  # A1.16 A2.24 A3.25
        # Declared before `localise` may walk back.
        join(run.chart, e, h)  # loop augmentation: A1.17 A2.25 A3.26
        declare_augment(run, e, LOOP, h, percept >> SHIFT)
        entered = h
    else:  # A1.18 A2.26 A3.27
        back(run, 0)  # the last hypothesis' way: A1.15 A3.24
        if run.stop != 0:
            return 0
        entered = add_vertex(run, percept)
        if run.stop != 0:
            return 0
        join(run.chart, e, entered)  # non-loop augmentation: A1.19 A2.27 A3.28
        declare_augment(run, e, NEW, entered, percept >> SHIFT)
    learn(run, e, entered, h < 0)
    if run.stop != 0:
        return 0
    return localise(run, entered)


@inlined
def hypotheses(run: RunWords, e: int, percept: int) -> int:
    chart = run.chart
    signature = 2 * (percept >> SHIFT) + ((percept & MASK) > 0)
    number = 0
    for v in range(chart.vertices):
        if chart.signature[v] == signature and chart.open[v] > 0:
            if planted(run.task, LEAVES_OUT_THE_DARTS_OF_VK) and v == chart.vertex[e]:
                continue
            if planted(run.task, LEAVES_OUT_THE_DARTS_OF_V0) and v == 0:
                continue
            for dart in range(chart.first[v], chart.first[v] + chart.degree[v]):
                if chart.in_u[dart] != 0:
                    run.remaining.dart[number] = dart
                    number += 1
    if number > 0:
        tree_of_v0(chart)
        shortest(run, number)
    if planted(run.task, TRIES_ONLY_THE_NEAREST_TWO) and number > 2:
        number = 2
    return number


@inlined
def validate(run: RunWords, e: int, remaining: int) -> int:
    """The confirmed hypothesis, or -1."""
    task, excursion = run.task, run.excursion
    if task.rule >= RULE_FOLDING:
        remaining = sift(run, e, remaining)
    while remaining > 0 and run.stop == 0:  # A1.7 A2.10 A2.20 A2.21 A3.8
        h = concluded(run, remaining)
        if h >= 0:
            declare_confirm(run, e, h, BY_FOLDING)
            return h
        chosen = choice(run, remaining)
        h = run.remaining.dart[chosen]
        remaining -= 1
        for i in range(chosen, remaining):  # A1.8 A2.7 A3.9
            run.remaining.dart[i] = run.remaining.dart[i + 1]
        step = execute(run, h, excursion.shared)
        if run.stop != 0:
            break
        if step < 0:  # A1.12 A2.12 A3.21
            declare_confirm(run, e, h, BY_MOTION)  # A1.13 A2.13 A3.22
            return h
        # The percepts differ: A1.14 A2.14 A3.23. The robot stays: A2.15.
        declare_reject(run, e, h, BY_MOTION)
        if excursion.size == 0:
            continue
        run.sequences.number += 1
        if task.rule != RULE_NONE:
            observe(run)
            remaining = sift(run, e, remaining)
    return -1


@kernel
def concluded(run: RunWords, remaining: int) -> int:
    """The hypothesis that must be true; -1: none."""
    if run.task.rule >= RULE_FOLDING:
        return conclude(run, remaining)
    if planted(run.task, CONFIRMS_WHAT_IS_ALONE) and remaining == 1:
        return run.remaining.dart[0]
    return -1


@kernel
def sift(run: RunWords, e: int, remaining: int) -> int:
    kept = 0
    for i in range(remaining):  # A2.16
        h = run.remaining.dart[i]
        by = refute(run, h)
        if run.stop != 0:
            return 0
        if by == 0:
            run.remaining.dart[kept] = h
            kept += 1  # A3.17
        else:
            declare_reject(run, e, h, by)  # A2.19 A3.16
    return kept


@inlined
def execute(run: RunWords, h: int, shared: int) -> int:
    """Walk the way home but for `shared` doors; return the first step that differs, or -1."""
    chart, excursion = run.chart, run.excursion
    length = chart.depth[chart.vertex[h]]
    if shared < length:  # else its way is executed already
        back(run, shared)  # A1.15 A2.23 A3.24
        if run.stop != 0:
            return 0
    at = h
    step = 0
    while True:  # A1.9 A1.10 A2.8 A2.9 A3.18 A3.19
        # Shared percepts are compared, not walked again.
        if excursion.percept[step] != chart.percept[at]:  # A1.11 A2.11 A3.20
            if overlooked(run, at, step, length):
                return -1
            cite(run.evidence, step, chart.percept[at], excursion.percept[step], -1)
            return step
        up = chart.up[chart.vertex[at]]
        if up < 0:
            return -1
        step += 1
        if step > excursion.size:
            forward(run, door(run, at, up))
            if run.stop != 0:
                return 0
        at = chart.alpha[up]


@kernel
def overlooked(run: RunWords, at: int, step: int, length: int) -> bool:
    """Does a planted mistake take this mismatch for none?"""
    chart, excursion = run.chart, run.excursion
    alike = chart.signature[chart.vertex[at]] == 2 * (excursion.percept[step] >> SHIFT) + (
        (excursion.percept[step] & MASK) > 0
    )
    if planted(run.task, IGNORES_DIRECTION_AT_THE_END) and step > 0:
        return step == length and alike
    if planted(run.task, IGNORES_DIRECTION_BEHIND_E) and step == 0:
        return length == 0 and alike
    return False


@inlined
def localise(run: RunWords, entered: int) -> int:
    """The reference dart on S, once vu's entry dart is known.

    At v0 the marker tells it. Elsewhere the robot goes back to vu, turned as the way back turned
    it.
    """
    chart = run.chart
    marker = sensed(run.world, run.robot.dart) & MASK  # 1 + marker
    if planted(run.task, GOES_ON_AS_IF_JUST_COME_IN):
        back(run, 0)
        return entered
    if marker > 0:
        return 0 if marker == 1 else chart.degree[0] - marker + 1
    back(run, 0)
    turned = run.excursion.turned
    while turned < 0:
        turned += chart.degree[chart.vertex[entered]]
    return turn(chart, entered, turned)


@kernel
def start_rule(run: RunWords) -> None:
    run.records.number = 0
    if run.task.rule >= RULE_FOLDING:
        start_fold(run)


@kernel
def arrive(run: RunWords, e: int, percept: int) -> None:
    task = run.task
    if task.rule >= RULE_FOLDING:
        if task.rule == RULE_PLANAR:
            face(run, e)
        arrive_fold(run, e, percept)


@kernel
def observe(run: RunWords) -> None:
    task = run.task
    if task.rule >= RULE_FOLDING:
        observe_fold(run)
    elif task.rule >= RULE_ONE:
        observe_sequence(run)


@kernel
def refute(run: RunWords, h: int) -> int:
    """The rule that refutes the hypothesis, BY_…; 0: none."""
    rule = run.task.rule
    if rule == RULE_PREFIX:
        return BY_PREFIX if refute_by_prefix(run, h) else 0
    if rule < RULE_FOLDING:
        if not refute_by_history(run, h):
            return 0
        return BY_HISTORY if run.evidence.record < 0 else BY_RECORDS
    if rule == RULE_PLANAR and refute_by_face(run, h):
        return BY_PLANAR
    return BY_FOLDING if refute_by_folding(run, h) else 0


@kernel
def learn(run: RunWords, e: int, entry: int, new: int) -> None:
    task = run.task
    if task.rule >= RULE_FOLDING:
        learn_fold(run, entry, new)
    elif task.rule >= RULE_ONE:
        learn_records(run, e, entry)
