"""The TARGET of a command: a mapper by name, from a module or from a file.

    a catalogue name, several with commas, or `all` (those that are right in all worlds)
    package.module:attribute
    path/file.py:attribute

Source: docs/semantics.md, section 16.
"""

from __future__ import annotations

import sys

from topo_verify.algorithms import CATALOGUE, Algorithm
from topo_verify.errors import InputError
from topo_verify.programs.loading import Mapper, Target, load


def targets(text: str, *, pick: str | None = None, order: str | None = None) -> tuple[Target, ...]:
    """The mappers that a TARGET names, in its order.

    Args:
        pick, order: policies for algorithms of the catalogue.
    Raises:
        InputError: no such algorithm, module, file, attribute or policy; it is not callable; or
            policies for a mapper that has none.
    """
    if ":" in text:
        return (_with_policies(Target(text, load(text)), pick, order),)
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
