"""Draws the pictures of docs/gallery.md into docs/gallery/: python docs/gallery.py.

The commands on the page make the same pictures one by one. Each is read back before it is written,
and tests/docs/test_site.py reads what is stored again.
"""

from __future__ import annotations

from pathlib import Path

from topo_verify.world.resolve import resolve_world

FOLDER = Path(__file__).with_name("gallery")

PICTURES = {
    # families, in the order of the page
    "lattice": "family:lattice(5,6,holes=0.2,seed=7)",
    "king": "family:king(3,4,holes=0.1,seed=1)",
    "torus": "family:torus(3,4)",
    "triangular_torus": "family:triangular_torus(3,3)",
    "hexagonal_torus": "family:hexagonal_torus(2,3)",
    "regular": "family:regular(8,3,seed=1)",
    "dense": "family:dense(6,0.6,seed=1)",
    "complete": "family:complete(5,seed=1)",
    "complete_bipartite": "family:complete_bipartite(3,3,seed=1)",
    "random_tree": "family:random_tree(14,seed=1)",
    "random_planar": "family:random_planar(14,seed=2)",
    "random_genus": "family:random_genus(10,2,seed=1)",
    "path": "family:path(5)",
    "cycle": "family:cycle(7)",
    "star": "family:star(6)",
    "wheel": "family:wheel(6)",
    "prism": "family:prism(5)",
    "tetrahedron": "family:tetrahedron()",
    "cube": "family:cube()",
    "octahedron": "family:octahedron()",
    "dodecahedron": "family:dodecahedron()",
    "icosahedron": "family:icosahedron()",
    "nyc": "nyc",
    "king_torus": "family:king_torus(3,3,holes=0.2,seed=1)",
    # genus 0 to 3, each with the fewest edges
    "m1-0": "m1/0",
    "m2-7": "m2/7",
    "m2-8": "m2/8",
    "m4-629": "m4/629",
    "m6-108770": "m6/108770",
    # worlds that other pages show
    "m3-14": "m3/14",
    "m4-94": "m4/94",
    "m4-183": "m4/183",
}
"""The name of each picture's file, and the WORLD that it shows."""


def main() -> None:
    """Write every picture."""
    FOLDER.mkdir(exist_ok=True)
    for name, world in PICTURES.items():
        resolve_world(world).draw(FOLDER / f"{name}.svg")


if __name__ == "__main__":
    main()
