"""Loads a mapper by its text: `package.module:attribute`, `path/file.py:attribute`, a library.

Source: docs/semantics.md, section 16.
"""

from __future__ import annotations

import ast
import importlib
import importlib.util
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib.machinery import SourceFileLoader
from pathlib import Path
from types import CodeType
from typing import Any, Protocol, cast

from topo_verify import extras
from topo_verify.errors import InputError, close_name
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


def is_library(target: Target) -> bool:
    """Whether this is a native mapper, a function of machine code."""
    return target.text.startswith(library.LIBRARY)


def load(text: str) -> Mapper:
    """The mapper at `package.module:attribute`, `path/file.py:attribute` or `--library PATH`.

    The attribute may be dotted. A key of a mapping counts as its attribute.

    Raises:
        InputError: there is no such module, file or attribute, or it cannot be called.
    """
    if text.startswith(library.LIBRARY):
        return library.NativeMapper(native_function(text))
    mapper = object_at(text)
    for maker in extras.function_makers():
        if maker.makes(mapper):
            raise InputError(f"target {text!r} {maker.words}: give it as --library {text}")
    if not callable(mapper):
        raise InputError(
            f"target {text!r}: expected a callable that takes a robot, got {type(mapper).__name__}"
        )
    return mapper


class FunctionMaker(Protocol):
    """A kind of TARGET that an extra brings: it makes functions of machine code out of a file.

    Attributes:
        words: what is said of such a function, as in `is compiled by …`.
    """

    words: str

    def makes(self, mapper: object) -> bool:
        """Is this loaded object such a function?"""
        ...

    def shows(self, path: str, name: str) -> bool:
        """Whether the source of a file shows that its function `name` is one."""
        ...

    def function(self, text: str) -> Any:
        """The function of a native mapper, made once in this process, as a ctypes object."""
        ...


def maker_of(path: str) -> FunctionMaker | None:
    """What makes functions out of a file with this ending; None: it is a shared library."""
    maker: FunctionMaker | None = extras.function_maker(Path(path).suffix)
    return maker


def native_function(text: str) -> Any:
    """The function of a native mapper as a ctypes object, valid as long as this process.

    Raises:
        InputError: there is no such function, or it cannot be compiled.
    """
    maker = maker_of(library.library_file(text)[0])
    if maker is None:
        return library.library_function(text)
    function = maker.function(text)
    library.confine()
    return function


def prepare(text: str) -> None:
    """Compile a native mapper before this process forks, if it is one to compile."""
    if text.startswith(library.LIBRARY):
        maker = maker_of(library.library_file(text)[0])
        if maker is not None:
            maker.function(text)


def object_at(text: str) -> object:
    """What stands at `package.module:attribute` or `path/file.py:attribute`."""
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


def require_file(text: str) -> None:
    """Raise an InputError if the TARGET names a file of Python that is not there."""
    place = text.rpartition(":")[0]
    if place.endswith(".py") and not Path(place).is_file():
        raise InputError(f"target {text!r}: there is no file {str(Path(place))!r}")


def _load_file(path: Path, text: str) -> object:
    require_file(text)
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


# ---------------------------------------------------------------- hints for a misspelled TARGET


SHOWN = 5
"""Most names that are listed if none is close."""


def close_attribute(whole: object, name: str) -> str:
    """A hint: the closest attribute, else the first candidates, if any."""
    known = [key for key in _callables(whole) if not key.startswith("_")]
    return close_name(name, known) or (f"; it has {_listed(known)}" if known else "")


def _listed(names: Sequence[str]) -> str:
    more = ", …" if len(names) > SHOWN else ""
    return ", ".join(names[:SHOWN]) + more


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
