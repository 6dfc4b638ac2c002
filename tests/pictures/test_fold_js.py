"""The page's fold in JavaScript is the trusted one: on every golden trace, at every event."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, cast

import msgspec
import pytest

from tests.helpers import SURE, worlds
from tests.pictures.node import answers, script
from topo_verify import World, explore
from topo_verify.checkers import decision_conclusions
from topo_verify.checkers.entailment import FoldedTrace
from topo_verify.errors import InputError
from topo_verify.faults import FAULTS
from topo_verify.programs.loader import Mapper
from topo_verify.robot.events import Augment, Move, Reject, Start, Trace
from topo_verify.robot.percept import Percept

ROOT = Path(__file__).parents[2]
FOLD = script("fold.js")
GOLDEN: list[dict[str, Any]] = json.loads((ROOT / "tests/data/golden.json").read_text())["cases"]

DRIVER = """
function answer(trace) {
  const fold = new Fold(trace[0].percept), map = new MapOnFold(fold);
  const counts = [], doubts = [], refuted = {};
  let drawn = true;
  for (const [when, event] of trace.entries()) {
    if (event.type === "move") {
      try { fold.move(event.door, event.percept); }
      catch { return { counts, doubts, broken: when }; }
      continue;
    }
    counts.push([fold.openDarts().length, fold.darts().flat().length]);
    if (!drawn || !["reject", "confirm", "augment"].includes(event.type)) continue;
    const { why, witness } = map.doubt(event, refuted[event.edge]);
    doubts.push([when, why, witness]);
    if (event.type !== "augment") {
      const out = (refuted[event.edge] ??= new Set());
      if (event.type === "reject" && !why) out.add(event.hypothesis);
    } else if (why) drawn = false;
    else map.grow(event);
  }
  return { counts, doubts, worlds: [fold.world(1), fold.world(2)] };
}
"""


def in_python(trace: Trace) -> dict[str, Any]:
    """What checkers/folding and checkers/entailment make of a trace, in the same shape."""
    start = trace[0]
    assert isinstance(start, Start)
    folded, counts = FoldedTrace(trace), list[tuple[int, int]]()
    fold = folded.fold
    doubts = [(c.when, c.why, c.witness) for c in decision_conclusions(FoldedTrace(trace))]
    for when, event in enumerate(trace):
        if folded.read_to(when + 1):
            return {"counts": counts, "doubts": doubts[:-1], "broken": when}
        if not isinstance(event, Move):
            counts.append((fold.open_darts(), sum(map(fold.degree, fold.roots()))))
    return {"counts": counts, "doubts": doubts, "worlds": [fold.world(1), fold.world(2)]}


def plain(shown: Any) -> Any:
    """Worlds by their codes, so that a numbering does not matter; pairs as lists."""
    if isinstance(shown, World):
        return shown.code
    if isinstance(shown, dict):
        fields = cast("dict[str, Any]", shown)
        if "vertices" not in fields:
            return {key: plain(value) for key, value in fields.items()}
        try:
            return World.from_map(fields).code
        except InputError as error:
            return str(error)
    if isinstance(shown, list | tuple):
        return [plain(one) for one in cast("Sequence[Any]", shown)]
    return shown


def differing(traces: Sequence[Trace], expected: Sequence[Any], source: str = FOLD) -> int:
    """In how many of these traces fold.js shows another thing than expected."""
    pairs = zip(answers(source + DRIVER, traces), expected, strict=True)
    return sum(plain(shown) != other for shown, other in pairs)


def golden(names: Iterable[str]) -> list[Trace]:
    """A trace of each algorithm in each golden world."""
    found = [World.from_json(json.dumps(case["world"])) for case in GOLDEN]
    return [explore(world, name).trace for name in names for world in found]


def guesses() -> list[Trace]:
    """Traces with decisions that do not follow: of guessers, and of planar ones without a plane."""
    names = ("concludes-by-elimination", "confirms-what-is-alone", "takes-each-place-for-known")
    mappers: list[Mapper | str] = [*(FAULTS[name] for name in names), "folding+planar"]
    found = [world for world in worlds([2, 3]) if world.is_planar][::4]
    return [without_the_prior(explore(world, by).trace) for by in mappers for world in found]


def without_the_prior(trace: Trace) -> Trace:
    """The trace with no rejection by rule `planar`, which would declare the prior."""
    return tuple(
        msgspec.structs.replace(event, rule="history")
        if isinstance(event, Reject) and event.rule == "planar"
        else event
        for event in trace
    )


def nonsense() -> list[Trace]:
    """Traces with decisions that no mapper makes, and with percepts that no world shows."""
    start, around = Start(percept=Percept(2, 0)), Move(0, Percept(2, 1))
    return [
        (start, Augment(0, "new", 2, 1)),
        (start, Augment(0, "new", 2, 2)),
        (start, around, Augment(0, "loop", 1, 3)),
        (start, around, Augment(0, "new", 2, 2)),
        (start, Move(0, Percept(3, None)), Augment(0, "new", 2, 4)),
        (Start(percept=Percept(0, None)),),
        (start, Move(2, Percept(1, None))),
        (start, Move(0, Percept(0, None))),
        (start, Move(0, Percept(2, 2))),
        (start, Move(0, Percept(2, 0))),
        (start, around, Move(0, Percept(2, 1))),
        (start, around, Move(0, Percept(3, None))),
    ]


@pytest.fixture(scope="module")
def judged() -> tuple[list[Trace], list[Any]]:
    """Traces that show every kind of conclusion, and what is to be shown of them."""
    small = [explore(world, "folding").trace for world in list(worlds([3]))[::3]]
    traces = [*guesses(), *nonsense(), *small]
    return traces, [plain(in_python(trace)) for trace in traces]


@pytest.mark.long
def test_it_shows_what_the_trusted_fold_shows(judged: tuple[list[Trace], list[Any]]) -> None:
    traces, expected = judged
    doubts = [why for shown in expected for _, why, _ in shown["doubts"]]
    reasons = {re.sub(r"darts \d+ and \d+ ", "", why) for why in doubts}
    assert reasons == {
        "",
        "may well belong to different edges",
        "the edge leads to another vertex",
        "the edge may well lead there",
        "the edge was never crossed",
        "the vertex there has another degree",
    }
    assert differing(traces, expected) == 0


@pytest.mark.nightly
def test_it_shows_that_on_every_golden_trace() -> None:
    traces = golden(SURE)
    assert len(traces) == 207
    assert differing(traces, [plain(in_python(trace)) for trace in traces]) == 0


PLANTED = {
    "identifies without turning": ("offset: j - i", "offset: 0"),
    "takes the marker for the reference dart": ("this.at[1] + marker]", "this.at[1]]"),
    "an assumption stays": ("node.partner.delete(dart);", ";"),
    "a dart may be its own other end": ("!this.same([node, dart], end)", "true"),
    "a vertex may be itself, turned": ("a !== b || i === j", "true"),
    "the marker is no difference": ("(one.marker === null) === (other.marker === null)", "true"),
    "degrees are no difference": ("one.degree === other.degree", "true"),
    "stops at the first pair": ("pairs.push(...this.lead(", "void (this.lead("),
    "no vertex is known": ("this.isKnown(end[0])", "false"),
    "new is new": ("this.others(edge).filter((other) => !refuted.has(other))", "[]"),
    "a loop is a loop": ("!end || !fold.same(end, this.places[h])", "!end"),
    "any degree will do": ("degree === undefined || degree === fold.degree(end[0])", "true"),
    "a leaf behind every open dart": ("degree === 1 ? 2 : 1", "1"),
}


@pytest.mark.parametrize("fault", PLANTED)
def test_a_planted_fault_is_seen(judged: tuple[list[Trace], list[Any]], fault: str) -> None:
    right, wrong = PLANTED[fault]
    assert FOLD.count(right) == 1
    assert differing(*judged, FOLD.replace(right, wrong)) > 0


def test_it_is_short_enough_to_be_read_beside_its_twin() -> None:
    assert len(FOLD.splitlines()) < 200
