"""Calls on a command line: `lattice(10, 10, holes=0.2)`, taken apart here and never run by Python.

A call is a name with literal arguments, by place or by name: numbers, for families of worlds; for
strategies also `True`, `False`, `None` and words in quotes.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeVar

from topo_verify.errors import InputError
from topo_verify.text import shown

T = TypeVar("T")

Literal = int | float | bool | str | None

_CALL = re.compile(r"(\w+)\(([^()]*)\)")
_NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_WORDS: dict[str, Literal] = {"True": True, "False": False, "None": None}
_QUOTED = r"'[a-z]*'|\"[a-z]*\""
_ARGUMENT = re.compile(
    rf"\s*(?:([a-z_]+)\s*=\s*)?(?:({_NUMBER})|({'|'.join(_WORDS)})|({_QUOTED}))\s*"
)

_LONGEST = 200
"""Letters in a call: more than any needs, and too few for a number that takes long."""


@dataclass(frozen=True, slots=True)
class Kind:
    """What is called, for the sentences.

    Attributes:
        kind: "family of worlds", say.
        before: what stands before the call on a command line.
        example: a whole text that is right.
        words: are arguments other than numbers allowed?
    """

    kind: str
    before: str
    example: str
    words: bool = False


def call(text: str, known: Mapping[str, Callable[..., T]], kind: Kind, *, bare: bool = False) -> T:
    """What the call returns.

    Args:
        text: the call itself, without what stands before it.
        known: what may be called.
        bare: a name alone is a call without arguments.
    Raises:
        InputError: the text is no such call, or its arguments do not fit; also whatever the called
            one raises.
    """
    text = f"{text}()" if bare and text in known else text
    found = _CALL.fullmatch(text) if len(text) <= _LONGEST else None
    make = known.get(found[1]) if found else None
    if found is None or make is None:
        raise InputError(
            f"'{shown(kind.before + text, limit=60)}' names no {kind.kind}:"
            f" {_expected(kind)} one of {', '.join(known)} with {_kinds(kind)}s for arguments,"
            f" as in {kind.example}"
        )
    signature = inspect.signature(make)
    try:
        places, options = _arguments(found[2], kind)
        bound = signature.bind(*places, **options)
    except TypeError as error:
        parameters = ", ".join(
            name if one.default is one.empty else f"{name}={one.default}"
            for name, one in signature.parameters.items()
        )
        raise InputError(
            f"'{shown(kind.before + text)}': {shown(str(error))}; the {kind.kind.split()[0]} is"
            f" {found[1]}({parameters})"
        ) from error
    return make(*bound.args, **bound.kwargs)


def _expected(kind: Kind) -> str:
    return f"after '{kind.before}' stands" if kind.before else "expected"


def _kinds(kind: Kind) -> str:
    return "literal" if kind.words else "number"


def _arguments(text: str, kind: Kind) -> tuple[list[Literal], dict[str, Literal]]:
    """Arguments by place and by name; where they are none, a TypeError, as from a call."""
    places: list[Literal] = []
    options: dict[str, Literal] = {}
    for part in text.split(",") if text.strip() else ():
        found = _ARGUMENT.fullmatch(part)
        if not found or not (kind.words or found[2]):
            wanted = _kinds(kind)
            raise TypeError(f"'{part.strip()}' is no {wanted} and no name={wanted}")
        key, number, word, quoted = found.groups()
        value: Literal = _WORDS[word] if word else quoted[1:-1] if quoted else _number(number)
        if key is None and options:
            raise TypeError(f"{part.strip()} stands behind an argument with a name")
        if key in options:
            raise TypeError(f"{key} is given twice")
        if key is None:
            places.append(value)
        else:
            options[key] = value
    return places, options


def _number(text: str) -> int | float:
    return int(text) if text.lstrip("+-").isdigit() else float(text)
