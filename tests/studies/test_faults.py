"""The campaign on the seeded faults: what counts as caught, and what must not be."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from tests.helpers import worlds
from topo_verify import examine
from topo_verify.algorithms import CATALOGUE
from topo_verify.faults import FAULTS, Fault
from topo_verify.robot.events import Augment, Robot
from topo_verify.robot.limits import Limits
from topo_verify.studies import faults as study
from topo_verify.world.rooted_map import World

UNTURNED = FAULTS["restores-with-the-wrong-sign"]
LUCKY = FAULTS["confirms-what-is-alone"]
SILENT = FAULTS["declares-nothing"]
ANY, STREETS = study.STRATEGIES


def test_search_tells_the_smallest_size_and_how_many_worlds_fail() -> None:
    found = study.smallest(UNTURNED)
    assert (found.edges, found.failing, found.total, found.world) == (3, 2, 74, "m3/8")
    assert found.claims["map-isomorphic"] == 1
    assert found.replay == f"topo-verify replay m3/8 --target {UNTURNED.target}"


def test_one_run_convicts_a_guess_by_what_its_history_proves() -> None:
    found = study.smallest(LUCKY)
    assert (found.edges, found.convicting) == (2, "m2/1")
    assert found.claims == {"map-entailed": 1, "decisions-entailed": 1}
    assert study.smallest(FAULTS["counts-no-ways-back"]).convicting is None


@pytest.mark.slow
def test_every_fault_is_caught_and_no_harmless_difference_is() -> None:
    entries = list(study.try_faults(FAULTS.values(), workers=2))
    assert [entry.name for entry in entries] == list(FAULTS)
    assert [entry for entry in entries if not entry.ok] == []


@pytest.mark.slow
@pytest.mark.parametrize("name", [fault.name for fault in FAULTS.values() if fault.harmless])
def test_no_harmless_difference_is_flagged_in_any_world_of_five_edges(name: str) -> None:
    (entry,) = study.try_faults([FAULTS[name]], by=["search"], thorough=True)
    assert entry.search is not None
    assert (entry.search.edges, entry.search.checked) == (5, 8162)
    assert entry.ok, entry


EARLY = [
    "leaves-h-in-u", "forgets-its-orientation", "ignores-direction-behind-e",
    "joins-a-loop-one-way", "keeps-sequences-of-last-edge", "forgets-that-vu-may-be-new",
    "delivers-the-mirror-image",
]  # fmt: skip


@pytest.mark.parametrize("name", EARLY)
def test_the_claim_that_must_catch_a_fault_does(name: str) -> None:
    (entry,) = study.try_faults([FAULTS[name]], by=["search"])
    assert entry.ok
    assert entry.properties is None


@pytest.mark.parametrize("name", [fault.name for fault in FAULTS.values() if fault.harmless])
def test_a_harmless_difference_is_not_flagged(name: str) -> None:
    assert study.smallest(FAULTS[name], largest=3).failing == 0
    assert study.examples(FAULTS[name], seeds=[0], most=20).found is False


def test_property_tests_find_a_fault_with_every_seed() -> None:
    drawn = study.examples(UNTURNED, seeds=[0, 1])
    assert drawn.strategy == ANY
    assert list(drawn.examples) == [ANY]
    assert drawn.median_examples == round(sum(filter(None, drawn.examples[ANY])) / 2)


def test_the_same_seed_takes_the_same_number_of_examples() -> None:
    assert len({study.examples_to_detection(UNTURNED, ANY, 3) for _ in range(2)}) == 1


def test_a_property_test_gives_up() -> None:
    assert study.examples_to_detection(SILENT, STREETS, 0, most=5) == (None, 0)


def test_a_fault_that_nothing_finds_is_not_ok() -> None:
    unseen = replace(SILENT, claim="map-isomorphic")
    found, drawn = study.smallest(unseen, largest=2), study.examples(unseen, seeds=[0], most=3)
    assert not study.entry_of(unseen, found, None).ok
    assert not study.entry_of(unseen, None, drawn).ok
    assert not study.entry_of(unseen, found, drawn).undecided


@pytest.mark.parametrize("name", ["counts-equal-doors-anywhere", "enters-old-places-by-door-0"])
def test_street_networks_find_what_small_worlds_hide(name: str) -> None:
    found, undecided = study.examples_to_detection(FAULTS[name], STREETS, 0)
    assert found is not None
    assert undecided == 0
    assert study.examples_to_detection(FAULTS[name], ANY, 0, most=50) == (None, 0)


@pytest.mark.parametrize(
    ("name", "world"),
    [("counts-equal-doors-anywhere", "m7/10899"), ("enters-old-places-by-door-0", "m6/8990")],
)
def test_the_latest_faults_fail_in_worlds_of_six_and_seven_edges(name: str, world: str) -> None:
    assert study.fails(FAULTS[name], World.from_id(world))


def test_beyond_five_edges_the_search_ends_at_the_first_failing_world(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(study, "COUNTED", 2)
    found = study.smallest(UNTURNED)
    assert (found.edges, found.failing, found.checked, found.total) == (3, 1, 9, 74)
    assert study.smallest(UNTURNED, thorough=True).failing == 2


# ---------------------------------------------------------------- what is not decided


def _stands_still(robot: Robot) -> object:
    while True:
        robot.percept  # noqa: B018  it looks, and looks again


def _draws_on_and_on(robot: Robot) -> object:
    while True:
        robot.declare(Augment(0, "new", 0, 1))


def _fault(mapper: Callable[[Robot], object], claim: str | None) -> Fault:
    return Fault(name="x", part="report", why="it is one", claim=claim, mapper=mapper)


def test_a_run_out_of_time_is_undecided_and_no_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(study, "A_SECOND", Limits(move_timeout=0.1, world_timeout=0.1))
    still = _fault(_stands_still, None)
    assert study.fails(still, World.from_id("m1/0")) is None
    found, drawn = study.smallest(still, largest=1), study.examples(still, seeds=[0], most=2)
    assert (found.failing, found.undecided, drawn.found) == (0, 2, False)
    assert drawn.undecided > 0
    entry = study.entry_of(still, found, drawn)
    assert entry.undecided
    assert not entry.ok


def _walks_on_and_on(robot: Robot) -> object:
    while True:
        robot.move(0)


def test_who_walks_on_and_on_is_undecided_below_the_bound_of_claim_7_and_fails_at_it() -> None:
    path = World.from_id("m5/0")
    assert study.fails(_fault(_walks_on_and_on, "cost-within-bound"), path) is None
    assert study.fails(_fault(_walks_on_and_on, None), path) is True


def test_who_declares_more_edges_than_there_are_has_failed_without_a_clock() -> None:
    assert study.fails(_fault(_draws_on_and_on, None), World.from_id("m3/8")) is True


def test_something_wrong_weighs_more_than_something_undecided() -> None:
    late = study.Smallest(5, 0, 8161, 8162, undecided=1)
    found = study.Examples(None, None, {ANY: (None, 3)}, 100)
    entry = study.entry_of(SILENT, late, found)
    assert (entry.undecided, entry.ok) == (False, False)


# ---------------------------------------------------------------- several processes


def test_workers_find_the_same_in_the_same_order() -> None:
    few = [FAULTS[name] for name in ("delivers-no-loops", "restores-with-the-wrong-sign")]
    alone = list(study.try_faults(few, by=["search"]))
    assert list(study.try_faults(few, by=["search"], workers=2)) == alone
    # In this process more modules are loaded than in a worker: Hypothesis may draw other examples.
    one = list(study.try_faults(few, by=["properties"], workers=1))
    assert list(study.try_faults(few, by=["properties"], workers=2)) == one


@pytest.mark.parametrize("claim", ["cost-honest", None])
def test_a_fault_that_another_claim_catches_and_a_harmless_one_that_is_flagged_are_not_ok(
    claim: str | None,
) -> None:
    (entry,) = study.try_faults([replace(UNTURNED, claim=claim)], by=["search"])
    assert (entry.ok, entry.harmless) == (False, claim is None)


@pytest.mark.parametrize("name", ["basic", "restores-with-the-wrong-sign", "declares-nothing"])
def test_asking_up_to_the_first_failing_claim_gives_the_same_verdict(name: str) -> None:
    mapper = FAULTS.get(name) or Fault(
        name="basic", part="motion", why="it is the reference", claim=None, mapper=CATALOGUE[name]
    )
    for world in worlds(range(1, 4)):
        assert study.fails(mapper, world) is not examine(mapper, world).ok
