"""The campaigns of lines: what a row has, in this process and in workers; a fault is a finding."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tests.extra.figures.rows import measured
from topo_verify import explore
from topo_verify.campaign.attempt import lost_row
from topo_verify.campaign.backend import MapperCampaign
from topo_verify.campaign.loss import Loss
from topo_verify.campaign.row import Row
from topo_verify.campaign.store import Store
from topo_verify.extra.figures import figures, points
from topo_verify.extra.figures.points import PlannedRun, line_campaigns, runs_of
from topo_verify.faults import FAULTS
from topo_verify.robot.limits import Limits
from topo_verify.world.resolve import resolve_world

WORLD = "family:lattice(4,4,holes=0.2,seed=3)"
SMALL = figures.Setting("lattice", "side", figures.LATTICE.family, (4,), (4,))
FIGURE = figures.Figure("3", "a test", SMALL, ("basic", "enhancement-ii"), {})
EXTENT = figures.FigureExtent(graphs=2)


def made(campaigns: list[MapperCampaign]) -> dict[PlannedRun, Row]:
    return {run: row for one in campaigns for row in one.rows(0) for run in runs_of(row)}


def test_a_row_has_what_the_run_cost_and_how_many_claims_held() -> None:
    row = measured(PlannedRun(WORLD, "enhancement-ii", "last", "newest"))
    world = resolve_world(WORLD)
    assert row.cost == explore(world, "enhancement-ii", pick="last", order="newest").cost
    assert row.cost != explore(world, "enhancement-ii").cost
    assert (row.edges, row.vertices) == (len(world.edges), len(world.vertices))
    assert row.least == world.least_cost()
    assert ({judged.status for judged in row.claims}, row.findings) == ({"ok"}, ())


def test_every_pair_of_policies_is_a_run_and_another_call_goes_on(tmp_path: Path) -> None:
    alone = figures.FigureExtent(graphs=1, policies=(figures.REFERENCE,))
    every = replace(alone, policies=figures.PAIRS)
    with Store(tmp_path / "runs.db") as store:
        made(line_campaigns([FIGURE], alone, "reference", store))
        rows = made(line_campaigns([FIGURE], every, "reference", store))
        assert {figures.PolicyPair(run.pick, run.order) for run in rows} == {*figures.PAIRS}
        assert len({row.cost for row in rows.values()}) > 5
        run = PlannedRun(WORLD.replace("3)", "0)"), "basic", "last", "newest")
        assert rows[run].cost == measured(run).cost
        grown = line_campaigns([FIGURE], EXTENT, "reference", store)
        assert [one.stored for one in grown] == [1, 1]


def test_a_seeded_fault_is_a_finding(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fault = FAULTS["restores-with-the-wrong-sign"]
    monkeypatch.setattr(
        "topo_verify.campaign.targets.NAMED", {"basic": fault, "enhancement-ii": fault}
    )
    with Store(tmp_path / "runs.db") as store:
        first, *_ = made(line_campaigns([FIGURE], EXTENT, "reference", store)).values()
    assert first.failed
    assert len(first.claims) == 10


def test_a_run_out_of_time_convicts_no_algorithm(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(points, "LIMITS", Limits(world_timeout=1e-4))
    large = replace(FIGURE, setting=replace(SMALL, sizes=(30,)), lines=("basic",))
    with Store(tmp_path / "runs.db") as store:
        (campaign,) = line_campaigns([large], EXTENT, "reference", store)
        rows = made([campaign])
        assert campaign.stored == 0  # the next call tries them again
    assert all(row.undecided and not row.failed for row in rows.values())


def test_a_lost_worker_leaves_every_pair_undecided() -> None:
    world = resolve_world(WORLD)
    row = lost_row(
        world, 0, WORLD, "basic", Limits(), "signal 9", Loss("worker", "silent", "right")
    )
    assert [run[2:] for run in runs_of(row)] == [(pair.pick, pair.order) for pair in figures.PAIRS]
    assert row.undecided == "signal 9"
