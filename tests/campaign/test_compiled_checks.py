"""The compiled judge, asked part by part as in large worlds, says what the checkers say."""

from __future__ import annotations

import pytest

pytest.importorskip("numba", reason="the compiled engine needs numba")

from tests.compiled.judged import as_judged, sampled
from topo_verify import CATALOGUE, World, explore, families
from topo_verify.campaign import compiled_checks
from topo_verify.campaign import judge as judging
from topo_verify.campaign.compiled_checks import CompiledChecks
from topo_verify.campaign.judge import judge
from topo_verify.checkers import check, claims
from topo_verify.compiled.faults import PLANTED
from topo_verify.faults import FAULTS
from topo_verify.programs.loader import Mapper
from topo_verify.robot.events import Finish

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


@pytest.mark.parametrize("name", MAPPERS)
def test_it_agrees_with_the_checkers_in_small_worlds(checks: CompiledChecks, name: str) -> None:
    worlds = [*sampled(4, 6), *sampled(5, 6), *sampled(6, 3)]
    decided = [require_alike(checks, world, name) for world in worlds]
    assert any(decided) or name not in CATALOGUE


@pytest.mark.slow
@pytest.mark.parametrize("name", MAPPERS)
def test_it_agrees_with_the_checkers_in_1000_worlds(checks: CompiledChecks, name: str) -> None:
    for world in [*sampled(4, 334), *sampled(5, 333), *sampled(6, 333)]:
        require_alike(checks, world, name)


@pytest.mark.parametrize(
    "name", ["basic", "enhancement-iii-all+i", "folding", "leaves-out-the-darts-of-vk"]
)
def test_it_agrees_with_the_checkers_in_a_lattice(checks: CompiledChecks, name: str) -> None:
    require_alike(checks, families.lattice(7, 7), name)


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in MAPPERS if name != "takes-each-place-for-known"])
def test_it_agrees_with_the_checkers_in_a_larger_lattice(checks: CompiledChecks, name: str) -> None:
    require_alike(checks, families.lattice(10, 10), name)


@pytest.fixture
def everything_is_large(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (claims, judging, compiled_checks):
        monkeypatch.setattr(module, "LARGE", 3)


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
