"""A trace that several mappers leave in one world is checked once, and only that very trace."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest

from tests.helpers import trace_of, typed
from topo_verify import World, explore
from topo_verify.algorithms import NAMED
from topo_verify.campaign import judge as judging
from topo_verify.campaign.judge import CheckedTraces, judge
from topo_verify.checkers import check
from topo_verify.errors import InputError
from topo_verify.robot.events import Event, Finish, Move, Start

WORLD = World.from_id("m3/14")

TRACE = trace_of("m3/14", "basic")


@pytest.fixture
def checked(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """The traces that were really checked."""
    traces: list[object] = []

    def counting(world: World, trace: Any, stopped: str | None, *, strict: bool) -> object:
        traces.append(trace)
        return check(world, trace, stopped, strict=strict)

    monkeypatch.setattr(judging, "check", counting)
    return traces


def test_reports_are_the_same_and_fewer_traces_are_checked(checked: list[object]) -> None:
    runs = [explore(WORLD, name) for name in NAMED]
    known = CheckedTraces()
    assert [judge(run, known=known) for run in runs] == [judge(run) for run in runs]
    distinct = {msgspec.json.encode(run.trace[1:]) for run in runs}
    assert len(checked) == len(distinct) + len(runs)
    assert len(distinct) < len(runs)


def test_of_the_start_only_the_percept_is_compared(checked: list[object]) -> None:
    start = typed(Start, TRACE[0])
    known = CheckedTraces()
    for algorithm in ("basic", "another"):
        renamed = msgspec.structs.replace(start, algorithm=algorithm)
        known(WORLD, (renamed, *TRACE[1:]), strict=False)
    assert len(checked) == 1
    percept = msgspec.structs.replace(start.percept, degree=start.percept.degree + 1)
    lie = msgspec.structs.replace(start, percept=percept)
    (first, *_) = known(WORLD, (lie, *TRACE[1:]), strict=False)
    assert (first.claim, first.status, len(checked)) == ("percepts-true", "failed", 2)


def _with_another_end(trace: tuple[Event, ...]) -> tuple[Event, ...]:
    finish = typed(Finish, trace[-1])
    return (*trace[:-1], msgspec.structs.replace(finish, cost=1.0))


class NamedMove(Move, frozen=True, tag="move"):  # type: ignore[misc]  # pyright: ignore[reportGeneralTypeIssues]  what Python lets pass
    """A move of another type, written in the same way."""


def _with_another_type(trace: tuple[Event, ...]) -> tuple[Event, ...]:
    place = next(place for place, event in enumerate(trace) if isinstance(event, Move))
    move = typed(Move, trace[place])
    other = NamedMove(move.door, move.percept, move.purpose)
    return (*trace[:place], other, *trace[place + 1 :])


def _without_its_end(trace: tuple[Event, ...]) -> tuple[Event, ...]:
    return trace[:-1]


@pytest.mark.parametrize("changed", [_without_its_end, _with_another_end, _with_another_type])
def test_any_other_trace_is_checked(checked: list[object], changed: Any) -> None:
    known = CheckedTraces()
    for trace in (TRACE, changed(TRACE)):
        assert known(WORLD, trace, strict=False) == check(WORLD, trace)
    assert len(checked) == 2


def test_worlds_and_reasons_and_strictness_are_compared(checked: list[object]) -> None:
    known = CheckedTraces()
    for world, stopped, strict in (
        (WORLD, None, False),
        (WORLD, "it raised", False),
        (WORLD, None, True),
        (World.from_id("m3/13"), None, False),
    ):
        known(world, TRACE[:-1], stopped, strict=strict)
    assert len(checked) == 4


class Anything:
    """Equal to everything, and nothing that can be written."""

    def __eq__(self, other: object) -> bool:
        return True

    __hash__ = None  # type: ignore[assignment]  # pyright: ignore[reportAssignmentType]  as with `__eq__` alone


def test_what_cannot_be_written_is_checked_each_time(checked: list[object]) -> None:
    known = CheckedTraces()
    known(WORLD, TRACE, strict=False)
    strange: Any = (*TRACE[:-1], Anything(), TRACE[-1])
    for _ in range(2):
        with pytest.raises(InputError, match="expected an event"):
            known(WORLD, strange, strict=False)
    assert len(checked) == 3
