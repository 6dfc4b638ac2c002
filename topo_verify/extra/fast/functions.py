"""Functions that numba compiles as native mappers: `--library path/file.py:name`.

Importing this module does not load numba.
"""

from __future__ import annotations

import ast
import ctypes
import re
import sys
from functools import cache
from pathlib import Path
from typing import Any

from topo_verify.errors import InputError, shown
from topo_verify.programs.library import library_file
from topo_verify.programs.loader import object_at

_lasting: list[object] = []
"""The compiled functions, which own their machine code."""


class JittedFunctions:
    """A kind of TARGET: see `FunctionMaker`."""

    words = "is compiled by numba"

    def makes(self, mapper: object) -> bool:
        """Does numba compile this function?"""
        module = sys.modules.get("numba.core.dispatcher")
        return module is not None and isinstance(mapper, module.Dispatcher)

    def shows(self, path: str, name: str) -> bool:
        """Whether the source of a file shows that numba compiles its function `name`."""
        try:
            body = ast.parse(Path(path).read_bytes()).body
        except (SyntaxError, ValueError, OSError, RecursionError, MemoryError):
            return False
        marks: list[ast.expr] = []
        for node in body:
            if isinstance(node, ast.FunctionDef) and node.name == name:
                marks = node.decorator_list
            elif isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == name:
                marks = [node.value]
        return any(map(_is_jit, marks))

    def function(self, text: str) -> Any:
        """The function of a native mapper, compiled once in this process, as a ctypes object."""
        return _compiled(":".join(library_file(text)))


JITTED = JittedFunctions()


def _is_jit(mark: ast.expr) -> bool:
    while isinstance(mark, ast.Call):
        mark = mark.func
    return ast.unparse(mark).rpartition(".")[2] in ("njit", "jit")


@cache
def _compiled(place: str) -> Any:
    return jitted_function(object_at(place), f"--library {place}")


def jitted_function(function: Any, where: str) -> Any:
    """A function compiled by numba, as a ctypes object.

    Args:
        where: the beginning of the error message.
    Raises:
        InputError: it is no such function, or numba cannot compile it for a robot.
    """
    if not JITTED.makes(function):
        raise InputError(
            f"{where}: expected a function compiled by numba, got {type(function).__name__}: put"
            " @numba.njit above it, or give it as a TARGET without --library"
        )
    # Numba freezes globals, so a call leaves to the next one only what hides behind an address.
    from numba import cfunc, types
    from numba.core.errors import NumbaError

    def call(robot: int) -> None:
        function(robot)

    try:
        machine_code: Any = cfunc(types.void(types.int64))(call)
    except NumbaError as error:
        raise InputError(f"{where}: numba cannot compile it: {_reason(str(error))}") from error
    _lasting.append(machine_code)
    return ctypes.CFUNCTYPE(None, ctypes.c_void_p)(machine_code.address)


def _reason(text: str) -> str:
    lines = [line.strip() for line in text.splitlines()]
    reasons = [line for line in lines if line and not line.startswith("Failed in ")]
    first = next((line for line in reasons if re.match(r"\w+Error: ", line)), reasons[0])
    places = [line.rstrip(":") for line in lines if re.match(r'File ".*", line \d+', line)]
    theirs = [place for place in places if "topo_verify/" not in place]
    return shown("; ".join((first.rstrip("."), *theirs[-1:])), limit=400)
