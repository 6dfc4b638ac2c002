"""Pictures of worlds: the cyclic order of the edges at every vertex is the true one.

Imported late: it loads numpy.
"""

from topo_verify.pictures.drawing.choice import WHOLE, lay_out, lay_out_known
from topo_verify.pictures.drawing.export import (
    FORMATS,
    IN_NOTEBOOKS,
    document,
    draw,
    format_of,
    image,
    notebook,
)
from topo_verify.pictures.drawing.layout import Bridge, Layout
from topo_verify.pictures.drawing.svg import to_svg

# choice.py     how a world is drawn: straight.py, cells.py, planar.py with plane_map.py
# layout.py     where everything lies; svg.py, export.py: the pictures of it
# read_back.py  compares a finished SVG with the world

__all__ = [
    "FORMATS",
    "IN_NOTEBOOKS",
    "WHOLE",
    "Bridge",
    "Layout",
    "document",
    "draw",
    "format_of",
    "image",
    "lay_out",
    "lay_out_known",
    "notebook",
    "to_svg",
]
