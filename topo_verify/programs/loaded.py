"""What a mapper's process has loaded, so that results can name it.

A file counts if a module was loaded from it, or if Python opened it for reading after `watch`; of
installed distributions the versions count. Values are what files do not say: arguments of partials,
contents of closures, defaults, attributes.

What this does not show: files that C code or another process opens; the environment, a network or a
clock; what C code holds; values beyond the first `MOST_VALUES`.
"""

from __future__ import annotations

import os
import stat
import sys
import sysconfig
from collections.abc import Iterable, Iterator, Mapping
from functools import cache, partial
from hashlib import sha256
from importlib import metadata
from pathlib import Path
from types import CodeType, FunctionType, MethodType, ModuleType
from typing import Any, cast

import msgspec

from topo_verify import errors
from topo_verify.errors import InputError, is_utf8

_PACKAGE = str(Path(errors.__file__).resolve().parent)

_NO_FILES = ("/proc/", "/sys/", "/dev/")

_START_HOOKS = ("_distutils_hack",)
"""Modules that a .pth file of setuptools imports at the start of every Python, for any mapper."""


class Loaded(msgspec.Struct, frozen=True):
    """What a mapper's process has loaded.

    Attributes:
        files: absolute path -> SHA-256.
        distributions: name of each imported distribution -> version.
        values: a hash of what the mapper was made with; empty: not known.
        modules: module name -> its file, among `files`.
    Raises:
        InputError: a file name is not UTF-8, so no store can keep it.
    """

    files: dict[str, str] = {}
    distributions: dict[str, str] = {}
    values: str = ""
    modules: dict[str, str] = {}

    def __post_init__(self) -> None:
        for path in self.files:
            if not is_utf8(path):
                raise InputError(
                    f"the mapper read {path!r}: expected a name in UTF-8; rename the file or the"
                    " folder"
                )


# ---------------------------------------------------------------- files

_opened: dict[str, None] = {}
_hashes: dict[str, tuple[tuple[int, ...], str]] = {}  # by path: what identifies its contents


def watch() -> None:
    """From now on note every file that Python opens for reading in this process."""
    _opened.clear()
    _hook()


@cache
def _hook() -> None:
    sys.addaudithook(_note)  # for good: Python has no way to take one away


def _note(event: str, arguments: tuple[Any, ...]) -> None:
    if event == "open":
        path, _, flags = arguments
        if flags & os.O_ACCMODE == os.O_WRONLY or flags & os.O_TRUNC:
            return
    elif event in ("ctypes.dlopen", "sqlite3.connect"):
        path = arguments[0]
    else:
        return
    if hasattr(path, "__fspath__"):
        path = path.__fspath__()
    if isinstance(path, str | bytes) and path:
        _opened[os.path.abspath(os.fsdecode(path))] = None  # noqa: PTH100  far cheaper


def loaded(values: str = "") -> Loaded:
    """What this process has loaded and, since `watch`, opened for reading.

    Args:
        values: `values_hash` of the mapper when it was loaded.
    Raises:
        InputError: a file name is not UTF-8.
    """
    files: dict[str, str] = {}
    modules: dict[str, str] = {}
    tops: set[str] = set()
    for name, module in list(sys.modules.items()):
        path = getattr(module, "__file__", None)
        if isinstance(path, str):
            _enter(files, whole := os.path.abspath(path))  # noqa: PTH100
            if whole in files and name != "__main__":
                modules[name] = whole
            top = name.partition(".")[0]
            if _is_installed(path) and top not in _START_HOOKS:
                tops.add(top)
    for path in list(_opened):
        _enter(files, path)
    return Loaded(files, _versions(frozenset(tops)), values, modules)


def hashes(paths: Iterable[str]) -> dict[str, str]:
    """The hash of each file; paths that are not files are left out."""
    files: dict[str, str] = {}
    for path in paths:
        if (digest := file_hash(path)) is not None:
            files[os.path.abspath(path)] = digest  # noqa: PTH100
    return files


def file_hash(path: str) -> str | None:
    """The hash of a file's contents; None if it cannot be read."""
    try:
        now = os.stat(path)  # noqa: PTH116  far cheaper
        if not stat.S_ISREG(now.st_mode):
            return None
        state = (now.st_dev, now.st_ino, now.st_size, now.st_mtime_ns, now.st_ctime_ns)
        known, digest = _hashes.get(path, ((), ""))
        if known != state:
            digest = sha256(Path(path).read_bytes()).hexdigest()
            _hashes[path] = (state, digest)
    except (OSError, ValueError):
        return None
    return digest


def _enter(files: dict[str, str], path: str) -> None:
    if path in files or "__pycache__" in path or not is_users(path):
        return
    if (digest := file_hash(path)) is not None:
        files[path] = digest


@cache
def is_users(path: str) -> bool:
    """Does a file belong to neither Python, an installed distribution, nor topo_verify?"""
    if path.startswith(_NO_FILES) or _is_installed(path):
        return False
    real = os.path.realpath(path)
    return not any(f"{p}{os.sep}" == real[: len(p) + 1] for p in (_PACKAGE, *_standard()))


@cache
def _is_installed(path: str) -> bool:
    return any(part in ("site-packages", "dist-packages") for part in Path(path).parts)


@cache
def _standard() -> frozenset[str]:
    return frozenset(os.path.realpath(sysconfig.get_path(n)) for n in ("stdlib", "platstdlib"))


@cache
def _versions(tops: frozenset[str]) -> dict[str, str]:
    return dict(sorted(pair for top in tops for pair in _installing(top)))


@cache
def _installing(top: str) -> tuple[tuple[str, str], ...]:
    try:
        return ((top, metadata.version(top)),)  # most have one name; to list all takes long
    except metadata.PackageNotFoundError:
        return tuple((name, metadata.version(name)) for name in _distributions().get(top, ()))


@cache
def _distributions() -> Mapping[str, list[str]]:
    return metadata.packages_distributions()


# ---------------------------------------------------------------- values


MOST_VALUES = 10_000


def values_hash(mapper: object) -> str:
    """A hash of what a mapper was made with; call it before the mapper runs and changes values."""
    text = repr(list(_described(mapper, {})))
    return sha256(text.encode(errors="backslashreplace")).hexdigest()


def _described(value: object, visited: dict[int, object]) -> Iterator[str]:
    """A value as words that are the same in every process."""
    if isinstance(value, bool | int | float | complex | str | bytes | None):
        yield f"{type(value).__name__} {value!r}"
        return
    yield f"{type(value).__module__}.{type(value).__qualname__}"
    if id(value) in visited or len(visited) >= MOST_VALUES:
        return
    visited[id(value)] = value  # kept, so that no other value gets its id
    if isinstance(value, set | frozenset):
        members = cast("frozenset[object]", value)
        yield from sorted(" ".join(_described(member, dict(visited))) for member in members)
        return
    for part in _parts(value):
        yield from _described(part, visited)
    yield "."


def _parts(value: object) -> Iterator[object]:
    if isinstance(value, list | tuple):
        yield from cast("list[object]", value)
    elif isinstance(value, Mapping):
        for pair in cast("Mapping[object, object]", value).items():
            yield from pair
    elif isinstance(value, partial):
        call = cast("partial[object]", value)
        yield from (call.func, call.args, call.keywords)
    elif isinstance(value, MethodType):
        yield from (value.__func__, value.__self__)
    elif isinstance(value, FunctionType):
        yield from (value.__qualname__, value.__code__, value.__defaults__, value.__kwdefaults__)
        yield from (_content(cell) for cell in value.__closure__ or ())
        yield dict(value.__dict__)
    elif isinstance(value, CodeType):
        yield from (value.co_code, value.co_names, value.co_consts, value.co_freevars)
    elif isinstance(value, type | ModuleType):
        yield value.__name__
    else:
        yield dict(getattr(value, "__dict__", {}))


def _content(cell: Any) -> object:
    try:
        return cell.cell_contents
    except ValueError:
        return None
