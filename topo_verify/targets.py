"""The TARGET of a command: a mapper by name, from a module or from a file.

    a catalogue name, several with commas, or `all` (those that are right in all worlds)
    package.module:attribute
    path/file.py:attribute

Source: docs/semantics.md, section 16.
"""

from __future__ import annotations

import importlib
import importlib.util
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from topo_verify.algorithms import CATALOGUE, Algorithm
from topo_verify.errors import InputError
from topo_verify.robot.simulator import SimulatedRobot

Mapper = Callable[[SimulatedRobot], object]
"""Takes a robot, returns a map: `vertices`, `edges`, `marker`, and perhaps `cost`."""


@dataclass(frozen=True, slots=True)
class Target:
    """A mapper, and the text by which the command line finds it again."""

    text: str
    mapper: Mapper


def targets(text: str, *, pick: str | None = None, order: str | None = None) -> tuple[Target, ...]:
    """The mappers that a TARGET names, in its order.

    Args:
        pick, order: policies for algorithms of the catalogue.
    Raises:
        InputError: no such algorithm, module, file, attribute or policy; it is not callable; or
            policies for a mapper that has none.
    """
    if ":" in text:
        return (_with_policies(Target(text, _load(text)), pick, order),)
    general = [name for name, algorithm in CATALOGUE.items() if algorithm.assumes is None]
    names = general if text == "all" else [name.strip() for name in text.split(",")]
    unknown = [name for name in names if name not in CATALOGUE]
    if unknown:
        raise InputError(
            f"no algorithm {unknown[0]!r}: there are {', '.join(CATALOGUE)} and all; a mapper of"
            " your own is package.module:attribute or path/file.py:attribute"
        )
    return tuple(_with_policies(Target(name, CATALOGUE[name]), pick, order) for name in names)


def one_target(
    mapper: Mapper | str | Target, *, pick: str | None = None, order: str | None = None
) -> Target:
    """The target that a callable or a text names; refuses a text that names several."""
    if isinstance(mapper, Target):
        return _with_policies(mapper, pick, order)
    if not isinstance(mapper, str):
        if not callable(mapper):
            raise InputError(f"{mapper!r} is no mapper: a mapper is a callable that takes a robot")
        return _with_policies(Target(_name(mapper), mapper), pick, order)
    found = targets(mapper, pick=pick, order=order)
    if len(found) != 1:
        raise InputError(f"{mapper!r} names {len(found)} mappers: name one")
    return found[0]


def _with_policies(target: Target, pick: str | None, order: str | None) -> Target:
    if pick is None and order is None:
        return target
    if not isinstance(target.mapper, Algorithm):
        raise InputError(
            f"{target.text} has no policies: --pick and --order are for algorithms of the catalogue"
        )
    try:
        return Target(target.text, target.mapper.with_policies(pick=pick, order=order))
    except ValueError as error:
        raise InputError(str(error)) from None


def _name(mapper: Mapper) -> str:
    """The text that finds a callable again, as far as there is one."""
    if isinstance(mapper, Algorithm):
        return mapper.name
    name = getattr(mapper, "__qualname__", type(mapper).__qualname__)
    module = getattr(mapper, "__module__", "__main__")
    if module == "__main__":  # a script: nobody else can import it by that name
        module = getattr(sys.modules[module], "__file__", None) or module
    return f"{module}:{name}"


def _load(text: str) -> Mapper:
    place, _, attribute = text.rpartition(":")
    module = _load_file(Path(place), text) if place.endswith(".py") else _load_module(place, text)
    found: Any = module
    for part in attribute.split("."):
        if not hasattr(found, part):
            raise InputError(f"target {text!r}: {place} has no attribute {attribute!r}")
        found = getattr(found, part)
    if not callable(found):
        raise InputError(f"target {text!r}: {attribute} is no callable; a mapper takes a robot")
    return found  # type: ignore[no-any-return]  # whatever it is, it is run as a mapper


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
