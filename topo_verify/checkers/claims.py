"""The claims of SPEC section 7, one named function each, over a world and a trace.

Trusted. A claim is asked of a `Case` (a trace replayed in its world) and answers with what is
wrong, which is nothing if it holds. `CLAIMS` lists them in order; `check` asks them all.

What these do not show: claims 1-8 ask whether the mapper was right in THIS world. A mapper that
guesses and is lucky passes all of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from topo_verify.checkers.findings import Finding, Judgement
from topo_verify.checkers.replay import Case, Word
from topo_verify.errors import InputError
from topo_verify.robot.events import (
    Augment,
    Confirm,
    Event,
    Evidence,
    Finish,
    Move,
    Pose,
    Record,
    Reject,
    Start,
)
from topo_verify.robot.percept import Door, Percept
from topo_verify.world.rooted_map import Dart, World

Wrong = tuple[int | None, Any, Any, str]
"""Something wrong: the event, what should be there, what is, and a sentence."""

Claim = Callable[[Case], Iterator[Wrong]]


def check(world: World, trace: Sequence[Event], stopped: str | None = None) -> list[Judgement]:
    """Every claim, judged on one run, in the order of SPEC section 7.

    Args:
        stopped: why the mapper ended without a map, if it did.
    Raises:
        InputError: the trace does not begin with its only `start`, or goes on after `finish`.
    """
    case = Case(world, trace, stopped)
    declared = {type(event) for event in trace}
    judgements: list[Judgement] = []
    for name, (claim, speaks_of) in CLAIMS.items():
        if speaks_of and world.alpha and not declared.intersection(speaks_of):
            judgements.append(Judgement(name, "not-declared"))
            continue
        findings = tuple(Finding(name, *wrong) for wrong in claim(case))
        judgements.append(Judgement(name, "failed" if findings else "ok", findings))
    return judgements


def cost_bound(world: World) -> int:
    """The most edge traversals that any run may cost: m·(n + (2m-1)·2(n-1)), which is O(m²n).

    m for n = 1; 0 for the world without edges.
    """
    m, n = len(world.edges), len(world.vertices)
    return m if n == 1 else m * (n + (2 * m - 1) * 2 * (n - 1))


# ---------------------------------------------------------------- the claims


def percepts_true(case: Case) -> Iterator[Wrong]:
    """1. Every percept in the trace is what the world shows after these doors."""
    for when, at in enumerate(case.positions):
        event, seen = case.trace[when], case.seen_at(at)
        if isinstance(event, Start | Move) and event.percept != seen:
            told = f"the trace says {_text(event.percept)} where the world shows {_text(seen)}"
            yield when, seen, event.percept, told
    if case.illegal is not None:
        move, degree = case.trace[case.illegal], case.seen_at(case.positions[-1]).degree
        assert isinstance(move, Move)
        told = f"there is no door {move.door} at a vertex of degree {degree}"
        yield case.illegal, f"a door below {degree}", move.door, told


def true_hypothesis_posed(case: Case) -> Iterator[Wrong]:
    """2. If e leads to a known vertex, its dart is in H; H is posed behind e, before S grows."""
    for when, event, pose, _, _ in case.rounds:
        if isinstance(event, Augment) and (pose is None or pose.edge != event.edge):
            yield when, event.edge, None, f"S grows along dart {event.edge}, which was not posed"
        if not isinstance(event, Pose):
            continue
        edge = event.edge
        if not all(case.is_open(dart, when) for dart in (edge, *event.hypotheses)):
            told = f"edge {edge} or one of its hypotheses is no unexplored dart of S"
            yield when, "unexplored darts", [edge, *event.hypotheses], told
        elif case.positions[when] != case.world.alpha[case.phi[edge]]:
            yield when, edge, None, f"the robot does not stand behind dart {edge}"
        elif (truth := case.truth(edge, when)) not in (None, *event.hypotheses):
            told = f"edge {edge} leads to dart {truth}, which is not among the hypotheses"
            yield when, truth, event.hypotheses, told


def true_hypothesis_kept(case: Case) -> Iterator[Wrong]:
    """3. No rule and no motion rejects the true hypothesis; it is not dropped in silence either."""
    for when, event, _, _, _ in case.rounds:
        match event:
            case Reject(edge, hypothesis, rule) if case.truth(edge, when) == hypothesis:
                told = f"edge {edge} does lead to dart {hypothesis}, which rule {rule!r} rejects"
                yield when, "kept", "rejected", told
            case Augment(edge, "new") if (truth := case.truth(edge, when)) is not None:
                told = f"edge {edge} leads to dart {truth}, but S grows by a new vertex"
                yield when, truth, "new", told
            case _:
                pass


def no_false_confirm(case: Case) -> Iterator[Wrong]:
    """4. A confirmed hypothesis is the true one."""
    for when, event, _, _, _ in case.rounds:
        if isinstance(event, Confirm) and event.hypothesis != case.truth(event.edge, when):
            leads = _end(case, event.edge, when)
            told = f"edge {event.edge} leads to {leads}, but dart {event.hypothesis} is confirmed"
            yield when, leads, event.hypothesis, told


def map_isomorphic(case: Case) -> Iterator[Wrong]:
    """5. The map at the end is the world, and every declared S on the way is a part of it."""
    if case.spoiled is not None:
        event = case.trace[case.spoiled]
        assert isinstance(event, Augment)
        leads = _end(case, event.edge, case.spoiled)
        told = f"S grows by {event.kind} dart {event.dart} with degree {event.degree}, but edge"
        yield case.spoiled, leads, event, f"{told} {event.edge} leads to {leads}"
    finish = case.trace[-1]
    if not isinstance(finish, Finish):
        why = case.stopped or "the trace ends without 'finish'"
        yield None, "a map", None, f"no map was delivered: {why}"
        return
    ours, last = case.world.code, len(case.trace) - 1
    left = case.joined.count(None) if case.spoiled is case.illegal is None else 0
    if 0 < left < len(case.joined):
        yield last, 0, left, f"the map is delivered while {left} darts of S are unexplored"
    try:
        theirs = World.from_map(finish.map).code
    except InputError as error:
        yield last, "a map", None, f"what was delivered is no map: {error}"
        return
    if theirs != ours:
        told = f"the map ({_size(theirs)}) is not isomorphic to the world ({_size(ours)})"
        yield last, _size(ours), _size(theirs), told


def cost_honest(case: Case) -> Iterator[Wrong]:
    """6. The reported cost, if one is reported, is the number of moves."""
    finish, cost = case.trace[-1], case.cost
    if isinstance(finish, Finish) and finish.cost not in (None, cost):
        told = f"the mapper reports a cost of {finish.cost}, but made {cost} moves"
        yield len(case.trace) - 1, cost, finish.cost, told


def cost_within_bound(case: Case) -> Iterator[Wrong]:
    """7. m <= cost <= m·(n + (2m-1)·2(n-1)); the lower half only where a map was delivered."""
    cost, bound, m = case.cost, cost_bound(case.world), len(case.world.edges)
    least = m if isinstance(case.trace[-1], Finish) else 0
    if not least <= cost <= bound:
        size = f"{m} edges and {len(case.world.vertices)} vertices"
        told = f"a cost of {cost} is outside {m} … {bound}, the bound for {size}"
        yield None, f"{m} … {bound}", cost, told


def rejection_justified(case: Case) -> Iterator[Wrong]:
    """8. The evidence that a rejection cites really disagrees, recomputed.

    What was observed is taken from the moves, what was expected from S; behind an unexplored dart,
    from the sequences executed for earlier edges, traced from where they are known to have begun.
    """
    for when, event, pose, word, sequences in case.rounds:
        if not isinstance(event, Reject):
            continue
        number = event.evidence.sequence
        executed = word if event.rule == "motion" and number is None else None
        if number is not None and 0 <= number < len(sequences):
            executed = sequences[number]
        if pose is None or event.edge != pose.edge or event.hypothesis not in pose.hypotheses:
            why = "no such hypothesis was posed"
        elif not all(case.is_open(d, when) for d in (event.edge, event.hypothesis)):
            why = "these are no unexplored darts of S"
        elif executed is None or not 0 <= event.evidence.step <= len(executed):
            why = f"step {event.evidence.step} of sequence {number} was not executed"
        else:
            why = _unjustified(case, when, event, executed[: event.evidence.step])
        if why:
            told = (
                f"the rejection of {event.hypothesis} for edge {event.edge} is unjustified: {why}"
            )
            yield when, "evidence that disagrees", event.evidence, told


def _unjustified(case: Case, when: int, event: Reject, word: Word) -> str:
    """What is wrong with the evidence that a word gives against a hypothesis; "" if it stands."""
    end = case.world.alpha[case.phi[event.edge]]
    observed = word[-1].percept if word else case.seen_at(end)
    expected = _expectation(case, when, event, word)
    for percept, name in ((observed, "observed"), (expected, "expected")):
        if isinstance(percept, str):
            return percept
        if getattr(event.evidence, name) != percept:
            return f"{name} is {_text(percept)}, not {_text(getattr(event.evidence, name))}"
    return f"{_text(observed)} is both expected and observed" if expected == observed else ""


def _expectation(case: Case, when: int, event: Reject, word: Word) -> Percept | str:
    """What is seen at the end of a word if the hypothesis is true; or why that is unknown."""
    at, record = event.hypothesis, event.evidence.record
    for place, step in enumerate(word):
        exit_dart = case.turn(at, step.door)
        arrival = case.crossed(exit_dart, when)
        if arrival is None:
            doors = tuple(s.door for s in word[place + 1 :])
            return _recorded(case, when, exit_dart, doors, event.evidence)
        at = arrival
    if record is not None or event.evidence.at not in (None, at):
        return f"tracing ends at dart {at} of S, not where the evidence says"
    return case.seen_at(case.phi[at])


def _recorded(
    case: Case, when: int, exit_dart: Dart, doors: tuple[Door, ...], evidence: Evidence
) -> Percept | str:
    """What a record says of the place behind an unexplored dart and further doors; or why not."""
    told = evidence.at in (None, exit_dart) and evidence.record == Record(exit_dart, doors)
    if not told:
        return f"tracing leaves S at dart {exit_dart} with the doors {list(doors)} to go"
    seen = case.recorded(exit_dart, doors, when)
    return seen or f"nothing is recorded behind dart {exit_dart} and the doors {list(doors)}"


# ---------------------------------------------------------------- words


def _end(case: Case, edge: Dart, when: int) -> str:
    """Where an edge really leads."""
    if not case.is_open(edge, when):
        return "nowhere (it is no unexplored dart of S)"
    truth, degree = case.truth(edge, when), case.percepts[case.world.alpha[case.phi[edge]]].degree
    return f"a new vertex of degree {degree}" if truth is None else f"dart {truth}"


def _size(code: tuple[Sequence[int], Sequence[int]]) -> str:
    return f"{len(code[0])} vertices, {len(code[1]) // 2} edges"


def _text(percept: Percept) -> str:
    marker = "no marker" if percept.marker is None else f"marker at door {percept.marker}"
    return f"(degree {percept.degree}, {marker})"


CLAIMS: dict[str, tuple[Claim, tuple[type[Event], ...]]] = {
    "percepts-true": (percepts_true, ()),
    "true-hypothesis-posed": (true_hypothesis_posed, (Pose,)),
    "true-hypothesis-kept": (true_hypothesis_kept, (Pose, Reject)),
    "no-false-confirm": (no_false_confirm, (Pose, Confirm)),
    "map-isomorphic": (map_isomorphic, ()),
    "cost-honest": (cost_honest, ()),
    "cost-within-bound": (cost_within_bound, ()),
    "rejection-justified": (rejection_justified, (Pose, Reject)),
}
"""Each claim by its name in SPEC section 7, and the events that it speaks of (none: any)."""
