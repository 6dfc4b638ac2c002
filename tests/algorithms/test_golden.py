"""Costs that two independent implementations agree on, to the traversal."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.helpers import SURE
from topo_verify import World, examine

GOLDEN = Path(__file__).parent.parent / "data" / "golden.json"
CASES: list[dict[str, Any]] = json.loads(GOLDEN.read_text())["cases"]


@pytest.mark.no_cover
@pytest.mark.parametrize("name", SURE)
@pytest.mark.parametrize("case", CASES, ids=lambda case: str(case["world"]["name"]))
def test_the_cost_is_the_golden_cost_to_the_traversal(case: dict[str, Any], name: str) -> None:
    world = World.from_json(json.dumps(case["world"]))
    report = examine(name, world)
    assert report.ok, str(report)
    assert report.cost == case["cost"][name]
    assert world.genus == case["genus"]


def test_there_is_a_golden_cost_for_every_algorithm_that_is_right_in_every_world() -> None:
    assert len(CASES) == 23
    assert all(list(case["cost"]) == SURE for case in CASES)
