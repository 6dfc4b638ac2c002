"""The least cost of a proof: what every mapper pays that is right in all worlds.

To prove its map, a mapper's closed trips from v0 must generate the fundamental group (else the fold
of its history has an open dart), even with the map in hand. Write d for the distance from v0.

- The classes of the trips span the cycle space. A closed trip of length at most t uses only edges
  uv with d(u) + 1 + d(v) <= t, so the loops that a breadth-first tree closes with the edges outside
  it are a lightest basis: d(u) + 1 + d(v) each.
- Edges of **pendant trees** (on no tree path from v0 to an end of such an edge) change no class.
  Each is walked there and back: 2·P for P of them.
- The last trip need not come back: ended at v in a pendant tree attached at a, it saves the depth
  of v below a, and costs d(a) to get there: s, if that is worth it.

LB = Σ (d(u) + 1 + d(v)) + 2·P - s. The loops attain it, so it is the optimum with the map in hand;
cost / LB is the price of not knowing the map. It does not hold for mappers that may assume
planarity, n or m.

Source: docs/semantics.md, section 11.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from topo_verify.world.rooted_map import World


def least_cost(world: World) -> int:
    """LB in edge traversals; 0 for the world without edges. O(m)."""
    vertex = world.vertex_of
    depth, parent = {world.marker_vertex: 0}, {world.marker_vertex: -1}
    order = [world.marker_vertex]
    tree: set[int] = set()
    for v in order:  # grows as it goes: a queue
        for dart in world.vertices[v]:
            u = vertex[world.alpha[dart]]
            if u not in depth:
                depth[u], parent[u] = depth[v] + 1, v
                tree.add(min(dart, world.alpha[dart]))
                order.append(u)
    loops = [(vertex[a], vertex[b]) for a, b in world.edges if a not in tree]
    core = {world.marker_vertex}  # the vertices on tree paths from v0 to the ends of loops
    for end in {end for loop in loops for end in loop}:
        v = end
        while v not in core:
            core.add(v)
            v = parent[v]
    attached = {v: depth[v] for v in core}  # per vertex: the depth of the core vertex above it
    for v in order:
        attached.setdefault(v, attached.get(parent[v], 0))
    saved = max((depth[v] - 2 * attached[v] for v in order if v not in core), default=0)
    pendant = len(order) - len(core)
    return sum(depth[u] + 1 + depth[v] for u, v in loops) + 2 * pendant - max(0, saved)
