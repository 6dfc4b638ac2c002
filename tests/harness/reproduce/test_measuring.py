"""One run, judged: its row, in this process and in workers; a fault is a finding."""

from __future__ import annotations

from typing import Any

import pytest

from topo_verify import explore
from topo_verify.faults import FAULTS
from topo_verify.harness.reproduce import measuring
from topo_verify.harness.reproduce.measuring import PlannedRun, measured, measured_runs
from topo_verify.harness.work import Loss
from topo_verify.robot.limits import Limits
from topo_verify.world.resolve import resolve_world

WORLD = "family:lattice(4,4,holes=0.2,seed=3)"
RUN = PlannedRun(WORLD, "enhancement-ii", "last", "newest")


def test_a_row_has_what_the_run_cost_and_how_many_claims_held() -> None:
    row, world = measured(RUN), resolve_world(WORLD)
    assert row.cost == explore(world, "enhancement-ii", pick="last", order="newest").cost
    assert row.cost != explore(world, "enhancement-ii").cost
    assert (row.edges, row.vertices) == (len(world.edges), len(world.vertices))
    assert row.least == world.least_cost()
    assert (row.held, row.claims, row.findings, row.undecided) == (10, 10, (), None)


def test_workers_make_the_same_rows() -> None:
    runs = [RUN, PlannedRun(WORLD, "basic", "nearest", "shortest")]
    here = {row.run: row for row in measured_runs(runs, 1)}
    assert {row.run: row for row in measured_runs(runs, 2)} == here


def test_a_seeded_fault_is_a_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    fault = FAULTS["restores-with-the-wrong-sign"]

    def faulty(world: Any, _algorithm: str, **_options: Any) -> Any:
        return explore(world, fault, limits=Limits())

    monkeypatch.setattr(measuring, "explore", faulty)
    row = measured(RUN)
    assert row.findings
    assert row.held < row.claims == 10


def test_a_run_out_of_time_convicts_nobody(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(measuring, "LIMITS", Limits(world_timeout=1e-4))
    row = measured(PlannedRun("family:lattice(30,30,seed=1)", "basic", "nearest", "shortest"))
    assert row.findings == ()
    assert row.undecided is not None


def test_a_lost_worker_decides_nothing() -> None:
    loss = Loss("signal 9", None, loading=False)
    row = measuring._lost(RUN, loss)  # pyright: ignore[reportPrivateUsage]
    assert row.undecided == "its worker was lost: signal 9"
