"""Writes what the code says of itself: python docs/reference.py.

    docs/reference/names.txt     every command, option and JSON field
    docs/reference/python.txt    every public Python name with its signature and its first line

Both stay in git, and tests/docs/test_reference.py compares them with what this file makes. What
docs/reference/commands.md includes is made when the site is built. Options are those of
click, fields those of msgspec. The sentence of a field stands in the docstring of its class, under
Attributes, or here in COMMON.
"""

from __future__ import annotations

import inspect
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from importlib import import_module
from operator import attrgetter
from pathlib import Path
from typing import Any

import click
from msgspec import inspect as types

from topo_verify.cli import main

FOLDER = Path(__file__).parent / "reference"

PAGE, NAMES, PYTHON = (FOLDER / name for name in ("_commands.md", "names.txt", "python.txt"))

ENTRIES = {
    "verify": "Part",
    "explore": "ExploreEntry",
    "world show": "ShowEntry",
    "world list": "ListEntry",
    "world count": "CountEntry",
    "world convert": "ConvertEntry",
    "world sample": "SampleEntry",
    "world draw": "DrawEntry",
    "search": "study.SearchEntry",
    "prove": "ProveEntry ProveListEntry",
    "conform": "LevelResult",
    "record": "study.RecordEntry",
    "compare": "Comparison",
    "replay": "ReplayEntry",
    "play": "PlayEntry",
    "certify": "CertifyEntry topo_verify.extra.certificates.study:CertificateEntry",
    "tour": "TourEntry",
    "arena": "LeagueEntry",
    "header": "HeaderEntry",
    "reproduce": "pts.FigurePoint",
}
"""The records that each command prints, as the module of the command names them.

MODULE:NAME is a record of an extra that adds a task to the command.
"""

OCCASIONS = {
    "ProveListEntry": "with `--list`",
    "CertificateEntry": "with `--check`",
}
"""When a command prints its second and third record."""

COMMON = {
    "algorithm": "the mapper, as the command line names it",
    "at": "the moment, counted in moves",
    "certified": "how many decisions have an accepted certificate",
    "cheapest": "the least that a run can cost",
    "checked": "how much was judged and decided",
    "claim": "the name of the claim",
    "claims": "the status of each claim",
    "class": "the class of worlds",
    "cost": "edge traversals of the run",
    "edges": "the number of edges",
    "entailed": "how many decisions follow from the history",
    "event": "the index in the trace; null: the whole run",
    "expected": "what had to be so",
    "faces": "the number of faces",
    "failing": "in how many worlds a claim fails",
    "file": "the file that was written",
    "findings": "what is wrong",
    "genus": "the genus of the world",
    "how": "how it was lost",
    "id": "the id of the world",
    "judgements": "the same as `claims`, with how much each status rests on",
    "kind": "inductive, mechanised, bounded, negative or mutant",
    "least": "the least cost of a proof",
    "least_cost": "the least cost of a proof",
    "mapper": "the mapper",
    "marker": "the dart that the marker points at; null: a world without edges",
    "message": "what is wrong, in one sentence",
    "name": "its name",
    "not_declared": "the claims of which the mapper declares nothing",
    "of": "the theorem from which a mutant takes a premise",
    "ok": "nothing is wrong, and nothing is left undecided",
    "order": "the policy that chooses the next hypothesis; null: the mapper has none",
    "other": "the cost of the other mapper",
    "pick": "the policy that chooses the next edge; null: the mapper has none",
    "policies": "the policies of the catalogue's algorithms",
    "ratio": "the cost divided by that of the reference, or by the least cost",
    "reference": "what the reference pays",
    "replay": "the command line that shows it again",
    "seed": "the seed of the draw",
    "seen": "what was so",
    "status": "the status of the claim",
    "stopped": "why the mapper delivered no map; null: it delivered one",
    "suite": "the suite of worlds",
    "target": "the mapper, as the command line names it",
    "total": "how much there is to judge",
    "verdict": "the verdict",
    "vertices": "the number of vertices",
    "why": "the reason, where something is not decided",
    "witness": "a world with the same history in which the mapper is wrong",
    "words": "the theorem in words",
    "world": "the world, as the command line names it",
    "worlds": "the number of worlds",
}
"""What a field of this name is where its class does not say it."""

SHARED = 2
"""An option that this many commands have in the same words stands in the table of shared ones."""

_PLAIN = {
    types.AnyType: "any JSON",
    types.BoolType: "true or false",
    types.FloatType: "number",
    types.IntType: "integer",
    types.NoneType: "null",
    types.StrType: "text",
}


def leaves(command: click.Command, path: str = "") -> Iterator[tuple[str, click.Command]]:
    """Every command that is no group, with the words that call it."""
    if not isinstance(command, click.Group):
        yield path, command
        return
    for name, part in command.commands.items():
        yield from leaves(part, f"{path} {name}".strip())


COMMANDS = dict(leaves(main))


def records(path: str) -> list[Any]:
    """The records that a command prints, as msgspec sees them."""
    found: list[Any] = []
    for place in ENTRIES[path].split():
        module, _, name = place.rpartition(":")
        home = import_module(module or COMMANDS[path].callback.__module__)
        found.append(types.type_info(attrgetter(name)(home)))
    return found


def page() -> str:
    """The whole page."""
    shared = _shared()
    parts = ["## Options that several commands share\n", _options(shared)]
    for path, command in COMMANDS.items():
        parts += _command(path, command, shared)
    parts.append("## Records\n\nParts of the entries above.\n")
    for record in _nested():
        parts += [
            f"### {record.cls.__name__}\n",
            _text(_summary(record.cls)) + "\n",
            _fields(record),
        ]
    return "\n".join(parts).rstrip("\n") + "\n"


def names() -> str:
    """The names that scripts use: a line for each command and for each record."""
    lines = ["# Commands with their options; the fields of an entry of `results`; those of records"]
    for path, command in COMMANDS.items():
        options = (name for option in _click_options(command) for name in option.opts)
        lines.append(f"{path}: {' '.join(options)}")
    for path in COMMANDS:
        lines += (f"{path} -> {_field_names(record)}" for record in records(path))
    lines += (f"{record.cls.__name__} -> {_field_names(record)}" for record in _nested())
    return "\n".join(lines) + "\n"


def _field_names(record: Any) -> str:
    return " ".join(field.encode_name for field in record.fields)


MODULES = (
    "topo_verify",
    "topo_verify.world.families",
    "topo_verify.strategies",
    "topo_verify.robot.events",
    "topo_verify.world.formats.nx",
)
"""What users import; a class is listed with its public methods."""


def python_names() -> str:
    """The public Python names, each with its signature and the first line of its docstring."""
    lines = ["# Public names by module. `help(topo_verify.explore)` prints a whole docstring."]
    for module_name in MODULES:
        module = import_module(module_name)
        public = getattr(module, "__all__", None) or [
            name
            for name, value in vars(module).items()
            if getattr(value, "__module__", None) == module_name and not name.startswith("_")
        ]
        lines += ["", f"## {module_name}", ""]
        for name in sorted(public):
            lines += _python_entry(name, getattr(module, name))
    return "\n".join(lines) + "\n"


def _python_entry(name: str, value: Any) -> Iterator[str]:
    """A name and its first line; those of a class's public methods and properties, indented."""
    function = value.fget if isinstance(value, property) else getattr(value, "func", value)
    function = getattr(function, "__func__", function)
    if not inspect.isclass(function) and not inspect.isfunction(function):
        return
    yield name + (_signature(function) if function is value or hasattr(value, "__func__") else "")
    yield f"    {inspect.cleandoc(function.__doc__ or '').partition(chr(10))[0]}".rstrip()
    for member, inside in vars(value).items() if inspect.isclass(value) else ():
        if not member.startswith("_"):
            yield from (f"    {line}" for line in _python_entry(f".{member}", inside))


def _signature(function: Any) -> str:
    """The parameters and the result, without `self` and without quotes around annotations."""
    try:
        text = str(inspect.signature(function))
    except (TypeError, ValueError):  # a class without __init__ of its own
        return ""
    text = re.sub(r"(: |-> )'([^']*)'", r"\1\2", text)
    return re.sub(r"^\((self|cls)(, )?", "(", text)


# ---------------------------------------------------------------- options


def _click_options(command: click.Command) -> list[click.Option]:
    return [one for one in command.params if isinstance(one, click.Option)]


def _row(option: click.Option) -> tuple[str, str, str]:
    """The spelling, the meaning and the default of an option."""
    words = "/".join(option.opts)
    if not option.is_flag:
        words += f" {option.make_metavar(click.Context(main))}"
    meaning, _, default = (option.help or "").partition("  [default: ")
    default = default.rstrip("]")
    if option.show_default and not default:
        value = option.default
        default = (
            ",".join(value)
            if isinstance(value, Sequence | tuple) and not isinstance(value, str)
            else str(value)
        )
    if option.multiple and not re.search("repeated|several times", meaning):
        meaning += " May be repeated."
    return (
        f"`{words}`",
        meaning.strip(),
        default if " " in default or not default else f"`{default}`",
    )


def _shared() -> list[tuple[str, str, str]]:
    rows = Counter(
        _row(option) for command in COMMANDS.values() for option in _click_options(command)
    )
    return [row for row, number in rows.items() if number >= SHARED]


def _options(rows: Sequence[tuple[str, str, str]]) -> str:
    lines = ["| option | meaning | default |", "| --- | --- | --- |"]
    lines += [_line(row) for row in rows]
    return "\n".join(lines) + "\n"


def _command(path: str, command: click.Command, shared: Sequence[object]) -> Iterator[str]:
    usage = " ".join(
        command.collect_usage_pieces(
            click.Context(command, info_name=path, help_option_names=["-h", "--help"])
        )
    )
    yield f"## {path}\n"
    yield f"    topo-verify {path} {usage}\n"
    yield _text(inspect.cleandoc(command.help or "")) + "\n"
    rows = [_row(option) for option in _click_options(command)]
    if mine := [row for row in rows if row not in shared]:
        yield _options(mine)
    names = ", ".join(row[0].split()[0].strip("`").join("``") for row in rows if row in shared)
    yield f"Shared: {names}.\n"
    for record in records(path):
        occasion = OCCASIONS.get(record.cls.__name__)
        yield f"Results{', ' + occasion if occasion else ''}:\n"
        yield _fields(record)


# ---------------------------------------------------------------- fields


def _nested() -> list[Any]:
    """Every record inside an entry, in the order of their names."""
    entries = [record for path in ENTRIES for record in records(path)]
    found: dict[type, Any] = {}
    waiting = [kind for record in entries for kind in _parts(record)]
    while waiting:
        kind = waiting.pop()
        if _is_record(kind) and kind.cls not in found:
            found[kind.cls] = kind
        if not _is_record(kind) or found[kind.cls] is kind:
            waiting += _parts(kind)
    names = Counter(cls.__name__ for cls in found)
    if several := [name for name, number in names.items() if number > 1]:
        raise ValueError(f"expected different names of records, got two of {several}; rename one")
    return sorted(found.values(), key=lambda kind: kind.cls.__name__)


def _is_record(kind: Any) -> bool:
    return isinstance(kind, types.StructType | types.DataclassType)


def _parts(kind: Any) -> list[Any]:
    """The types that stand in a type."""
    if _is_record(kind):
        return [field.type for field in kind.fields]
    if isinstance(kind, types.UnionType):
        return list(kind.types)
    if isinstance(kind, types.TupleType):
        return list(kind.item_types)
    if isinstance(kind, types.DictType):
        return [kind.key_type, kind.value_type]
    return [kind.item_type] if isinstance(kind, types.CollectionType) else []


def _type(kind: Any) -> str:  # noqa: PLR0911  a return for each kind
    """A type in words."""
    match kind:
        case types.UnionType():
            return " or ".join(_type(one) for one in kind.types)
        case types.LiteralType():
            return ", ".join(f"`{value}`" for value in kind.values)
        case types.TupleType():
            return f"({', '.join(_type(one) for one in kind.item_types)})"
        case types.DictType():
            return f"object of {_type(kind.value_type)}"
        case types.CollectionType():
            return f"list of {_type(kind.item_type)}"
        case types.StructType() | types.DataclassType():
            name = kind.cls.__name__
            return f"[{name}](#{name.lower()})"
        case _:
            return _PLAIN[type(kind)]


def _attributes(cls: type) -> dict[str, str]:
    """The sentence of each field that the docstrings of a class and its bases name."""
    texts = [inspect.cleandoc(base.__doc__ or "") for base in reversed(cls.__mro__)]
    text = "".join(text.partition("Attributes:\n")[2] + "\n" for text in texts)
    sentences: dict[str, str] = {}
    for line in re.findall(r"^ {4}(\w[\w, ]*: .*(?:\n {6,}.*)*)", text, re.MULTILINE):
        # "cost: over all worlds; priced: world by world" is about two fields.
        for part in re.split(r"; (?=`?\w+`?: )", " ".join(line.split())):
            names, _, sentence = part.partition(": ")
            sentences |= dict.fromkeys(names.replace("`", "").split(", "), sentence)
    return sentences


def _meaning(record: Any, field: Any) -> str:
    """The sentence of a field: of its class, of its name, or of the one record in it."""
    if sentence := _attributes(record.cls).get(field.name) or COMMON.get(field.encode_name):
        return re.sub(r"\bNone\b", "null", sentence.rstrip("."))
    inside = [kind for kind in (field.type, *_parts(field.type)) if _is_record(kind)]
    if len(inside) == 1:
        return _summary(inside[0].cls).rstrip(".")
    raise ValueError(
        f"expected a sentence for the field {field.name} of {record.cls.__module__}."
        f"{record.cls.__name__}; write it under Attributes in the docstring of the class"
    )


def _summary(cls: type) -> str:
    """The first paragraph of a docstring."""
    text = inspect.cleandoc(cls.__doc__ or "").split("\n\n")[0]
    return " ".join(text.split())


def _fields(record: Any) -> str:
    lines = ["| field | type | meaning |", "| --- | --- | --- |"]
    if isinstance(record, types.StructType) and record.tag is not None:
        lines.append(_line((f"`{record.tag_field}`", f"`{record.tag}`", "which record this is")))
    for field in record.fields:
        name, meaning = f"`{field.encode_name}`", _meaning(record, field)
        lines.append(_line((name, _type(field.type), meaning)))
    return "\n".join(lines) + "\n"


# ---------------------------------------------------------------- Markdown


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(_text(cell).replace('|', chr(92) + '|') for cell in cells)} |"


def _text(text: str) -> str:
    """A text with the signs of Markdown as they are, but for code and links."""
    pieces = re.split(r"(``?[^`]+``?|\[\w+\]\(#\w+\))", text.replace("\b\n", ""))
    pieces[::2] = [re.sub(r"([\\*_<\[\]])", r"\\\1", piece) for piece in pieces[::2]]
    return "".join(pieces)


if __name__ == "__main__":
    NAMES.write_text(names(), encoding="utf-8")
    PYTHON.write_text(python_names(), encoding="utf-8")
