"""The campaigns of a league: where they stop, what is kept of them, how memory is measured."""

from __future__ import annotations

from pathlib import Path

import pytest

from topo_verify.campaign.campaign import Campaign
from topo_verify.campaign.progress import no_progress
from topo_verify.campaign.store import Store
from topo_verify.campaign.targets import targets
from topo_verify.extra.arena.league import League
from topo_verify.extra.arena.match import matches, measure
from topo_verify.extra.arena.suites import Suite, drawn, every
from topo_verify.world.resolve import resolve_world

SMALL = Suite("small", "a test", (every(2), drawn("lattice(3,3,holes=0.2)", 3, planar=True)))
WRONG = "topo_verify.faults:FAULTS.forgets-its-orientation"


def play(table: League, store: Store | None = None) -> None:
    """Make all runs, here."""
    for campaign in matches(table, store):
        for row in campaign.rows(0):
            table.rows[row.mapper, row.world] = row


def test_of_a_wrong_mapper_no_run_is_made_behind_its_counterexample() -> None:
    table = League(targets(WRONG), (SMALL,), 0)
    play(table)
    (entry,) = table.entries()
    assert entry.counterexample is not None
    assert list(table.rows)[-1][1] == entry.counterexample.world
    assert len(table.rows) == entry.worlds < SMALL.size


def test_what_is_stored_is_not_made_again_and_mappers_and_suites_join_later(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = League(targets("basic"), (SMALL,), 7)
    with Store(tmp_path / "runs.db") as store:
        play(first, store)
    later = League(targets("folding,basic"), (Suite("more", "a test", (every(3),)), SMALL), 7)
    with Store(tmp_path / "runs.db") as store:
        folding, basic = matches(later, store)
        assert (folding.stored, basic.stored, basic.total) == (0, SMALL.size, 86 + 3)
        play(later, store)
        monkeypatch.setattr(Campaign, "load", None)  # no mapper is loaded, so none runs
        again = League(targets("basic"), (SMALL,), 7)
        play(again, store)
    assert again.entries() == first.entries()
    assert later.entries()[-1].ratio == first.entries()[0].ratio


@pytest.mark.parametrize("mapper", ["basic", WRONG])
def test_the_store_does_not_tell_the_drawn_worlds(tmp_path: Path, mapper: str) -> None:
    grids = Suite("grids", "a test", SMALL.families[1:])
    table = League(targets(mapper), (grids,), 271)
    with Store(tmp_path / "runs.db") as store:
        play(table, store)
    kept = (tmp_path / "runs.db").read_bytes()
    assert b"hidden-" in kept
    assert b'"digest"' not in kept
    for name in grids.worlds(271):
        world = resolve_world(name)
        for secret in (name, name.partition("seed=")[2][:-1], world.id, str(world.code[0])):
            assert secret.encode() not in kept
    with Store(tmp_path / "runs.db") as store:
        again = League(targets(mapper), (grids,), 271)
        play(again, store)
    assert [(key, row.findings) for key, row in again.rows.items()] == [
        (key, row.findings) for key, row in table.rows.items()
    ]


@pytest.mark.parametrize("name", ["basic", "planner"])
def test_the_memory_of_a_named_mapper_is_measured(name: str) -> None:
    table = League(targets(name), (Suite("small", "a test", (every(1),)),), 0)
    play(table)
    measure(table, None, no_progress)
    ((_, peak),) = table.peaks.items()
    assert peak is None or peak > 1000  # a Python process takes more than a mebibyte
