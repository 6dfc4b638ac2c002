"""Resolves a WORLD argument of the command line, as docs/semantics.md, section 16, lists them.

A call's arguments are literals; nothing is evaluated as Python.
"""

from __future__ import annotations

import ast
import inspect
import re
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import IO, TypeVar, cast

from topo_verify.errors import InputError, close_name, shown
from topo_verify.world import io
from topo_verify.world.families import FAMILIES
from topo_verify.world.formats import files, other, world_json
from topo_verify.world.rooted_map import World

T = TypeVar("T")


class NoSuchWorld(InputError):
    """The text has none of the forms of a WORLD, and no file has this name."""


Argument = int | float | str | bool | None

MAX_LENGTH = 200
"""Against deep nesting and long numbers."""


@dataclass(frozen=True, slots=True)
class CallSyntax:
    """How error messages describe a call.

    Attributes:
        kind: such as "family of worlds".
        before: the text before the call.
        example: a complete valid text.
        words: whether words, True, False and None are allowed.
    """

    kind: str
    before: str
    example: str
    words: bool = False


def call(
    text: str, known: Mapping[str, Callable[..., T]], syntax: CallSyntax, *, bare: bool = False
) -> T:
    """The result of calling a known function as the text says.

    Args:
        bare: a name alone is a call without arguments.
    Raises:
        InputError: unknown name or unfit arguments.
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
    named: dict[str, Argument] = {}
    try:
        positional, named = _arguments(f"{name}()" if bare and text == name else text, syntax)
        bound = signature.bind(*positional, **named)
    except TypeError as error:
        parameters = ", ".join(
            key if parameter.default is parameter.empty else f"{key}={parameter.default}"
            for key, parameter in signature.parameters.items()
        )
        strange = next((key for key in named if key not in signature.parameters), "")
        raise InputError(
            f"'{shown(syntax.before + text, limit=60)}': {shown(str(error))};"
            f" the {syntax.kind.split()[0]} is {name}({parameters})"
            f"{close_name(strange, signature.parameters)}"
        ) from error
    # outside the `try`: a TypeError from here is the function's defect
    return known[name](*bound.args, **bound.kwargs)


def _arguments(text: str, syntax: CallSyntax) -> tuple[list[Argument], dict[str, Argument]]:
    if len(text) > MAX_LENGTH:
        raise TypeError(f"expected at most {MAX_LENGTH} characters, got {len(text)}")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            parsed = ast.parse(text, mode="eval").body
    except SyntaxError as error:
        raise TypeError(error.msg) from error
    except (ValueError, RecursionError, MemoryError) as error:
        raise TypeError("expected a call without nested brackets or control characters") from error
    if not isinstance(parsed, ast.Call) or not isinstance(parsed.func, ast.Name):
        raise TypeError("expected one call, with its arguments in brackets")
    named: dict[str, Argument] = {}
    for word in parsed.keywords:
        # `**x` has no name
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
        value = ...
    # isinstance would take True for an int
    if type(value) not in allowed:
        expected = "a literal" if syntax.words else "a number"
        raise TypeError(f"expected {expected}, got '{ast.get_source_segment(text, node)}'")
    return cast("Argument", value)


_ID = re.compile(r"m[0-9]+/[0-9]+")
_NUMBERED = re.compile(r"(.+):([0-9]{1,9})")
_FAMILY = CallSyntax("family of worlds", "family:", "family:lattice(3,4,seed=7)")


def resolve_world(
    text: str, *, stdin: IO[bytes] | None = None, largest_part: bool = False
) -> World:
    """The world that the text names; `-` reads `stdin`.

    Args:
        largest_part: as for `io.load`.
    Raises:
        NoSuchWorld: the text names no world.
        InputError: the world cannot be made or read.
    """
    if text == "-":
        stream, name = stdin or files.standard_input(), "standard input"
        data = files.unpacked(files.read_stream(stream, name=name), name)
        if not data.startswith(io.PLANAR_CODE):
            other.refuse(text, data, "json")
        return io.decoded(World, data, "json", name=name)
    if text == "nyc":
        file = resources.files("topo_verify.world") / "data" / "nyc_osmnx.json"
        return world_json.decode(World, file.read_bytes(), name="the street network of the package")
    if _ID.fullmatch(text):
        return World.from_id(text)
    if text.startswith("family:"):
        return call(text.removeprefix("family:"), FAMILIES, _FAMILY)
    numbered = _NUMBERED.fullmatch(text)
    if numbered and not _exists(text) and _exists(numbered[1]):
        return World.load(numbered[1], graph=int(numbered[2]))
    if not _exists(text):
        raise NoSuchWorld(
            f"no such world: '{shown(text)}' is not a file; give a path, an id (m5/17), a family"
            " (family:lattice(10,10,holes=0.2,seed=7)), nyc (the street network of the package) or"
            " - (world JSON on standard input)"
        )
    return io.load(World, text, largest_part=largest_part)


def _exists(path: str) -> bool:
    try:
        return bool(path) and Path(path).exists()
    except (OSError, ValueError):
        return False
