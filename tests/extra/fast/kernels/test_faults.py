"""Mistakes planted in the kernels are those of topo_verify/faults: every event, in every world."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice

import pytest

from tests.extra.fast.kernels.twins import difference
from tests.faults.table import Failing, by_search, stored
from tests.marks import with_marks
from topo_verify import World, worlds
from topo_verify.extra.fast.kernels.explore import CompiledJob, run_world
from topo_verify.extra.fast.kernels.faults import PLANTED
from topo_verify.extra.fast.kernels.workspace import CAPACITIES, FAULTY, RUN, WordLayout
from topo_verify.extra.fast.snapshots import examine_range
from topo_verify.faults import FAULTS, Fault

ROWS = stored()
FIRST = {name: len(World.from_id(ROWS[name].world).edges) for name in PLANTED}
"""The edges of the smallest worlds in which each mistake is found."""


def fault_difference(world: World, name: str) -> str | None:
    """Where the kernel with the mistake parts from the mapper with it."""
    algorithm = PLANTED[name][1]
    return difference(world, algorithm, fault=name, mapper=FAULTS[name])


def changed(world: World, name: str) -> bool:
    """Whether the mistake changes a word of the run."""
    algorithm = PLANTED[name][1]
    right = run_world(world, algorithm, trace=True)
    return run_world(world, algorithm, trace=True, fault=name).trace != right.trace


def by_kernel(fault: Fault, edges: int) -> Failing:
    """The worlds with this number of edges in which the kernel with the mistake fails."""
    end = examine_range([fault.name], edges, faults={fault.name: fault.name})
    rank = end.named[0].first.get(fault.claim or "")
    return Failing(end.tally.failing, None if rank is None else f"m{edges}/{rank}")


@pytest.mark.parametrize("name", PLANTED)
def test_the_compiled_engine_finds_a_fault_in_the_worlds_of_the_table(name: str) -> None:
    pytest.importorskip("numba", reason="the compiled engine needs numba")
    assert by_search(by_kernel, FAULTS[name]) == ROWS[name][3:5]


@pytest.mark.long
@pytest.mark.parametrize("name", PLANTED)
def test_equal_events_in_every_world_to_3_edges(name: str) -> None:
    small = (world for edges in range(1, 4) for world in worlds(edges=edges))
    found = (fault_difference(world, name) for world in small)
    assert list(islice(filter(None, found), 3)) == []


@pytest.mark.long
@pytest.mark.parametrize(
    "name",
    with_marks(
        PLANTED,
        nightly=[
            "retraces-in-the-wrong-order",
            "compares-before-the-door",
            "records-a-loop-from-dart-0",
            "records-from-the-near-end",
        ],
    ),
)
def test_equal_events_in_some_worlds_in_which_the_mistake_shows(name: str) -> None:
    showing = (world for world in worlds(edges=FIRST[name]) if changed(world, name))
    found = [fault_difference(world, name) for world in islice(showing, 100)]
    assert found
    assert list(filter(None, found)) == []


@pytest.mark.long
def test_a_mistake_is_seen_as_a_difference_from_the_reference() -> None:
    name = "restores-with-the-wrong-sign"
    seen = [difference(world, "basic", fault=name) for world in worlds(edges=3)]
    found = next(filter(None, seen))
    assert found.splitlines()[0].endswith("differs")
    assert "  reference: takes door" in found
    assert "  compiled: takes door" in found


def beyond_its_fields(space: Sequence[int], layout: WordLayout) -> list[str]:
    """The fields beyond whose end something was written."""
    sizes = {**layout.constants, "": 1}
    ends = {one.name: layout.at(one.name) + sizes[one.capacity] for one in RUN.all}
    return [name for name, end in ends.items() if end < len(space) and space[end] != 0]


@pytest.mark.long
@pytest.mark.parametrize("name", PLANTED)
def test_a_wrong_mapper_writes_nothing_beyond_a_field(name: str) -> None:
    algorithm = PLANTED[name][1]
    for world in islice(worlds(edges=5), 0, None, 200):
        job = CompiledJob(world, algorithm, trace=True, budget=world.cost_bound, fault=name)
        space = job.run(FAULTY, CAPACITIES["TRACE"])
        assert beyond_its_fields(space[: FAULTY.at("trace.word")].tolist(), FAULTY) == []


def test_what_is_written_beyond_a_field_is_seen() -> None:
    space = [0] * FAULTY.at("trace.word")
    space[FAULTY.at("excursion.percept") + FAULTY.constants["CHART_DARTS"]] = 7
    assert beyond_its_fields(space, FAULTY) == ["excursion.percept"]
