"""A native mapper in the place of `explore`: called by its address, it calls back.

Twin of programs/library.py; both refuse the same things. After a refusal, or the map, each callback
does nothing and returns `REFUSED`. Declarations are checked as far as Python takes them for an
index or an event.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from topo_verify.extra.fast.kernels.events import *
from topo_verify.extra.fast.kernels.kernel import callback, entry, inlined, kernel
from topo_verify.extra.fast.kernels.robot import declare, move, sensed, took
from topo_verify.extra.fast.kernels.workspace import *

if TYPE_CHECKING:  # native_call.py needs numba

    def call_address(address: int, argument: int) -> int: ...

    def row_at(address: int, size: int) -> Any: ...


SIZE = SMALL.at("SIZE")

REFUSED = -1

MOST_WORDS = 1 << 20
"""The most words read of a mapper's row."""

MOST_DEGREE = 1_000_000

PURPOSE_COUNT = 4

FENCE_WORDS = 8
FENCE = 0x5AFE5AFE5AFE5AFE
"""Stands before each row, to detect stray writes."""

WROTE = 71
"""Exit code if a mapper wrote over our data."""


@entry
def run_native(run: RunWords, darts: int, vertices: int) -> int:
    """Have the native mapper map the world: the cost; -1: no map."""
    return explore_native(run, darts, vertices)


@kernel
def explore_native(run: RunWords, darts: int, vertices: int) -> int:
    """`run_native`, for other kernels."""
    run.robot.dart = 0
    run.robot.cost = 0
    run.stop = 0
    run.trace.size = 0
    run.native.delivered = 0
    run.native.reported = ABSENT
    B = row_at(run.native.beats, 2)
    B[0] = run.native.rank - run.native.first
    B[1] += 1
    before = mark(run, darts, vertices)
    call_address(run.native.mapper, run.native.robot)
    if mark(run, darts, vertices) != before or is_torn(run):
        # The enumeration goes on in this world, so later ones would be wrong.
        call_address(run.native.exit, WROTE)
    return run.robot.cost if run.native.delivered != 0 and run.stop == 0 else -1


@inlined
def mark(run: RunWords, darts: int, vertices: int) -> int:
    """A hash of the world, and of what leads to it."""
    h = (
        run.native.mapper
        ^ run.native.robot
        ^ run.native.beats
        ^ run.native.exit
        ^ run.task.room
        ^ run.task.budget
        ^ run.task.tracing
    )
    for d in range(darts):
        h = (h ^ (run.world.alpha[d] + (run.world.vertex[d] << 16))) * 1099511628211
    for v in range(vertices):
        h = (h ^ (run.world.first[v] + (run.world.degree[v] << 16))) * 1099511628211
    return h


@inlined
def is_torn(run: RunWords) -> bool:
    F = row_at(run.native.self - 8 * FENCE_WORDS, FENCE_WORDS)
    torn = False
    for k in range(FENCE_WORDS):
        torn = torn or F[k] != FENCE
    return torn


@inlined
def is_over(run: RunWords) -> bool:
    return run.stop != 0 or run.native.delivered != 0


@callback
def native_look(run: RunWords) -> int:
    return REFUSED if is_over(run) else sensed(run.world, run.robot.dart)


@callback
def native_move(run: RunWords, door: int, purpose: int) -> int:
    if is_over(run):
        return REFUSED
    B = row_at(run.native.beats, 2)
    B[1] += 1
    percept = move(run, door, purpose if 0 <= purpose < PURPOSE_COUNT else ABSENT)
    return percept if run.stop == 0 else REFUSED


@callback
def native_pose(run: RunWords, e: int, number: int, hypotheses: int) -> int:
    if is_over(run):
        return REFUSED
    if number < 0 or number > MOST_WORDS:
        run.stop = STOP_EVENT
        return REFUSED
    i = run.trace.place_of("word") + took(run, 3 + number)
    if run.stop == 0:
        posed = row_at(hypotheses, number)
        run[i] = POSE
        run[i + 1] = e
        run[i + 2] = number
        for k in range(number):
            run[i + 3 + k] = posed[k]
    return 0 if run.stop == 0 else REFUSED


@callback
def native_reject(
    run: RunWords, e: int, h: int, by: int, evidence: int, number: int, way: int
) -> int:
    """Evidence: seven words; way: a record's doors."""
    if is_over(run):
        return REFUSED
    if not is_rejection(by, evidence, number):
        run.stop = STOP_EVENT
        return REFUSED
    E = row_at(evidence, 7)
    doors = 0 if E[5] == ABSENT else number
    i = run.trace.place_of("word") + took(run, REJECT_WORDS + doors)
    if run.stop == 0:
        D = row_at(way, doors)
        run[i] = REJECT
        run[i + 1] = e
        run[i + 2] = h
        run[i + 3] = REJECT_WORDS + doors
        run[i + 4] = by
        for k in range(7):  # step expected observed sequence at record contradiction
            run[i + 5 + k] = E[k]
        run[i + 12] = doors
        for k in range(doors):
            run[i + 13 + k] = D[k]
    return 0 if run.stop == 0 else REFUSED


@kernel
def is_rejection(by: int, evidence: int, number: int) -> bool:
    E = row_at(evidence, 7)
    if number < 0 or number > MOST_WORDS or by < 0 or by > BY_PLANAR:
        return False
    if E[6] < 0 or E[6] > OTHER_FACE:
        return False
    for k in range(1, 3):  # noqa: SIM110  numba knows no such generator
        if E[k] < ABSENT or E[k] >> SHIFT > MOST_DEGREE:
            return False
    return True


@callback
def native_confirm(run: RunWords, e: int, h: int, by: int) -> int:
    if is_over(run):
        return REFUSED
    if by < 0 or by > BY_PLANAR:
        run.stop = STOP_EVENT
        return REFUSED
    declare(run, CONFIRM, e, h, by)
    return 0 if run.stop == 0 else REFUSED


@callback
def native_augment(run: RunWords, e: int, kind: int, dart: int, degree: int) -> int:
    if is_over(run):
        return REFUSED
    if kind < NEW or kind > LOOP:
        run.stop = STOP_EVENT
        return REFUSED
    i = run.trace.place_of("word") + took(run, 5)
    if run.stop == 0:
        run[i] = AUGMENT
        run[i + 1] = e
        run[i + 2] = kind
        run[i + 3] = dart
        run[i + 4] = degree
    return 0 if run.stop == 0 else REFUSED


@callback
def native_skip(run: RunWords, _why: int) -> int:
    """Decline the world; behind the pipe it says why."""
    if not is_over(run):
        run.stop = STOP_SKIP
    return REFUSED


@callback
def native_deliver(
    run: RunWords, vertices: int, degrees: int, alpha: int, marker: int, cost: int
) -> int:
    """Deliver a map: degrees of vertices, other ends of darts, the marker's dart."""
    if is_over(run):
        return REFUSED
    if vertices < 0 or vertices > MOST_WORDS:
        run.stop = STOP_MAP
        return REFUSED
    place_map(run, vertices, degrees, alpha, marker)
    if run.stop != 0:
        return REFUSED
    run.native.delivered = 1
    run.native.reported = cost
    return 0


@kernel
def place_map(run: RunWords, vertices: int, degrees: int, alpha: int, marker: int) -> None:
    """Write the map as the chart, its darts in order of discovery."""
    run.chart.vertices = vertices
    run.chart.darts = -1
    darts = place_vertices(run, vertices, degrees)
    if darts < 0 or not is_paired(run, alpha, darts):
        return
    D = row_at(degrees, vertices)
    A = row_at(alpha, darts)
    if darts == 0:
        if marker == ABSENT and vertices == 1:
            run.chart.darts = 0
            run.chart.degree[0] = 0
    elif 0 <= marker < darts:
        if marker == 0 and is_in_order(run, A, darts):
            for d in range(darts):
                run.chart.vertex[d] = run.native.given[d]
                run.chart.alpha[d] = A[d]
            for v in range(vertices):
                run.chart.degree[v] = D[v]
            run.chart.darts = darts
        else:
            rename_darts(run, vertices, D, A, darts, marker)


@kernel
def place_vertices(run: RunWords, vertices: int, degrees: int) -> int:
    """Write the vertices; return the number of darts; -1: no map."""
    D = row_at(degrees, vertices)
    darts = 0
    for v in range(vertices):
        if D[v] < 0:
            run.stop = STOP_MAP
            return -1
        if v >= CHART_DARTS or D[v] > CHART_DARTS - darts:
            return -1
        run.chart.first[v] = darts
        for k in range(D[v]):
            run.native.given[darts + k] = v
            run.native.named[darts + k] = -1
        darts += D[v]
    return darts


@kernel
def is_paired(run: RunWords, alpha: int, darts: int) -> bool:
    A = row_at(alpha, darts)
    for d in range(darts):
        if A[d] < 0 or A[d] >= darts or A[d] == d or A[A[d]] != d:
            run.stop = STOP_MAP
            return False
    return True


@kernel
def is_in_order(run: RunWords, A: Any, darts: int) -> bool:
    met = 0
    for d in range(darts):
        if run.native.given[d] > met:
            return False
        met = max(met, run.native.given[A[d]])
    return True


@kernel
def rename_darts(run: RunWords, vertices: int, D: Any, A: Any, darts: int, marker: int) -> None:
    named = name_vertex(run, D, marker, 0)
    reached = 1
    d = 0
    while d < named:
        other = A[run.chart.alpha[d]]
        if run.native.named[other] < 0:
            named = name_vertex(run, D, other, named)
            reached += 1
        d += 1
    if named < darts or reached < vertices:
        return
    v = -1
    last = -1
    for at in range(darts):
        given = run.native.given[run.chart.alpha[at]]
        if given != last:
            v += 1
            run.chart.degree[v] = D[given]
            run.chart.first[v] = at
            last = given
        run.chart.vertex[at] = v
    for d in range(darts):
        run.chart.alpha[d] = run.native.named[A[run.chart.alpha[d]]]
    run.chart.darts = darts


@kernel
def name_vertex(run: RunWords, D: Any, dart: int, named: int) -> int:
    """Name the darts of a vertex from this one on; return the number named."""
    v = run.native.given[dart]
    begin = run.chart.first[v]
    for _ in range(D[v]):
        run.native.named[dart] = named
        run.chart.alpha[named] = dart
        named += 1
        dart += 1
        if dart == begin + D[v]:
            dart = begin
    return named
