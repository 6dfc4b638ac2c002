"""The door to the extras: what its tables name is there, and loads without heavy packages."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path
from typing import Any

import click
import pytest

from tests.python import python
from topo_verify import InputError, extras
from topo_verify.cli import SHORT_HELPS

ROOT = Path(__file__).resolve().parent.parent
COMMAND_LINE = [
    *extras.COMMANDS.values(),
    *(place for places in extras.OPTIONS.values() for place in places),
]
"""What the command line loads, for --help too."""
PLACES = [
    *COMMAND_LINE,
    *extras.ENGINES.values(),
    *extras.FUNCTION_MAKERS.values(),
    *extras.BACKENDS.values(),
]
EXTRAS = sorted(p.parent.name for p in (ROOT / "topo_verify" / "extra").glob("*/__init__.py"))


def named(place: str) -> str:
    return place.partition(".")[0]


def test_every_extra_brings_something_through_the_door() -> None:
    assert {named(place) for place in PLACES} == {*EXTRAS}
    assert extras.PACKAGES.keys() <= {*EXTRAS}


@pytest.mark.parametrize("extra", EXTRAS)
def test_an_extra_has_tests_and_a_page_and_describes_its_files(extra: str) -> None:
    home = ROOT / "topo_verify" / "extra" / extra
    described = (home / "__init__.py").read_text(encoding="utf-8")
    assert [p.name for p in home.glob("[!_]*.py") if p.name not in described] == []
    assert list((ROOT / "tests" / "extra" / extra).glob("test_*.py"))
    assert (ROOT / "docs" / "extra" / f"{extra}.md").is_file()


def test_a_command_is_in_one_place_and_has_its_line_in_help() -> None:
    files = {path.stem for path in (ROOT / "topo_verify" / "cli").glob("*.py")}
    assert extras.COMMANDS.keys() <= SHORT_HELPS.keys()
    assert SHORT_HELPS.keys() - extras.COMMANDS.keys() <= files
    assert extras.COMMANDS.keys().isdisjoint(files)


@pytest.mark.parametrize("name", extras.COMMANDS)
def test_a_command_is_found_by_its_name(name: str) -> None:
    assert extras.command(name).name == name


def test_a_command_without_added_options_stays_as_it_is() -> None:
    def run() -> int:
        return 0

    assert extras.options("tour")(run) is run


def test_the_options_of_extras_stand_where_the_command_asks_for_them() -> None:
    @click.command
    @click.option("--first")
    @extras.options("explore")
    @click.option("--last")
    def command(**_: object) -> int:
        return 0

    names = [option.name for option in command.params]
    assert (names[0], names[-1]) == ("first", "last")
    assert "svg" in names


def test_a_command_may_ask_for_one_option_where_it_belongs() -> None:
    @click.command
    @extras.options("prove", "certify")
    @click.option("--between")
    @extras.options("prove", "solver")
    def command(**_: object) -> int:
        return 0

    assert [option.opts for option in command.params] == [
        ["--certify"], ["--between"], ["--solver"],
    ]  # fmt: skip


@pytest.mark.parametrize("place", COMMAND_LINE)
def test_what_the_command_line_loads_needs_no_package_of_an_extra(place: str) -> None:
    packages = [name for names in extras.PACKAGES.values() for name in names]
    code = (
        f"import sys; sys.modules.update(dict.fromkeys({packages!r}))\n"
        f"from topo_verify import extras; extras.found({place!r})\n"
        "print(*{name.partition('.')[0] for name in sys.modules})"
    )
    done = python("-c", code, cwd=ROOT, check=True)
    if ".options:" in place:
        heavy = {"msgspec", "rich", "numpy", "networkx", "hypothesis", "z3"}
        assert not heavy & {*done.stdout.split()}


@pytest.mark.parametrize("extra", extras.PACKAGES)
def test_a_missing_package_is_one_sentence_with_what_brings_it(
    extra: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for package in extras.PACKAGES[extra]:
        monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(InputError) as error:
        extras.require(extra)
    words = [*extras.PACKAGES[extra], f"pip install 'topo-verify[{extra}]'"]
    assert [word for word in words if word not in str(error.value)] == []


@pytest.mark.parametrize("extra", EXTRAS)
def test_an_extra_whose_packages_are_installed_may_begin(extra: str) -> None:
    if missing := extras.missing_packages(extra):
        pytest.skip(f"{' and '.join(missing)} is not installed")
    extras.require(extra)


def test_pip_knows_each_extra_that_needs_packages_and_the_names_of_0_3() -> None:
    table: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    pip = table["optional-dependencies"]
    assert pip.keys() >= extras.PACKAGES.keys()
    assert pip["plots"] == ["topo-verify[figures]"]
    assert pip["proofs"] == ["topo-verify[sat]"]
