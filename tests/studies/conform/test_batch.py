"""Batch mode: worlds go out, runs come back, and are judged as any other."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.programs.programs import HERE, python
from tests.studies.conform.test_conform import standings
from topo_verify import World, explore
from topo_verify.errors import InputError
from topo_verify.programs import protocol as ms
from topo_verify.robot.events import Augment, Confirm, Move, Pose, Reject, Trace
from topo_verify.robot.limits import Limits
from topo_verify.studies.conform.batch import BatchReplay


def batch(way: str = "right") -> str:
    return python(HERE / "batch_program.py", way)


def test_runs_are_judged_on_every_level() -> None:
    found = standings(batch(), "edges<=3", "nyc", batch=True, like="basic")
    assert [(s.level, s.passed, s.verdict) for s in found.values()] == [
        (level, 87, "SAMPLED") for level in ("result", "claims", "decisions", "cost")
    ]


@pytest.mark.long
@pytest.mark.parametrize(
    ("way", "kind", "words"),
    [
        ("exits", "crashed", "ended with exit code 3 before it wrote a run for this world"),
        ("leaves out", "crashed", "ended with exit code 0"),
        pytest.param("hangs", "silent", "wrote no run for 4 s", marks=pytest.mark.nightly),
        ("garbage", "not-json", "spam"),
        ("half a line", "half-line", "in the middle of a line"),
        ("10 MB", "too-long", "a line of more than 1048576 bytes"),
        ("another id", "unknown-world", "expected the id of an unanswered world, got 'm9/9'"),
        ("twice", "unknown-world", "expected the end of the output, got another line"),
        ("no door", "bad-door", "door 99"),
        ("no map", "malformed", "expected 'map', 'skip' or 'error'"),
        ("late decision", "bad-declaration", "got 'after': 10000"),
        ("no decision", "bad-declaration", "$.declare"),
        ("too many doors", "budget", "more than 16 moves"),
        ("lies", "cost-honest", "reports a cost of"),
        ("another map", "map-isomorphic", "not isomorphic"),
    ],
)
def test_what_goes_wrong_in_one_world_is_found_there_alone(way: str, kind: str, words: str) -> None:
    # On a busy machine a program may take seconds to start: only the silent one has little time.
    limits = Limits(world_timeout=4) if way == "hangs" else Limits()
    result = standings(batch(way), "edges<=2", batch=True, limits=limits)["result"]
    assert result.passed == 11
    assert {found.world for found in result.findings} == {"m2/5"}
    assert result.findings[0].kind == kind
    assert words in result.findings[0].message


def test_a_world_may_be_skipped_or_given_up() -> None:
    for way in ("skip", "error"):
        result = standings(batch(way), "edges<=2", batch=True)["result"]
        assert (result.passed, result.skipped + result.errored) == (11, 1)
        assert result.verdict == "UNKNOWN"


def test_runs_may_come_in_any_order_and_all_at_the_end() -> None:
    found = standings(batch("backwards"), "edges<=3", batch=True, like="basic")
    assert found["decisions"].passed == 86


def test_a_world_that_stands_twice_in_the_corpus_is_run_twice() -> None:
    assert standings(batch(), "m1/0", "m1/0", batch=True)["result"].passed == 2


def test_batch_is_for_programs() -> None:
    with pytest.raises(InputError, match="name one with --cmd"):
        standings("basic", "m1/0", batch=True)


def test_what_was_said_is_kept(tmp_path: Path) -> None:
    standings(batch("lies"), "edges<=2", batch=True, transcript=str(tmp_path))
    (file,) = tmp_path.iterdir()
    assert '"cost\\":999' in file.read_text()


def as_run(trace: Trace, world: World) -> ms.BatchRun:
    doors: list[int] = []
    declared: list[ms.BatchDecision] = []
    for event in trace:
        if isinstance(event, Move):
            doors.append(event.door)
        elif isinstance(event, Pose | Reject | Confirm | Augment):
            declared.append(ms.BatchDecision(len(doors), event))
    found = explore(world, "basic").map
    return ms.BatchRun("x", tuple(doors), tuple(declared), found, len(doors))


def test_a_replay_is_the_run_again() -> None:
    world = World.from_id("m4/41")
    trace = explore(world, "basic").trace
    again = explore(world, BatchReplay(as_run(trace, world))).trace
    bare = [Move(e.door, e.percept) if isinstance(e, Move) else e for e in trace[1:]]
    assert list(again[1:]) == bare
