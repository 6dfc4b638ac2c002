"""How long pictures of worlds take, and how readable they are, beside what is required.

    OPENBLAS_NUM_THREADS=1 .venv/bin/python benchmarks/pictures.py

Processor seconds on one core. `angle` is the smallest angle between two darts of a vertex in
degrees, `radius` that of a vertex in thousandths of the picture's longer side.
"""

from __future__ import annotations

from time import process_time

from topo_verify.pictures.drawing import lay_out, read_back, to_svg
from topo_verify.world.resolve import resolve_world
from topo_verify.world.rooted_map import World

REQUIRED: dict[str, tuple[float, tuple[str, ...]]] = {
    "structured, to 50 vertices": (
        0.5,
        (
            *(
                "nyc",
                "lattice(7,7)",
                "king(6,6)",
                "torus(6,8)",
                "triangular_torus(6,8)",
                "star(49)",
            ),
            *("hexagonal_torus(5,5)", "dodecahedron()", "icosahedron()", "prism(25)", "wheel(49)"),
            *("cycle(50)", "star(49)", "random_tree(49,seed=1)"),
        ),
    ),
    "structured, to 300 vertices": (
        5.0,
        (
            *(
                "lattice(17,17,holes=0.1)",
                "king(17,17)",
                "torus(15,20)",
                "prism(150)",
                "cycle(300)",
            ),
            *("triangular_torus(15,20)", "star(299)", "wheel(299)"),
            *("prism(150)", "cycle(300)", "random_tree(299,seed=1)"),
        ),
    ),
    "random maps of 20 edges": (
        1.0,
        tuple(f"random_genus(20,{genus},seed={seed})" for genus in range(4) for seed in range(5)),
    ),
    "random maps of 60 edges": (
        4.0,
        tuple(f"random_genus(60,{genus},seed={seed})" for genus in range(4) for seed in range(5)),
    ),
    "others": (
        4.0,
        ("complete(7,seed=1)", "complete(9,seed=1)", "regular(50,3,seed=1)", "dense(20,0.3)"),
    ),
}
"""Groups of worlds, each with the seconds allowed for a picture."""


def main() -> None:
    lay_out(World.from_id("m5/17"))  # what is imported late
    lay_out(resolve_world("family:random_planar(100)"))
    print("| worlds | number | required s | slowest s | mean s | slowest is | angle | radius |")
    print("| --- | ---: | ---: | ---: | ---: | --- | ---: | ---: |")
    for group, (required, names) in REQUIRED.items():
        took: dict[str, float] = {}
        angles: list[float] = []
        radii: list[float] = []
        for name in names:
            world = resolve_world(name if name == "nyc" else f"family:{name}")
            start = process_time()
            layout = lay_out(world)
            took[name] = process_time() - start
            picture = read_back.read(to_svg(world, layout))
            angles.append(read_back.smallest_angle(picture, world))
            radii.append(1000 * layout.radius / max(layout.width, layout.height))
        slowest = max(took, key=lambda name: took[name])
        mean = sum(took.values()) / len(took)
        print(
            f"| {group} | {len(names)} | {required} | {took[slowest]:.2f} | {mean:.2f} |"
            f" `{slowest}` | {min(angles):.1f} | {min(radii):.1f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
