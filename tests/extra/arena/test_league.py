"""The table does not depend on the order of the runs, and is no place for a broken claim."""

from __future__ import annotations

import dataclasses
from random import Random

import pytest
from msgspec.structs import replace

from tests.helpers import some
from topo_verify.campaign.row import Judged, Row
from topo_verify.campaign.targets import targets
from topo_verify.checkers import CLAIMS, Finding
from topo_verify.extra.arena.league import League
from topo_verify.extra.arena.suites import Suite, drawn, every
from topo_verify.robot.limits import Limits

SMALL = Suite("small", "a test", (every(2), drawn("lattice(3,3,holes=0.2)", 3, planar=True)))
GRIDS = Suite("grids", "a test", SMALL.families[1:])
HELD = tuple(Judged("ok", 3, 3) for _ in CLAIMS)


def enter(table: League, mapper: str, world: str, cost: int, *, wrong: bool = False) -> None:
    """Enter a run that was not made."""
    finding = Finding("map-isomorphic", None, None, None, "wrong", replay="topo-verify replay x")
    table.rows[mapper, world] = Row(
        mapper=mapper,
        world=world,
        place=0,
        edges=4,
        least=10,
        cost=cost,
        claims=HELD,
        findings=(finding,) if wrong else (),
    )


def league(text: str, *suites: Suite) -> League:
    return League(targets(text), suites, 0)


def test_places_follow_the_means_and_equal_ones_are_shared() -> None:
    table = league("basic,folding,enhancement-i", GRIDS)
    for mapper in ("basic", "folding", "enhancement-i"):
        for noise, world in enumerate(GRIDS.worlds(0)):
            enter(table, mapper, world, (20 if mapper == "folding" else 30) + 5 * noise)
    entries = table.entries()
    assert [(e.mapper, e.place) for e in entries] == [
        ("folding", 1), ("basic", 2), ("enhancement-i", 2),
    ]  # fmt: skip
    behind, ratio = entries[1].behind, entries[1].ratio
    assert behind is not None
    assert ratio is not None
    # Paired: both pay more in the same worlds, so the difference has no spread at all.
    assert (behind.mapper, behind.mean, behind.low, behind.high) == ("folding", 1.0, 1.0, 1.0)
    assert some(ratio.high) > ratio.mean


def test_mappers_that_cannot_be_told_apart_share_a_place() -> None:
    names = ("folding", "basic", "enhancement-i", "enhancement-ii")
    table = league(",".join(names), GRIDS)
    costs = [(20, 20, 20), (19, 24, 20), (30, 30, 30), (31, 35, 30)]
    for mapper, row in zip(names, costs, strict=True):
        for world, cost in zip(GRIDS.worlds(0), row, strict=True):
            enter(table, mapper, world, cost)
    entries = table.entries()
    assert [(e.mapper, e.place) for e in entries] == list(zip(names, (1, 1, 3, 3), strict=True))
    # The last one is compared with the first of its place, and clearly worse than the table's.
    assert entries[-1].behind is not None
    assert some(entries[-1].behind.low) > 0


def test_the_worlds_in_which_a_mapper_lost_most_come_with_a_command() -> None:
    table = dataclasses.replace(league("basic,folding", SMALL), limits=Limits(budget=90))
    worlds = SMALL.worlds(0)
    for number, world in enumerate(worlds):
        enter(table, "folding", world, 20)
        enter(table, "basic", world, 20 + {2: 5, 4: 30, 6: 5, 7: 5}.get(number, -1))
    first, second = table.entries()
    assert (first.mapper, first.losses) == ("folding", ())
    assert [(lost.world, lost.cost, lost.other, lost.excess) for lost in second.losses] == [
        (worlds[4], 50, 20, 3.0), (worlds[2], 25, 20, 0.5), (worlds[6], 25, 20, 0.5),
    ]  # fmt: skip
    assert second.losses[0].show == (
        f"topo-verify play {worlds[4]} --target folding --target basic -o basic-small-1.html"
        " --budget 90"
    )


@pytest.mark.parametrize("seed", range(3))
def test_the_first_failing_world_is_shown_whatever_was_finished_first(seed: int) -> None:
    table = league("basic,folding", SMALL, GRIDS)
    worlds = table.worlds_of(table.mappers[1])
    wrong = {worlds[4], worlds[7], worlds[-1]}
    Random(seed).shuffle(worlds)
    for world in worlds:
        enter(table, "folding", world, 20, wrong=world in wrong)
    entries = [entry for entry in table.entries() if entry.mapper == "folding"]
    assert [(e.suite, e.place, e.ratio, e.worlds) for e in entries] == [
        ("small", None, None, 5), ("grids", None, None, 0),
    ]  # fmt: skip
    assert {e.counterexample.world for e in entries if e.counterexample} == {"m2/2"}


def test_a_world_that_is_not_decided_costs_the_place() -> None:
    table = league("basic", GRIDS)
    for world in GRIDS.worlds(0):
        enter(table, "basic", world, 20)
    first = GRIDS.worlds(0)[0]
    row = table.rows["basic", first]
    table.rows["basic", first] = replace(row, undecided="too late")
    (entry,) = table.entries()
    assert (entry.place, entry.ratio, entry.worlds, entry.undecided) == (None, None, 2, 1)
    assert entry.why == (f"{first}: too late",)


@pytest.mark.parametrize("name", ["folding+planar", "homing+planar"])
def test_a_mapper_that_assumes_planar_worlds_plays_no_others(name: str) -> None:
    table = league(f"basic,{name}", SMALL, GRIDS)
    assert table.worlds_of(table.mappers[1]) == GRIDS.worlds(0)
