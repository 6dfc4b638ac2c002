"""A hash of a mapper's sources, so that results of different sources are never added up.

For an algorithm of the catalogue these are the parts of topo_verify that decide what a search
finds. For a user's mapper these, its own file, the neighbours that it imports (files in the same
folder or package), and theirs. For a program, the files that its command names.

What this does not see: imports by a computed name, data that a mapper reads, libraries.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterable, Iterator
from functools import cache
from hashlib import sha256
from pathlib import Path

import msgspec

from topo_verify import errors
from topo_verify.algorithms import Algorithm
from topo_verify.harness.targets import fingerprint
from topo_verify.programs.foreign import Foreign
from topo_verify.programs.loader import Target
from topo_verify.programs.program import Program

_PACKAGE = Path(errors.__file__).resolve().parent

DECIDE = ("algorithms", "checkers", "harness", "programs", "robot", "world")
"""The parts of topo_verify whose change may change what a search finds."""


def source_hash(mappers: Iterable[Target]) -> str:
    """The hash of these mappers' sources, as they are in the files now, in hexadecimal."""
    digest = sha256(_own().encode())
    for mapper in mappers:
        if isinstance(mapper.mapper, Foreign):
            digest.update(msgspec.json.encode(mapper.mapper.loaded()))
        elif isinstance(mapper.mapper, Program):
            digest.update(fingerprint(mapper.text).encode())
        elif not isinstance(mapper.mapper, Algorithm):
            for name, text in sorted(_sources(mapper).items()):
                digest.update(f"\0{name}\0".encode() + sha256(text).digest())
    return digest.hexdigest()


@cache
def _own() -> str:
    """The hash of the parts of topo_verify that decide what a search finds."""
    digest = sha256()
    for part in DECIDE:
        place = _PACKAGE / part
        for path in sorted(place.rglob("*.py")) if place.is_dir() else [place]:
            digest.update(f"\0{path.relative_to(_PACKAGE)}\0".encode() + path.read_bytes())
    return digest.hexdigest()


def _sources(mapper: Target) -> dict[str, bytes]:
    """The mapper's files, by their place in the folder from which they are imported."""
    name = getattr(mapper.mapper, "__module__", None) or type(mapper.mapper).__module__
    file = getattr(sys.modules.get(name), "__file__", None)
    if file is None:
        return {}
    home = Path(file).resolve()
    depth = 0 if name.startswith("_") else name.count(".") + (home.name == "__init__.py")
    root = home.parents[min(depth, len(home.parents) - 1)]
    found: dict[Path, bytes] = {}
    todo = [home]
    while todo:
        path = todo.pop()
        if path not in found and path.is_file() and not path.is_relative_to(_PACKAGE):
            found[path] = path.read_bytes()
            todo += _neighbours(path, found[path], root)
    return {str(path.relative_to(root)): text for path, text in found.items()}


def _neighbours(path: Path, text: bytes, root: Path) -> Iterator[Path]:
    """The paths at which a file's imports would stand if they were neighbours of it."""
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError):  # no Python: then nothing is imported either
        return
    for node in ast.walk(tree):
        names: list[str] = []
        start = root
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            start = path.parents[node.level - 1] if 0 < node.level <= len(path.parents) else root
            module = [node.module] if node.module else []
            names = [".".join([*module, alias.name]) for alias in node.names]
        for name in names:
            place = start
            for part in name.split("."):
                place /= part
                yield place.with_suffix(".py")
                yield place / "__init__.py"
