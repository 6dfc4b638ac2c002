"""topo-verify: is this robot-mapping algorithm right? Reference, checkers, worlds, proofs.

import topo_verify as tv
world = tv.World.from_id("m5/17")
run = tv.explore(world, "enhancement-ii")
report = tv.examine(my_mapper, world)

A name is imported on first use: pytest imports this package in every session, for the plugin.
"""

import sys
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from topo_verify import strategies
    from topo_verify.algorithms import CATALOGUE, Algorithm
    from topo_verify.campaign.judge import Report, assert_maps, examine
    from topo_verify.campaign.run import Exploration, explore
    from topo_verify.errors import (
        ClaimFailed,
        ClaimUndecided,
        InputError,
        InternalError,
        TopoVerifyError,
    )
    from topo_verify.robot.events import Policies, Robot
    from topo_verify.robot.limits import Limits
    from topo_verify.robot.percept import Percept
    from topo_verify.search_entry import SearchEntry, SearchInterrupted, search
    from topo_verify.studies.log_file import read_log
    from topo_verify.studies.log_report import Certificate, certify
    from topo_verify.world import families
    from topo_verify.world.enumeration.classes import WorldClass
    from topo_verify.world.enumeration.pruned import worlds
    from topo_verify.world.resolve import resolve_world
    from topo_verify.world.rooted_map import World

__version__ = "0.3.0"

__all__ = [
    "CATALOGUE",
    "Algorithm",
    "Certificate",
    "ClaimFailed",
    "ClaimUndecided",
    "Exploration",
    "InputError",
    "InternalError",
    "Limits",
    "Percept",
    "Policies",
    "Report",
    "Robot",
    "SearchEntry",
    "SearchInterrupted",
    "TopoVerifyError",
    "World",
    "WorldClass",
    "__version__",
    "assert_maps",
    "certify",
    "examine",
    "explore",
    "families",
    "read_log",
    "resolve_world",
    "search",
    "strategies",
    "worlds",
]

_MODULES = {
    "algorithms": ("CATALOGUE", "Algorithm"),
    "errors": (
        "ClaimFailed",
        "ClaimUndecided",
        "InputError",
        "InternalError",
        "TopoVerifyError",
    ),
    "robot.limits": ("Limits",),
    "robot.events": ("Policies", "Robot"),
    "robot.percept": ("Percept",),
    "campaign.judge": ("Report", "assert_maps", "examine"),
    "search_entry": ("SearchEntry", "SearchInterrupted", "search"),
    "studies.log_file": ("read_log",),
    "studies.log_report": ("Certificate", "certify"),
    "campaign.run": ("Exploration", "explore"),
    "world.enumeration.classes": ("WorldClass",),
    "world.enumeration.pruned": ("worlds",),
    "world.resolve": ("resolve_world",),
    "world.rooted_map": ("World",),
}

_PACKAGES = {"families": "topo_verify.world.families", "strategies": "topo_verify.strategies"}

_HOME = {name: f"topo_verify.{module}" for module, names in _MODULES.items() for name in names}


def __getattr__(name: str) -> Any:
    if name in _PACKAGES:
        return import_module(_PACKAGES[name])
    if name not in _HOME:
        raise AttributeError(f"module 'topo_verify' has no attribute {name!r}")
    if "hypothesis" in sys.modules:
        # Imported now: Hypothesis's first example has a deadline.
        import_module("topo_verify.campaign.judge")
    value = globals()[name] = getattr(import_module(_HOME[name]), name)
    return value


def __dir__() -> list[str]:
    return __all__
