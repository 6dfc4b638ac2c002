"""The robot in the world of the workspace.

Twin of robot/simulator.py, `SimulatedRobot`. Differs: the world's darts are numbered in order of
discovery, so a vertex is an interval, sigma the next dart of it, and the marker dart 0. Where the
reference raises, `stop` is set.
"""

from __future__ import annotations

from topo_verify.extra.fast.kernels.events import *
from topo_verify.extra.fast.kernels.kernel import inlined, kernel
from topo_verify.extra.fast.kernels.workspace import *


@inlined
def sensed(world: WorldWords, dart: int) -> int:
    v = world.vertex[dart]
    percept = world.degree[v] << SHIFT
    if v == 0:  # from dart d of v0, dart 0 is door -d
        percept += 1
        if dart > 0:
            percept += world.degree[0] - dart
    return percept


@inlined
def move(run: RunWords, door: int, purpose: int) -> int:
    """Leave by a door; return the percept, or set `stop`. Costs 1."""
    robot, world = run.robot, run.world
    v = world.vertex[robot.dart]
    degree = world.degree[v]
    if robot.cost >= run.task.budget:
        run.stop = STOP_BUDGET
        return 0
    if door < 0 or door >= degree:
        run.stop = STOP_DOOR
        return 0
    exit_dart = robot.dart + door
    if exit_dart >= world.first[v] + degree:
        exit_dart -= degree
    dart = world.alpha[exit_dart]
    robot.dart = dart
    robot.cost += 1
    percept = sensed(world, dart)
    declare(run, MOVE, door, percept, purpose)
    return percept


@kernel
def took(run: RunWords, words: int) -> int:
    """Reserve words of trace; return where they begin, or set `stop`."""
    trace = run.trace
    i = trace.size
    if i + words > run.task.room:
        run.stop = STOP_FULL + FULL_TRACE
    else:
        trace.size = i + words
    return i


@inlined
def declare(run: RunWords, kind: int, first: int, second: int, third: int) -> None:
    if run.task.tracing != 0:
        i = run.trace.place_of("word") + took(run, 4)
        if run.stop == 0:
            run[i] = kind
            run[i + 1] = first
            run[i + 2] = second
            run[i + 3] = third


@kernel
def declare_pose(run: RunWords, e: int, remaining: int) -> None:
    if run.task.tracing != 0:
        i = run.trace.place_of("word") + took(run, 3 + remaining)
        if run.stop == 0:
            pose = PoseWords(run, i)
            pose.kind = POSE
            pose.edge = e
            pose.number = remaining
            for k in range(remaining):
                pose.h[k] = run.remaining.dart[k]


@kernel
def declare_reject(run: RunWords, e: int, h: int, by: int) -> None:
    evidence = run.evidence
    if run.task.tracing != 0:
        step = evidence.step
        doors = 0
        if evidence.record >= 0:
            doors = step - evidence.first
        i = run.trace.place_of("word") + took(run, REJECT_WORDS + doors)
        if run.stop == 0:
            rejection = RejectionWords(run, i)
            rejection.kind = REJECT
            rejection.edge = e
            rejection.h = h
            rejection.size = REJECT_WORDS + doors
            rejection.rule = by
            rejection.step = step
            rejection.expected = evidence.expected
            rejection.observed = evidence.observed
            rejection.sequence = (
                -1 if by == BY_MOTION or evidence.wrong != 0 else run.sequences.number - 1
            )
            rejection.at = evidence.at
            rejection.record = evidence.record
            rejection.contradiction = evidence.wrong
            rejection.doors = doors
            for k in range(doors):
                rejection.door[k] = run.excursion.door[evidence.first + k]


@kernel
def declare_confirm(run: RunWords, e: int, h: int, by: int) -> None:
    declare(run, CONFIRM, e, h, by)


@kernel
def declare_augment(run: RunWords, e: int, kind: int, dart: int, degree: int) -> None:
    if run.task.tracing != 0:
        i = run.trace.place_of("word") + took(run, 5)
        if run.stop == 0:
            augmentation = AugmentationWords(run, i)
            augmentation.kind = AUGMENT
            augmentation.edge = e
            augmentation.growth = kind
            augmentation.dart = dart
            augmentation.degree = degree
