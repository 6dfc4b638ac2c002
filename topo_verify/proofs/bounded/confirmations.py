"""False confirmations: negatives, the false claims that a world must refute.

Behind e a mapper walks a shortest way on S from hypothesis h to v0, and compares only the marker's
presence (`undirected`), or nothing of it (`none`). In some world every percept is as expected
although h is false. The smallest such worlds have this many edges, for any policy:

    class       undirected   none
    any         2            2
    loopless    3            2
    simple      4            3

One negative is a control in the catalogue; tests refute all. With fewer edges there is no such
world (`theorems.py`).

Depths on S are one-hot: depth[x][t] says that the vertex of x is t edges from v0, down[x] that x
leads one nearer to v0.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from topo_verify.proofs.bounded import encoding as enc
from topo_verify.proofs.bounded.cnf import REFUTED, CnfRow, Formula, first_model
from topo_verify.proofs.bounded.replay import (
    BoundedCounterexample,
    ReplayedCounterexample,
    decode,
    decoded_booleans,
    replay_confirmation,
)
from topo_verify.proofs.bounded.statements import EncodedCounterexample
from topo_verify.proofs.solvers.z3_solver import z3_result
from topo_verify.proofs.theorem import Budget, Theorem, TheoremResult, one_query, timed


@dataclass(frozen=True, slots=True)
class Negative:
    """A false claim about a class, and the edges of the smallest world that refutes it."""

    marker: enc.MarkerDetail
    world_class: str
    edges: int

    @property
    def name(self) -> str:
        return f"{self.marker}-{self.world_class}"

    @property
    def statement(self) -> str:
        compared = {
            "directed": "compares all of the marker",
            "undirected": "looks only at the presence of the marker",
            "none": "does not look at the marker",
        }
        kind = "a" if self.world_class == "any" else f"a {self.world_class}"
        return f"A mapper that {compared[self.marker]} confirms a false hypothesis in {kind} world."


SMALLEST = (
    Negative("undirected", "any", 2),
    Negative("none", "any", 2),
    Negative("undirected", "loopless", 3),
    Negative("none", "loopless", 2),
    Negative("undirected", "simple", 4),
    Negative("none", "simple", 3),
)


def premises(edges: int, world_class: str) -> Formula:
    # Without h: the loopless world with one edge has none, but counts.
    return enc.behind_an_edge(edges, world_class=world_class).world


def false_confirmation(
    edges: int, world_class: str, marker: enc.MarkerDetail
) -> EncodedCounterexample:
    """Percepts on a shortest way home from a false h are as expected."""
    scene = enc.behind_an_edge(edges, world_class=world_class)
    world, h = scene.world, enc.hypothesis(scene)
    word = enc.doors(world, "door", edges)
    go = world.booleans("way.go", edges)
    here = enc.walk(world, "here", h, word, go)
    there = enc.walk(world, "there", scene.vu, word, go)
    enc.stay_explored(world, scene.chart, here, go)
    # A step is made exactly if v0 is not reached yet.
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


def depths(world: enc.Worlds, chart: enc.EncodedMap) -> tuple[CnfRow, ...]:
    """Per dart, one-hot: the distance of its vertex from v0 on the map."""
    group, levels = "depths", range(world.edges + 1)
    depth = tuple(world.booleans(f"depth.{d}", len(levels)) for d in world.darts)
    down = world.booleans("down", len(world.darts))
    for d in world.darts:
        # Known darts have one depth; 0 is v0.
        world.equate(group, (), (world.in_v0[d],), depth[d][:1])
        world.imply(group, [chart.known[d]], *depth[d])
        for t in levels:
            world.imply(group, [depth[d][t]], chart.known[d])
            for u in range(t):
                world.add(group, -depth[d][t], -depth[d][u])
        world.imply(group, [down[d]], chart.explored[d])
    # A vertex has one depth, and a dart that leads nearer.
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
                farther = depth[y][t - 1 : t + 2]
                world.imply(group, (*joined, chart.explored[x]), *farther)
    return depth


def _one_nearer(
    world: enc.Worlds, depth: tuple[CnfRow, ...], leave: CnfRow, arrive: CnfRow, on: int
) -> None:
    for x in world.darts:
        for y in world.darts:
            for t in range(1, world.edges + 1):
                premise = (on, leave[x], arrive[y], depth[x][t])
                world.imply("shortest", premise, depth[y][t - 1])


def negative(case: Negative) -> Theorem:
    build = partial(false_confirmation, case.edges, case.world_class, case.marker)
    return Theorem(
        name=case.name,
        kind="negative",
        claims=("no-false-confirm",),
        words=f"{case.statement} {case.edges} edges are enough.",
        symbols="every percept on a shortest way home as expected ∧ h ≠ alpha(e)",
        solver_part=f"finds a world with {case.edges} edges, a map and a hypothesis",
        expected="REFUTED",
        prove=timed(partial(refute, build, partial(replay_confirmation, marker=case.marker))),
        queries=one_query(case.name, partial(script, build), "sat"),
        edges=case.edges,
    )


def refute(
    build: Callable[[], EncodedCounterexample],
    replay: Callable[[BoundedCounterexample], ReplayedCounterexample],
    budget: Budget,
) -> TheoremResult:
    encoded = build()
    result = first_model(encoded.world, decoded_booleans(encoded), budget)
    if result.model is None:
        # No model: EXHAUSTED is not the expected verdict.
        exhausted = result.answer == "unsat"
        return z3_result(
            verdict="EXHAUSTED" if exhausted else "UNKNOWN",
            note="there is no such world" if exhausted else f"{result.why}; more time: --timeout",
        )
    replayed = replay(decode(encoded, result.model))
    return z3_result(
        verdict="REFUTED",
        replayed=(1, 1),
        counterexample=replayed.world.id,
        history=replayed.doors,
        note=f"{replayed.claim} fails in {replayed.world.id} at event {replayed.event}",
    )


def script(build: Callable[[], EncodedCounterexample]) -> str:
    return build().world.smt2() + "(check-sat)\n"


CONTROL: Theorem = negative(SMALLEST[0])
"""An undirected marker is not enough: refuted in milliseconds, by a world that is replayed."""
