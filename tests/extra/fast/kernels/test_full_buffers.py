"""A full buffer ends a run, or leaves a verdict open: with its name, and nothing beyond it.

Each buffer that has a capacity is made smaller and smaller (`fenced.py`). In the workspace a full
one ends the run with a reason of its own; in the judge it leaves the verdict open. Neither ever
gives another result.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

pytest.importorskip("numba", reason="the compiled engine needs numba")

from tests.extra.fast.kernels.fenced import JUDGE_CAPACITIES, Fenced, judged_within, run_within
from tests.extra.fast.kernels.judged import Run, by_judge, run_of
from tests.extra.fast.kernels.test_judge_fold import fold_of
from topo_verify import InputError, World
from topo_verify.extra.fast.kernels import explore, workspace
from topo_verify.extra.fast.kernels import workspace as ws
from topo_verify.extra.fast.kernels.events import POSE, spans
from topo_verify.extra.fast.kernels.explore import run_world
from topo_verify.extra.fast.kernels.folding import add_place, join_places, lay, start_fold
from topo_verify.extra.fast.kernels.judging import entailed, fold, layout

# ---------------------------------------------------------------- runs

RUNS = [
    ("CHART_DARTS", ws.FULL_CHART, "basic", "m4/73"),
    ("STEPS", ws.FULL_STEPS, "enhancement-iii-one", "m5/705"),
    ("STEPS", ws.FULL_STEPS, "enhancement-iii-all+i", "m8/408983"),
    ("RECORDS", ws.FULL_RECORDS, "enhancement-iii-one+i", "m8/408983"),
    ("RECORDS", ws.FULL_RECORDS, "enhancement-iii-all", "m8/408983"),
    ("PLACE_DARTS", ws.FULL_PLACES, "folding", "m4/41"),
    ("CHANGED", ws.FULL_PLACES, "folding", "m4/41"),
    ("LAYER_WORDS", ws.FULL_PLACES, "folding", "m4/41"),
    ("TRACE", ws.FULL_TRACE, "basic", "m3/9"),
]
"""A capacity, the reason that it gives, and a run that fills some of it."""


@pytest.mark.parametrize(("capacity", "reason", "algorithm", "place"), RUNS)
def test_a_run_is_itself_or_ends_for_the_buffer_that_is_full(
    capacity: str, reason: int, algorithm: str, place: str
) -> None:
    world = World.from_id(place)
    _, whole = run_within({}, world, algorithm)
    size = 1
    while (run := run_within({capacity: size}, world, algorithm)) != (0, whole):
        stop, trace = run
        assert stop == ws.STOP_FULL + reason
        assert trace == whole[: len(trace)]
        size += 1
    assert 1 < size < ws.CAPACITIES[capacity]


def test_every_capacity_of_the_workspace_has_a_run_that_fills_it() -> None:
    assert {capacity for capacity, *_ in RUNS} == ws.CAPACITIES.keys() - {"WORLD_DARTS"}


def test_a_budget_that_ends_at_the_same_time_does_not_hide_a_full_buffer() -> None:
    """S has grown by a false edge, and the robot is to go back before it goes on."""
    world, fault = World.from_id("m3/5"), "confirms-what-is-alone"
    stop, words = run_within({}, world, "basic", fault=fault, budget=3)
    assert stop == ws.STOP_BUDGET
    full = {"TRACE": len(words) - 1}
    stop, _ = run_within(full, world, "basic", fault=fault, budget=3)
    assert stop == ws.STOP_FULL + ws.FULL_TRACE


@pytest.mark.parametrize(
    ("reason", "said"),
    [
        (ws.FULL_CHART, "for the map S: use the reference engine"),
        (ws.FULL_STEPS, "for the sequences behind one edge: use the reference engine"),
        (ws.FULL_RECORDS, "for the records T: use the reference engine"),
        (ws.FULL_PLACES, "for the places that were seen: use the reference engine"),
    ],
)
def test_a_run_that_fills_the_largest_layout_is_refused_in_words(
    monkeypatch: pytest.MonkeyPatch, reason: int, said: str
) -> None:
    def full(_job: explore.CompiledJob, layout: workspace.WordLayout, room: int) -> Any:
        space = explore.workspace(layout, room)
        space[layout.at("stop")] = ws.STOP_FULL + reason
        return space

    monkeypatch.setattr(explore.CompiledJob, "run", full)
    with pytest.raises(InputError, match=f"the run of folding needs more room .* {said}"):
        run_world(World.from_id("m4/41"), "folding")


# ---------------------------------------------------------------- verdicts


JUDGED = [
    ("JUDGE_STEPS", "enhancement-iii-all", "m8/408983"),  # doors of an excursion
    ("JUDGE_STEPS", "folding", "m8/6719310"),  # rejections
    ("JUDGE_ARENA", "enhancement-iii-all", "m7/100000"),
    ("JUDGE_SEQUENCES", "enhancement-iii-all", "m7/100000"),
    ("JUDGE_NODES", "basic", "m4/73"),
    ("JUDGE_DOORS", "folding", "m3/38"),
]
"""A capacity of the judge, and a run that fills some of it."""


def least_room(capacity: str, run: Run, least: int) -> int:
    """The least capacity with which the verdict is not open: then it is as with all of it."""
    size = least
    while (found := judged_within({capacity: size}, run)) is None:
        size += 1
    assert found == by_judge(run)
    return size


@pytest.mark.parametrize(("capacity", "algorithm", "place"), JUDGED)
def test_a_verdict_is_itself_or_open(capacity: str, algorithm: str, place: str) -> None:
    run = run_of(World.from_id(place), algorithm, algorithm)
    assert 1 < least_room(capacity, run, 1) < JUDGE_CAPACITIES[capacity]


def test_a_hypothesis_that_is_no_dart_of_the_world_may_leave_the_verdict_open() -> None:
    """A set of hypotheses is a mask; it has a place for every dart of the world, and a few more."""
    run, darts = run_of(World.from_id("m4/73"), "basic", "basic"), 8
    words = list(run.events)
    at = next(at for at, _ in spans(words) if words[at] == POSE and words[at + 2] > 0)
    words[at + 3] = 20
    assert least_room("JUDGE_DARTS", replace(run, events=tuple(words)), darts + 2) == 23


def test_every_capacity_of_the_judge_has_a_run_that_fills_it() -> None:
    assert {capacity for capacity, *_ in JUDGED} == JUDGE_CAPACITIES.keys() - {"JUDGE_DARTS"}


# ---------------------------------------------------------------- kernels by themselves


def square() -> layout.CaseWords:
    """A judge's fold of four crossings, of which 0 leads to 2, and 1 to 3."""
    case = layout.CaseWords(fold_of((2, 2, 2, 2)))
    fold.join_ends(case.fold, 0, 0, 2, 0)
    fold.join_ends(case.fold, 1, 0, 3, 0)
    return case


def test_the_fold_of_a_run_has_no_room_for_more_pairs_than_darts() -> None:
    words = workspace.CAPACITIES["PLACE_DARTS"]
    for room, stop in ((words - 2, 0), (words - 1, ws.STOP_FULL + ws.FULL_PLACES)):
        space = ws.RunWords([0] * ws.SMALL.at("trace.word"))
        start_fold(space)
        a, b, c, d = (add_place(space, 2 * ws.P, 0) for _ in range(4))
        join_places(space, a, c)
        join_places(space, b, d)
        assert lay(space, a, b, room, 0) == (room if stop else room + 2)
        assert space.stop == stop


def test_the_fold_of_the_judge_has_no_room_for_more_pairs(monkeypatch: pytest.MonkeyPatch) -> None:
    for doors, is_full in ((8, 0), (7, 1)):
        case = square()
        monkeypatch.setattr(fold, "JUDGE_DOORS", doors)
        fold.make_one(case.fold, 0, 0, 1, 0)
        assert case.full == is_full


def test_a_fold_with_more_darts_than_a_mask_is_not_laid_out() -> None:
    assert fold.lay_out(fold_of((31, 31))) == 62
    assert fold.lay_out(fold_of((31, 32))) == -1


def test_s_on_the_fold_has_no_more_darts_than_a_mask() -> None:
    case = layout.CaseWords(fold_of((32, 33)))
    for node, added, is_full in ((0, True, 0), (0, True, 0), (0, False, 1)):
        assert entailed.add_vertex_on_fold(case, node, 0) is added
        assert case.full == is_full


def test_what_follows_has_no_room_for_more_ends_or_pairs() -> None:
    most = JUDGE_CAPACITIES["JUDGE_DOORS"]
    for field, full in (("entries", most), ("waiting", most - 1)):
        for number, is_full in ((full - 1, 0), (full, 1)):
            case = square()
            fold.start_consequences(case)
            setattr(case.consequences, field, number)
            for node in (2, 3):  # the second end behind a dart is one with the first
                fold.put_beyond(
                    case,
                    fold.slot_at(case.fold, 0, 1),
                    fold.slot_at(case.fold, node, 1),
                )
            assert case.full == is_full


# ---------------------------------------------------------------- the fences


def test_a_fence_is_seen_where_a_word_is_read_or_written() -> None:
    words = Fenced([1, 2, 3], [range(1, 2)])
    assert (words[0], words[2]) == (1, 3)
    with pytest.raises(AssertionError, match="word 1 is read, beyond a capacity"):
        words[1]
    with pytest.raises(AssertionError, match="word 1 is written, beyond a capacity"):
        words[1] = 4
