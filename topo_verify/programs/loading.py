"""A mapper found by its text: `package.module:attribute` or `path/file.py:attribute`.

Source: docs/semantics.md, section 16.
"""

from __future__ import annotations

import importlib
import importlib.util
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import cast

from topo_verify.errors import InputError
from topo_verify.robot.simulator import SimulatedRobot

Mapper = Callable[[SimulatedRobot], object]
"""Takes a robot, returns a map: `vertices`, `edges`, `marker`, and perhaps `cost`."""


@dataclass(frozen=True, slots=True)
class Target:
    """A mapper, and the text by which the command line finds it again."""

    text: str
    mapper: Mapper


def load(text: str) -> Mapper:
    """The mapper at `package.module:attribute` or `path/file.py:attribute`.

    The attribute may be dotted; where an object is a mapping, its keys count as attributes.

    Raises:
        InputError: there is no such module, file or attribute, or it is not callable.
    """
    place, _, attribute = text.rpartition(":")
    found = _load_file(Path(place), text) if place.endswith(".py") else _load_module(place, text)
    for name in attribute.split("."):
        try:
            found = _attribute(found, name)
        except AttributeError:
            raise InputError(f"target {text!r}: {place} has no attribute {attribute!r}") from None
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
    if "" not in sys.path and str(Path.cwd()) not in sys.path:
        sys.path.insert(0, str(Path.cwd()))  # a console script does not look where the user stands
    try:
        return importlib.import_module(name)
    except (Exception, SystemExit) as error:
        raise InputError(f"target {text!r}: cannot import {name!r}: {_said(error)}") from error


def _load_file(path: Path, text: str) -> object:
    if not path.is_file():
        raise InputError(f"target {text!r}: there is no file {str(path)!r}")
    name = f"_topo_verify_target_{path.resolve().stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None, "a name that ends in .py has a loader"
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    folder = str(path.resolve().parent)
    if folder not in sys.path:
        sys.path.insert(0, folder)  # so that the file can import its neighbours
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        raise InputError(f"target {text!r}: {str(path)!r} fails: {_said(error)}") from error
    return module


def _said(error: BaseException) -> str:
    """An exception on one line, also one whose text cannot be had."""
    try:
        return f"{type(error).__name__}: {error}".replace("\n", " ")
    except Exception:  # noqa: BLE001  it is somebody else's __str__
        return type(error).__name__
