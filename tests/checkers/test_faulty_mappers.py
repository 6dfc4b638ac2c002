"""Each claim catches a mapper with one fault, in the smallest world where the fault matters."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from examples.undirected import undirected, unmarked
from tests.faults.every import EVERY
from tests.helpers import EIGHT, worlds
from topo_verify import CATALOGUE, Limits, World, examine
from topo_verify.algorithms.chart import Survey
from topo_verify.faults.fault import ForwardingRobot
from topo_verify.programs.loader import Mapper
from topo_verify.robot.events import Robot
from topo_verify.robot.percept import Door, Percept, Purpose


def failing(mapper: Mapper, world: World, *, budget: int | None = None) -> set[str]:
    """Which of the claims 1-8 fail."""
    report = examine(mapper, world, limits=Limits(budget=budget))
    return {claim for claim, status in report.claims.items() if status == "failed"} & EIGHT


class Wandering(ForwardingRobot):
    """A robot that walks every edge two hundred times more."""

    cost = 0

    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:
        percept = super().move(door, purpose)
        for _ in range(200):
            super().move(0)
        self.cost += 201
        return percept


def wanders(robot: Robot) -> object:
    wandering = Wandering(robot)
    return CATALOGUE["basic"](wandering)._replace(cost=wandering.cost)


def knows_it_beforehand(_robot: Robot) -> Survey:
    """A single edge, it says, whatever the world."""
    return Survey(((0,), (1,)), ((0, 1),), 0, 0)


REJECTS_THE_TRUTH = {"true-hypothesis-kept", "map-isomorphic", "rejection-justified"}

FAULTS: list[tuple[Mapper, str, set[str]]] = [
    (
        EVERY["tries-only-the-nearest-two"],
        "m2/9",
        {"true-hypothesis-posed", "true-hypothesis-kept", "map-isomorphic"},
    ),
    (EVERY["traces-through-the-unexplored"], "m4/36", REJECTS_THE_TRUTH),
    (EVERY["compares-before-the-door"], "m5/85", REJECTS_THE_TRUTH),
    (EVERY["records-a-loop-from-dart-0"], "m5/446", REJECTS_THE_TRUTH),
    (undirected, "m2/5", {"no-false-confirm", "map-isomorphic"}),
    (EVERY["delivers-the-mirror-image"], "m2/4", {"map-isomorphic"}),
    (EVERY["counts-the-start-as-a-move"], "m1/0", {"cost-honest"}),
    (knows_it_beforehand, "m1/0", {"cost-within-bound"}),
]


@pytest.mark.parametrize(("mapper", "world", "claims"), FAULTS)
def test_a_faulty_mapper_is_caught(mapper: Mapper, world: str, claims: set[str]) -> None:
    assert failing(mapper, World.from_id(world)) == claims


def test_a_rejection_with_false_evidence_is_caught_where_it_does_no_harm() -> None:
    world = World.from_id("m4/42")
    assert failing(EVERY["traces-through-the-unexplored"], world) == {"rejection-justified"}


def test_every_claim_but_percepts_true_is_caught_by_a_faulty_mapper() -> None:
    # A mapper cannot put percepts on record: those in a trace are the robot's.
    assert {claim for _, _, claims in FAULTS for claim in claims} == EIGHT - {"percepts-true"}


def test_a_mapper_that_wanders_is_caught_by_the_bound_if_not_by_its_budget() -> None:
    world = World.from_id("m1/0")
    assert failing(wanders, world, budget=1000) == {"cost-within-bound"}
    assert failing(wanders, world) == {"map-isomorphic"}


def test_a_fault_that_does_not_matter_in_a_world_is_not_held_against_the_mapper() -> None:
    assert failing(EVERY["delivers-the-mirror-image"], World.from_id("m1/0")) == set()


def test_a_mapper_that_declares_nothing_is_judged_on_percepts_map_and_cost() -> None:
    silent = {
        "true-hypothesis-posed",
        "true-hypothesis-kept",
        "no-false-confirm",
        "rejection-justified",
    }
    for world in worlds(range(1, 4)):
        report = examine(EVERY["declares-nothing"], world)
        assert report.ok
        claims = {claim: report.claims[claim] for claim in EIGHT}
        assert {c for c, status in claims.items() if status == "not-declared"} == silent
        assert {c for c, status in claims.items() if status == "ok"} == EIGHT - silent


CLASSES: dict[str, Callable[[World], bool]] = {
    "any": lambda world: bool(world.edges),
    "loopless": lambda world: world.is_loopless,
    "simple": lambda world: world.is_simple,
}


@pytest.mark.long
@pytest.mark.parametrize(
    ("mapper", "smallest"),
    [
        (undirected, {"any": "m2/5", "loopless": "m3/28", "simple": "m4/183"}),
        (unmarked, {"any": "m2/3", "loopless": "m2/3", "simple": "m3/12"}),
    ],
)
@pytest.mark.no_cover
def test_without_a_directed_marker_there_are_false_confirmations(
    mapper: Mapper, smallest: dict[str, str]
) -> None:
    # The worlds that docs/semantics.md names: this is a limit of the marker, not of the mapper.
    wrong = [w for w in worlds(range(1, 5)) if "no-false-confirm" in failing(mapper, w)]
    for name, belongs in CLASSES.items():
        assert next(world.id for world in wrong if belongs(world)) == smallest[name]
