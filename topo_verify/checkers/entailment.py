"""Claims 9 and 10: what a mapper concluded must follow from its history, not from luck.

Trusted. A mapper that guesses right passes every check that looks at one world. Here its history is
folded, and each conclusion must hold in EVERY world that shows this history; where it does not, the
answer carries a **witness**: a world with the same history in which the conclusion is false. For a
mapper that declares the planar prior (it rejects by rule `planar`), only planar witnesses count.

What this does not show: under the planar prior the only witness that is tried is the fold itself,
leaves hung. Where that is not planar, a planar world that folds it further may still exist, and the
decision passes. Never the other way: what fails here is refuted by a world that is there to see.

Source: docs/semantics.md, sections 9 and 11.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from functools import lru_cache
from typing import NamedTuple

from topo_verify.checkers.folding import Contradiction, Fold, Place
from topo_verify.errors import InputError
from topo_verify.robot.events import Augment, Confirm, Event, Finish, MapData, Move, Reject, Start
from topo_verify.robot.percept import Percept
from topo_verify.world.rooted_map import Code, World


class Conclusion(NamedTuple):
    """What was concluded at event `when`: why it does not follow ("": it does), and a witness."""

    when: int
    why: str
    witness: World | None = None


def fold_history(trace: Sequence[Event]) -> tuple[Fold, tuple[int, str] | None]:
    """The fold of a trace; and at which move, and why, no world shows it any more, if so."""
    assert isinstance(trace[0], Start)
    fold = Fold(trace[0].percept)
    for when, event in enumerate(trace):
        if why := _followed(fold, event):
            return fold, (when, why)
    return fold, None


def _followed(fold: Fold, event: Event) -> str:
    """Let the fold grow by an event; why no world shows the history any more, or ""."""
    if isinstance(event, Move):
        try:
            fold.move(event.door, event.percept)
        except Contradiction as contradiction:
            return str(contradiction)
    elif isinstance(event, Start):
        seen = event.percept
        if not seen.marker == 0 < seen.degree and seen != Percept(0, None):
            return f"the robot starts on the marked dart and cannot see {seen}"
    return ""


@lru_cache(maxsize=16)
def delivered_code(delivered: MapData) -> Code:
    """The canonical code of a delivered map; asked twice a run. Raises InputError: it is none."""
    return World.from_rotations(delivered.vertices, delivered.edges, delivered.marker).code


def map_conclusion(trace: Sequence[Event]) -> Conclusion:
    """Does the history alone prove the map that was delivered?"""
    finish, last = trace[-1], len(trace) - 1
    if not isinstance(finish, Finish):
        return Conclusion(0, "no map was delivered")
    fold, broken = fold_history(trace)
    if broken is not None:
        return Conclusion(broken[0], f"no world shows this history: {broken[1]}")
    try:
        code = delivered_code(finish.map)
    except InputError as error:
        return Conclusion(last, f"what was delivered is no map: {error}")
    left = fold.open_darts()
    why = f"darts never crossed: {left}" if left else "the history proves another map"
    for witness in (fold.world(1), fold.world(2)) if left else (fold.world(),):
        if witness.code != code:
            return Conclusion(last, why, witness)
    return Conclusion(last, "")


def decision_conclusions(trace: Sequence[Event]) -> Iterator[Conclusion]:
    """Every declared reject, confirm and augmentation, up to the first that draws a wrong S."""
    assert isinstance(trace[0], Start)
    fold = Fold(trace[0].percept)
    seats: list[Place] = [(0, door) for door in range(fold.degree(0))]  # where the darts of S are
    opened = set(range(len(seats)))
    prior = any(isinstance(event, Reject) and event.rule == "planar" for event in trace)
    for when, event in enumerate(trace):
        if why := _followed(fold, event):
            yield Conclusion(when, f"no world shows this history: {why}")
            return
        if not isinstance(event, (Reject, Confirm, Augment)):
            continue
        new = isinstance(event, Augment) and event.kind == "new"
        other = event.dart if isinstance(event, Augment) else event.hypothesis
        if event.edge not in opened or other not in ([len(seats)] if new else opened):
            yield Conclusion(when, f"{event.edge} or {other} is no unexplored dart of S")
            return
        e = seats[event.edge]
        if isinstance(event, Reject):
            conclusion = _leads_to_none(fold, when, e, [seats[other]], prior=prior)
        elif new:
            assert isinstance(event, Augment)
            rest = [seats[h] for h in sorted(opened - {event.edge})]
            conclusion = _new(fold, when, e, event.degree, seats)
            if not conclusion.why:
                conclusion = _leads_to_none(fold, when, e, rest, prior=prior)
        elif fold.partner(e) != fold.find(seats[other]):
            why = f"darts {event.edge} and {other} may well belong to different edges"
            conclusion = Conclusion(when, why, fold.world())
        elif isinstance(event, Augment) and event.degree != fold.degree(seats[other][0]):
            conclusion = Conclusion(when, "the vertex there has another degree", fold.world())
        else:
            conclusion = Conclusion(when, "")
        yield conclusion
        if isinstance(event, Augment):
            if conclusion.why:
                return
            if new:
                entry = fold.partner(e)
                assert entry is not None, "a crossed edge has two ends"
                opened |= set(range(len(seats), len(seats) + event.degree))
                seats += [(entry[0], entry[1] + door) for door in range(event.degree)]
            opened -= {event.edge, other}


def _new(fold: Fold, when: int, e: Place, degree: int, seats: Sequence[Place]) -> Conclusion:
    """Was e crossed, to a place of this degree that is not known to be a vertex of S?"""
    entry = fold.partner(e)
    if entry is None:
        return Conclusion(when, "the edge was never crossed", fold.world(2 if degree == 1 else 1))
    if fold.degree(entry[0]) != degree or entry[0] in {fold.find(seat)[0] for seat in seats}:
        return Conclusion(when, "the edge leads to another vertex", fold.world())
    return Conclusion(when, "")


def _leads_to_none(
    fold: Fold, when: int, e: Place, ends: Sequence[Place], *, prior: bool
) -> Conclusion:
    """Does a contradiction follow from each of these being the other end of e?"""
    for end in ends:
        with suppress(Contradiction), fold.assuming(e, end):
            witness = fold.world()
            if witness.is_planar or not prior:
                return Conclusion(when, "the edge may well lead there", witness)
    return Conclusion(when, "")
