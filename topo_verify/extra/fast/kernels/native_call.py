"""Call the function at an address, and see the words at an address, from kernels.

Numba's `carray` needs reference counting, which is off here (kernel.py).
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from numba import types
from numba.core.typing.templates import Signature
from numba.extending import intrinsic

ir: Any = import_module("llvmlite.ir")
_arrays: Any = import_module("numba.np.arrayobj")  # neither has types

_WORD = ir.IntType(64)


@intrinsic
def call_address(_typing: Any, _address: Any, _argument: Any) -> Any:
    """Call the function at this address with one word."""

    def generate(_context: Any, builder: Any, _signature: Signature, values: Any) -> Any:
        kind = ir.FunctionType(_WORD, [_WORD]).as_pointer()
        return builder.call(builder.inttoptr(values[0], kind), [values[1]])

    return types.int64(types.int64, types.int64), generate


@intrinsic
def row_at(_typing: Any, _address: Any, _size: Any) -> Any:
    """The row of `size` words at this address, without counted references."""
    row = types.Array(types.int64, 1, "C")

    def generate(context: Any, builder: Any, _signature: Signature, values: Any) -> Any:
        array = _arrays.make_array(row)(context, builder)
        _arrays.populate_array(
            array,
            data=builder.inttoptr(values[0], _WORD.as_pointer()),
            shape=[values[1]],
            strides=[ir.Constant(_WORD, 8)],
            itemsize=ir.Constant(_WORD, 8),
            meminfo=None,
        )
        return array._getvalue()  # noqa: SLF001  as numba's own code does

    return row(types.int64, types.int64), generate
