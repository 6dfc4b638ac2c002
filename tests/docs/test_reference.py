"""What docs/reference.py makes: names that are current, a page of commands that is true."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click
import msgspec
import pytest
from click.testing import CliRunner
from msgspec import inspect as types

from tests.docs.test_site import part
from tests.pages import ROOT
from topo_verify.cli import FORMER, main

MADE = part("reference.py")
PAGE: str = MADE.page()
COMMANDS: dict[str, click.Command] = MADE.COMMANDS
CLI = ROOT / "topo_verify" / "cli"


def sections(text: str) -> dict[str, str]:
    """The text of each section, by its heading."""
    pieces = re.split(r"^##+ (.+)\n", text, flags=re.MULTILINE)
    return dict(zip(pieces[1::2], pieces[2::2], strict=True))


def tables(section: str) -> list[list[str]]:
    """The fields of each table of results in a section."""
    found = re.findall(r"^\| field \|.*\n.*\n((?:\|.*\n)+)", section + "\n", re.MULTILINE)
    return [re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE) for table in found]


def test_the_names_in_git_are_those_of_the_code() -> None:
    for file, made in ((MADE.NAMES, MADE.names()), (MADE.PYTHON, MADE.python_names())):
        assert file.read_text(encoding="utf-8") == made, "make it anew: python docs/reference.py"


def test_a_new_option_and_a_new_field_are_new_names(monkeypatch: pytest.MonkeyPatch) -> None:
    tour, before = COMMANDS["tour"], set(MADE.names().split())
    monkeypatch.setattr(tour, "params", [*tour.params, click.Option(["--colour"])])
    record: Any = types.type_info(msgspec.defstruct("Entry", [("novel", int)]))

    def records(path: str) -> list[Any]:
        return [record] if path == "tour" else []

    monkeypatch.setattr(MADE, "records", records)
    assert {"--colour", "novel"} <= {*MADE.names().split()} - before


def test_what_went_stands_on_its_page() -> None:
    page = (ROOT / "docs" / "howto" / "from-0.3-to-0.4.md").read_text(encoding="utf-8")
    for spelling in FORMER:
        assert f"`{spelling}" in page


def missing(text: str) -> Iterator[str]:
    """The options and fields that a page lacks, each with its command or record."""
    found = sections(text)
    shared = found["Options that several commands share"]
    for path, command in COMMANDS.items():
        section = found.get(path, "")
        for option in command.params:
            for name in option.opts if isinstance(option, click.Option) else ():
                if not re.search(rf"`[^`\s]*(?<![\w-]){name}(?![\w-])[^`]*`", section):
                    yield f"{path} {name}"
        for name in re.findall(r"`(-[\w-]+)`", section.partition("Shared: ")[2].partition(".")[0]):
            if f"`{name}" not in shared + section.partition("Shared: ")[0]:
                yield f"shared {name}"
    waiting = [(path, MADE.records(path)) for path in COMMANDS]
    waiting += [(one.cls.__name__, [one]) for one in MADE._nested()]
    for name, records in waiting:
        listed = tables(found.get(name, ""))
        for number, record in enumerate(records):
            there = listed[number] if number < len(listed) else []
            yield from (
                f"{name} {field.encode_name}"
                for field in record.fields
                if field.encode_name not in there
            )


def test_no_option_and_no_field_is_missing() -> None:
    assert list(missing(PAGE)) == []


def test_a_missing_option_and_a_missing_field_are_seen() -> None:
    lines = PAGE.splitlines()
    gone = [line for line in lines if line.startswith(("| `--dask ", "| `least_cost`"))]
    assert len(gone) >= 3
    assert "search --dask" in missing("\n".join(line for line in lines if line not in gone))
    rest = "\n".join(line for line in lines if not line.startswith("| `least_cost`"))
    assert list(missing(rest)) == [
        f"{command} least_cost" for command in ("explore", "world show", "certify")
    ]


def test_a_new_option_makes_another_page(monkeypatch: pytest.MonkeyPatch) -> None:
    tour = COMMANDS["tour"]
    option = click.Option(["--colour"], help="Paint it.")
    monkeypatch.setattr(tour, "params", [*tour.params, option])
    assert list(missing(PAGE)) == ["tour --colour"]
    assert "| `--colour TEXT` | Paint it. |" in MADE.page()


def test_a_field_without_a_sentence_is_refused() -> None:
    record: Any = types.type_info(msgspec.defstruct("Entry", [("novel", int)]))
    with pytest.raises(ValueError, match=r"a sentence for the field novel of .*\.Entry"):
        MADE._fields(record)


def yielded() -> Iterator[str]:
    """The records that the commands yield, by the types of their generators: Result[RECORD]."""
    for path in [*CLI.glob("*.py"), *(CLI.parent / "extra").rglob("*.py")]:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            match node:
                case ast.Subscript(value=ast.Name(id="Result"), slice=ast.Name(id=name)) | (
                    ast.Subscript(value=ast.Name(id="Result"), slice=ast.Attribute(attr=name))
                ):
                    yield name
                case _:
                    pass


def test_every_record_that_a_command_yields_has_its_table() -> None:
    listed = {record.cls.__name__ for path in COMMANDS for record in MADE.records(path)}
    # GameEntry is one of two.
    unions = {"E", "GameEntry"}
    assert set(yielded()) - unions == listed
    assert MADE.ENTRIES.keys() == COMMANDS.keys()


LINES = [
    "explore m2/5 --target basic",
    "world show m2/5",
    "world list --edges 2",
    "world count --edges 2",
    "world convert m2/5",
    "world sample --edges 3",
    "world draw m2/5",
    "search basic --edges 1 --workers 0",
    "prove percept",
    "prove --list",
    "conform basic --worlds m1/0 --workers 0",
    "record basic --worlds m1/0 --out b.gz",
    "replay m1/0",
    "play m1/0",
    "tour m1/0",
]


@pytest.mark.parametrize("line", LINES)
def test_an_entry_has_the_fields_of_the_page(
    line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(main, [*line.split(), "--format", "json"])
    assert done.exit_code == 0, done.stderr
    path = next(path for path in COMMANDS if line.startswith(path))
    documented = tables(sections(PAGE)[path])
    for entry in json.loads(done.stdout)["results"]:
        assert list(entry) in documented
