"""The statements of the bounded theorems, in words, in symbols, and as clauses of a failure.

    S, U        a reachable map; its unexplored darts               W     the world
    p, r        corresponding: a dart of S, a reference dart        p',r' behind the same door
    e, h        the dart that is crossed; a hypothesis for its other end

Statements about one arbitrary door cover words of any length by induction (docs/proofs.md); those
about whole words of up to `steps` doors need none.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from topo_verify.proofs.bounded import encoding as enc
from topo_verify.proofs.bounded.cnf import REFUTED, CnfLiteral, CnfRow, Formula


def pose(edges: int) -> enc.Worlds:
    """S knows the other end of e, which is explored or e itself: not a hypothesis."""
    scene = enc.behind_an_edge(edges)
    world, known = scene.world, scene.chart.known
    for d in world.darts:
        world.add("end-known", -scene.vu[d], known[d])
    explored = world.at_one_of("pose", scene.vu, scene.chart.explored, "vu.explored")
    world.add(REFUTED, explored, world.define_equal("pose", "vu.is.e", scene.vu, scene.e))
    return world


def door(edges: int) -> enc.Worlds:
    """Behind an explored door of corresponding darts, darts or percepts do not correspond."""
    world, chart = _map(edges)
    p = _known(world, chart, "p")
    r = world.position("r", "r")
    # S and the world share numbers: corresponding darts are equal.
    world.equate("corresponding", (), p, r)
    word = enc.doors(world, "door", 1)
    here, there = enc.walk(world, "here", p, word), enc.walk(world, "there", r, word)
    _explored(world, chart, here.leave[0])
    same = world.define_equal("compare", "same", here.at[1], there.at[1])
    alike = world.alike("compare", here.senses[1], there.senses[1], "seen")
    world.add(REFUTED, -same, -alike)
    return world


def confirm_back(edges: int) -> enc.Worlds:
    """Two darts correspond behind one explored door, but not before it."""
    world, chart = _map(edges)
    p, r = _known(world, chart, "p"), world.position("r", "r")
    word = enc.doors(world, "door", 1)
    here, there = enc.walk(world, "here", p, word), enc.walk(world, "there", r, word)
    _explored(world, chart, here.leave[0])
    world.equate("corresponding", (), here.at[1], there.at[1])
    world.add(REFUTED, -world.define_equal("compare", "same", p, r))
    return world


def confirm_final(edges: int, *, marker: enc.MarkerDetail = "directed") -> enc.Worlds:
    """Two different darts at v0 have equal percepts; marker "undirected" is a seeded fault."""
    world, chart = _map(edges)
    p, r = _known(world, chart, "p"), world.position("r", "r")
    for d in world.darts:
        world.add("home", -p[d], world.in_v0[d])
    here, there = world.sense("here", p, "here"), world.sense("there", r, "there")
    world.add("seen", world.alike("compare", here, there, "seen", marker))
    world.add(REFUTED, -world.define_equal("compare", "same", p, r))
    return world


def record(edges: int) -> enc.Worlds:
    """One unexplored dart is crossed at two times; the percepts differ."""
    world = enc.Worlds(edges)
    earlier, later = world.map("earlier"), world.map("later")
    world.include("grows", earlier, later)
    world.number_the_rest(later.known)
    q, p = _known(world, earlier, "q"), _known(world, later, "p")
    wrote = enc.walk(world, "wrote", q, enc.doors(world, "wrote.door", 1))
    reads = enc.walk(world, "reads", p, enc.doors(world, "reads.door", 1))
    d = enc.open_dart(world, later, "d")
    world.equate("crossed", (), wrote.leave[0], d)
    world.equate("crossed", (), reads.leave[0], d)
    world.add(REFUTED, -world.alike("compare", wrote.senses[1], reads.senses[1], "seen"))
    return world


def new_vertex(edges: int) -> enc.Worlds:
    """S does not know the other end of e, but another dart of its vertex."""
    scene = enc.behind_an_edge(edges)
    world, known = scene.world, scene.chart.known
    for d in world.darts:
        world.add("end-unknown", -scene.vu[d], -known[d])
    turned = world.position("turn", "turned")
    world.turn("turn", scene.vu, enc.doors(world, "door", 1)[0], turned)
    world.add(REFUTED, world.at_one_of("turn", turned, known, "turned.known"))
    return world


def closed(edges: int) -> enc.Worlds:
    """All darts of S are explored, but S does not know every dart."""
    world, chart = _map(edges)
    for known, explored in zip(chart.known, chart.explored, strict=True):
        world.imply("nothing-open", [known], explored)
    world.add(REFUTED, *(-known for known in chart.known))
    return world


def _map(edges: int) -> tuple[enc.Worlds, enc.EncodedMap]:
    world = enc.Worlds(edges)
    chart = world.map("S")
    world.number_the_rest(chart.known)
    return world, chart


def _known(world: enc.Worlds, chart: enc.EncodedMap, name: str) -> CnfRow:
    dart = world.position(name, name)
    for d in world.darts:
        world.add(name, -dart[d], chart.known[d])
    return dart


def _explored(world: enc.Worlds, chart: enc.EncodedMap, leave: CnfRow) -> None:
    for d in world.darts:
        world.add("explored-door", -leave[d], chart.explored[d])


@dataclass(frozen=True, slots=True)
class EncodedExcursion:
    """The map before an earlier excursion, the dart crossed, the word behind it."""

    chart: enc.EncodedMap
    e: CnfRow
    executed: tuple[CnfRow, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class EncodedCounterexample:
    """A formula, and the rows that describe a `BoundedCounterexample`.

    Attributes:
        executed: the doors taken behind e.
        made: per door, is it taken? None: all are.
    """

    world: enc.Worlds
    chart: enc.EncodedMap
    e: CnfRow
    h: CnfRow
    executed: tuple[CnfRow, ...]
    made: tuple[CnfLiteral, ...] | None = None
    own: tuple[CnfRow, ...] = ()
    turned: CnfRow | None = None
    earlier: EncodedExcursion | None = None
    levels: int | None = None


def confirm(
    edges: int, steps: int, *, marker: enc.MarkerDetail = "directed"
) -> EncodedCounterexample:
    """A way home from a false h ends with v0's percept as expected.

    Percepts on the way could only reject more.
    """
    scene = enc.behind_an_edge(edges)
    world, h = scene.world, enc.hypothesis(scene)
    word, go = enc.doors(world, "door", steps), enc.going(world, "way", steps)
    here = enc.walk(world, "here", h, word, go)
    there = enc.walk(world, "there", scene.vu, word, go)
    enc.stay_explored(world, scene.chart, here, go)
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


def trace_way(edges: int, steps: int, *, fault: enc.RuleFault = "") -> EncodedCounterexample:
    """On a way from the true h over explored darts, a percept is unexpected."""
    scene = enc.behind_an_edge(edges)
    world, h = scene.world, enc.true_hypothesis(scene)
    word, go = enc.doors(world, "door", steps), enc.going(world, "way", steps)
    here = enc.walk(world, "here", h, word, go)
    enc.stay_explored(world, scene.chart, here, go)
    start, turned = scene.vu, None
    if fault == "turned":  # the robot takes the doors as if it were not turned
        start, turned = world.position("turned", "start"), world.row("turned", "turn", 2 * edges)
        world.turn("turned", scene.vu, turned, start)
    there = enc.walk(world, "there", start, word, go)
    later = int(fault == "shifted")
    pairs = [(here.senses[i - later], there.senses[i], (go[i - 1],)) for i in range(1, steps + 1)]
    at_vu = [] if fault else [(here.senses[0], there.senses[0], ())]
    enc.differ_somewhere(world, [*at_vu, *pairs])
    return EncodedCounterexample(
        world=world, chart=scene.chart, e=scene.e, h=h, executed=word, made=go, turned=turned
    )


def prefix(edges: int, steps: int, *, fault: enc.RuleFault = "") -> EncodedCounterexample:
    """On the common prefix of an executed word and the way of the true h, percepts differ."""
    scene = enc.behind_an_edge(edges)
    world, h = scene.world, enc.true_hypothesis(scene)
    own, go = enc.doors(world, "own", steps), enc.going(world, "way", steps)
    executed = enc.doors(world, "door", steps)
    here = enc.walk(world, "here", h, own, go)
    enc.stay_explored(world, scene.chart, here, go)
    there = enc.walk(world, "there", scene.vu, executed)
    # shared[i]: the first i doors agree, and the own way has them.
    shared = [world.first[0]]
    for i in range(steps):
        same = world.define_equal("prefix", f"same.{i}", own[i], executed[i])
        shared.append(world.define_and("prefix", f"shared.{i}", [shared[i], go[i], same]))
    pairs = [
        (here.senses[i], there.senses[i], (shared[i - 1], go[i - 1]) if fault else (shared[i],))
        for i in range(1, steps + 1)
    ]
    enc.differ_somewhere(world, pairs)
    return EncodedCounterexample(
        world=world, chart=scene.chart, e=scene.e, h=h, executed=executed, made=go, own=own
    )


def history(edges: int, steps: int, *, fault: enc.RuleFault = "") -> EncodedCounterexample:
    """An executed word, traced on S from the true h, shows a percept that differs."""
    scene = enc.behind_an_edge(edges)
    world, h = scene.world, enc.true_hypothesis(scene)
    word = enc.doors(world, "door", steps)
    there = enc.walk(world, "there", scene.vu, word)
    here = enc.trace(world, "here", scene.chart, h, word, fault=fault)
    later = int(fault == "shifted")
    pairs = [
        (here.walk.senses[i], there.senses[i + later], (here.alive[i],))
        for i in range(1, steps + 1 - later)
    ]
    enc.differ_somewhere(world, pairs)
    return EncodedCounterexample(world=world, chart=scene.chart, e=scene.e, h=h, executed=word)


def records(
    edges: int, steps: int, *, levels: int | None, fault: enc.RuleFault = ""
) -> EncodedCounterexample:
    """A word traced from the true h crosses a recorded dart, and a percept differs from the record.

    In map `before`, e1 is crossed and `wrote` executed. On `earlier`, which is `before` with the
    edge from e1 to `entry`, the word is traced again. In S, a later map, the dart where that ended
    is unexplored.

    Args:
        levels: 1: only the place behind the dart; None: as deep as the doors agree.
    """
    world = enc.Worlds(edges)
    before, earlier, later = (world.map(name) for name in ("before", "earlier", "S"))
    world.include("grows", before, earlier)
    world.include("grows", earlier, later)
    world.number_the_rest(later.known)
    written, read = enc.doors(world, "wrote", steps), enc.doors(world, "door", steps)
    e1, entry = enc.crossed(world, before, "e1")
    for d in world.darts:
        for dart in (before.explored[d], e1[d], entry[d]):
            world.imply("augment", [dart], earlier.explored[d])
        world.imply("augment", [earlier.explored[d]], before.explored[d], e1[d], entry[d])
    # The robot was at `past`; the rule believes `traced`.
    past = enc.walk(world, "past", entry, written)
    traced = enc.trace(world, "retraced", earlier, _root(world, entry, fault), written)
    e, vu = enc.crossed(world, later, "e")
    h = enc.open_dart(world, later, "h")
    world.equate("h", (), h, vu)
    there = enc.walk(world, "there", vu, read)
    here = enc.trace(world, "here", later, h, read)
    link = _links(world, traced, here, later, levels)
    pairs = [
        (past.senses[j + 1], there.senses[i + 1], (linked,)) for (j, i), linked in link.items()
    ]
    enc.differ_somewhere(world, pairs)
    earlier_word = EncodedExcursion(before, e1, written)
    return EncodedCounterexample(
        world=world, chart=later, e=e, h=h, executed=read, earlier=earlier_word, levels=levels
    )


def _root(world: enc.Worlds, entry: CnfRow, fault: enc.RuleFault) -> CnfRow:
    if fault != "first-dart":
        return entry
    first = world.position("first-dart", "root")
    for (f, degree), vertex in world.vertex.items():
        for x in range(f, f + degree):
            world.imply("first-dart", [vertex, entry[x]], first[f])
    return first


def _links(
    world: enc.Worlds,
    past: enc.TracedWalk,
    now: enc.TracedWalk,
    later: enc.EncodedMap,
    levels: int | None,
) -> dict[tuple[int, int], CnfLiteral]:
    """link[j, i]: the percept recorded behind door j is compared with that behind door i."""
    link: dict[tuple[int, int], CnfLiteral] = {}
    for j, ended in enumerate(past.ends):
        explored = world.at_one_of("records", past.walk.leave[j], later.explored, f"dropped.{j}")
        for i, ends in enumerate(now.ends):
            tag = f"{j}.{i}"
            one, other = past.walk.leave[j], now.walk.leave[i]
            same = world.define_equal("records", f"crossed.{tag}", one, other)
            # Both walks end by crossing the same unexplored dart: a record begins.
            begins = [ended, ends, same, -explored]
            linked = world.define_and("records", f"begins.{tag}", begins)
            # Behind linked doors, equal doors are linked: one place deeper.
            if levels is None and j and i:
                words = past.walk.doors[j], now.walk.doors[i]
                further = world.define_equal("records", f"door.same.{tag}", *words)
                deeper = [link[j - 1, i - 1], further]
                deep = world.define_and("records", f"deeper.{tag}", deeper)
                linked = world.define_or("records", f"linked.{tag}", [linked, deep])
            link[j, i] = linked
    return link


@dataclass(frozen=True, slots=True, kw_only=True)
class BoundedStatement:
    """A theorem about worlds of bounded size.

    Attributes:
        refuted: for a number of edges, the clauses of a counterexample.
        premises: clauses that must be satisfiable; None: `refuted` without the negated conclusion.
        least: the fewest edges with which it is not vacuous.
    """

    name: str
    claims: tuple[str, ...]
    words: str
    symbols: str
    refuted: Callable[[int], enc.Worlds]
    premises: Callable[[int], Formula] | None = None
    least: int = 1
    world_class: str = "any"
    argued: tuple[str, ...] = ()


_BY_DOORS = ("doors",)

ONE_DOOR_STATEMENTS = (
    BoundedStatement(
        name="bounded-pose",
        claims=("true-hypothesis-posed",),
        words="If e leads to a known vertex, its other end is unexplored and not e: a hypothesis.",
        symbols="alpha(e) ∈ S ⇒ alpha(e) ∈ U \\ {e}",
        refuted=pose,
    ),
    BoundedStatement(
        name="bounded-door",
        claims=("true-hypothesis-kept", "map-isomorphic"),
        words="Through an explored door of S and the same door of the world, corresponding darts"
        " lead to corresponding darts, which show the same percept.",
        symbols="p = r, x = sigma^k(p) explored ⇒ p' = r' ∧ percept(p') = percept(r')",
        refuted=door,
        argued=_BY_DOORS,
    ),
    BoundedStatement(
        name="bounded-confirm-final",
        claims=("no-false-confirm",),
        words="Two places that show v0's percept with the same marker direction are one dart.",
        symbols="p ∈ v0 ∧ percept(p) = percept(r) ⇒ p = r",
        refuted=confirm_final,
    ),
    BoundedStatement(
        name="bounded-confirm-back",
        claims=("no-false-confirm",),
        words="Where a door of S and the same door of the world lead to one dart, they leave from"
        " one dart.",
        symbols="x = sigma^k(p) explored ∧ p' = r' ⇒ p = r",
        refuted=confirm_back,
        argued=_BY_DOORS,
    ),
    BoundedStatement(
        name="bounded-record",
        claims=("true-hypothesis-kept",),
        words="The percept recorded behind an unexplored dart is seen there on any later map, too.",
        symbols="S ⊆ S', sigma^k(q) = sigma^l(p) = d ∈ U' ⇒ percept(q') = percept(p')",
        refuted=record,
    ),
    BoundedStatement(
        name="bounded-new-vertex",
        claims=("map-isomorphic",),
        words="If e leads to no known dart, S knows no dart of the vertex behind it.",
        symbols="alpha(e) ∉ S ⇒ sigma^k(alpha(e)) ∉ S",
        refuted=new_vertex,
    ),
    BoundedStatement(
        name="bounded-closed",
        claims=("map-isomorphic",),
        words="A map with no unexplored dart is the whole world.",
        symbols="U = ∅ ⇒ S = W",
        refuted=closed,
    ),
)


def _word(build: Callable[[int, int], EncodedCounterexample], edges: int) -> enc.Worlds:
    # A way home is simple, so it has at most n - 1 <= m doors.
    return build(edges, edges).world


# With one edge, e, S has explored nothing to compare.
_words_kept = partial(BoundedStatement, claims=("true-hypothesis-kept",), least=2)

WHOLE_WORD_STATEMENTS = (
    BoundedStatement(
        name="words-confirm",
        claims=("no-false-confirm",),
        words="A way home from h whose last percept is v0's as expected proves that e ends in h.",
        symbols="w ≤ m doors from h to v0 on S, percepts equal at its end ⇒ h = alpha(e)",
        refuted=partial(_word, confirm),
    ),
    _words_kept(
        name="words-trace",
        words="On every way over explored edges the true hypothesis meets the percepts it expects.",
        symbols="h = alpha(e), w ≤ m doors on S ⇒ all percepts equal",
        refuted=partial(_word, trace_way),
    ),
    _words_kept(
        name="words-prefix",
        words="Rule prefix keeps the true hypothesis, whatever word was executed.",
        symbols="h = alpha(e), own way and executed word of ≤ m doors ⇒ equal on the common prefix",
        refuted=partial(_word, prefix),
    ),
    _words_kept(
        name="words-history",
        words="Rule history keeps the true hypothesis, whatever word was executed.",
        symbols="h = alpha(e), any word of m doors ⇒ equal until it crosses an unexplored dart",
        refuted=partial(_word, history),
    ),
    _words_kept(
        name="words-records-one",
        words="Rule records(1) keeps the true hypothesis, whatever was recorded on an earlier map.",
        symbols="as words-history, and T[d] equals the percept behind d",
        refuted=partial(_word, partial(records, levels=1)),
    ),
    _words_kept(
        name="words-records-all",
        words="Rule records(∞) keeps the true hypothesis, whatever was recorded on an earlier map.",
        symbols="as words-history, and T[d] equals the percepts behind d as deep as doors agree",
        refuted=partial(_word, partial(records, levels=None)),
    ),
)
