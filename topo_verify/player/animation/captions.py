"""What a moment of a run means, in a sentence or two for everybody, and what is seen as a glyph.

A vertex is a place here, an edge a road, a dart an exit, a hypothesis a guess.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import assert_never

from topo_verify.player.scenes import Moment, Playback
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept
from topo_verify.text import plural, shown
from topo_verify.world.drawing.curves import number

MOVES = {
    "cross": ("A new road", "Was it ever at the other end? Places do not tell.", "ask"),
    "walk": ("On to the next unexplored exit", "Along roads that are on its map.", ""),
    "validate": ("It tests {}", "The ring is where it would be if {} were right.", ""),
    "retrace": ("Back to where the road ended", "It knows by which doors it came.", ""),
    None: ("The robot moves on", "", ""),
}

OPENING = (
    "A robot that recognises nothing but the marker",
    "It sees how many exits a place has, and knows by which one it came.",
)

MOST_SPOKES = 12
"""A glyph of more exits is their number."""


@dataclass(frozen=True)
class Caption:
    """What is said of a moment.

    Attributes:
        words, detail: the sentence in bold, and what stands below it.
        kind: its colour: `bad`, `ok`, `ask` or none.
        seen, expected: the percepts that differ, at a rejection.
    """

    words: str
    detail: str = ""
    kind: str = ""
    seen: Percept | None = None
    expected: Percept | None = None


def captions(playback: Playback) -> list[Caption]:
    """What is said of each moment."""
    told = list(_told(playback))
    last = playback.moments[-1]
    if playback.about_the_run and not last.findings:
        told[-1] = _wrong(playback.about_the_run[0].message)
    elif playback.stopped is not None and not last.findings:
        told[-1] = Caption("The run ends without a map", shown(playback.stopped), "bad")
    return told


def _told(playback: Playback) -> Iterator[Caption]:
    tested = _tested(playback)
    pose = list[int]()
    for moment in playback.moments:
        if isinstance(moment.event, ev.Pose):
            pose = list(moment.event.hypotheses)
        if moment.findings:
            yield _wrong(moment.findings[0].message)
        else:
            yield _sentence(playback, moment, pose, tested.get(moment.number))


def _wrong(message: str) -> Caption:
    return Caption("Here the mapper goes wrong", shown(message), "bad")


def _tested(playback: Playback) -> dict[int, int]:
    """By moment of a validating move, the hypothesis that the next decision is about."""
    tested: dict[int, int] = {}
    goal = None
    for moment in reversed(playback.moments):
        event = moment.event
        if isinstance(event, ev.Reject | ev.Confirm):
            goal = event.hypothesis if event.rule == "motion" else goal
        elif goal is not None:
            tested[moment.number] = goal
    return tested


def _sentence(playback: Playback, moment: Moment, pose: list[int], goal: int | None) -> Caption:
    told = Caption(*OPENING)
    match moment.event:
        case ev.Start():
            pass
        case ev.Move(purpose=purpose):
            words, detail, kind = MOVES[purpose]
            meant = f"guess {pose.index(goal) + 1}" if goal in pose else "a guess"
            told = Caption(words.format(meant), detail.format(meant), kind)
        case ev.Pose(hypotheses=guesses):
            told = _posed(len(guesses))
        case ev.Reject() as reject:
            told = _rejected(reject, pose)
        case ev.Confirm(hypothesis=h, rule=rule):
            guess = pose.index(h) + 1 if h in pose else "this"
            walked = "From there the same doors lead to the marker, and so they did."
            why = walked if rule == "motion" else "What it saw before leaves nothing else."
            told = Caption(f"Guess {guess} is right", why, "ok")
        case ev.Augment(kind="new"):
            told = Caption(
                "A new place on the map", "It is none of the places where the road could end.", "ok"
            )
        case ev.Augment():
            told = Caption("The road closes a circle", "No new place: it was here before.", "ok")
        case ev.Finish():
            told = _finished(playback)
        case _:
            assert_never(moment.event)
    return told


def _posed(guesses: int) -> Caption:
    if not guesses:
        return Caption("Nothing on the map looks like this", "So the place is new.")
    count = "There is one guess" if guesses == 1 else f"There are {guesses} guesses"
    return Caption(
        f"Was it here before? {count}",
        "A guess is an unexplored exit of a place that looks like this one.",
    )


def _finished(playback: Playback) -> Caption:
    least = playback.world.least_cost()
    detail = f"{plural(playback.cost, 'move')}; with the map in hand, a proof takes {least}."
    if playback.findings:
        return Caption("The mapper delivers a map", detail)
    return Caption("The map is complete, and nothing in it is a guess", detail, "ok")


def _rejected(reject: ev.Reject, pose: list[int]) -> Caption:
    guess = pose.index(reject.hypothesis) + 1 if reject.hypothesis in pose else "this"
    cited = reject.evidence
    if cited.observed is None or cited.expected is None:
        why = cited.contradiction or "two things that cannot both be"
        return Caption(f"Guess {guess} is wrong", f"With it, {shown(why)}.", "bad")
    walked = reject.rule == "motion"
    words = f"Guess {guess} is wrong" + ("" if walked else " too, without a step")
    sees = "It sees" if walked else "That walk saw"
    detail = f"{sees} {_sight(cited.observed)}, not {_sight(cited.expected)}."
    if cited.observed.signature == cited.expected.signature:
        detail = f"{sees} the marker point to another exit than it would."
    return Caption(words, detail, "bad", cited.observed, cited.expected)


def _sight(percept: Percept) -> str:
    marker = " and the marker" if percept.marker is not None else ""
    return f"{plural(percept.degree, 'exit')}{marker}"


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
