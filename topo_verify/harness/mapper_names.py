"""The text by which a command line finds a callable again that was handed over in Python.

| the callable | its text |
| --- | --- |
| an algorithm of the catalogue | its name |
| what a module holds under a name | `package.module:name` |
| likewise, but other programs do not find the module by its name | `path/file.py:name` |
| anything else, such as a closure, or what a notebook holds | `module:<name>`, which finds none |

No replay command is printed for the last kind.
"""

from __future__ import annotations

import ast
import inspect
import os
import sys
from dataclasses import replace
from operator import attrgetter
from pathlib import Path
from types import ModuleType

from topo_verify.algorithms import CATALOGUE, STEERED, Algorithm, Steered
from topo_verify.programs.loader import Mapper


def text_of(mapper: Mapper) -> str:
    """The text of a callable; see the table above."""
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
    called: str = getattr(mapper, "__qualname__", type(mapper).__qualname__)
    return f"{home}:<{called.rpartition('.')[2].strip('<>')}>"


def is_found_again(text: str) -> bool:
    """Whether a command line finds the mapper of this text."""
    return "<" not in text.rpartition(":")[2]


def _name_in(module: ModuleType, mapper: Mapper) -> str | None:
    """The name under which a module holds this very object; None if it does not."""
    name: str = getattr(mapper, "__qualname__", "")
    try:
        if attrgetter(name)(module) is mapper:
            return name
    except AttributeError:
        pass
    return next((key for key, value in vars(module).items() if value is mapper), None)


def _place(module: ModuleType) -> str | None:
    """How another program, started in this folder, names the module; None if it cannot."""
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
    """Whether a script may be loaded again: the line that it is at stands below a guard.

    The guard is `if __name__ == "__main__":`. A script without one would do its work again as soon
    as it is loaded, and that may fail before the mapper is found.
    """
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
