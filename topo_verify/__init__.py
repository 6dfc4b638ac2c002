"""topo-verify: is this robot-mapping algorithm right? Reference, checkers, worlds, proofs.

import topo_verify as tv
world = tv.World.from_id("m5/17")
run = tv.explore(world, "enhancement-ii")
report = tv.examine(my_mapper, world)
"""

from typing import TYPE_CHECKING, Any

from topo_verify.algorithms import CATALOGUE, Algorithm
from topo_verify.certificate import Certificate, certify
from topo_verify.errors import ClaimFailed, InputError, InternalError, TopoVerifyError
from topo_verify.robot.limits import Limits
from topo_verify.robot.percept import Percept, Robot
from topo_verify.trial import Exploration, Report, assert_maps, examine, explore
from topo_verify.world import families
from topo_verify.world.rooted_map import World

if TYPE_CHECKING:
    from topo_verify import strategies

__version__ = "0.1.0"

__all__ = [
    "CATALOGUE",
    "Algorithm",
    "Certificate",
    "ClaimFailed",
    "Exploration",
    "InputError",
    "InternalError",
    "Limits",
    "Percept",
    "Report",
    "Robot",
    "TopoVerifyError",
    "World",
    "__version__",
    "assert_maps",
    "certify",
    "examine",
    "explore",
    "families",
    "strategies",
]


def __getattr__(name: str) -> Any:  # Hypothesis is loaded by those alone who ask for strategies
    if name == "strategies":
        import topo_verify.strategies

        return topo_verify.strategies
    raise AttributeError(f"module 'topo_verify' has no attribute {name!r}")
