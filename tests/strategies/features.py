"""What a world has, as the conditions of searches: loops, bridges, cycles that close far away."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

from topo_verify import World, explore
from topo_verify.robot.events import Augment, Confirm, Event, Move

Condition = Callable[[World], bool]


def joins(world: World) -> Counter[tuple[int, int]]:
    """How many edges join two vertices, or one with itself."""
    of = world.vertex_of
    return Counter((min(of[a], of[b]), max(of[a], of[b])) for a, b in world.edges)


def has_loop(world: World) -> bool:
    return any(u == v for u, v in joins(world))


def has_parallel_edges(world: World) -> bool:
    return any(number > 1 for (u, v), number in joins(world).items() if u != v)


def has_bridge(world: World) -> bool:
    """Is there an edge without which the world falls apart?"""
    return any(not is_whole_without(world, edge) for edge in world.edges)


def is_whole_without(world: World, edge: tuple[int, int]) -> bool:
    reached = {0}
    queue = [0]
    for vertex in queue:  # grows as it goes
        for dart in world.vertices[vertex]:
            other = world.vertex_of[world.alpha[dart]]
            if dart not in edge and other not in reached:
                reached.add(other)
                queue.append(other)
    return len(reached) == len(world.vertices)


def signatures(world: World) -> Counter[tuple[int, bool]]:
    """How many vertices have which degree and the marker or not: what a robot can tell apart."""
    return Counter((d, v == world.marker_vertex) for v, d in enumerate(world.degrees))


def has_equal_signatures(world: World) -> bool:
    return max(signatures(world).values()) > 1


def has_three_of_one_degree(world: World) -> bool:
    return max(Counter(world.degrees).values()) >= 3


def way_home(trace: tuple[Event, ...]) -> int:
    """The most doors that confirmed a hypothesis by motion; where all paths are retraced."""
    longest = length = 0
    for event in trace:
        if isinstance(event, Move):
            length = length + 1 if event.purpose == "validate" else 0
        elif isinstance(event, Confirm):
            longest = max(longest, length)
        elif isinstance(event, Augment):
            length = 0
    return longest


def closes_far_away(world: World) -> bool:
    """Does `basic` confirm a hypothesis at distance 3 from the marker, or further?"""
    return way_home(explore(world, "basic").trace) >= 3


def is_dear(world: World) -> bool:
    return explore(world, "basic").cost > 20
