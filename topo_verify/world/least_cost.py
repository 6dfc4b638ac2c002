"""The least cost of a proof: a lower bound for every mapper that is right in all worlds.

A mapper has proved its map only if its closed trips from v0 generate the fundamental group (else
the fold of its history has an open dart). That holds even for a mapper that was given the map.
Write d for the distance from v0.

- The classes of the trips span the cycle space. A closed trip of length at most t uses only edges
  uv with d(u) + 1 + d(v) <= t, so the loops that a breadth-first tree closes with the edges outside
  it are a lightest basis: d(u) + 1 + d(v) each.
- Edges of **pendant trees** (on no tree path from v0 to an end of such an edge) change no class.
  Each is walked there and back: 2·P for P of them.
- The last trip need not come back: ended at v in a pendant tree attached at a, it saves the depth
  of v below a, and costs d(a) to get there: s, if that is worth it.

LB = Σ (d(u) + 1 + d(v)) + 2·P - s. The loops attain it (proof_tour.py makes the walk), so it is the
optimum with the map in hand; cost / LB is the price of not knowing the map. It does not hold for
mappers that may assume planarity, n or m.

Source: docs/semantics.md, section 11.
"""

from __future__ import annotations

from itertools import accumulate

from topo_verify.world.enumeration.rank_order import Table


def least_cost(table: Table) -> int:
    """The least cost LB, in edge traversals, of the world with this canonical code. O(m)."""
    degrees, alpha = table
    vertex = [v for v, degree in enumerate(degrees) for _ in range(degree)]
    # The code numbers vertices breadth-first and the darts of each from the one it was entered by.
    # So the first darts lead to the parents, and every parent stands before its children.
    entry = list(accumulate(degrees, initial=0))[:-1]
    parent = [vertex[alpha[dart]] if dart else 0 for dart in entry]
    depth = [0] * len(degrees)
    for v in range(1, len(degrees)):
        depth[v] = depth[parent[v]] + 1
    in_tree = set(
        entry[1:]
    )  # an edge of the tree is its child's first dart, the greater of its two
    loops = [
        (vertex[dart], vertex[other])
        for dart, other in enumerate(alpha)
        if dart < other and other not in in_tree
    ]
    core = {0}  # the vertices on tree paths from v0 to the ends of loops
    # The order of this set does not show, because `core` is the union of the ways.
    for v in {end for loop in loops for end in loop}:
        while v not in core:
            core.add(v)
            v = parent[v]  # noqa: PLW2901  climbs towards v0
    attached = depth.copy()  # per vertex: the depth of the core vertex above it
    for v in range(len(degrees)):
        if v not in core:
            attached[v] = attached[parent[v]]
    pendant = [v for v in range(len(degrees)) if v not in core]
    # (depth of v below a) - d(a), where attached[v] = d(a).
    saved = max((depth[v] - 2 * attached[v] for v in pendant), default=0)
    return sum(depth[u] + 1 + depth[v] for u, v in loops) + 2 * len(pendant) - max(0, saved)
