"""What a mapper's process has loaded: files and distributions, so that results can name them.

A file counts if a module was loaded from it, or if Python opened it for reading after `watch`. Left
out are the standard library, installed distributions (they count by their versions) and topo_verify
itself. Files are hashed when `loaded` is called.

What this does not show: files that C code opens by itself; what comes from a network, a clock or
another process.
"""

from __future__ import annotations

import os
import sys
import sysconfig
from functools import cache
from hashlib import sha256
from importlib import metadata
from pathlib import Path

import msgspec

from topo_verify import errors

_PACKAGE = Path(errors.__file__).resolve().parent

_opened: dict[str, None] = {}
"""The absolute paths opened for reading since `watch`, in their order."""


class Loaded(msgspec.Struct, frozen=True):
    """What a mapper's process has loaded.

    Attributes:
        files: absolute path to SHA-256 of its content; empty for a file that is gone.
        distributions: the name of each installed distribution that was imported to its version.
    """

    files: dict[str, str]
    distributions: dict[str, str]


@cache
def watch() -> None:
    """From now on note every file that Python opens for reading in this process."""
    sys.addaudithook(_note)


def _note(event: str, arguments: tuple[object, ...]) -> None:
    if event != "open":
        return
    path, _, flags = arguments
    writes = isinstance(flags, int) and flags & os.O_ACCMODE == os.O_WRONLY
    if isinstance(path, str | bytes) and not writes:
        _opened.setdefault(_absolute(os.fsdecode(path)))  # now: the folder may change


def loaded() -> Loaded:
    """What this process has loaded until now."""
    paths = [getattr(module, "__file__", None) for module in list(sys.modules.values())]
    found = {_absolute(path) for path in paths if isinstance(path, str)} | _opened.keys()
    files = {path: _hash(path) for path in sorted(found) if is_users(path) and _is_file(path)}
    return Loaded(files, _distributions())


@cache
def is_users(path: str) -> bool:
    """Whether a file belongs to neither Python, nor an installed distribution, nor topo_verify."""
    place = Path(path).resolve()
    if {"site-packages", "dist-packages"} & {*place.parts, *Path(path).parts}:
        return False
    if place.is_relative_to("/proc") or place.is_relative_to("/sys"):
        return False
    return not any(place.is_relative_to(home) for home in (_PACKAGE, *_standard()))


@cache
def _standard() -> tuple[Path, ...]:
    paths = sysconfig.get_paths()
    return tuple({Path(paths[name]).resolve() for name in ("stdlib", "platstdlib")})


def _absolute(path: str) -> str:
    return os.path.abspath(path)  # noqa: PTH100  as it was named: `resolve` follows links


def _is_file(path: str) -> bool:
    return not Path(path).exists() or Path(path).is_file()  # no folder, no device


def _hash(path: str) -> str:
    try:
        return sha256(Path(path).read_bytes()).hexdigest()
    except OSError:
        return ""


def _distributions() -> dict[str, str]:
    """The installed distributions of the modules that are loaded, and their versions."""
    known = metadata.packages_distributions()
    names = {name.partition(".")[0] for name in sys.modules}
    used = {dist for name in names for dist in known.get(name, ())}
    return {name: metadata.version(name) for name in sorted(used) if name != "topo-verify"}
