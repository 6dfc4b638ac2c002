"""A run as compact data for the page: the events of its trace, with what the replay knows.

The page draws S as it grows (`page/model.js`; a test compares it with `scenes.py`). Each event is a
letter and numbers:

    move       c2: by door 2, to cross (w walk, c cross, v validate, t retrace, m: no purpose)
    pose       p edge, hypotheses
    reject     r edge, hypothesis, rule, and where its evidence lies: behind these doors, or, by
               folding, at two darts of the world; -1: the replay does not find it
    confirm    k edge, hypothesis, rule
    augment    a (new) or l (loop) edge, dart, degree, the darts of which a record is kept from now
    percept    a degree, or [degree, door of the marker]
    saying     [kind, title, sentences, seen, expected, labels], without the usual end; kinds and
               texts by their numbers. An event has its saying's number as a digit of 64, behind a
               blank for each further 64; frequent sayings have small numbers
"""

from __future__ import annotations

import json
import re
import string
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple, assert_never, get_args

from topo_verify.checkers import Finding, Judgement
from topo_verify.errors import LINE, shown
from topo_verify.pictures.detours import circle, turns
from topo_verify.pictures.narrator import SEES, SENSES, Narrator
from topo_verify.pictures.remarks import remarks
from topo_verify.pictures.scenes import Moment, Playback
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept
from topo_verify.world import io
from topo_verify.world.resolve import resolve_world
from topo_verify.world.rooted_map import World

MOST_WITNESSES = 4

WIDEST_WITNESS = 200
"""Most edges of a witness world that is drawn; larger ones take seconds."""


class GalleryWorld(NamedTuple):
    """A world to walk, with every page.

    Attributes:
        text: its name as a WORLD.
        symmetries: the number of its automorphisms without the marker.
    """

    name: str
    text: str
    genus: int
    symmetries: int


GALLERY = (
    GalleryWorld("one road", "m1/0", 0, 2),
    GalleryWorld("one loop", "m1/1", 0, 2),
    GalleryWorld("three roads", "m3/14", 0, 1),
    GalleryWorld("four roads", "m4/41", 0, 1),
    GalleryWorld("two loops that cross: a torus", "m2/8", 1, 4),
    GalleryWorld("a ring of five", "family:cycle(5)", 0, 10),
    GalleryWorld("a wheel", "family:wheel(4)", 0, 4),
    GalleryWorld("two by three", "family:lattice(3,2)", 0, 2),
    GalleryWorld("three by three", "family:lattice(3,3)", 0, 4),
    GalleryWorld("seven places", "family:lattice(2,4,holes=0.1,seed=2)", 0, 1),
    GalleryWorld("a small torus", "family:torus(3,3)", 1, 36),
    GalleryWorld("a cube", "family:cube()", 0, 24),
)

DIGITS = string.digits + string.ascii_letters + "-_"
"""None of these is escaped in JSON."""


@dataclass(frozen=True, slots=True)
class PlayedRun:
    """A run to show.

    Attributes:
        stopped: why the mapper ended without a map, or None.
    """

    name: str
    trace: ev.Trace
    judgements: Sequence[Judgement] = ()
    stopped: str | None = None


_TENTHS = re.compile(r"\.0\d?|(\.[1-9])\d?")
"""The decimals of a number in path data; its group is what one decimal keeps of them."""


def recording(world: World, runs: Sequence[PlayedRun], *, name: str = "") -> dict[str, Any]:
    """What the page shows of these runs, as data for JSON."""
    worlds, places = [pictured(world)], dict[str, int]()
    return {
        "name": shown(name or world.name or "a world"),
        "least_cost": world.least_cost(),
        "runs": [_run(world, run, worlds, places) for run in runs],
        "worlds": worlds,
        "gallery": _gallery(),
    }


def pictured(world: World) -> dict[str, Any]:
    """A world and its picture, as data for JSON."""
    from topo_verify.pictures.drawing import lay_out

    def rounded(points: Iterable[tuple[float, float]]) -> list[list[float]]:
        return [[round(x, 1), round(y, 1)] for x, y in points]

    layout = lay_out(world)
    data: dict[str, Any] = {
        "vertices": world.vertices,
        "edges": world.edges,
        "root": world.root,
        "width": layout.width,
        "height": layout.height,
        "radius": layout.radius,
        "centres": rounded(layout.centres),
        "paths": [_TENTHS.sub(r"\1", "".join(parts)) for parts in layout.paths],
        "bridges": [[bridge.path, bridge.over, bridge.under] for bridge in layout.bridges],
    }
    if layout.cell is not None:
        data["sides"] = layout.cell.sides
        data["corners"] = rounded(layout.cell.corners)
    if world.vertex_names:
        data["names"] = [shown(name) for name in world.vertex_names]
    return data


@cache
def _gallery() -> list[dict[str, Any]]:
    worlds = [(f"{entry.name} ({entry.text})", resolve_world(entry.text)) for entry in GALLERY]
    return [{**pictured(world), "name": name} for name, world in worlds]


def _run(
    world: World, run: PlayedRun, worlds: list[dict[str, Any]], places: dict[str, int]
) -> dict[str, Any]:
    playback = Playback(world, run.trace, run.judgements, run.stopped)
    narrator = Narrator(playback)
    cites_records = any(isinstance(e, ev.Reject) and e.rule == "records" for e in run.trace)
    return {
        "name": shown(run.name),
        "events": "".join(
            _event(moment, narrator.folded.clashes, cites_records=cites_records)
            for moment in playback.moments
        ),
        "said": _said(narrator),
        "findings": _findings(playback, worlds, places),
        "identified": narrator.folded.identified,
    }


def _said(narrator: Narrator) -> dict[str, Any]:
    texts = {text: number for number, text in enumerate(SEES)}
    rows: list[str] = []
    for saying in narrator.sayings:
        title, sentences, labels = (
            [texts.setdefault(text, len(texts)) for text in group]
            for group in ((saying.title,), saying.sentences, saying.labels)
        )
        row = [
            SENSES.index(saying.kind),
            *title,
            sentences,
            _percept(saying.seen),
            _percept(saying.expected),
            labels,
        ]
        for usual in ([0, 1], None, None):
            if row[-1] != usual:
                break
            row.pop()
        rows.append(json.dumps(row))
    sayings = [row for row, _ in Counter(rows).most_common()]
    number = {row: place for place, row in enumerate(sayings)}
    return {
        "texts": list(texts),
        "sayings": list(map(json.loads, sayings)),
        "events": "".join(_digits(number[row]) for row in rows),
    }


def _digits(number: int) -> str:
    return " " * (number // len(DIGITS)) + DIGITS[number % len(DIGITS)]


def _findings(
    playback: Playback, worlds: list[dict[str, Any]], places: dict[str, int]
) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = []
    turned, explained, repeated = turns(playback), set[int | None]([None]), circle(playback)
    for finding in playback.findings:
        number, notes = finding.event, list[str]()
        if number is None and repeated is not None:
            number, notes = repeated.last, [str(repeated)]  # shown at the end of the first round
        elif number not in explained:
            assert number is not None
            notes = list(remarks(playback, playback.moments[number], turned.get(number)))
        explained.add(finding.event)
        rows.append({**_finding(finding, worlds, places), "event": number, "remarks": notes})
    return rows


def _finding(
    finding: Finding, worlds: list[dict[str, Any]], places: dict[str, int]
) -> dict[str, Any]:
    text = finding.witness
    if text is not None and text not in places and len(places) < MOST_WITNESSES:
        witness = io.from_text(text)
        if len(witness.edges) <= WIDEST_WITNESS:
            places[text] = len(worlds)
            worlds.append(pictured(witness))
    return {
        "claim": finding.claim,
        "event": finding.event,
        "message": shown(finding.message, limit=LINE),
        "witness": None if text is None else places.get(text),
    }


_RULES = get_args(ev.RuleName)
_LETTERS = {"walk": "w", "cross": "c", "validate": "v", "retrace": "t", None: "m"}


def _event(moment: Moment, clashes: Mapping[int, Sequence[int]], *, cites_records: bool) -> str:
    extra: Sequence[int] = ()
    match moment.event:
        case ev.Start():
            letter, numbers = "s", []
        case ev.Move(door, _, purpose):
            letter, numbers = _LETTERS[purpose], [door]
        case ev.Pose(edge, hypotheses):
            letter, numbers = "p", [edge, *hypotheses]
        case ev.Reject(edge, hypothesis, rule):
            if rule == "folding":
                extra = clashes.get(moment.number, ())
            else:
                extra = (-1,) if moment.mismatch is None else moment.mismatch.doors
            letter, numbers = "r", [edge, hypothesis, _RULES.index(rule), *extra]
        case ev.Confirm(edge, hypothesis, rule):
            letter, numbers = "k", [edge, hypothesis, _RULES.index(rule)]
        case ev.Augment(edge, kind, dart, degree):
            if cites_records:
                extra = [dart for dart, _ in moment.recorded]
            letter, numbers = "a" if kind == "new" else "l", [edge, dart, degree, *extra]
        case ev.Finish():
            letter, numbers = "f", []
        case _:
            assert_never(moment.event)
    return letter + ",".join(map(str, numbers))


def _percept(percept: Percept | None) -> Any:
    if percept is None or percept.marker is None:
        return percept and percept.degree
    return [percept.degree, percept.marker]
