"""The negatives: without the marker's direction, mappers confirm false hypotheses.

A mapper stands behind e and walks the way home of a hypothesis h, a shortest way on S from h to v0.
It compares the percepts at each door and at both ends, but of the marker it compares only the
presence (`undirected`), or nothing (`none`). Then there are worlds in which every percept is as
expected although e does not end in h. The smallest have this many edges:

    class       undirected   none
    any         2            2
    loopless    3            2
    simple      4            3

The way is any shortest one, whichever a breadth-first search would take: so there is no smaller
world for any policy. Depths on S are one-hot:

    depth[x][t]   the vertex of x is t edges from v0 on S       down[x]   x leads one nearer to v0

Source: docs/semantics.md, sections 6 and 10.
"""

from __future__ import annotations

from dataclasses import dataclass

from topo_verify.proofs.bounded.cnf import REFUTED, CnfRow, Formula
from topo_verify.proofs.bounded.encoding import EncodedMap, MarkerDetail, Worlds
from topo_verify.proofs.bounded.walks import behind_an_edge, doors, hypothesis, stay_explored, walk
from topo_verify.proofs.bounded.word_rules import EncodedCounterexample


@dataclass(frozen=True, slots=True)
class Negative:
    """A false claim about a class of worlds, and the edges of the smallest that refutes it."""

    marker: MarkerDetail
    world_class: str
    edges: int

    @property
    def name(self) -> str:
        """The name of the theorem, such as `undirected-simple`."""
        return f"{self.marker}-{self.world_class}"

    @property
    def statement(self) -> str:
        """The false claim, in words."""
        what = {
            "directed": "compares all of the marker",
            "undirected": "looks only at the presence of the marker",
            "none": "does not look at the marker",
        }
        kind = "a" if self.world_class == "any" else f"a {self.world_class}"
        return f"A mapper that {what[self.marker]} confirms a false hypothesis in {kind} world."


SMALLEST = (
    Negative("undirected", "any", 2),
    Negative("none", "any", 2),
    Negative("undirected", "loopless", 3),
    Negative("none", "loopless", 2),
    Negative("undirected", "simple", 4),
    Negative("none", "simple", 3),
)


def premises(edges: int, world_class: str) -> Formula:
    """Any unexplored dart of any map of any world of the class, without a hypothesis."""
    # Without h: in the loopless world with one edge there is none, and the theorem counts it.
    return behind_an_edge(edges, world_class=world_class).world


def false_confirmation(edges: int, world_class: str, marker: MarkerDetail) -> EncodedCounterexample:
    """Every percept on a shortest way home from h is as expected, and e does not end in h."""
    scene = behind_an_edge(edges, world_class=world_class)
    world, h = scene.world, hypothesis(scene)
    word = doors(world, "door", edges)
    go = world.booleans("way.go", edges)
    here = walk(world, "here", h, word, go)
    there = walk(world, "there", scene.vu, word, go)
    stay_explored(world, scene.chart, here, go)
    # A step is made exactly if v0 is not reached yet, and after all steps it is.
    for i, on in enumerate(go):
        world.equate("way", (), (on,), (-here.senses[i].here,))
    world.add("way", here.senses[-1].here)
    depth = depths(world, scene.chart)
    for i, on in enumerate(go):
        _one_nearer(world, depth, here.leave[i], here.at[i + 1], on)
    for i, (one, other) in enumerate(zip(here.senses, there.senses, strict=True)):
        world.add("matching", world.alike("percepts", one, other, f"compare.{i}", marker))
    for a, b in zip(h, scene.vu, strict=True):
        world.add(REFUTED, -a, -b)
    return EncodedCounterexample(
        world=world, chart=scene.chart, e=scene.e, h=h, executed=word, made=go
    )


def depths(world: Worlds, chart: EncodedMap) -> tuple[CnfRow, ...]:
    """Per dart, a one-hot row: the distance of its vertex from v0 on the map."""
    group, levels = "depths", range(world.edges + 1)
    depth = tuple(world.booleans(f"depth.{d}", len(levels)) for d in world.darts)
    down = world.booleans("down", len(world.darts))
    for d in world.darts:
        # Depth 0 is v0 alone. A dart has one depth if S knows it, and none otherwise.
        world.equate(group, (), (world.in_v0[d],), depth[d][:1])
        world.imply(group, [chart.known[d]], *depth[d])
        for t in levels:
            world.imply(group, [depth[d][t]], chart.known[d])
            for u in range(t):
                world.add(group, -depth[d][t], -depth[d][u])
        world.imply(group, [down[d]], chart.explored[d])
    # All darts of a vertex have one depth, and each vertex but v0 has a dart that leads nearer.
    for (f, degree), vertex in world.vertex.items():
        for x in range(f + 1, f + degree):
            world.equate(group, (vertex,), depth[x], depth[f])
        if f:
            nearer = down[f : f + degree]
            world.imply(group, [vertex, chart.known[f]], *nearer)
    for a, b in world.joined:
        for x, y in ((a, b), (b, a)):
            for t in levels[1:]:
                joined = (world.edge(a, b), depth[x][t])
                world.imply(group, (*joined, down[x]), depth[y][t - 1])
                # An explored edge changes the depth by at most one: so depths are distances.
                farther = depth[y][t - 1 : t + 2]
                world.imply(group, (*joined, chart.explored[x]), *farther)
    return depth


def _one_nearer(
    world: Worlds, depth: tuple[CnfRow, ...], leave: CnfRow, arrive: CnfRow, on: int
) -> None:
    """Require that a step that is made leads from depth t to depth t - 1."""
    for x in world.darts:
        for y in world.darts:
            for t in range(1, world.edges + 1):
                made = (on, leave[x], arrive[y], depth[x][t])
                world.imply("shortest", made, depth[y][t - 1])
