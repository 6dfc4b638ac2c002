"""The trace as JSON Lines: a format that scripts rely on, field by field."""

from __future__ import annotations

import json
from codecs import BOM_UTF8
from typing import Any, cast

import msgspec
import pytest
from hypothesis import given
from hypothesis.vendor.pretty import pretty

import topo_verify
from tests.helpers import any_world, trace_of
from topo_verify import InputError, World
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept

START = ev.Start(algorithm="basic", policies=ev.Policies(), world="m1/0", percept=Percept(1, 0))

EVENTS: list[tuple[ev.Event, dict[str, Any]]] = [
    (
        START,
        {
            "type": "start", "format": "topo-verify/trace", "version": 1, "algorithm": "basic",
            "policies": {"pick": "nearest", "order": "shortest"}, "world": "m1/0",
            "percept": {"degree": 1, "marker": 0},
        },
    ),
    (
        ev.Start(percept=Percept(0, None)),
        {
            "type": "start", "format": "topo-verify/trace", "version": 1, "algorithm": None,
            "policies": None, "world": None, "percept": {"degree": 0, "marker": None},
        },
    ),
    (
        ev.Move(2, Percept(3, None), "cross"),
        {
            "type": "move", "door": 2, "percept": {"degree": 3, "marker": None},
            "purpose": "cross",
        },
    ),
    (
        ev.Move(0, Percept(3, 1)),
        {"type": "move", "door": 0, "percept": {"degree": 3, "marker": 1}, "purpose": None},
    ),
    (ev.Pose(4, (5, 6)), {"type": "pose", "edge": 4, "hypotheses": [5, 6]}),
    (
        ev.Reject(4, 5, "motion", ev.Evidence(0, Percept(3, 0), Percept(3, 1))),
        {
            "type": "reject", "edge": 4, "hypothesis": 5, "rule": "motion",
            "evidence": {
                "step": 0,
                "expected": {"degree": 3, "marker": 0},
                "observed": {"degree": 3, "marker": 1},
            },
        },
    ),
    (
        ev.Reject(
            4, 5, "records",
            ev.Evidence(
                1, Percept(2, None), Percept(3, 1), sequence=0, at=7, record=ev.Record(7, (1,))
            ),
        ),
        {
            "type": "reject", "edge": 4, "hypothesis": 5, "rule": "records",
            "evidence": {
                "step": 1,
                "expected": {"degree": 2, "marker": None},
                "observed": {"degree": 3, "marker": 1},
                "sequence": 0, "at": 7, "record": {"dart": 7, "doors": [1]},
            },
        },
    ),
    (
        ev.Confirm(4, 6, "motion"),
        {"type": "confirm", "edge": 4, "hypothesis": 6, "rule": "motion"},
    ),
    (
        ev.Augment(4, "loop", 6, 3),
        {"type": "augment", "edge": 4, "kind": "loop", "dart": 6, "degree": 3},
    ),
    (
        ev.Finish(5, ev.MapData(((0,), (1,)), ((0, 1),), 0)),
        {
            "type": "finish", "cost": 5,
            "map": {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0},
        },
    ),
]  # fmt: skip


@pytest.mark.parametrize(("event", "expected"), EVENTS)
def test_an_event_is_written_with_exactly_these_fields(
    event: ev.Event, expected: dict[str, Any]
) -> None:
    written = json.loads(ev.write_trace([event]))
    assert written == expected
    assert list(written) == list(expected)


@pytest.mark.parametrize("rule", ["motion", "prefix", "history", "records", "folding", "planar"])
def test_a_rule_has_one_of_the_names_of_the_interface(rule: str) -> None:
    line = {"type": "confirm", "edge": 0, "hypothesis": 1, "rule": rule}
    trace = ev.read_trace(ev.write_trace([START]) + json.dumps(line).encode())
    assert isinstance(trace[1], ev.Confirm)
    assert trace[1].rule == rule


def test_what_was_written_is_read_back_a_line_an_event() -> None:
    trace = (START, *(event for event, _ in EVENTS[2:]))
    text = ev.write_trace(trace)
    assert text.count(b"\n") == len(trace)
    assert ev.read_trace(text) == trace


@given(world=any_world(max_edges=5))
def test_real_traces_survive_the_round_trip(world: World) -> None:
    trace = trace_of(world, "enhancement-iii-all+i")
    assert ev.read_trace(ev.write_trace(trace)) == trace


def test_a_byte_order_mark_is_passed_over_at_the_begin_and_nowhere_else() -> None:
    text = ev.write_trace([START, ev.Move(0, Percept(1, None))])
    assert ev.read_trace(BOM_UTF8 + text) == ev.read_trace(text)
    start, move = text.splitlines(keepends=True)
    with pytest.raises(InputError, match="trace, line 2"):
        ev.read_trace(start + BOM_UTF8 + move)


def test_a_trace_may_hold_only_start_and_moves_without_purposes_and_more_fields() -> None:
    text = (
        b'{"type":"start","format":"topo-verify/trace","version":1,'
        b'"percept":{"degree":1,"marker":0},"made_by":"hand"}\n\n'
        b'{"type":"move","door":0,"percept":{"degree":1,"marker":null}}\n'
    )
    assert ev.read_trace(text) == (ev.Start(percept=Percept(1, 0)), ev.Move(0, Percept(1, None)))


@pytest.mark.parametrize(
    "line",
    [
        b"{",
        b"7",
        b"[]",
        b'"start"',
        b"{}",
        b'{"type":"jump"}',
        b'{"type":"move"}',
        b'{"type":"move","door":"0","percept":{"degree":1,"marker":0}}',
        b'{"type":"move","door":0,"percept":{"degree":1}}',
        b'{"type":"move","door":0,"percept":{"degree":1,"marker":0},"purpose":"fun"}',
        b'{"type":"augment","edge":0,"kind":"half","dart":1,"degree":1}',
        b'{"type":"confirm","edge":0,"hypothesis":1,"rule":"instinct"}',
        b'{"type":"start","format":"other/trace","percept":{"degree":1,"marker":0}}',
        b"\xff\xfe",
        b"[" * 100_000,
        b'{"type":"finish","cost":1e999,"map":null}',
    ],
)
def test_a_line_that_is_no_event_is_refused_by_its_number(line: bytes) -> None:
    with pytest.raises(
        InputError, match=r"^t\.jsonl, line 2: expected an event of a trace, as .*: "
    ):
        ev.read_trace(ev.write_trace([START]) + line, name="t.jsonl")


@pytest.mark.parametrize("trace", [[], [ev.Move(0, Percept(1, None))]])
def test_a_trace_begins_with_start(trace: list[ev.Event]) -> None:
    with pytest.raises(
        InputError, match="expected an event of type 'start' in the first line, as "
    ):
        ev.read_trace(ev.write_trace(trace))


def test_a_newer_version_is_refused_with_what_to_do() -> None:
    newer = ev.write_trace([START]).replace(b'"version":1', b'"version":2')
    with pytest.raises(InputError, match=r"version 2 is newer than 1, .* update it"):
        ev.read_trace(newer)


def test_equal_moves_of_a_log_are_one_object() -> None:
    start, move = (
        b'{"type": "start", "percept": {"degree": 1, "marker": 0}}',
        b'{"type": "move", "door": 0, "percept": {"degree": 1, "marker": null}}',
    )
    _, one, other = ev.read_trace(b"\n".join((start, move, move)))
    assert one is other


@pytest.mark.parametrize(
    ("line", "key"),
    [
        (b'{"type":"move","door":0,"door":1,"percept":{"degree":1,"marker":0}}', "door"),
        (b'{"type":"move","door":0,"percept":{"degree":1,"degree":2,"marker":0}}', "degree"),
        (b'{"type":"move","x":{"y":1,"y":2},"door":0,"percept":{"degree":1,"marker":0}}', "y"),
    ],
)
def test_a_doubled_key_is_refused_by_name(line: bytes, key: str) -> None:
    start = b'{"type": "start", "percept": {"degree": 1, "marker": 0}}\n'
    with pytest.raises(InputError, match=f"line 2: the key '{key}' stands twice"):
        ev.read_trace(start + line)


def test_numbers_of_any_length_in_unknown_fields_are_ignored() -> None:
    start = b'{"type": "start", "x": %s, "percept": {"degree": 1, "marker": 0}}' % (b"7" * 5000)
    assert ev.read_trace(start) == (ev.Start(percept=Percept(1, 0)),)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (b'{"type": "augment", "edge": 0, "kind": "vertex", "dart": 1, "degree": 1}',
         "new or loop"),
        (b'{"type": "confirm", "edge": 0, "hypothesis": 1, "rule": "luck"}', "motion or prefix or"),
        (b'{"type": "move", "door": 0, "percept": {"degree": 1, "marker": 0}, "purpose": "run"}',
         "walk or cross or"),
    ],
)  # fmt: skip
def test_the_words_of_a_field_are_named(line: bytes, words: str) -> None:
    start = b'{"type": "start", "percept": {"degree": 1, "marker": 0}}\n'
    with pytest.raises(InputError, match=words):
        ev.read_trace(start + line)


def test_policies_print_as_code_that_makes_them_again() -> None:
    chosen = ev.Policies("last", "random(3)")
    assert eval(repr(chosen), {"tv": topo_verify}) == chosen  # noqa: S307  as pasted
    assert pretty(chosen) == repr(chosen) == "tv.Policies(pick='last', order='random(3)')"


def test_an_event_of_a_kind_of_ones_own_is_in_order_where_its_base_is() -> None:
    def subclass(kind: type[ev.Event]) -> Any:
        return msgspec.defstruct("Own", [], bases=(kind,), frozen=True, tag_field="type")

    start, *_, end = trace_of("m1/0")
    assert isinstance(end, ev.Finish)
    move, finish = subclass(ev.Move)(0, Percept(2, 1)), subclass(ev.Finish)(end.cost, end.map)
    assert ev.require_order([start, move, end]) == (start, ev.Move(0, Percept(2, 1)), end)
    with pytest.raises(InputError, match="event 1 of the trace is out of order"):
        ev.require_order([start, finish, end])


def test_what_is_no_event_is_refused() -> None:
    start, *_, end = trace_of("m1/0")
    with pytest.raises(InputError, match="event 1 of the trace is a str"):
        ev.require_order(cast("ev.Trace", (start, "move", end)))
