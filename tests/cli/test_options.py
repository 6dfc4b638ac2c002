"""Options that are given twice: refused where one value counts, joined where several do."""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from typing import Any

import click
import pytest

from tests.cli.conftest import Call, Refused, Results
from topo_verify.cli import main

REPEATABLE = {
    "explore": {"--target"},
    "play": {"--target", "--name"},
    "search": {"--class", "--depends"},
    "world count": {"--class"},
    "world list": {"--class"},
    "world sample": {"--class"},
    "conform": {"--worlds"},
    "record": {"--worlds"},
    "arena": {"--target", "--cmd", "--library", "--name", "--worlds"},
    "prove": {"--kind"},
}
"""The options of each command that may be given several times; every value counts."""


def leaves(command: click.Command, path: str = "") -> Iterator[tuple[str, click.Command]]:
    """Every command that is no group, with the words that call it."""
    if not isinstance(command, click.Group):
        yield path, command
        return
    for name, part in command.commands.items():
        yield from leaves(part, f"{path} {name}".strip())


OPTIONS = [
    pytest.param(path, option, name, id=f"{path} {name}")
    for path, command in leaves(main)
    for option in command.params
    if isinstance(option, click.Option)
    for name in option.opts
]


def test_the_tree_has_every_command() -> None:
    assert len(list(leaves(main))) == 20
    assert len(OPTIONS) > 200


@pytest.mark.parametrize(("path", "option", "name"), OPTIONS)
def test_an_option_of_one_value_is_refused_when_it_is_given_twice(
    path: str, option: click.Option, name: str, call: Call
) -> None:
    assert option.multiple == (name in REPEATABLE.get(path, set()))
    if option.multiple:
        return
    values = ["", ""] if option.is_flag else [" one", "=two" if name.startswith("--") else " two"]
    done = call(f"{path} {name}{values[0]} {name}{values[1]}")
    assert (done.exit_code, done.stdout) == (2, "")
    got = "it twice" if option.is_flag else "'one' and 'two'"
    words = f"topo-verify {path}: expected {name} at most once, got {got}: leave "
    assert done.stderr.startswith(words), done.stderr
    assert done.stderr.count("\n") == 1


def test_all_values_of_three_are_named(call: Call) -> None:
    done = call("search basic --edges 1 --edges 2 --edges 3")
    assert "expected --edges at most once, got '1', '2' and '3': leave out all but one" in (
        done.stderr
    )


@pytest.mark.parametrize("line", ["search basic --edges 3 --edges 1 --help", "search --help -h"])
def test_help_is_shown_whatever_stands_beside_it(line: str, call: Call) -> None:
    done = call(line)
    assert done.exit_code == 0
    assert done.stdout.startswith("Usage: topo-verify search ")


# ---------------------------------------------------------------- several that count


def test_every_algorithm_counts(results: Results) -> None:
    """The right one, named last, does not hide the wrong one."""
    line = "explore m2/5 --target mappers.py:guesses --target basic --target folding"
    entries = results(line, code=1)["results"]
    assert [(one["algorithm"], one["ok"]) for one in entries] == [
        ("mappers.py:guesses", False),
        ("basic", True),
        ("folding", True),
    ]
    (page,) = results("play m2/5 --target basic --target folding")["results"]
    assert page["algorithms"] == ["basic", "folding"]


def test_a_file_may_have_a_comma_in_its_name(call: Call, folder: Any) -> None:
    (folder / "a,b.py").write_text("from mappers import right\n")
    assert call("explore m2/5 --target a,b.py:right").exit_code == 0


@pytest.mark.parametrize("classes", [("planar", "simple"), ("simple", "planar"), ("any", "simple")])
@pytest.mark.parametrize(
    "line",
    [
        pytest.param("search basic --edges 3", marks=pytest.mark.long),
        "world count --edges 3",
        "world list --edges 3",
    ],
)
def test_classes_are_joined_as_by_a_comma(line: str, classes: tuple[str, str], call: Call) -> None:
    """Of one class given twice every world has both properties."""
    apart = call(f"{line} --class {classes[0]} --class {classes[1]}")
    together = call(f"{line} --class {','.join(classes)}")
    assert apart.exit_code == together.exit_code == 0
    assert apart.stdout == together.stdout
    assert apart.stdout != call(line).stdout


def test_classes_that_contradict_each_other_are_refused(refused: Refused) -> None:
    refused("search basic --class genus:1 --class planar", "contradicts itself")


def test_the_line_that_repeats_a_run_keeps_every_value(call: Call, folder: Any) -> None:
    line = "search basic --edges 2 --class planar --class simple"
    assert call(f"{line} --report page.html").exit_code == 0
    assert shlex.join(["topo-verify", *line.split()]) in (folder / "page.html").read_text()
