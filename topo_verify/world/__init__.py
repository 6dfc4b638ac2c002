"""Worlds: rooted maps, their enumeration, families and file formats.

`rooted_map.py` and `enumeration/` are trusted.
"""

from topo_verify.world import families, io
from topo_verify.world.enumeration import rank_order
from topo_verify.world.rooted_map import World

# rooted_map.py    World: rotations and a marker; genus, canonical code, ids
# validation.py    refuses what does not make a world
# least_cost.py    the least cost of a proof, and a walk of that cost
# unrooted.py      counts worlds without their marker
# twins.py         worlds that look the same without the marker's direction
# enumeration/     every world of a size or class
# families/        lattices, tori, solids, shapes, random graphs and maps
# formats/         world JSON, planar_code, NetworkX, GraphML, SUMO
# drawing/         pictures with the true cyclic order; loads numpy
# io.py            reads and writes files
# resolve.py       WORLD on a command line
# data/            the street network of the package

World.formats = io
setattr(World, "_repr_html_", io.notebook)  # noqa: B010  the class knows no picture

__all__ = ["World", "families", "rank_order"]
