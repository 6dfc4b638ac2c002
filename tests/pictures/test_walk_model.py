"""The reader's walk, without a browser: where it is on S and what followed, as checkers say."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, dist, tau
from typing import Any

import msgspec
import pytest

from tests.helpers import worlds
from tests.pictures.node import answers, script
from topo_verify import World, explore, families
from topo_verify.checkers import decision_conclusions
from topo_verify.checkers.entailment import FoldedTrace
from topo_verify.faults import FAULTS
from topo_verify.pictures.scenes import Playback
from topo_verify.programs.loader import Mapper
from topo_verify.robot.events import Augment
from topo_verify.robot.simulator import first_percept

MODEL = script("fold.js", "walk_world.js", "walk_model.js")

WALK = """
function answer({ world, trace }) {
  const walk = new Walk(new WalkWorld(world)), at = [];
  for (const event of trace) {
    if (event.type === "move") walk.move(event.door);
    else if (event.type === "augment") {
      const known = event.kind === "new" ? walk.mayBeNew() : walk.hypotheses().includes(event.dart);
      if (!known || walk.pending.edge !== event.edge) break; // S is wrong since long
      walk.declare(event.kind === "new" ? null : event.dart);
    }
    at.push(walk.here);
    if (walk.contradiction) break;
  }
  const { found, proved } = walk.judged();
  return { at, fates: found.map(({ fate }) => fate), proved, complete: walk.complete };
}
"""

MEASURE = """
function answer(world) {
  const measured = new WalkWorld(world);
  return [measured.leastCost(), measured.genus(), measured.seen(measured.marker)];
}
"""

ENDS = """
function answer(world) {
  const sketch = sketchOf(world), ends = [];
  for (const [dart, other] of sketch.alpha) {
    const [, x, y] = /^M(\\S+) ([^C]+)/.exec(sketch.road(dart));
    const [, u, v] = /(\\S+) (\\S+)$/.exec(sketch.road(other));
    ends.push([dart, +x, +y, +u, +v]);
  }
  return { spots: sketch.spots, ends };
}
"""

DRAWN = "function answer([seed, edges]) { return randomWorld(seed, edges); }"

BUILT = """
function answer(steps) {
  let book = new Sketchbook();
  for (const [from, to] of steps) {
    const corners = book.corners();
    book = book.withEdge(corners[from], to === null ? null : corners[to]);
  }
  return book.world;
}
"""


def data(world: World) -> dict[str, Any]:
    return {"vertices": world.vertices, "edges": world.edges, "marker": world.root}


def walked(cases: Sequence[tuple[World, Mapper | str]]) -> list[tuple[Playback, Any]]:
    """The runs, and the same doors and declarations as a reader's walk."""
    runs = [Playback(world, explore(world, mapper).trace) for world, mapper in cases]
    asked = [{"world": data(run.world), "trace": run.trace} for run in runs]
    return list(zip(runs, answers(MODEL + WALK, asked), strict=True))


def fates(run: Playback) -> list[str]:
    """What the checkers say of each augmentation, up to the first that is wrong."""
    why = {found.when: found.why for found in decision_conclusions(FoldedTrace(run.trace))}
    told: list[str] = []
    for when, event in enumerate(run.trace):
        if isinstance(event, Augment):
            wrong = when == run.replayed.spoiled
            told.append("wrong" if wrong else "luck" if why.get(when, "unknown") else "followed")
            if wrong:
                break
    return told


SMALL = [*worlds([1, 2, 3]), families.lattice(3, 3), families.torus(3, 3)]


def test_a_walk_is_where_the_robot_is_and_all_of_it_followed() -> None:
    for run, shown in walked([(world, "enhancement-ii") for world in SMALL]):
        places = zip(shown["at"], run.moments, strict=True)
        assert all(here in (None, moment.known) for here, moment in places), run.world
        after = [shown["at"][n] for n, event in enumerate(run.trace) if isinstance(event, Augment)]
        assert None not in after
        assert set(shown["fates"]) == {"followed"}
        assert (shown["proved"], shown["complete"]) == (True, True)


@pytest.mark.parametrize("fault", ["concludes-by-elimination", "confirms-what-is-alone"])
def test_luck_is_told_from_what_followed_and_a_wrong_declaration_is_found(fault: str) -> None:
    seen = set[str]()
    for run, shown in walked([(world, FAULTS[fault]) for world in SMALL]):
        told = fates(run)
        # The checkers stop at the first luck: what they say holds up to there.
        upto = told.index("luck") + 1 if "luck" in told else len(told)
        assert shown["fates"][:upto] == told[:upto], run.world
        assert ("wrong" in shown["fates"]) == ("wrong" in told)
        seen |= set(shown["fates"])
    assert seen == {"followed", "luck", "wrong"}


def test_what_the_moves_prove_does_not_depend_on_a_wrong_declaration() -> None:
    both = """
    function answer([world, said]) {
      const walk = new Walk(new WalkWorld(world));
      walk.move(0);
      if (said !== null) walk.declare(said);
      walk.move(1);
      const { found, proved, witness } = walk.judged();
      return [found.map(({ fate }) => fate), proved, witness];
    }
    """
    world = data(World.from_id("m2/8"))
    silent, wrong, right = answers(MODEL + both, [(world, None), (world, 1), (world, 2)])
    assert (silent, wrong, right) == (
        [[], True, None],
        [["wrong"], True, None],
        [["followed"], True, None],
    )


def test_least_cost_genus_and_percept_are_those_of_the_world() -> None:
    found = [World((), (), None), *worlds([1, 2, 3]), families.torus(3, 4), families.lattice(5, 5)]
    expected = [
        [world.least_cost(), world.genus, msgspec.to_builtins(first_percept(world))]
        for world in found
    ]
    assert answers(MODEL + MEASURE, map(data, found)) == expected


def test_every_small_world_without_more_than_5_exits_at_a_place_is_drawn_by_lot() -> None:
    drawn = answers(MODEL + DRAWN, [(seed, 1 + seed % 3) for seed in range(4500)])
    assert {World.from_map(one).code for one in drawn} == {
        world.code for world in worlds([1, 2, 3]) if max(map(len, world.vertices)) <= 5
    }
    large = answers(MODEL + DRAWN, [(seed, 4 + seed % 37) for seed in range(300)])
    assert {len(World.from_map(one).edges) for one in large} == set(range(4, 41))
    assert max(len(rotation) for one in large for rotation in one["vertices"]) == 5


def test_what_is_built_corner_by_corner_is_a_rotation_system() -> None:
    steps = [
        [[0, None]],
        [[0, 0]],
        [[0, 0], [0, 1]],
        [[0, 0], [0, 1], [1, 3]],
        [[0, None], [0, None], [1, 2], [3, 3], [4, 0]],
    ]
    built = [World.from_map(one) for one in answers(MODEL + BUILT, steps)]
    assert [len(world.edges) for world in built] == [1, 1, 2, 3, 5]
    assert [len(world.vertices) for world in built] == [2, 1, 1, 1, 3]
    crossing = answers(MODEL + BUILT, [[[0, 0], [a, b]] for a in range(2) for b in range(2)])
    assert {World.from_map(one).genus for one in crossing} == {0, 1}


def test_a_sketch_shows_the_rotation_of_every_vertex_clockwise() -> None:
    found = [*worlds([1, 2, 3]), families.torus(3, 3), families.lattice(3, 4), families.star(9)]
    source = script("geometry.js") + MODEL + script("sketch.js") + ENDS
    for world, shown in zip(found, answers(source, map(data, found)), strict=True):
        angles = dict[int, float]()
        for dart, x, y, last_x, last_y in shown["ends"]:
            spot = shown["spots"][world.vertex_of[dart]]
            assert dist((x, y), (spot["x"], spot["y"])) == pytest.approx(17, abs=0.2)
            assert (x, y) == (last_x, last_y)  # the road from its other end ends here
            angles[dart] = atan2(y - spot["y"], x - spot["x"])  # y downwards: clockwise
        for rotation in world.vertices:
            turns = [(angles[dart] - angles[rotation[0]]) % tau for dart in rotation]
            assert turns == sorted(turns)


def test_roads_of_small_and_of_well_known_planar_maps_do_not_cross_in_their_sketches() -> None:
    planar = [families.cube(), families.octahedron(), families.prism(5), families.lattice(3, 3)]
    source = script("geometry.js") + MODEL + script("sketch.js")
    source += "const answer = (world) => Math.floor(sketchOf(world).crossings());"
    planar += [world for world in worlds([1, 2, 3]) if not world.genus]
    planar += map(World.from_id, ("m4/34", "m4/45", "m4/471"))  # a loop around a dead end, or none
    assert set(answers(source, map(data, planar))) == {0}
    assert min(answers(source, map(data, [World.from_id("m2/8"), families.torus(3, 3)]))) > 0


def test_roads_cross_in_the_sketch_of_one_in_fifty_planar_worlds_with_4_edges_at_most() -> None:
    four = [world for world in worlds([4]) if not world.genus]
    source = script("geometry.js") + MODEL + script("sketch.js")
    source += "const answer = (world) => sketchOf(world).crossings() >= 1;"
    assert sum(answers(source, map(data, four))) < len(four) / 50


def test_a_declaration_can_be_taken_back() -> None:
    back = """
    function answer(world) {
      const walk = new Walk(new WalkWorld(world));
      const told = () => [walk.size, walk.here, walk.pending && walk.pending.edge, walk.moves];
      walk.move(0); const before = told();
      walk.declare(null); const grown = told();
      walk.takeBack(); return [before, grown, told()];
    }
    """
    (told,) = answers(MODEL + back, [data(families.path(3))])
    before, grown, after = told
    assert before == after != grown


def test_an_unexpected_sight_says_that_the_map_is_wrong() -> None:
    wrong = """
    function answer(world) {
      const walk = new Walk(new WalkWorld(world));
      for (const door of [0, 1, 1]) { walk.move(door); walk.declare(null); }
      walk.move(1); walk.declare(walk.hypotheses()[0]); // from here on the map is wrong
      walk.move(1);
      return [walk.contradiction, walk.judged().found.map(({ fate }) => fate)];
    }
    """
    world = families.lattice(2, 4, holes=0.1, seed=2)
    (told,) = answers(MODEL + wrong, [data(world)])
    contradiction = "After move 5 you saw 3 exits, where your map shows 2 exits and the marker."
    assert told == [contradiction, ["followed", "followed", "followed", "wrong"]]
