"""Loading of a mapper by its text, `package.module:attribute` or `path/file.py:attribute`.

Source: docs/semantics.md, section 16.
"""

from __future__ import annotations

import importlib
import importlib.util
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from importlib.machinery import SourceFileLoader
from pathlib import Path
from types import CodeType
from typing import cast

from topo_verify.errors import InputError
from topo_verify.programs.hints import close_attribute
from topo_verify.robot.events import Robot

Mapper = Callable[[Robot], object]
"""Takes a robot and returns a map: `vertices`, `edges`, `marker`, and optionally `cost`."""


@dataclass(frozen=True, slots=True)
class Target:
    """A mapper, and the text by which the command line finds it again."""

    text: str
    mapper: Mapper


def load(text: str) -> Mapper:
    """The mapper at `package.module:attribute` or `path/file.py:attribute`.

    The attribute may be dotted. A key of a mapping counts as its attribute.

    Raises:
        InputError: there is no such module, file or attribute, or it cannot be called.
    """
    place, _, attribute = text.rpartition(":")
    found = _load_file(Path(place), text) if place.endswith(".py") else _load_module(place, text)
    for name in attribute.split("."):
        try:
            found = _attribute(found, name)
        except AttributeError:
            raise InputError(
                f"target {text!r}: {place} has no attribute {attribute!r}"
                f"{close_attribute(found, name)}"
            ) from None
    if not callable(found):
        raise InputError(
            f"target {text!r}: expected a callable that takes a robot, got {type(found).__name__}"
        )
    return found


def _attribute(whole: object, name: str) -> object:
    """An entry of a mapping, else an attribute of an object."""
    if not isinstance(whole, Mapping):
        return getattr(whole, name)
    entries = cast("Mapping[str, object]", whole)
    return entries[name] if name in entries else getattr(entries, name)


def _load_module(name: str, text: str) -> object:
    with suppress(FileNotFoundError):  # the working folder was removed
        if "" not in sys.path and str(Path.cwd()) not in sys.path:
            sys.path.insert(0, str(Path.cwd()))  # a console script lacks it
    try:
        return importlib.import_module(name)
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt):
            raise
        raise InputError(f"target {text!r}: cannot import {name!r}: {_one_line(error)}") from error


class _UncachedLoader(SourceFileLoader):
    """Compiles the source each time, and writes no bytecode beside it.

    Python takes bytecode for current if the source has the same second and size: a mapper that is
    edited and run twice in a second would be the old one.
    """

    def get_code(self, fullname: str) -> CodeType:  # noqa: ARG002  given by the base class
        """The code of the source as it is now."""
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
        sys.path.insert(0, folder)  # so that the file can import modules beside it
    sys.modules[name] = module  # before it runs: dataclasses look their module up here
    try:
        loader.exec_module(module)
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt):
            raise
        raise InputError(f"target {text!r}: {str(path)!r} fails: {_one_line(error)}") from error
    return module


def _one_line(error: BaseException) -> str:
    """The type and the text of an exception on one line; its type alone if the text raises."""
    try:
        return f"{type(error).__name__}: {error}".replace("\n", " ")
    except Exception:  # noqa: BLE001  a foreign __str__ may raise anything
        return type(error).__name__
