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
from typing import NamedTuple, assert_never

from topo_verify.checkers.darts import KnownDart
from topo_verify.checkers.folding import Contradiction, Fold
from topo_verify.checkers.map_on_fold import MapOnFold
from topo_verify.errors import InputError
from topo_verify.robot.events import Augment, Confirm, Event, Finish, MapData, Move, Reject, Start
from topo_verify.robot.percept import Percept
from topo_verify.world.rooted_map import Code, World


class Conclusion(NamedTuple):
    """Why what was concluded at event `when` does not follow ("": it does), and a witness."""

    when: int
    why: str
    witness: World | None = None


def fold_history(trace: Sequence[Event]) -> tuple[Fold, tuple[int, str] | None]:
    """The fold of a trace; and the first event with which no world shows it, and why, or None."""
    assert isinstance(trace[0], Start)
    fold = Fold(trace[0].percept)
    for when, event in enumerate(trace):
        if why := followed(fold, event):
            return fold, (when, why)
    return fold, None


def followed(fold: Fold, event: Event) -> str:
    """Let the fold grow by an event. Returns why no world shows the history now, or ""."""
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
    """The canonical code of a delivered map, which claims 5 and 9 ask for. Raises InputError."""
    return World.from_rotations(delivered.vertices, delivered.edges, delivered.marker).code


def map_conclusion(trace: Sequence[Event]) -> Conclusion:
    """Whether the history alone proves the map that was delivered (claim 9).

    If a dart of the fold is open, two worlds show the history; the map is at most one of them.
    """
    finish, last = trace[-1], len(trace) - 1
    if not isinstance(finish, Finish):
        return Conclusion(0, "no map was delivered")
    fold, broken = fold_history(trace)
    if broken is not None:
        return Conclusion(broken[0], f"no world shows this history: {broken[1]}")
    try:
        code = delivered_code(finish.map)
    except InputError as error:
        return Conclusion(last, f"the delivered value is not a map: {error}")
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
    on_fold = MapOnFold(fold)
    planar = any(isinstance(event, Reject) and event.rule == "planar" for event in trace)
    for when, event in enumerate(trace):
        if why := followed(fold, event):
            yield Conclusion(when, f"no world shows this history: {why}")
            return
        if not isinstance(event, (Reject, Confirm, Augment)):
            continue
        if why := _unknown_dart(on_fold, event):
            yield Conclusion(when, why)
            return
        doubt = _doubt(on_fold, event, planar=planar)
        why, witness = doubt or ("", None)
        yield Conclusion(when, why, witness)
        if isinstance(event, Augment):
            if doubt is not None:  # from here on S is not proved
                return
            on_fold.grow(event)


Doubt = tuple[str, World]
"""Why a decision does not follow, and a world with the same history in which it is false."""


def _unknown_dart(on_fold: MapOnFold, event: Reject | Confirm | Augment) -> str:
    """Which dart that a decision names is not the one that it must be; "" if all are."""
    other = event.dart if isinstance(event, Augment) else event.hypothesis
    if isinstance(event, Augment) and event.kind == "new":
        right = other == on_fold.size
    else:
        right = on_fold.is_open(other)
    if right and on_fold.is_open(event.edge):
        return ""
    return f"{event.edge} or {other} is not an unexplored dart of S"


def _doubt(on_fold: MapOnFold, event: Reject | Confirm | Augment, *, planar: bool) -> Doubt | None:
    """Why a decision does not follow from the history, or None if it does.

    Its darts are unexplored darts of S. `planar`: only a planar world counts as a witness.
    """
    e = KnownDart(event.edge)
    match event:
        case Reject(_, h):
            return _may_lead_to(on_fold, e, [KnownDart(h)], planar=planar)
        case Confirm(_, h):
            return _may_be_apart(on_fold, e, KnownDart(h))
        case Augment(_, "new", _, degree):
            return _may_be_known(on_fold, e, degree) or _may_lead_to(
                on_fold, e, on_fold.others(e), planar=planar
            )
        case Augment(_, _, h, degree):
            return _may_be_apart(on_fold, e, KnownDart(h)) or _has_another_degree(
                on_fold, KnownDart(h), degree
            )
        case _:
            assert_never(event)


def _may_lead_to(
    on_fold: MapOnFold, e: KnownDart, ends: Sequence[KnownDart], *, planar: bool
) -> Doubt | None:
    """Folding with e joined to each of these must contradict; else the fold shows an end of e."""
    fold = on_fold.fold
    for end in ends:
        with suppress(Contradiction), fold.assuming(on_fold.place(e), on_fold.place(end)):
            witness = fold.world()
            if witness.is_planar or not planar:
                return "the edge may well lead there", witness
    return None


def _may_be_apart(on_fold: MapOnFold, e: KnownDart, h: KnownDart) -> Doubt | None:
    """Folding must make e and h partners; else they belong to different edges of the fold."""
    if on_fold.are_partners(e, h):
        return None
    return f"darts {e} and {h} may well belong to different edges", on_fold.fold.world()


def _has_another_degree(on_fold: MapOnFold, h: KnownDart, degree: int) -> Doubt | None:
    """The degree that is stated must be that of the vertex of h."""
    node, _ = on_fold.place(h)
    if on_fold.fold.degree(node) == degree:
        return None
    return "the vertex there has another degree", on_fold.fold.world()


def _may_be_known(on_fold: MapOnFold, e: KnownDart, degree: int) -> Doubt | None:
    """The edge e must have been crossed, to a place of this degree that is no vertex of S."""
    fold = on_fold.fold
    entry = fold.partner(on_fold.place(e))
    if entry is None:  # a leaf may be behind e, and if a leaf is claimed, a vertex of degree 2
        return "the edge was never crossed", fold.world(2 if degree == 1 else 1)
    if fold.degree(entry[0]) != degree or on_fold.is_known(entry[0]):
        return "the edge leads to another vertex", fold.world()
    return None
