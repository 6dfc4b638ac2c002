"""Worlds: what they are, how many there are, where they come from. Trusted.

A robot and a mapper never see this package; checkers, searches and commands all speak of its
`World`.
"""

from topo_verify.world import families, io
from topo_verify.world.enumeration import rank_order
from topo_verify.world.rooted_map import World

# rooted_map.py         World: rotations and a marker; faces, genus, canonical code, ids
# validation.py         what is no world, and why
# enumeration/          every world of a size or a class: counted, listed in order, ranked, drawn
# families/             lattices, tori, solids, shapes, random graphs and maps
# formats/              world JSON, planar_code, NetworkX, GraphML, SUMO: one file a format
# io.py                 which format a file has
# resolve.py            WORLD on a command line: a path, an id, family:…, nyc, -
# data/                 the street network that comes with the package

World.formats = io

__all__ = ["World", "families", "rank_order"]
