"""The order in which an implementation meets the worlds: drawn, and no part of the results."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from topo_verify.harness.conform import order
from topo_verify.harness.conform.order import DrawnOrder, Placed
from topo_verify.harness.conform.outcome import WorldResult
from topo_verify.harness.corpus import Named
from topo_verify.world.rooted_map import World

LATE = {"w3", "w4", "w5", "w6"}


def worlds(number: int) -> Iterator[Named]:
    one = World.from_id("m1/0")
    return (Named(f"w{place}", one, "some", ()) for place in range(number))


class Examining:
    """Examines worlds, and notes in which order; some are out of time, one is interrupted."""

    def __init__(self, interrupt: int | None = None) -> None:
        self.met: list[str] = []
        self.interrupt = interrupt

    def __call__(
        self, todo: Iterator[Placed], room: Callable[[], bool]
    ) -> Iterator[tuple[int, WorldResult]]:
        for place, at in todo:
            if len(self.met) == self.interrupt:
                raise KeyboardInterrupt
            assert room()
            self.met.append(at.name)
            yield (
                place,
                WorldResult(
                    world=at.name,
                    group="",
                    edges=1,
                    states={},
                    findings={},
                    timeout=at.name in LATE,
                ),
            )


def met(number: int, seed: int) -> list[str]:
    examining = Examining()
    found = [made.world for made in DrawnOrder(worlds(number), seed, examining, 99).results()]
    assert found == [at.name for at in worlds(number)]
    return examining.met


def test_results_have_the_order_of_the_corpus_and_worlds_a_drawn_one() -> None:
    first = met(40, 1)
    assert first == met(40, 1)
    assert first != met(40, 2)
    assert sorted(first) == sorted(at.name for at in worlds(40)) != first


def test_the_order_is_drawn_block_by_block(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(order, "BLOCK", 10)
    seen = met(25, 1)
    names = [at.name for at in worlds(25)]
    for begin in (0, 10, 20):
        block = seen[begin : begin + 10]
        assert sorted(block) == sorted(names[begin : begin + 10])
    assert met(10, 1) != names[:10]


@pytest.mark.parametrize("seed", range(4))
def test_where_the_work_ends_after_time_outs_depends_on_the_corpus_alone(seed: int) -> None:
    examining = Examining()
    found: list[str] = []
    late = 0
    for made in DrawnOrder(worlds(1000), seed, examining, 2).results():
        found.append(made.world)
        late += made.timeout
        if late == 2:
            break
    assert found == ["w0", "w1", "w2", "w3", "w4"]
    late_at = [turn for turn, name in enumerate(examining.met) if name in LATE]
    then = [int(name[1:]) for name in examining.met[late_at[1] + 1 :]]
    assert then == sorted(then)


def test_after_ctrl_c_what_is_finished_is_handed_on() -> None:
    examining = Examining(interrupt=10)
    results = DrawnOrder(worlds(40), 1, examining, 99).results()
    done = [next(results).world for _ in range(10)]
    with pytest.raises(KeyboardInterrupt):
        next(results)
    assert sorted(done) == sorted(examining.met)
    assert done == sorted(done, key=lambda name: int(name[1:]))
