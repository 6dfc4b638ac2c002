"""Families of worlds: well-known graphs, lattices, random graphs and maps.

A world's name is the call that makes it again, such as `lattice(10,10,holes=0.2,seed=7)`. All draws
come from `random.Random(seed)`, the same on every machine with Python 3.11 to 3.13. Arguments out
of range, and more than `MAX_DARTS` darts, raise `InputError`.

**Holes** are `round(holes·nodes)` nodes removed at random. The largest component stays; of equally
large ones, that with the lowest node.

**The marker** is drawn last: a vertex, then one of its exits. Random maps have it at their root,
families without a seed at dart 0. `marker=DART` changes nothing else.

**Rotations** follow the drawing if there is one: node 0 at the top left, exits clockwise from the
north, y upwards. Other families draw each vertex's rotation uniformly.
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

__all__ = [
    "FAMILIES", "MAX_DARTS", "complete", "complete_bipartite", "cube", "cycle", "dense",
    "dodecahedron", "hexagonal_torus", "icosahedron", "king", "king_torus", "lattice",
    "octahedron", "path", "prism", "random_genus", "random_planar", "random_tree", "regular",
    "star", "tetrahedron", "torus", "triangular_torus", "wheel",
]  # fmt: skip


def __dir__() -> list[str]:
    return __all__
