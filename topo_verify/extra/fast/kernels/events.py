"""The trace of a compiled run: words, and the events of robot/events.py that they mean.

    words                                                          event
    MOVE door percept purpose                                      Move
    POSE e n h1 … hn                                               Pose
    REJECT e h length rule step expected observed sequence at      Reject
           record contradiction k door1 … doork
    CONFIRM e h rule                                               Confirm
    AUGMENT e kind dart degree                                     Augment
    FINISH cost                                                    Finish, without its map

A percept is `degree * P`, plus 1 + marker if present; -1 means absent. `length` is 13 + k.
`purpose`, `rule` and `contradiction` are indices of `PURPOSES`, `RULES` and `CONTRADICTIONS`;
`kind` is 1 (new) or 2 (loop). `record` is the dart before a record, followed by doors.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from typing import Annotated, Literal, get_args

from topo_verify.errors import InternalError
from topo_verify.extra.fast.kernels.kernel import entry
from topo_verify.extra.fast.kernels.names import Words, WordView, cursor
from topo_verify.extra.fast.kernels.workspace import P, TraceWords
from topo_verify.robot import events as ev
from topo_verify.robot.percept import PURPOSES, Percept, Purpose
from topo_verify.robot.simulator import shared_move

MOVE, POSE, REJECT, CONFIRM, AUGMENT, FINISH = range(1, 7)

WALK, CROSS, VALIDATE, RETRACE = range(4)
"""Indices of `PURPOSES`."""

RULES: tuple[ev.RuleName, ...] = get_args(ev.RuleName)
BY_MOTION, BY_PREFIX, BY_HISTORY, BY_RECORDS, BY_FOLDING, BY_PLANAR = range(6)

CONTRADICTIONS = (
    "",
    "two degrees, or the marker and its absence, at one place",
    "a vertex would be itself, turned",
    "a dart would be its own other end",
    "two vertices of S would be one",
    "it lies on another face than e",
)
UNLIKE, TURNED_ITSELF, OWN_OTHER_END, TWO_OF_S, OTHER_FACE = range(1, 6)

NEW, LOOP = 1, 2
KINDS: tuple[Literal["new", "loop"], ...] = ("new", "loop")

ABSENT = -1

REJECT_WORDS = 13
"""Words of a rejection without a record's doors."""


PerWord = Annotated[Words, "TRACE"]


@cursor("W")
class EventWords(WordView):
    kind: int


@cursor("W")
class MoveWords(EventWords):
    door: int
    percept: int
    purpose: int


@cursor("W")
class DecisionWords(EventWords):
    """A pose, rejection, confirmation or augmentation."""

    edge: int


@cursor("W")
class PoseWords(DecisionWords):
    number: int
    h: PerWord


@cursor("W")
class RejectionWords(DecisionWords):
    h: int
    size: int
    rule: int
    step: int
    expected: int
    observed: int
    sequence: int
    at: int
    record: int
    contradiction: int
    doors: int
    door: PerWord


@cursor("W")
class ConfirmationWords(DecisionWords):
    h: int
    rule: int


@cursor("W")
class AugmentationWords(DecisionWords):
    growth: int
    dart: int
    degree: int


@entry
def digest(trace: TraceWords) -> int:
    h = 1469598103934665603
    for i in range(trace.size):
        h = (h ^ trace.word[i]) * 1099511628211
        h ^= (h >> 29) & 0x7FFFFFFFF  # a shift keeps the sign
    return h


def percept_word(percept: Percept | None) -> int:
    """The word for a percept; -1 for none.

    Raises:
        OverflowError: it fits no word.
    """
    if percept is None:
        return ABSENT
    if percept.degree >= P or not -1 < (percept.marker or 0) < max(percept.degree, 1):
        raise OverflowError(f"{percept} is no percept of a world")
    return percept.degree * P + (0 if percept.marker is None else 1 + percept.marker)


def _number_word(number: int | None) -> int:
    if number == ABSENT:
        raise OverflowError(f"{ABSENT} is the word for no number")
    return ABSENT if number is None else number


def words(events: Iterable[ev.Event]) -> list[int]:
    """The words of a trace, without its start and its map.

    Raises:
        OverflowError: a percept or a number fits no word, or is -1, the word for none.
    """
    row: list[int] = []
    moves: dict[int, tuple[ev.Move, tuple[int, ...]]] = {}  # by identity: most are shared
    for event in events:
        match event:
            case ev.Move(door, percept, purpose):
                if id(event) not in moves:
                    number = ABSENT if purpose is None else PURPOSES.index(purpose)
                    moves[id(event)] = event, (MOVE, door, percept_word(percept), number)
                row += moves[id(event)][1]
            case ev.Pose(edge, hypotheses):
                row += (POSE, edge, len(hypotheses), *hypotheses)
            case ev.Reject():
                row += _reject_words(event)
            case ev.Confirm(edge, hypothesis, rule):
                row += (CONFIRM, edge, hypothesis, RULES.index(rule))
            case ev.Augment(edge, kind, dart, degree):
                row += (AUGMENT, edge, 1 + KINDS.index(kind), dart, degree)
            case ev.Finish(cost, _):
                row += (FINISH, _number_word(cost))
            case ev.Start():
                pass
    return row


def _reject_words(event: ev.Reject) -> tuple[int, ...]:
    why = event.evidence
    doors = () if why.record is None else why.record.doors
    return (
        REJECT,
        event.edge,
        event.hypothesis,
        REJECT_WORDS + len(doors),
        RULES.index(event.rule),
        why.step,
        percept_word(why.expected),
        percept_word(why.observed),
        _number_word(why.sequence),
        _number_word(why.at),
        _number_word(None if why.record is None else why.record.dart),
        CONTRADICTIONS.index(why.contradiction or ""),
        len(doors),
        *doors,
    )


@lru_cache(maxsize=2**12)
def percept_of(word: int) -> Percept:
    marker = word % P
    return Percept(word // P, marker - 1 if marker else None)


def spans(trace: Sequence[int]) -> Iterator[tuple[int, int]]:
    at = 0
    while at < len(trace):
        kind = trace[at]
        if not MOVE <= kind <= FINISH:
            raise InternalError(f"word {at} of a compiled trace is {kind}, no kind of event")
        length = (4, 0, 0, 4, 5, 2)[kind - 1]
        if kind == POSE:
            length = 3 + trace[at + 2]
        elif kind == REJECT:
            length = trace[at + 3]
        yield at, at + length
        at += length


def decoded(trace: Sequence[int]) -> Iterator[ev.Event]:
    for at, end in spans(trace):
        kind, *rest = trace[at:end]
        if kind == MOVE:
            yield _move(*rest)
        elif kind == POSE:
            yield ev.Pose(rest[0], tuple(rest[2:]))
        elif kind == REJECT:
            yield ev.Reject(rest[0], rest[1], RULES[rest[3]], _evidence(rest))
        elif kind == CONFIRM:
            yield ev.Confirm(rest[0], rest[1], RULES[rest[2]])
        elif kind == AUGMENT:
            yield ev.Augment(rest[0], KINDS[rest[1] - 1], rest[2], rest[3])


@lru_cache(maxsize=2**16)
def _move(door: int, percept: int, purpose: int) -> ev.Move:
    return shared_move(door, percept_of(percept), _purpose(purpose))


def _purpose(number: int) -> Purpose | None:
    return None if number == ABSENT else PURPOSES[number]


def _evidence(rest: Sequence[int]) -> ev.Evidence:
    _, _, _, _, step, expected, observed, sequence, at, record, wrong, _, *doors = rest
    return ev.Evidence(
        step,
        None if expected == ABSENT else percept_of(expected),
        None if observed == ABSENT else percept_of(observed),
        None if sequence == ABSENT else sequence,
        None if at == ABSENT else at,
        None if record == ABSENT else ev.Record(record, tuple(doors)),
        CONTRADICTIONS[wrong] or None,
    )
