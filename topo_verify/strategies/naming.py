"""Lets a strategy print as the call that made it: `worlds(max_edges=6)`.

Hypothesis prints strategies in its errors, and a prompt prints them, too.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

P = ParamSpec("P")
T = TypeVar("T")


def shown_as_called(make: Callable[P, SearchStrategy[T]]) -> Callable[P, SearchStrategy[T]]:
    """The same function, whose strategies print as its calls, defaults left out."""
    signature = inspect.signature(make)
    draw = inspect.Parameter("draw", inspect.Parameter.POSITIONAL_ONLY)
    shown = inspect.Signature([draw, *signature.parameters.values()])

    @wraps(make)
    def made(*args: P.args, **kwargs: P.kwargs) -> SearchStrategy[T]:
        strategy = make(*args, **kwargs)  # here, so that wrong arguments are refused at once

        def call(draw: st.DrawFn, /, *_: P.args, **__: P.kwargs) -> T:
            return draw(strategy)

        # Hypothesis prints a composite by its function's name, and by the arguments of the call.
        call.__name__ = make.__name__
        vars(call)["__signature__"] = shown
        return st.composite(call)(*args, **kwargs)

    return made
