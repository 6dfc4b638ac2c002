"""What a baseline keeps of a run, and what it takes two runs to differ in."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pytest

from tests.faults.every import EVERY
from tests.programs.programs import deadly, served
from tests.studies.baseline.recording import recording
from topo_verify import CATALOGUE, Robot
from topo_verify.campaign.attempt import Attempt, row_of
from topo_verify.campaign.campaign import MAX_TIMEOUTS
from topo_verify.campaign.judge import examine
from topo_verify.campaign.run import explore
from topo_verify.campaign.targets import one_target
from topo_verify.faults.fault import ForwardingRobot
from topo_verify.programs.loader import Mapper
from topo_verify.programs.program import Program
from topo_verify.robot.events import Augment, Confirm, Decision, Event, Evidence, Move, Pose, Reject
from topo_verify.robot.limits import Limits
from topo_verify.robot.percept import Door, Percept, Purpose
from topo_verify.studies.baseline import record as study
from topo_verify.studies.baseline.file import BaselineEntry
from topo_verify.world.rooted_map import World

WORLD = World.from_id("m9/67076232")
"""A world in which enhancement-i rejects without motion what basic walks for."""


class Purposeless(ForwardingRobot):
    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:
        del purpose
        return super().move(door)


class Vague(ForwardingRobot):
    """Rejects for another reason, in words that differ."""

    def declare(self, event: Decision) -> None:
        if isinstance(event, Reject):
            evidence = {"step": 0, "expected": [1, None], "observed": [1, None]}
            told = {"type": "reject", "edge": event.edge, "hypothesis": event.hypothesis}
            evidence |= {name: {"degree": 1, "marker": None} for name in ("expected", "observed")}
            self.robot.declare({**told, "rule": event.rule, "evidence": evidence})  # type: ignore[arg-type]  # its JSON  # pyright: ignore[reportArgumentType]
        else:
            self.robot.declare(event)


def seen(mapper: Mapper | str, world: World = WORLD) -> BaselineEntry:
    (row,) = study.baseline_runs(one_target(mapper), [("here", world)], 1).rows(0)
    return study.entry_of(row, world)


def test_the_cost_and_the_map_are_those_of_the_run() -> None:
    entry = seen("basic")
    assert (entry.cost, entry.map, entry.failed, entry.undecided) == (64, WORLD.id, (), False)
    assert (entry.world, entry.name) == (WORLD.id, "here")


def test_another_algorithm_has_other_moves_and_other_decisions() -> None:
    basic, other = seen("basic"), seen("enhancement-i")
    assert basic.moves != other.moves
    assert basic.decisions != other.decisions


def test_the_purpose_of_a_move_and_the_evidence_are_no_decisions() -> None:
    basic = seen("basic")
    assert seen(lambda robot: CATALOGUE["basic"](Purposeless(robot))) == basic
    other = seen(lambda robot: CATALOGUE["basic"](Vague(robot)))
    assert (other.moves, other.decisions) == (basic.moves, basic.decisions)
    assert other.failed == ("rejection-justified",)


EVIDENCE = Evidence(1, Percept(2, None), Percept(3, None))
DECIDED: tuple[tuple[Decision, dict[str, Any]], ...] = (
    (Pose(4, (5, 6)), {"edge": 3, "hypotheses": (5,)}),
    (Reject(4, 5, "motion", EVIDENCE), {"edge": 3, "hypothesis": 6, "rule": "prefix"}),
    (Confirm(4, 6, "motion"), {"edge": 3, "hypothesis": 5, "rule": "folding"}),
    (Augment(4, "new", 7, 2), {"edge": 3, "kind": "loop", "dart": 8, "degree": 1}),
)
"""Decisions, and other values of each field that is a part of one."""


def decisions(*events: Event) -> str | None:
    """The hash of the decisions among these events."""
    run = replace(explore(WORLD, "basic"), trace=events)
    report = examine("basic", WORLD)
    return row_of(Attempt(run, report), "here", 0).decisions


@pytest.mark.parametrize(("event", "others"), DECIDED)
def test_every_field_of_a_decision_counts_and_so_does_its_moment(
    event: Decision, others: dict[str, Any]
) -> None:
    move = Move(0, Percept(2, None))
    hashes = {decisions(event), decisions(move, event), decisions(event, event)}
    for name, value in others.items():
        hashes.add(decisions(msgspec.structs.replace(event, **{name: value})))
    assert len(hashes) == 3 + len(others)
    assert decisions(event, move) == decisions(event)
    assert {*others} | {"evidence"} >= {*event.__struct_fields__}


def test_a_mapper_that_declares_nothing_has_moves_alone() -> None:
    basic, other = seen("basic"), seen(EVERY["declares-nothing"])
    assert other.decisions is None
    assert other.moves == basic.moves


def test_a_map_that_is_wrong_is_kept_and_what_is_no_map_is_none() -> None:
    def guess(_robot: Robot) -> object:
        return {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}

    def nonsense(_robot: Robot) -> object:
        return {"vertices": [[0], [1]], "edges": [[0, 7]], "marker": 0}

    def nothing(_robot: Robot) -> object:
        raise ValueError

    assert seen(guess).map == "m1/0"
    assert "map-isomorphic" in seen(guess).failed
    assert seen(nonsense).map is None
    assert seen(nothing).map is None


def test_a_mapper_that_hangs_is_given_up_after_a_few_time_outs() -> None:
    def hang(_robot: Robot) -> object:
        while True:
            pass

    limits = Limits(move_timeout=0.06)
    made = recording(one_target(hang), "edges<=2", limits=limits)
    assert len(made.entries) == MAX_TIMEOUTS < made.header.total == 12
    assert {entry.failed for entry in made.entries} == {("map-isomorphic",)}


# ---------------------------------------------------------------- programs

PROGRAM = """
import json, sys
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "start" and message["percept"]["degree"] == 1:
        answer = {"type": "move", "door": 0}
    elif message["type"] == "start":
        answer = {"type": "skip", "why": "too hard"}
    elif message["type"] == "percept":
        ends = {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}
        answer = {"type": "done", "map": ends}
    else:
        break
    print(json.dumps(answer), flush=True)
"""


def test_a_program_is_recorded_and_a_world_that_it_skips_is_undecided(tmp_path: Path) -> None:
    path = tmp_path / "mapper.py"
    path.write_text(PROGRAM)
    with Program([sys.executable, str(path)]) as program:
        entries = recording(program.target, "edges<=1", "m2/0").entries
    assert [entry.right for entry in entries] == [True, False, False]
    assert [entry.undecided for entry in entries] == [False, True, False]
    assert "map-isomorphic" in entries[2].failed


@pytest.mark.parametrize(
    ("deed", "once", "failed", "undecided"),
    [
        ("os.kill(os.getpid(), 9)", True, (), True),
        ("os.kill(os.getpid(), 9)", False, ("map-isomorphic",), False),
        ("os.abort()", True, ("map-isomorphic",), False),
    ],
)
def test_a_program_that_is_killed_is_tried_again(
    tmp_path: Path, deed: str, once: bool, failed: tuple[str, ...], undecided: bool
) -> None:
    target = one_target(served(deadly(tmp_path, deed, once=once)))
    first, second = recording(target, "edges<=1").entries
    assert first.right
    assert (second.failed, second.undecided) == (failed, undecided)


def test_a_finding_of_a_program_is_shown_again_by_conform() -> None:
    with Program("./mapper --fast") as program:
        line = study.replay_command(program.target, "m3/13", Limits(budget=9))
    assert line == "topo-verify conform --cmd './mapper --fast' --worlds m3/13 --budget 9"


@pytest.mark.parametrize("policies", [{}, {"pick": "last"}])
def test_a_finding_of_a_mapper_is_shown_again_by_replay(policies: dict[str, Any]) -> None:
    line = study.replay_command(one_target("basic", **policies), "m3/13", Limits())
    words = "".join(f" --{name} {value}" for name, value in policies.items())
    assert line == f"topo-verify replay m3/13 --target basic{words}"
