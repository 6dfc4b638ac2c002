"""topo-verify: is this robot-mapping algorithm right? Reference, checkers, worlds, proofs.

import topo_verify as tv
world = tv.World.from_id("m5/17")
run = tv.explore(world, "enhancement-ii")
report = tv.examine(my_mapper, world)
"""

from topo_verify.algorithms import CATALOGUE, Algorithm
from topo_verify.certificate import Certificate, certify
from topo_verify.errors import ClaimFailed, InputError, InternalError, TopoVerifyError
from topo_verify.robot.limits import Limits
from topo_verify.robot.percept import Percept, Robot
from topo_verify.trial import Exploration, Report, assert_maps, examine, explore
from topo_verify.world import families
from topo_verify.world.rooted_map import World

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
]
