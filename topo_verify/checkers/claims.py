"""The claims of docs/semantics.md, section 9: one function each, which yields its findings.

`check` replays a trace in its world once. Each claim reads this `ReplayedTrace`: where the robot
stood at each event, and how far the declared map S was true. A claim without findings is `ok` if
all that it speaks of was declared; `coverage` counts that.

Trusted. What these do not show: claims 1 to 8 ask whether the mapper was right in this world, so a
lucky guess passes them. Claims 9 and 10 quantify over every world with the same history.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial

import msgspec

from topo_verify.checkers.coverage import coverage
from topo_verify.checkers.darts import KnownDart, WorldDart
from topo_verify.checkers.entailment import UNDECIDED, Conclusion, map_conclusion
from topo_verify.checkers.excursions import Word
from topo_verify.checkers.findings import Finding, Judgement, Status
from topo_verify.checkers.replayed_trace import ReplayedTrace, Round
from topo_verify.errors import map_size, plural
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept
from topo_verify.world.rooted_map import World

Wrong = partial(Finding, "")
"""Something that is wrong; `check` adds the name of the claim."""

Claim = Callable[[ReplayedTrace], Iterator[Finding]]

LARGE = 2000
"""With more edges claim 10 is asked only if `strict`."""


def check(
    world: World, trace: Sequence[ev.Event], stopped: str | None = None, *, strict: bool = False
) -> list[Judgement]:
    """Every claim, judged on one run, in the order of docs/semantics.md, section 9.

    Args:
        stopped: why the mapper ended without a map, if it did.
        strict: ask claim 10 also in worlds with more than 2,000 edges.
    Raises:
        InputError: the trace does not begin with its only `start`, or goes on after `finish`.
    """
    run = ReplayedTrace(world, trace, stopped)
    shares = coverage(run)
    # backwards: claim 9 goes on with claim 10's fold
    return [_judgement(run, name, *shares[name], strict=strict) for name in reversed(CLAIMS)][::-1]


def _judgement(run: ReplayedTrace, name: str, judged: int, of: int, *, strict: bool) -> Judgement:
    claim, speaks_of, folds = CLAIMS[name]
    if speaks_of and run.world.alpha and run.kinds.isdisjoint(speaks_of):
        return Judgement(name, "not-declared", 0, of)
    if folds and len(run.world.edges) > LARGE and not strict:
        return Judgement(name, "not-asked", 0, of)
    if findings := [*claim(run)]:
        named = map(partial(msgspec.structs.replace, claim=name), findings)
        return Judgement(name, "failed", judged, of, tuple(named))
    conclusions = run.conclusions.values() if folds else ()
    if number := [conclusion.why for conclusion in conclusions].count(UNDECIDED[0]):
        return Judgement(name, "undecided", judged - number, of)
    status: Status = "ok" if judged == of else "partial" if judged else "not-declared"
    return Judgement(name, status, judged, of)


# ---------------------------------------------------------------- the claims


def percepts_true(run: ReplayedTrace) -> Iterator[Finding]:
    """1. Every percept in the trace is what the world shows after these doors."""
    for when, told, seen in run.false_percepts:
        yield Wrong(when, seen, told, f"the trace says {told} where the world shows {seen}")
    if run.illegal is not None:
        move, degree = run.trace[run.illegal], run.map.seen_at(run.positions[-1]).degree
        assert type(move) is ev.Move
        message = f"there is no door {move.door} at a vertex of degree {degree}"
        yield Wrong(run.illegal, f"a door below {degree}", move.door, message)


def true_hypothesis_posed(run: ReplayedTrace) -> Iterator[Finding]:
    """2. If e leads to a known vertex, its dart is in H; S grows along edges that were posed."""
    for decision in run.rounds:
        event = decision.event
        if type(event) is ev.Pose:
            yield from _wrongly_posed(run, decision, event)
        elif type(event) is ev.Augment and decision.pose is None:
            message = f"S grows along dart {event.edge}, which was not posed"
            yield Wrong(decision.when, event.edge, None, message)


def _wrongly_posed(run: ReplayedTrace, decision: Round, pose: ev.Pose) -> Iterator[Finding]:
    edge, hypotheses, when, crossing = pose.edge, pose.hypotheses, decision.when, decision.crossing
    if crossing is None or not all(run.map.is_open(h, when) for h in hypotheses):
        message = f"edge {edge} or a hypothesis is no unexplored dart of S: is an augment missing?"
        yield Wrong(when, "unexplored darts", [edge, *hypotheses], message)
    elif run.crossings.get(crossing, when) >= when:
        yield Wrong(when, edge, None, f"dart {edge} is posed before the robot crossed it")
    elif (truth := decision.truth) not in (None, *hypotheses):
        message = f"edge {edge} leads to dart {truth}, which is not among the hypotheses"
        yield Wrong(when, truth, hypotheses, message)


def true_hypothesis_kept(run: ReplayedTrace) -> Iterator[Finding]:
    """3. No rule and no motion rejects the true hypothesis, and none is dropped in silence."""
    for decision in run.rounds:
        event, edge, truth = decision.event, decision.event.edge, decision.truth
        if type(event) is ev.Reject and truth == event.hypothesis:
            message = f"edge {edge} does lead to dart {truth}, which rule {event.rule!r} rejects"
            yield Wrong(decision.when, "kept", "rejected", message)
        elif type(event) is ev.Augment and event.kind == "new" and truth is not None:
            message = f"edge {edge} leads to dart {truth}, but S grows by a new vertex"
            yield Wrong(decision.when, truth, "new", message)
    for crossing, fate in run.fates.items():
        if type(event := fate.event) is ev.Augment and (left := run.left[crossing]):
            message = f"S grows by a new vertex behind edge {event.edge}, but hypotheses are left:"
            message += " declare a reject for each, or declare nothing"
            yield Wrong(fate.when, "each rejected", sorted(left), message)


def no_false_confirm(run: ReplayedTrace) -> Iterator[Finding]:
    """4. A confirmed hypothesis is the true one."""
    for decision in run.rounds:
        event = decision.event
        if type(event) is ev.Confirm and event.hypothesis != decision.truth:
            edge, hypothesis, leads = event.edge, event.hypothesis, _leads(run, decision)
            message = f"edge {edge} leads to {leads}, but dart {hypothesis} is confirmed"
            yield Wrong(decision.when, leads, hypothesis, message)


def map_isomorphic(run: ReplayedTrace) -> Iterator[Finding]:
    """5. The map at the end is the world, and every declared S on the way is a part of it."""
    if run.spoiled is not None:
        event, leads = run.rounds[-1].event, _leads(run, run.rounds[-1])
        assert type(event) is ev.Augment
        grows = f"S grows by {event.kind} dart {event.dart} with degree {event.degree}"
        message = f"{grows}, but edge {event.edge} leads to {leads}"
        yield Wrong(run.spoiled, leads, event, message)
    code, last, left = run.code, len(run.trace) - 1, len(run.map.phi) - len(run.map.alpha)
    if code and run.spoiled is run.illegal is None and run.map.alpha and left:
        yield Wrong(last, 0, left, f"the map is delivered while {left} darts of S are unexplored")
    if code is None:
        why = run.stopped or "the trace ends without 'finish'"
        yield Wrong(None, "a map", None, f"no map was delivered: {why}")
    elif isinstance(code, str):
        yield Wrong(last, "a map", None, code)
    elif code != run.world.code:
        ours, theirs = (map_size(len(v), len(a) // 2) for v, a in (run.world.code, code))
        message = f"the map ({theirs}) is not isomorphic to the true map ({ours})"
        yield Wrong(last, ours, theirs, message)


def cost_honest(run: ReplayedTrace) -> Iterator[Finding]:
    """6. The reported cost, if one is reported, is the number of moves."""
    finish = run.trace[-1]
    if type(finish) is ev.Finish and finish.cost not in (None, run.cost):
        message = f"the mapper reports a cost of {finish.cost}, but made {plural(run.cost, 'move')}"
        yield Wrong(len(run.trace) - 1, run.cost, finish.cost, message)


def cost_within_bound(run: ReplayedTrace) -> Iterator[Finding]:
    """7. m <= cost <= m·(n + (2m-1)·2(n-1)); the lower half only where a map was delivered."""
    bound, m, n = run.world.cost_bound, len(run.world.edges), len(run.world.vertices)
    least = m if type(run.trace[-1]) is ev.Finish else 0
    if not least <= run.cost <= bound:
        bounds = f"{m} … {bound}"
        message = f"a cost of {run.cost} is outside {bounds}, the bound for m = {m} and n = {n}"
        yield Wrong(None, bounds, run.cost, message)


def rejection_justified(run: ReplayedTrace) -> Iterator[Finding]:
    """8. The evidence that a rejection cites really disagrees, recomputed.

    The observation is taken from the moves, the expectation from S; behind an unexplored dart, from
    the sequences executed for earlier edges. Rules `folding` and `planar` cite a contradiction,
    which must follow from the history.
    """
    for decision in run.rounds:
        event = decision.event
        if type(event) is ev.Reject and (why := _unjustified(run, decision, event)):
            message = f"rejecting {event.hypothesis} for edge {event.edge} is not justified: {why}"
            yield Wrong(decision.when, "evidence that disagrees", event.evidence, message)


UNTRUE = Wrong(None, "true percepts", None, "the percepts are not true and prove nothing")
"""Such a history is not folded: a false percept may claim any number of doors."""


def map_entailed(run: ReplayedTrace) -> Iterator[Finding]:
    """9. The history alone proves the map: no other world fits it."""
    proofs = [map_conclusion(run.fold, run.code)] if run.is_history else []
    yield from unproved("map-entailed", proofs) if run.is_history else [UNTRUE]


def decisions_entailed(run: ReplayedTrace) -> Iterator[Finding]:
    """10. The history at that moment alone proves each declared reject, confirm, augmentation."""
    conclusions = run.conclusions.values()
    yield from unproved("decisions-entailed", conclusions) if run.is_history else [UNTRUE]


def unproved(claim: str, conclusions: Iterable[Conclusion]) -> Iterator[Finding]:
    """A finding for each conclusion that does not follow and is not undecided."""
    expected, but = "a proved decision", "the decision does not follow"
    if claim == "map-entailed":
        expected, but = "a map that is proved", "the history proves no such map"
    for when, why, witness, _ in conclusions:
        if why not in ("", UNDECIDED[0]):
            text = witness.text if witness else None
            yield Finding(claim, when, expected, why, f"{but}: {why}", text)


# ---------------------------------------------------------------- what justifies a rejection


def _unjustified(run: ReplayedTrace, decision: Round, event: ev.Reject) -> str:
    h, when, pose, end = event.hypothesis, decision.when, decision.pose, decision.end
    if pose is None or h not in pose.hypotheses:
        return "no such hypothesis was posed"
    if end is None or not run.map.is_open(h, when):
        return "the two are not unexplored darts of S"
    if event.rule in ("folding", "planar"):
        ends = run.map.seen_at(run.map.phi[h]), run.map.seen_at(end)
        return _unmet(run, when, event.evidence, ends)
    if event.evidence.contradiction is not None:
        return f"rule {event.rule!r} rests on two percepts, and cites a contradiction"
    return _percepts_agree(run, decision, event, end, h)


def _unmet(run: ReplayedTrace, when: int, cited: ev.Evidence, ends: tuple[Percept, Percept]) -> str:
    for told, seen in zip((cited.expected, cited.observed), ends, strict=True):
        if told not in (None, seen):
            return f"what is seen there is {seen}, not {told}"
    if cited.step or (cited.sequence, cited.at, cited.record) != (None, None, None):
        return "it rests on no step of a sequence, and cites one"
    if (conclusion := run.conclusions.get(when)) is None:
        return "S was not proved so far"
    return "" if conclusion.met else f"it does not follow that {cited.contradiction!r}"


def _percepts_agree(
    run: ReplayedTrace, decision: Round, event: ev.Reject, end: WorldDart, h: KnownDart
) -> str:
    cited, word, when = event.evidence, _executed(decision, event), decision.when
    if word is None:
        return f"step {cited.step}, which it cites, was not executed"
    observed = word[-1].percept if word else run.map.seen_at(end)
    if cited.observed != observed:
        return f"observed is {observed}, not {cited.observed}"
    at, rest = run.records.trace(h, word, when)
    doors = tuple(step.door for step in rest[1:])
    if cited.at not in (None, at) or cited.record != (ev.Record(at, doors) if rest else None):
        leaves = f"lead to unexplored dart {at}, behind which S expects nothing"
        leaves += f": cite its record, doors {list(doors)}" * (event.rule == "records")
        ends = f"end at dart {at}: cite that dart and no record"
        return f"on S the doors {leaves if rest else ends}"
    expected = run.records.behind(at, doors, when) if rest else run.map.seen_at(run.map.phi[at])
    if expected is None:
        return f"nothing is recorded behind dart {at} and the doors {list(doors)}"
    if cited.expected != expected:
        return f"expected is {expected}, not {cited.expected}"
    return f"{observed} is both expected and observed" if expected == observed else ""


def _executed(decision: Round, event: ev.Reject) -> Word | None:
    number, step, words = event.evidence.sequence, event.evidence.step, decision.sequences
    if number is None:
        number, words = 0, (decision.word,) if event.rule == "motion" else ()
    executed = 0 <= number < len(words) and 0 <= step <= len(words[number])
    return words[number][:step] if executed else None


# ---------------------------------------------------------------- words for messages


def _leads(run: ReplayedTrace, decision: Round) -> str:
    if (end := decision.end) is None:
        return "nowhere (it is not an unexplored dart of S)"
    degree, truth = run.map.seen_at(end).degree, decision.truth
    return f"a new vertex of degree {degree}" if truth is None else f"dart {truth}"


CLAIMS: dict[str, tuple[Claim, tuple[type[ev.Event], ...], bool]] = {
    "percepts-true": (percepts_true, (), False),
    "true-hypothesis-posed": (true_hypothesis_posed, (ev.Pose,), False),
    "true-hypothesis-kept": (true_hypothesis_kept, (ev.Pose, ev.Reject), False),
    "no-false-confirm": (no_false_confirm, (ev.Pose, ev.Confirm), False),
    "map-isomorphic": (map_isomorphic, (), False),
    "cost-honest": (cost_honest, (), False),
    "cost-within-bound": (cost_within_bound, (), False),
    "rejection-justified": (rejection_justified, (ev.Pose, ev.Reject), False),
    "map-entailed": (map_entailed, (ev.Finish,), False),
    "decisions-entailed": (decisions_entailed, (ev.Reject, ev.Confirm, ev.Augment), True),
}
"""Each claim; the events that it speaks of (none: any); whether it folds the history at each event,
which takes long in a large world."""
