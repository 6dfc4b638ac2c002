"""Resolves a WORLD argument of the command line to the world that it names.

| text | world |
| --- | --- |
| `-` | world JSON from standard input |
| `nyc` | the street network that comes with the package |
| `m5/17` | the world of that id |
| `family:lattice(10,10,holes=0.2,seed=7)` | the world of that family; arguments are numbers |
| anything else | the world in the file at that path; its ending says its format (io.py) |

The first row that fits counts. A file whose name fits an earlier row is named with `./` before it.
The text behind `family:` is parsed by calls.py and never run as Python.

Source: docs/semantics.md, section 16.
"""

from __future__ import annotations

import re
from importlib import resources
from pathlib import Path
from typing import IO

from topo_verify.errors import InputError
from topo_verify.text import shown
from topo_verify.world import calls
from topo_verify.world.families import FAMILIES
from topo_verify.world.formats import files, world_json
from topo_verify.world.rooted_map import World

_ID = re.compile(r"m[0-9]+/[0-9]+")
_FAMILY = calls.CallSyntax("family of worlds", "family:", "family:lattice(3,4,seed=7)")


def resolve_world(text: str, *, stdin: IO[bytes] | None = None) -> World:
    """The world that the text names.

    Args:
        text: a path, `-`, a world id, `family:…` or `nyc`.
        stdin: what `-` reads; default: standard input.
    Raises:
        InputError: there is no such world, or it cannot be read.
    """
    if text == "-":
        return _from_stream(files.standard_input() if stdin is None else stdin)
    if text == "nyc":
        return _street_network()
    if _ID.fullmatch(text):
        return World.from_id(text)
    if text.startswith("family:"):
        return calls.call(text.removeprefix("family:"), FAMILIES, _FAMILY)
    if not _exists(text):
        raise InputError(
            f"no such world: '{shown(text)}' is not a file; give a path, an id (m5/17), a family"
            " (family:lattice(10,10,holes=0.2,seed=7)), nyc (the street network of the package) or"
            " - (world JSON on standard input)"
        )
    return World.load(text)


def _from_stream(stream: IO[bytes]) -> World:
    name = "standard input"
    return world_json.decode(World, files.read_stream(stream, name=name), name=name)


def _street_network() -> World:
    file = resources.files("topo_verify.world") / "data" / "nyc_osmnx.json"
    return world_json.decode(World, file.read_bytes(), name="the street network of the package")


def _exists(path: str) -> bool:
    try:
        return bool(path) and Path(path).exists()
    except (OSError, ValueError):  # a folder without permission; a name that no file can have
        return False
