"""Calls on a command line: `lattice(10, 10, holes=0.2)`, parsed and never run as Python.

A call is a name with literal arguments, by position or by name: numbers, for families of worlds;
for strategies also `True`, `False`, `None` and quoted words.
"""

from __future__ import annotations

import ast
import inspect
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeVar, cast

from topo_verify.errors import InputError
from topo_verify.text import shown

T = TypeVar("T")

Argument = int | float | str | bool | None

MAX_LENGTH = 200
"""Characters in a call: more than any needs, too few to nest deeply or to hold a long number."""


@dataclass(frozen=True, slots=True)
class CallSyntax:
    """What is called, for the error messages.

    Attributes:
        kind: "family of worlds", say.
        before: what stands before the call on a command line.
        example: a whole text that is right.
        words: may arguments be words and truth values, too?
    """

    kind: str
    before: str
    example: str
    words: bool = False


def call(
    text: str, known: Mapping[str, Callable[..., T]], syntax: CallSyntax, *, bare: bool = False
) -> T:
    """What the call returns.

    Args:
        text: the call itself, without what stands before it.
        known: what may be called.
        bare: a name alone is a call without arguments.
    Raises:
        InputError: the name is unknown or the arguments do not fit; also whatever is raised by the
            function that is called.
    """
    name = text.partition("(")[0]
    if name not in known:
        expected = f"expected after '{syntax.before}'" if syntax.before else "expected"
        raise InputError(
            f"no such {syntax.kind}: '{shown(syntax.before + text, limit=60)}'; {expected} one of"
            f" {', '.join(known)} with {'literals' if syntax.words else 'numbers'} for arguments,"
            f" as in {syntax.example}"
        )
    signature = inspect.signature(known[name])
    try:
        positional, named = _arguments(f"{name}()" if bare and text == name else text, syntax)
        bound = signature.bind(*positional, **named)
    except TypeError as error:
        parameters = ", ".join(
            parameter if one.default is one.empty else f"{parameter}={one.default}"
            for parameter, one in signature.parameters.items()
        )
        raise InputError(
            f"'{shown(syntax.before + text, limit=60)}': {shown(str(error))};"
            f" the {syntax.kind.split()[0]} is {name}({parameters})"
        ) from error
    # Not inside the `try`: a TypeError from here is a defect of the function, not of the text.
    return known[name](*bound.args, **bound.kwargs)


def _arguments(text: str, syntax: CallSyntax) -> tuple[list[Argument], dict[str, Argument]]:
    """The call's arguments by position and by name; TypeError, as from a call, if it is none."""
    if len(text) > MAX_LENGTH:
        raise TypeError(f"expected at most {MAX_LENGTH} characters, got {len(text)}")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # Python's on sloppy literals: one message is enough
            parsed = ast.parse(text, mode="eval").body
    except SyntaxError as error:
        raise TypeError(error.msg) from error
    except (ValueError, RecursionError, MemoryError) as error:  # the others that ast.parse raises
        raise TypeError("expected a call without nested brackets or control characters") from error
    if not isinstance(parsed, ast.Call) or not isinstance(parsed.func, ast.Name):
        raise TypeError("expected one call, with its arguments in brackets")
    named: dict[str, Argument] = {}
    for word in parsed.keywords:
        # `**x` has no name. Python refuses a name given twice only when it compiles, after parsing.
        if word.arg is None or word.arg in named:
            given = ast.get_source_segment(text, word)
            raise TypeError(f"expected name=value and each name once, got '{given}'")
        named[word.arg] = _literal(word.value, text, syntax)
    return [_literal(node, text, syntax) for node in parsed.args], named


def _literal(node: ast.expr, text: str, syntax: CallSyntax) -> Argument:
    allowed = {int, float, str, bool, type(None)} if syntax.words else {int, float}
    try:
        value = ast.literal_eval(node)
    except (ValueError, RecursionError):
        value = ...  # an Ellipsis is a literal, too, and never allowed
    # Not isinstance: True would be an int.
    if type(value) not in allowed:
        expected = "a literal" if syntax.words else "a number"
        raise TypeError(f"expected {expected}, got '{ast.get_source_segment(text, node)}'")
    return cast("Argument", value)
