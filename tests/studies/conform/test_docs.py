"""docs/oracle.md and docs/reference/programs.md: conversations, kinds of findings, figures."""

from __future__ import annotations

import re
from typing import get_args

import msgspec

from tests.programs.programs import ROOT, served
from topo_verify import World, explore
from topo_verify.checkers import CLAIMS
from topo_verify.programs import protocol as ms
from topo_verify.programs.misbehaviour import MISBEHAVIOURS
from topo_verify.programs.program import IN_A_ROW, Program
from topo_verify.robot.limits import Limit
from topo_verify.studies.conform.conform import MOST_TIMEOUTS
from topo_verify.studies.corpus import corpus_from
from topo_verify.world.formats import world_json

PAGE = (ROOT / "docs" / "oracle.md").read_text()
PROGRAMS = (ROOT / "docs" / "reference" / "programs.md").read_text()

BLOCKS = [block.splitlines() for block in re.findall(r"```\n(.*?)```", PROGRAMS, re.DOTALL)]


def test_the_conversation_is_the_one_that_takes_place() -> None:
    with Program(served("basic").removeprefix("--cmd "), record=True) as player:
        explore(World.from_id("m1/0"), player.target)
        said = [f"{way} {line.decode()}" for way, line in player.lines if b"declare" not in line]
    assert BLOCKS[0] == said


def test_the_batch_is_the_one_that_takes_place() -> None:
    world, run = BLOCKS[1]
    task = ms.BatchTask("m1/0", world_json.to_data(next(iter(corpus_from(["edges<=1"]))).world))
    assert world == f"> {msgspec.json.encode(task).decode()}"
    assert msgspec.json.encode(msgspec.json.decode(run[2:], type=ms.BatchRun)).decode() == run[2:]


def test_every_kind_of_finding_is_explained() -> None:
    rows = re.findall(r"^\| (`[^|]+?) \|", PROGRAMS, re.MULTILINE)
    explained = {kind for row in rows for kind in re.findall(r"`([a-z0-9-]+)`", row)}
    limits = set(get_args(Limit)) - {"world-timeout"}  # that one is not decided
    ours = {*MISBEHAVIOURS, *limits, "no-map", "worker-lost", "decisions"} - {"skip", "error"}
    assert ours <= explained
    assert not explained & CLAIMS.keys()


def test_the_figures_are_those_of_the_code() -> None:
    assert f"After {MOST_TIMEOUTS} time-outs" in PAGE
    assert f"at most {IN_A_ROW:,} between two moves" in PROGRAMS
    assert f"the {corpus_from([]).total} worlds of the default corpus" in PAGE
