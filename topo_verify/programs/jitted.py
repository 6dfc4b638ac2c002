"""A native mapper in Python: a function that numba compiles; `topo_verify.native` has its robot.

    jitted_function(found, where)       # as ctypes has it, like a function of a shared library

It is compiled in the process that calls it. Numba freezes the globals that it reads, so a call
leaves nothing to the next one but what it hides behind an address.
"""

from __future__ import annotations

import ctypes
import re
import sys
from typing import Any

from topo_verify.errors import InputError, shown

_lasting: list[object] = []
"""What numba made: its machine code is there as long as it is."""


def is_jitted(found: object) -> bool:
    """Whether numba compiles this function."""
    module = sys.modules.get("numba.core.dispatcher")
    return module is not None and isinstance(found, module.Dispatcher)


def jitted_function(found: Any, where: str) -> Any:
    """A function that numba compiles, as ctypes has it.

    Args:
        where: the beginning of the sentence.
    Raises:
        InputError: it is no such function, or numba cannot compile it for a robot.
    """
    if not is_jitted(found):
        raise InputError(
            f"{where}: expected a function compiled by numba, got {type(found).__name__}: put"
            " @numba.njit above it, or give it as a TARGET without --library"
        )
    from numba import cfunc, types
    from numba.core.errors import NumbaError

    def call(robot: int) -> None:
        found(robot)

    try:
        made: Any = cfunc(types.void(types.int64))(call)
    except NumbaError as error:
        raise InputError(f"{where}: numba cannot compile it: {_reason(str(error))}") from error
    _lasting.append(made)
    return ctypes.CFUNCTYPE(None, ctypes.c_void_p)(made.address)


def _reason(text: str) -> str:
    """What an error of numba's comes down to, and the last place in a source that it names."""
    lines = [line.strip() for line in text.splitlines()]
    told = [line for line in lines if line and not line.startswith("Failed in ")]
    first = next((line for line in told if re.match(r"\w+Error: ", line)), told[0])
    places = [line.rstrip(":") for line in lines if re.match(r'File ".*", line \d+', line)]
    theirs = [place for place in places if "topo_verify/" not in place]
    return shown("; ".join((first.rstrip("."), *theirs[-1:])), limit=400)
