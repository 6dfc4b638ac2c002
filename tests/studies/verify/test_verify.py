"""The campaign `verify` as a library: parts, verdicts, and what stops a part."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from typing import Any
from unittest.mock import Mock

import pytest

from topo_verify import CATALOGUE, Percept, Robot, World, examine, extras
from topo_verify.campaign.campaign import MAX_TIMEOUTS
from topo_verify.campaign.targets import targets
from topo_verify.programs.loader import Target
from topo_verify.proofs.catalogue import QUICK, choose
from topo_verify.robot.limits import Limits
from topo_verify.studies.verify import verify as campaign
from topo_verify.studies.verify.parts import Part, Proofs, WorldCounts
from topo_verify.studies.verify.trials import Trials, with_ids
from topo_verify.studies.verify.verify import verify
from topo_verify.world.enumeration import rank_order

pytestmark = pytest.mark.usefixtures("proved_once")

Mapper = Callable[[Robot], object]


def silence(_part: str, _done: int, _total: int) -> None:
    pass


def basic(robot: Robot) -> Any:
    return CATALOGUE["basic"](robot)


def trials(mapper: Mapper, edges: int = 2, **options: Any) -> Trials:
    """One mapper in every world of 1 … edges edges."""
    sizes = range(1, edges + 1)
    worlds = [one for m in sizes for one in with_ids(map(World.from_code, rank_order.tables(m)))]
    total = sum(map(rank_order.count, sizes))
    return Trials(
        "part", "", total, worlds, [Target("mine", mapper)], Limits(), finite=True, **options
    )


def done(mapper: Mapper, **options: Any) -> Part:
    job = trials(mapper, **options)
    job.work(silence)
    return job.part()


@pytest.mark.nightly
def test_the_whole_campaign_exhausts_what_it_says(monkeypatch: pytest.MonkeyPatch) -> None:
    # All theorems are proved in test_proofs.py; here, how many there are, and those that are quick.
    assert len(choose(kinds=QUICK)) == 65

    monkeypatch.setattr(campaign, "ProofsBeside", Mock(return_value=Proofs(quick=True)))
    monkeypatch.setattr(campaign, "TASKS", ("engine", "drawing"))
    parts = list(verify(targets("enhancement-ii"), seed=1))
    small = 119364 if extras.usable_engines() else 8954  # one size more with the compiled engine
    assert [(part.part, part.verdict, part.checked, part.total) for part in parts] == [
        ("counts", "EXHAUSTED", 119364, 119364),
        ("small-worlds", "EXHAUSTED", small, small),
        ("proofs", "PROVED", 63, 63),
        ("sampled-worlds", "SAMPLED", 200, 200),
        ("generated-worlds", "SAMPLED", 160, 160),
        ("street-network", "SAMPLED", 1, 1),
    ]
    assert all(part.ok and not part.failing for part in parts)
    assert all(
        {status for status, runs in seen.items() if runs} == {"ok"} and seen["ok"] == small
        for seen in parts[1].claims.values()
    )


def test_the_seed_decides_which_worlds_are_sampled() -> None:
    def drawn(seed: int) -> list[str]:
        return [world.id for world in campaign.sampled_worlds(20, seed)]

    assert drawn(0) == drawn(0) != drawn(1)
    sizes = [len(world.edges) for world in campaign.sampled_worlds(60, 0)]
    assert sizes == sorted(sizes)
    assert 6 <= sizes[0] < sizes[-1] <= 30


@pytest.mark.long
def test_progress_is_told_part_by_part() -> None:
    told: list[tuple[str, int, int]] = []

    def tell(part: str, done: int, total: int) -> None:
        told.append((part, done, total))

    list(verify(targets("basic"), quick=True, tell=tell))
    assert [*dict.fromkeys(part for part, _, _ in told)] == [
        "counts", "small-worlds", "proofs", "sampled-worlds", "generated-worlds", "street-network",
    ]  # fmt: skip
    assert all(done <= total for _, done, total in told)


# ---------------------------------------------------------------- counts


@pytest.mark.parametrize("spoil", ["a world is missing", "a world is listed twice"])
def test_counts_notices_when_the_list_is_wrong(monkeypatch: pytest.MonkeyPatch, spoil: str) -> None:
    right = rank_order.tables

    def wrong(edges: int) -> list[rank_order.Table]:
        rows = list(right(edges))
        return rows[1:] if spoil == "a world is missing" else [rows[0], *rows[:-1]]

    monkeypatch.setattr(rank_order, "tables", wrong)
    job = WorldCounts(3)
    job.work(silence)
    part = job.part()
    assert (part.verdict, part.ok) == ("REFUTED", False)
    assert part.findings[0].message == (
        "with 1 edge 1 worlds are listed, the sum of completions says 2"
    )
    assert part.findings[0].replay == "topo-verify world count --edges 1"


def test_counts_cut_off_is_unknown() -> None:
    part = WorldCounts(3).part(interrupted=True)
    assert (part.verdict, part.ok, part.checked, part.total) == ("UNKNOWN", False, 0, 86)


# ---------------------------------------------------------------- trials


def test_a_part_is_exhausted_only_if_it_saw_as_many_worlds_as_there_are() -> None:
    job = trials(basic)
    job.total += 1  # one world is missing from the list
    job.work(silence)
    part = job.part()
    assert (part.verdict, part.ok, part.checked, part.total) == ("UNKNOWN", False, 12, 13)


def test_a_part_counts_all_failing_worlds_but_keeps_few_findings() -> None:
    part = done(lambda _robot: None)
    assert (part.verdict, part.failing, part.checked) == ("REFUTED", 12, 12)
    assert [finding.world for finding in part.findings] == ["m1/0", "m1/1", "m2/0"]
    assert part.summary == "12 of 12 worlds: 12 of them refute map-isomorphic, first m1/0"


def test_each_claim_that_a_part_names_fails_in_the_world_named() -> None:
    def guesses(robot: Robot) -> object:
        """That two doors at the start are a loop: true by luck in the loop."""
        loop = {"vertices": [[0, 1]], "edges": [[0, 1]], "marker": 0}
        return loop if robot.percept.degree == 2 else basic(robot)

    part = done(guesses)
    named = dict(re.findall(r"([a-z-]+) \(first (m\d/\d+)\)", part.summary))
    assert list(named) == ["map-isomorphic", "cost-within-bound", "map-entailed"]
    assert named["map-entailed"] != named["map-isomorphic"]
    for claim, world in named.items():
        report = examine(guesses, World.from_id(world))
        assert report.claims[claim] == "failed"


def test_a_part_stops_after_a_few_failing_worlds_where_that_is_asked_for() -> None:
    part = done(lambda _robot: None, max_failing=2)
    assert (part.checked, part.total, part.failing) == (2, 12, 2)
    assert part.summary.endswith("stopped after 2 failing worlds")


def test_a_part_stops_after_a_few_time_outs() -> None:
    def sleeps(_robot: Robot) -> None:
        time.sleep(5)

    job = trials(sleeps)
    job.limits = Limits(move_timeout=0.05)
    job.work(silence)
    part = job.part()
    assert (part.verdict, part.checked) == ("REFUTED", MAX_TIMEOUTS)
    assert part.summary.endswith("stopped after 3 time-outs")


def test_a_claim_that_is_declared_now_and_then_is_told_as_such() -> None:
    class Sometimes:
        def __init__(self, robot: Robot) -> None:
            self.robot, self.percept = robot, robot.percept
            self.talks = robot.percept.degree > 2

        def move(self, door: int, purpose: Any = None) -> Percept:
            self.percept = self.robot.move(door, purpose)
            return self.percept

        def declare(self, event: Any) -> None:
            if self.talks:
                self.robot.declare(event)

    part = done(lambda robot: basic(Sometimes(robot)))
    assert part.ok
    assert part.summary.endswith("5 of 10 claims hold, 5 partial")


def test_the_summary_names_which_of_several_mappers_fails() -> None:
    job = trials(basic)
    job.targets = [*targets("basic"), Target("mine.py:f", lambda _robot: None)]
    job.work(silence)
    assert job.part().summary == (
        "12 of 12 worlds × 2 mappers: 12 of them refute map-isomorphic, first m1/0 (mine.py:f)"
    )


def test_the_costs_of_a_mapper_that_fails_have_no_ratio() -> None:
    *_, street = verify([Target("mine", lambda _robot: None)], quick=True)
    assert (street.costs[0].algorithm, street.costs[0].ratio) == ("mine", None)
    assert [cost.algorithm for cost in street.costs[1:]] == list(CATALOGUE)
    assert [cost.reference for cost in street.costs] == [False] + [True] * len(CATALOGUE)
    assert street.costs[1].ratio == 1


# ---------------------------------------------------------------- Ctrl-C


def test_an_interrupted_part_is_yielded_as_far_as_it_came() -> None:
    runs: list[int] = []

    def interrupts(robot: Robot) -> object:
        runs.append(1)
        if len(runs) > 20:
            raise KeyboardInterrupt
        return basic(robot)

    parts = verify([Target("mine", interrupts)], quick=True)
    part = next(parts)
    assert (part.verdict, part.ok, part.checked, part.total) == ("UNKNOWN", False, 20, 86)
    assert part.summary.endswith("; interrupted")
    with pytest.raises(KeyboardInterrupt):
        next(parts)
