"""The compiled judge, asked part by part as in large worlds, says what the checkers say."""

from __future__ import annotations

from typing import Any
from unittest.mock import Mock

import pytest
from msgspec.structs import replace

pytest.importorskip("numba", reason="the compiled engine needs numba")

from tests.extra.fast.kernels.judged import as_judged, sampled
from tests.extra.fast.kernels.mutations import mutated_traces
from tests.marks import with_marks
from topo_verify import CATALOGUE, World, examine, explore, families, worlds
from topo_verify.campaign import judge as judging
from topo_verify.campaign.judge import judge
from topo_verify.checkers import check, claims
from topo_verify.errors import InternalError
from topo_verify.extra.fast import checks as compiled_checks
from topo_verify.extra.fast import engine as compiled_engine
from topo_verify.extra.fast.checks import CompiledChecks, SampledChecks
from topo_verify.extra.fast.kernels.faults import PLANTED
from topo_verify.faults import FAULTS
from topo_verify.programs.loader import Mapper
from topo_verify.robot.events import Confirm, Event, Evidence, Finish, Record, Reject

MAPPERS: dict[str, Mapper | str] = {
    **{name: name for name in CATALOGUE},
    **{name: FAULTS[name].mapper for name in PLANTED},
}


@pytest.fixture(scope="module")
def checks() -> CompiledChecks:
    return CompiledChecks(is_long=True, part=40)


def require_alike(checks: CompiledChecks, world: World, name: str) -> bool:
    """Assert that judge and checkers agree on a run; whether the judge decided it."""
    run = explore(world, MAPPERS[name])
    judged = checks.unchecked(world, run.trace)
    decided = judged is not None
    if decided:
        expected = as_judged(check(world, run.trace, run.stopped))
        assert as_judged(judged or ()) == expected, f"{name} in {world.name}"
    else:
        assert name == "folding+planar" or not isinstance(run.trace[-1], Finish)
    return decided


@pytest.mark.parametrize("name", with_marks(MAPPERS, long=["takes-each-place-for-known"]))
def test_it_agrees_with_the_checkers_in_small_worlds(checks: CompiledChecks, name: str) -> None:
    worlds = [*sampled(4, 6), *sampled(5, 6), *sampled(6, 3)]
    decided = [require_alike(checks, world, name) for world in worlds]
    assert any(decided) or name not in CATALOGUE


@pytest.mark.nightly
@pytest.mark.parametrize("name", MAPPERS)
def test_it_agrees_with_the_checkers_in_1000_worlds(checks: CompiledChecks, name: str) -> None:
    for world in [*sampled(4, 334), *sampled(5, 333), *sampled(6, 333)]:
        require_alike(checks, world, name)


@pytest.mark.parametrize(
    "name", ["basic", "enhancement-iii-all+i", "folding", "leaves-out-the-darts-of-vk"]
)
def test_it_agrees_with_the_checkers_in_a_lattice(checks: CompiledChecks, name: str) -> None:
    require_alike(checks, families.lattice(7, 7), name)


@pytest.mark.nightly
@pytest.mark.parametrize("name", [name for name in MAPPERS if name != "takes-each-place-for-known"])
def test_it_agrees_with_the_checkers_in_a_larger_lattice(checks: CompiledChecks, name: str) -> None:
    require_alike(checks, families.lattice(10, 10), name)


@pytest.fixture(scope="module", params=[False, True], ids=["small", "part by part"])
def each_layout(request: pytest.FixtureRequest) -> CompiledChecks:
    return CompiledChecks(is_long=request.param, part=3)


def require_alike_on_mutated_traces(checks: CompiledChecks, seed: int, number: int) -> None:
    """Assert that judge and checkers agree on mutated traces, of which few may be left open."""
    left_open = 0
    for world, trace in mutated_traces(seed, number):
        judged = checks.unchecked(world, trace)
        if judged is None:
            left_open += 1
        else:
            assert as_judged(judged) == as_judged(check(world, trace)), f"{world.name}: {trace}"
    assert left_open < number / 3


def test_it_agrees_with_the_checkers_on_mutated_traces(each_layout: CompiledChecks) -> None:
    require_alike_on_mutated_traces(each_layout, 1, 1000)


@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(2, 7))
def test_it_agrees_with_the_checkers_on_many_mutated_traces(
    each_layout: CompiledChecks, seed: int
) -> None:
    require_alike_on_mutated_traces(each_layout, seed, 4000)


@pytest.fixture
def everything_is_large(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (claims, judging, compiled_checks, compiled_engine):
        monkeypatch.setattr(module, "LARGE", 3)


@pytest.mark.usefixtures("everything_is_large")
def test_where_claim_10_is_not_asked_it_agrees_on_mutated_traces(
    each_layout: CompiledChecks,
) -> None:
    require_alike_on_mutated_traces(each_layout, 7, 1000)


@pytest.mark.nightly
@pytest.mark.usefixtures("everything_is_large")
@pytest.mark.parametrize("seed", range(8, 13))
def test_where_claim_10_is_not_asked_it_agrees_on_many_mutated_traces(
    each_layout: CompiledChecks, seed: int
) -> None:
    require_alike_on_mutated_traces(each_layout, seed, 4000)


WITH_EVIDENCE = explore("m2/8", "enhancement-ii+i")
"""A run with a rejection whose evidence cites a dart, and with a reported cost."""


@pytest.mark.parametrize(
    "evidence",
    [{"sequence": -1}, {"at": -1}, {"record": Record(-1, ())}],
    ids=lambda e: next(iter(e)),
)
def test_evidence_that_cites_minus_1_cites_something(
    each_layout: CompiledChecks, evidence: dict[str, Any]
) -> None:
    trace = [with_evidence(event, evidence) for event in WITH_EVIDENCE.trace]
    assert each_layout.unchecked(WITH_EVIDENCE.world, trace) is None
    judgements = each_layout(WITH_EVIDENCE.world, trace, strict=False)
    assert "rejection-justified" in [j.claim for j in judgements if j.status == "failed"]


def with_evidence(event: Event, evidence: dict[str, Any]) -> Event:
    if isinstance(event, Reject):
        return replace(event, evidence=replace(event.evidence, **evidence))
    return event


def test_a_reported_cost_of_minus_1_is_a_cost(each_layout: CompiledChecks) -> None:
    *events, finish = WITH_EVIDENCE.trace
    assert isinstance(finish, Finish)
    trace = [*events, replace(finish, cost=-1)]
    judgements = each_layout(WITH_EVIDENCE.world, trace, strict=False)
    assert [j.claim for j in judgements if j.status == "failed"] == ["cost-honest"]


@pytest.mark.parametrize(
    "decision",
    [Confirm(97, 98, "motion"), Reject(97, 98, "motion", Evidence(0)), Confirm(-1, 0, "folding")],
)
def test_a_decision_about_no_dart_of_s_leaves_s_proved(
    each_layout: CompiledChecks, decision: Confirm | Reject
) -> None:
    run = explore("m4/167", "folding")
    for place in range(1, len(run.trace) - 1):
        trace = [*run.trace[:place], decision, *run.trace[place:]]
        judged = each_layout.unchecked(run.world, trace)
        assert judged is not None
        assert as_judged(judged) == as_judged(check(run.world, trace))


@pytest.mark.usefixtures("everything_is_large")
@pytest.mark.parametrize("name", ["basic", "enhancement-ii", "folding"])
def test_in_a_large_world_it_judges_a_compiled_run_and_claim_10_is_not_asked(
    monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    run = explore("m5/700", name, engine="compiled")
    expected = check(run.world, run.trace)
    monkeypatch.setattr(compiled_checks, "check", None)
    monkeypatch.setattr(judging, "check", None)
    report = judge(run)
    assert list(report.judgements) == expected
    assert report.claims["decisions-entailed"] == "not-asked"
    with pytest.raises(TypeError):  # the checkers are asked
        judge(run, strict=True)


@pytest.mark.usefixtures("everything_is_large")
def test_what_it_convicts_the_checkers_judge() -> None:
    world = World.from_id("m5/700")
    report = judge(explore(world, FAULTS["sets-out-unturned"].mapper))
    run = explore(world, "basic", engine="compiled")
    convicted = explore(world, FAULTS["sets-out-unturned"].mapper).trace
    checked = CompiledChecks(is_long=True)(world, convicted, strict=False)
    assert list(checked) == check(world, convicted)
    assert report.findings
    assert judge(run).ok


# ---------------------------------------------------------------- a sample for the checkers


@pytest.fixture(scope="module")
def small() -> CompiledChecks:
    return CompiledChecks()


def judged_by_checkers(small: CompiledChecks, mapper: Mapper | str, seed: int = 0) -> int:
    """The number of worlds with 3 edges in which the checkers judge; all judgements are theirs."""
    sampled_checks = SampledChecks(small, seed)
    for world in worlds(edges=3):
        run = explore(world, mapper)
        judged = sampled_checks(world, run.trace, run.stopped, strict=False)
        assert as_judged(judged) == as_judged(check(world, run.trace, run.stopped))
    return sampled_checks.worlds


def test_the_checkers_judge_what_costs_most_so_far_and_a_sample(
    small: CompiledChecks, monkeypatch: pytest.MonkeyPatch
) -> None:
    few = judged_by_checkers(small, "basic")
    assert 0 < few < 40
    monkeypatch.setattr(compiled_checks, "SAMPLE", 1)
    assert judged_by_checkers(small, "basic") == 74


def test_the_checkers_judge_every_run_that_fails(small: CompiledChecks) -> None:
    wrong = FAULTS["sets-out-unturned"].mapper
    failing = sum(not examine(wrong, world).ok for world in worlds(edges=3))
    assert failing <= judged_by_checkers(small, wrong)


def test_a_judge_that_acquits_a_failing_run_is_seen_where_the_sample_falls(
    small: CompiledChecks, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compiled_checks, "SAMPLE", 1)
    wrong = FAULTS["sets-out-unturned"].mapper
    world = next(world for world in worlds(edges=3) if not examine(wrong, world).ok)
    acquitted = small.unchecked(world, explore(world, "basic").trace)
    assert acquitted is not None
    monkeypatch.setattr(CompiledChecks, "unchecked", Mock(return_value=acquitted))
    run = explore(world, wrong)
    with pytest.raises(InternalError, match="the compiled judge says"):
        SampledChecks(small, 0)(run.world, run.trace, run.stopped, strict=False)
