"""Tallies and notable rows: worlds can be grouped in any way that keeps their order."""

from __future__ import annotations

from functools import cache
from itertools import chain, pairwise

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from topo_verify.campaign.backend import here
from topo_verify.campaign.campaign import Campaign, Ranks, results
from topo_verify.campaign.examiner import counted
from topo_verify.campaign.row import Row
from topo_verify.campaign.tally import Tally, notable

WRONG = "topo_verify.faults:FAULTS.leaves-out-the-darts-of-vk"
MAPPERS = (("enhancement-i",), (WRONG,), ("basic", "enhancement-i"), (WRONG, "basic"))


@cache
def rows_by_world(mappers: tuple[str, ...]) -> list[list[Row]]:
    """The rows of each world of 1 to 3 edges."""
    campaign = Campaign(worlds=Ranks(3), mappers=mappers)
    rows = [row for _, result in results(campaign, here()) for row in result.rows]
    return [rows[at : at + len(mappers)] for at in range(0, len(rows), len(mappers))]


@st.composite
def grouped(draw: st.DrawFn, mappers: tuple[str, ...]) -> list[list[list[Row]]]:
    """The worlds, cut into at most five groups in order; a group may be empty."""
    worlds = rows_by_world(mappers)
    cuts = draw(st.lists(st.integers(0, len(worlds)), max_size=4))
    return [worlds[a:b] for a, b in pairwise([0, *sorted(cuts), len(worlds)])]


@pytest.mark.parametrize("mappers", MAPPERS)
def test_the_tallies_of_groups_add_up_to_the_tally_of_all(mappers: tuple[str, ...]) -> None:
    whole = counted(rows_by_world(mappers)).tally
    assert (whole.worlds, whole.failing > 0) == (86, WRONG in mappers)

    @given(grouped(mappers))
    def add_up(groups: list[list[list[Row]]]) -> None:
        tallies = [counted(group).tally for group in groups if group]
        assert sum(tallies, Tally()) == whole

    add_up()


@pytest.mark.parametrize("mappers", MAPPERS)
def test_the_notable_rows_of_groups_have_the_notable_rows_of_all(mappers: tuple[str, ...]) -> None:
    every = list(chain.from_iterable(rows_by_world(mappers)))
    assert 0 < len(notable(every)) < len(every)

    @given(grouped(mappers))
    def have_all(groups: list[list[list[Row]]]) -> None:
        kept = [notable(chain.from_iterable(group)) for group in groups]
        assert notable(chain.from_iterable(kept)) == notable(every)

    have_all()


def test_the_first_undecided_world_of_a_size_is_notable() -> None:
    every = [row for (row,) in rows_by_world(("enhancement-i",))]
    for at in (50, 51):  # neither the first nor the last world of its size
        why = {"undecided": "out of time", "timed_out": True, "claims": ()}
        every[at] = msgspec.structs.replace(every[at], **why)
    assert every[50] in notable(every)
    assert every[51] not in notable(every)
    assert notable([*notable(every[:50]), *notable(every[50:])]) == notable(every)
