"""The claims of docs/semantics.md, section 9, one named function each, over a world and a trace.

Trusted. A claim is asked of a `Case` (a trace replayed in its world) and answers with what is
wrong, which is nothing if it holds. `CLAIMS` lists them in order; `check` asks them all.

What these do not show: claims 1-8 ask whether the mapper was right in THIS world. A mapper that
guesses and is lucky passes them. Claims 9 and 10 ask about every world with the same history.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from topo_verify.checkers.entailment import (
    decision_conclusions,
    delivered_code,
    map_conclusion,
)
from topo_verify.checkers.findings import Finding, Judgement
from topo_verify.checkers.replayed_trace import Case, Word
from topo_verify.errors import InputError
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Door, Percept
from topo_verify.world.rooted_map import Dart, World

Wrong = tuple[int | None, Any, Any, str, World | None]
"""Something wrong: the event, what should be there, what is, a sentence, a witness world."""

Claim = Callable[[Case], Iterator[Wrong]]

LARGE = 100
"""Beyond this many edges claim 10 is asked only with `strict`: it folds anew at each decision."""


def check(
    world: World, trace: Sequence[ev.Event], stopped: str | None = None, *, strict: bool = False
) -> list[Judgement]:
    """Every claim, judged on one run, in the order of docs/semantics.md, section 9.

    Args:
        stopped: why the mapper ended without a map, if it did.
        strict: ask claim 10 also in worlds with more than 100 edges.
    Raises:
        InputError: the trace does not begin with its only `start`, or goes on after `finish`.
    """
    case = Case(world, trace, stopped)
    declared = {type(event) for event in trace}
    judgements: list[Judgement] = []
    for name, (claim, speaks_of) in CLAIMS.items():
        if speaks_of and world.alpha and not declared.intersection(speaks_of):
            judgements.append(Judgement(name, "not-declared"))
        elif claim is decisions_entailed and len(world.edges) > LARGE and not strict:
            judgements.append(Judgement(name, "not-asked"))
        elif claim in (map_entailed, decisions_entailed) and judgements[0].findings:
            told = "the percepts are not true and prove nothing"
            finding = Finding(name, None, "true percepts", None, told)
            judgements.append(Judgement(name, "failed", (finding,)))
        else:
            found = tuple(
                Finding(name, when, expected, seen, told, None if witness is None else witness.text)
                for when, expected, seen, told, witness in claim(case)
            )
            judgements.append(Judgement(name, "failed" if found else "ok", found))
    return judgements


# ---------------------------------------------------------------- the claims


def percepts_true(case: Case) -> Iterator[Wrong]:
    """1. Every percept in the trace is what the world shows after these doors."""
    for when, at in enumerate(case.positions):
        event, seen = case.trace[when], case.seen_at(at)
        if isinstance(event, (ev.Start, ev.Move)) and event.percept != seen:
            told = f"the trace says {event.percept} where the world shows {seen}"
            yield when, seen, event.percept, told, None
    if case.illegal is not None:
        move, seen = case.trace[case.illegal], case.seen_at(case.positions[-1])
        assert isinstance(move, ev.Move)
        told = f"there is no door {move.door} at a vertex of degree {seen.degree}"
        yield case.illegal, f"a door below {seen.degree}", move.door, told, None


def true_hypothesis_posed(case: Case) -> Iterator[Wrong]:
    """2. If e leads to a known vertex, its dart is in H; H is posed behind e, before S grows."""
    for when, event, pose, _, _ in case.rounds:
        if isinstance(event, ev.Augment) and (pose is None or pose.edge != event.edge):
            told = f"S grows along dart {event.edge}, which was not posed"
            yield when, event.edge, None, told, None
        if not isinstance(event, ev.Pose):
            continue
        edge, hypotheses = event.edge, event.hypotheses
        if not all(case.is_open(dart, when) for dart in (edge, *hypotheses)):
            told = f"edge {edge} or one of its hypotheses is no unexplored dart of S"
            yield when, "unexplored darts", [edge, *hypotheses], told, None
        elif case.positions[when] != case.end(edge):
            yield when, edge, None, f"the robot does not stand behind dart {edge}", None
        elif (truth := case.truth(edge, when)) not in (None, *hypotheses):
            told = f"edge {edge} leads to dart {truth}, which is not among the hypotheses"
            yield when, truth, hypotheses, told, None


def true_hypothesis_kept(case: Case) -> Iterator[Wrong]:
    """3. No rule and no motion rejects the true hypothesis; it is not dropped in silence either."""
    for when, event, _, _, _ in case.rounds:
        match event:
            case ev.Reject(edge, hypothesis, rule) if case.truth(edge, when) == hypothesis:
                told = f"edge {edge} does lead to dart {hypothesis}, which rule {rule!r} rejects"
                yield when, "kept", "rejected", told, None
            case ev.Augment(edge, "new") if (truth := case.truth(edge, when)) is not None:
                told = f"edge {edge} leads to dart {truth}, but S grows by a new vertex"
                yield when, truth, "new", told, None
            case _:
                pass


def no_false_confirm(case: Case) -> Iterator[Wrong]:
    """4. A confirmed hypothesis is the true one."""
    for when, event, _, _, _ in case.rounds:
        if isinstance(event, ev.Confirm) and event.hypothesis != case.truth(event.edge, when):
            leads = _end(case, event.edge, when)
            told = f"edge {event.edge} leads to {leads}, but dart {event.hypothesis} is confirmed"
            yield when, leads, event.hypothesis, told, None


def map_isomorphic(case: Case) -> Iterator[Wrong]:
    """5. The map at the end is the world, and every declared S on the way is a part of it."""
    if case.spoiled is not None:
        event = case.trace[case.spoiled]
        assert isinstance(event, ev.Augment)
        leads = _end(case, event.edge, case.spoiled)
        told = f"S grows by {event.kind} dart {event.dart} with degree {event.degree}, but edge"
        yield case.spoiled, leads, event, f"{told} {event.edge} leads to {leads}", None
    finish, last = case.trace[-1], len(case.trace) - 1
    if not isinstance(finish, ev.Finish):
        why = case.stopped or "the trace ends without 'finish'"
        yield None, "a map", None, f"no map was delivered: {why}", None
        return
    left = sum(joined == len(case.trace) for joined in case.joined)
    if case.spoiled is case.illegal is None and 0 < left < len(case.joined):
        told = f"the map is delivered while {left} darts of S are unexplored"
        yield last, 0, left, told, None
    try:
        code = delivered_code(finish.map)
    except InputError as error:
        yield last, "a map", None, f"what was delivered is no map: {error}", None
        return
    if code != case.world.code:
        ours, theirs = _size(case.world.code), _size(code)
        told = f"the map ({theirs}) is not isomorphic to the world ({ours})"
        yield last, ours, theirs, told, None


def cost_honest(case: Case) -> Iterator[Wrong]:
    """6. The reported cost, if one is reported, is the number of moves."""
    finish = case.trace[-1]
    if isinstance(finish, ev.Finish) and finish.cost not in (None, case.cost):
        told = f"the mapper reports a cost of {finish.cost}, but made {case.cost} moves"
        yield len(case.trace) - 1, case.cost, finish.cost, told, None


def cost_within_bound(case: Case) -> Iterator[Wrong]:
    """7. m <= cost <= m·(n + (2m-1)·2(n-1)); the lower half only where a map was delivered."""
    bound, m = case.world.cost_bound, len(case.world.edges)
    least = m if isinstance(case.trace[-1], ev.Finish) else 0
    if not least <= case.cost <= bound:
        size = f"m = {m} and n = {len(case.world.vertices)}"
        told = f"a cost of {case.cost} is outside {m} … {bound}, the bound for {size}"
        yield None, f"{m} … {bound}", case.cost, told, None


def rejection_justified(case: Case) -> Iterator[Wrong]:
    """8. The evidence that a rejection cites really disagrees, recomputed.

    What was observed is taken from the moves, what was expected from S; behind an unexplored dart,
    from the sequences executed for earlier edges, traced from where they are known to have begun.
    Rule `folding` cites no percepts: the history must contradict the hypothesis. Rule `planar`
    cites S: the hypothesis must lie on another face than e.
    """
    unproved: dict[int, str] | None = None
    for when, event, pose, word, sequences in case.rounds:
        if not isinstance(event, ev.Reject):
            continue
        number, step = event.evidence.sequence, event.evidence.step
        executed = word if event.rule == "motion" and number is None else None
        if number is not None and 0 <= number < len(sequences):
            executed = sequences[number]
        if pose is None or event.edge != pose.edge or event.hypothesis not in pose.hypotheses:
            why = "no such hypothesis was posed"
        elif not all(case.is_open(dart, when) for dart in (event.edge, event.hypothesis)):
            why = "these are no unexplored darts of S"
        elif event.rule == "folding":
            if unproved is None:
                proofs = () if any(percepts_true(case)) else decision_conclusions(case.trace)
                unproved = {proof.when: proof.why for proof in proofs}
            why = unproved.get(when, "S was not proved so far")
        elif event.rule == "planar":
            same = event.hypothesis in _face(case, event.edge, when)
            why = "they lie on one face" if same else ""
        elif executed is None or not 0 <= step <= len(executed):
            why = f"step {step} of sequence {number} was not executed"
        else:
            why = _unjustified(case, when, event, executed[:step])
        if why:
            told = f"rejecting {event.hypothesis} for edge {event.edge} is not justified: {why}"
            yield when, "evidence that disagrees", event.evidence, told, None


def map_entailed(case: Case) -> Iterator[Wrong]:
    """9. The history alone proves the map: no other world fits it."""
    when, why, witness = map_conclusion(case.trace)
    if why:
        yield when, "a map that is proved", why, f"the history proves no such map: {why}", witness


def decisions_entailed(case: Case) -> Iterator[Wrong]:
    """10. The history at that moment alone proves each declared reject, confirm, augmentation."""
    for when, why, witness in decision_conclusions(case.trace):
        if why:
            yield when, "a proved decision", why, f"the decision does not follow: {why}", witness


# ---------------------------------------------------------------- what they are made of


def _unjustified(case: Case, when: int, event: ev.Reject, word: Word) -> str:
    """What is wrong with the evidence that a word gives against a hypothesis; "" if it stands."""
    observed = word[-1].percept if word else case.seen_at(case.end(event.edge))
    expected = _expectation(case, when, event, word)
    for percept, name in ((observed, "observed"), (expected, "expected")):
        if isinstance(percept, str):
            return percept
        if getattr(event.evidence, name) != percept:
            return f"{name} is {percept}, not {getattr(event.evidence, name)}"
    return f"{observed} is both expected and observed" if expected == observed else ""


def _expectation(case: Case, when: int, event: ev.Reject, word: Word) -> Percept | str:
    """What is seen at the end of a word if the hypothesis is true; or why that is unknown."""
    at, evidence = event.hypothesis, event.evidence
    for place, step in enumerate(word):
        exit_at = case.turn(at, step.door)
        if case.is_open(exit_at, when):
            doors = tuple(s.door for s in word[place + 1 :])
            return _recorded(case, when, exit_at, doors, evidence)
        at = case.alpha[exit_at]
    if evidence.record is not None or evidence.at not in (None, at):
        return f"tracing ends at dart {at} of S, not where the evidence says"
    return case.seen_at(case.phi[at])


def _recorded(
    case: Case, when: int, exit_at: Dart, doors: tuple[Door, ...], evidence: ev.Evidence
) -> Percept | str:
    """What a record says of the place behind an unexplored dart and further doors; or why not."""
    if evidence.record != ev.Record(exit_at, doors) or evidence.at not in (None, exit_at):
        return f"tracing leaves S at dart {exit_at} with the doors {list(doors)} to go"
    seen = case.recorded(exit_at, doors, when)
    return seen or f"nothing is recorded behind dart {exit_at} and the doors {list(doors)}"


def _face(case: Case, e: Dart, when: int) -> list[Dart]:
    """The darts of S on the face of e; where a dart is open, the boundary turns back."""
    face = [e]
    while True:
        last = face[-1]
        across = last if case.is_open(last, when) else case.alpha[last]
        face.append(case.turn(across, 1))
        if face[-1] == e:
            return face


def _end(case: Case, edge: Dart, when: int) -> str:
    """Where an edge really leads."""
    if not case.is_open(edge, when):
        return "nowhere (it is no unexplored dart of S)"
    truth, degree = case.truth(edge, when), case.seen_at(case.end(edge)).degree
    return f"a new vertex of degree {degree}" if truth is None else f"dart {truth}"


def _size(code: tuple[Sequence[int], Sequence[int]]) -> str:
    return f"{len(code[0])} vertices, {len(code[1]) // 2} edges"


CLAIMS: dict[str, tuple[Claim, tuple[type[ev.Event], ...]]] = {
    "percepts-true": (percepts_true, ()),
    "true-hypothesis-posed": (true_hypothesis_posed, (ev.Pose,)),
    "true-hypothesis-kept": (true_hypothesis_kept, (ev.Pose, ev.Reject)),
    "no-false-confirm": (no_false_confirm, (ev.Pose, ev.Confirm)),
    "map-isomorphic": (map_isomorphic, ()),
    "cost-honest": (cost_honest, ()),
    "cost-within-bound": (cost_within_bound, ()),
    "rejection-justified": (rejection_justified, (ev.Pose, ev.Reject)),
    "map-entailed": (map_entailed, (ev.Finish,)),
    "decisions-entailed": (decisions_entailed, (ev.Reject, ev.Confirm, ev.Augment)),
}
"""Each claim by its name, and the events that it speaks of (none: any)."""
