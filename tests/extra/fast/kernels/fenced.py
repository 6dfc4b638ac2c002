"""The kernels as plain functions, with smaller capacities and a fence behind each.

Every field stands where it stands in the small layout. With a capacity lowered, the rest of each
field that has it is fenced off: a kernel that reads or writes there raises an AssertionError, and
so does one that does not end.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

from tests.extra.fast.kernels.judged import Judged, Run, by_judge
from topo_verify import World
from topo_verify.extra.fast.kernels.explore import KERNELS, place_world, workspace
from topo_verify.extra.fast.kernels.faults import PLANTED
from topo_verify.extra.fast.kernels.judging import layout as judging
from topo_verify.extra.fast.kernels.kernel import F, kernel, module_source
from topo_verify.extra.fast.kernels.workspace import CAPACITIES, RUN, SMALL

JUDGE_CAPACITIES = {
    name: size
    for name, size in judging.JUDGE_CAPACITIES.items()
    if name not in ("JUDGE_SLOTS", "JUDGE_SET", "JUDGE_SETS")
}

ENDLESS = 5_000_000
"""Words that no run of these tests reads."""


class Fenced(list[int]):
    """Words, some of which are fenced off."""

    def __init__(self, words: Iterable[int], fences: Iterable[range]) -> None:
        super().__init__(words)
        self._fenced = bytearray(len(self))
        for fence in fences:
            self._fenced[fence.start : fence.stop] = bytes([1]) * len(fence)
        self._reads = 0

    def __getitem__(self, at: int) -> int:  # type: ignore[override]  # pyright: ignore[reportIncompatibleMethodOverride]
        self._reads += 1
        assert self._reads < ENDLESS, "the kernel does not end"
        assert at >= 0
        assert not self._fenced[at], f"word {at} is read, beyond a capacity"
        return super().__getitem__(at)

    def __setitem__(self, at: int, word: int) -> None:  # type: ignore[override]  # pyright: ignore[reportIncompatibleMethodOverride]
        assert at >= 0
        assert not self._fenced[at], f"word {at} is written, beyond a capacity"
        super().__setitem__(at, word)


@cache
def _kernels() -> dict[str, Any]:
    """Everything in the module of the small layout, its kernels not compiled."""
    source = module_source(SMALL).partition("\n\n")[2]  # without its imports
    module: dict[str, Any] = {
        "np": SimpleNamespace(uint64=int),
        "njit": _uncompiled,
    }
    exec(source, module)  # noqa: S102  the text of the kernels
    return module


def _uncompiled(**_options: object) -> Callable[[F], F]:
    """The decorator that leaves a kernel as it is."""
    return kernel


def _kernel(name: str, capacities: Mapping[str, int], *, faults: bool = False) -> Any:
    """A kernel; whatever it calls has these capacities until the next call of this function."""
    module = _kernels()
    module.update({**CAPACITIES, **JUDGE_CAPACITIES, **capacities, "FAULTS": int(faults)})
    return module[name]


# ---------------------------------------------------------------- runs


def run_within(
    capacities: Mapping[str, int],
    world: World,
    algorithm: str,
    *,
    fault: str = "",
    budget: int | None = None,
) -> tuple[int, tuple[int, ...]]:
    """The reason why a run with these capacities stopped, 0: none; and the words of its trace."""
    at = SMALL.at
    room = capacities.get("TRACE", CAPACITIES["TRACE"])
    words = workspace(SMALL, CAPACITIES["TRACE"])
    place_world(words, SMALL, world)
    fences = (
        range(at(one.name) + capacities[one.capacity], at(one.name) + CAPACITIES[one.capacity])
        for one in RUN.all
        if one.capacity in capacities
    )
    space = Fenced(words.tolist(), fences)
    space[at("task.rule")], space[at("task.motion")] = KERNELS[algorithm]
    space[at("task.fault")] = PLANTED[fault][0] if fault else 0
    space[at("task.budget")] = world.cost_bound if budget is None else budget
    space[at("task.tracing")], space[at("task.room")] = 1, room
    _kernel("explore", capacities, faults=bool(fault))(space)
    trace = at("trace.word")
    return space[at("stop")], tuple(space[trace + i] for i in range(space[at("trace.size")]))


# ---------------------------------------------------------------- verdicts


def judged_within(capacities: Mapping[str, int], run: Run) -> Judged | None:
    """What the judge with these capacities says of a run; None: the verdict is open."""
    words = Fenced([0] * judging.JUDGE_SIZE, _judge_fences(capacities))
    judge = _kernel("judge", capacities)
    return by_judge(run, judge=lambda space, case: judge(space.array, case.array), words=words)


def _judge_fences(capacities: Mapping[str, int]) -> Iterator[range]:
    """Of each field of the judge: what is beyond it with these capacities."""
    whole, lowered = pairwise(_judge_offsets({})), pairwise(_judge_offsets(capacities))
    for (first, end), (low_first, low_end) in zip(whole, lowered, strict=True):
        yield range(first + low_end - low_first, end)


def _judge_offsets(capacities: Mapping[str, int]) -> list[int]:
    """Where each field would begin, and the last one end, with these capacities."""
    sizes = {**judging.CASE.capacities, **capacities}
    sizes["JUDGE_SLOTS"] = sizes["JUDGE_DOORS"] // 4
    return list(judging.CASE.offsets(sizes).values())
