"""The one door to the extras: what each brings, where it is found, and which packages it needs.

An extra is a package in topo_verify/extra/ for what only some users need. It imports the main
house, and the main house never imports it: it asks here for a thing by name, and the module of that
thing is imported then. A new extra has its entries in the tables below; the line of a command in
--help stands with the others in cli/.

A place is `EXTRA.module:attribute`. Modules named in `COMMANDS` and `OPTIONS` load without the
packages of their extra, so that --help works; the extra calls `require` when its work begins.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from typing import Any

COMMANDS = {
    "arena": "arena.command:arena",
    "reproduce": "figures.command:reproduce",
}
"""The place of each command."""

OPTIONS: dict[str, tuple[str, ...]] = {
    "certify": ("certificates.options:certify",),
    "explore": ("fast.options:engine", "films.options:svg"),
    "prove": ("sat.options:solver", "sat.options:certify"),
    "record": ("fast.options:engine",),
    "replay": ("certificates.options:kernel",),
    "reproduce": ("fast.options:engine",),
    "search": ("dask.options:dask", "fast.options:search_engine"),
}
"""The places of the options that extras add to a command of the main house.

They stand in the extra's options.py, each a decorator made by click. The command gets their values
by name; what it asks of a value is a protocol in the file of the command.
"""

ENGINES = {"compiled": "fast.engine:COMPILED"}
"""The place of each engine beside the reference."""

FUNCTION_MAKERS = {".py": "fast.functions:JITTED"}
"""The place of what makes functions of machine code out of files with this ending."""

BACKENDS = {"cluster": "dask.backend:DaskBackend"}
"""The place of each backend that Python code asks for by name: made with an address."""

PACKAGES = {
    "dask": ("distributed",),
    "fast": ("numba",),
    "figures": ("matplotlib",),
}
"""The packages of other projects that an extra needs, by the names that Python imports."""


def found(place: str) -> Any:
    """The object at a place; its module is imported now."""
    module, _, attribute = place.partition(":")
    return getattr(import_module(f"topo_verify.extra.{module}"), attribute)


def engine(name: str) -> Any:
    """The engine of this name."""
    return found(ENGINES[name])


def usable_engines() -> tuple[str, ...]:
    """The names of the engines whose packages are installed."""
    return tuple(
        name for name, place in ENGINES.items() if not missing_packages(place.partition(".")[0])
    )


def function_maker(ending: str) -> Any:
    """What makes functions of machine code out of files with this ending, or None."""
    place = FUNCTION_MAKERS.get(ending)
    return None if place is None else found(place)


def function_makers() -> list[Any]:
    """All that make functions of machine code."""
    return [*map(found, FUNCTION_MAKERS.values())]


def backend(name: str) -> Any:
    """The class of this backend."""
    return found(BACKENDS[name])


def command(name: str) -> Any:
    """The click command of this name."""
    return found(COMMANDS[name])


Option = Callable[[Callable[..., int]], Callable[..., int]]
"""A decorator that adds an option to a command."""


def options(command: str, *names: str) -> Option:
    """The options that extras add to a command, in the order of the table.

    Args:
        names: of these attributes alone; by default all.
    """
    places = OPTIONS.get(command, ())
    if names:
        places = tuple(place for place in places if place.partition(":")[2] in names)
    added: list[Option] = [found(place) for place in places]

    def decorate(run: Callable[..., int]) -> Callable[..., int]:
        for add in reversed(added):
            run = add(run)
        return run

    return decorate


def missing_packages(extra: str) -> list[str]:
    """The packages that an extra needs and that are not installed."""
    return [name for name in PACKAGES.get(extra, ()) if find_spec(name) is None]


def require(extra: str, instead: str = "") -> None:
    """Check that the packages of an extra are installed.

    Args:
        instead: what else helps, for the error message.
    Raises:
        InputError: one is not; the sentence says what installs it.
    """
    from topo_verify.errors import InputError

    if missing := missing_packages(extra):
        raise InputError(
            f"the extra {extra} needs {' and '.join(missing)}: {sys.executable} -m pip install"
            f" 'topo-verify[{extra}]'{instead and f', or {instead}'}"
        )
