"""What a failing test prints of its runs, and what observations carry."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings

import topo_verify
from topo_verify import Algorithm, Policies, World, explore, families
from topo_verify.strategies import mappers, notes, observe, policies, worlds
from topo_verify.strategies.notes import describe, features


def test_a_run_is_described_in_one_line_that_can_be_replayed() -> None:
    run = explore(World.from_id("m4/17"), "enhancement-ii", pick="last", order="newest")
    assert describe(run) == (
        f"enhancement-ii (pick last, order newest) in m4/17: {run.cost} edge traversals"
    )


def test_a_world_without_an_id_is_described_by_its_json() -> None:
    path = families.path(203)
    line = describe(explore(path, "basic"))
    text = line.removeprefix("basic (pick nearest, order shortest) in ").rpartition(":")[0]
    assert World.from_json(text).code == path.code


def test_no_name_of_a_mapper_controls_a_terminal() -> None:
    run = replace(explore(World.from_id("m1/0"), "basic"), algorithm="a\x1b[31m.py:explore")
    assert describe(run).startswith("a\\x1b[31m.py:explore (pick ")


@pytest.mark.nightly
def test_the_failing_example_prints_its_world_and_the_run() -> None:
    @settings(database=None, derandomize=True)
    @given(world=worlds(), mapper=mappers())
    def wrong(world: World, mapper: Algorithm) -> None:
        run = explore(world, mapper)
        observe(run)
        assert world.genus == 0

    with pytest.raises(AssertionError) as failure:
        wrong()
    notes = "\n".join(failure.value.__notes__)
    assert "world=tv.World.from_id('m2/8')" in notes
    assert "basic (pick nearest, order shortest) in m2/8: " in notes


@pytest.mark.nightly
def test_the_failing_example_can_be_pasted_as_it_is_printed() -> None:
    """Below `import topo_verify as tv`, with which every file of tests in docs/ begins."""
    drawn: dict[str, object] = {}

    @settings(database=None, derandomize=True)
    @given(world=worlds(), mapper=mappers(), chosen=policies())
    def example(world: World, mapper: Algorithm, chosen: Policies) -> None:
        drawn.update(world=world, mapper=mapper, chosen=chosen)
        assert mapper.policies.pick == chosen.pick == "nearest" or mapper.name == "basic"

    with pytest.raises(AssertionError) as failure:
        example()
    shown = re.search(r"example\(.*?\n\)", "\n".join(failure.value.__notes__), re.DOTALL)
    assert shown is not None
    assert eval(shown[0], {"example": dict, "tv": topo_verify}) == drawn  # noqa: S307  as pasted


@pytest.mark.parametrize("inside", [True, False])
def test_a_run_is_noted_within_a_test_of_hypothesis_only(
    inside: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    messages: list[object] = []

    def event(feature: str, value: int) -> None:
        messages.append((feature, value))

    if inside:
        monkeypatch.setattr(notes, "currently_in_test_context", lambda: True)
    monkeypatch.setattr(notes, "observability_enabled", lambda: True)
    monkeypatch.setattr(notes, "note", messages.append)
    monkeypatch.setattr(notes, "event", event)
    run = explore(World.from_id("m2/0"), "basic")
    observe(run)
    assert messages == ([describe(run), *features(run).items()] if inside else [])
    assert capsys.readouterr() == ("", "")


def test_features_are_those_of_the_run() -> None:
    run = explore(World.from_id("m2/8"), "basic")
    assert features(run) == {"edges": 2, "genus": 1, "cost": run.cost, "loop closings": 2}


TEST = """
from hypothesis import given, settings
from topo_verify import World, explore
from topo_verify.strategies import observe, worlds

settings.load_profile("topo-ci")  # in a new folder Hypothesis first parses every module

@settings(max_examples=10)
@given(world=worlds())
def test(world: World) -> None:
    observe(explore(world, "basic"))

test()
"""


@pytest.mark.nightly
def test_with_hypothesiss_own_switch_on_every_run_carries_its_features(tmp_path: Path) -> None:
    env = {**os.environ, "HYPOTHESIS_EXPERIMENTAL_OBSERVABILITY": "1"}
    subprocess.run([sys.executable, "-c", TEST], env=env, cwd=tmp_path, check=True)
    (file,) = (tmp_path / ".hypothesis" / "observed").glob("*_testcases.jsonl")
    runs = [json.loads(line) for line in file.read_text().splitlines()]
    carried = [run["features"] for run in runs if run["type"] == "test_case"]
    assert len(carried) == 10
    assert all({"edges", "genus", "cost", "loop closings"} <= set(run) for run in carried)
