"""Reads XML that may be hostile, as a stream.

A document type declaration is refused, so nothing expands ("billion laughs") and nothing is
fetched. The depth is limited. Names come without namespaces.

Source: "XML security" in the manual of Python's standard library.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from xml.parsers import expat

from topo_verify.errors import InputError

DEEPEST = 64
"""The formats here need 6."""

_SEPARATOR = "\x01"

OnStart = Callable[[tuple[str, ...], dict[str, str]], None]
"""Called with the names from the root, and the attributes."""

OnEnd = Callable[[tuple[str, ...], str], None]
"""Called with the names from the root, and the text just before."""


def read(data: bytes, *, name: str, start: OnStart, end: OnEnd) -> None:
    """Go through the document; raises InputError."""
    paths: list[tuple[str, ...]] = [()]
    text: list[str] = []

    def begin(tag: str, attributes: dict[str, str]) -> None:
        path = (*paths[-1], _local(tag))
        if len(path) > DEEPEST:
            raise InputError(f"{name}: its elements are nested too deeply, over {DEEPEST} deep")
        paths.append(path)
        text.clear()
        start(path, {_local(key): value for key, value in attributes.items()})

    def finish(_tag: str) -> None:
        end(paths.pop(), "".join(text))
        text.clear()

    def refuse(*_declared: object) -> None:
        raise InputError(
            f"{name} has a document type (<!DOCTYPE …>), which could expand without end or fetch"
            " other files: take it out"
        )

    parser = expat.ParserCreate(namespace_separator=_SEPARATOR)
    parser.buffer_text = True
    parser.StartElementHandler = begin
    parser.EndElementHandler = finish
    parser.CharacterDataHandler = text.append
    parser.StartDoctypeDeclHandler = refuse
    try:
        parser.Parse(data, True)  # noqa: FBT003  expat's signature
    except expat.ExpatError as error:
        raise InputError(f"{name} is not valid XML: {error}") from error
    # an unknown encoding
    except (LookupError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{name} is not valid XML: {error}; save it as UTF-8") from error


@lru_cache
def _local(name: str) -> str:
    return name.rpartition(_SEPARATOR)[2]
