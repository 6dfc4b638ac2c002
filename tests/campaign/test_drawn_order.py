"""The order in which a mapper meets the worlds of a list: drawn, and no part of the results."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator

import pytest

from topo_verify.campaign import campaign as c
from topo_verify.campaign.examiner import counted
from topo_verify.campaign.row import Row
from topo_verify.world.rooted_map import World

LATE = {"w3", "w4", "w5", "w6"}


def worlds(number: int) -> list[tuple[str, World]]:
    one = World.from_id("m1/0")
    return [(f"w{place}", one) for place in range(number)]


class Examining:
    """A backend that notes the order of the worlds; some are out of time, one is interrupted."""

    def __init__(self, interrupt: int | None = None) -> None:
        self.met: list[str] = []
        self.interrupt = interrupt

    def __call__(
        self, campaign: c.Campaign, shards: Iterator[c.Shard], in_flight: Callable[[int], None]
    ) -> Generator[tuple[c.Shard, c.ShardResult]]:
        del in_flight
        for shard in shards:
            if len(self.met) == self.interrupt:
                raise KeyboardInterrupt
            ((place, name, _),) = campaign.worlds.worlds(shard)
            self.met.append(name)
            late = name in LATE
            row = Row(world=name, edges=1, place=place, least=1, mapper="basic", timed_out=late)
            yield shard, counted([[row]])


def names(number: int, seed: int, backend: c.Backend, enough: int = 99) -> Iterator[str]:
    """The worlds in the order of the results."""
    campaign = c.Campaign(
        worlds=c.ListedWorlds(number),
        mappers=("basic",),
        stop=c.Stop(timeouts=enough),
        seed=seed,
        drawn=True,
    )
    for _, result in c.results(campaign, backend, worlds(number)):
        yield from (row.world for row in result.rows)


def met(number: int, seed: int) -> list[str]:
    examining = Examining()
    assert list(names(number, seed, examining)) == [name for name, _ in worlds(number)]
    return examining.met


def test_results_have_the_order_of_the_list_and_worlds_a_drawn_one() -> None:
    first = met(40, 1)
    assert first == met(40, 1)
    assert first != met(40, 2)
    assert sorted(first) == sorted(name for name, _ in worlds(40)) != first


def test_the_order_is_drawn_block_by_block(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(c, "BLOCK", 10)
    seen = met(25, 1)
    listed = [name for name, _ in worlds(25)]
    for begin in (0, 10, 20):
        block = seen[begin : begin + 10]
        assert sorted(block) == sorted(listed[begin : begin + 10])
    assert met(10, 1) != listed[:10]


@pytest.mark.parametrize("seed", range(4))
def test_where_the_work_ends_after_time_outs_depends_on_the_list_alone(seed: int) -> None:
    examining = Examining()
    assert list(names(1000, seed, examining, 2)) == ["w0", "w1", "w2", "w3", "w4"]
    late_at = [turn for turn, name in enumerate(examining.met) if name in LATE]
    then = [int(name[1:]) for name in examining.met[late_at[1] + 1 :]]
    assert then == sorted(then)


def test_after_ctrl_c_what_is_finished_is_handed_on() -> None:
    examining = Examining(interrupt=10)
    found = names(40, 1, examining)
    done = [next(found) for _ in range(10)]
    with pytest.raises(KeyboardInterrupt):
        next(found)
    assert sorted(done) == sorted(examining.met)
    assert done == sorted(done, key=lambda name: int(name[1:]))
