"""What the strategies draw: sizes, repeats, planar worlds, and the time for an example.

.venv/bin/python benchmarks/strategies.py
"""

from __future__ import annotations

from statistics import median
from time import process_time

from topo_verify.strategies.sample import resolve_strategy, sample

CALLS = (
    "worlds()",
    "worlds(max_edges=30)",
    "worlds(min_edges=100)",
    "worlds(max_edges=30, simple=True)",
    "planar_worlds(max_edges=30)",
    "nonplanar_worlds(max_edges=30)",
    "tree_worlds(max_edges=30)",
    "lattices(max_edges=30)",
    "dense_worlds(max_edges=30)",
    "symmetric_worlds(max_edges=30)",
    "uniform_worlds(edges=12)",
)

NUMBER = 500


def main() -> None:
    """Print a row for each call."""
    print("| strategy | median edges | most edges | planar | different | ms an example |")
    print("| --- | ---: | ---: | ---: | ---: | ---: |")
    for call in CALLS:
        begin = process_time()
        worlds = sample(resolve_strategy(call), NUMBER)
        milliseconds = 1000 * (process_time() - begin) / NUMBER
        sizes = [len(world.edges) for world in worlds]
        planar = sum(world.is_planar for world in worlds) / NUMBER
        different = len({world.code for world in worlds}) / NUMBER
        print(
            f"| `{call}` | {median(sizes):.0f} | {max(sizes)} | {planar:.0%} | {different:.0%}"
            f" | {milliseconds:.1f} |"
        )


if __name__ == "__main__":
    main()
