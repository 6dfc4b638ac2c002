"""Runs as the player takes them, for its tests."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from topo_verify import World
from topo_verify.campaign.run import explore
from topo_verify.checkers import check
from topo_verify.pictures.page import player_page
from topo_verify.pictures.recording import PlayedRun
from topo_verify.pictures.scenes import Playback
from topo_verify.robot.events import Confirm, Event, Trace


def played(world: World, mapper: Any = "enhancement-ii", name: str = "") -> PlayedRun:
    """The run of a mapper in a world, judged."""
    run = explore(world, mapper)
    judgements = check(world, run.trace, run.stopped)
    return PlayedRun(name or run.algorithm, run.trace, judgements, run.stopped)


def page_of(world: World, *mappers: Any, name: str = "") -> str:
    """The page of these mappers' runs in a world."""
    return player_page(world, [played(world, mapper) for mapper in mappers], name=name)


def playback_of(
    world: World | str, mapper: Any, edit: Callable[[Any], Sequence[Event]] = tuple
) -> Playback:
    """The run of a mapper in a world, judged; `edit` changes its trace before that."""
    there = World.from_id(world) if isinstance(world, str) else world
    run = explore(there, mapper)
    trace = edit(run.trace)
    return Playback(there, trace, check(there, trace, run.stopped), run.stopped)


def confirms_at_once(h: int) -> Callable[[Trace], list[Event]]:
    """An edit of m4/41: dart h is confirmed directly behind edge 7."""
    return lambda trace: [*trace[:9], Confirm(7, h, "motion")]
