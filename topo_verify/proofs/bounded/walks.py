"""Walks as clauses: a word of doors, executed in the world and traced on a map.

A robot has crossed the unexplored dart `e` and stands at `vu`, its reference dart `alpha(e)`. A
hypothesis `h` says that this is dart h of S. Then a word of doors can be followed twice:

    there     in the world, from alpha(e): the true positions of the robot
    here      on S, from h, over explored darts: the positions that the hypothesis predicts

The rules compare the percepts there with those that S shows here. The statements speak of any word
up to a number of doors, any map, and any world with m edges:

    confirm   here ends at v0 and the last percepts are equal            ⇒  h = alpha(e)
    trace     h = alpha(e), every door crosses an explored dart          ⇒  all percepts are equal
    prefix    h = alpha(e), another word was executed there              ⇒  equal on what they share
    history   h = alpha(e), any word, traced until a dart is unexplored  ⇒  equal until then
    records   as history, and behind the unexplored dart the percepts of an earlier word that
              crossed it are compared, one place deep or as deep as the doors agree

A `RuleFault` changes a rule in one way, so that it rejects a true hypothesis or confirms a false
one in a small world. This shows that the statements can fail.

Source: docs/semantics.md, sections 6, 7 and 9.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from topo_verify.proofs.bounded.cnf import REFUTED, CnfLiteral, CnfRow
from topo_verify.proofs.bounded.encoding import EncodedMap, EncodedPercept, Worlds

RuleFault = Literal[
    "", "through-unexplored", "absolute-doors", "shifted", "turned", "one-more", "first-dart"
]
"""One mistake in a rule; "" is none:

    through-unexplored  an unexplored dart is traced as if it led back to itself
    absolute-doors      doors are counted on S from the first dart of the vertex
    shifted             a percept is compared with the one behind the next door
    turned              after an excursion the robot forgets that its reference dart is turned
    one-more            the door behind the common prefix is compared too
    first-dart          records are traced again from the first dart of the vertex that was entered
"""


@dataclass(frozen=True, slots=True)
class Walk:
    """A walk of n doors: n + 1 positions, the doors, the darts left by, and n + 1 percepts."""

    at: tuple[CnfRow, ...]
    doors: tuple[CnfRow, ...]
    leave: tuple[CnfRow, ...]
    senses: tuple[EncodedPercept, ...]


@dataclass(frozen=True, slots=True)
class EdgeCrossing:
    """A world, a map of it, and the robot behind an unexplored dart.

    Attributes:
        e: the dart crossed.
        vu: the reference dart behind it.
    """

    world: Worlds
    chart: EncodedMap
    e: CnfRow
    vu: CnfRow


def behind_an_edge(edges: int, *, world_class: str = "any") -> EdgeCrossing:
    """A robot behind any unexplored dart e of any reachable map S in any world of the class."""
    world = Worlds(edges)
    world.restrict(world_class)
    chart = world.map("S")
    world.number_the_rest(chart.known)
    e, vu = crossed(world, chart, "e")
    return EdgeCrossing(world, chart, e, vu)


def crossed(world: Worlds, chart: EncodedMap, name: str) -> tuple[CnfRow, CnfRow]:
    """Any unexplored dart of a map, and the robot's reference dart after crossing it."""
    e = open_dart(world, chart, name)
    vu = world.position(name, f"{name}.behind")
    world.cross(name, e, vu)
    return e, vu


def open_dart(world: Worlds, chart: EncodedMap, name: str) -> CnfRow:
    """Any unexplored dart of a map."""
    dart = world.position(name, name)
    for d in world.darts:
        world.add(name, -dart[d], chart.known[d])
        world.add(name, -dart[d], -chart.explored[d])
    return dart


def hypothesis(scene: EdgeCrossing) -> CnfRow:
    """Any hypothesis for e: another unexplored dart of S."""
    h = open_dart(scene.world, scene.chart, "h")
    for one, other in zip(scene.e, h, strict=True):
        scene.world.add("h", -one, -other)
    return h


def true_hypothesis(scene: EdgeCrossing) -> CnfRow:
    """The true hypothesis for e: its other end, in worlds where S knows it."""
    h = hypothesis(scene)
    scene.world.equate("h", (), h, scene.vu)
    return h


# ------------------------------------------------------------------ walks


def doors(world: Worlds, name: str, steps: int) -> tuple[CnfRow, ...]:
    """Any word of doors."""
    return tuple(world.row(name, f"{name}.{i}", len(world.darts)) for i in range(steps))


def going(world: Worlds, name: str, steps: int) -> tuple[CnfLiteral, ...]:
    """Per step, is it made? This lets a word be shorter than the number of steps."""
    go = world.booleans(f"{name}.go", steps)
    for before, after in pairwise(go):
        world.add(name, -after, before)
    return go


def walk(
    world: Worlds,
    name: str,
    start: CnfRow,
    word: tuple[CnfRow, ...],
    go: tuple[CnfLiteral, ...] | None = None,
) -> Walk:
    """The walk along a word in the world, which stays in place once `go` has ended."""
    at, leave, senses = [start], list[CnfRow](), [world.sense(name, start, f"{name}.0")]
    for i, door in enumerate(word):
        # Where a step is not made, `leave` is any dart, and nothing reads it.
        guard = () if go is None else (go[i],)
        leave.append(world.position(name, f"{name}.leave.{i}"))
        at.append(world.position(name, f"{name}.at.{i + 1}"))
        world.turn(name, at[i], door, leave[i], *guard)
        world.cross(name, leave[i], at[i + 1], *guard)
        if go is not None:  # a step that is not made stays in place
            world.equate(name, (-go[i],), at[i], at[i + 1])
        senses.append(world.sense(name, at[i + 1], f"{name}.{i + 1}"))
    return Walk(tuple(at), word, tuple(leave), tuple(senses))


@dataclass(frozen=True, slots=True)
class TracedWalk:
    """A walk on a map, made until it crosses an unexplored dart.

    Attributes:
        alive: per position, has the walk crossed only explored darts so far?
        ends: per step, is it the first to cross an unexplored dart?
    """

    walk: Walk
    alive: tuple[CnfLiteral, ...]
    ends: tuple[CnfLiteral, ...]


def trace(
    world: Worlds,
    name: str,
    chart: EncodedMap,
    start: CnfRow,
    word: tuple[CnfRow, ...],
    *,
    fault: RuleFault = "",
) -> TracedWalk:
    """The walk along a word on a map, made as far as it crosses explored darts."""
    at, leave, senses = [start], list[CnfRow](), [world.sense(name, start, f"{name}.0")]
    # Dart 0 always begins a vertex: `first[0]` is the constant true of the encoding.
    alive, ends = [world.first[0]], list[CnfLiteral]()
    for i, door in enumerate(word):
        leave.append(world.position(name, f"{name}.leave.{i}"))
        at.append(world.position(name, f"{name}.at.{i + 1}"))
        world.turn(name, at[i], door, leave[i], alive[i], absolute=fault == "absolute-doors")
        known = world.at_one_of(name, leave[i], chart.explored, f"{name}.known.{i}")
        on = world.define_and(name, f"{name}.on.{i + 1}", [alive[i], known])
        ends.append(world.define_and(name, f"{name}.ends.{i}", [alive[i], -known]))
        world.cross(name, leave[i], at[i + 1], on)
        # Once the walk has ended it stays in place, so that all rows keep a definite value.
        world.equate(name, (-alive[i],), at[i], at[i + 1])
        through = fault == "through-unexplored"
        world.equate(name, (ends[i],), leave[i] if through else at[i], at[i + 1])
        alive.append(world.first[0] if through else on)
        senses.append(world.sense(name, at[i + 1], f"{name}.{i + 1}"))
    return TracedWalk(Walk(tuple(at), word, tuple(leave), tuple(senses)), tuple(alive), tuple(ends))


def stay_explored(
    world: Worlds, chart: EncodedMap, walked: Walk, go: tuple[CnfLiteral, ...]
) -> None:
    """Require that every step made crosses an explored dart of the map."""
    for leave, on in zip(walked.leave, go, strict=True):
        for d in world.darts:
            world.add("explored-way", -on, -leave[d], chart.explored[d])


def differ_somewhere(
    world: Worlds, pairs: Sequence[tuple[EncodedPercept, EncodedPercept, tuple[CnfLiteral, ...]]]
) -> None:
    """Negate the conclusion: somewhere all guards hold and the two percepts differ.

    The premises alone must let a guarded place be reached: otherwise nothing would be compared.
    """
    reached: list[CnfLiteral] = []
    seen: list[CnfLiteral] = []
    # Without guards a place is always reached, and `met` has nothing to require for it.
    for i, (one, other, guards) in enumerate(pairs):
        same = world.alike("percepts", one, other, f"compare.{i}")
        if guards:
            reached.append(world.define_and("percepts", f"reached.{i}", guards))
        seen.append(world.define_and("percepts", f"differ.{i}", [-same, *guards]))
    world.add(REFUTED, *seen)
    world.met.append(tuple(reached))
