"""Mistakes planted in the kernels are those of topo_verify/faults: every event, in every world."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice

import pytest

from tests.compiled.twins import difference
from topo_verify import World, worlds
from topo_verify.compiled.explore import CompiledJob, run_world
from topo_verify.compiled.faults import PLANTED
from topo_verify.compiled.workspace import CAPACITIES, FAULTY, RUN, WordLayout
from topo_verify.faults import FAULTS

FIRST = {
    "leaves-out-the-darts-of-vk": 1,
    "leaves-out-the-darts-of-v0": 1,
    "tries-only-the-nearest-two": 2,
    "confirms-what-is-alone": 2,
    "forgets-its-orientation": 3,
    "restores-with-the-wrong-sign": 3,
    "sets-out-unturned": 3,
    "retraces-in-the-wrong-order": 5,
    "retraces-one-edge-short": 3,
    "goes-on-as-if-just-come-in": 3,
    "ignores-direction-at-the-end": 4,
    "ignores-direction-behind-e": 2,
    "counts-doors-anticlockwise": 2,
    "compares-before-the-door": 5,
    "traces-through-the-unexplored": 4,
    "traces-from-the-first-dart": 4,
    "takes-unknown-for-a-mismatch": 3,
    "records-a-loop-from-dart-0": 5,
    "records-from-the-near-end": 5,
    "takes-each-place-for-known": 1,
    "identifies-without-turning": 1,
    "forgets-that-vu-may-be-new": 2,
}
"""The edges of the smallest worlds that show each mistake, as docs/faults.md has them."""


def fault_difference(world: World, name: str) -> str | None:
    """Where the kernel with the mistake parts from the mapper with it."""
    algorithm = PLANTED[name][1]
    return difference(world, algorithm, fault=name, mapper=FAULTS[name])


def changed(world: World, name: str) -> bool:
    """Whether the mistake changes a word of the run."""
    algorithm = PLANTED[name][1]
    right = run_world(world, algorithm, trace=True)
    return run_world(world, algorithm, trace=True, fault=name).trace != right.trace


@pytest.mark.parametrize("name", PLANTED)
def test_equal_events_in_every_world_to_3_edges(name: str) -> None:
    small = (world for edges in range(1, 4) for world in worlds(edges=edges))
    found = (fault_difference(world, name) for world in small)
    assert list(islice(filter(None, found), 3)) == []


@pytest.mark.parametrize("name", PLANTED)
def test_equal_events_in_some_worlds_in_which_the_mistake_shows(name: str) -> None:
    showing = (world for world in worlds(edges=FIRST[name]) if changed(world, name))
    found = [fault_difference(world, name) for world in islice(showing, 100)]
    assert found
    assert list(filter(None, found)) == []


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
