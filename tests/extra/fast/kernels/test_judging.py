"""The judge of the compiled engine says of every run what the checkers say, claim by claim.

Its kernels run here as plain Python, except where the machine code is asked by name.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import chain
from random import Random

import pytest

pytest.importorskip("numba", reason="the compiled engine needs numba")

from tests.extra.fast.kernels.judged import (
    Judged,
    Run,
    by_checkers,
    by_judge,
    counted,
    doctored,
    plant,
    run_of,
    sampled,
)
from tests.marks import with_marks
from topo_verify import CATALOGUE, World, worlds
from topo_verify.checkers import CLAIMS
from topo_verify.extra.fast.kernels.events import (
    BY_FOLDING,
    BY_PLANAR,
    REJECT,
    TWO_OF_S,
    UNLIKE,
    spans,
)
from topo_verify.extra.fast.kernels.faults import PLANTED
from topo_verify.extra.fast.kernels.judging import fold, verdict
from topo_verify.extra.fast.kernels.judging.layout import CaseWords
from topo_verify.extra.fast.kernels.workspace import TRACE, RunWords
from topo_verify.extra.fast.snapshots import examine_range
from topo_verify.faults import FAULTS
from topo_verify.world.enumeration import rank_order

MAPPERS = (*CATALOGUE, *PLANTED)

OPEN = {"folding+planar", "takes-each-place-for-known", "identifies-without-turning"}
"""Some verdicts on their runs are open: only the checkers look for a planar witness, and have room
for all that these two faults reject."""

Difference = tuple[str, Judged, Judged | None]


def runs(world: World, name: str, ways: int) -> Iterator[Run]:
    """The run of a mapper, right or with a mistake, and so many doctored ones."""
    run = run_of(world, FAULTS.get(name, name), name)
    return chain((run,), doctored(run, ways))


def differences(world: World, name: str, ways: int) -> Iterator[Difference]:
    """The runs in this world of which the judge says something else, or nothing."""
    for run in runs(world, name, ways):
        expected, found = by_checkers(run), by_judge(run)
        if found != expected and not (found is None and run.is_map_doctored):
            yield run.what, expected, found


@pytest.mark.long
@pytest.mark.parametrize("name", with_marks(MAPPERS, nightly=["takes-each-place-for-known"]))
def test_every_run_to_3_edges_has_the_verdict_of_the_checkers(name: str) -> None:
    small = (world for edges in range(1, 4) for world in worlds(edges=edges))
    assert [found for world in small for found in differences(world, name, 1)] == []


@pytest.mark.long
@pytest.mark.parametrize("name", with_marks(MAPPERS, nightly=["takes-each-place-for-known"]))
def test_sampled_runs_with_4_edges_have_the_verdict_of_the_checkers(name: str) -> None:
    some = sampled(4, 20)
    assert [found for world in some for found in differences(world, name, 2)] == []


def citing(place: str) -> Iterator[Run]:
    """A run of `folding` in which one rejection cites a contradiction, each of them in turn."""
    run = run_of(World.from_id(place), "folding", "folding")
    parts = [list(run.events[at:end]) for at, end in spans(run.events)]
    for part in [part for part in parts if part[0] == REJECT and part[4] == BY_FOLDING]:
        kept = part[11]
        for part[11] in range(UNLIKE, TWO_OF_S + 1):
            yield replace(run, events=tuple(word for told in parts for word in told))
        part[11] = kept


@pytest.mark.parametrize("place", ["m3/38", "m4/188", "m6/57535", "m8/6719310"])
def test_each_contradiction_that_the_checkers_let_a_rejection_cite_the_judge_does(
    place: str,
) -> None:
    """In most of these some are met only where all is drawn, behind other contradictions."""
    judged = [(by_checkers(run), by_judge(run)) for run in citing(place)]
    assert all(expected == judgements for expected, judgements in judged)
    assert sum(expected[7][0] == "ok" for expected, _ in judged) >= 2


@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.parametrize("room", [TRACE, 50], ids=["fits", "does-not-fit"])
def test_machine_code_gives_each_run_the_verdict_of_the_checkers(name: str, room: int) -> None:
    for world in chain(worlds(edges=2), sampled(3, 20), sampled(4, 10)):
        edges, rank = (int(part) for part in str(world.name)[1:].split("/"))
        end = examine_range([name], edges, start=rank, stop=rank + 1, room=room)
        assert counted(end.tally) == by_checkers(run_of(world, name, name)), world.name


# ---------------------------------------------------------------- the whole comparison


@pytest.mark.nightly
@pytest.mark.parametrize("name", MAPPERS)
def test_every_run_with_4_edges_has_the_verdict_of_the_checkers(name: str) -> None:
    found = [one for world in worlds(edges=4) for one in differences(world, name, 1)]
    if name in OPEN:
        found = [one for one in found if one[2] is not None]
    assert found == []


@pytest.mark.nightly
@pytest.mark.parametrize("name", MAPPERS)
@pytest.mark.parametrize("edges", range(5, 9), ids=lambda edges: f"edges-{edges}")
def test_runs_in_60_worlds_of_a_size_have_the_verdict_of_the_checkers(
    edges: int, name: str
) -> None:
    opened = 0
    for world in sampled(edges, 60):
        for what, expected, found in differences(world, name, 1):
            assert found is None, (what, expected)
            opened += 1
    assert opened == 0 or name == "folding+planar"


@pytest.mark.nightly
@pytest.mark.parametrize("name", MAPPERS)
def test_machine_code_gives_every_run_to_4_edges_the_verdict_of_the_checkers(name: str) -> None:
    faults = {name: name} if name in FAULTS else None
    for edges in range(1, 5):
        for rank, world in enumerate(worlds(edges=edges)):
            end = examine_range([name], edges, start=rank, stop=rank + 1, faults=faults)
            run = run_of(world, FAULTS.get(name, name), name)
            assert counted(end.tally) == by_checkers(run), (
                f"m{edges}/{rank} of {rank_order.count(edges)}"
            )


# ---------------------------------------------------------------- mistakes in the judge

MISTAKES = [
    (
        1,
        "truth.follow_move",
        "if move.percept != percept:",
        "if move.percept >> 16 != percept >> 16:",
    ),
    (1, "truth.follow_move", "case.followed += 1", "case.followed += 2"),
    (2, "truth.pose", "if wrong or not has_truth:", "if wrong:"),
    (2, "truth.pose", "edge < 0 or case.crossed[edge] == 0", "edge < 0"),
    (3, "truth.decide", "opened and truth >= 0 and truth == h", "opened and 0 < truth < h"),
    (3, "truth.augment", "if is_new and truth >= 0:", "if False:"),
    (3, "truth.settle_hypothesis", "&= ~(1 <<", "&= ~(2 <<"),
    (4, "truth.decide", "if truth < 0 or truth != h:", "if truth >= 0 and truth != h:"),
    (4, "verdict.share_out", "max(confirmations, loops)", "confirmations"),
    (5, "verdict.is_same_map", "elif case.image[other] != image:", "elif case.image[other] < 0:"),
    (5, "verdict.judge_delivery", "if case.spoiled != 0 or not delivered:", "if not delivered:"),
    (6, "verdict.judge_delivery", "case.reported not in (ABSENT, cost)", "case.reported > cost"),
    (7, "verdict.judge_delivery", "cost < case.darts // 2", "cost < case.darts // 4"),
    (7, "verdict.judge_delivery", "cost > case.bound", "cost >= case.bound + 4"),
    (8, "justified.percepts_agree", "or rejection.expected != expected", ""),
    (
        8,
        "justified.unjustified",
        "case.posed_by[h] != case.poses",
        "case.posed_by[h] == case.poses",
    ),
    (8, "justified.cites_in_vain", "== 0:", "< 0:"),
    (9, "verdict.proves_map", "if not is_chart(chart, darts, vertices):", "if False:"),
    (9, "verdict.is_same_map", "elif case.image[other] != image:", "elif False:"),
    (9, "fold.make_one", "fold.offset[a] = offset", "fold.offset[a] = 0"),
    (9, "fold.fold_move", "find_node(fold, 0) != node or", "False and"),
    (10, "entailed.conclude_event", "not may_be_apart(case, e, other)", "True"),
    (10, "entailed.may_be_known", "if fold.degree[node] != degree:", "if degree < 0:"),
    (10, "entailed.may_lead_to", "return wrong == 0", "return True"),
]
"""Of the judge: the claim that a mistake is in, the kernel, what stands there, the mistake."""


checked = cache(by_checkers)


@cache
def some_runs() -> tuple[Run, ...]:
    """Runs right, wrong and doctored, shuffled: a mistake shows among the first of them."""
    small = chain(worlds(edges=1), worlds(edges=2), sampled(3, 20), sampled(4, 4))
    every = [run for world in small for name in MAPPERS for run in runs(world, name, 3)]
    Random("judged").shuffle(every)
    return tuple(every)


def judged_runs() -> Iterator[tuple[Run, Judged]]:
    """These runs with the verdict of the checkers."""
    return ((run, checked(run)) for run in some_runs())


@pytest.mark.nightly
def test_every_claim_has_a_mistake_and_the_judge_as_it_is_has_none() -> None:
    assert {claim for claim, *_ in MISTAKES} == set(range(1, len(CLAIMS) + 1))
    verdicts = [(run.is_map_doctored, by_judge(run), expected) for run, expected in judged_runs()]
    assert all(
        found == expected or (doctored and not found) for doctored, found, expected in verdicts
    )


def by_parts(run: Run, most: int = 5) -> Judged | None:
    """What the judge says of a run of which it is given a few events at a time."""
    events = [run.events[at:end] for at, end in spans(run.events)]
    rules = [event[4] for event in events if event[0] == REJECT]
    asked = 2 if BY_PLANAR in rules else int(BY_FOLDING in rules)

    def judge(space: RunWords, case: CaseWords) -> int:
        left = events
        part, answer = verdict.FIRST_PART, 0
        while part & verdict.LAST_PART == 0 and answer >= 0:
            words = [*chain.from_iterable(left[:most])]
            for place, word in enumerate(words):
                space.trace.word[place] = word
            space.trace.size = len(words)
            left = left[most:]
            answer = verdict.judge_part(space, case, part + (not left) * verdict.LAST_PART, asked)
            part = 0 if left else verdict.LAST_PART
        return answer

    return by_judge(run, judge=judge)


def differ_by_parts() -> Iterator[Run]:
    """The runs of which the judge says otherwise part by part, with nodes dropped at once."""
    for run, expected in judged_runs():
        judgements = by_parts(run)
        if judgements != expected and (judgements is not None or not run.is_map_doctored):
            yield run


@pytest.mark.long
def test_every_run_has_the_same_verdict_part_by_part(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fold, "LEAST_TIDIED", 0)
    assert not [*differ_by_parts()]


@pytest.mark.parametrize(
    ("place", "right", "wrong"),
    [
        ("tidy_up", "fold.number[end] if end >= 0 else -1", "fold.number[end]"),
        *(
            (place, right, "pass")
            for place, right in (
                ("settle_places", "fold.end_node[slot] = find_node(fold, end)"),
                ("settle_places", "fold.dart = find_dart(fold, fold.at, fold.dart)"),
                ("tidy_up", "fold.degree[nodes] = degree"),
                ("tidy_up", "fold.base[nodes] = doors"),
                ("tidy_up", "fold.marked[nodes] = fold.marked[node]"),
                ("tidy_up", "fold.end_dart[doors] = fold.end_dart[slot]"),
                ("tidy_up", "fold.at = fold.number[fold.at]"),
                ("tidy_up", "drawn.node[d] = fold.number[drawn.node[d]]"),
            )
        ),
    ],
)
def test_a_mistake_where_nodes_are_dropped_is_seen(
    monkeypatch: pytest.MonkeyPatch, place: str, right: str, wrong: str
) -> None:
    monkeypatch.setattr(fold, "LEAST_TIDIED", 0)
    plant(monkeypatch, f"fold.{place}", right, wrong)
    assert any(differ_by_parts())


@pytest.mark.parametrize(("claim", "place", "right", "wrong"), MISTAKES)
def test_a_mistake_in_the_judge_is_seen_in_its_claim(
    monkeypatch: pytest.MonkeyPatch, claim: int, place: str, right: str, wrong: str
) -> None:
    plant(monkeypatch, place, right, wrong)
    verdicts = ((by_judge(run), expected) for run, expected in judged_runs())
    assert any(found and found[claim - 1] != expected[claim - 1] for found, expected in verdicts)
