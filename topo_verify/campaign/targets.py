"""The TARGET of a command: a mapper by its name, its module, its file or its command.

    basic                       a name of the catalogue
    package.module:attribute    a callable of an importable module
    path/file.py:attribute      a callable of a file
    --cmd program args          a program behind protocol 1, started in its first world
    --library file.so:symbol    a function of a shared library, in its own process
    --library path/file.py:name a function to be compiled first; as path/file.py:name, too
    all                         the algorithms that are right in every world
    basic,path/file.py:name     several of these, except programs and libraries

Conversely, `text_of` names a callable by its catalogue name, its module, its file if other
programs do not find the module by name, or else, as for a closure, by `module:<maker.name>`, or as
for what a notebook holds, by `<name>`. Neither finds anything.

Source: docs/semantics.md, section 16.
"""

from __future__ import annotations

import ast
import inspect
import os
import shlex
import sys
from collections.abc import Iterable
from dataclasses import replace
from operator import attrgetter
from pathlib import Path
from types import ModuleType

from topo_verify.algorithms import CATALOGUE, NAMED, STEERED, Algorithm, Steered
from topo_verify.errors import InputError, close_name, is_utf8
from topo_verify.programs.foreign import Foreign
from topo_verify.programs.library import LIBRARY
from topo_verify.programs.loader import (
    Mapper,
    Target,
    load,
    maker_of,
    missing_attribute,
    require_file,
)
from topo_verify.programs.program import OPTIONS, PREFIX, Program, split

_LIBRARIES = (".so", ".dylib", ".dll")


def targets(
    text: str, *, pick: str | None = None, order: str | None = None, in_process: bool = True
) -> tuple[Target, ...]:
    """The mappers that a TARGET names, in its order; InputError if it names none.

    Programs, and mappers in their own processes, start in their first world. If `in_process`,
    mappers outside the catalogue share this process. `pick` and `order` are for those
    that have policies, which must be one at least.
    """
    mappers = [_target(name, in_process=in_process) for name in each_text(text)]
    some_have = any(isinstance(target.mapper, Algorithm) for target in mappers)
    return tuple(
        target
        if some_have and not isinstance(target.mapper, Algorithm)
        else _with_policies(target, pick, order)
        for target in mappers
    )


def start(mappers: Iterable[Target]) -> None:
    """Start mappers in their own processes now; InputError if one cannot be loaded."""
    for target in mappers:
        if isinstance(target.mapper, Foreign):
            target.mapper.start()


def each_text(text: str) -> tuple[str, ...]:
    """The text of each mapper that a TARGET names: split at commas, with `all` expanded.

    A function of a file that is to be compiled becomes a native mapper.
    """
    place = text.rpartition(":")[0]
    named = "," in place and os.path.isfile(place)  # noqa: PTH113  Path.is_file raises if a list is longer than a file name
    if text.startswith(OPTIONS):
        return (text,)
    general = [name for name, algorithm in CATALOGUE.items() if algorithm.assumes is None]
    parts = [text] if named else [part.strip() for part in text.split(",")]
    names = (name for part in parts for name in (general if part == "all" else [part]))
    return tuple(LIBRARY + name if _is_to_compile(name) else name for name in names)


def _is_to_compile(text: str) -> bool:
    """Whether the source of `path/file:name` shows a function to be compiled first."""
    path, _, name = text.rpartition(":")
    maker = maker_of(path)
    return maker is not None and maker.shows(path, name)


def one_target(
    mapper: Mapper | str | Target,
    *,
    pick: str | None = None,
    order: str | None = None,
    in_process: bool = True,
) -> Target:
    """The target that a callable or a text names; InputError if it names several."""
    if isinstance(mapper, Target):
        return _with_policies(mapper, pick, order)
    if not isinstance(mapper, str):
        if not callable(mapper):
            raise InputError(f"expected a callable that takes a robot, got {mapper!r}")
        return _with_policies(Target(text_of(mapper), mapper), pick, order)
    mappers = targets(mapper, pick=pick, order=order, in_process=in_process)
    if len(mappers) != 1:
        raise InputError(f"{mapper!r} names {len(mappers)} mappers: name one")
    return mappers[0]


def _target(text: str, *, in_process: bool) -> Target:
    if not is_utf8(text):  # results, stores and workers keep every mapper as one text of JSON
        raise InputError(
            f"target {text!r}: expected a name in UTF-8; rename the file or the folder, or change"
            " into the folder"
        )
    if text.startswith(PREFIX):
        return Program(text.removeprefix(PREFIX)).target
    native = text.startswith(LIBRARY)
    if native or ":" in text:
        if in_process and not native:  # native code shares no process with a checker
            return Target(text, load(text))
        if not native:
            require_file(text)
        return Foreign(text).target
    if text not in NAMED:
        if (hint := missing_attribute(text)) is not None:
            raise InputError(f"target {text!r}: {hint}")
        if Path(text).is_file():
            option = "--library" if Path(text).suffix in _LIBRARIES else "--cmd"
            raise InputError(f"no algorithm {text!r}: it is a file; to run it, {option} {text}")
        raise InputError(
            f"no algorithm {text!r}{close_name(text, NAMED) or ':'} there are"
            f" {', '.join(NAMED)} and all; a mapper of your own is"
            " package.module:attribute, path/file.py:attribute, --cmd 'program args' or"
            " --library path/file.so"
        )
    return Target(text, NAMED[text])


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
    """The text of the TARGET given as an argument, by `--cmd` or by `--library`.

    Raises:
        InputError: several are given; or none, and there is no default.
    """
    if command is not None and target is None:
        if command.startswith(LIBRARY):
            return command
        return PREFIX + shlex.join(split(command))
    if command is None and target is None:
        target = default
    if command is not None or target is None:
        raise InputError(
            "name a TARGET, a program with --cmd 'program args', or a native mapper with --library"
            " FILE: one of them, not two; with another TARGET, give --target '--cmd PROGRAM'"
        )
    return target


def target_arguments(text: str) -> tuple[str, ...]:
    """The arguments of a command line that name this TARGET."""
    option = next((option for option in OPTIONS if text.startswith(option)), None)
    return (text,) if option is None else (option.strip(), text.removeprefix(option))


# ---------------------------------------------------------------- the text of a callable


def text_of(mapper: Mapper) -> str:
    """The text of a callable."""
    if isinstance(mapper, Algorithm):
        known = CATALOGUE.get(mapper.name)
        ours = known is not None and replace(mapper, policies=known.policies) == known
        return mapper.name if ours else f"<{mapper.name}>"
    if isinstance(mapper, Steered):
        return mapper.name if mapper == STEERED.get(mapper.name) else f"<{mapper.name}>"
    home: str = getattr(mapper, "__module__", None) or "__main__"
    module = sys.modules.get(home)
    name = None if module is None else _name_in(module, mapper)
    place = None if module is None or name is None else _place(module)
    if place is not None:
        return f"{place}:{name}"
    called: str = getattr(mapper, "__qualname__", f"{type(mapper).__qualname__}()")
    name = f"<{name or called.replace('<locals>.', '').replace('<lambda>', 'lambda')}>"
    return name if home == "__main__" else f"{home}:{name}"


def is_found_again(text: str) -> bool:
    """Whether a command line finds the mapper of this text."""
    return "<" not in text.rpartition(":")[2]


def _name_in(module: ModuleType, mapper: Mapper) -> str | None:
    name: str = getattr(mapper, "__qualname__", "")
    try:
        if attrgetter(name)(module) is mapper:
            return name
    except AttributeError:
        pass
    return next((key for key, value in vars(module).items() if value is mapper), None)


def _place(module: ModuleType) -> str | None:
    """How another program in this folder would name the module, or None."""
    name, file = module.__name__, getattr(module, "__file__", None)
    if name == "__main__":
        return file if file is not None and _is_guarded(module, Path(file)) else None
    if "." in name or file is None:
        return name
    path = Path(file).resolve()
    folders = [Path.cwd(), *map(Path, os.environ.get("PYTHONPATH", "").split(os.pathsep))]
    at_hand = path.parent in [folder.resolve() for folder in folders]
    at_hand |= path.stem == "__init__" or "site-packages" in path.parts
    if at_hand and path.stem in (name, "__init__"):
        return name
    return str(path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path)


def _is_guarded(script: ModuleType, path: Path) -> bool:
    """Whether a script's current line is below a `__name__` guard, so it may be loaded again."""
    if path.suffix != ".py" or not path.is_file():
        return False
    frame = inspect.currentframe()
    while frame and not (frame.f_globals is vars(script) and frame.f_code.co_name == "<module>"):
        frame = frame.f_back
    return frame is None or any(
        isinstance(node, ast.If)
        and "__name__" in ast.unparse(node.test)
        and node.lineno < frame.f_lineno <= (node.end_lineno or 0)
        for node in ast.parse(path.read_bytes()).body
    )
