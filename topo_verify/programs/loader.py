"""Loads a mapper by its text: `package.module:attribute`, `path/file.py:attribute`, a library.

Source: docs/semantics.md, section 16.
"""

from __future__ import annotations

import ast
import ctypes
import importlib
import importlib.util
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from importlib.machinery import SourceFileLoader
from pathlib import Path
from types import CodeType
from typing import Any, cast

from topo_verify.errors import InputError, close_name, shown
from topo_verify.programs import library
from topo_verify.programs.delivery import loading_text
from topo_verify.robot.events import Robot

Mapper = Callable[[Robot], object]
"""Takes a robot and returns a map: `vertices`, `edges`, `marker`, and optionally `cost`."""


@dataclass(frozen=True, slots=True)
class Target:
    """A mapper and its text on the command line."""

    text: str
    mapper: Mapper


def load(text: str) -> Mapper:
    """The mapper at `package.module:attribute`, `path/file.py:attribute` or `--library PATH`.

    The attribute may be dotted. A key of a mapping counts as its attribute.

    Raises:
        InputError: there is no such module, file or attribute, or it cannot be called.
    """
    if text.startswith(library.LIBRARY):
        return library.NativeMapper(native_function(text))
    mapper = _found(text)
    if is_jitted(mapper):
        raise InputError(f"target {text!r} is compiled by numba: give it as --library {text}")
    if not callable(mapper):
        raise InputError(
            f"target {text!r}: expected a callable that takes a robot, got {type(mapper).__name__}"
        )
    return mapper


def native_function(text: str) -> Any:
    """The function of a native mapper as a ctypes object, valid as long as this process.

    Raises:
        InputError: there is no such function, or numba cannot compile it.
    """
    if not is_python(text):
        return library.library_function(text)
    function = compiled_once(text)
    library.confine()
    return function


def is_python(text: str) -> bool:
    """Is this native mapper a function that numba compiles?"""
    return text.startswith(library.LIBRARY) and library.library_file(text)[0].endswith(".py")


@cache
def compiled_once(text: str) -> Any:
    """The function of a native mapper in a Python file; raises as `native_function`."""
    place = ":".join(library.library_file(text))
    return jitted_function(_found(place), f"--library {place}")


def _found(text: str) -> object:
    place, _, attribute = text.rpartition(":")
    value = _load_file(Path(place), text) if place.endswith(".py") else _load_module(place, text)
    for name in attribute.split("."):
        try:
            value = _attribute(value, name)
        except AttributeError:
            raise InputError(
                f"target {text!r}: {place} has no attribute {attribute!r}"
                f"{close_attribute(value, name)}"
            ) from None
    return value


def _attribute(whole: object, name: str) -> object:
    if not isinstance(whole, Mapping):
        return getattr(whole, name)
    entries = cast("Mapping[str, object]", whole)
    return entries[name] if name in entries else getattr(entries, name)


def _load_module(name: str, text: str) -> object:
    with suppress(FileNotFoundError):
        if "" not in sys.path and str(Path.cwd()) not in sys.path:
            sys.path.insert(0, str(Path.cwd()))
    try:
        return importlib.import_module(name)
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt):
            raise
        raise InputError(
            f"target {text!r}: cannot import {name!r}: {loading_text(error)}"
        ) from error


class _UncachedLoader(SourceFileLoader):
    """Compiles the source each time.

    Bytecode counts as current if the source has the same second and size, so a mapper edited and
    run twice in a second would be the old one.
    """

    def get_code(self, fullname: str) -> CodeType:  # noqa: ARG002  given by the base class
        """The code of the present source."""
        return self.source_to_code(self.get_data(self.path), self.path)


def _load_file(path: Path, text: str) -> object:
    if not path.is_file():
        raise InputError(f"target {text!r}: there is no file {str(path)!r}")
    name = f"_topo_verify_target_{path.resolve().stem}"
    loader = _UncachedLoader(name, str(path))
    spec = importlib.util.spec_from_file_location(name, path, loader=loader)
    assert spec is not None, "it has a loader"
    module = importlib.util.module_from_spec(spec)
    folder = str(path.resolve().parent)
    if folder not in sys.path:
        sys.path.insert(0, folder)
    sys.modules[name] = module  # before it runs: dataclasses look their module up here
    try:
        loader.exec_module(module)
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt):
            raise
        raise InputError(f"target {text!r}: {str(path)!r} fails: {loading_text(error)}") from error
    return module


# ---------------------------------------------------------------- functions by numba


_lasting: list[object] = []
"""The compiled functions, which own their machine code."""


def is_jitted(function: object) -> bool:
    """Does numba compile this function?"""
    module = sys.modules.get("numba.core.dispatcher")
    return module is not None and isinstance(function, module.Dispatcher)


def jitted_function(function: Any, where: str) -> Any:
    """A function compiled by numba, as a ctypes object.

    Args:
        where: the beginning of the error message.
    Raises:
        InputError: it is no such function, or numba cannot compile it for a robot.
    """
    if not is_jitted(function):
        raise InputError(
            f"{where}: expected a function compiled by numba, got {type(function).__name__}: put"
            " @numba.njit above it, or give it as a TARGET without --library"
        )
    # Numba freezes globals, so a call leaves to the next one only what hides behind an address.
    from numba import cfunc, types
    from numba.core.errors import NumbaError

    def call(robot: int) -> None:
        function(robot)

    try:
        machine_code: Any = cfunc(types.void(types.int64))(call)
    except NumbaError as error:
        raise InputError(f"{where}: numba cannot compile it: {_reason(str(error))}") from error
    _lasting.append(machine_code)
    return ctypes.CFUNCTYPE(None, ctypes.c_void_p)(machine_code.address)


def _reason(text: str) -> str:
    lines = [line.strip() for line in text.splitlines()]
    reasons = [line for line in lines if line and not line.startswith("Failed in ")]
    first = next((line for line in reasons if re.match(r"\w+Error: ", line)), reasons[0])
    places = [line.rstrip(":") for line in lines if re.match(r'File ".*", line \d+', line)]
    theirs = [place for place in places if "topo_verify/" not in place]
    return shown("; ".join((first.rstrip("."), *theirs[-1:])), limit=400)


# ---------------------------------------------------------------- hints for a misspelled TARGET


SHOWN = 5
"""Most names that are listed if none is close."""


def close_attribute(whole: object, name: str) -> str:
    """A hint: the closest attribute, else the first candidates, if any."""
    known = [key for key in _callables(whole) if not key.startswith("_")]
    return close_name(name, known) or (f"; it has {_listed(known)}" if known else "")


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names[:SHOWN]) + ", …" * (len(names) > SHOWN)


def _callables(whole: object) -> list[str]:
    if isinstance(whole, Mapping):
        return [
            key for key, value in cast("Mapping[str, object]", whole).items() if callable(value)
        ]
    entries: dict[str, object] = getattr(whole, "__dict__", {})
    home = getattr(whole, "__name__", None)
    return [
        key
        for key, value in entries.items()
        if callable(value) and getattr(value, "__module__", None) == home
    ]


def missing_attribute(name: str) -> str | None:
    """How to name a mapper in a file, if `name` is a file or a module in the current folder."""
    place = Path(name) if name.endswith(".py") else Path(f"{name.replace('.', '/')}.py")
    if not place.is_file():
        return f"there is no file {name!r}" if name.endswith(".py") else None
    try:
        body = ast.parse(place.read_bytes()).body
    except (SyntaxError, ValueError, OSError):
        body = []
    makers = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
    found = [node for node in body if isinstance(node, makers) and node.name[0] != "_"]
    names = [node.name for node in sorted(found, key=lambda node: isinstance(node, ast.ClassDef))]
    first = "explore" if "explore" in names or not names else names[0]
    listed = f" (it has {_listed(names)})" if names else ""
    return f"{place} is a file; name a mapper in it, as {name}:{first}{listed}"
