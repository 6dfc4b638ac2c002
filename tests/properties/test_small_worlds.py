"""Every algorithm is right in every world to four edges that meets what it assumes."""

from __future__ import annotations

from collections import Counter

import pytest

from tests.helpers import worlds
from tests.small_rows import SmallRows, costs
from topo_verify.algorithms import NAMED
from topo_verify.checkers import CLAIMS

PLANAR = [name for name, mapper in NAMED.items() if mapper.assumes == "planar"]
WORLDS = list(worlds(range(1, 5)))


@pytest.mark.parametrize("name", NAMED)
def test_every_claim_holds_and_is_judged_in_full(name: str, small_rows: SmallRows) -> None:
    for world, row in zip(WORLDS, small_rows[name], strict=True):
        assert row.world == world.id
        if name not in PLANAR or world.is_planar:
            assert len(row.claims) == len(CLAIMS)
            assert row.cost >= row.least
            for judged in row.claims:
                assert (judged.status, judged.judged) == ("ok", judged.of), row


@pytest.mark.parametrize("name", PLANAR)
def test_who_assumes_a_plane_delivers_no_right_map_elsewhere(
    name: str, small_rows: SmallRows
) -> None:
    elsewhere = [
        row for world, row in zip(WORLDS, small_rows[name], strict=True) if not world.is_planar
    ]
    assert Counter(row.edges for row in elsewhere) == {2: 1, 3: 20, 4: 328}
    assert all("map-isomorphic" in row.failed for row in elsewhere)


@pytest.mark.parametrize("name", [name for name in PLANAR if name != "folding+planar"])
def test_those_that_steer_find_out_elsewhere(name: str, small_rows: SmallRows) -> None:
    last = [row.findings[-1].message for row in small_rows[name] if row.failed]
    assert all("raised ImpossibleError: no planar world shows this history: " in m for m in last)
    known = {"another face of S": 299, "two vertices of S would be one": 50}
    assert {words: sum(m.endswith(words) for m in last) for words in known} == known
    assert len(last) == sum(known.values())


@pytest.mark.parametrize(
    ("name", "totals"),
    [
        ("homing", [2, 23, 295, 4198]),
        ("planner", [2, 23, 295, 4202]),
        ("homing+planar", [2, 21, 223, 2335]),
        ("planner+planar", [2, 21, 223, 2335]),
    ],
)
def test_what_those_that_steer_pay_together(
    name: str, totals: list[int], small_rows: SmallRows
) -> None:
    right = [row for row in small_rows[name] if row.right]
    assert [sum(costs(right, edges)) for edges in range(1, 5)] == totals
