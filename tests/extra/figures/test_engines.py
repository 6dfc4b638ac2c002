"""`reproduce --engine compiled`: the same points, and larger ones."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tests.cli.conftest import Refused
from topo_verify import extras
from topo_verify.campaign.judge import TRACELESS
from topo_verify.campaign.row import Row
from topo_verify.campaign.store import Store
from topo_verify.extra.figures import points
from topo_verify.extra.figures.figures import FIGURES, LATTICE, FigureExtent
from topo_verify.extra.figures.points import line_campaigns

pytest.importorskip("numba")


def rows(folder: Path, engine: str, workers: int = 0) -> list[Row]:
    """The rows of a small figure."""
    lattices = replace(LATTICE, sizes=(6,), large=())
    figure = replace(FIGURES["3"], setting=lattices)
    with Store(folder / f"{engine}.db") as store:
        campaigns = line_campaigns([figure], FigureExtent(graphs=2), engine, store)
        return [row for one in campaigns for row in one.rows(workers)]


def test_a_point_of_a_figure_is_the_same_by_either_engine(tmp_path: Path) -> None:
    ours, theirs = rows(tmp_path, "reference"), rows(tmp_path, "compiled")
    assert [row.mapper for row in ours] == ["basic", "basic", "folding", "folding"]
    assert [(row.cost, row.claims, row.moves) for row in theirs] == [
        (row.cost, row.claims, row.moves) for row in ours
    ]


def test_a_large_world_is_judged_by_its_map_and_cost(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = rows(tmp_path, "compiled")
    monkeypatch.setattr(points, "LARGE", 10)
    (tmp_path / "compiled.db").unlink()
    brief = rows(tmp_path, "compiled")
    assert [(row.cost, row.least, row.edges, row.map) for row in brief] == [
        (row.cost, row.least, row.edges, row.map) for row in whole
    ]
    for row in brief:
        statuses = {one.claim: one.status for one in row.judgements}
        assert {claim for claim, status in statuses.items() if status == "ok"} == {*TRACELESS}
        assert {status for claim, status in statuses.items() if claim not in TRACELESS} == {
            "not-asked"
        }
        assert row.right


@pytest.mark.nightly
def test_workers_use_the_engine_that_is_asked_for(tmp_path: Path) -> None:
    here = rows(tmp_path, "compiled")
    (tmp_path / "compiled.db").unlink()
    there = rows(tmp_path, "compiled", workers=2)
    assert [row.digest for row in there] == [row.digest for row in here]


def test_lattices_grow_to_100_by_100_with_the_compiled_engine() -> None:
    assert FigureExtent(large=True).sizes(LATTICE)[-1] == 100
    assert FigureExtent().sizes(LATTICE)[-1] == 20
    assert FIGURES["3"].setting is LATTICE


def test_without_numba_the_extra_is_named(
    refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(extras.PACKAGES, "fast", ("no_such_numba",))
    refused("reproduce --figure 3 --quick --engine compiled", "the extra fast needs no_such_numba")
