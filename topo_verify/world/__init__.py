"""Worlds: rooted maps, their enumeration, families and file formats.

`rooted_map.py` and `enumeration/` are trusted. Robots hide worlds from mappers; checkers, searches
and commands all share this `World`.
"""

from topo_verify.world import families, io
from topo_verify.world.enumeration import rank_order
from topo_verify.world.rooted_map import World

# rooted_map.py         World: rotations and a marker; faces, genus, canonical code, ids
# permutations.py       the cycles of a permutation
# validation.py         refuses rotations, edges and markers that do not make a world
# least_cost.py         the least cost of proving a world's map, and a walk of that cost
# unrooted.py           how many worlds there are without their marker
# twins.py              another world that looks the same without the marker's direction
# enumeration/          every world of a size or a class: counted, listed in order, ranked, sampled
# families/             lattices, tori, solids, shapes, random graphs and maps
# formats/              world JSON, planar_code, NetworkX, GraphML, SUMO: one file a format
# drawing/              pictures with the true cyclic order; imported late, loads numpy
# io.py                 reads and writes files; their names say the format
# resolve.py            WORLD on a command line: a path, an id, family:…, nyc, -; calls
# data/                 the street network that comes with the package

World.formats = io
setattr(World, "_repr_html_", io.notebook)  # noqa: B010  the class knows no picture

__all__ = ["World", "families", "rank_order"]
