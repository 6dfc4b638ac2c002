"""A mapper that misbehaves by number of calls is never EXHAUSTED, whichever way it is run.

Two misdeeds: one in a single call, one from a later call on. In a search by several workers the
second one is reached only where worlds are run again.
"""

from __future__ import annotations

import shutil
from itertools import cycle, islice, product
from pathlib import Path

import pytest

from tests.campaign.misdeeds import DEEDS
from tests.programs import natives
from tests.programs.programs import python
from topo_verify import extras
from topo_verify.campaign.backend import pooled
from topo_verify.campaign.drawn_row import ROW
from topo_verify.campaign.store import Store
from topo_verify.campaign.targets import targets
from topo_verify.checkers.findings import Verdict
from topo_verify.errors import InputError
from topo_verify.robot.limits import Limits
from topo_verify.studies.search import again
from topo_verify.studies.search.choices import SHARD
from topo_verify.studies.search.search import Search, search_campaign

WAYS = [*product(("child", "program", "library"), (0, 1, 2), (False, True))]
"""How the mapper is run, the number of workers, and whether a ledger is resumed."""

PAIRS = [*product(DEEDS, DEEDS)]

EVERY = [
    pytest.param(*pair, *way, marks=pytest.mark.nightly)
    for pair, way in zip(PAIRS, islice(cycle(WAYS), 7, None), strict=False)
]

SELECTED = [
    ("map", "skip", "child", 0, False),
    pytest.param("skip", "doors", "library", 0, True, marks=pytest.mark.long),
    ("doors", "hang", "child", 2, False),
    ("cost", "kill", "program", 1, True),
    ("kill", "error", "program", 2, False),
    pytest.param("hang", "cost", "child", 1, True, marks=pytest.mark.long),
    ("error", "map", "program", 0, True),
    pytest.param("nothing", "nothing", "library", 1, False, marks=pytest.mark.long),
]
"""Each deed in both places, each way."""


pytestmark = pytest.mark.usefixtures("folder")


@pytest.fixture(autouse=True)
def as_many_as_usual(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(again, "ROW", ROW)
    monkeypatch.setitem(SHARD, "reference", 20)


def target(way: str, plan: str, monkeypatch: pytest.MonkeyPatch) -> str:
    if way == "child":
        return f"misdeeds.py:{plan}"
    if way == "program":
        return python(Path("misdeeds.py").absolute(), plan)
    if not extras.usable_engines() or shutil.which("cc") is None:
        pytest.skip("numba or cc is not installed")
    monkeypatch.setenv("MISDEEDS", plan.replace("_", " "))
    return natives.misdeeds(Path.cwd())


def verdict(text: str, workers: int, *, has_ledger: bool) -> Verdict:
    mappers = targets(text, in_process=False)
    limits = Limits(move_timeout=0.4)
    campaign = search_campaign(mappers, edges=3, limits=limits, in_process=False)
    if not has_ledger:
        return search_with(Search(campaign, mappers, pooled(workers)))
    with Store("search.db") as store:
        known = store.resumed(campaign, mappers, ())
        return search_with(Search(campaign, mappers, pooled(workers, ()), known))


def resumed(text: str, workers: int) -> str:
    """The verdict of a search that goes on, or that the ledger holds other results."""
    try:
        return verdict(text, workers, has_ledger=True)
    except InputError:
        return "refused"


def search_with(study: Search) -> Verdict:
    study.work()
    study.run_again()
    return study.entry().verdict


@pytest.mark.parametrize(("once", "later", "way", "workers", "is_resumed"), [*SELECTED, *EVERY])
def test_a_pair_of_misdeeds_is_never_exhausted(
    once: str, later: str, way: str, workers: int, is_resumed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = target(way, f"at_20_{once}_from_70_{later}", monkeypatch)
    assert verdict(text, workers, has_ledger=is_resumed) in ("UNKNOWN", "REFUTED")
    if is_resumed:
        assert resumed(text, workers) in ("UNKNOWN", "REFUTED", "refused")


@pytest.mark.parametrize(
    "way", ["child", "program", pytest.param("library", marks=pytest.mark.long)]
)
def test_without_a_misdeed_it_is_exhausted(way: str, monkeypatch: pytest.MonkeyPatch) -> None:
    text = target(way, "at_9999_map", monkeypatch)
    assert verdict(text, 2, has_ledger=True) == "EXHAUSTED"
    assert verdict(text, 1, has_ledger=True) == "EXHAUSTED"


@pytest.mark.parametrize("plan", ["at_1_map", "from_3_map"])
@pytest.mark.parametrize(
    "way", ["child", "program", pytest.param("library", marks=pytest.mark.long)]
)
def test_a_mapper_that_is_wrong_first_or_after_its_second_world_is_refuted(
    way: str, plan: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = target(way, plan, monkeypatch)
    assert {verdict(text, workers, has_ledger=False) for workers in (0, 2)} == {"REFUTED"}
