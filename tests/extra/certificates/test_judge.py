"""The judge that is proved, the checkers that run and the compiled judge say the same of a run.

Coq extracts the judge of coq/Judge.v as a program in OCaml. Status, `judged` and `of` of its claims
are compared with those of the Python checkers, run by run: for every algorithm and every seeded
fault in every world to 4 edges, in larger worlds, and for traces with random changes. With the
compiled judge the sums over all worlds of a size are compared.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import suppress
from itertools import islice
from pathlib import Path

import msgspec
import pytest

from tests.checkers.mutated import mutated_traces
from tests.faults.every import EVERY
from tests.helpers import EMPTY, edited, trace_of, worlds
from tests.proofs.mechanised.conftest import LIMIT, RARE
from topo_verify import CATALOGUE, InputError, Limits, World, explore
from topo_verify.checkers import CLAIMS, Judgement, check
from topo_verify.extra.certificates import judge
from topo_verify.extra.fast.snapshots import examine_range
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept
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


def changed_runs(number: int, seed: int) -> Iterator[judge.TracedRun]:
    """Five traces of each run with some changes, if a file can hold them and Coq count so far."""
    for world, trace, _ in mutated_traces(seed, number, most_edges=5):
        with suppress(InputError):
            numbers = judge.numbers(world, ev.read_trace(ev.write_trace(trace)))
            if max(numbers) < 1000:
                yield world, trace


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
def test_the_judge_agrees_on_traces_with_random_changes(program: Path, seed: int) -> None:
    assert differing(program, changed_runs(4_000, seed)) == []


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
    judgements = [one for run in changed_runs(400, 0) for one in by_checkers(run)]
    assert {one.claim for one in judgements if one.status == "failed"} == {*CLAIMS}
    assert {one.status for one in judgements} == {"ok", "failed", "partial", "not-declared"}


# ---------------------------------------------------------------- a run as numbers


@pytest.mark.parametrize("claim", CLAIMS)
def test_a_checker_that_finds_nothing_is_seen(
    program: Path, monkeypatch: pytest.MonkeyPatch, claim: str
) -> None:
    _, events, folds = CLAIMS[claim]
    monkeypatch.setitem(CLAIMS, claim, (lambda _: iter(()), events, folds))
    assert differing(program, changed_runs(160, 5))


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
