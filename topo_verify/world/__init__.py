"""Worlds: rooted maps, their enumeration, families and file formats.

`rooted_map.py` and `enumeration/` are trusted.
"""

from topo_verify.world.enumeration import rank_order
from topo_verify.world.rooted_map import World

# rooted_map.py    World: rotations and a marker; genus, canonical code, ids
# validation.py    refuses what does not make a world
# least_cost.py    the least cost of a proof; unrooted.py, twins.py: worlds without their marker
# enumeration/, families/, formats/
# io.py            reads and writes files; resolve.py: WORLD on a command line

__all__ = ["World", "rank_order"]
