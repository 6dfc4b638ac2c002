"""The map S that the mapper draws. Twin of algorithms/chart.py, `Chart`.

Differs: U is a mark at each dart with a count at each vertex. The tree rooted at v0 is kept
(`chart.has_tree`) over edges that cannot change it: to a new vertex, which hangs at vk, and between
vertices at one distance.
"""

from __future__ import annotations

from topo_verify.extra.fast.kernels.faults import COUNTS_DOORS_ANTICLOCKWISE, planted
from topo_verify.extra.fast.kernels.kernel import inlined, kernel
from topo_verify.extra.fast.kernels.workspace import *


@kernel
def start_chart(run: RunWords, percept: int) -> None:
    chart = run.chart
    chart.vertices = 0
    chart.darts = 0
    chart.unexplored = 0
    add_vertex(run, percept)
    chart.depth[0] = 0
    chart.up[0] = -1
    chart.has_tree = 1


@kernel
def add_vertex(run: RunWords, percept: int) -> int:
    chart = run.chart
    v = chart.vertices
    first = chart.darts
    degree = percept >> SHIFT
    if first + degree > CHART_DARTS:
        run.stop = STOP_FULL + FULL_CHART
        return 0
    marker = percept & MASK  # 1 + marker
    chart.first[v] = first
    chart.degree[v] = degree
    chart.signature[v] = 2 * degree + (marker > 0)
    chart.open[v] = degree
    chart.depth[v] = -1
    for dart in range(first, first + degree):
        chart.alpha[dart] = -1
        chart.vertex[dart] = v
        chart.in_u[dart] = 1
        run.records.of_dart[dart] = -1
        # From the next place clockwise, the marker is one door nearer.
        chart.percept[dart] = degree * P + marker
        if marker == 1:
            marker = degree
        elif marker > 1:
            marker -= 1
    chart.vertices = v + 1
    chart.darts = first + degree
    chart.unexplored += degree
    return first


@inlined
def leave_u(chart: ChartWords, dart: int) -> None:
    if chart.in_u[dart] != 0:
        chart.in_u[dart] = 0
        chart.unexplored -= 1
        chart.open[chart.vertex[dart]] -= 1


@inlined
def join(chart: ChartWords, e: int, other: int) -> None:
    chart.alpha[e] = other
    chart.alpha[other] = e
    leave_u(chart, e)
    leave_u(chart, other)
    vk = chart.vertex[e]
    v = chart.vertex[other]
    if chart.depth[v] < 0:
        chart.depth[v] = chart.depth[vk] + 1
        chart.up[v] = other
    elif chart.depth[v] != chart.depth[vk]:
        chart.has_tree = 0


@inlined
def turn(chart: ChartWords, dart: int, door: int) -> int:
    v = chart.vertex[dart]
    beyond = chart.first[v] + chart.degree[v]
    turned = dart + door
    while turned >= beyond:
        turned -= chart.degree[v]
    return turned


@inlined
def door(run: RunWords, dart: int, exit_dart: int) -> int:
    chart = run.chart
    doors = exit_dart - dart
    if planted(run.task, COUNTS_DOORS_ANTICLOCKWISE):
        doors = dart - exit_dart
    if doors < 0:
        doors += chart.degree[chart.vertex[dart]]
    return doors


@kernel
def tree(chart: ChartWords, root: int, until: int) -> None:
    """The breadth-first tree from a vertex, until `until` is reached: `seen`, `near`, `towards`."""
    search = chart.search + 1
    chart.search = search
    chart.seen[root] = search
    chart.towards[root] = -1
    chart.reached[0] = root
    head = 0
    tail = 1
    while head < tail:
        v = chart.reached[head]
        head += 1
        # Its way to the root was reached before it.
        if v == until:
            return
        for dart in range(chart.first[v], chart.first[v] + chart.degree[v]):
            other = chart.alpha[dart]
            if other >= 0:
                u = chart.vertex[other]
                if chart.seen[u] != search:
                    # `other` leads back.
                    chart.seen[u] = search
                    chart.towards[u] = other
                    chart.reached[tail] = u
                    tail += 1


@kernel
def tree_of_v0(chart: ChartWords) -> None:
    """The breadth-first tree from v0: `depth`, `up`."""
    if chart.has_tree != 0:
        return
    chart.has_tree = 1
    for v in range(1, chart.vertices):
        chart.depth[v] = -1
    chart.queue[0] = 0
    head = 0
    tail = 1
    while head < tail:
        v = chart.queue[head]
        head += 1
        depth = chart.depth[v] + 1
        for dart in range(chart.first[v], chart.first[v] + chart.degree[v]):
            other = chart.alpha[dart]
            if other >= 0:
                u = chart.vertex[other]
                if chart.depth[u] < 0:
                    chart.depth[u] = depth
                    chart.up[u] = other
                    chart.queue[tail] = u
                    tail += 1


@kernel
def first_in_u(chart: ChartWords, v: int) -> int:
    dart = chart.first[v]
    while chart.in_u[dart] == 0:
        dart += 1
    return dart


@kernel
def reach(chart: ChartWords, root: int) -> int:
    """The lowest dart of U nearest to the root; `policies.nearest`."""
    search = chart.search + 1
    chart.search = search
    chart.seen[root] = search
    chart.near[root] = 0
    chart.reached[0] = root
    head = 0
    tail = 1
    best = -1
    distance = 0
    while head < tail:
        v = chart.reached[head]
        head += 1
        if best >= 0 and chart.near[v] > distance:
            break
        if chart.open[v] > 0:
            opened = first_in_u(chart, v)
            if best < 0 or opened < best:
                best = opened
                distance = chart.near[v]
        elif best < 0:
            for dart in range(chart.first[v], chart.first[v] + chart.degree[v]):
                other = chart.alpha[dart]
                if other >= 0:
                    u = chart.vertex[other]
                    if chart.seen[u] != search:
                        chart.seen[u] = search
                        chart.near[u] = chart.near[v] + 1
                        chart.reached[tail] = u
                        tail += 1
    return best
