"""Pictures of worlds: the cyclic order of the edges at every vertex is the true one.

Imported late: it loads numpy.
"""

from topo_verify.world.drawing.choice import lay_out
from topo_verify.world.drawing.export import FORMATS, IN_NOTEBOOKS, document, format_of, image
from topo_verify.world.drawing.layout import Bridge, Layout
from topo_verify.world.drawing.svg import to_svg

# choice.py     how a world is drawn; balls
# layout.py     Layout: where everything lies; fits sketches
# straight.py   straight edges: given positions, trees; springs
# cells.py      surfaces cut open: regular tori, worlds with one face
# planar.py     any world as a plane map with bridges
# plane_map.py  plane maps and their meshes
# svg.py        a layout as SVG
# heat.py       a world coloured by a cost for each dart
# export.py     files: SVG, PNG, PDF or HTML
# curves.py     SVG path data and crossings
# arrays.py     names for arrays, linear equations
# read_back.py  compares a finished SVG with the world

__all__ = [
    "FORMATS",
    "IN_NOTEBOOKS",
    "Bridge",
    "Layout",
    "document",
    "format_of",
    "image",
    "lay_out",
    "to_svg",
]
