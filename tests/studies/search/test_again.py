"""Worlds run again in fresh processes: a mapper that remembers other worlds is noticed."""

from __future__ import annotations

import shlex
from pathlib import Path

import msgspec
import pytest

from tests.helpers import some, worlds
from tests.programs.programs import served
from topo_verify.campaign.backend import here
from topo_verify.campaign.campaign import Ranks
from topo_verify.campaign.drawn_row import drawn_row
from topo_verify.campaign.targets import targets
from topo_verify.cli import main
from topo_verify.programs.foreign import Foreign
from topo_verify.robot.limits import Limits
from topo_verify.studies.search import again
from topo_verify.studies.search.search import (
    Search,
    SearchEntry,
    SearchInterrupted,
    search,
    search_campaign,
)


@pytest.fixture(autouse=True)
def as_many_as_usual(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(again, "MOST", 50)
    monkeypatch.setattr(again, "ROW", 1000)


def searched(name: str, edges: int = 3, *, keep_going: bool = False) -> SearchEntry:
    return search(f"mappers.py:{name}", edges=edges, keep_going=keep_going)


def exit_code(line: str) -> int:
    """What a command line exits with."""
    from click.testing import CliRunner

    return CliRunner().invoke(main, shlex.split(line)[1:]).exit_code


@pytest.mark.nightly
@pytest.mark.usefixtures("folder")
def test_a_world_that_fails_after_others_only_is_shown_after_others() -> None:
    found = searched("remembers")
    first = some(found.counterexample)
    assert (found.verdict, first.world, first.claim) == ("REFUTED", "m3/8", "not-deterministic")
    assert first.message.startswith("a claim fails here only after other worlds, and alone none ")
    assert first.replay.startswith("topo-verify explore m1/0 m1/1 ")
    assert first.replay.endswith(" m3/8 --target mappers.py:remembers")
    assert exit_code(first.replay) == 1
    assert exit_code("topo-verify explore m3/8 --target mappers.py:remembers") == 0


@pytest.mark.long
@pytest.mark.usefixtures("folder")
def test_a_world_that_passes_after_others_only_is_a_finding() -> None:
    found = searched("learns", edges=2)
    first = some(found.counterexample)
    assert (found.verdict, first.world, first.claim) == ("REFUTED", "m2/0", "not-deterministic")
    assert first.message.startswith("it passed after other worlds, and alone it fails: map-isom")
    assert first.replay == "topo-verify replay m2/0 --target mappers.py:learns"
    assert exit_code(first.replay) == 1
    assert [one.failing for one in found.claims if one.claim == "not-deterministic"] == [10]


@pytest.mark.nightly
@pytest.mark.usefixtures("folder")
def test_a_mapper_that_is_right_alone_and_in_the_order_of_the_search_is_tried_in_another() -> None:
    found = searched("shrinks")
    first = some(found.counterexample)
    assert (found.verdict, found.checked, first.claim) == ("REFUTED", 86, "not-deterministic")
    assert first.message.startswith("it passed in the search, and fails as number ")
    words = shlex.split(first.replay)
    assert words[:2] == ["topo-verify", "explore"]
    assert len(words) == 2 + 2 + 2  # one world before it is enough
    assert exit_code(first.replay) == 1
    assert some(found.run_again).row < 86


@pytest.mark.parametrize("toss", [0, 3, 5])
def test_a_mapper_that_fails_now_and_then_is_not_said_to_remember(folder: Path, toss: int) -> None:
    (folder / "runs").write_text("." * toss)
    found = searched("tosses")
    assert found.run_again is not None
    (first, *_), rows = found.run_again.failures, found.run_again.rows
    assert first.findings[0].message.startswith(again.VARIES)
    assert first.findings[0].replay == f"topo-verify replay {rows[0].world} --target {first.target}"
    assert [row.world for row in rows] == sorted(row.world for row in rows)


@pytest.mark.usefixtures("folder")
def test_the_row_has_every_world_once_and_an_order_drawn_by_the_seed() -> None:
    campaign = search_campaign(targets("mappers.py:right"), edges=3)
    rows = [[*drawn_row(msgspec.structs.replace(campaign, seed=seed))] for seed in (0, 0, 1)]
    assert rows[0] == rows[1] != rows[2]
    every = [world.id for world in worlds([1, 2, 3])]
    assert sorted(rows[0]) == sorted(rows[2]) == sorted(every)
    of_three = [[name for name in row if name.startswith("m3/")] for row in (rows[0], every)]
    assert of_three[0] != of_three[1]
    whole = msgspec.structs.replace(campaign, worlds=Ranks(5, shard=100_000))
    assert drawn_row(whole) == drawn_row(msgspec.structs.replace(whole, worlds=Ranks(5)))


@pytest.mark.parametrize("deed", ["kill", "hang"])
def test_a_row_in_which_each_process_is_ended_is_not_run_to_its_end(
    monkeypatch: pytest.MonkeyPatch, folder: Path, deed: str
) -> None:
    monkeypatch.setattr(again, "MOST", 0)
    monkeypatch.setattr(again, "MOST_ENDED", 3)
    (folder / "late.py").write_text(
        "from pathlib import Path\n"
        "import misdeeds\n"
        "def explore(robot):\n"
        f"    deed = 'at_2_{deed}' if Path('late').exists() else 'at_0_map'\n"
        "    return getattr(misdeeds, deed)(robot)"
    )
    mappers = targets("late.py:explore", in_process=False)
    limits = Limits(move_timeout=0.3)
    campaign = search_campaign(mappers, edges=2, limits=limits, in_process=False)
    late = Search(campaign, mappers, here(mappers))
    late.work()
    (folder / "late").touch()
    late.run_again()
    assert late.again is not None
    assert late.entry().verdict == "UNKNOWN"
    assert (late.again.undecided, late.again.row) == (3, 4)


@pytest.mark.long
@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(("alone", "row"), [(9, 0), (0, 30)])
def test_a_mapper_that_draws_lots_leaves_the_verdict_open(
    monkeypatch: pytest.MonkeyPatch, alone: int, row: int
) -> None:
    monkeypatch.setattr(again, "MOST", alone)
    monkeypatch.setattr(again, "ROW", row)
    found = searched("draws")
    assert (found.verdict, found.checked, found.counterexample) == ("UNKNOWN", 86, None)
    assert found.run_again is not None
    assert found.run_again.other == len(found.run_again.others) > 0


@pytest.mark.parametrize(
    ("deed", "outcome"), [("skip", "other"), ("kill", "undecided"), ("hang", "undecided")]
)
@pytest.mark.usefixtures("folder")
def test_no_run_that_was_made_again_is_passed_over(deed: str, outcome: str) -> None:
    """The mapper is right in the order of the search, and not in that of the row."""
    found = search(f"misdeeds.py:unsorted_{deed}", edges=3, limits=Limits(move_timeout=0.3))
    assert (found.verdict, found.checked, found.counterexample) == ("UNKNOWN", 86, None)
    numbers = some(found.run_again)
    assert (numbers.row, numbers.same + getattr(numbers, outcome)) == (86, 86)
    assert getattr(numbers, outcome) > 0


@pytest.mark.usefixtures("folder")
def test_an_interrupted_repetition_leaves_the_verdict_open() -> None:
    def interrupted(words: str, done: int, _total: int) -> None:
        if words.endswith("run again") and done:
            raise KeyboardInterrupt

    with pytest.raises(SearchInterrupted) as cut:
        search("mappers.py:right", edges=3, tell=interrupted)
    entry = cut.value.entry
    assert (entry.verdict, entry.checked) == ("UNKNOWN", 86)
    assert entry.run_again is not None
    assert (entry.run_again.whole, entry.run_again.row) == (False, 0)
    assert 0 < entry.run_again.same < 50


@pytest.mark.nightly
@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(("name", "verdict"), [("right", "EXHAUSTED"), ("forgets", "REFUTED")])
def test_a_mapper_that_does_the_same_each_time_is_judged_as_before(name: str, verdict: str) -> None:
    found = searched(name, keep_going=True)
    assert found.verdict == verdict
    failing = sum(size.failing for size in found.by_edges)
    row = 0 if failing else 86
    alone = min(50, failing) + min(50, 86 - failing)
    assert found.run_again == again.RunAgain(alone, row, same=max(alone, row))
    assert "not-deterministic" not in [one.claim for one in found.claims]


@pytest.mark.nightly
def test_a_program_is_run_again_too(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(again, "MOST", 2)
    found = search(served(f"{folder / 'mappers.py'}:remembers"), edges=3)
    assert found.counterexample is not None
    assert found.counterexample.claim == "not-deterministic"
    assert found.counterexample.replay.startswith("topo-verify explore m1/0 ")
    assert "--cmd" in found.counterexample.replay


@pytest.mark.long
@pytest.mark.usefixtures("folder")
def test_where_no_row_of_worlds_makes_it_fail_the_search_is_named(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(again, "LONGEST", 4)
    first = some(searched("remembers").counterexample)
    assert "No row of up to 4 worlds before it made it fail again" in first.message
    assert first.replay == (
        "topo-verify search mappers.py:remembers --edges 3 --class any --workers 0"
    )


def test_an_algorithm_of_the_catalogue_is_not_run_again() -> None:
    assert search("basic", edges=1).run_again is None


# ---------------------------------------------------------------- the fresh process


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("exits", "ended with exit code 3"),
        ("segfaults", "was ended by SIGSEGV"),
        ("kills_itself", "was ended by SIGKILL"),
    ],
)
def test_what_ends_a_fork_ends_its_process_likewise(name: str, words: str) -> None:
    from topo_verify import World, explore

    with Foreign(f"mappers.py:{name}", fresh=True) as mapper:
        run = explore(World.from_id("m3/21"), mapper.target)
        assert words in some(run.stopped)
        assert explore(World.from_id("m3/20"), mapper.target).map is not None


@pytest.mark.parametrize("once", [False, True])
def test_a_mapper_that_cannot_be_loaded_any_more_delivers_no_map(
    folder: Path, *, once: bool
) -> None:
    from topo_verify import World, explore

    (folder / "mappers.py").write_text("")
    with Foreign("mappers.py:right", fresh=True, once=once) as mapper:
        for _ in range(2):
            run = explore(World.from_id("m1/0"), mapper.target)
            assert run.map is None
            assert "has no attribute 'right'" in str(run.stopped)
