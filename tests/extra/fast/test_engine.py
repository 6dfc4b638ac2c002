"""The compiled engine behind `explore` and `record`: the same runs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import topo_verify as tv
from tests.studies.baseline.recording import recording
from topo_verify import CATALOGUE, InputError, InternalError, Limits, World, explore, extras
from topo_verify.algorithms import NAMED
from topo_verify.campaign.engine import ENGINES, on_engine, usual_engine
from topo_verify.campaign.judge import judge
from topo_verify.campaign.targets import one_target
from topo_verify.extra.fast.engine import CompiledAlgorithm
from topo_verify.programs.loader import Target
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
        ({"mapper": "homing"}, "and homing is none of them: leave --engine out$"),
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
    monkeypatch.setitem(extras.PACKAGES, "fast", ("no_such_numba",))
    with pytest.raises(InputError, match=r"needs no_such_numba: .* 'topo-verify\[fast\]', or"):
        explore(NYC, "basic", engine="compiled")


def test_a_compiled_algorithm_takes_no_robot() -> None:
    robot: Any = None
    with pytest.raises(InternalError, match="the mapper basic of an engine got a robot"):
        CompiledAlgorithm("basic")(robot)


def test_the_reference_engine_leaves_targets_as_they_are() -> None:
    target = one_target("basic")
    assert on_engine("reference", (target,), Limits(budget=3)) == (target,)


# ---------------------------------------------------------------- record


@pytest.mark.long
def test_both_engines_record_the_same_baseline() -> None:
    made = [recording(one_target("folding"), "edges<=3", engine=engine) for engine in ENGINES]
    assert made[0] == made[1]


# ---------------------------------------------------------------- without a trace


@pytest.mark.parametrize(
    "wrong",
    [
        MapData(((0,), (1,)), ((0, 1),), 0),  # another world
        MapData(((0,), (0,)), ((0, 1),), 0),  # no world
        None,
    ],
)
def test_a_wrong_map_without_a_trace_is_a_finding(wrong: MapData | None) -> None:
    run = explore(NYC, "basic", engine="compiled", trace=False)
    report = judge(replace(run, map=wrong), where="nyc")
    assert [finding.claim for finding in report.findings] == ["map-isomorphic"]
    assert report.findings[0].replay == "topo-verify replay nyc --target basic"
    assert (report.ok, report.claims["cost-within-bound"]) == (False, "ok")


def test_a_cost_without_a_trace_is_held_to_the_bound() -> None:
    run = explore(NYC, "basic", engine="compiled", trace=False)
    report = judge(replace(run, cost=NYC.cost_bound + 1))
    assert [finding.claim for finding in report.findings] == ["cost-within-bound"]
    with pytest.raises(InternalError, match="the least cost of a proof is"):
        judge(replace(run, cost=1))


# ---------------------------------------------------------------- the default of a search


@pytest.mark.parametrize(
    ("target", "worlds", "engine"),
    [
        ("basic", 10**9, "reference"),
        ("homing", 10**9, "reference"),
        ("--cmd ./mapper", 10**9, "reference"),
        ("--library ./mapper.so", 10, "compiled"),
        ("mine.py:explore", 10**6, "compiled"),
        ("mine.py:explore", 1000, "reference"),
    ],
)
def test_the_usual_engine_is_the_faster_one(target: str, worlds: int, engine: str) -> None:
    mapper = Target(target, NAMED.get(target, print))
    assert usual_engine([mapper], worlds) == engine
