"""Running a mapper: whatever it does, it is a finding and never a crash."""

from __future__ import annotations

import asyncio
import json
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, cast

import pytest

from tests.helpers import path, typed
from topo_verify import CATALOGUE, InputError, Limits, Robot, World, examine, explore
from topo_verify.algorithms import Policies
from topo_verify.campaign.judge import judge, undecided
from topo_verify.campaign.targets import one_target
from topo_verify.robot import simulator
from topo_verify.robot.events import (
    Augment,
    Event,
    Finish,
    Move,
    Pose,
    Start,
    read_trace,
    write_trace,
)
from topo_verify.robot.limits import BudgetExceeded, WorldTimeout

HERE = Path(__file__).relative_to(Path.cwd())

WORLD = World.from_id("m2/5")
SHORT = Limits(move_timeout=0.15, world_timeout=600)

Mapper = Callable[[Robot], object]


def right(robot: Robot) -> object:
    """A mapper of one's own that is right, and declares its decisions."""
    return CATALOGUE["basic"](robot)


def mistaken(_robot: Robot) -> object:
    """A mapper that is sure that every world is a single edge."""
    return {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}


def delivers(result: object) -> Mapper:
    """A mapper that explores and then delivers something else."""

    def mapper(robot: Robot) -> object:
        right(robot)
        return result

    return mapper


NO_DOOR = "the mapper asked for door 9 at a vertex with 3 doors; the first is 0; it was at {}"


def line(mapper: Callable[..., object], behind: int = 1) -> str:
    """File and line of the mapper, `behind` lines after its `def`."""
    number = mapper.__code__.co_firstlineno + behind
    return f"{Path(__file__).relative_to(Path.cwd())}, line {number}"


def why(mapper: Mapper, limits: Limits | None = None) -> str:
    """Why no map was delivered: the one thing that is wrong with this mapper."""
    report = examine(mapper, WORLD, limits=limits)
    assert not report.ok
    assert report.claims["map-isomorphic"] == "failed"
    assert json.loads(report.to_json())["ok"] is False
    (message,) = (f.message for f in report.findings if f.claim == "map-isomorphic")
    assert message.startswith("no map was delivered: ")
    return message.removeprefix("no map was delivered: ")


class Unspeakable(Exception):
    """An exception that cannot be put into words."""

    def __str__(self) -> str:
        raise RuntimeError


# ---------------------------------------------------------------- a run


def test_a_run_knows_its_cost_its_map_and_everything_that_happened() -> None:
    run = explore(WORLD, "enhancement-ii")
    assert (run.world, run.algorithm, run.policies) == (WORLD, "enhancement-ii", Policies())
    assert (run.cost, run.stopped, run.error, run.limit) == (2, None, None, None)
    assert run.map is not None
    assert World.from_map(run.map).code == WORLD.code
    start, finish = run.trace[0], run.trace[-1]
    assert isinstance(start, Start)
    assert isinstance(finish, Finish)
    assert (start.algorithm, start.policies, start.world) == ("enhancement-ii", Policies(), "m2/5")
    assert (finish.map, finish.cost) == (run.map, 2)


def test_a_run_counts_hypotheses_by_how_they_ended() -> None:
    run = explore(World.from_id("m5/434"), "enhancement-iii-all")
    assert (run.rejected_free, run.rejected_moving, run.confirmed) == (1, 3, 2)


def test_the_default_is_the_basic_algorithm_with_the_reference_policies() -> None:
    assert explore(WORLD).trace == explore(WORLD, "basic").trace


def test_policies_are_those_of_the_command_line() -> None:
    run = explore(World.from_id("m3/8"), "basic", pick="last", order="newest")
    assert run.policies == Policies("last", "newest")
    assert run.trace != explore(World.from_id("m3/8")).trace


def test_an_algorithm_a_function_and_a_target_are_all_mappers() -> None:
    for mapper in (CATALOGUE["basic"], right, one_target("basic")):
        assert explore(WORLD, mapper).cost == 2
    assert explore(WORLD, right).policies is None


def test_a_large_world_has_no_id_in_its_trace() -> None:
    start = typed(Start, explore(path(250, marker=0)).trace[0])
    assert start.world is None


@pytest.mark.parametrize("mapper", ["basic,enhancement-i", "all", "nobody", "basic:", 7, None])
def test_what_is_not_one_mapper_is_refused(mapper: Any) -> None:
    with pytest.raises(InputError):
        explore(WORLD, mapper)


# ---------------------------------------------------------------- mappers that misbehave


def test_a_mapper_that_raises_is_a_finding_with_its_exception() -> None:
    def fail(_robot: Robot) -> object:
        raise KeyError("dart 7")

    line = fail.__code__.co_firstlineno + 1
    assert why(fail) == f"the mapper raised KeyError: 'dart 7' ({HERE}, line {line})"
    assert isinstance(explore(WORLD, fail).error, KeyError)


def test_a_mapper_that_exits_is_a_finding() -> None:
    assert why(lambda _robot: sys.exit(3)).startswith("the mapper raised SystemExit: 3 (")


@pytest.mark.parametrize(
    "kind", [asyncio.CancelledError, GeneratorExit, BaseException, Unspeakable]
)
def test_an_exception_of_any_kind_is_named(kind: type[BaseException]) -> None:
    def fail(_robot: Robot) -> object:
        raise kind

    assert why(fail).startswith(f"the mapper raised {kind.__name__} ({HERE}, line ")


def test_what_ends_a_test_passes_through_a_mapper() -> None:
    with pytest.raises(pytest.skip.Exception):
        explore(WORLD, lambda _robot: pytest.skip("not here"))


def test_a_mapper_that_recurses_for_ever_is_a_finding() -> None:
    def deep(robot: Robot) -> object:
        return deep(robot)

    assert why(deep).startswith("the mapper raised RecursionError: ")


def test_ctrl_c_is_not_the_mappers() -> None:
    def interrupted(_robot: Robot) -> object:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        examine(interrupted, WORLD)


def test_a_mapper_that_walks_for_ever_ends_with_its_budget() -> None:
    def walk(robot: Robot) -> object:
        while True:
            robot.move(0)

    run = explore(WORLD, walk)
    bound = 2 * (2 + 3 * 2)
    assert (run.cost, run.limit) == (bound, "budget")
    assert run.stopped == str(BudgetExceeded(bound))
    assert explore(WORLD, walk, limits=Limits(budget=5)).cost == 5


def test_a_mapper_that_declares_nonsense_is_a_finding() -> None:
    def boast(robot: Robot) -> object:
        robot.declare(cast("Any", {"type": "boast"}))
        return WORLD

    expected = "expected a decision (pose, reject, confirm, augment), got boast: "
    assert why(boast).startswith(expected)
    assert why(boast).endswith(f"; it was at {line(boast)}")


@pytest.mark.parametrize("nap", [lambda: time.sleep(30), lambda: [None for _ in iter(int, 1)]])
def test_a_mapper_that_sleeps_or_loops_without_moving_is_stopped(nap: Callable[[], object]) -> None:
    run = explore(WORLD, lambda _robot: nap(), limits=SHORT)
    assert run.stopped == f"the mapper did not move for 0.15 s; it was at {line(nap, 0)}"
    assert run.limit == "move-timeout"


def test_a_mapper_that_keeps_moving_too_slowly_is_stopped() -> None:
    def slow(robot: Robot) -> object:
        while True:
            time.sleep(0.01)
            robot.move(0)

    run = explore(WORLD, slow, limits=Limits(budget=10**6, move_timeout=600, world_timeout=0.3))
    assert str(run.stopped).startswith("the mapper was stopped after 0.3 s in this world; it was ")
    assert run.limit == "world-timeout"


def test_a_mapper_is_stopped_in_another_thread_too() -> None:
    reasons: list[str] = []

    def loop(_robot: Robot) -> object:
        while True:
            pass

    thread = threading.Thread(target=lambda: reasons.append(why(loop, SHORT)))
    thread.start()
    thread.join()
    (reason,) = reasons
    assert reason.startswith("the mapper did not move for 0.15 s; it was at ")


@pytest.mark.parametrize("caught", [Exception, BaseException])
def test_a_mapper_that_swallows_what_stops_it_has_not_delivered(
    caught: type[BaseException],
) -> None:
    def swallow(robot: Robot) -> object:
        with suppress(caught):
            robot.move(9)
        return WORLD

    assert why(swallow) == NO_DOOR.format(line(swallow, 2))


def test_a_mapper_that_swallows_what_stops_it_and_then_raises_is_stopped_for_the_first_reason() -> (
    None
):
    def swallow(robot: Robot) -> object:
        with suppress(BaseException):
            robot.move(9)
        raise ValueError("lost")

    run = explore(WORLD, swallow)
    assert run.stopped == NO_DOOR.format(line(swallow, 2))
    assert isinstance(run.error, ValueError)


def test_a_limit_that_strikes_in_the_middle_of_a_move_convicts_nobody(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    recorded = simulator.shared_move

    def strikes(*move: Any) -> Event:
        strikes_at.append(0)
        if len(strikes_at) == 5:
            raise WorldTimeout("the mapper was stopped after 60 s in this world")
        return recorded(*move)

    strikes_at: list[int] = []
    monkeypatch.setattr(simulator, "shared_move", strikes)
    run = explore(World.from_id("m4/41"), "basic")
    monkeypatch.undo()
    report = judge(run)
    assert (run.limit, run.cost, report.cost) == ("world-timeout", 4, 4)
    assert {finding.claim for finding in report.findings} == {"map-isomorphic"}
    assert undecided(run, report)


def test_a_mapper_that_swallows_its_time_limit_has_not_delivered() -> None:
    def swallow(_robot: Robot) -> object:
        with suppress(BaseException):
            time.sleep(30)
        return WORLD

    assert why(swallow, SHORT).startswith("the mapper did not move for 0.15 s")


def test_what_was_declared_and_moved_before_the_end_is_still_judged() -> None:
    def fail(robot: Robot) -> object:
        robot.move(0)
        robot.declare(Pose(0, ()))
        raise ValueError

    report = examine(fail, WORLD)
    assert report.cost == 1
    assert report.claims["percepts-true"] == "ok"
    assert report.claims["true-hypothesis-posed"] == "failed"


def test_on_request_a_run_ends_at_its_first_false_augmentation() -> None:
    true, false = Augment(0, "loop", 2, 3), Augment(1, "new", 3, 4)

    def guess(robot: Robot) -> object:
        robot.declare(true)
        robot.declare(false)
        while True:
            robot.move(0)

    run = explore(WORLD, guess, stop_if_false=True)
    assert (run.trace[1:], run.cost, run.limit) == ((true, false), 0, None)
    assert (
        run.stopped == "its 'augment' at event 2 is false: the run ended there (a replay goes on)"
    )
    assert explore(WORLD, guess).limit == "budget"
    for algorithm in ("basic", "folding"):
        assert explore(WORLD, algorithm, stop_if_false=True) == explore(WORLD, algorithm)


def test_a_wrong_cost_is_a_finding() -> None:
    world = {"vertices": WORLD.vertices, "edges": WORLD.edges, "marker": WORLD.marker}
    report = examine(delivers({**world, "cost": 3}), WORLD)
    assert [finding.claim for finding in report.findings] == ["cost-honest"]
    assert json.loads(report.to_json())["findings"][0]["seen"] == 3


def test_the_trace_of_a_mapper_that_failed_can_be_written_and_read() -> None:
    def fail(robot: Robot) -> object:
        robot.move(1)
        return robot.move(9)

    trace = explore(WORLD, fail).trace
    assert [type(event) for event in trace] == [Start, Move]
    assert read_trace(write_trace(trace)) == trace
