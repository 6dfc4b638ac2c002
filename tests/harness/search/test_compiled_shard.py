"""A search by the compiled engine: what the checkers count, and what they hold it to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
import pytest

from topo_verify import CATALOGUE, Exploration, InputError, InternalError, Limits, explore
from topo_verify.faults import FAULTS
from topo_verify.harness.engines import CompiledAlgorithm
from topo_verify.harness.ledger import Ledger
from topo_verify.harness.search import compiled_shard
from topo_verify.harness.search import plan as planning
from topo_verify.harness.search.by_checkers import Interrupted, examine_by_checkers
from topo_verify.harness.search.compiled_shard import CompiledShard
from topo_verify.harness.search.exhaustive import Search, SearchResult, search
from topo_verify.harness.search.plan import Plan, Shard
from topo_verify.harness.search.shard import examine_shard
from topo_verify.harness.tally import Tally
from topo_verify.harness.targets import targets
from topo_verify.harness.verify import small_worlds
from topo_verify.harness.verify.small_worlds import SmallWorlds
from topo_verify.programs.loader import Target
from topo_verify.world.enumeration.classes import WorldClass

pytest.importorskip("numba")

from topo_verify.compiled import shard as engine

Counts = Any


def plain(tally: Tally) -> Tally:
    """Without what only one of the engines keeps."""
    return msgspec.structs.replace(tally, digest="", sample=(), by_checkers=0)


def found(target: str, edges: int, kind: str = "any", **options: Any) -> SearchResult:
    return search(target, edges=edges, world_class=WorldClass.parse(kind), **options)


# ---------------------------------------------------------------- the same results


@pytest.mark.parametrize(
    ("target", "edges", "kind", "keep_going"),
    [
        ("basic", 4, "any", False),
        ("folding", 4, "genus<=1", False),
        ("enhancement-iii-all+i", 5, "simple", True),
        ("enhancement-ii,enhancement-i", 4, "any", False),
        ("folding+planar", 3, "any", False),
        ("folding+planar", 4, "any", True),
    ],
)
def test_the_compiled_engine_counts_what_the_checkers_count(
    target: str, edges: int, kind: str, *, keep_going: bool
) -> None:
    ours = found(target, edges, kind, keep_going=keep_going)
    theirs = found(target, edges, kind, keep_going=keep_going, engine="compiled")
    assert (theirs.verdict, theirs.counterexample) == (ours.verdict, ours.counterexample)
    assert theirs.claims == ours.claims
    for one, other in zip(ours.by_edges, theirs.by_edges, strict=True):
        assert plain(other.tally) == plain(one.tally)
        assert other.checked == one.checked


def test_slices_and_workers_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = found("basic", 4, engine="compiled")
    monkeypatch.setattr(planning, "COMPILED_SHARD", 100)
    assert found("basic", 4, engine="compiled", workers=2).verdict == whole.verdict
    monkeypatch.setattr(compiled_shard, "SLICE", 7)
    cut = found("basic", 4, engine="compiled")
    for one, other in zip(whole.by_edges, cut.by_edges, strict=True):
        assert plain(other.tally) == plain(one.tally)
        assert other.tally.digest == one.tally.digest


WRONG = {
    "basic": "tries-only-the-nearest-two",
    "enhancement-ii": "takes-unknown-for-a-mismatch",
    "folding": "forgets-that-vu-may-be-new",
}
"""Algorithms, and the mistakes that are planted in them here."""


@pytest.mark.parametrize("keep_going", [False, True])
@pytest.mark.parametrize(("edges", "start", "stop"), [(3, 0, 74), (4, 300, 500)])
def test_several_algorithms_that_fail_are_counted_as_the_checkers_count_them(
    monkeypatch: pytest.MonkeyPatch, edges: int, start: int, stop: int, *, keep_going: bool
) -> None:
    examine = engine.examine_range

    def planted(world: Any, target: Any, **options: Any) -> Exploration:
        if "engine" not in options:
            run = explore(world, target, **options)
            return replace(run, mapper=None)  # a fault does not run in witness worlds
        wrong = Target(target, CompiledAlgorithm(target, WRONG[target]))
        start, *events = (run := explore(world, wrong, limits=options["limits"])).trace
        start = msgspec.structs.replace(start, policies=None)  # those of a seeded fault are unknown
        return replace(run, trace=(start, *events))

    monkeypatch.setattr(engine, "examine_range", partial(examine, faults=WRONG))
    monkeypatch.setattr(compiled_shard, "explore", planted)
    plan = Plan(targets=tuple(WRONG), edges=edges, engine="compiled", keep_going=keep_going)
    mappers = [Target(text, FAULTS[fault]) for text, fault in WRONG.items()]
    shard = Shard(edges, start, stop)
    ours = examine_by_checkers(plan, mappers, shard)
    theirs = examine_shard(plan, mappers, shard).tally
    if keep_going:
        assert len({failure.target for failure in ours.failures}) > 1
    assert plain(theirs) == plain(ours)


# ---------------------------------------------------------------- what the checkers judge again


def made(plan: Plan, shard: Shard) -> CompiledShard:
    done = CompiledShard(plan, targets(",".join(plan.targets)), shard)
    done.examine(lambda _worlds: None)
    return done


PLAN = Plan(targets=("basic",), edges=5, engine="compiled")


def sampled(plan: Plan) -> list[int]:
    return list(CompiledShard(plan, targets("basic"), Shard(5, 0, 8162))._sampled(8162))  # pyright: ignore[reportPrivateUsage]  what is drawn


def test_about_one_world_in_a_thousand_is_judged_by_the_checkers_too() -> None:
    drawn = sampled(PLAN)
    assert 2 <= len(drawn) <= 20
    assert drawn == sorted(drawn) == sampled(PLAN)
    assert drawn != sampled(msgspec.structs.replace(PLAN, seed=1))
    planar = sampled(msgspec.structs.replace(PLAN, kind="planar"))
    assert set(planar) < set(drawn)


def test_the_worst_worlds_are_judged_by_the_checkers_too() -> None:
    done = made(PLAN, Shard(5, 0, 8162))
    worst = {world for costs in done.tally().costs.values() for world in costs.worst}
    assert worst
    assert done.tally().by_checkers == len({f"m5/{rank}" for rank in sampled(PLAN)} | worst)
    assert done.seconds.checkers > 0 < done.seconds.engine


def lying(monkeypatch: pytest.MonkeyPatch, change: Callable[[Counts], Counts]) -> None:
    """The engine counts something else from now on."""
    examine = engine.examine_range

    def lies(*arguments: Any, **options: Any) -> tuple[Counts, ...]:
        return tuple(change(one) for one in examine(*arguments, **options))

    monkeypatch.setattr(engine, "examine_range", lies)


def cheaper(counts: Counts) -> Counts:
    share = {**counts.shares, "no-false-confirm": (0, 0)}
    return msgspec.structs.replace(counts, shares=share)


def never_confirms(counts: Counts) -> Counts:
    statuses = {**counts.statuses, "no-false-confirm": {"not-declared": counts.worlds}}
    return msgspec.structs.replace(counts, statuses=statuses)


def convicts(counts: Counts) -> Counts:
    claims = {**counts.claims, "map-entailed": (1, 0)}
    return msgspec.structs.replace(counts, claims=claims, failing=1, failing_ranks=(0,))


@pytest.mark.parametrize("change", [cheaper, never_confirms, convicts])
def test_an_engine_that_judges_otherwise_is_our_bug(
    change: Callable[[Counts], Counts], monkeypatch: pytest.MonkeyPatch
) -> None:
    lying(monkeypatch, change)
    words = r"^m5/\d+, basic: the engines disagree: (no-false-confirm|no claim fails by)"
    with pytest.raises(InternalError, match=words):
        made(PLAN, Shard(5, 0, 8162))


def dearer(run: Exploration) -> Exploration:
    return replace(run, cost=run.cost + 1)


def without_map(run: Exploration) -> Exploration:
    return replace(run, map=None)


def cut_off(run: Exploration) -> Exploration:
    return replace(run, trace=run.trace[:-1])


def backwards(run: Exploration) -> Exploration:
    return replace(run, trace=run.trace[::-1])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (dearer, r"cost \d+ by the reference, \d+ by the compiled"),
        (without_map, r"cost \d+ by the reference, \d+ by the compiled"),
        (cut_off, r"\d+ events by the reference, \d+ by the com"),
        (backwards, r"event 0 is Start.* by the reference, Finish"),
    ],
)
def test_an_engine_that_runs_otherwise_is_our_bug(
    change: Callable[[Exploration], Exploration], words: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lies(world: Any, target: Any, **options: Any) -> Exploration:
        run = explore(world, target, **options)
        return change(run) if "engine" in options else run

    monkeypatch.setattr(compiled_shard, "explore", lies)
    with pytest.raises(InternalError, match=rf"^m5/\d+, basic: the engines disagree: {words}"):
        made(PLAN, Shard(5, 0, 8162))


def test_what_the_engine_leaves_open_the_checkers_decide(monkeypatch: pytest.MonkeyPatch) -> None:
    plan, shard = Plan(targets=("basic",), edges=3, engine="compiled"), Shard(3, 10, 30)
    by_checkers = examine_by_checkers(plan, targets("basic"), shard)

    def undecided(counts: Counts) -> Counts:
        return msgspec.structs.replace(counts, undecided=counts.worlds)

    lying(monkeypatch, undecided)
    tally = examine_shard(plan, targets("basic"), shard).tally
    assert msgspec.structs.replace(plain(tally), sample=()) == plain(by_checkers)
    assert tally.by_checkers == 20


def test_ctrl_c_keeps_the_slices_that_are_done(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiled_shard, "SLICE", 100)

    def beat(worlds: int) -> None:
        if worlds == 300:
            raise KeyboardInterrupt

    with pytest.raises(Interrupted) as cut:
        examine_shard(PLAN, targets("basic"), Shard(5, 0, 8162), beat)
    assert cut.value.tally.worlds == 300


# ---------------------------------------------------------------- what is refused


@pytest.mark.parametrize(
    ("target", "options", "words"),
    [
        ("mappers.py:right", {}, "runs the algorithms of the catalogue, basic,"),
        ("basic", {"policies": "all"}, "it knows the reference policies only"),
        ("basic", {"limits": Limits(world_timeout=1.0)}, "leave out --move-timeout"),
        ("basic", {"limits": Limits(budget=7)}, "leave out --budget"),
    ],
)
@pytest.mark.usefixtures("folder")
def test_what_the_engine_cannot_search_is_refused(
    target: str, options: dict[str, Any], words: str
) -> None:
    with pytest.raises(InputError, match=words):
        search(target, edges=2, engine="compiled", **options)


def test_a_ledger_never_mixes_engines(folder: Path) -> None:
    def searched(plan: Plan) -> SearchResult:
        mappers = targets("basic")
        with Ledger(str(folder / "ledger"), plan, mappers, "1") as ledger:
            work = Search(plan, mappers, ledger=ledger)
            work.work()
            return work.found()

    plan = Plan(targets=("basic",), edges=3, engine="compiled")
    assert searched(plan).from_ledger == 0
    assert searched(plan).from_ledger == 86
    with pytest.raises(InputError, match="its engine is compiled, now it is reference"):
        searched(Plan(targets=("basic",), edges=3))


# ---------------------------------------------------------------- verify


def test_verify_goes_one_size_further_and_compares_the_engines(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def part(**options: Any) -> Any:
        job = SmallWorlds(3, targets("basic,folding"), Limits(), **options)
        job.work(lambda _what, _done, _total: None)
        return job.part()

    assert (part().verdict, part().checked) == ("EXHAUSTED", 86)
    further = part(further=True)
    assert (further.verdict, further.checked) == ("EXHAUSTED", 792)
    assert "; those of 4 edges by the compiled engine, and " in further.summary
    lying(monkeypatch, lambda counts: msgspec.structs.replace(counts, total=counts.total + 1))
    with pytest.raises(InternalError, match="1 edge the engines disagree on costs"):
        part(further=True)
    monkeypatch.setattr(small_worlds, "available", lambda: False)
    assert part(further=True).checked == 86


def test_the_engine_knows_every_algorithm_of_the_catalogue() -> None:
    assert {one.algorithm for one in engine.examine_range(list(CATALOGUE), 2)} == set(CATALOGUE)
