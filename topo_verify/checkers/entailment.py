"""Claims 9 and 10: what a mapper concluded must follow from its history, not from luck.

Trusted. The history is folded, and each conclusion must hold in EVERY world that shows it. If not,
the answer carries a **witness**: such a world in which the conclusion is false.

For a mapper that declares the planar prior (it rejects by rule `planar`), only planar witnesses
count. They are looked for among the fold and its further foldings; any planar world with this
history folds onto one of these. After `FURTHER` foldings in a run the decision is **undecided**.

What this does not show: a confirmation or a loop that follows from the prior alone fails here.

Source: docs/semantics.md, sections 9 and 11.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
from contextlib import suppress
from copy import deepcopy
from itertools import islice
from typing import NamedTuple

from topo_verify.checkers.darts import KnownDart
from topo_verify.checkers.folding import Contradiction, Fold, Pair
from topo_verify.checkers.map_on_fold import MapOnFold
from topo_verify.errors import InputError, plural
from topo_verify.robot.events import Augment, Confirm, Event, Finish, MapData, Move, Reject, Start
from topo_verify.robot.percept import Percept
from topo_verify.world.rooted_map import Code, World

CONCLUDED = Reject, Confirm, Augment
Concluded = Reject | Confirm | Augment
"""A decision on where an edge leads, or does not."""

Tries = Iterator[int] | None
"""The foldings that may still be tried; None without the planar prior."""


class Conclusion(NamedTuple):
    """Why what was concluded at event `when` does not follow ("" if it does), and a witness.

    Attributes:
        met: the contradiction that a rejection cites follows.
    """

    when: int
    why: str
    witness: World | None = None
    met: bool = False


FURTHER = 300
"""The most foldings tried in one run."""


class FoldedTrace:
    """A trace, and the fold of the events read so far.

    Attributes:
        read: the number of events read.
        broken: the first event with which no world shows the history, and why; or None.
    """

    def __init__(self, trace: Sequence[Event], fold: Fold | None = None) -> None:
        assert isinstance(trace[0], Start)
        self.trace, self.fold, self.read = trace, fold or Fold(trace[0].percept), 0
        self.broken: tuple[int, str] | None = None

    def read_to(self, end: int) -> tuple[int, str] | None:
        """Read on up to event number `end`, excluded, and return `broken`."""
        while self.read < end and self.broken is None:
            event = self.trace[self.read]
            try:
                if type(event) is Move:
                    self.fold.move(event.door, event.percept)
                elif type(event) is Start:
                    _require_start(event.percept)
            except Contradiction as contradiction:
                self.broken = self.read, str(contradiction)
            self.read += 1
        return self.broken


def _require_start(seen: Percept) -> None:
    """Raise Contradiction unless some world shows this to a robot on the marked dart."""
    if not seen.marker == 0 < seen.degree and seen != Percept(0, None):
        raise Contradiction(f"at the start door 0 is the marked one, so {seen} cannot be seen")


def delivered_code(delivered: MapData) -> Code | str:
    """The canonical code of a delivered map, or why it is not a map."""
    try:
        return World.from_rotations(delivered.vertices, delivered.edges, delivered.marker).code
    except InputError as error:
        return f"the delivered value is not a map: {error}"


def map_conclusion(folded: FoldedTrace, code: Code | str | None = None) -> Conclusion:
    """Whether the history alone proves the delivered map (claim 9); `code`: as `delivered_code`."""
    fold, finish, last = folded.fold, folded.trace[-1], len(folded.trace) - 1
    if type(finish) is not Finish:
        return Conclusion(0, "no map was delivered")
    if broken := folded.read_to(last):
        return Conclusion(broken[0], f"no world shows this history: {broken[1]}")
    code = code or delivered_code(finish.map)
    if isinstance(code, str):
        return Conclusion(last, code)
    if fold.table(0) == code:
        return Conclusion(last, "")
    number = fold.open_darts()
    why = f"{plural(number, 'door')} seen and never crossed" if number else "it proves another map"
    witness = fold.world(1)
    return Conclusion(last, why, fold.world(2) if witness.code == code else witness)


def decision_conclusions(folded: FoldedTrace) -> Iterator[Conclusion]:
    """Every declared reject, confirm and augmentation, up to the first that draws an unproved S."""
    trace = folded.trace
    on_fold = MapOnFold(folded.fold)
    rules = {event.rule for event in trace if type(event) is Reject}
    tries = iter(range(FURTHER)) if "planar" in rules else None
    refuted: set[tuple[int, int]] = set()  # for good: S and the history only grow
    for when, event in enumerate(trace):
        if type(event) is Move or not isinstance(event, CONCLUDED):
            continue
        if folded.read_to(when):
            break
        if why := _unknown_dart(on_fold, event):
            yield Conclusion(when, why)
        else:
            why, witness = _doubt(on_fold, event, refuted, tries)
            yield Conclusion(when, why, witness, _is_met(on_fold, event))
        if type(event) is Augment:
            if why:  # from here on S is not proved
                return
            on_fold.grow(event)
        elif not why:
            refuted.add((event.edge, event.hypothesis))
    if broken := folded.read_to(len(trace)):
        yield Conclusion(broken[0], f"no world shows this history: {broken[1]}")


Doubt = tuple[str, World | None]

FOLLOWS: Doubt = ("", None)

UNDECIDED: Doubt = ("no planar world was found in which it is false, nor that none exists", None)


def _is_met(on_fold: MapOnFold, event: Concluded) -> bool:
    if type(event) is not Reject or event.rule not in ("folding", "planar"):
        return False
    e, h, cited = KnownDart(event.edge), KnownDart(event.hypothesis), event.evidence.contradiction
    if event.rule == "planar":
        return cited == "it lies on another face than e" and h not in on_fold.face(e)
    met = on_fold.fold.contradictions(on_fold.places[e], on_fold.places[h], on_fold.entries)
    return any(contradiction == cited for contradiction, _ in met)


def _unknown_dart(on_fold: MapOnFold, event: Concluded) -> str:
    other = event.dart if type(event) is Augment else event.hypothesis
    is_new = type(event) is Augment and event.kind == "new"
    is_right = other == len(on_fold.places) if is_new else on_fold.is_open(other)
    fits = is_right and on_fold.is_open(event.edge)
    return "" if fits else f"{event.edge} or {other} is not an unexplored dart of S"


def _doubt(
    on_fold: MapOnFold, event: Concluded, refuted: Container[tuple[int, int]], tries: Tries
) -> Doubt:
    e = KnownDart(event.edge)
    if type(event) is Reject:
        return _may_lead_to(on_fold, e, [KnownDart(event.hypothesis)], tries)
    if type(event) is Confirm:
        return _may_be_apart(on_fold, e, KnownDart(event.hypothesis), None)
    if event.kind == "loop":
        return _may_be_apart(on_fold, e, KnownDart(event.dart), event.degree)
    ends = [h for h in on_fold.others(e) if (e, h) not in refuted]
    return _may_be_known(on_fold, e, event.degree) or _may_lead_to(on_fold, e, ends, tries)


def _may_lead_to(on_fold: MapOnFold, e: KnownDart, ends: list[KnownDart], tries: Tries) -> Doubt:
    """Folding with e joined to each of these must contradict; else the fold shows an end of e."""
    fold, doubt = on_fold.fold, FOLLOWS
    # with the prior, the fold may not tell vertices of S apart
    face, apart = (ends, ()) if tries is None else (on_fold.face(e), on_fold.entries)
    behind = fold.partner(on_fold.places[e])
    for end in ends:
        places = on_fold.places[e], on_fold.places[end]
        # asked first, since it refutes most
        is_other = behind is not None and fold.are_apart(behind, places[1])
        if is_other or end not in face or any(fold.contradictions(*places, apart)):
            continue
        joined = deepcopy(fold)
        joined.join(*places)
        if tries is None:
            return "the edge may well lead there", joined.world()
        if witness := _planar_folding(joined, tuple(islice(joined.alike(), FURTHER)), tries):
            return "the edge may well lead there", witness
        if next(tries, None) is None:
            doubt = UNDECIDED
    return doubt


def _planar_folding(fold: Fold, pairs: Sequence[Pair], tries: Iterator[int]) -> World | None:
    """The fold, or what it becomes if some of these pairs are each one dart, if it is planar."""
    world = fold.world()
    if world.is_planar:
        return world
    for number, pair in enumerate(pairs, 1):
        if next(tries, None) is None:
            break
        with suppress(Contradiction):
            further = deepcopy(fold)
            further.identify(*pair)
            if found := _planar_folding(further, pairs[number:], tries):
                return found
    return None


def _may_be_apart(on_fold: MapOnFold, e: KnownDart, h: KnownDart, degree: int | None) -> Doubt:
    """Folding must make e and h partners, at a vertex of the stated degree, if any."""
    fold = on_fold.fold
    if fold.partner(on_fold.places[e]) != fold.find(on_fold.places[h]):
        return f"darts {e} and {h} may well belong to different edges", fold.world()
    if degree not in (None, fold.degree(on_fold.places[h][0])):
        return "the vertex there has another degree", fold.world()
    return FOLLOWS


def _may_be_known(on_fold: MapOnFold, e: KnownDart, degree: int) -> Doubt | None:
    """The edge e must have been crossed, to a place of this degree that is not a vertex of S."""
    fold, entry = on_fold.fold, on_fold.fold.partner(on_fold.places[e])
    if entry is None:  # if a leaf is claimed, a vertex of degree 2 may be there, else a leaf
        return "the edge was never crossed", fold.world(2 if degree == 1 else 1)
    if fold.degree(entry[0]) != degree or on_fold.is_known(entry[0]):
        return "the edge leads to another vertex", fold.world()
    return None
