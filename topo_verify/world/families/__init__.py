"""Families of worlds: well-known graphs, lattices, random graphs and maps, named by arguments.

The name of each world is the call that made it without its defaults, such as
`lattice(10,10,holes=0.2,seed=7)`; behind `family:` that text makes the same world again. All random
draws come from `random.Random(seed)`, so a world is the same on every machine whose Python draws
alike (3.11 to 3.13 do).

**Holes** are `round(holes·nodes)` nodes taken out at random. The largest component of the rest is
kept (of equally large ones, that with the lowest node), as in every family that may fall apart.

**The marker** is drawn from the same seed after everything else: a vertex, then one of its exits.
So an average over seeds is one over starting places too, and a lattice does not always start in
its corner. Random maps have the marker at their root (random_maps.py), families without a seed at
dart 0. `marker=DART` puts it elsewhere and changes nothing else.

**Rotations** follow the drawing if there is one (`lattice`, `king`: node 0 at the top left, exits
clockwise from the north, positions with y upwards; the tori, shapes and solids likewise, but
without positions). Random maps are drawn with their rotations. In the other families each vertex's
rotation is drawn uniformly.
"""

from collections.abc import Callable, Mapping

from topo_verify.world.families._arguments import MAX_DARTS
from topo_verify.world.families.lattices import (
    hexagonal_torus,
    king,
    king_torus,
    lattice,
    torus,
    triangular_torus,
)
from topo_verify.world.families.random_graphs import complete, complete_bipartite, dense, regular
from topo_verify.world.families.random_maps import random_genus, random_planar, random_tree
from topo_verify.world.families.shapes import (
    cube,
    cycle,
    dodecahedron,
    icosahedron,
    octahedron,
    path,
    prism,
    star,
    tetrahedron,
    wheel,
)
from topo_verify.world.rooted_map import World

# lattices.py       lattice, king, king_torus, torus, triangular_torus, hexagonal_torus
# random_graphs.py  regular, dense, complete, complete_bipartite
# random_maps.py    random_tree, random_planar, random_genus
# shapes.py         path, cycle, star, wheel, prism; the five Platonic solids
# _rotated_graph.py graphs with exits in clockwise order, and their worlds
# _arguments.py     checks and limits of arguments, names of worlds

FAMILIES: Mapping[str, Callable[..., World]] = {
    make.__name__: make
    for make in (
        *(lattice, king, king_torus, torus, triangular_torus, hexagonal_torus),
        *(regular, dense, complete, complete_bipartite),
        *(random_tree, random_planar, random_genus),
        *(path, cycle, star, wheel, prism),
        *(tetrahedron, cube, octahedron, dodecahedron, icosahedron),
    )
}
"""All families by name, as it may follow `family:`."""

__all__ = [
    "FAMILIES", "MAX_DARTS", "complete", "complete_bipartite", "cube", "cycle", "dense",
    "dodecahedron", "hexagonal_torus", "icosahedron", "king", "king_torus", "lattice",
    "octahedron", "path", "prism", "random_genus", "random_planar", "random_tree", "regular",
    "star", "tetrahedron", "torus", "triangular_torus", "wheel",
]  # fmt: skip
