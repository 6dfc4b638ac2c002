"""One compiled run: what it gives, and what it refuses."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import topo_verify as tv
from topo_verify import InputError, World, families
from topo_verify.extra.fast.kernels import explore, workspace
from topo_verify.extra.fast.kernels.explore import run_world

WORLD = World.from_id("m4/41")


def test_a_run_has_cost_and_map_at_once_and_its_events_when_asked() -> None:
    reference = tv.explore(WORLD, "enhancement-ii")
    short, long = (run_world(WORLD, "enhancement-ii", trace=trace) for trace in (False, True))
    assert short.map == long.map == reference.map
    assert short.cost == long.cost == reference.cost
    assert short.events == ()
    assert long.events == reference.trace[1:]


def test_a_run_stops_at_its_budget_as_the_reference_does() -> None:
    limits = tv.Limits(budget=7)
    reference = tv.explore(WORLD, "basic", limits=limits)
    run = run_world(WORLD, "basic", trace=True, budget=7)
    assert (run.map, run.stopped, run.cost) == (None, reference.stopped, 7)
    assert run.events == reference.trace[1:]


def test_a_world_may_be_numbered_as_it_likes() -> None:
    world = families.lattice(3, 3)
    turned = world.renumbered([(5 * dart + 3) % 24 for dart in range(24)])
    assert run_world(turned, trace=True) == run_world(world, trace=True)


def test_a_run_that_fills_its_trace_is_made_again_with_more_room(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    whole = run_world(WORLD, "enhancement-ii", trace=True)
    monkeypatch.setitem(workspace.CAPACITIES, "TRACE", 20)
    assert run_world(WORLD, "enhancement-ii", trace=True) == whole


@pytest.mark.long
def test_a_run_that_fills_the_small_layout_is_made_in_the_large_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    whole, run, used = run_world(WORLD, "basic", trace=True), explore.CompiledJob.run, list[str]()

    def full(job: explore.CompiledJob, layout: workspace.WordLayout, room: int) -> Any:
        space = run(job, layout, room)
        used.append(layout.name)
        if layout is workspace.SMALL:
            space[layout.at("stop")] = workspace.STOP_FULL + workspace.FULL_CHART
        return space

    monkeypatch.setattr(explore.CompiledJob, "run", full)
    assert run_world(WORLD, "basic", trace=True) == whole
    assert used == ["small", "large"]


@pytest.mark.long
def test_a_trace_grows_until_it_holds_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    world = families.lattice(5, 5)
    whole = run_world(world, "basic", trace=True)
    monkeypatch.setattr(explore, "TRACE_ROOM", 8)
    assert run_world(world, "basic", trace=True) == whole


GIB = 1 << 30


@pytest.mark.parametrize(
    ("most", "room", "runs"),
    [
        (1500, 1000, [1000, 1]),  # 442 moves have more words than that
        (1800, 100, [100, 1, 400, 1, 1600, 1, 1800]),  # the moves alone have 1,768
    ],
)
def test_a_trace_that_the_free_memory_does_not_hold_is_refused(
    most: int, room: int, runs: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    world, rooms, run = families.lattice(5, 5), list[int](), explore.CompiledJob.run

    def spied(job: explore.CompiledJob, layout: workspace.WordLayout, words: int) -> Any:
        rooms.append(words)
        return run(job, layout, words)

    monkeypatch.setattr(explore, "TRACE_ROOM", room)
    monkeypatch.setattr(explore, "free_memory", lambda: 2 * explore.WORD_BYTES * most)
    monkeypatch.setattr(explore.CompiledJob, "run", spied)
    words = r"trace of basic in this world of 40 edges needs at least 0.00 GiB.*trace=False"
    with pytest.raises(InputError, match=words):
        run_world(world, "basic", trace=True)
    assert rooms == runs


def test_a_trace_may_take_half_of_the_free_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    world = families.lattice(5, 5)
    whole = run_world(world, "basic", trace=True)
    assert whole.trace is not None
    monkeypatch.setattr(explore, "TRACE_ROOM", 8)
    monkeypatch.setattr(explore, "free_memory", lambda: 144 * len(whole.trace or ()))
    assert run_world(world, "basic", trace=True) == whole


@pytest.mark.parametrize(
    ("files", "free"),
    [
        ({"/proc/meminfo": "MemTotal: 9 kB\nMemAvailable: 1048576 kB"}, GIB),
        (
            {
                "/proc/meminfo": "MemAvailable: 1048576 kB",
                "/proc/self/cgroup": "0::/a",
                "/sys/fs/cgroup/a/memory.max": "5000",
                "/sys/fs/cgroup/a/memory.current": "3000",
                "/sys/fs/cgroup/a/memory.stat": "anon 7\ninactive_file 500",
            },
            2500,
        ),
        (
            {
                "/proc/meminfo": "MemAvailable: 1048576 kB",
                "/proc/self/cgroup": "3:cpuset:/\n4:memory:/b\n0::/",
                "/sys/fs/cgroup/memory/b/memory.limit_in_bytes": "5000",
                "/sys/fs/cgroup/memory/b/memory.usage_in_bytes": "6000",
            },
            0,
        ),
        (
            {
                "/proc/meminfo": "MemAvailable: 1048576 kB",
                "/proc/self/cgroup": "0::/a",
                "/sys/fs/cgroup/a/memory.max": "max",
                "/sys/fs/cgroup/a/memory.current": "3000",
            },
            GIB,
        ),
    ],
)
def test_free_memory_is_that_of_the_machine_or_of_the_control_group(
    files: dict[str, str], free: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lines(path: str) -> list[str]:
        return files.get(path, "").splitlines()

    monkeypatch.setattr(explore, "_lines", lines)
    assert explore.free_memory() == free


def test_without_address_space_the_limit_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def none(_file: int, _size: int) -> object:
        raise OSError

    monkeypatch.setattr("mmap.mmap", none)
    with pytest.raises(InputError, match=r"GiB of address space .*ulimit -v"):
        explore.workspace(workspace.LARGE, 1)


@pytest.mark.parametrize(
    ("world", "run", "words"),
    [
        (
            lambda: WORLD,
            {"algorithm": "mine"},
            "expected an algorithm of the catalogue, got 'mine'",
        ),
        (lambda: WORLD, {"fault": "typo"}, "expected a fault that has a kernel, got 'typo'"),
        (lambda: families.lattice(4, 4), {"fault": "sets-out-unturned"}, "up to 12 edges"),
        (lambda: families.path(65538), {}, r"up to 65536 edges .* use the reference engine"),
    ],
    ids=["algorithm", "fault", "fault in a large world", "large world"],
)
def test_what_has_no_kernel_or_no_room_is_refused(
    world: Callable[[], World], run: dict[str, Any], words: str
) -> None:
    with pytest.raises(InputError, match=words):
        run_world(world(), **run)
