"""One arbitrary door, at any place of any map: the steps of which words are made.

Each function returns clauses that describe a failure at one door. The statement is that no world
and no map satisfies them. By induction (docs/proofs.md) the statements hold for words of any length
in every world with m edges.

    p, r      what corresponds: a dart of S, and a reference dart of the robot in the world
    p', r'    the same behind the same door

Source: docs/semantics.md, sections 4, 6, 7 and 9.
"""

from __future__ import annotations

from topo_verify.proofs.bounded.cnf import REFUTED, CnfRow
from topo_verify.proofs.bounded.encoding import EncodedMap, MarkerDetail, Worlds
from topo_verify.proofs.bounded.walks import behind_an_edge, doors, open_dart, walk


def pose(edges: int) -> Worlds:
    """S knows the other end of e, which is explored or e itself: so it is no hypothesis."""
    scene = behind_an_edge(edges)
    world, known = scene.world, scene.chart.known
    for d in world.darts:
        world.add("end-known", -scene.vu[d], known[d])
    explored = world.at_one_of("pose", scene.vu, scene.chart.explored, "vu.explored")
    world.add(REFUTED, explored, world.define_equal("pose", "vu.is.e", scene.vu, scene.e))
    return world


def door(edges: int) -> Worlds:
    """Behind one explored door of corresponding darts, darts or percepts do not correspond."""
    world, chart = _map(edges)
    p = _known(world, chart, "p")
    r = world.position("r", "r")
    # S is a part of the world with the same numbers, so what corresponds is equal.
    world.equate("corresponding", (), p, r)
    word = doors(world, "door", 1)
    here, there = walk(world, "here", p, word), walk(world, "there", r, word)
    _explored(world, chart, here.leave[0])
    same = world.define_equal("compare", "same", here.at[1], there.at[1])
    alike = world.alike("compare", here.senses[1], there.senses[1], "seen")
    world.add(REFUTED, -same, -alike)
    return world


def confirm_back(edges: int) -> Worlds:
    """Two darts correspond behind one explored door, and did not before it."""
    world, chart = _map(edges)
    p, r = _known(world, chart, "p"), world.position("r", "r")
    word = doors(world, "door", 1)
    here, there = walk(world, "here", p, word), walk(world, "there", r, word)
    _explored(world, chart, here.leave[0])
    world.equate("corresponding", (), here.at[1], there.at[1])
    world.add(REFUTED, -world.define_equal("compare", "same", p, r))
    return world


def confirm_final(edges: int, *, marker: MarkerDetail = "directed") -> Worlds:
    """Two darts at v0 have equal percepts, marker direction included, and are different.

    Args:
        marker: "undirected" looks at its presence only (a seeded fault).
    """
    world, chart = _map(edges)
    p, r = _known(world, chart, "p"), world.position("r", "r")
    for d in world.darts:
        world.add("home", -p[d], world.in_v0[d])
    here, there = world.sense("here", p, "here"), world.sense("there", r, "there")
    world.add("seen", world.alike("compare", here, there, "seen", marker))
    world.add(REFUTED, -world.define_equal("compare", "same", p, r))
    return world


def record(edges: int) -> Worlds:
    """One unexplored dart is crossed from two places, at two times; the percepts differ."""
    world = Worlds(edges)
    earlier, later = world.map("earlier"), world.map("later")
    world.include("grows", earlier, later)
    # The earlier map is a prefix of the later one, so one numbering serves both.
    world.number_the_rest(later.known)
    q, p = _known(world, earlier, "q"), _known(world, later, "p")
    wrote = walk(world, "wrote", q, doors(world, "wrote.door", 1))
    reads = walk(world, "reads", p, doors(world, "reads.door", 1))
    d = open_dart(world, later, "d")
    world.equate("crossed", (), wrote.leave[0], d)
    world.equate("crossed", (), reads.leave[0], d)
    world.add(REFUTED, -world.alike("compare", wrote.senses[1], reads.senses[1], "seen"))
    return world


def new_vertex(edges: int) -> Worlds:
    """S does not know the other end of e, and knows another dart of its vertex."""
    scene = behind_an_edge(edges)
    world, known = scene.world, scene.chart.known
    for d in world.darts:
        world.add("end-unknown", -scene.vu[d], -known[d])
    turned = world.position("turn", "turned")
    world.turn("turn", scene.vu, doors(world, "door", 1)[0], turned)
    world.add(REFUTED, world.at_one_of("turn", turned, known, "turned.known"))
    return world


def closed(edges: int) -> Worlds:
    """Every dart that S knows is explored, and S does not know every dart."""
    world, chart = _map(edges)
    for known, explored in zip(chart.known, chart.explored, strict=True):
        world.imply("nothing-open", [known], explored)
    world.add(REFUTED, *(-known for known in chart.known))
    return world


def _map(edges: int) -> tuple[Worlds, EncodedMap]:
    world = Worlds(edges)
    chart = world.map("S")
    world.number_the_rest(chart.known)
    return world, chart


def _known(world: Worlds, chart: EncodedMap, name: str) -> CnfRow:
    dart = world.position(name, name)
    for d in world.darts:
        world.add(name, -dart[d], chart.known[d])
    return dart


def _explored(world: Worlds, chart: EncodedMap, leave: CnfRow) -> None:
    for d in world.darts:
        world.add("explored-door", -leave[d], chart.explored[d])
