"""The bound O(m²n) of the paper is reached: a family in which `basic` needs about m²n / 20 moves.

Every vertex has degree 3. The marker is at one end of a ladder; its other end is joined to a random
cubic graph with as many vertices. While that graph is explored, in the order of m darts are open,
each is posed for each edge, and its way home has in the order of n doors. All places look alike, so
a false hypothesis is walked to its end, where the marker is missing.

This is measured, not proved: Coq proves the upper bound (Algorithms.bound_order), and of lower
bounds those that hold for every mapper.
"""

from __future__ import annotations

from topo_verify import World, explore, families
from topo_verify.robot.events import Confirm, Reject


def ladder_to_cubic_graph(rungs: int) -> World:
    """A ladder with so many rungs, the marker at its near end, behind it a cubic graph."""
    graph = families.regular(2 * rungs, 3, seed=0)
    rows = [list(row) for row in graph.vertices]
    (one, other), *edges = [(a, b) for a, b in graph.edges]

    def vertex() -> list[int]:
        first = 3 * len(rows)
        rows.append([first, first + 1, first + 2])
        return rows[-1]

    left, right = vertex(), vertex()
    root = left[0]
    edges += [(left[0], right[0]), (left[1], right[2])]
    upper, lower = left[2], right[1]
    for _ in range(rungs):
        left, right = vertex(), vertex()
        edges += [(upper, left[0]), (lower, right[0]), (left[1], right[2])]
        upper, lower = left[2], right[1]
    return World.from_rotations(rows, [*edges, (upper, one), (lower, other)], root)


def test_basic_needs_moves_of_the_order_of_the_bound() -> None:
    shares: list[float] = []
    for rungs in (4, 8, 16, 32):
        world = ladder_to_cubic_graph(rungs)
        edges, vertices = len(world.edges), len(world.vertices)
        assert (edges, vertices) == (6 * rungs + 3, 4 * rungs + 2)
        shares.append(explore(world, "basic").cost / (edges**2 * vertices))
    assert [round(share, 3) for share in shares] == [0.072, 0.049, 0.056, 0.049]


def test_false_hypotheses_are_walked_far_since_all_places_look_alike() -> None:
    world = ladder_to_cubic_graph(16)
    trace = explore(world, "basic").trace
    rejected = [event.evidence.step for event in trace if isinstance(event, Reject)]
    confirmed = sum(isinstance(event, Confirm) for event in trace)
    assert len(rejected) > 10 * confirmed
    assert sum(rejected) > 10 * len(rejected)
