"""A hash of what a mapper was made with, which the text of its files does not say.

That are the arguments of partials, the contents of closures, defaults, and the attributes of
callable objects. Read them before the mapper runs, for some may change then.

What this does not show: what C code holds. Of more than `MOST_VALUES` values the rest is not read.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from hashlib import sha256
from types import CodeType, FunctionType, MethodType, ModuleType
from typing import Any, cast

MOST_VALUES = 10_000
"""The most values that are read."""


def values_hash(mapper: object) -> str:
    """A hash of what a mapper was made with; call this before it runs."""
    text = repr(list(_described(mapper, {})))
    return sha256(text.encode(errors="backslashreplace")).hexdigest()


def _described(value: object, seen: dict[int, object]) -> Iterator[str]:
    """A value as words that are the same in every process."""
    if isinstance(value, bool | int | float | complex | str | bytes | None):
        yield f"{type(value).__name__} {value!r}"
        return
    yield f"{type(value).__module__}.{type(value).__qualname__}"
    if id(value) in seen or len(seen) >= MOST_VALUES:
        return
    seen[id(value)] = value  # kept, so that no other value gets its id
    if isinstance(value, set | frozenset):
        whole = cast("frozenset[object]", value)
        yield from sorted(" ".join(_described(one, dict(seen))) for one in whole)
        return
    for part in _parts(value):
        yield from _described(part, seen)
    yield "."  # where the parts end


def _parts(value: object) -> Iterator[object]:
    """What a value is made of."""
    if isinstance(value, list | tuple):
        yield from cast("list[object]", value)
    elif isinstance(value, Mapping):
        for pair in cast("Mapping[object, object]", value).items():
            yield from pair
    elif isinstance(value, partial):
        made = cast("partial[object]", value)
        yield from (made.func, made.args, made.keywords)
    elif isinstance(value, MethodType):
        yield from (value.__func__, value.__self__)
    elif isinstance(value, FunctionType):
        yield from (value.__qualname__, value.__code__, value.__defaults__, value.__kwdefaults__)
        yield from (_content(cell) for cell in value.__closure__ or ())
        yield dict(value.__dict__)
    elif isinstance(value, CodeType):
        yield from (value.co_code, value.co_names, value.co_consts, value.co_freevars)
    elif isinstance(value, type | ModuleType):
        yield value.__name__
    else:
        yield dict(getattr(value, "__dict__", {}))


def _content(cell: Any) -> object:
    try:
        return cell.cell_contents
    except ValueError:  # it is empty
        return None
