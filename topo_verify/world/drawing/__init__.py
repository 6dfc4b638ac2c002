"""Pictures of worlds: the cyclic order of the edges at every vertex is the true one.

`lay_out` finds where everything lies, `to_svg` draws it, and `read_back` reads the finished picture
and compares it with the world. This room is imported late: it loads numpy.
"""

from topo_verify.world.drawing.choice import lay_out
from topo_verify.world.drawing.export import FORMATS, IN_NOTEBOOKS, document, format_of, image
from topo_verify.world.drawing.layout import Bridge, Layout
from topo_verify.world.drawing.svg import to_svg

# choice.py     chooses how a world is drawn, and tries again until the picture is true; balls
# layout.py     Layout: where vertices, edges and bridges lie; sketches fitted to it
# straight.py   straight edges: the positions of the world's file, trees; springs spread them evenly
# cells.py      surfaces cut open: regular maps of the torus, worlds with one face as a 4g-gon
# planar.py     any world as a plane map with bridges: a mesh over it, packed and polished
# plane_map.py  edges that do not fit cross others in dummies; the mesh over such a map
# svg.py        a layout as SVG, in colours for light and dark, with the numbers of darts
# heat.py       a world coloured by a cost for each dart
# export.py     the picture as a file: SVG, PNG, PDF or HTML
# curves.py     SVG path data: made and flattened, and where it crosses
# arrays.py     names for arrays, sparse linear equations
# read_back.py  reads a finished SVG and says what in it is untrue

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
