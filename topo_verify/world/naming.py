"""What a WORLD may be called on a command line, and the world that is meant.

| text | world |
| --- | --- |
| `-` | world JSON from standard input |
| `nyc` | the street network that comes with the package |
| `m5/17` | the world of that id |
| `family:lattice(10,10,holes=0.2,seed=7)` | of a family, arguments being numbers |
| anything else | a file, by its path; its ending says its format (formats/loading.py) |

The first line that fits counts; a file that is called like one of the others is named with `./`
before it. The text behind `family:` is taken apart here and never handed to Python.

Source: docs/semantics.md, section 16.
"""

from __future__ import annotations

import inspect
import re
import sys
from importlib import resources
from pathlib import Path
from typing import BinaryIO

from topo_verify.errors import InputError
from topo_verify.world.families import FAMILIES
from topo_verify.world.formats import files, world_json
from topo_verify.world.rooted_map import World

_ID = re.compile(r"m[0-9]+/[0-9]+")
_CALL = re.compile(r"family:(\w+)\(([^()]*)\)")
_NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_ARGUMENT = re.compile(rf"\s*(?:([a-z_]+)\s*=\s*)?({_NUMBER})\s*")

_LONGEST = 200
"""Letters in a family's text: more than any needs, and too few for a number that takes long."""


def world_from(text: str, *, stdin: BinaryIO | None = None) -> World:
    """The world that the text names.

    Args:
        text: a path, `-`, a world id, `family:…` or `nyc`.
        stdin: what `-` reads; default: standard input.
    Raises:
        InputError: no world is called so, or it cannot be read; one sentence says why.
    """
    if text == "-":
        return _from_stream(sys.stdin.buffer if stdin is None else stdin)
    if text == "nyc":
        return _street_network()
    if _ID.fullmatch(text):
        return World.from_id(text)
    if text.startswith("family:"):
        return _from_family(text)
    if not _exists(text):
        raise InputError(
            f"'{files.shown(text)}' names no world: no file of that name is to be seen; a world is"
            " a path, an id (m5/17), a family (family:lattice(10,10,holes=0.2,seed=7)), nyc (the"
            " street network of the package) or - (world JSON on standard input)"
        )
    return World.load(text)


def _from_stream(stream: BinaryIO) -> World:
    name = "standard input"
    return world_json.decode(World, files.read_stream(stream, name=name), name=name)


def _street_network() -> World:
    file = resources.files("topo_verify.world") / "data" / "nyc_osmnx.json"
    return world_json.decode(World, file.read_bytes(), name="the street network of the package")


def _exists(path: str) -> bool:
    try:
        return bool(path) and Path(path).exists()
    except (OSError, ValueError):  # where nobody may look; a name that no file can have
        return False


# ---------------------------------------------------------------- family:…


def _from_family(text: str) -> World:
    call = _CALL.fullmatch(text) if len(text) <= _LONGEST else None
    make = FAMILIES.get(call[1]) if call else None
    if call is None or make is None:
        raise InputError(
            f"'{files.shown(text, limit=60)}' names no family of worlds: after 'family:' stands"
            f" one of {', '.join(FAMILIES)} with numbers for arguments, as in"
            " family:lattice(3,4,seed=7)"
        )
    signature = inspect.signature(make)
    try:
        places, options = _arguments(call[2])
        bound = signature.bind(*places, **options)
    except TypeError as error:
        parameters = ", ".join(
            name if one.default is one.empty else f"{name}={one.default}"
            for name, one in signature.parameters.items()
        )
        raise InputError(
            f"'{files.shown(text)}': {files.shown(str(error))}; the family is"
            f" {call[1]}({parameters})"
        ) from error
    return make(*bound.args, **bound.kwargs)


def _arguments(text: str) -> tuple[list[float], dict[str, float]]:
    """Numbers by place and by name; where they are none, a TypeError, as from a call."""
    places: list[float] = []
    options: dict[str, float] = {}
    for part in text.split(",") if text.strip() else ():
        found = _ARGUMENT.fullmatch(part)
        if not found:
            raise TypeError(f"'{part.strip()}' is no number and no name=number")
        key, number = found.groups()
        value = int(number) if number.lstrip("+-").isdigit() else float(number)
        if key is None and options:
            raise TypeError(f"{number} stands behind an argument with a name")
        if key in options:
            raise TypeError(f"{key} is given twice")
        if key is None:
            places.append(value)
        else:
            options[key] = value
    return places, options
