"""How heavy each core dependency is: prints the table of docs/reference/dependencies.md.

Purpose, size of the installed files without .pyc, the same with all that it needs, and the
processor time of a first import, the median of five.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path
from statistics import median

from packaging.requirements import Requirement

ROOT = Path(__file__).resolve().parents[1]

PURPOSES = {
    "click": "the command line",
    "hypothesis": "the strategies of property tests; `verify`, `conform`: generated worlds",
    "msgspec": "worlds, events and messages: strict JSON, schemas",
    "networkx": "planarity, layouts; graphs in and out",
    "numpy": "pictures; folds of long logs",
    "pytest": "the plugin; property tests",
    "rich": "tables and progress in the terminal",
    "scipy": "pictures: sparse equations",
    "z3-solver": "`prove`, and the part `proofs` of `verify`",
}
"""What each core dependency is for; a test compares the names with pyproject.toml."""

MODULES = {"z3-solver": "z3", "scipy": "scipy.sparse.linalg"}
"""The imported name where it is not the distribution's."""

CLOCK = """
import time
begin = time.process_time()
import {module}
print(time.process_time() - begin)
"""


def core() -> list[str]:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return [Requirement(text).name for text in project["dependencies"]]


def size(name: str) -> int:
    files = metadata.distribution(name).files or []
    paths = [Path(str(file.locate())) for file in files if file.suffix != ".pyc"]
    return sum(path.stat().st_size for path in paths if path.is_file())


def needs(name: str) -> set[str]:
    """A distribution and all that it needs, by their normal names."""
    names, todo = set[str](), [name]
    while todo:
        needed = re.sub(r"[-_.]+", "-", todo.pop()).lower()
        if needed not in names:
            names.add(needed)
            todo += _required(needed)
    return names


def _required(name: str) -> Iterator[str]:
    for text in metadata.requires(name) or []:
        requirement = Requirement(text)
        if requirement.marker is None or requirement.marker.evaluate({"extra": ""}):
            yield requirement.name


def import_time(name: str) -> float:
    code = CLOCK.format(module=MODULES.get(name, name))
    line = [sys.executable, "-c", code]
    times = [
        float(subprocess.run(line, capture_output=True, text=True, check=True).stdout)  # noqa: S603  ours
        for _ in range(5)
    ]
    return median(times)


def main() -> None:
    print("| package | for | installed | with what it needs | import |")
    print("| --- | --- | ---: | ---: | ---: |")
    everything = set[str]()
    for name in core():
        needed = needs(name)
        everything |= needed
        megabytes = [f"{of / 1e6:.1f} MB" for of in (size(name), sum(map(size, needed)))]
        cells = [name, PURPOSES[name], *megabytes, f"{import_time(name):.2f} s"]
        print(f"| {' | '.join(cells)} |")
    whole = sum(map(size, everything)) / 1e6
    print(f"| topo_verify itself | | | {whole:.1f} MB | {import_time('topo_verify'):.2f} s |")


if __name__ == "__main__":
    main()
