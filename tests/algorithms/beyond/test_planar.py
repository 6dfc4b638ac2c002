"""The planar prior: right in every planar world, wrong in every other, and caught there."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import given

from tests.checkers.test_planar_prior import FACE
from tests.helpers import of_type, trace_of, variant, worlds
from topo_verify import World, examine, explore
from topo_verify.algorithms import STEERED, Algorithm
from topo_verify.algorithms.beyond.planar import PlanarRule, face
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.rules import NoRule
from topo_verify.robot.events import Reject
from topo_verify.robot.percept import Percept
from topo_verify.strategies import planar_worlds
from topo_verify.world.resolve import resolve_world


def planar_basic() -> Algorithm:
    return variant(lambda: PlanarRule(NoRule()))


@pytest.mark.no_cover
def test_every_planar_world_is_mapped() -> None:
    for world in worlds(range(1, 5)):
        if world.is_planar:
            report = examine(planar_basic(), world)
            assert set(report.claims.values()) == {"ok"}, str(report)


@pytest.mark.long
@pytest.mark.no_cover
def test_every_nonplanar_world_is_mapped_wrong_and_caught() -> None:
    nonplanar = [world for world in worlds(range(1, 5)) if not world.is_planar]
    assert len(nonplanar) == 1 + 20 + 328
    for world in nonplanar:
        report = examine(planar_basic(), world)
        assert report.claims["map-isomorphic"] == "failed"
        assert report.claims["true-hypothesis-kept"] == "failed"


def test_it_rejects_before_any_motion() -> None:
    rejected = [
        reject
        for world in worlds([4])
        if world.is_planar
        for reject in of_type(Reject, trace_of(world, "folding+planar"))
        if reject.rule == "planar"
    ]
    assert rejected
    assert all(reject.evidence.contradiction for reject in rejected)


STEERED_ON_A_PLANE = [name for name, mapper in STEERED.items() if mapper.assumes == "planar"]


@pytest.mark.long
@pytest.mark.parametrize("name", STEERED_ON_A_PLANE)
@given(world=planar_worlds(max_edges=15))
def test_every_claim_of_those_that_steer_holds_in_planar_worlds(name: str, world: World) -> None:
    report = examine(name, world)
    assert set(report.claims.values()) == {"ok"}, str(report)


@pytest.mark.parametrize("name", STEERED_ON_A_PLANE)
@pytest.mark.parametrize(
    ("place", "words"), [("m2/8", "another face of S"), ("m3/8", "two vertices of S would be one")]
)
def test_elsewhere_those_that_steer_find_out(name: str, place: str, words: str) -> None:
    assert examine(name, World.from_id(place)).findings[-1].message.endswith(words)


GRID = resolve_world("family:lattice(8,8,holes=0.2,seed=3)")


def test_those_that_steer_declare_the_prior_where_they_use_it() -> None:
    rejects = of_type(Reject, trace_of(GRID, "homing+planar"))
    assert Counter(reject.rule for reject in rejects) == {"folding": 240, "planar": 62}
    assert {r.evidence.contradiction for r in rejects if r.rule == "planar"} == {FACE}


@pytest.mark.no_cover
def test_the_prior_saves_moves_on_a_grid() -> None:
    for name in ("folding", "homing"):
        assert explore(GRID, f"{name}+planar").cost < explore(GRID, name).cost


def test_an_open_dart_is_a_dead_end_of_its_face() -> None:
    chart = Chart(Percept(3, 0))
    assert face(chart, 0) == [0, 1, 2]
    chart.join(0, 1)
    assert face(chart, 2) == [2, 0]
