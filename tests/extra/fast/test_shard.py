"""Shards by the compiled engine: what the checkers count, and what they hold it to."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
import pytest

from tests.extra.fast.kernels.plain import plain as plain_kernel
from tests.studies.search.searching import search_of, searched
from topo_verify import CATALOGUE, Exploration, InputError, InternalError, Limits, explore
from topo_verify.campaign.attempt import attempt
from topo_verify.campaign.backend import here
from topo_verify.campaign.campaign import Campaign, Interrupted, Ranks, Shard, ShardResult
from topo_verify.campaign.campaign import examine as examine_by_checkers
from topo_verify.campaign.store import Store
from topo_verify.campaign.tally import Tally
from topo_verify.campaign.targets import targets
from topo_verify.campaign.worker import no_beat
from topo_verify.checkers import CLAIMS
from topo_verify.extra.fast import shard as shards
from topo_verify.extra.fast.checks import STATUSES
from topo_verify.extra.fast.engine import CompiledAlgorithm
from topo_verify.extra.fast.shard import examine_compiled
from topo_verify.faults import FAULTS
from topo_verify.programs.loader import Target
from topo_verify.studies.search.search import Search, SearchEntry, search, search_campaign
from topo_verify.studies.verify.parts import Part
from topo_verify.studies.verify.trials import EngineCounts, SmallWorlds, engine_counts
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.enumeration.pruned import ranked_tables

pytest.importorskip("numba")

from topo_verify.extra.fast import snapshots as engine
from topo_verify.extra.fast.kernels import tally
from topo_verify.extra.fast.snapshots import Snapshot


def plain(tally: Tally) -> Tally:
    """Without what the engines keep in different ways."""
    statuses = {claim: runs for claim, runs in tally.statuses.items() if runs}
    return msgspec.structs.replace(tally, digest="", by_checkers=0, statuses=statuses)


def campaign(target: str, edges: int, **options: Any) -> Campaign:
    return search_campaign(targets(target), edges=edges, engine="compiled", **options)


# ---------------------------------------------------------------- the same results


@pytest.mark.long
@pytest.mark.parametrize(
    ("target", "edges", "kind", "keep_going"),
    [
        ("basic", 4, "any", False),
        ("folding", 4, "genus<=1", False),
        ("enhancement-iii-all+i", 5, "simple", True),
        pytest.param("enhancement-ii,enhancement-i", 4, "any", False, marks=pytest.mark.nightly),
        ("folding+planar", 3, "any", False),
        pytest.param("folding+planar", 4, "any", True, marks=pytest.mark.nightly),
    ],
)
def test_the_compiled_engine_counts_what_the_checkers_count(
    target: str, edges: int, kind: str, *, keep_going: bool
) -> None:
    options: dict[str, Any] = {"edges": edges, "kind": kind, "keep_going": keep_going}
    ours, theirs = (searched(target, engine=e, **options) for e in ("reference", "compiled"))
    for size in ours.tallies:
        assert plain(theirs.tallies[size]) == plain(ours.tallies[size])
    ones, others = (
        msgspec.structs.replace(
            study.entry(compare="," in target), engine="", judged_by="", by_checkers=0
        )
        for study in (ours, theirs)
    )
    assert others == ones


@pytest.mark.nightly
def test_slices_and_workers_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = searched("basic", edges=4, engine="compiled")
    study = search_of("basic", edges=4, engine="compiled", workers=2)
    study.campaign = msgspec.structs.replace(study.campaign, worlds=Ranks(4, shard=100))
    study.work()
    assert study.entry().verdict == whole.entry().verdict
    monkeypatch.setattr(shards, "SLICE", 7)
    cut = searched("basic", edges=4, engine="compiled")
    for size in whole.tallies:
        assert plain(cut.tallies[size]) == plain(whole.tallies[size])
        assert cut.tallies[size].digest == whole.tallies[size].digest


WRONG = {
    "basic": "tries-only-the-nearest-two",
    "enhancement-ii": "takes-unknown-for-a-mismatch",
    "folding": "forgets-that-vu-may-be-new",
}
"""Algorithms, and the mistakes that are planted in them here."""


@pytest.mark.long
@pytest.mark.parametrize("keep_going", [False, True])
@pytest.mark.parametrize(("edges", "start", "stop"), [(3, 0, 74), (4, 300, 500)])
def test_several_algorithms_that_fail_are_counted_as_the_checkers_count_them(
    monkeypatch: pytest.MonkeyPatch, edges: int, start: int, stop: int, *, keep_going: bool
) -> None:
    def planted(world: Any, target: Any, **options: Any) -> Exploration:
        wrong = Target(target, CompiledAlgorithm(target, fault=WRONG[target]))
        start, *events = (run := explore(world, wrong, limits=options["limits"])).trace
        start = msgspec.structs.replace(start, policies=None)  # those of a seeded fault are unknown
        return replace(run, trace=(start, *events))

    monkeypatch.setattr(engine, "CompiledRange", partial(engine.CompiledRange, faults=WRONG))
    monkeypatch.setattr(shards, "SAMPLE", 10)
    monkeypatch.setattr(shards, "explore", planted)
    wrong = campaign(",".join(WRONG), edges, keep_going=keep_going)
    mappers = [Target(text, FAULTS[fault]) for text, fault in WRONG.items()]
    shard = Shard(edges, start, stop)
    ours = examine_by_checkers(wrong, mappers, shard)
    theirs = examine_compiled(wrong, mappers, shard, no_beat)
    assert plain(theirs.tally) == plain(ours.tally)
    for result in (ours, theirs):
        failing = [row for row in result.rows if row.failed]
        assert len({row.mapper for row in failing}) > 1 or not keep_going


# ---------------------------------------------------------------- what the checkers judge again


def made(asked: Campaign, shard: Shard) -> ShardResult:
    """A shard that the compiled engine has examined."""
    return examine_compiled(asked, asked.load(), shard, no_beat)


def judged_again(asked: Campaign, monkeypatch: pytest.MonkeyPatch) -> set[int]:
    """The ranks of the worlds of 5 edges that the checkers judge."""
    ranks: set[int] = set()

    def noted(world: Any, *arguments: Any, where: str, **options: Any) -> Any:
        ranks.add(int(where.partition("/")[2]))
        return attempt(world, *arguments, where=where, **options)

    with monkeypatch.context() as patch:
        patch.setattr(shards, "attempt", noted)
        assert made(asked, WHOLE).tally.by_checkers == len(ranks)
    return ranks


def lying(monkeypatch: pytest.MonkeyPatch, change: Callable[[Snapshot], Snapshot]) -> None:
    """The engine reports other counts from now on."""
    examine = engine.CompiledRange.examine

    def lies(examined: engine.CompiledRange, steps: Iterable[int]) -> Iterator[Snapshot]:
        return map(change, examine(examined, steps))

    monkeypatch.setattr(engine.CompiledRange, "examine", lies)


def changed(end: Snapshot, **fields: Any) -> Snapshot:
    """The snapshot with other fields of its tally."""
    return end._replace(tally=msgspec.structs.replace(end.tally, **fields))


def costing(end: Snapshot, **fields: int) -> Snapshot:
    """The snapshot with other costs of `basic`."""
    costs = msgspec.structs.replace(end.tally.costs["basic"], **fields)
    return changed(end, costs={**end.tally.costs, "basic": costs})


BASIC = campaign("basic", 5)
WHOLE = Shard(5, 0, 8162)


def worst() -> set[int]:
    """The ranks of the most expensive worlds."""
    rows = made(BASIC, WHOLE).rows
    most = max(row.cost for row in rows)
    return {row.place for row in rows if row.cost == most}


@pytest.mark.long
def test_the_first_worlds_and_about_one_in_a_thousand_are_judged_by_the_checkers_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    drawn = judged_again(BASIC, monkeypatch) - worst()
    assert 2 <= len(drawn) <= 25
    assert drawn == judged_again(BASIC, monkeypatch) - worst()
    assert drawn != judged_again(msgspec.structs.replace(BASIC, seed=1), monkeypatch) - worst()
    assert 0 in drawn


def test_of_a_class_only_worlds_of_the_class_are_judged_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    planar = {
        rank for rank, _ in ranked_tables(5, WorldClass.parse("planar"), 0, rank_order.count(5))
    }
    drawn = judged_again(campaign("basic", 5, kind="planar"), monkeypatch)
    assert len(drawn) > 2
    assert drawn < planar


def test_the_worst_worlds_are_judged_by_the_checkers_too(monkeypatch: pytest.MonkeyPatch) -> None:
    assert worst()
    assert worst() <= judged_again(BASIC, monkeypatch)
    seconds = made(BASIC, WHOLE).seconds
    assert seconds.checkers > 0 < seconds.engine


def cheaper(end: Snapshot) -> Snapshot:
    return changed(end, shares={**end.tally.shares, "no-false-confirm": (0, 0)})


def never_confirms(end: Snapshot) -> Snapshot:
    statuses = {"no-false-confirm": {"not-declared": end.tally.worlds}}
    return changed(end, statuses={**end.tally.statuses, **statuses})


def convicts(end: Snapshot) -> Snapshot:
    (named,) = end.named
    named = named._replace(first={"map-entailed": 0}, failing=(0,))
    claims = {**end.tally.claims, "map-entailed": 1}
    return changed(end._replace(named=(named,)), claims=claims, failing=1)


@pytest.mark.parametrize("change", [cheaper, never_confirms, convicts])
def test_an_engine_that_judges_otherwise_is_our_bug(
    change: Callable[[Snapshot], Snapshot], monkeypatch: pytest.MonkeyPatch
) -> None:
    lying(monkeypatch, change)
    words = (
        r"^m5/\d+, basic: the engines disagree: "
        r"(\w+ of no-false-confirm: |costs of basic: |failing: )"
    )
    with pytest.raises(InternalError, match=words):
        made(BASIC, WHOLE)


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

    monkeypatch.setattr(shards, "explore", lies)
    with pytest.raises(InternalError, match=rf"^m5/\d+, basic: the engines disagree: {words}"):
        made(BASIC, WHOLE)


def test_what_the_engine_leaves_open_the_checkers_decide(monkeypatch: pytest.MonkeyPatch) -> None:
    asked, shard = campaign("basic", 3), Shard(3, 10, 30)
    by_checkers = examine_by_checkers(asked, targets("basic"), shard).tally

    def undecided(end: Snapshot) -> Snapshot:
        return changed(end, undecided=end.tally.worlds)

    lying(monkeypatch, undecided)
    tally = made(asked, shard).tally
    assert plain(tally) == plain(by_checkers)
    assert tally.by_checkers == 20


def test_ctrl_c_keeps_the_slices_that_are_done(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shards, "SLICE", 100)

    def beat(worlds: int, *_at_work: object) -> None:
        if worlds == 300:
            raise KeyboardInterrupt

    with pytest.raises(Interrupted) as cut:
        examine_compiled(BASIC, targets("basic"), Shard(5, 0, 8162), beat)
    assert cut.value.result.tally.worlds == 300


# ---------------------------------------------------------------- faults in the tally itself


def uncompiled(monkeypatch: pytest.MonkeyPatch, fault: Callable[..., int]) -> None:
    """The tally's kernels run as Python from now on, with a fault where a run is counted.

    Args:
        fault: called with what `enter` is about to count, and how many worlds its walk has begun;
            it may change what it is given, and returns the mask of the claims that fail.
    """

    def plain_function(function: Any, _layout: object) -> Any:
        return plain_kernel(function)

    def enters(case: Any, control: Any, t: Any, wrong: int) -> None:
        enter(case, control, t, fault(case, control, wrong, tally.CountWords(t).worlds + 1))

    enter = tally.enter
    monkeypatch.setattr(tally, "enter", enters)
    monkeypatch.setattr(engine, "compiled", plain_function)


def counts_too_much(case: Any, _control: Any, _wrong: int, worlds: int) -> int:
    """Right in the first world of every walk, like a range of one world."""
    if worlds > 1:
        case.cost += 100_000
        for k in range(len(CLAIMS)):
            case.status[k] = 0
    return 0


def counts_too_little(case: Any, _control: Any, wrong: int, worlds: int) -> int:
    case.cost -= worlds > 1
    return wrong


def forgets_a_verdict(case: Any, _control: Any, wrong: int, worlds: int) -> int:
    if worlds > 1:
        case.status[list(CLAIMS).index("no-false-confirm")] = STATUSES.index("not-declared")
    return wrong


def forgets_a_share(case: Any, _control: Any, wrong: int, worlds: int) -> int:
    case.of[list(CLAIMS).index("rejection-justified")] += worlds > 1
    return wrong


def takes_another_door(case: Any, _control: Any, wrong: int, worlds: int) -> int:
    case.doors_hash += worlds > 1
    return wrong


def fails_a_claim(_case: Any, _control: Any, wrong: int, worlds: int) -> int:
    return wrong | 1 if worlds > 1 else wrong


def makes_no_mistake(_case: Any, _control: Any, wrong: int, _worlds: int) -> int:
    return wrong


def makes_no_pause(_case: Any, control: Any, wrong: int, _worlds: int) -> int:
    control.pause = 0
    return wrong


SMALL = campaign("basic", 3, keep_going=True)


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        (counts_too_much, r"costs of basic: .* by the reference, .* in the tally"),
        (counts_too_little, "costs of basic: "),
        (forgets_a_verdict, "statuses of no-false-confirm: "),
        (forgets_a_share, "shares of rejection-justified: "),
        (takes_another_door, "digest: "),
        (fails_a_claim, r"failing: \d+ by the reference, \d+ in the tally"),
        (makes_no_pause, "the engine made no pause"),
    ],
)
@pytest.mark.filterwarnings("ignore:overflow")
def test_a_fault_in_the_tally_is_our_bug_and_names_a_world(
    fault: Callable[..., int], words: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shards, "SAMPLE", 1)
    uncompiled(monkeypatch, fault)
    with pytest.raises(InternalError, match=rf"^m3/\d+.*: the engines disagree: ({words})"):
        made(SMALL, Shard(3, 20, 32))


@pytest.mark.filterwarnings("ignore:overflow")
def test_without_a_fault_the_same_kernels_as_python_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shards, "SAMPLE", 1)
    uncompiled(monkeypatch, makes_no_mistake)
    assert made(SMALL, Shard(3, 20, 32)).tally.worlds == 12


def test_a_world_that_is_named_with_another_cost_is_our_bug(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def late(end: Snapshot) -> Snapshot:  # behind the steps that are compared
        return end if end.tally.worlds < 74 else costing(end, most=99)

    monkeypatch.setattr(shards, "SAMPLE", 10**6)
    lying(monkeypatch, late)
    words = r"^m3/9, basic: the engines disagree: cost 10 by the reference, 99 in the tally"
    with pytest.raises(InternalError, match=words):
        made(SMALL, Shard(3, 0, 74))


def test_a_world_that_is_named_as_costlier_with_other_costs_is_our_bug(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def late(end: Snapshot) -> Snapshot:
        if end.tally.worlds < 706:
            return end
        named, other = end.named
        first, *further = named.dearer
        dearer = (first._replace(other=first.other - 1), *further)
        return end._replace(named=(named._replace(dearer=dearer), other))

    monkeypatch.setattr(shards, "SAMPLE", 10**6)
    lying(monkeypatch, late)
    pair = campaign("basic,enhancement-i", 4)
    words = r"^m4/\d+, enhancement-i: the engines disagree: cost \d+ by the reference, \d+ in the"
    with pytest.raises(InternalError, match=words):
        made(pair, Shard(4, 0, 706))


# ---------------------------------------------------------------- what is refused


@pytest.mark.parametrize(
    ("target", "options", "words"),
    [
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


def test_a_store_never_mixes_engines(folder: Path) -> None:
    def known(engine: str) -> SearchEntry:
        mappers = targets("basic")
        asked = search_campaign(mappers, edges=3, engine=engine)
        with Store(folder / "store") as store:
            memory = store.resumed(asked, mappers)
            study = Search(asked, mappers, here(mappers), memory)
            study.work()
            return study.entry()

    assert known("compiled").from_ledger == 0
    assert known("compiled").from_ledger == 86
    with pytest.raises(InputError, match="holds another campaign: its engine is compiled, now it"):
        known("reference")


# ---------------------------------------------------------------- verify


@pytest.mark.long
def test_verify_goes_one_size_further_and_compares_the_engines(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ours = targets("basic,folding")

    def part(further: Callable[[], EngineCounts] | None = None) -> Part:
        job = SmallWorlds(3, ours, Limits(), further=further)
        job.work(lambda _what, _done, _total: None)
        return job.part()

    assert (part().verdict, part().checked) == ("EXHAUSTED", 86)
    further = part(partial(engine_counts, "compiled", 4, ours))
    assert (further.verdict, further.checked) == ("EXHAUSTED", 792)
    assert "; those of 4 edges by the compiled engine, and " in further.summary

    def late(end: Snapshot) -> Snapshot:  # behind the worlds that a search compares
        if end.tally.worlds != 74:
            return end
        return costing(end, total=end.tally.costs["basic"].total + 1)

    monkeypatch.setattr(shards, "SAMPLE", 10**6)
    lying(monkeypatch, late)
    with pytest.raises(InternalError, match="3 edges the engines disagree on costs"):
        part(partial(engine_counts, "compiled", 4, ours))


def test_the_engine_knows_every_algorithm_of_the_catalogue() -> None:
    assert engine.examine_range(list(CATALOGUE), 2).tally.costs.keys() == set(CATALOGUE)
