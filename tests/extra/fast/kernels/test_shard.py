"""A range examined by the kernel: status, share and cost are those of the checkers."""

from __future__ import annotations

from collections import Counter

import pytest
from msgspec import structs

pytest.importorskip("numba", reason="the compiled engine needs numba")

from tests.extra.fast.kernels.judged import as_judged, counted
from topo_verify import CATALOGUE, worlds
from topo_verify.campaign.run import explore
from topo_verify.campaign.tally import Costs
from topo_verify.checkers import CLAIMS, check
from topo_verify.errors import InputError
from topo_verify.extra.fast.checks import CompiledChecks
from topo_verify.extra.fast.kernels.events import words
from topo_verify.extra.fast.kernels.faults import PLANTED
from topo_verify.extra.fast.kernels.workspace import TRACE
from topo_verify.extra.fast.snapshots import Snapshot, examine_range
from topo_verify.faults import FAULTS
from topo_verify.programs.loader import Mapper
from topo_verify.robot.events import Finish, Reject, Start, Trace
from topo_verify.robot.percept import Percept
from topo_verify.world.enumeration import rank_order
from topo_verify.world.rooted_map import World


def judged_by_checkers(mapper: Mapper | str, edges: int) -> dict[str, object]:
    """What the reference comes to: statuses, shares, costs and failing ranks."""
    statuses = {claim: Counter[str]() for claim in CLAIMS}
    shares: dict[str, tuple[int, int]] = dict.fromkeys(CLAIMS, (0, 0))
    costs: list[int] = []
    failing: list[int] = []
    for rank, world in enumerate(worlds(edges=edges)):
        run = explore(world, mapper)
        judgements = check(world, run.trace, run.stopped)
        for one in judgements:
            statuses[one.claim][one.status] += 1
            judged, of = shares[one.claim]
            shares[one.claim] = judged + one.judged, of + one.of
        if any(one.status == "failed" for one in judgements):
            failing.append(rank)
        else:
            costs.append(run.cost)
    return {
        "statuses": {claim: dict(seen) for claim, seen in statuses.items()},
        "shares": shares,
        "total": sum(costs),
        "most": max(costs, default=0),
        "failing": len(failing),
        "failing_ranks": tuple(failing[:10]),
    }


def judged_by_kernel(end: Snapshot) -> dict[str, object]:
    costs = [*end.tally.costs.values()] or [Costs()]
    return {
        "statuses": end.tally.statuses,
        "shares": end.tally.shares,
        "total": costs[0].total,
        "most": costs[0].most,
        "failing": end.tally.failing,
        "failing_ranks": end.named[0].failing,
    }


@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.parametrize("edges", [1, 2, 3])
def test_every_claim_has_the_status_and_share_that_the_checkers_give(name: str, edges: int) -> None:
    assert judged_by_kernel(examine_range([name], edges)) == judged_by_checkers(name, edges)


@pytest.mark.long
@pytest.mark.parametrize("name", PLANTED)
def test_a_seeded_fault_has_the_verdicts_that_the_checkers_give(name: str) -> None:
    for edges in (2, 3):
        end = examine_range([name], edges, faults={name: name})
        assert judged_by_kernel(end) == judged_by_checkers(FAULTS[name], edges), edges


@pytest.mark.long
def test_a_range_stops_behind_its_first_failing_world() -> None:
    name = "leaves-out-the-darts-of-vk"
    whole = examine_range([name], 3, faults={name: name})
    short = examine_range([name], 3, faults={name: name}, stop_at_first=True)
    assert short.tally.failing == 1
    assert short.named[0].failing == whole.named[0].failing[:1]
    assert short.tally.worlds == whole.named[0].failing[0] + 1


def test_the_tallies_of_parts_add_up_to_that_of_the_whole() -> None:
    whole = examine_range(["enhancement-ii", "basic"], 5).tally
    first = examine_range(["enhancement-ii", "basic"], 5, stop=3000).tally
    second = examine_range(["enhancement-ii", "basic"], 5, start=3000).tally
    assert whole.worlds == rank_order.count(5)
    assert first + second == whole
    assert first.digest != second.digest


def test_two_algorithms_are_compared_world_by_world() -> None:
    names = ["basic", "enhancement-i"]
    costs = [[explore(w, name).cost for w in worlds(edges=4)] for name in names]
    pairs = examine_range(names, 4).tally.pairs
    assert pairs.dearer == sum(a > b for a, b in zip(*costs, strict=True))
    assert pairs.cheaper == sum(a < b for a, b in zip(*costs, strict=True))
    end = examine_range(names, 5)
    assert len({end.tally.costs[name].total for name in names}) == 2
    assert end.named[0].dearer
    for rank, cost, other in end.named[0].dearer:
        world = World.from_id(f"m5/{rank}")
        assert (explore(world, "basic").cost, explore(world, "enhancement-i").cost) == (cost, other)


@pytest.mark.parametrize("room", [0, 60, 300])
def test_a_trace_that_does_not_fit_changes_no_count(room: int) -> None:
    names = ["basic", "folding+planar"]
    assert examine_range(names, 3, room=room) == examine_range(names, 3)


LONG_TRACE = 273_516
"""The rank of a world with 7 edges in which the planar prior is wrong and the run is long."""


@pytest.mark.long
def test_a_run_of_more_words_than_the_workspace_has_is_judged_by_the_checkers() -> None:
    world = World.from_id(f"m7/{LONG_TRACE}")
    run = explore(world, "folding+planar", engine="compiled")
    assert len(words(run.trace)) > TRACE
    end = examine_range(["folding+planar"], 7, start=LONG_TRACE, stop=LONG_TRACE + 1)
    assert counted(end.tally) == as_judged(check(world, run.trace, run.stopped))
    assert end.named[0].failing == (LONG_TRACE,)


def test_a_class_is_examined_alone() -> None:
    tally = examine_range(["folding+planar"], 4, "planar").tally
    assert tally.worlds == rank_order.count_planar(4)
    assert not tally.failing


def test_the_worst_worlds_cost_the_most() -> None:
    end = examine_range(["basic"], 5)
    costs, worst = end.tally.costs["basic"], end.named[0].worst
    assert (costs.total, costs.most) == (68_652, 36)
    assert len(worst) == min(10, costs.attained)
    for rank in worst:
        assert explore(World.from_id(f"m5/{rank}"), "basic").cost == costs.most


def test_what_cannot_be_examined_is_refused_with_the_choices() -> None:
    with pytest.raises(InputError, match="expected an algorithm of the catalogue, got 'best'"):
        examine_range(["best"], 3)
    with pytest.raises(InputError, match="8, 9 or 10"):
        examine_range(["basic"], 3, claims=7)
    with pytest.raises(InputError, match="expected a fault that has a kernel"):
        examine_range(["x"], 3, faults={"x": "no-such-fault"})


def test_the_kernel_asks_a_claim_at_every_level() -> None:
    for level in (8, 9, 10):
        tally = examine_range(["basic"], 2, claims=level).tally
        assert list(tally.statuses) == list(CLAIMS)[:level]


def test_compiled_checks_judge_as_the_checkers_do() -> None:
    checks = CompiledChecks()
    mappers: list[Mapper | str] = ["basic", "folding", FAULTS["sets-out-unturned"].mapper]
    for world in (world for edges in (1, 2, 3) for world in worlds(edges=edges)):
        for mapper in mappers:
            run = explore(world, mapper)
            ours = checks(world, run.trace, run.stopped, strict=False)
            assert list(ours) == list(check(world, run.trace, run.stopped))


def test_compiled_checks_pass_nothing_that_the_checkers_refuse() -> None:
    world = World.from_id("m3/9")
    start, *events, finish = explore(world, "basic").trace
    assert isinstance(finish, Finish)
    assert isinstance(start, Start)
    edges = finish.map.edges
    doctored: list[Trace] = [
        (structs.replace(start, percept=Percept(9, None)), *events, finish),
        (start, *events, structs.replace(finish, cost=-1)),
        (start, *events, _with_map(finish, edges=(*edges, edges[0]))),
        (start, *events, _with_map(finish, edges=edges[1:])),
        (start, *events, _with_map(finish, marker=1)),
        (start, *events[:-1], finish),
    ]
    rejects = [at for at, event in enumerate(events) if isinstance(event, Reject)]
    for at in rejects:  # as a word, this percept would be the one that was seen
        event = events[at]
        assert isinstance(event, Reject)
        seen = event.evidence.observed
        assert seen is not None
        alias = Percept(seen.degree - 1, 65536 + (-1 if seen.marker is None else seen.marker))
        wrong = structs.replace(event, evidence=structs.replace(event.evidence, observed=alias))
        doctored.append((start, *events[:at], wrong, *events[at + 1 :], finish))
    assert rejects
    for trace in doctored:
        judged = list(CompiledChecks()(world, trace, None, strict=False))
        assert judged == list(check(world, trace))
        assert any(one.status == "failed" for one in judged)


def _with_map(finish: Finish, **fields: object) -> Finish:
    return structs.replace(finish, map=structs.replace(finish.map, **fields))
