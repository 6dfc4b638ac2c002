"""A run as compact data for the page: the events of its trace, which are deltas, and no snapshot.

The page finds again from the doors where the robot stood, how S grew and what each event means
(`page/model.js`; a test compares it with `scenes.py`, event by event). What it cannot find is added
here: the picture of the world, percepts that are not true, where the fold of the history
identifies visits, the findings, and the witness worlds with their pictures.

    move       "c2": by door 2, to cross (w walk, c cross, v validate, t retrace, m: no purpose)
    pose       ["p", edge, hypotheses]
    reject     ["r", edge, hypothesis, rule, step, observed, expected, sequence, at, record,
               contradiction], without the empty end; rules by their first letter, planar "l";
               or, where a contradiction is all that is cited, [..., rule, its number as text]
    confirm    ["c", edge, hypothesis, rule]
    augment    ["a" new or "l" loop, edge, dart, degree]
    percept    a degree, or [degree, door of the marker]
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import hypot, inf
from typing import TYPE_CHECKING, Any, assert_never

from topo_verify.checkers import Finding, Judgement
from topo_verify.player.fold_places import fold_places
from topo_verify.player.gallery import gallery
from topo_verify.player.scenes import Playback
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept
from topo_verify.text import LINE, shown
from topo_verify.world.rooted_map import World

if TYPE_CHECKING:
    from topo_verify.world.drawing import Layout

MOST_WITNESSES = 4
"""The witness worlds of so many findings are drawn."""

WIDEST_WITNESS = 200
"""The most edges of a witness world that is drawn: larger ones take seconds."""


@dataclass(frozen=True, slots=True)
class PlayedRun:
    """A run to be shown.

    Attributes:
        name: of the mapper.
        trace: what happened.
        judgements: of the claims; their findings are marked.
        stopped: why the mapper ended without a map, if it did.
    """

    name: str
    trace: ev.Trace
    judgements: Sequence[Judgement] = ()
    stopped: str | None = None


def recording(world: World, runs: Sequence[PlayedRun], *, name: str = "") -> dict[str, Any]:
    """What the page shows of these runs, as data for JSON.

    Args:
        name: of the world; default: its own.
    """
    worlds, places = [pictured(world)], dict[str, int]()
    return {
        "name": shown(name or world.name or "a world"),
        "least_cost": world.least_cost(),
        "runs": [_run(world, run, worlds, places) for run in runs],
        "worlds": worlds,
        "gallery": gallery(),
    }


def pictured(world: World) -> dict[str, Any]:
    """A world and its picture, as data for JSON."""
    layout = _roomy_layout(world)
    data: dict[str, Any] = {
        "vertices": world.vertices,
        "edges": world.edges,
        "root": world.root,
        "width": layout.width,
        "height": layout.height,
        "radius": layout.radius,
        "centres": [[round(x, 1), round(y, 1)] for x, y in layout.centres],
        "paths": ["".join(parts) for parts in layout.paths],
        "bridges": [[bridge.path, bridge.over, bridge.under] for bridge in layout.bridges],
    }
    if world.vertex_names:
        data["names"] = [shown(one) for one in world.vertex_names]
    return data


def _roomy_layout(world: World) -> Layout:
    """A layout in which vertices stand apart, in half a page: the positions, where they do."""
    from topo_verify.world.drawing import lay_out

    layout = lay_out(world)
    if layout.kind != "positions" or _room(layout) >= ENOUGH:
        return layout
    other = lay_out(replace(world, positions=()))
    return max(layout, other, key=_room)


ENOUGH = 24
"""Pixels between a vertex and the next one at which a robot, badges and rings have room."""


def _room(layout: Layout) -> float:
    """How far a vertex is from the next one, in pixels of a pane; a tenth may be nearer."""
    centres = layout.centres
    near = sorted(
        min((hypot(u - x, v - y) for j, (u, v) in enumerate(centres) if j != i), default=inf)
        for i, (x, y) in enumerate(centres)
    )
    return near[len(near) // 10] * min(640 / layout.width, 440 / layout.height)


def _run(
    world: World, run: PlayedRun, worlds: list[dict[str, Any]], places: dict[str, int]
) -> dict[str, Any]:
    playback = Playback(world, run.trace, run.judgements, run.stopped)
    rules = {event.rule for event in run.trace if isinstance(event, ev.Reject)}
    folded = fold_places(playback.moments if "folding" in rules else ())
    lies = {when: _percept(told) for when, told, _ in playback.replayed.false_percepts}
    contradictions: dict[str, int] = {}
    return {
        "name": shown(run.name),
        "events": [_event(event, contradictions) for event in run.trace],
        "contradictions": list(contradictions),
        "findings": [_finding(one, worlds, places) for one in playback.findings],
        "lies": lies,
        "places": folded.clashes,
        "identified": folded.identified,
        "records": "records" in rules,
    }


def _finding(
    finding: Finding, worlds: list[dict[str, Any]], places: dict[str, int]
) -> dict[str, Any]:
    text = finding.witness
    if text is not None and text not in places and len(places) < MOST_WITNESSES:
        witness = World.from_text(text)
        if len(witness.edges) <= WIDEST_WITNESS:
            places[text] = len(worlds)
            worlds.append(pictured(witness))
    return {
        "claim": finding.claim,
        "event": finding.event,
        "message": shown(finding.message, limit=LINE),
        "witness": None if text is None else places.get(text),
    }


_LETTERS = {"walk": "w", "cross": "c", "validate": "v", "retrace": "t", None: "m"}


def _event(event: ev.Event, contradictions: dict[str, int]) -> Any:
    """An event as the page reads it; contradictions are numbered as they come."""
    kept: Any
    match event:
        case ev.Start():
            kept = "s"
        case ev.Move(door, _, purpose):
            kept = f"{_LETTERS[purpose]}{door}"
        case ev.Pose(edge, hypotheses):
            kept = ["p", edge, hypotheses]
        case ev.Reject(edge, hypothesis, rule, evidence):
            kept = ["r", edge, hypothesis, _rule(rule), *_evidence(evidence, contradictions)]
        case ev.Confirm(edge, hypothesis, rule):
            kept = ["c", edge, hypothesis, _rule(rule)]
        case ev.Augment(edge, kind, dart, degree):
            kept = ["a" if kind == "new" else "l", edge, dart, degree]
        case ev.Finish(cost):
            kept = ["f", cost]
        case _:
            assert_never(event)
    return kept


def _rule(rule: str) -> str:
    return "l" if rule == "planar" else rule[0]


def _evidence(evidence: ev.Evidence, contradictions: dict[str, int]) -> list[Any]:
    """What is cited, without the empty end."""
    text = evidence.contradiction and shown(evidence.contradiction, limit=LINE)
    if text and evidence == ev.Evidence(0, contradiction=evidence.contradiction):
        return [str(contradictions.setdefault(text, len(contradictions)))]
    record = evidence.record
    kept: list[Any] = [
        evidence.step,
        _percept(evidence.observed),
        _percept(evidence.expected),
        evidence.sequence,
        evidence.at,
        record and [record.dart, record.doors],
        text,
    ]
    while kept[-1] is None:
        kept.pop()
    return kept


def _percept(percept: Percept | None) -> Any:
    if percept is None or percept.marker is None:
        return percept and percept.degree
    return [percept.degree, percept.marker]
