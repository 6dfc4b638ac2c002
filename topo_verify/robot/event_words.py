"""An event in one exact sentence, as the mapper states it; no world is needed.

Percepts are short: `5` is degree 5 with no marker, `5, marker 2` has the marker at door 2.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import assert_never

from topo_verify.errors import plural
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Door, Percept

MOST = 12
"""Items of a list; more are cut."""


def event_words(event: ev.Event, *, brief: bool = False) -> str:  # noqa: PLR0911  one a kind
    """The sentence of an event; if `brief`, with few hypotheses and no degree behind a loop."""
    match event:
        case ev.Start(percept=percept):
            return f"starts and sees {percept_in_brackets(percept)}"
        case ev.Move(door, percept):
            return f"takes door {door} and sees {percept_in_brackets(percept)}"
        case ev.Pose(edge, hypotheses):
            names = listed(hypotheses, most=MOST if brief else len(hypotheses))
            to = f"to {names} or" if hypotheses else "no hypothesis, so"
            return f"asks where edge {edge} leads: {to} to a new vertex"
        case ev.Reject():
            return f"{rejection_words(event)}{_declared_evidence(event.evidence)}"
        case ev.Confirm(edge, hypothesis, rule):
            return f"confirms that edge {edge} leads to {hypothesis} (by {rule})"
        case ev.Augment():
            return f"S grows: edge {event.edge} leads to {_grown(event, brief=brief)}"
        case ev.Finish(cost, delivered):
            size = plural(len(delivered.vertices), "vertex", "vertices")
            words = f"delivers a map of {size} and {plural(len(delivered.edges), 'edge')}"
            return words if cost is None else f"{words}, and a cost of {cost}"
        case _:
            assert_never(event)


def _grown(event: ev.Augment, *, brief: bool) -> str:
    dart, degree = event.dart, event.degree
    if event.kind == "loop":
        return f"{dart}" if brief else f"{dart}, of degree {degree}"
    darts = f"dart {dart}" if degree == 1 else f"darts {dart} to {dart + degree - 1}"
    return f"a new vertex, {darts}"


def rejection_words(event: ev.Reject) -> str:
    """How the sentence of a rejection begins; its evidence follows."""
    return f"rejects that edge {event.edge} leads to {event.hypothesis} (by {event.rule}): "


def cited_words(cited: ev.Evidence) -> str:
    """The two percepts that evidence cites."""
    expected, observed = map(percept_in_brackets, (cited.expected, cited.observed))
    return f"expects {expected}, saw {observed}"


def _declared_evidence(cited: ev.Evidence) -> str:
    if cited.contradiction is not None:
        return cited.contradiction
    words = f"{cited_words(cited)} at step {cited.step}"
    words += "" if cited.sequence is None else f" of sequence {cited.sequence}"
    words += "" if cited.at is None else f", at dart {cited.at}"
    if cited.record is not None:
        doors = door_words(cited.record.doors)
        words += f", from the record behind dart {cited.record.dart}, {doors}"
    return words


# ---------------------------------------------------------------- percepts, doors, lists


def percept_words(percept: Percept | None) -> str:
    """The degree, and the marker's door if the marker is here."""
    if percept is None:
        return "nothing"
    marker = "" if percept.marker is None else f", marker {percept.marker}"
    return f"{percept.degree}{marker}"


def percept_in_brackets(percept: Percept | None) -> str:
    """A percept within a sentence: `(5, marker 2)`, or `nothing`."""
    return "nothing" if percept is None else f"({percept_words(percept)})"


def door_words(doors: Sequence[Door]) -> str:
    """Doors in the order in which they are taken: `doors 1 0 2`."""
    if not doors:
        return "no door"
    return f"door{'s' if len(doors) > 1 else ''} {' '.join(map(str, doors))}"


def listed(things: Iterable[object], none: str = "none", *, most: int = MOST) -> str:
    """The things with commas, at most `most` of them."""
    texts = [str(thing) for thing in things]
    if len(texts) > most:
        texts = [*texts[:most], f"and {len(texts) - most} more"]
    return ", ".join(texts) or none
