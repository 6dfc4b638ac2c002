"""What Hypothesis knows of topo_verify without being told, in a program of its own."""

from __future__ import annotations

import pytest
from hypothesis import Phase, find, settings
from hypothesis import strategies as st

from tests.python import python
from topo_verify import World
from topo_verify.strategies import registration


def printed(code: str) -> str:
    """What a fresh Python prints that runs this code, warnings being errors."""
    return python("-W", "error", "-c", code, check=True).stdout.strip()


@pytest.mark.long
def test_worlds_are_drawn_wherever_a_world_is_annotated() -> None:
    code = """
from hypothesis import find, strategies as st
from topo_verify import World

def edges(world: World) -> int:
    return len(world.edges)

print(find(st.builds(edges), lambda number: number > 2))
"""
    assert printed(code) == "3"


@pytest.mark.nightly
def test_a_mapper_is_drawn_wherever_an_algorithm_is_annotated() -> None:
    code = """
from hypothesis import find, strategies as st
from topo_verify import Algorithm, Policies, assert_maps, World

def runs(mapper: Algorithm, policies: Policies) -> tuple[str, str]:
    assert_maps(mapper, World.from_id("m2/8"))
    assert_maps("basic", World.from_id("m2/8"), pick=policies.pick, order=policies.order)
    return mapper.name, policies.pick

print(find(st.builds(runs), lambda names: names[1] != "nearest"))
"""
    assert printed(code) == "('basic', 'last')"


@pytest.mark.parametrize(("ci", "topo"), [("", "100 False None"), ("true", "100 True None")])
def test_the_profiles_are_there_as_soon_as_hypothesis_is_imported(
    ci: str, topo: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a build server `topo` tries the same examples every time, as Hypothesis does there."""
    for name in ("CI", "GITHUB_ACTIONS", "GITLAB_CI"):  # where Hypothesis loads its profile `ci`
        monkeypatch.delenv(name, raising=False)
    if ci:
        monkeypatch.setenv("CI", ci)
    code = """
from hypothesis import settings
for name in ("topo", "topo-ci", "topo-nightly"):
    profile = settings.get_profile(name)
    print(profile.max_examples, profile.derandomize, profile.deadline)
"""
    assert printed(code).splitlines() == [topo, "100 True None", "5000 False None"]


def test_whoever_imports_hypothesis_gets_nothing_heavy_with_it() -> None:
    code = """
import sys, hypothesis
heavy = ("z3", "networkx", "numpy", "click", "rich", "pytest")
print([name for name in heavy if name in sys.modules])
"""
    assert printed(code) == "[]"


@pytest.mark.long
def test_it_works_from_either_end() -> None:
    """Whichever is imported first, each asks for the other half-way."""
    assert printed("import topo_verify.strategies as s; print(s.worlds is not None)") == "True"
    code = "import hypothesis, topo_verify as tv; print(tv.strategies.worlds is not None)"
    assert printed(code) == "True"


def test_a_property_test_imports_what_its_first_run_needs_when_it_is_defined() -> None:
    """Hypothesis bounds the time of an example: the first one shall not import half the package."""
    code = """
import sys
import topo_verify as tv
from hypothesis import given, settings

@settings(max_examples=1, database=None)
@given(world=tv.strategies.worlds(min_edges=3, max_edges=3))
def first(world: tv.World) -> None:
    before = set(sys.modules)
    tv.explore(world, "folding")
    tv.assert_maps(lambda robot: tv.CATALOGUE["basic"](robot), world)
    print(sorted(name for name in set(sys.modules) - before if "topo_verify" in name))

first()
"""
    assert printed(code) == "[]"


def test_registering_twice_does_no_harm() -> None:
    registration.register()
    registration.register()
    assert find(st.from_type(World), lambda world: world.genus == 1).id == "m2/8"
    assert settings.get_profile("topo-ci").print_blob
    for name in ("topo", "topo-ci", "topo-nightly"):
        assert Phase.explain not in settings.get_profile(name).phases


def test_no_module_of_hypothesis_is_changed() -> None:
    code = """
from hypothesis.internal import scrutineer
print([place for place in scrutineer.UNHELPFUL_LOCATIONS if "topo_verify" in place])
"""
    assert printed(code) == "[]"
