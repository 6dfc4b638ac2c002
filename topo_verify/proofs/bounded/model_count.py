"""The worlds of the encoding: the solver lists them, and they are compared with the enumeration.

With S = v0 alone a model of the encoding is a world in its breadth-first numbering. So the list of
all models (each one found is forbidden before the next is asked for) must contain each rooted map
once: the pairs (degrees, alpha) must be exactly the canonical codes of `world.enumeration`. There
are 2, 10, 74, 706, 8162 of them with 1 … 5 edges. Hence "every world" in the bounded theorems means
every world.

Source: docs/semantics.md, section 12.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from itertools import accumulate

from topo_verify.proofs.bounded.cnf import REFUTED
from topo_verify.proofs.bounded.decode import decode_table
from topo_verify.proofs.bounded.encoding import Worlds
from topo_verify.proofs.bounded.solve import SolverGaveUp, models
from topo_verify.proofs.theorem import Budget
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.enumeration.rank_order import Table

LISTED_EDGES = 4
"""Up to this size the worlds of a theorem are counted in its encoding; beyond, by formulas."""


def every_world(edges: int, world_class: str = "any") -> Worlds:
    """The encoding of the worlds of a class, each in its breadth-first numbering."""
    world = Worlds(edges)
    world.restrict(world_class)
    world.number_the_rest()
    return world


def codes(edges: int, world_class: str = "any", budget: Budget | None = None) -> Iterator[Table]:
    """The pair (degrees, alpha) of each model, in the order in which the solver finds them.

    Raises:
        SolverGaveUp: the solver gave up before it had excluded further models.
    """
    world = every_world(edges, world_class)
    # These determine the world; every other Boolean is defined by them.
    over = (*world.first, *world.joined.values())
    for model in models(world, over, budget or Budget()):
        yield decode_table(world, model)


def missing_and_spurious(
    edges: int, world_class: str = "any", budget: Budget | None = None
) -> tuple[int, list[Table], list[Table]]:
    """The number of models; the codes without a model; the models that are no code, or repeated."""
    kind = WorldClass.parse(world_class)
    wanted = {table for table in rank_order.tables(edges) if kind.admits(table)}
    spurious: list[Table] = []
    found = 0
    for code in codes(edges, world_class, budget):
        found += 1
        if code in wanted:
            wanted.remove(code)  # so that a second model with this code counts as spurious
        else:
            spurious.append(code)
    return found, sorted(wanted), spurious


def another_world(edges: int) -> Worlds:
    """The clauses of a world that is none of the canonical codes: they must contradict."""
    world = every_world(edges)
    for degrees, alpha in rank_order.tables(edges):
        # One clause for each code: the world has other vertices, or lacks one of its edges.
        firsts = {0, *accumulate(degrees[:-1])}
        numbers = [-world.first[d] if d in firsts else world.first[d] for d in world.darts]
        joined = [-world.edge(d, other) for d, other in enumerate(alpha) if d < other]
        world.add(REFUTED, *numbers, *joined)
    return world


@cache
def worlds_encoded(edges: int, world_class: str = "any") -> int | None:
    """The number of worlds of the class in the encoding; None if the solver gave up.

    Up to `LISTED_EDGES` the models that the enumeration confirms are counted; beyond, the formulas
    or the enumeration give the number.
    """
    if edges > LISTED_EDGES:
        return WorldClass.parse(world_class).count(edges)
    try:
        found, _, spurious = missing_and_spurious(edges, world_class)
    except SolverGaveUp:
        return None
    return found - len(spurious)
