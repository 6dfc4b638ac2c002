"""Kernels as plain Python, on arrays: every index is checked, and a mistake can be planted."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from topo_verify.extra.fast.kernels.names import WordView


def plain(kernel: Callable[..., Any]) -> Callable[..., Any]:
    """The kernel, for the arrays that machine code is given in place of views."""
    notes = [note for name, note in kernel.__annotations__.items() if name != "return"]
    known = [kernel.__globals__.get(note) for note in notes]
    views = [
        view if isinstance(view, type) and issubclass(view, WordView) else None for view in known
    ]

    def on_arrays(*arguments: Any) -> Any:
        pairs = zip(views, arguments, strict=True)
        return kernel(*(argument if view is None else view(argument) for view, argument in pairs))

    return on_arrays
