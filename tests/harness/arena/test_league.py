"""The table does not depend on the order of the runs, and is no place for a broken claim."""

from __future__ import annotations

from random import Random

import pytest

from topo_verify.checkers import CLAIMS, Finding
from topo_verify.harness.arena.league import League
from topo_verify.harness.arena.match import arena_job, play
from topo_verify.harness.arena.rows import ArenaResult, ArenaRun, ArenaTask, ClaimCount, MemoryRun
from topo_verify.harness.arena.suites import Suite, drawn, every
from topo_verify.harness.targets import targets
from topo_verify.robot.limits import Limits

SMALL = Suite("small", "a test", (every(2), drawn("lattice(3,3,holes=0.2)", 3, planar=True)))
GRIDS = Suite("grids", "a test", SMALL.families[1:])
HELD = tuple(ClaimCount("ok", 3, 3) for _ in CLAIMS)

Made = dict[ArenaTask, ArenaRun | MemoryRun]


def a_run(task: ArenaTask, cost: int, *, wrong: bool = False) -> ArenaRun:
    """A run that nobody made."""
    found = Finding("map-isomorphic", None, None, None, "wrong", replay="topo-verify replay x")
    return ArenaRun(
        mapper=task.mapper,
        world=task.world,
        edges=4,
        least=10,
        cost=cost,
        claims=HELD,
        findings=(found,) if wrong else (),
    )


def league(text: str, suites: tuple[Suite, ...], made: Made) -> League:
    return League(targets(text), suites, 0, made)


def test_places_follow_the_means_and_equal_ones_are_shared() -> None:
    made: Made = {}
    table = league("basic,folding,enhancement-i", (GRIDS,), made)
    for task in table.planned:
        noise = int(task.world.rpartition("=")[2].rstrip(")"))
        made[task] = a_run(task, (20 if task.mapper == "folding" else 30) + 5 * noise)
    entries = table.entries()
    assert [(e.mapper, e.place) for e in entries] == [
        ("folding", 1), ("basic", 2), ("enhancement-i", 2),
    ]  # fmt: skip
    behind, ratio = entries[1].behind, entries[1].ratio
    assert behind is not None
    assert ratio is not None
    # Paired: both pay more in the same worlds, so the difference has no spread at all.
    assert (behind.mapper, behind.mean, behind.low, behind.high) == ("folding", 1.0, 1.0, 1.0)
    assert ratio.high is not None
    assert ratio.high > ratio.mean


@pytest.mark.parametrize("seed", range(3))
def test_the_first_failing_world_is_shown_whatever_was_finished_first(seed: int) -> None:
    made: Made = {}
    table = league("basic,folding", (SMALL, GRIDS), made)
    tasks = [task for task in table.planned if task.mapper == "folding"]
    wrong = {tasks[4], tasks[7], tasks[-1]}
    Random(seed).shuffle(tasks)
    made.update((task, a_run(task, 20, wrong=task in wrong)) for task in tasks)
    entries = [entry for entry in table.entries() if entry.mapper == "folding"]
    assert [(e.suite, e.place, e.ratio, e.worlds) for e in entries] == [
        ("small", None, None, 5), ("grids", None, None, 0),
    ]  # fmt: skip
    assert {e.counterexample.world for e in entries if e.counterexample} == {"m2/2"}


def test_a_world_that_is_not_decided_costs_the_place() -> None:
    made: Made = {}
    table = league("basic", (GRIDS,), made)
    first, *others = table.planned
    made[first] = ArenaRun(
        mapper="basic", world=first.world, edges=4, least=10, undecided="too late"
    )
    made.update((task, a_run(task, 20)) for task in others)
    (entry,) = table.entries()
    assert (entry.place, entry.ratio, entry.worlds, entry.undecided) == (None, None, 2, 1)
    assert entry.why == (f"{first.world}: too late",)


@pytest.mark.parametrize("name", ["folding+planar", "homing+planar"])
def test_a_mapper_that_assumes_planar_worlds_plays_no_others(name: str) -> None:
    planned = league(f"basic,{name}", (SMALL, GRIDS), {}).planned
    mine = [task.world for task in planned if task.mapper == name]
    assert mine == GRIDS.worlds(0)


def test_of_a_wrong_mapper_no_run_is_made_behind_its_counterexample() -> None:
    made: Made = {}
    table = League(targets("topo_verify.faults:FAULTS.forgets-its-orientation"), (SMALL,), 0, made)

    def keep(result: ArenaResult) -> None:
        made[result.made.task] = result.made

    def tell(_what: str, _done: int, _total: int) -> None:
        pass

    job = arena_job(table.mappers, Limits(), in_process=True, identify=False)
    play(table, job, keep, workers=0, tell=tell)
    (entry,) = table.entries()
    assert entry.counterexample is not None
    assert list(made)[-1].world == entry.counterexample.world
    assert len(made) == entry.worlds < SMALL.size
