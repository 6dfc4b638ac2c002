"""The judge that is proved, the checkers that run and the compiled judge say the same of a run.

Coq extracts the judge of coq/Judge.v as a program in OCaml. Status, `judged` and `of` of its claims
are compared with those of the Python checkers, run by run: for every algorithm and every seeded
fault in every world to 4 edges, in larger worlds, and for traces with one random change. With the
compiled judge the sums over all worlds of a size are compared.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path
from random import Random

import msgspec
import pytest

from tests.faults.every import EVERY
from tests.helpers import EMPTY, edited, trace_of, worlds
from tests.proofs.mechanised.conftest import LIMIT, RARE
from topo_verify import CATALOGUE, InputError, Limits, World, explore
from topo_verify.checkers import CLAIMS, Judgement, check
from topo_verify.checkers.folding import OWN_END, TURNED, TWO_OF_S, UNLIKE
from topo_verify.extra.certificates import judge
from topo_verify.extra.fast.snapshots import examine_range
from topo_verify.programs.loader import Mapper
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept
from topo_verify.world.enumeration import rank_order
from topo_verify.world.resolve import resolve_world

LARGER = (
    "family:lattice(4,4,holes=0.2,seed=7)", "family:torus(3,3)", "family:wheel(5)",
    "family:random_genus(9,2,seed=3)", "nyc",
)  # fmt: skip

STUCK_SOON = Limits(move_timeout=0.5)
"""In 13 of these worlds a fault loops without a move: its trace is the same after 5 s."""


@pytest.fixture(scope="module")
def program(library: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The extracted judge; skips where there is no compiler for it."""
    if why := judge.missing():
        pytest.skip(why)
    folder = tmp_path_factory.mktemp("judge")
    for path in library.glob("*.vo"):
        (folder / path.name).symlink_to(path)
    return judge.build(folder, timeout=LIMIT)


def by_checkers(run: judge.TracedRun) -> tuple[Judgement, ...]:
    """The judgements of the Python checkers, without findings, of the claims that Coq judges."""
    return tuple(
        msgspec.structs.replace(judgement, findings=())
        for judgement in check(*run)
        if judgement.claim in judge.judged_claims(run[1])
    )


def differing(program: Path, runs: Iterable[judge.TracedRun]) -> list[tuple[str, ev.Trace]]:
    """The world and the trace of each run of which the two say different things."""
    differences: list[tuple[str, ev.Trace]] = []
    rest = iter(runs)
    while batch := list(islice(rest, 5000)):
        batch = list(dict.fromkeys(batch))  # many faulty mappers do the same in a small world
        for run, answer in zip(batch, judge.judge(program, batch, timeout=LIMIT), strict=True):
            if answer != by_checkers(run):
                differences.append((run[0].id, tuple(run[1])))
    return differences


# ---------------------------------------------------------------- one random change


def changed(trace: ev.Trace, random: Random, darts: int) -> ev.Trace:
    """The trace with one change: a door, a percept, a dart, or an event dropped, doubled, moved."""
    inner = range(1, len(trace) - isinstance(trace[-1], ev.Finish))
    if not inner or random.random() < 0.1:
        return (
            trace[:-1]
            if len(trace) > 1 and random.random() < 0.5
            else _other(trace, 0, random, darts)
        )
    at = random.choice(inner)
    match random.randrange(6):
        case 0:
            return trace[:at] + trace[at + 1 :]
        case 1:
            return trace[:at] + trace[at : at + 1] + trace[at:]
        case 2:
            rest = [*trace[:at], *trace[at + 1 :]]
            rest.insert(random.choice(inner), trace[at])
            return tuple(rest)
        case _:
            return _other(trace, at, random, darts)


def _other(trace: ev.Trace, at: int, random: Random, darts: int) -> ev.Trace:
    """The trace with another number in one event."""
    event, number = trace[at], random.randrange(darts + 2)
    changes: dict[str, object] = {}
    match event:
        case ev.Move() | ev.Start():
            degree, marker = event.percept.degree, event.percept.marker
            changes = random.choice([
                {"percept": Percept(number, marker)},
                {"percept": Percept(degree, None if marker is not None else number)},
                {"percept": Percept(degree, number)},
                {"door": number},
            ])  # fmt: skip
            if isinstance(event, ev.Start):
                changes = {"percept": Percept(number, marker)}
        case ev.Pose(hypotheses=hypotheses):
            more = (*hypotheses, number)
            less = tuple(h for h in hypotheses if random.random() < 0.7)
            changes = random.choice([{"edge": number}, {"hypotheses": more}, {"hypotheses": less}])
        case ev.Reject() if random.random() < 0.7:
            changes = _other_reason(event, random, number)
        case ev.Reject() | ev.Confirm():
            changes = {random.choice(["edge", "hypothesis"]): number}
        case ev.Augment(kind=kind):
            if random.random() < 0.3:
                changes = {"kind": "new" if kind == "loop" else "loop"}
            else:
                changes = {random.choice(["edge", "dart", "degree"]): number}
        case _:
            pass
    return edited(trace, at, **changes)


def _other_reason(event: ev.Reject, random: Random, number: int) -> dict[str, object]:
    """Another rule or another evidence of a rejection."""
    small, percept = random.randrange(3), Percept(number, random.choice([None, 0, 1]))
    record = event.evidence.record or ev.Record(number, ())
    changes: dict[str, object] = random.choice([
        {"step": small}, {"sequence": random.choice([None, small])},
        {"at": random.choice([None, number])},
        {"expected": random.choice([None, percept, event.evidence.observed])},
        {"observed": random.choice([None, percept, event.evidence.expected])},
        {"record": random.choice([None, ev.Record(number, record.doors)])},
        {"record": ev.Record(record.dart, (small,))},
        {"contradiction": random.choice([None, UNLIKE, TURNED, OWN_END, TWO_OF_S, "a whim"])},
    ])  # fmt: skip
    if random.random() < 0.2:
        return {"rule": random.choice(["motion", "prefix", "history", "records", "folding"])}
    return {"evidence": msgspec.structs.replace(event.evidence, **changes)}


def changed_runs(number: int, seed: int) -> Iterator[judge.TracedRun]:
    """Runs of algorithms and faulty mappers in worlds to 5 edges, each with one random change."""
    random = Random(seed)
    mappers: list[Mapper] = [*CATALOGUE.values(), *EVERY.values()]
    for _ in range(number // 10):
        edges = random.choice([1, 2, 3, 3, 4, 4, 5])
        world = World.from_code(rank_order.unrank(edges, random.randrange(rank_order.count(edges))))
        trace = trace_of(world, random.choice(mappers))
        for _ in range(10):
            yield world, changed(trace, random, len(world.alpha))


# ---------------------------------------------------------------- all say the same


def test_the_judge_agrees_on_every_algorithm_in_every_world_to_4_edges(program: Path) -> None:
    every = ((world, trace_of(world, name)) for world in worlds(range(5)) for name in CATALOGUE)
    assert differing(program, every) == []


def test_the_judge_agrees_on_every_algorithm_in_larger_worlds(program: Path) -> None:
    larger = ((resolve_world(text), name) for text in LARGER for name in CATALOGUE)
    assert differing(program, ((world, trace_of(world, name)) for world, name in larger)) == []


@pytest.mark.parametrize("edges", [3, pytest.param(4, marks=RARE)])
def test_the_judge_agrees_on_every_fault_in_every_small_world(program: Path, edges: int) -> None:
    every = (
        (world, explore(world, fault, limits=STUCK_SOON).trace)
        for world in worlds(range(edges + 1))
        for fault in EVERY.values()
    )
    assert differing(program, every) == []


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=RARE)])
def test_the_judge_agrees_on_traces_with_one_random_change(program: Path, seed: int) -> None:
    assert differing(program, changed_runs(10_000, seed)) == []


@pytest.mark.parametrize("edges", range(1, 5))
def test_the_judge_agrees_with_the_compiled_one(program: Path, edges: int) -> None:
    for name in CATALOGUE:
        tally = examine_range([name], edges).tally
        runs = [(world, trace_of(world, name)) for world in worlds([edges])]
        answers = judge.judge(program, runs, timeout=LIMIT)
        for claim in CLAIMS:
            judgements = [one for answer in answers for one in answer if one.claim == claim]
            if len(judgements) < len(runs):
                continue  # a run declares the planar prior, or is long
            statuses = Counter(judgement.status for judgement in judgements)
            assert statuses == Counter(tally.statuses[claim])
            judged = sum(judgement.judged for judgement in judgements)
            of = sum(judgement.of for judgement in judgements)
            assert (judged, of) == tally.shares[claim]


@pytest.mark.long
def test_the_random_changes_make_every_claim_fail_and_every_status_occur() -> None:
    judgements = [one for run in changed_runs(1000, 0) for one in by_checkers(run)]
    assert {one.claim for one in judgements if one.status == "failed"} == {*CLAIMS}
    assert {one.status for one in judgements} == {"ok", "failed", "partial", "not-declared"}


# ---------------------------------------------------------------- a run as numbers


@pytest.mark.parametrize("claim", CLAIMS)
def test_a_checker_that_finds_nothing_is_seen(
    program: Path, monkeypatch: pytest.MonkeyPatch, claim: str
) -> None:
    _, events = CLAIMS[claim]
    monkeypatch.setitem(CLAIMS, claim, (lambda _: iter(()), events))
    assert differing(program, changed_runs(400, 5))


@pytest.mark.parametrize("door", [-1, 2**60 + 1])
def test_a_number_that_cannot_be_stated_is_refused(door: int) -> None:
    trace = edited(trace_of("m1/0"), 1, door=door)
    with pytest.raises(InputError, match="cannot be stated as a natural number"):
        judge.numbers(World.from_id("m1/0"), trace)


def test_the_world_without_an_edge_is_judged(program: Path) -> None:
    trace = trace_of(EMPTY)
    lies = [trace, edited(trace, 0, percept=Percept(1, None)), trace[:-1]]
    lies += [edited(trace, -1, map=ev.MapData(rows, (), None)) for rows in ((), ((), ()), ((0,),))]
    assert differing(program, [(EMPTY, lie) for lie in lies]) == []
