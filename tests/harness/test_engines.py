"""The compiled engine behind `explore`, `record`, `reproduce`, `faults`: the same runs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import topo_verify as tv
from topo_verify import CATALOGUE, InputError, InternalError, Limits, World, explore
from topo_verify.compiled.faults import PLANTED
from topo_verify.faults import FAULTS
from topo_verify.harness.baseline.record import record
from topo_verify.harness.corpus import corpus_from
from topo_verify.harness.engines import CompiledAlgorithm, on_engine, planted
from topo_verify.harness.faults.checks import smallest
from topo_verify.harness.judge import judge
from topo_verify.harness.reproduce import measuring
from topo_verify.harness.reproduce.figures import FIGURES, LATTICE, FigureExtent
from topo_verify.harness.reproduce.measuring import (
    MAP_CLAIMS,
    MeasuredRun,
    PlannedRun,
    measured,
    measured_runs,
)
from topo_verify.harness.reproduce.store import RunStore
from topo_verify.harness.targets import one_target
from topo_verify.robot.events import MapData

pytest.importorskip("numba")

NYC = World.load(Path(tv.__file__).parent / "world" / "data" / "nyc_osmnx.json")


# ---------------------------------------------------------------- explore


@pytest.mark.parametrize("name", CATALOGUE)
def test_a_run_of_the_compiled_engine_is_the_run_of_the_reference(name: str) -> None:
    ours, theirs = explore(NYC, name), explore(NYC, name, engine="compiled")
    assert theirs.trace == ours.trace
    assert (theirs.cost, theirs.map, theirs.policies) == (ours.cost, ours.map, ours.policies)
    assert judge(theirs) == judge(ours)


def test_cost_and_map_can_be_had_without_the_trace() -> None:
    whole, brief = (
        explore(NYC, "basic", engine="compiled", trace=asked) for asked in (True, False)
    )
    assert (brief.trace, brief.cost, brief.map) == ((), whole.cost, whole.map)


def test_a_budget_stops_the_compiled_engine_where_it_stops_the_reference() -> None:
    limits = Limits(budget=100)
    ours = explore(NYC, "enhancement-ii", limits=limits)
    theirs = explore(NYC, "enhancement-ii", limits=limits, engine="compiled")
    assert (theirs.trace, theirs.stopped, theirs.limit) == (ours.trace, ours.stopped, ours.limit)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (
            {"mapper": CATALOGUE["basic"].with_policies(pick="last")},
            "policies nearest and shortest",
        ),
        ({"mapper": print}, "runs the algorithms of the catalogue, basic,"),
        ({"limits": Limits(move_timeout=1.0)}, "leave out --move-timeout and --world-timeout"),
        ({"engine": "steam"}, "engine='steam': expected one of reference, compiled"),
        ({"engine": "reference", "trace": False}, "the reference engine always keeps the trace"),
    ],
)
def test_what_the_engine_cannot_run_is_refused(options: dict[str, Any], words: str) -> None:
    asked: dict[str, Any] = {"mapper": "basic", "engine": "compiled", **options}
    with pytest.raises(InputError, match=words):
        explore(NYC, **asked)


def test_without_numba_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("topo_verify.compiled.available", lambda: False)
    with pytest.raises(InputError, match=r"needs numba: pip install 'topo-verify\[fast\]'"):
        explore(NYC, "basic", engine="compiled")


def test_a_compiled_algorithm_takes_no_robot() -> None:
    robot: Any = None
    with pytest.raises(InternalError, match="the compiled basic was called with a robot"):
        CompiledAlgorithm("basic")(robot)


def test_the_reference_engine_leaves_targets_as_they_are() -> None:
    target = one_target("basic")
    assert on_engine("reference", (target,), Limits(budget=3)) == (target,)


# ---------------------------------------------------------------- record, faults


def test_both_engines_record_the_same_baseline() -> None:
    corpus = corpus_from(("edges<=3",), seed=0)
    made = [
        record(target, corpus, worlds=("edges<=3",), seed=0, limits=Limits())
        for target in (
            one_target("folding"),
            *on_engine("compiled", (one_target("folding"),), Limits()),
        )
    ]
    assert made[0] == made[1]


@pytest.mark.parametrize("name", ["leaves-out-the-darts-of-v0", "takes-each-place-for-known"])
def test_a_seeded_fault_is_found_in_the_same_worlds_by_either_engine(name: str) -> None:
    ours, theirs = (smallest(FAULTS[name], engine=one) for one in ("reference", "compiled"))
    assert theirs == ours


def test_every_kernel_with_a_mistake_has_the_name_of_a_seeded_fault() -> None:
    assert set(PLANTED) <= set(FAULTS)
    assert len(PLANTED) >= 10
    assert planted("no-such-fault") is None


# ---------------------------------------------------------------- reproduce


def planned(world: str, algorithm: str = "basic") -> PlannedRun:
    return PlannedRun(world, algorithm, "nearest", "shortest")


@pytest.mark.parametrize("algorithm", ["basic", "folding"])
def test_a_point_of_a_figure_is_the_same_by_either_engine(algorithm: str) -> None:
    run = planned("family:lattice(6,6,holes=0.2,seed=1)", algorithm)
    ours, theirs = measured(run), measured(run, "compiled")
    assert (theirs.cost, theirs.held, theirs.claims) == (ours.cost, ours.held, ours.claims)
    assert (ours.engine, theirs.engine) == ("reference", "compiled")


def test_a_large_world_is_judged_by_its_map_and_cost(monkeypatch: pytest.MonkeyPatch) -> None:
    run = planned("family:lattice(6,6,holes=0.2,seed=1)")
    whole = measured(run, "compiled")
    monkeypatch.setattr(measuring, "LARGE", 10)
    brief = measured(run, "compiled")
    assert (brief.cost, brief.least, brief.edges) == (whole.cost, whole.least, whole.edges)
    assert (brief.held, brief.claims, brief.findings) == (2, len(MAP_CLAIMS), ())


@pytest.mark.parametrize(
    "wrong",
    [
        MapData(((0,), (1,)), ((0, 1),), 0),  # another world
        MapData(((0,), (0,)), ((0, 1),), 0),  # no world
    ],
)
def test_a_wrong_map_of_a_large_world_is_a_finding(
    wrong: MapData, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lies(*arguments: Any, **options: Any) -> tv.Exploration:
        return replace(explore(*arguments, **options), map=wrong)

    monkeypatch.setattr(measuring, "LARGE", 2)
    monkeypatch.setattr(measuring, "explore", lies)
    brief = measured(planned("m3/14"), "compiled")
    assert [finding.claim for finding in brief.findings] == ["map-isomorphic"]
    assert (brief.held, brief.claims) == (1, 2)


def test_workers_use_the_engine_that_is_asked_for() -> None:
    runs = [planned(f"family:lattice(4,4,holes=0.2,seed={seed})") for seed in (1, 2)]
    here = list(measured_runs(runs, 1, "compiled"))
    there: list[MeasuredRun] = list(measured_runs(runs, 2, "compiled"))
    assert sorted(there, key=lambda made: made.run.world) == here
    assert {made.engine for made in here} == {"compiled"}


def test_lattices_grow_to_100_by_100_with_the_compiled_engine() -> None:
    assert FigureExtent(large=True).sizes(LATTICE)[-1] == 100
    assert FigureExtent().sizes(LATTICE)[-1] == 20
    assert FIGURES["3"].setting is LATTICE


def test_a_store_never_mixes_engines(tmp_path: Path) -> None:
    with RunStore(tmp_path / "runs.jsonl") as store:
        store.put(measured(planned("m3/14")))
    words = "the reference engine made its runs, not the compiled: remove it to begin anew"
    with pytest.raises(InputError, match=words), RunStore(tmp_path / "runs.jsonl", "compiled"):
        pass
