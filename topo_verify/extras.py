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
    "explore": ("films.options:svg",),
    "prove": ("sat.options:solver", "sat.options:certify"),
    "replay": ("certificates.options:kernel",),
    "search": ("dask.options:dask",),
}
"""The places of the options that extras add to a command of the main house.

They stand in the extra's options.py, each a decorator made by click. The command gets their values
by name; what it asks of a value is a protocol in the file of the command.
"""

BACKENDS = {"cluster": "dask.backend:DaskBackend"}
"""The place of each backend that Python code asks for by name: made with an address."""

PACKAGES = {
    "dask": ("distributed",),
    "figures": ("matplotlib",),
}
"""The packages of other projects that an extra needs, by the names that Python imports."""


def found(place: str) -> Any:
    """What is at a place; its module is imported now."""
    module, _, attribute = place.partition(":")
    return getattr(import_module(f"topo_verify.extra.{module}"), attribute)


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


def require(extra: str) -> None:
    """Check that the packages of an extra are installed.

    Raises:
        InputError: one is not; the sentence says what installs it.
    """
    from topo_verify.errors import InputError

    missing = [name for name in PACKAGES.get(extra, ()) if find_spec(name) is None]
    if missing:
        raise InputError(
            f"the extra {extra} needs {' and '.join(missing)}: {sys.executable} -m pip install"
            f" 'topo-verify[{extra}]'"
        )
