"""The planar prior: right in every planar world, wrong in every other, and caught there."""

from __future__ import annotations

import pytest

from tests.helpers import of_type, trace_of, variant, worlds
from topo_verify import examine
from topo_verify.algorithms import Algorithm
from topo_verify.algorithms.basic import NoRule
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.planar import PlanarRule, face
from topo_verify.robot.events import Reject
from topo_verify.robot.percept import Percept


def planar_basic() -> Algorithm:
    return variant(lambda: PlanarRule(NoRule()))


@pytest.mark.no_cover
def test_every_planar_world_is_mapped() -> None:
    for world in worlds(range(1, 5)):
        if world.is_planar:
            for mapper in (planar_basic(), "folding+planar"):
                report = examine(mapper, world)
                assert set(report.claims.values()) == {"ok"}, str(report)


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


def test_an_open_dart_is_a_dead_end_of_its_face() -> None:
    chart = Chart(Percept(3, 0))
    assert face(chart, 0) == [0, 1, 2]
    chart.join(0, 1)
    assert face(chart, 2) == [2, 0]
