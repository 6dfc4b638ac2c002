"""Runs as the player takes them, for its tests."""

from __future__ import annotations

from typing import Any

from topo_verify import World
from topo_verify.campaign.run import explore
from topo_verify.checkers import check
from topo_verify.player.page import player_page
from topo_verify.player.recording import PlayedRun


def played(world: World, mapper: Any = "enhancement-ii", name: str = "") -> PlayedRun:
    """The run of a mapper in a world, judged."""
    run = explore(world, mapper)
    judgements = check(world, run.trace, run.stopped)
    return PlayedRun(name or run.algorithm, run.trace, judgements, run.stopped)


def page_of(world: World, *mappers: Any, name: str = "") -> str:
    """The page of these mappers' runs in a world."""
    return player_page(world, [played(world, mapper) for mapper in mappers], name=name)
