"""Marks for some parameters of a computed list, where `pytest.param` cannot be written out."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any

import pytest


def with_marks(
    values: Iterable[object], *, long: Collection[str] = (), nightly: Collection[str] = ()
) -> list[Any]:
    """The values as parameters of a test; those with the given names are marked.

    The name of a value is its attribute `name`, or the value itself. A name that no value has is
    an error, so that a mark does not outlive its parameter.
    """
    marks = {
        **dict.fromkeys(long, pytest.mark.long),
        **dict.fromkeys(nightly, pytest.mark.nightly),
    }
    named: list[tuple[Any, object]] = [(getattr(value, "name", value), value) for value in values]
    if missing := marks.keys() - {name for name, _ in named}:
        raise ValueError(f"no parameter is named {sorted(missing)}: use the name of a parameter")
    return [pytest.param(value, marks=marks.get(name, ())) for name, value in named]
