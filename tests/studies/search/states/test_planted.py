"""Mistakes planted in the code that is shipped: `--policies every` runs that code, so it sees them.

A mistake is planted in the function itself, so that whatever calls it runs the mistaken code.
"""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable
from types import FunctionType
from typing import cast

import pytest

from topo_verify import CATALOGUE, World
from topo_verify.algorithms import exploration, policies
from topo_verify.algorithms.beyond.folding import FoldingRule
from topo_verify.algorithms.rules import HistoryRule, PrefixRule
from topo_verify.campaign.attempt import Attempt, attempt
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.studies.search.choices import Choices, every
from topo_verify.studies.search.search import search
from topo_verify.world.enumeration.classes import WorldClass

Plant = Callable[..., None]


@pytest.fixture
def plant(monkeypatch: pytest.MonkeyPatch) -> Plant:
    """Replaces parts of the text of a function by others."""

    def planted(function: Callable[..., object], parts: dict[str, str]) -> None:
        text = textwrap.dedent(inspect.getsource(function))
        for old, new in parts.items():
            assert text.count(old) == 1, "the part that is replaced stands there once"
            text = text.replace(old, new)
        code = cast("FunctionType", function).__code__
        names = dict(cast("FunctionType", function).__globals__)
        text = f"from __future__ import annotations\n{text}"
        exec(compile(text, code.co_filename, "exec"), names)  # noqa: S102  the text is ours
        monkeypatch.setattr(function, "__code__", names[code.co_name].__code__)

    return planted


def smallest(name: str, policies: Choices, edges: int, kind: str = "any") -> str:
    """The smallest counterexample; empty if every world was checked and no claim failed."""
    found = search(name, edges=edges, cls=WorldClass.parse(kind), policies=policies)
    assert found.verdict == ("EXHAUSTED" if found.counterexample is None else "REFUTED")
    return "" if found.counterexample is None else found.counterexample.world


OLDER = """\
if len(chart.alpha) >= 7 and len(chart.first) >= 3 and chart.vertex[e] == 1 != before:
            if chart.degree[0] == 1:
                remaining = [h for h in remaining if chart.vertex[h.dart] == chart.vertex[e]]
        """
LOOP = "chart.unexplored and pilot.cost != 10"


@pytest.mark.long
def test_a_mistake_that_rests_on_the_numbers_of_darts_is_found_in_four_edges(plant: Plant) -> None:
    walked, posed = "at = pilot.walk(", "robot.declare(Pose("
    begun = f"before = chart.vertex[at]; {walked}"
    plant(exploration.explore, {walked: begun, posed: f"{OLDER}{posed}"})
    assert smallest("basic", "all", 4, "simple") == "m4/13"
    assert smallest("basic", "every", 4, "simple") == "m4/13"


@pytest.mark.parametrize(
    ("world", "name", "function", "old", "new"),
    [
        ("m2/4", "basic", exploration.hypotheses, "order(alike,", "order(alike[1:],"),
        ("m2/5", "basic", exploration.execute, "!= expected:", "!= expected and step:"),
        ("m2/9", "basic", policies.shortest, "sorted(darts,", "sorted([*darts][:2],"),
        ("m2/2", "basic", policies.last, "next(reversed(chart.unexplored))", "-1"),
        ("m3/4", "enhancement-i", PrefixRule.refute, "1, shared + 1", "1, len(last.doors) + 1"),
        ("m3/4", "enhancement-ii", HistoryRule.refute, "return self.beyond", "at = self.beyond"),
        ("m2/1", "folding", FoldingRule.conclude, "self.fold.is_known(self.vu)", "True"),
        # In four edges; a model of the algorithm would not have the mistake.
        pytest.param(
            "m4/48", "basic", exploration.explore, "while chart.unexplored:", f"while {LOOP}:",
            marks=pytest.mark.long,
        ),
    ],
)  # fmt: skip
def test_a_mistake_in_the_code_that_is_shipped_is_found(
    plant: Plant, world: str, name: str, function: Callable[..., object], old: str, new: str
) -> None:
    def once(target: Target) -> Attempt:
        return attempt(World.from_id(world), target, Limits(), where=world, witness=False)

    def ok() -> bool:
        runs = every(Target(name, CATALOGUE[name]), World.from_id(world), once)
        return all(made.report.ok for made in runs)

    assert ok()
    plant(function, {old: new})
    assert not ok()
