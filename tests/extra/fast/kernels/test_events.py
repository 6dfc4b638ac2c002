"""Words and events: each stands for the other."""

from __future__ import annotations

import pytest

from topo_verify import InternalError, World, explore, worlds
from topo_verify.algorithms import CATALOGUE
from topo_verify.extra.fast.kernels.events import (
    REJECT,
    decoded,
    digest,
    percept_of,
    percept_word,
    words,
)
from topo_verify.extra.fast.kernels.explore import CompiledJob
from topo_verify.extra.fast.kernels.kernel import compiled
from topo_verify.extra.fast.kernels.workspace import CAPACITIES, SMALL
from topo_verify.robot.events import Evidence, Finish, Record, Reject
from topo_verify.robot.percept import Percept


@pytest.mark.parametrize("name", CATALOGUE)
def test_the_words_of_a_trace_mean_its_events(name: str) -> None:
    for world in worlds(edges=3):
        events = [e for e in explore(world, name).trace[1:] if not isinstance(e, Finish)]
        assert list(decoded(words(events))) == events


def test_a_rejection_by_a_record_keeps_all_its_evidence() -> None:
    why = Evidence(3, Percept(4, None), Percept(2, 1), 5, 6, Record(6, (1, 0)))
    event = Reject(9, 8, "records", why)
    row = words([event])
    assert row == [REJECT, 9, 8, 15, 3, 3, 4 << 16, (2 << 16) + 2, 5, 6, 6, 0, 2, 1, 0]
    assert list(decoded(row)) == [event]


@pytest.mark.parametrize("percept", [Percept(1, 0), Percept(3, None), Percept(65533, 65532)])
def test_a_percept_is_one_word(percept: Percept) -> None:
    assert percept_of(percept_word(percept)) == percept


def test_words_that_are_no_trace_are_our_mistake() -> None:
    with pytest.raises(InternalError, match="word 4 of a compiled trace is 9"):
        list(decoded([1, 0, 65536, 0, 9]))


def test_the_digest_depends_on_every_word_and_on_their_order() -> None:
    world = World.from_id("m4/41")
    job = CompiledJob(world, "enhancement-ii", trace=True, budget=world.cost_bound, fault="")
    space = job.run(SMALL, CAPACITIES["TRACE"])
    hashed = compiled(digest, SMALL)
    start, length = SMALL.at("trace.word"), int(space[SMALL.at("trace.size")])
    seen = {hashed(space)}
    for at in range(start, start + length):
        space[at] += 1
        seen.add(hashed(space))
        space[at] -= 1
    space[start], space[start + 1] = int(space[start + 1]), int(space[start])
    seen.add(hashed(space))
    assert len(seen) == length + 2
