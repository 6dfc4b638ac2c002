"""The run of a counterexample comes back from a worker as it was judged."""

from __future__ import annotations

import msgspec
import pytest

from topo_verify import World, examine
from topo_verify.campaign.attempt import attempt, row_of
from topo_verify.campaign.row import Row
from topo_verify.campaign.targets import one_target
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.studies.search import failing_run
from topo_verify.studies.search.failing_run import look, report_of


def row(target: Target, world: str = "m1/0") -> Row:
    """The row of a run, as it comes from a worker."""
    judged = attempt(World.from_id(world), target, Limits(), where=world)
    made = row_of(judged, world, 0, look=look())
    return msgspec.json.decode(msgspec.json.encode(made), type=Row)


@pytest.mark.usefixtures("folder")
def test_a_report_comes_back_with_its_run() -> None:
    target = one_target("mappers.py:guesses")
    came = report_of(row(target, "m2/3"), "map-isomorphic")
    judged = examine(target, "m2/3", where="m2/3")
    assert came == judged
    assert came is not None
    assert came.run == judged.run
    assert came.walk() == judged.walk() != []


@pytest.mark.usefixtures("folder")
def test_a_claim_that_did_not_fail_has_no_report() -> None:
    guesses = row(one_target("mappers.py:guesses"), "m2/3")
    assert report_of(guesses, "not-deterministic") is None
    assert report_of(row(one_target("basic")), "map-isomorphic") is None


@pytest.mark.usefixtures("folder")
def test_a_long_run_is_not_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    assert report_of(row(one_target("mappers.py:guesses"), "m2/3"), "map-isomorphic") is not None
    monkeypatch.setattr(failing_run, "MOST_EVENTS", 1)
    assert report_of(row(one_target("mappers.py:guesses"), "m2/3"), "map-isomorphic") is None
