"""Worlds: what they are, how many there are, where they come from. Trusted.

A robot and a mapper never see this package; checkers, searches and commands all speak of its
`World`.
"""

from topo_verify.world import counting, families
from topo_verify.world.rooted_map import World

# rooted_map.py         World: rotations and a marker; faces, genus, canonical code, ids
# validation.py         what is no world, and why
# counting.py           all rooted maps: how many, which number, which by number, listed, drawn
# counting_by_genus.py  how many there are on each surface
# classes.py            CLASS: planar, genus:1, simple, …
# families/             lattices, tori, solids, shapes, random graphs and maps
# formats/              world JSON, planar_code, NetworkX, GraphML, SUMO
# naming.py             WORLD: a path, an id, family:…, nyc, -
# data/                 the street network that comes with the package

__all__ = ["World", "counting", "families"]
