"""Which worlds an unlimited walk determines: marker with direction, without it, no marker.

    .venv/bin/python -m research.twins 6 > docs/data/tables/twins.csv       # 20 s

A row for each number of edges and genus, then the shares. With the direction every world is
determined (docs/explanation/fold.md). For any other world a twin is made and walked beside it, or
the reason is known why there is none.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter

import topo_verify as tv
from topo_verify.world.twins import find_twin, no_twin


def main() -> None:
    """Print the table as CSV, and the smallest pairs of three classes to standard error."""
    ask = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    ask.add_argument("edges", type=int, help="worlds of 1 to this many edges")
    most: int = ask.parse_args().edges
    smallest: dict[str, str] = {}
    shares = ["edges,worlds,with direction,undirected,no marker"]
    print("edges,genus,worlds,directed,undirected,no marker")
    for m in range(1, most + 1):
        total, undirected, unmarked = Counter[int](), Counter[int](), Counter[int]()
        for world in tv.worlds(edges=m):
            twin, why = find_twin(world, "undirected")
            assert twin is not None or no_twin(world, "undirected") == why, world
            total[world.genus] += 1
            undirected[world.genus] += twin is None
            unmarked[world.genus] += no_twin(world, "none") != ""
            if twin is not None:
                simple = world.is_simple and twin.is_simple
                classes = {"any": True, "loopless": world.is_loopless, "simple": simple}
                for name in (name for name, holds in classes.items() if holds):
                    smallest.setdefault(name, f"{world.id} and {twin.id}")
        for genus in sorted(total):
            n = total[genus]
            print(f"{m},{genus},{n},{n},{undirected[genus]},{unmarked[genus]}", flush=True)
        numbers = [total.total(), undirected.total(), unmarked.total()]
        cells = [f"{100 * n / numbers[0]:.3g} %" for n in numbers]
        shares.append(f"{m},{numbers[0]},{','.join(cells)}")
    print("", *shares, sep="\n")
    print(smallest, file=sys.stderr)


if __name__ == "__main__":
    main()
