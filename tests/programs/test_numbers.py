"""Numbers of 64 bits with a sign are taken from every kind of mapper and file; no others."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.programs.natives import built
from tests.programs.programs import python
from topo_verify import InputError, World, examine, extras
from topo_verify.campaign.targets import one_target
from topo_verify.programs.loader import Target, load
from topo_verify.robot.events import read_trace
from topo_verify.studies.search.search import search

IN_RANGE = (2**62 - 1, 2**62, 2**63 - 1, -(2**63))
BEYOND = (2**63, 2**64, -(2**63) - 1, 10**400)

STICK = World.from_id("m1/0")

USES = {
    "names a dart": set[str](),
    "reports a cost": {"cost-honest"},
    "declares a dart": {"no-false-confirm", "decisions-entailed"},
}
"""What a mapper uses a number for, and which claims fail if the number is in the range."""

NO_MAP = "map-isomorphic"
"""The claim that fails without a map, hence if the number is refused."""


def failing(target: Target) -> set[str]:
    return {name for name, status in examine(target, STICK).claims.items() if status == "failed"}


def require_right(use: str, number: int, failed: set[str]) -> None:
    if number in IN_RANGE:
        assert failed == USES[use]
    else:
        assert NO_MAP in failed


@pytest.fixture(params=USES)
def use(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(params=IN_RANGE + BEYOND, ids=lambda number: f"{number:+d}"[:24])
def number(request: pytest.FixtureRequest) -> int:
    return int(request.param)


# ---------------------------------------------------------------- what a mapper says


def declaration(number: int) -> dict[str, object]:
    return {"type": "confirm", "edge": number, "hypothesis": number, "rule": "motion"}


def delivery(use: str, number: int) -> dict[str, Any]:
    dart = number if use == "names a dart" else 1
    cost = number if use == "reports a cost" else 1
    return {"map": {"vertices": [[dart], [0]], "edges": [[dart, 0]], "marker": dart}, "cost": cost}


def python_mapper(folder: Path, use: str, number: int) -> str:
    said = delivery(use, number)
    declare = f"    robot.declare({declaration(number)})\n" * (use == "declares a dart")
    mapped = {**said["map"], "cost": said["cost"]}
    (folder / "mapper.py").write_text(
        f"def explore(robot):\n{declare}    robot.move(0)\n    return {mapped}\n"
    )
    return f"{folder / 'mapper.py'}:explore"


def program(use: str, number: int) -> str:
    move = json.dumps({"type": "move", "door": 0})
    if use == "declares a dart":
        move = json.dumps({"type": "declare", "event": declaration(number)}) + "\n" + move
    done = json.dumps({"type": "done", **delivery(use, number)})
    answer = "import sys\nfor line in sys.argv[1:]: sys.stdin.readline(); print(line, flush=True)"
    return python("-c", answer, move, done)


def library(folder: Path, use: str, number: int) -> str:
    source = folder / "mapper.c"
    cost = number if use == "reports a cost" else 1
    confirm = f"tv_confirm(r, {c(number)}, {c(number)}, TV_MOTION);" * (use == "declares a dart")
    source.write_text(
        '#include "topo_verify.h"\nvoid map_world(const tv_robot *r) {\n'
        f"  int64_t degrees[] = {{1, 1}}, ends[] = {{1, 0}};\n  {confirm}\n  tv_move(r, 0);\n"
        f"  tv_deliver(r, 2, degrees, ends, 0, {c(cost)});\n}}\n"
    )
    return built(folder, source=source)


def c(number: int) -> str:
    return f"((int64_t){number % 2**64}u)"


# ---------------------------------------------------------------- the ways


def test_in_the_same_process(tmp_path: Path, use: str, number: int) -> None:
    text = python_mapper(tmp_path, use, number)
    require_right(use, number, failing(Target(text, load(text))))


def test_behind_the_pipe(tmp_path: Path, use: str, number: int) -> None:
    require_right(use, number, failing(one_target(python_mapper(tmp_path, use, number))))


def test_in_a_program(use: str, number: int) -> None:
    require_right(use, number, failing(one_target(program(use, number))))


@pytest.mark.parametrize("use", ["reports a cost", "declares a dart"])
@pytest.mark.parametrize("number", IN_RANGE)
def test_in_a_library(tmp_path: Path, use: str, number: int) -> None:
    text = library(tmp_path, use, number)
    require_right(use, number, failing(one_target(text)))


@pytest.mark.long
@pytest.mark.skipif(not extras.usable_engines(), reason="numba is not installed")
@pytest.mark.parametrize("use", ["reports a cost", "declares a dart"])
@pytest.mark.parametrize("number", [2**63 - 1, -(2**63)])
def test_in_a_library_that_the_compiled_engine_calls(tmp_path: Path, use: str, number: int) -> None:
    entry = search(library(tmp_path, use, number), edges=1, engine="compiled")
    assert USES[use] <= {claim.claim for claim in entry.claims}


def test_in_the_file_of_a_trace(use: str, number: int) -> None:
    said = delivery(use, number)
    start = {"type": "start", "format": "topo-verify/trace", "version": 1}
    events = [
        {**start, "percept": {"degree": 1, "marker": 0}},
        *[declaration(number)] * (use == "declares a dart"),
        {"type": "finish", **said},
    ]
    text = "\n".join(map(json.dumps, events)).encode()
    if number in IN_RANGE:
        assert str(number) in str(read_trace(text)[-1 if use != "declares a dart" else 1])
    else:
        with pytest.raises(InputError):
            read_trace(text)


def test_in_the_file_of_a_world(number: int) -> None:
    drawn = delivery("names a dart", number)["map"]
    text = json.dumps({"format": "topo-verify/world", "version": 1, **drawn})
    if number in IN_RANGE:
        assert World.from_json(text).code == STICK.code
    else:
        with pytest.raises(InputError):
            World.from_json(text)
