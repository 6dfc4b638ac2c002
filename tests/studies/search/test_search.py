"""The search: what is exhausted, what is the smallest counterexample, and what is counted."""

from __future__ import annotations

from typing import Any

import pytest

from tests.campaign import mappers
from tests.small_rows import SmallRows, costs
from tests.studies.search.searching import searched
from topo_verify import CATALOGUE, InputError, InternalError, Limits, Robot
from topo_verify.campaign import campaign as campaigns
from topo_verify.campaign.backend import SHORT_OF_MEMORY
from topo_verify.campaign.campaign import Ranks, Stop
from topo_verify.campaign.tally import KEPT_FAILING, KEPT_WORST, Tally
from topo_verify.studies.search import choices
from topo_verify.studies.search.search import SearchInterrupted, search
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.classes import WorldClass


def basic(robot: Robot) -> Any:
    return CATALOGUE["basic"](robot)


def of_class(text: str) -> WorldClass:
    return WorldClass.parse(text)


# ---------------------------------------------------------------- exhausted


@pytest.mark.long
@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("planar", [2, 9, 54, 378]),
        ("genus:1", [0, 1, 20, 307]),
        ("simple", [1, 2, 6, 23]),
        ("loopless", [1, 3, 14, 87]),
        ("simple,planar", [1, 2, 6, 23]),
        ("max-degree:2", [2, 3, 4, 5]),
    ],
)
def test_a_class_is_exhausted_when_its_number_is_met(text: str, numbers: list[int]) -> None:
    found = search(basic, edges=4, cls=of_class(text))
    assert found.verdict == "EXHAUSTED"
    assert [size.checked for size in found.by_edges] == numbers


@pytest.mark.nightly
def test_the_planar_prior_is_right_in_planar_worlds_and_wrong_in_all_others() -> None:
    planar = search("folding+planar", edges=4, cls=of_class("planar"))
    assert planar.verdict == "EXHAUSTED"
    torus = search("folding+planar", edges=4, cls=of_class("genus:1"), keep_going=True)
    assert [(size.failing, size.total) for size in torus.by_edges] == [
        (0, 0), (1, 1), (20, 20), (307, 307),
    ]  # fmt: skip


@pytest.mark.parametrize("lie", [-1, 1])
def test_a_search_that_does_not_meet_its_number_is_our_bug(
    lie: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    def wrong(kind: WorldClass, edges: int) -> int:
        return kind.count(edges) + lie

    monkeypatch.setattr(campaigns, "_total", wrong)
    with pytest.raises(InternalError, match="2 worlds of class any where m = 1, and there are"):
        search(basic, edges=2)


# ---------------------------------------------------------------- counterexamples


def test_the_search_stops_at_the_smallest_counterexample() -> None:
    found = search(mappers.guesses, edges=4)
    assert (found.verdict, found.checked, found.total) == ("REFUTED", 2, 792)
    first = found.counterexample
    assert first is not None
    assert (first.world, first.edges, first.claim) == ("m1/1", 1, "map-isomorphic")
    assert first.message.startswith("the map (2 vertices, 1 edge) is not isomorphic")
    assert first.replay.startswith("topo-verify replay m1/1 --target ")


def test_what_lies_behind_the_counterexample_is_not_counted() -> None:
    found = search(mappers.forgets, edges=4)
    assert [(size.checked, size.total, size.failing) for size in found.by_edges] == [
        (2, 2, 0), (10, 10, 0), (1, 74, 1), (0, 706, 0),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("edges", "kind", "words"),
    [
        (300, "any", "expected an integer from 1 to 200"),
        (150, "any", "no search of them ends: expected at most 15 edges"),
        (40, "planar", "no search of them ends: expected at most 19 edges"),
    ],
)
def test_a_search_that_cannot_end_is_refused(edges: int, kind: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        search(basic, edges=edges, cls=kind)


@pytest.mark.long
def test_keeping_going_tells_of_each_claim_how_often_it_fails_and_where_first() -> None:
    found = search(mappers.guesses, edges=3, keep_going=True)
    assert (found.verdict, found.checked) == ("REFUTED", 86)
    assert [size.failing for size in found.by_edges] == [1, 10, 74]
    assert {one.claim: one.failing for one in found.claims}["map-isomorphic"] == 85
    assert found.counterexample is not None
    smallest = {one.claim: one.smallest.world for one in found.claims}
    assert smallest == {
        "map-isomorphic": found.counterexample.world,
        "map-entailed": found.counterexample.world,
        "cost-within-bound": "m2/0",
    }
    study = searched(mappers.guesses, edges=3, keep_going=True)
    kept = [row for row in study.rows if row.failed and row.edges == 3]
    assert [row.place for row in kept[:KEPT_FAILING]] == [0, 1, 2]


def test_a_mapper_that_loops_without_moving_is_a_finding() -> None:
    found = search(mappers.loops, edges=3, limits=Limits(move_timeout=0.1))
    assert found.counterexample is not None
    assert found.counterexample.world == "m3/21"
    assert "did not move for 0.1 s" in found.counterexample.message
    assert found.counterexample.replay.endswith("--move-timeout 0.1")


def test_a_mapper_that_is_out_of_time_is_neither_right_nor_wrong() -> None:
    found = search(mappers.strolls, edges=2, limits=Limits(world_timeout=0.01))
    assert (found.verdict, found.checked, found.total) == ("UNKNOWN", 0, 12)
    assert [size.undecided for size in found.by_edges] == [2, 10]


@pytest.mark.usefixtures("folder")
def test_a_mapper_that_stands_still_once_leaves_its_world_undecided() -> None:
    found = search(mappers.stalls_once, edges=3, limits=Limits(move_timeout=0.5))
    assert (found.verdict, found.checked, found.total) == ("UNKNOWN", 85, 86)
    (lost,) = found.lost
    assert lost.world == "m3/21"
    assert lost.how.startswith("the mapper did not move for 0.5 s; it was at ")


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(("first", "second"), [("kill", "skip"), ("hang", "skip")])
def test_a_mapper_that_was_ended_and_then_declines_is_undecided(first: str, second: str) -> None:
    """Killed or still in the fifth world of a process, it declines the first one of a fresh one."""
    target = f"misdeeds.py:at_5_{first}_at_1_{second}"
    study = searched(target, edges=2, in_process=False, limits=Limits(move_timeout=0.4))
    assert (study.entry().verdict, study.tally.failing) == ("UNKNOWN", 0)


def test_an_interrupted_search_says_how_far_it_came_and_keeps_the_result() -> None:
    runs = 0

    def interrupted(robot: Robot) -> Any:
        nonlocal runs
        runs += 1
        if runs > 5:
            raise KeyboardInterrupt
        return basic(robot)

    with pytest.raises(SearchInterrupted, match="after 5 of 86 worlds, so far UNKNOWN") as cut:
        search(interrupted, edges=3)
    entry = cut.value.entry
    assert [size.checked for size in entry.by_edges] == [2, 3, 0]
    assert (entry.verdict, entry.checked, entry.total) == ("UNKNOWN", 5, 86)


def test_a_search_that_would_take_for_ever_ends_after_its_time_outs() -> None:
    limits = Limits(world_timeout=0.01)
    study = searched(mappers.strolls, edges=3, limits=limits, stop=Stop(timeouts=4))
    assert study.tally.worlds == 2 + 4


# ---------------------------------------------------------------- costs


@pytest.mark.long
def test_the_highest_costs_are_the_known_ones_and_their_worlds_have_them(
    small_rows: SmallRows,
) -> None:
    found = search("basic", edges=4)
    assert (found.verdict, found.checked, found.total) == ("EXHAUSTED", 792, 792)
    assert found.counterexample is None
    entailed = next(one for one in found.judgements if one.claim == "map-entailed")
    assert (entailed.status, entailed.judged, entailed.of) == ("ok", 792, 792)
    assert [size.max_cost for size in found.by_edges] == [1, 3, 10, 21]
    for size in found.by_edges:
        spent = costs(small_rows["basic"], size.edges)
        assert size.checked == size.total == size.runs == len(spent)
        assert (size.max_cost, size.total_cost) == (max(spent), sum(spent))
        assert size.attained == spent.count(max(spent))
        highest = [row.world for row in small_rows["basic"] if row.cost == max(spent)]
        assert set(size.worst) <= set(highest)
        assert len(size.worst) == min(size.attained, KEPT_WORST)


def test_failing_runs_have_no_part_in_the_costs() -> None:
    found = search(mappers.guesses, edges=1)
    assert found.by_edges[0].runs == 1


@pytest.mark.long
def test_two_mappers_in_the_same_worlds_are_compared() -> None:
    found = searched("enhancement-ii,enhancement-i", edges=4, keep_going=True).entry(compare=True)
    sizes = [size.compare for size in found.by_edges if size.compare is not None]
    assert [compared.dearer for compared in sizes] == [0, 0, 0, 2]
    compared = sizes[3]
    assert [(pair.world, pair.cost - pair.other) for pair in compared.first] == [
        ("m4/16", 2),
        ("m4/97", 2),
    ]
    assert (compared.most, compared.cheaper) == (2, 5)


# ---------------------------------------------------------------- shards


@pytest.mark.parametrize(
    "size",
    [pytest.param(1, marks=pytest.mark.long), 50, pytest.param(10_000, marks=pytest.mark.long)],
)
@pytest.mark.parametrize("text", ["any", "planar"])
def test_the_size_of_the_shards_makes_no_difference(
    size: int, text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for mapper, keep_going in ((mappers.forgets, True), (mappers.forgets, False), (basic, False)):
        usual = search(mapper, edges=3, cls=of_class(text), keep_going=keep_going)
        monkeypatch.setitem(choices.SHARD, "reference", size)
        cut = search(mapper, edges=3, cls=of_class(text), keep_going=keep_going)
        monkeypatch.undo()
        assert cut == usual


def test_shards_cover_each_rank_once() -> None:
    for text in ("any", "planar", "max-degree:2", "simple"):
        shards = list(Ranks(6, text).shards())
        for edges in range(1, 7):
            ranks = [0, *(s.stop for s in shards if s.edges == edges)]
            assert [s.start for s in shards if s.edges == edges] == ranks[:-1]
            assert ranks[-1] == rank_order.count(edges)


def test_tallies_add_up_in_any_grouping() -> None:
    a, b, c = searched(mappers.guesses, edges=3, keep_going=True).tallies.values()
    assert (a + b) + c == a + (b + c)
    assert Tally() + a == a == a + Tally()


# ---------------------------------------------------------------- what cannot be searched


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"edges": 0}, "worlds of 1 edge and more"),
        ({"edges": 2, "policies": "some"}, "no policies 'some'"),
        (
            {"edges": 9, "cls": of_class("simple,genus:1")},
            "no formula counts a genus and a property",
        ),
        ({"edges": 17, "cls": of_class("simple")}, "expected at most 16 edges, got 17"),
        ({"edges": 2, "policies": "all"}, "has no policies"),
        ({"edges": 2, "workers": 2}, "cannot be handed to workers"),
    ],
)
def test_what_cannot_be_searched_is_refused_with_a_sentence(
    arguments: dict[str, Any], words: str
) -> None:
    class Mine:
        def __call__(self, robot: Robot) -> object:
            return basic(robot)

    with pytest.raises(InputError, match=words):
        search(Mine(), **arguments)


def test_every_choice_is_refused_where_there_are_too_many() -> None:
    with pytest.raises(InputError, match=r"research\.every"):
        search("basic", edges=5, policies="every")


# ---------------------------------------------------------------- memory


@pytest.mark.long
@pytest.mark.usefixtures("folder")
def test_a_mapper_that_lacks_memory_in_a_worker_once_is_undecided() -> None:
    found = search("mappers.py:lacks_memory_once", edges=3, keep_going=True, workers=1)
    assert (found.verdict, found.checked, found.counterexample) == ("UNKNOWN", 85, None)
    assert [(one.world, one.how) for one in found.lost] == [("m3/21", SHORT_OF_MEMORY)]


@pytest.mark.usefixtures("folder")
def test_a_wrong_map_counts_though_a_worker_lacked_memory_behind_it() -> None:
    study = searched("mappers.py:errs_then_lacks_memory", edges=3, keep_going=True, workers=1)
    entry = study.entry()
    assert (entry.verdict, [size.failing for size in entry.by_edges]) == ("REFUTED", [0, 0, 1])
    assert [one.how for one in entry.lost] == [SHORT_OF_MEMORY]


@pytest.mark.long
@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize("workers", [0, 1])
def test_a_mapper_that_lacks_memory_each_time_is_refuted(workers: int) -> None:
    found = search("mappers.py:lacks_memory", edges=3, workers=workers)
    assert found.verdict == "REFUTED"
    assert found.counterexample is not None
    assert found.counterexample.world == "m3/21"
    assert "the mapper raised MemoryError" in found.counterexample.message
    assert found.lost == ()
