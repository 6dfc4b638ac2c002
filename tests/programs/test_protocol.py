"""The messages of protocol 1 and of the batch format, and their schemas."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema
import msgspec
import pytest

from tests.programs.programs import served
from tests.versions import older
from topo_verify import World, explore
from topo_verify.programs import protocol as ms
from topo_verify.programs.misbehaviour import Misbehaved, decoded
from topo_verify.programs.program import Program
from topo_verify.world.formats import world_json

SHELF = Path(ms.__file__).with_name("schemas")
WITH_NULL = {"from-program", "batch-run"}
"""The schemas in which something is an object or null."""


def validate(name: str, message: object) -> None:
    jsonschema.validate(message, ms.schema(name), cls=jsonschema.Draft202012Validator)


@pytest.mark.parametrize("name", ms.SCHEMAS)
def test_the_schemas_in_the_package_are_those_that_are_made(name: str) -> None:
    jsonschema.Draft202012Validator.check_schema(ms.schema(name))
    if name in WITH_NULL and older("msgspec", 0, 22):
        pytest.skip("msgspec before 0.22 names null first in anyOf: as good, but other bytes")
    made = json.dumps(ms.schema(name), indent=2) + "\n"
    assert (SHELF / f"{name}.schema.json").read_text() == made, "make them anew from the types"


def test_there_is_no_schema_of_nothing() -> None:
    ours = {path.name for path in SHELF.iterdir() if path.name != "baseline.schema.json"}
    assert ours == {f"{name}.schema.json" for name in ms.SCHEMAS}


@pytest.mark.long
def test_every_line_of_a_conversation_meets_its_schema() -> None:
    program = Program(served("basic").removeprefix("--cmd "), record=True)
    with program:
        explore(World.from_id("m4/41"), program.target)
    assert {json.loads(line)["type"] for _, line in program.lines} == {
        *("start", "percept", "move", "declare", "done")
    }
    for way, line in program.lines:
        validate("to-program" if way == ">" else "from-program", json.loads(line))


MAP: dict[str, Any] = {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}

RUNS: list[dict[str, Any]] = [
    {"id": "m1/0", "doors": [0], "map": MAP},
    {"id": "m1/0", "doors": [0], "map": MAP, "cost": 1, "declare": []},
    {
        "id": "m1/0",
        "doors": [0],
        "map": MAP,
        "declare": [{"after": 1, "event": {"type": "pose", "edge": 0, "hypotheses": []}}],
    },
    {"id": "m1/0", "skip": "too small"},
]


@pytest.mark.parametrize("run", RUNS)
def test_a_run_meets_its_schema(run: dict[str, Any]) -> None:
    validate("batch-run", run)
    msgspec.json.decode(json.dumps(run), type=ms.BatchRun)


def test_a_world_of_a_batch_meets_its_schema() -> None:
    task = ms.BatchTask("m5/17", world_json.to_data(World.from_id("m5/17")))
    validate("batch-world", json.loads(msgspec.json.encode(task)))


@pytest.mark.parametrize(
    "message",
    [
        {"type": "teleport"},
        {"type": "move"},
        {"type": "move", "door": "0"},
        {"type": "done"},
        {"type": "declare", "event": {"type": "start"}},
        [],
    ],
)
def test_the_schema_refuses_what_the_decoder_refuses(message: object) -> None:
    with pytest.raises(jsonschema.ValidationError):
        validate("from-program", message)
    with pytest.raises(msgspec.ValidationError):
        msgspec.json.decode(json.dumps(message), type=ms.FromProgram)


def unknown_fields(data: dict[str, Any]) -> list[str]:
    return list(ms.unknown_fields(data, msgspec.convert(data, ms.FromProgram)))


def test_fields_that_no_schema_lists_are_seen_wherever_they_stand() -> None:
    event: dict[str, object] = {"type": "pose", "edge": 0, "hypotheses": [], "why": ""}
    assert unknown_fields({"type": "move", "door": 0, "dor": 1}) == ["$.dor"]
    assert unknown_fields({"type": "declare", "event": event}) == ["$.event.why"]
    assert unknown_fields({"type": "done", "map": {**MAP, "name": "x"}, "cost": 1}) == [
        "$.map.name"
    ]
    assert not unknown_fields({"type": "done", "map": MAP, "cost": 1})


def test_the_kinds_of_an_augmentation_are_named() -> None:
    event = '{"type": "augment", "edge": 0, "kind": "vertex", "dart": 1, "degree": 1}'
    decode = msgspec.json.Decoder[ms.FromProgram](ms.FromProgram).decode
    with pytest.raises(Misbehaved, match="new or loop"):
        decoded(f'{{"type": "declare", "event": {event}}}'.encode(), decode, validate=False)
