"""A short run as one animated SVG: CSS alone, so that it plays inside an `<img>`.

The world is dotted, and solid where S has it. The robot is a blue disc with a notch towards its
reference dart; e is blue; hypotheses are numbered badges. A ring shows where the robot would be if
the hypothesis that it tests were right; at a rejection both turn red.

Colours are literal, since librsvg ignores CSS variables; a media query has those for dark.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import accumulate
from textwrap import wrap
from typing import TypeVar

from topo_verify.errors import InputError, map_size, plural, shown
from topo_verify.extra.films.tracks import Tracks, timed
from topo_verify.pictures.drawing import lay_out
from topo_verify.pictures.drawing.curves import number
from topo_verify.pictures.drawing.svg import FONT, arrow, text
from topo_verify.pictures.narrator import Narrator, Saying
from topo_verify.pictures.scenes import Moment, Playback
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept

T = TypeVar("T")

MOST_EVENTS = 500

MOST_SPOKES = 12

WIDTH, MARGIN, FOOT = 560, 14, 84
"""Of the picture; the words stand below the world."""

COLUMNS, BESIDE = 78, 55
"""Of a line of words, alone and beside two glyphs; there are two lines."""

SECONDS = {
    ev.Start: 2.0,
    ev.Move: 0.75,
    ev.Pose: 1.7,
    ev.Reject: 2.6,
    ev.Confirm: 2.0,
    ev.Augment: 0.9,
    ev.Finish: 5.0,
}

STYLE = (
    ".card,.place,.far-place{fill:#fdfcf9}text{fill:#22282e}.soft{fill:#626b74}"
    ".far,.far-place{stroke:#aab2b9}.road{stroke:#79828b}.place{stroke:#22282e}"
    ".halo{stroke:#fdfcf9}.e{stroke:#1f6feb}.tv-mark{stroke:#b3261e}.tv-tip,.bad{fill:#b3261e}"
    ".robot{fill:#1f6feb;stroke:#fdfcf9}.notch{fill:#fdfcf9}.guess{fill:#c2510c}"
    ".ghost{stroke:#c2510c}.ring{stroke:#b3261e}.ok{fill:#1a7f4b}.on{fill:#fdfcf9}.ask{fill:#1f6feb}"
    "@media(prefers-color-scheme:dark){.card,.place,.far-place{fill:#14181c}text{fill:#e8eaec}"
    ".soft{fill:#9aa4ae}.far,.far-place{stroke:#56606a}.road{stroke:#8a949e}.place{stroke:#e8eaec}"
    ".halo{stroke:#14181c}.e{stroke:#6cb0ff}.tv-mark{stroke:#ff8078}.tv-tip,.bad{fill:#ff8078}"
    ".robot{fill:#6cb0ff;stroke:#14181c}.notch{fill:#14181c}.guess{fill:#ff9d5c}"
    ".ghost{stroke:#ff9d5c}.ring{stroke:#ff8078}.ok{fill:#56d090}.on{fill:#14181c}.ask{fill:#6cb0ff}}"
)

STILL = "@media(prefers-reduced-motion:reduce){*{animation:none!important}}"


Keyframe = tuple[float, float, float, float | None]
"""A time in seconds, a place, and degrees clockwise or None."""


@dataclass
class Stage:
    """The time line, and the keyframes requested so far.

    Attributes:
        begins: when each moment begins, in seconds, and when the last one ends.
    """

    begins: Sequence[float]
    rules: list[str] = field(default_factory=list[str])
    _names: dict[str, str] = field(default_factory=dict[str, str])

    def percent(self, seconds: float) -> str:
        """The moment as a share of the whole, as keyframes name it."""
        return f"{number(100 * seconds / self.begins[-1])}%"

    def during(self, *spans: tuple[int, int]) -> str:
        """Attributes that show an element during these spans, and hide it otherwise."""
        end = len(self.begins) - 1
        spans = tuple(span for span in spans if span[0] < span[1])
        if spans == ((0, end),):
            return ""
        keys = ["" if any(first == 0 for first, _ in spans) else "0%{opacity:0}"]
        for first, last in spans:
            keys += [f"{self.percent(self.begins[first])}{{opacity:1}}"]
            keys += [f"{self.percent(self.begins[last])}{{opacity:0}}"] if last < end else []
        at_end = "" if spans and spans[-1][1] == end else ' opacity="0"'
        return f' class="t {self._animation("".join(keys))}"{at_end}'

    def moving(self, way: Sequence[Keyframe]) -> str:
        """Attributes that move an element along these keyframes."""
        # Repeated before it changes: otherwise the way there would begin early.
        keys = "".join(
            f"{self.percent(pose[0])}{{transform:{_at(pose, 'px', 'deg')}}}" for pose in way
        )
        return f' class="t m {self._animation(keys)}" transform="{_at(way[-1])}"'

    def _animation(self, keys: str) -> str:
        if keys not in self._names:
            name = self._names[keys] = f"k{len(self._names)}"
            self.rules.append(f"@keyframes {name}{{{keys}}}.{name}{{animation-name:{name}}}")
        return self._names[keys]


def _at(pose: Keyframe, length: str = "", angle: str = "") -> str:
    _, x, y, turn = pose
    moved = f"translate({number(x)}{length},{number(y)}{length})"
    return moved if turn is None else f"{moved} rotate({number(turn)}{angle})"


def animated_svg(playback: Playback, *, name: str = "") -> str:
    """The run as an animated SVG, the same bytes for the same run.

    Args:
        name: of the mapper.
    Raises:
        InputError: the run is too long.
    """
    if len(playback.moments) > MOST_EVENTS:
        events = f"this run has {len(playback.moments)} events and {playback.cost} moves"
        raise InputError(
            f"{events}; an animated SVG shows at most {MOST_EVENTS} events: write the player"
            " instead (--player FILE.html)"
        )
    stage, layout = Stage(times(playback)), lay_out(playback.world)
    tracks = Tracks(playback, layout)
    scale = min((WIDTH - 2 * MARGIN) / layout.width, 280 / layout.height, 26 / layout.radius)
    wide, high = scale * layout.width, scale * layout.height
    box = f'x="{number((WIDTH - wide) / 2)}" y="{MARGIN}"'
    box += f' width="{number(wide)}" height="{number(high)}"'
    box += f' viewBox="0 0 {number(layout.width)} {number(layout.height)}"'
    body = [
        f'<svg {box} overflow="visible">',
        *_world(tracks, stage),
        *_questions(tracks, stage),
        *_walkers(tracks, stage),
        "</svg>",
        *_words(playback, stage, high + MARGIN),
    ]
    height = number(high + MARGIN + FOOT)
    return "\n".join([*_head(playback, name, height, stage), *body, "</svg>\n"])


def times(playback: Playback) -> list[float]:
    """When each moment begins, in seconds, and when the last one ends."""
    lengths = [_seconds(moment) for moment in playback.moments]
    if not isinstance(playback.trace[-1], ev.Finish):
        lengths[-1] += SECONDS[ev.Finish]
    return [0.0, *accumulate(lengths)]


def _seconds(moment: Moment) -> float:
    if moment.findings:
        return SECONDS[ev.Finish]
    if isinstance(moment.event, ev.Pose) and not moment.event.hypotheses:
        return 0.9
    return SECONDS[type(moment.event)]


def _head(playback: Playback, name: str, height: str, stage: Stage) -> Iterator[str]:
    world = playback.world
    size = f"{map_size(len(world.vertices), len(world.edges))}"
    mapper = f"{name} in " if name else ""
    title = text(f"{mapper}{shown(world.name or 'a world')} ({size}): {playback.cost} moves")
    timing = f".t{{animation:{number(stage.begins[-1])}s step-end infinite}}"
    timing += ".m{animation-timing-function:linear}"
    yield (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}"'
        f' height="{height}" role="img" aria-label="{title}" font-family="{FONT}">'
    )
    yield f"<title>{title}</title><style>{STYLE}{timing}{''.join(stage.rules)}{STILL}</style>"
    yield f'<rect class="card" fill="#fdfcf9" width="{WIDTH}" height="{height}" rx="12"/>'


def _world(tracks: Tracks, stage: Stage) -> Iterator[str]:
    layout, end = tracks.layout, len(tracks.moments)
    r = layout.radius
    vertices, edges = tracks.known_from()
    dots = f'stroke-dasharray="0.1 {number(0.45 * r)}"'
    thin = f'stroke-width="{number(0.15 * r)}"'
    yield (
        '<g fill="none" stroke-linecap="round" stroke-linejoin="round"'
        f' stroke-width="{number(0.2 * r)}">'
    )
    for edge, parts in enumerate(layout.paths):
        data = "".join(parts)
        yield f'<path class="far" {thin} {dots} d="{data}"/>'
        yield f'<g{stage.during((edges[edge], end))}><path class="road" d="{data}"/></g>'
    for bridge in layout.bridges:
        yield f'<path class="halo" stroke-width="{number(0.62 * r)}" d="{bridge.path}"/>'
        yield f'<path class="far" {thin} {dots} d="{bridge.path}"/>'
        known = stage.during((edges[bridge.over], end))
        yield f'<g{known}><path class="road" d="{bridge.path}"/></g>'
    for edge, spans in tracks.asked().items():
        data = "".join(layout.paths[edge])
        yield (
            f'<g{stage.during(*spans)}><path class="e" stroke-width="{number(0.28 * r)}"'
            f' d="{data}"/></g>'
        )
    yield "</g>"
    yield f'<g stroke-width="{number(0.13 * r)}">'
    for vertex, (x, y) in enumerate(layout.centres):
        if vertex in layout.hidden:
            continue
        at = f'cx="{number(x)}" cy="{number(y)}" r="{number(r)}"'
        known = stage.during((vertices[vertex], end))
        yield f'<circle class="far-place" {dots} stroke-linecap="round" {at}/>'
        yield f'<g{known}><circle class="place" {at}/></g>'
    yield "</g>"
    if tracks.world.root is not None:
        yield from arrow(tracks.world, layout, tracks.world.root)


def _questions(tracks: Tracks, stage: Stage) -> Iterator[str]:
    size = 0.5 * tracks.layout.radius
    yield f'<g font-size="{number(1.25 * size)}" font-weight="700" text-anchor="middle">'
    for badge in tracks.badges():
        x, y = badge.at
        for first, last, kind, words in badge.faces:
            yield (
                f'<g{stage.during((first, last))}><circle class="{kind}" cx="{number(x)}"'
                f' cy="{number(y)}" r="{number(size)}"/><text class="on" x="{number(x)}"'
                f' y="{number(y + 0.44 * size)}">{words}</text></g>'
            )
    yield "</g>"


def _walkers(tracks: Tracks, stage: Stage) -> Iterator[str]:
    r = tracks.layout.radius
    line = f'fill="none" stroke-width="{number(0.2 * r)}"'
    dots = f'stroke-dasharray="{number(0.5 * r)}"'
    for ((x, y), is_expected), spans in tracks.clashes().items():
        at = f'cx="{number(x)}" cy="{number(y)}" r="{number((2 if is_expected else 1.6) * r)}"'
        at += f" {dots}" if is_expected else ""
        yield f'<g{stage.during(*spans)}><circle class="ring" {line} {at}/></g>'
    for ghost in tracks.ghosts():
        ring = f'<circle class="ghost" {line} {dots} r="{number(1.3 * r)}"/>'
        way = timed(ghost.steps, stage.begins)
        going = stage.moving([(at, *points[-1], None) for at, points in way])
        yield f"<g{stage.during(ghost.span)}><g{going}>{ring}</g></g>"
    size = 0.74 * r
    notch = f"M{number(0.9 * size)} 0L{number(0.05 * size)} {number(0.5 * size)}"
    yield (
        f'<g{stage.moving(list(_turned(tracks, stage)))}><circle class="robot"'
        f' stroke-width="{number(0.12 * r)}" r="{number(size)}"/>'
        f'<path class="notch" d="{notch}V{number(-0.5 * size)}Z"/></g>'
    )


def _turned(tracks: Tracks, stage: Stage) -> Iterator[Keyframe]:
    turn, departed = tracks.first_turn(), 0.0
    for at, points in timed(tracks.robot(), stage.begins):
        if len(points) == 1:
            departed = at
        else:
            (x, y), before = points[-1], points[-2]
            back = math.degrees(math.atan2(before[1] - y, before[0] - x))
            back = turn + (back - turn + 180) % 360 - 180  # the short way round
            if len(points) == 2:
                yield departed + 0.15 * (at - departed), *before, back
            turn = back
        yield at, *points[-1], turn


def _words(playback: Playback, stage: Stage, top: float) -> Iterator[str]:
    captioned = [_caption(saying, top) for saying in captions(playback)]
    for first, last, caption in _spans(captioned):
        yield f"<g{stage.during((first, last))}>{caption}</g>"
    costs = [moment.spent.cost for moment in playback.moments]
    x, y = number(WIDTH - MARGIN - 6), number(MARGIN + 8)
    yield '<g font-size="13" text-anchor="end">'
    for first, last, cost in _spans(costs):
        words = plural(cost, "move")
        shown_during = stage.during((first, last))
        yield f'<g{shown_during}><text class="soft" x="{x}" y="{y}">{words}</text></g>'
    yield "</g>"


def _caption(saying: Saying, top: float) -> str:
    x, kind = MARGIN + 8, f' class="{saying.kind}"' if saying.kind else ""
    compared = saying.seen, saying.expected if saying.kind == "bad" else None
    columns = COLUMNS if None in compared else BESIDE
    words = (
        f'<text{kind} x="{x}" y="{number(top + 34)}" font-size="17" font-weight="700">'
        f"{text(saying.title, limit=64)}</text>"
    )
    for row, line in enumerate(wrap(saying.text, columns, max_lines=2, placeholder=" …")):
        words += f'<text class="soft" x="{x}" y="{number(top + 56 + 18 * row)}" font-size="14">'
        words += f"{text(line)}</text>"
    seen, expected = compared
    if seen is None or expected is None:
        return words
    right = WIDTH - MARGIN
    unequal = f'<text class="bad" x="{right - 90}" y="{number(top + 34)}" font-size="22">≠</text>'
    seen_here = glyph(seen, right - 124, top + 26, saying.labels[0])
    return words + seen_here + unequal + glyph(expected, right - 42, top + 26, saying.labels[1])


def _spans(values: Sequence[T]) -> Iterator[tuple[int, int, T]]:
    """The stretches of equal values: the first, the one after the last, the value."""
    first = 0
    for place in range(1, len(values) + 1):
        if place == len(values) or values[place] != values[first]:
            yield first, place, values[first]
            first = place


def captions(playback: Playback) -> Sequence[Saying]:
    """The caption of each moment: its sentence, or its first finding."""
    sayings = [
        _wrong(moment.findings[0].message) if moment.findings else saying
        for moment, saying in zip(playback.moments, Narrator(playback).sayings, strict=True)
    ]
    last = playback.moments[-1]
    if playback.about_the_run and not last.findings:
        sayings[-1] = _wrong(playback.about_the_run[0].message)
    elif playback.stopped is not None and not last.findings:
        sayings[-1] = Saying("bad", "The run ends without a map", (shown(playback.stopped),))
    return sayings


def _wrong(message: str) -> Saying:
    return Saying("bad", "Here the mapper goes wrong", (shown(message),))


def glyph(percept: Percept, x: float, y: float, label: str) -> str:
    """A place as the robot sees it: its exits as spokes, the way it came downwards, in blue."""
    degree = percept.degree
    parts = [f'<g transform="translate({number(x)} {number(y)})" stroke-linecap="round">']
    parts.append(f'<text class="soft" y="44" font-size="12" text-anchor="middle">{label}</text>')
    if degree > MOST_SPOKES:
        parts.append(f'<text y="5" font-size="15" text-anchor="middle">{degree}</text></g>')
        return "".join(parts)
    for door in range(degree):
        turn = math.tau * door / degree + math.tau / 4
        if door == percept.marker:
            tip = "M26 0l-9 -5v10z"
            parts.append(
                f'<g transform="rotate({number(math.degrees(turn))})"><path class="tv-mark"'
                f' stroke-width="3.5" d="M9 0H18"/><path class="tv-tip" d="{tip}"/></g>'
            )
        else:
            ends = [f"{number(r * math.cos(turn))} {number(r * math.sin(turn))}" for r in (9, 23)]
            kind = "e" if door == 0 else "road spoke"
            parts.append(f'<path class="{kind}" stroke-width="3.5" d="M{ends[0]}L{ends[1]}"/>')
    parts.append('<circle class="place spoke" stroke-width="2" r="8"/></g>')
    return "".join(parts)
