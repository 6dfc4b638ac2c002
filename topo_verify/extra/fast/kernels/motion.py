"""Motion: excursions from vu, and which edge and which hypothesis is walked next.

Twin of algorithms/motion.py, `Pilot`, `Hypothesis`, `retrace`, `overlap`, and of
algorithms/policies.py, `nearest` and `shortest`, the policies of the reference costs. Differs: a
hypothesis is its dart; its way home is followed along `up`. Few hypotheses are sorted by insertion,
many by counting distances.
"""

from __future__ import annotations

from topo_verify.extra.fast.kernels.chart import door, first_in_u, reach, tree
from topo_verify.extra.fast.kernels.events import CROSS, RETRACE, VALIDATE, WALK
from topo_verify.extra.fast.kernels.faults import *
from topo_verify.extra.fast.kernels.kernel import inlined, kernel
from topo_verify.extra.fast.kernels.robot import move
from topo_verify.extra.fast.kernels.workspace import *


@inlined
def walk(run: RunWords, at: int, v: int) -> int:
    """Walk on S to v; return the reference dart."""
    chart = run.chart
    if chart.vertex[at] == v:
        return at
    tree(chart, v, chart.vertex[at])
    while chart.vertex[at] != v:
        exit_dart = chart.towards[chart.vertex[at]]
        move(run, door(run, at, exit_dart), WALK)
        if run.stop != 0:
            break
        at = chart.alpha[exit_dart]
    return at


@inlined
def cross(run: RunWords, at: int, e: int) -> int:
    excursion = run.excursion
    percept = move(run, door(run, at, e), CROSS)
    excursion.turned = 0
    excursion.size = 0
    excursion.percept[0] = percept
    return percept


@inlined
def forward(run: RunWords, door: int) -> None:
    excursion, world = run.excursion, run.world
    relative = door if planted(run.task, SETS_OUT_UNTURNED) else door - excursion.turned
    degree = world.degree[world.vertex[run.robot.dart]]
    # Twice at most, for a planted mistake.
    while relative < 0:
        relative += degree
    while relative >= degree:
        relative -= degree
    percept = move(run, relative, VALIDATE)
    excursion.turned = 0
    n = excursion.size
    excursion.door[n] = door
    excursion.percept[n + 1] = percept
    excursion.size = n + 1


@inlined
def back(run: RunWords, steps: int) -> None:
    """Retrace until this many doors of the excursion are left."""
    excursion, world = run.excursion, run.world
    if planted(run.task, RETRACES_ONE_EDGE_SHORT) and steps == 0:
        steps = 1
    if planted(run.task, RETRACES_IN_THE_WRONG_ORDER):
        turn_round(excursion, steps)
    while excursion.size > steps:
        relative = -excursion.turned
        degree = world.degree[world.vertex[run.robot.dart]]
        while relative < 0:
            relative += degree
        while relative >= degree:
            relative -= degree
        move(run, relative, RETRACE)
        if run.stop != 0:
            return
        n = excursion.size - 1
        excursion.size = n
        excursion.turned = excursion.door[n]
        if planted(run.task, FORGETS_ITS_ORIENTATION):
            excursion.turned = 0
        if planted(run.task, RESTORES_WITH_THE_WRONG_SIGN):
            excursion.turned = -excursion.door[n]


@kernel
def turn_round(excursion: ExcursionWords, steps: int) -> None:
    """Reverse the doors from a step on: a planted mistake."""
    low = steps
    high = excursion.size - 1
    while low < high:
        kept = excursion.door[low]
        excursion.door[low] = excursion.door[high]
        excursion.door[high] = kept
        low += 1
        high -= 1


@kernel
def choice(run: RunWords, remaining: int) -> int:
    """The index in H to walk next: by `retrace` the first, or `overlap`."""
    excursion = run.excursion
    excursion.shared = 0
    if run.task.motion == 0 or run.sequences.number == 0:
        return 0  # A1.8 A1.15 A3.9 A3.24
    best = 0
    longest = -1
    for i in range(remaining):
        shared = common_prefix(run, run.remaining.dart[i])
        # Ties: the order policy decides.
        if shared > longest:
            longest = shared
            best = i
    excursion.shared = longest
    return best  # A2.7 A2.22


@kernel
def common_prefix(run: RunWords, h: int) -> int:
    excursion, chart = run.excursion, run.chart
    n = excursion.size
    at = h
    for length in range(n):
        up = chart.up[chart.vertex[at]]
        if up < 0 or door(run, at, up) != excursion.door[length]:
            return length
        at = chart.alpha[up]
    return n


FEW = 24
"""The most hypotheses sorted by insertion."""


@inlined
def nearest(chart: ChartWords, at: int) -> int:
    root = chart.vertex[at]
    if chart.open[root] > 0:
        return first_in_u(chart, root)
    return reach(chart, root)


@kernel
def shortest(run: RunWords, number: int) -> None:
    remaining, chart = run.remaining, run.chart
    if number > FEW:
        counted(run, number)
        return
    for i in range(1, number):
        h = remaining.dart[i]
        depth = chart.depth[chart.vertex[h]]
        j = i
        while j > 0 and chart.depth[chart.vertex[remaining.dart[j - 1]]] > depth:
            remaining.dart[j] = remaining.dart[j - 1]
            j -= 1
        remaining.dart[j] = h


@kernel
def counted(run: RunWords, number: int) -> None:
    """Sort H as `shortest`, in linear time."""
    chart, remaining = run.chart, run.remaining
    for depth in range(chart.vertices):
        remaining.counts[depth] = 0
    for i in range(number):
        remaining.counts[chart.depth[chart.vertex[remaining.dart[i]]]] += 1
    below = 0
    for depth in range(chart.vertices):
        here = remaining.counts[depth]
        remaining.counts[depth] = below
        below += here
    for i in range(number):
        h = remaining.dart[i]
        depth = chart.depth[chart.vertex[h]]
        remaining.sorted[remaining.counts[depth]] = h
        remaining.counts[depth] += 1
    for i in range(number):
        remaining.dart[i] = remaining.sorted[i]
