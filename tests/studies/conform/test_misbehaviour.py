"""Programs that misbehave: one clear finding for the world, the next world is played, none is left.

Each program is right in the first and the third world and misbehaves in the second.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.marks import with_marks
from tests.processes import gone
from tests.programs.misbehaving import WAYS
from tests.programs.programs import kinds, messages, misbehaving, outcomes
from topo_verify.programs.misbehaviour import MISBEHAVIOURS
from topo_verify.robot.limits import Limits

LIMITS = Limits(move_timeout=0.9, world_timeout=30)
PATIENT = Limits(move_timeout=60, world_timeout=600)
"""For programs that end a world by themselves, however long the machine takes for it."""

HANG = {"move-timeout", "half-line", "flooded-stderr", "closed-input", "not-reading"}
"""The kinds that are found only when a time limit strikes, or may be."""

EXPECTED = {
    "hangs": ("move-timeout", "did not move for 0.9 s"),
    "exits": ("crashed", "ended with exit code 7"),
    "exits with success": ("crashed", "ended with exit code 0"),
    "raises": ("crashed", "/ IndexError: list index out of range"),
    "kills itself": ("crashed", "was ended by SIGKILL"),
    "crashes": ("crashed", "it delivered a map; gdb names the line: docs/tutorials/any-"),
    "closes its output": ("closed-output", "closed its output and runs on"),
    "closes its input": ("closed-input", "it has closed its input"),
    "floods stdout": ("too-long", "a line of more than 1048576 bytes"),
    "floods stdout with lines": ("not-json", "spam"),
    "floods stderr": ("flooded-stderr", "more than 1048576 bytes on standard error"),
    "floods moves": ("budget", "more than 1 move"),
    "floods declarations": ("declarations", "100001 decisions without a move"),
    "prints garbage": ("not-json", "hello, world"),
    "prints an empty line": ("not-json", "truncated"),
    "prints binary": ("not-json", r"\x00\x80\xff\xfe"),
    "prints binary in a string": ("not-utf8", r"\xff"),
    "prints half a line and exits": ("half-line", "exit code 0 in the middle of a line"),
    "prints half a line and hangs": ("half-line", 'in the middle of a line: {"type": "mo'),
    "prints a line of 10 MB": ("too-long", "a line of more than 1048576 bytes"),
    "nests 100,000 brackets": ("nested", "nested too deeply"),
    "nests in a known field": ("malformed", "Expected `object`, got `array` - at `$.map`"),
    "says NaN": ("not-json", "NaN"),
    "says half a door": ("malformed", "Expected `int`, got `float` - at `$.door`"),
    "says true for a door": ("malformed", "Expected `int`, got `bool` - at `$.door`"),
    "says a door in words": ("malformed", "Expected `int`, got `str` - at `$.door`"),
    "says a huge door": ("malformed", "at `$.door`"),
    "asks for door 99": ("bad-door", "door 99 at a vertex with 2 doors"),
    "asks for door -1": ("bad-door", "door -1 at a vertex with 2 doors"),
    "says a list": ("malformed", "Expected `object`, got `array`"),
    "says null": ("malformed", "Expected `object`, got `null`"),
    "says no type": ("malformed", "missing required field `type`"),
    "says an unknown type": ("unknown-type", "Invalid value 'teleport'"),
    "declares nonsense": ("bad-declaration", "`$.event.edge`"),
    "declares a start": ("bad-declaration", "Invalid value 'start'"),
    "delivers a map of words": ("malformed", "Expected `object`, got `str` - at `$.map`"),
    "delivers a map without edges": ("malformed", "missing required field `marker`"),
    "delivers a map of nonsense": ("map-isomorphic", "dart 0 stands at two places"),
    "delivers another map": ("map-isomorphic", "not isomorphic to the true map"),
    "delivers too early": ("cost-within-bound", "a cost of 0 is outside"),
    "lies about its cost": ("cost-honest", "a cost of 5, but made 1 move"),
    "goes on after the end": ("out-of-turn", "went on after the world's end"),
    "goes on later": ("out-of-turn", "went on after the world's end: and another thing"),
    "goes on in halves": ("out-of-turn", "went on after the world's end: and another"),
    "delivers and reads no more": ("not-reading", "does not read on"),
    "delivers and crashes": ("crashed", "was ended by SIGSEGV before it read the next message"),
    "floods declarations of 1 MB": ("declarations", "more than 16778240 bytes in this world"),
    "ignores SIGTERM": ("move-timeout", "did not move"),
    "leaves a child": ("crashed", "exit code 1"),
    "leaves a child in a session of its own": ("crashed", "exit code 1"),
    "walks for ever": ("budget", "more than 1 move"),
}
"""What is found, and what its sentence says."""

NO_FAULT = {"skips", "gives up", "strolls", "delivers and ends"}
"""What is no finding: see the last tests."""


def test_every_way_to_misbehave_is_expected_here() -> None:
    assert EXPECTED.keys() | NO_FAULT == WAYS.keys()
    assert len({kind for kind, _ in EXPECTED.values()}) >= 15


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_a_program_that_ends_after_its_map_is_started_again() -> None:
    made = outcomes(misbehaving("delivers and ends"), "m1/0", "m1/1", "m1/0", limits=PATIENT)
    assert [one.states["result"] for one in made] == ["passed"] * 3


@pytest.mark.parametrize(
    "way",
    with_marks(
        EXPECTED,
        long=[
            "hangs",
            "closes its output",
            "closes its input",
            "floods stderr",
            "prints half a line and hangs",
            "delivers and reads no more",
            "floods declarations of 1 MB",
        ],
        nightly=["floods declarations", "ignores SIGTERM"],
    ),
)
def test_misbehaviour_is_one_finding_for_its_world(way: str) -> None:
    kind, words = EXPECTED[way]
    limits = LIMITS if kind in HANG else PATIENT
    before, made, after = outcomes(misbehaving(way), "m1/0", "m1/1", "m1/0", limits=limits)
    assert before.states["result"] == after.states["result"] == "passed"
    assert made.states["result"] == "failed"
    assert made.findings["result"][0].kind == kind, messages(made)
    assert words in messages(made)
    if kind in MISBEHAVIOURS:  # no map was delivered: that is the one finding
        assert len(made.findings["result"]) == 1


@pytest.mark.parametrize("way", ["skips", "gives up"])
def test_a_world_that_is_declined_is_no_failure_and_no_success(way: str) -> None:
    before, made, after = outcomes(misbehaving(way), "m1/0", "m1/1", "m1/0", limits=LIMITS)
    assert before.states["result"] == after.states["result"] == "passed"
    assert made.states["result"] == {"skips": "skipped", "gives up": "errored"}[way]
    assert not kinds(made)
    assert made.why is not None
    assert {"skips": "no loops, please", "gives up": "out of ideas"}[way] in made.why


def test_a_program_that_moves_on_when_its_time_is_over_is_undecided() -> None:
    limits = Limits(budget=10**6, move_timeout=20, world_timeout=0.5)
    made, after = outcomes(misbehaving("strolls"), "m1/1", "m1/0", limits=limits)
    assert made.states["result"] == "undecided"
    assert not kinds(made)
    assert made.why == "the mapper was stopped after 0.5 s in this world"
    assert after.states["result"] == "passed"


# ---------------------------------------------------------------- nothing is left behind


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="no /proc here")
@pytest.mark.parametrize("way", ["leaves a child", "leaves a child in a session of its own"])
def test_children_that_live_on_are_ended(way: str) -> None:
    outcomes(misbehaving(way), "m1/0", "m1/1", "m1/0", limits=LIMITS)
    (child,) = map(int, Path("lingers").read_text().split())
    assert gone(child)
