"""TARGET on the command line, and what a wrong one is told."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.shell_completion import ShellComplete

from tests.cli.conftest import Call, Refused
from topo_verify.cli import main

LINES = {
    "verify": "verify {} --quick",
    "search": "search {} --edges 2 --workers 0",
    "conform": "conform {} --worlds m2/3 --workers 0",
    "record": "record {} --worlds m2/3 --out b.gz",
    "compare": "compare b.gz {}",
}
"""A quick call of each command that takes a TARGET as an argument."""


@pytest.fixture
def baseline(call: Call) -> None:
    assert call("record basic --worlds m2/3 --out b.gz").exit_code == 0


@pytest.mark.parametrize(
    "line", [*(line.format("--target basic") for line in LINES.values()), "arena --target basic"]
)
def test_a_target_that_is_an_argument_is_no_option(line: str, refused: Refused) -> None:
    refused(line, "TARGET is an argument here: type it without --target\n")


@pytest.mark.parametrize("line", ["explore m2/3", "play m2/3"])
def test_the_former_name_of_target_is_answered(line: str, refused: Refused) -> None:
    refused(f"{line} --algorithm basic", "--algorithm went with version 0.4: type --target\n")


@pytest.mark.usefixtures("baseline")
@pytest.mark.parametrize(
    "line", [*(line.format("basic") for line in LINES.values()), "explore m2/3 --target basic"]
)
def test_a_program_is_a_target_as_well(line: str, refused: Refused) -> None:
    refused(f"{line} --cmd ./x", "one of them, not two")


@pytest.mark.parametrize("command", [*LINES, "arena", "explore", "replay", "play"])
def test_the_help_of_each_and_a_shell_offer_one_spelling(command: str, call: Call) -> None:
    """The argument where the command is about a mapper, --target where it is about a world."""
    text = " ".join(call(f"{command} --help").stdout.split())
    about_a_world = command in {"explore", "replay", "play"}
    assert ("--target TARGET" in text) == about_a_world
    assert ("[TARGET]" in text) != about_a_world
    assert "--algorithm" not in text
    completion = ShellComplete(main, {}, "topo-verify", "")
    offered = {item.value for item in completion.get_completions([command], "--")}
    assert ("--target" in offered) == about_a_world
    assert "--cmd" in offered
    assert "--algorithm" not in offered


# ---------------------------------------------------------------- help


@pytest.mark.parametrize("path", ["", *main.commands, "world sample"])
def test_h_is_short_for_help(path: str, call: Call) -> None:
    done = call(f"{path} -h")
    assert (done.exit_code, done.stderr) == (0, "")
    assert done.stdout == call(f"{path} --help").stdout


@pytest.mark.parametrize("group", ["", "world"])
def test_a_group_alone_shows_its_help(group: str, call: Call) -> None:
    """On stderr and with exit 2: in a script the name of a command is missing."""
    done = call(group)
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr == call(f"{group} --help").stdout


# ---------------------------------------------------------------- hints


@pytest.mark.parametrize("target", ["m.py:explore", "m.py", "pack.m:explore"])
def test_a_target_in_the_place_of_a_command_is_told_verify(target: str, refused: Refused) -> None:
    refused(f"{target} --quick", f"no such command {target!r}, did you mean verify {target}; ")


MODULE = """
from math import floor
LIMIT = 3
def explore(robot): ...
def _helper(robot): ...
class Walker: ...
"""


@pytest.mark.parametrize(
    ("target", "hint"),
    [
        ("m.py", "m.py is a file; name a mapper in it, as m.py:explore (it has explore, Walker)"),
        ("m", "m.py is a file; name a mapper in it, as m:explore (it has explore, Walker)"),
        ("empty.py", "empty.py is a file; name a mapper in it, as empty.py:explore"),
        ("gone.py", "there is no file 'gone.py'"),
        ("m.py:explor", "m.py has no attribute 'explor'; did you mean 'explore'?"),
        ("m.py:walker", "m.py has no attribute 'walker'; did you mean 'Walker'?"),
        ("m.py:", "m.py has no attribute ''; it has explore, Walker"),
        ("m.py:LIMIT.real.x", "m.py has no attribute 'LIMIT.real.x'\n"),
        ("m.py:Walker.step", "m.py has no attribute 'Walker.step'"),
        ("empty.py:explore", "empty.py has no attribute 'explore'\n"),
        ("bassic", "no algorithm 'bassic'; did you mean 'basic'? there are basic, "),
        ("basic,foldin", "no algorithm 'foldin'; did you mean 'folding'? there are basic, "),
        ("./m.so", "no algorithm './m.so': it is a file; to run it, --library ./m.so"),
        ("./m", "no algorithm './m': it is a file; to run it, --cmd ./m"),
        ("a-mapper", "no algorithm 'a-mapper': there are basic, "),
    ],
)
def test_a_wrong_target_is_told_the_right_one(
    target: str, hint: str, refused: Refused, folder: Path
) -> None:
    (folder / "m.py").write_text(MODULE)
    (folder / "empty.py").write_text("a syntax error is no mapper")
    for name in ("m", "m.so"):
        (folder / name).write_bytes(b"compiled")
    if ":" in target:
        (folder / "empty.py").write_text("")
    refused(f"verify {target}", hint)


# ---------------------------------------------------------------- names that are not UTF-8

NO_UTF8 = "r\udcff.py"
"""A file's name with the byte 0xff, as Python reads it from a command line."""

NAMING = [
    f"{command} '{NO_UTF8}:explore' {options}"
    for command, options in {
        "search": "--edges 2 --workers 0",
        "verify": "--quick",
        "conform": "--worlds edges<=1 --workers 1",
        "record": "--worlds edges<=1 --out base.gz",
        "arena": "--suite tiny --workers 0 --out league",
        "explore m2/5 --target": "--format json",
        "replay m2/5 --target": "--in-process",
    }.items()
]


@pytest.mark.parametrize("line", [*NAMING, f"search --cmd './{NO_UTF8}' --edges 2 --workers 0"])
def test_a_mapper_whose_name_is_not_utf8_is_bad_input(call: Call, folder: Path, line: str) -> None:
    (folder / NO_UTF8).write_text("import topo_verify\nexplore = topo_verify.CATALOGUE['basic']\n")
    done = call(line)
    assert done.exit_code == 2, done.output
    assert "expected a name in UTF-8; rename the file or the folder" in done.stderr
    assert done.stderr.isascii()


@pytest.mark.long
def test_a_mapper_that_reads_a_file_whose_name_is_not_utf8_has_no_ledger(
    call: Call, refused: Refused, folder: Path
) -> None:
    (folder / NO_UTF8).write_text("")
    (folder / "reads.py").write_text(
        "import os, topo_verify\nopen(os.fsdecode(b'r\\xff.py')).close()\n"
        "explore = topo_verify.CATALOGUE['basic']\n"
    )
    line = "search reads.py:explore --edges 1 --workers 0"
    assert call(line).exit_code == 0
    for option in ("", f"--depends '{NO_UTF8}' --in-process"):
        refused(f"{line} --ledger l.db {option}", "the mapper read", "expected a name in UTF-8")


@pytest.mark.parametrize("command", ["conform basic --workers 0", "record basic --out base.gz"])
def test_a_world_whose_name_is_not_utf8_is_bad_input(
    call: Call, refused: Refused, folder: Path, command: str
) -> None:
    named = (folder / NO_UTF8).with_suffix(".json")
    assert call("world convert m2/5 -o world.json").exit_code == 0
    (folder / "world.json").rename(named)
    refused(f"{command} --worlds '{named.name}'", "expected a name in UTF-8")


# ---------------------------------------------------------------- a working folder that was removed


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("search basic --edges 1 --workers 0 --ledger l.db", 2),
        ("search module:explore --edges 1 --workers 0", 2),
        ("explore m1/0 --target {}/mappers.py:raises_or_strolls", 1),
        ("explore m1/0 --target {}/mappers.py:raises_or_strolls --in-process", 1),
    ],
)
def test_a_working_folder_that_was_removed_is_one_sentence_or_no_matter(
    call: Call, folder: Path, monkeypatch: pytest.MonkeyPatch, line: str, code: int
) -> None:
    gone = folder / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    done = call(line.format(folder))
    assert done.exit_code == code, done.output
    assert "a bug of topo-verify" not in done.stderr
    assert len(done.stderr.splitlines()) == (code == 2)
