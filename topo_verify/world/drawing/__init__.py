"""Pictures of worlds: the cyclic order of the edges at every vertex is the true one.

`lay_out` finds where everything lies, `to_svg` draws it, and `read_back` reads the finished picture
and compares it with the world. This room is imported late: it loads numpy.
"""

from topo_verify.world.drawing.choice import lay_out
from topo_verify.world.drawing.export import FORMATS, document, format_of
from topo_verify.world.drawing.layout import Bridge, Layout
from topo_verify.world.drawing.svg import to_svg

# choice.py     chooses how a world is drawn, and tries again until the picture is true
# layout.py     Layout: where vertices, edges and bridges lie
# given.py      the positions of the world's file
# trees.py      trees with straight edges; springs.py spreads them evenly
# torus_cell.py regular maps of the torus as a flat periodic cell
# ball.py       the part of a large world around a dart
# planar.py     any world as a plane map with bridges: a mesh over it, packed and polished
# plane_map.py  edges that do not fit cross others in dummies
# mesh.py       a triangulated disc over a plane map
# packing.py    a circle packing: a first injective map of the mesh
# polish.py     wished triangles and smooth edges, never a flip
# sparse.py     sparse linear equations
# fit.py        places in a plane as a layout: scaled, trimmed at the circles, with bridges
# svg.py        a layout as SVG, in colours for light and dark
# heat.py       a world coloured by a cost for each dart
# export.py     the picture as a file: SVG, PNG, PDF or HTML
# curves.py     SVG path data: made and flattened
# crossings.py  where flattened curves cross
# read_back.py  reads a finished SVG and says what in it is untrue

__all__ = ["FORMATS", "Bridge", "Layout", "document", "format_of", "lay_out", "to_svg"]
