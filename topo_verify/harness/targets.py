"""The TARGET of a command: a mapper by its name, its module, its file or its command.

    basic, folding              names of the catalogue; `all`: those that are right in every world
    package.module:attribute    a callable of an importable module, in this process or its own
    path/file.py:attribute      a callable of a file, likewise
    --cmd program args          a program behind protocol 1, started when it plays its first world

A program's text is `--cmd` and its command in one text, so that workers, ledgers and baselines keep
every mapper as one text.

Source: docs/semantics.md, section 16.
"""

from __future__ import annotations

import shlex

from topo_verify.algorithms import CATALOGUE, NAMED, Algorithm
from topo_verify.errors import InputError
from topo_verify.harness.mapper_names import text_of
from topo_verify.programs.foreign import Foreign
from topo_verify.programs.hints import close_name, missing_attribute
from topo_verify.programs.loader import Mapper, Target, load
from topo_verify.programs.program import PREFIX, Program, split


def targets(
    text: str, *, pick: str | None = None, order: str | None = None, in_process: bool = True
) -> tuple[Target, ...]:
    """The mappers that a TARGET names, in its order.

    A program runs from its first world until it is closed or its object is deleted; a mapper in a
    process of its own from now on.

    Args:
        pick, order: policies for algorithms of the catalogue.
        in_process: a mapper that is not of the catalogue shares this process, or else gets its own.
    Raises:
        InputError: there is no such algorithm, module, file, attribute or policy; what was found
            cannot be called; the command is empty; or policies are given for another mapper.
    """
    found = _targets(text, in_process=in_process)
    return tuple(_with_policies(target, pick, order) for target in found)


def one_target(
    mapper: Mapper | str | Target,
    *,
    pick: str | None = None,
    order: str | None = None,
    in_process: bool = True,
) -> Target:
    """The target that a callable or a text names; see `targets`.

    Raises:
        InputError: as `targets`; or the text names several mappers, or the object is no callable.
    """
    if isinstance(mapper, Target):
        return _with_policies(mapper, pick, order)
    if not isinstance(mapper, str):
        if not callable(mapper):
            raise InputError(f"expected a callable that takes a robot, got {mapper!r}")
        return _with_policies(Target(text_of(mapper), mapper), pick, order)
    found = targets(mapper, pick=pick, order=order, in_process=in_process)
    if len(found) != 1:
        raise InputError(f"{mapper!r} names {len(found)} mappers: name one")
    return found[0]


def _targets(text: str, *, in_process: bool) -> tuple[Target, ...]:
    # The prefix comes first: a command may well hold a colon, a module path never begins with `--`.
    if text.startswith(PREFIX):
        return (Program(text.removeprefix(PREFIX)).target,)
    if ":" in text:
        if in_process:
            return (Target(text, load(text)),)
        foreign = Foreign(text)
        foreign.start()  # now, so that a text that names no mapper is refused before all else
        return (foreign.target,)
    general = [name for name, algorithm in CATALOGUE.items() if algorithm.assumes is None]
    names = general if text == "all" else [name.strip() for name in text.split(",")]
    for name in names:
        if name not in NAMED:
            if (hint := missing_attribute(name)) is not None:
                raise InputError(f"target {name!r}: {hint}")
            raise InputError(
                f"no algorithm {name!r}{close_name(name, NAMED) or ':'} there are"
                f" {', '.join(NAMED)} and all; a mapper of your own is"
                " package.module:attribute, path/file.py:attribute or --cmd 'program args'"
            )
    return tuple(Target(name, NAMED[name]) for name in names)


def _with_policies(target: Target, pick: str | None, order: str | None) -> Target:
    if pick is None and order is None:
        return target
    if not isinstance(target.mapper, Algorithm):
        raise InputError(
            f"{target.text} has no policies: leave out --pick and --order, which are for algorithms"
            " of the catalogue"
        )
    try:
        return Target(target.text, target.mapper.with_policies(pick=pick, order=order))
    except ValueError as error:
        raise InputError(str(error)) from None


# ---------------------------------------------------------------- on the command line


def target_text(target: str | None, command: str | None, default: str | None = None) -> str:
    """The text of the TARGET that is given as an argument or by `--cmd`.

    Args:
        default: the text if neither is given.
    Raises:
        InputError: both are given; or neither, and there is no default.
    """
    if command is not None and target is None:
        return PREFIX + shlex.join(split(command))
    if command is None and target is None:
        target = default
    if command is not None or target is None:
        raise InputError(
            "name a TARGET, or a program with --cmd 'program args': one of the two, not both"
        )
    return target


def target_arguments(text: str) -> tuple[str, ...]:
    """The arguments of a command line that name this TARGET."""
    return ("--cmd", text.removeprefix(PREFIX)) if text.startswith(PREFIX) else (text,)
