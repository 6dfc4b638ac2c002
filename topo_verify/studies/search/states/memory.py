"""When two moments of two runs in one world are the same state, with the same possible future.

Two moments are one state only if these are equal:

    what the mapper keeps       of each running function: the place in its code, and each local
                                variable that it may still read
    what the judgement keeps    all of the past on which the judgement of later events depends

A deterministic mapper then goes on alike, and its events are judged alike:

    1, 5, 6, 7  by the robot's place in the world, its moves so far, and S as it was declared
    2, 3, 4     by S, the pose, and the hypotheses that were neither rejected nor confirmed
    8           by the sequences behind e; by what earlier sequences showed behind unexplored darts
    9, 10       by the fold of the whole history, and S on it

What this does not see: module variables, the iterator of a `for` loop that a choice interrupts
(the mapper has none), what a C object hides from `pickle`, the prior of `folding+planar`.
"""

from __future__ import annotations

import dis
import pickle
from collections.abc import Hashable, Iterator, Mapping, Sequence
from functools import cache
from io import BytesIO
from types import CodeType, FrameType
from typing import Any

from topo_verify.checkers.darts import KnownDart
from topo_verify.checkers.entailment import FoldedTrace
from topo_verify.checkers.folding import Fold, Place
from topo_verify.checkers.replayed_trace import ReplayedTrace
from topo_verify.errors import InputError
from topo_verify.robot.events import Augment, Event, Move, Pose, Reject
from topo_verify.studies.search.states import script
from topo_verify.studies.search.states.script import ChoicePoint, MeteredRobot, ScriptedPolicies
from topo_verify.world.rooted_map import World

State = Hashable


def state(moment: ChoicePoint, world: World) -> State | None:
    """The state at a moment; None if a claim has failed, so that S is no map of the world."""
    judged = _judged(world, moment.trace)
    return None if judged is None else (_kept(moment.frame), judged)


# ---------------------------------------------------------------- what the mapper keeps


def _outside(_: object) -> tuple[type, tuple[()]]:
    return object, ()


class _Snapshot(pickle.Pickler):
    """Leaves out the robot, whose place is judged, and the script."""

    dispatch_table: Mapping[type, Any] = {MeteredRobot: _outside, ScriptedPolicies: _outside}


def _kept(frame: FrameType | None) -> bytes:
    """The running functions of the mapper, innermost first, with their variables."""
    rows: list[tuple[str, int, dict[str, object]]] = []
    while frame is not None and frame.f_globals["__name__"] != script.__name__:
        code, place = frame.f_code, frame.f_lasti
        read = _read(code, place)
        kept = {name: value for name, value in frame.f_locals.items() if name in read}
        rows.append((code.co_qualname, place, kept))
        frame = frame.f_back
    snapshot = BytesIO()
    try:
        _Snapshot(snapshot).dump(rows)
    except Exception as error:
        raise InputError(
            f"--policies every: what the mapper keeps cannot be pickled ({type(error).__name__}:"
            f" {error}), so its states cannot be compared; ask for --policies all"
        ) from error
    return snapshot.getvalue()


@cache
def _read(code: CodeType, place: int) -> frozenset[str]:
    """The local variables that a function may still read after the call at this place.

    Conservative; all of them with an exception handler.
    """
    every = frozenset((*code.co_varnames, *code.co_cellvars, *code.co_freevars))
    if code.co_exceptiontable:
        return every
    rows = list(dis.get_instructions(code))
    numbers = {row.offset: number for number, row in enumerate(rows)}
    read = [frozenset[str]()] * len(rows) + [every - {*code.co_varnames}]
    known: list[frozenset[str]] = []
    while known != read:
        known = [*read]
        for number, row in reversed([*enumerate(rows)]):
            later = read[number + 1]
            if row.opcode in dis.hasjrel or row.opcode in dis.hasjabs:
                later |= read[numbers[row.argval]]
            if row.opname == "STORE_FAST":
                later -= {row.argval}
            elif "FAST" in row.opname:
                later |= {*code.co_varnames} & {*row.argrepr.split(", ")}
            read[number] = later
    return read[next(number for number, row in enumerate(rows) if row.offset > place)]


# ---------------------------------------------------------------- what the judgement keeps


def _judged(world: World, trace: Sequence[Event]) -> Hashable | None:
    """What the judgement of later events depends on; None if a claim has failed."""
    run = ReplayedTrace(world, trace)
    if run.illegal is not None or run.spoiled is not None:
        return None
    folded = FoldedTrace(trace)
    assert folded.read_to(len(trace)) is None, "the world shows what the robot saw"
    planar = any(isinstance(event, Reject) and event.rule == "planar" for event in trace)
    drawn = tuple(run.map.phi.values()), tuple(sorted(run.map.alpha))
    waiting = tuple(
        (edge, tuple(sorted(run.left[edge])))
        for edge, fate in run.fates.items()
        if isinstance(fate.event, Pose)
    )
    places = tuple(_places(folded.fold))
    return run.cost, drawn, waiting, _behind(run), _records(run), places, planar


def _behind(run: ReplayedTrace) -> Hashable:
    """The last pose, if S did not grow since: the word behind it, the sequences."""
    last = run.rounds[-1] if run.rounds else None
    if last is None or isinstance(last.event, Augment):
        return None
    sequences = last.sequences
    if isinstance(last.event, Reject) and last.event.rule == "motion" and last.word:
        sequences = (*sequences, last.word)
    since = tuple(event.door for event in run.trace[last.when :] if isinstance(event, Move))
    return last.pose, last.word, sequences, since


def _records(run: ReplayedTrace) -> Hashable:
    """What earlier sequences showed behind darts that are unexplored now."""
    rests = (
        run.records.trace(KnownDart(event.dart), sequence, decision.when + 1)
        for decision in run.rounds
        if isinstance(event := decision.event, Augment) and decision.pose
        for sequence in decision.sequences
    )
    now = len(run.trace)
    return frozenset((at, rest) for at, rest in rests if rest and run.map.is_open(at, now))


def _places(fold: Fold) -> Iterator[Hashable]:
    """The places of a fold from v0 on, each with the ends of its doors."""
    numbers: dict[int, tuple[int, int]] = {}  # of a node: its number, and its dart found
    queue: list[Place] = []

    def number(place: Place) -> Place:
        node, dart = fold.find(place)
        if node not in numbers:
            numbers[node] = len(queue), dart
            queue.append((node, dart))
        known, first = numbers[node]
        return known, (dart - first) % fold.degree(node)

    number((0, 0))  # v0's dart with the marker
    for node, dart in queue:  # grows as it goes
        ends = (fold.partner((node, dart + door)) for door in range(fold.degree(node)))
        yield tuple(end and number(end) for end in ends)
    yield number(fold.at)
