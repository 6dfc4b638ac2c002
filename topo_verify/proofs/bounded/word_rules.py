"""The rules on whole words: every word of up to `steps` doors, on every map of every world.

Each function returns clauses that describe a failure of a rule: it confirms a false hypothesis, or
rejects the true one. The statement is that nothing satisfies them. `walks.py` explains the letters
and the rules. `door_steps.py` treats one door at a time, and words of any length by induction; here
no induction is needed, for words that are short.

With a `fault` the rule is changed in one way, and there is a world in which it fails. The rows that
say what happens there are in the `EncodedCounterexample`, for `decode.py` and `replay.py`.
"""

from __future__ import annotations

from dataclasses import dataclass

from topo_verify.proofs.bounded.cnf import REFUTED, CnfLiteral, CnfRow
from topo_verify.proofs.bounded.encoding import EncodedMap, MarkerDetail, Worlds
from topo_verify.proofs.bounded.walks import (
    RuleFault,
    TracedWalk,
    behind_an_edge,
    crossed,
    differ_somewhere,
    doors,
    going,
    hypothesis,
    open_dart,
    stay_explored,
    trace,
    true_hypothesis,
    walk,
)


@dataclass(frozen=True, slots=True)
class EncodedExcursion:
    """An earlier excursion: the map before it, the dart crossed, the word executed behind it."""

    chart: EncodedMap
    e: CnfRow
    executed: tuple[CnfRow, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class EncodedCounterexample:
    """A formula, and the rows that say what happens in a world that satisfies it.

    Attributes:
        chart: the map S.
        e, h: the dart crossed, and the hypothesis for its other end.
        executed: the doors that the robot takes behind e.
        made: per door, is it taken? None: all are.
        own: for `prefix`, the doors of the hypothesis' own way home.
        turned: for the fault of that name, the door of an earlier excursion.
        earlier, levels: for `records`, the recorded excursion, and the depth compared.
    """

    world: Worlds
    chart: EncodedMap
    e: CnfRow
    h: CnfRow
    executed: tuple[CnfRow, ...]
    made: tuple[CnfLiteral, ...] | None = None
    own: tuple[CnfRow, ...] = ()
    turned: CnfRow | None = None
    earlier: EncodedExcursion | None = None
    levels: int | None = None


def confirm(edges: int, steps: int, *, marker: MarkerDetail = "directed") -> EncodedCounterexample:
    """A way home from h ends with v0's percept as expected, and h is not the other end of e.

    Only the last percept is compared: comparing those between could only reject more.
    """
    scene = behind_an_edge(edges)
    world, h = scene.world, hypothesis(scene)
    word, go = doors(world, "door", steps), going(world, "way", steps)
    here = walk(world, "here", h, word, go)
    there = walk(world, "there", scene.vu, word, go)
    stay_explored(world, scene.chart, here, go)
    for d in world.darts:
        world.add("home", -here.at[-1][d], world.in_v0[d])
    world.add(
        "matching", world.alike("percepts", here.senses[-1], there.senses[-1], "last", marker)
    )
    for one, other in zip(h, scene.vu, strict=True):
        world.add(REFUTED, -one, -other)
    return EncodedCounterexample(
        world=world, chart=scene.chart, e=scene.e, h=h, executed=word, made=go
    )


def trace_way(edges: int, steps: int, *, fault: RuleFault = "") -> EncodedCounterexample:
    """On a way over explored darts from the true h, a percept differs from the expected one."""
    scene = behind_an_edge(edges)
    world, h = scene.world, true_hypothesis(scene)
    word, go = doors(world, "door", steps), going(world, "way", steps)
    here = walk(world, "here", h, word, go)
    stay_explored(world, scene.chart, here, go)
    start, turned = scene.vu, None
    if fault == "turned":  # the robot is turned by any door, and takes the doors as if it were not
        start, turned = world.position("turned", "start"), world.row("turned", "turn", 2 * edges)
        world.turn("turned", scene.vu, turned, start)
    there = walk(world, "there", start, word, go)
    later = int(fault == "shifted")
    pairs = [(here.senses[i - later], there.senses[i], (go[i - 1],)) for i in range(1, steps + 1)]
    at_vu = [] if fault else [(here.senses[0], there.senses[0], ())]
    differ_somewhere(world, [*at_vu, *pairs])
    return EncodedCounterexample(
        world=world, chart=scene.chart, e=scene.e, h=h, executed=word, made=go, turned=turned
    )


def prefix(edges: int, steps: int, *, fault: RuleFault = "") -> EncodedCounterexample:
    """On the common prefix of any executed word and the way of the true h, percepts differ."""
    scene = behind_an_edge(edges)
    world, h = scene.world, true_hypothesis(scene)
    own, go = doors(world, "own", steps), going(world, "way", steps)
    executed = doors(world, "door", steps)
    here = walk(world, "here", h, own, go)
    stay_explored(world, scene.chart, here, go)
    there = walk(world, "there", scene.vu, executed)
    # shared[i]: the first i doors agree, and the own way has that many. first[0] is always true.
    shared = [world.first[0]]
    for i in range(steps):
        same = world.define_equal("prefix", f"same.{i}", own[i], executed[i])
        shared.append(world.define_and("prefix", f"shared.{i}", [shared[i], go[i], same]))
    pairs = [
        (here.senses[i], there.senses[i], (shared[i - 1], go[i - 1]) if fault else (shared[i],))
        for i in range(1, steps + 1)
    ]
    differ_somewhere(world, pairs)
    return EncodedCounterexample(
        world=world, chart=scene.chart, e=scene.e, h=h, executed=executed, made=go, own=own
    )


def history(edges: int, steps: int, *, fault: RuleFault = "") -> EncodedCounterexample:
    """Any executed word, traced on S from the true h, shows a percept that differs."""
    scene = behind_an_edge(edges)
    world, h = scene.world, true_hypothesis(scene)
    word = doors(world, "door", steps)
    there = walk(world, "there", scene.vu, word)
    here = trace(world, "here", scene.chart, h, word, fault=fault)
    later = int(fault == "shifted")
    pairs = [
        (here.walk.senses[i], there.senses[i + later], (here.alive[i],))
        for i in range(1, steps + 1 - later)
    ]
    differ_somewhere(world, pairs)
    return EncodedCounterexample(world=world, chart=scene.chart, e=scene.e, h=h, executed=word)


def records(
    edges: int, steps: int, *, levels: int | None, fault: RuleFault = ""
) -> EncodedCounterexample:
    """A word traced from the true h crosses a recorded dart, and a percept differs from the record.

    The map `before` has the unexplored dart `e1`; behind it the word `wrote` is executed, e1 turns
    out to end in `entry`, which gives the map `earlier`, and the word is traced on it again. S is
    any later map on which the dart where that ended is still unexplored.

    Args:
        levels: 1: only the place directly behind the dart; None: as deep as the doors agree.
    """
    world = Worlds(edges)
    before, earlier, later = (world.map(name) for name in ("before", "earlier", "S"))
    world.include("grows", before, earlier)
    world.include("grows", earlier, later)
    world.number_the_rest(later.known)
    written, read = doors(world, "wrote", steps), doors(world, "door", steps)
    e1, entry = crossed(world, before, "e1")
    # `earlier` is `before` with the one edge e1-entry explored as well, and no other.
    for d in world.darts:
        for dart in (before.explored[d], e1[d], entry[d]):
            world.imply("augment", [dart], earlier.explored[d])
        world.imply("augment", [earlier.explored[d]], before.explored[d], e1[d], entry[d])
    # `past` is where the robot was, `traced` where the rule believes it was: a fault parts them.
    past = walk(world, "past", entry, written)
    traced = trace(world, "retraced", earlier, _root(world, entry, fault), written)
    e, vu = crossed(world, later, "e")
    h = open_dart(world, later, "h")
    world.equate("h", (), h, vu)
    there = walk(world, "there", vu, read)
    here = trace(world, "here", later, h, read)
    link = _links(world, traced, here, later, levels)
    pairs = [
        (past.senses[j + 1], there.senses[i + 1], (linked,)) for (j, i), linked in link.items()
    ]
    differ_somewhere(world, pairs)
    earlier_word = EncodedExcursion(before, e1, written)
    return EncodedCounterexample(
        world=world, chart=later, e=e, h=h, executed=read, earlier=earlier_word, levels=levels
    )


def _root(world: Worlds, entry: CnfRow, fault: RuleFault) -> CnfRow:
    """The dart from which the earlier word is traced: the entry dart, or (a fault) the first."""
    if fault != "first-dart":
        return entry
    first = world.position("first-dart", "root")
    for (f, degree), vertex in world.vertex.items():
        for x in range(f, f + degree):
            world.imply("first-dart", [vertex, entry[x]], first[f])
    return first


def _links(
    world: Worlds, past: TracedWalk, now: TracedWalk, later: EncodedMap, levels: int | None
) -> dict[tuple[int, int], CnfLiteral]:
    """link[j, i]: the percept recorded behind door j is compared with the one behind door i."""
    link: dict[tuple[int, int], CnfLiteral] = {}
    for j, ended in enumerate(past.ends):
        explored = world.at_one_of("records", past.walk.leave[j], later.explored, f"dropped.{j}")
        for i, ends in enumerate(now.ends):
            tag = f"{j}.{i}"
            one, other = past.walk.leave[j], now.walk.leave[i]
            same = world.define_equal("records", f"crossed.{tag}", one, other)
            # Both walks end by crossing the same dart, which S has not explored: a record begins.
            begins = [ended, ends, same, -explored]
            linked = world.define_and("records", f"begins.{tag}", begins)
            # Behind linked doors, equal doors are linked as well: the record goes one place deeper.
            if levels is None and j and i:
                words = past.walk.doors[j], now.walk.doors[i]
                further = world.define_equal("records", f"door.same.{tag}", *words)
                deeper = [link[j - 1, i - 1], further]
                deep = world.define_and("records", f"deeper.{tag}", deeper)
                linked = world.define_or("records", f"linked.{tag}", [linked, deep])
            link[j, i] = linked
    return link
