"""Exit codes, the envelope, and the sentences on stderr."""

from __future__ import annotations

import errno
import json
import os
import shlex
import signal
import subprocess
import sys
from pathlib import Path
from unittest.mock import Mock

import pytest

from tests.cli.conftest import Call, Program, interrupted
from tests.python import python
from topo_verify.cli import SHORT_HELPS, main, runs

COMMANDS = (
    *("verify", "explore", "world", "search", "prove", "conform", "record", "compare"),
    *("replay", "play", "certify", "tour", "arena", "header", "reproduce"),
)
LEAVES = (
    *(command for command in COMMANDS if command not in ("world", "certify")),
    *(f"world {w}" for w in ("show", "list", "convert", "count", "sample", "draw")),
)


# ---------------------------------------------------------------- 0, 1, 2, 3, 70


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("explore m3/14", 0),
        ("explore m3/14 --target mappers.py:guesses", 1),
        ("explore m3/9999", 2),
        ("explore m3/14 --no-such-option", 2),
        ("explore m3/14 --target mappers.py:strolls --world-timeout 0.1", 3),
        # 1 beats 3
        ("explore m1/0 nyc --target mappers.py:raises_or_strolls --world-timeout 1", 1),
    ],
)
def test_each_exit_code_is_told_by_the_envelope_too(call: Call, line: str, code: int) -> None:
    done = call(f"{line} --format json")
    assert done.exit_code == code, done.output
    if code == 2:
        assert done.stdout == ""
        assert done.stderr.startswith("topo-verify")
        assert done.stderr.count("\n") == 1
    else:
        envelope = json.loads(done.stdout)
        assert (envelope["exit"], envelope["ok"]) == (code, code == 0)


def test_our_bug_exits_70_and_says_how_to_report_it(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(runs, "resolve_world", Mock(side_effect=KeyError("planted", 0)))
    done = call("explore m3/14 --target basic")
    assert done.exit_code == 70
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    for word in ("bug of topo-verify", "KeyError: ('planted'", "explore m3/14", "report"):
        assert word in done.stderr
    monkeypatch.setenv("TOPO_VERIFY_TRACEBACK", "1")
    assert "Traceback (most recent call last)" in call("explore m3/14").stderr


# ---------------------------------------------------------------- help


def test_help_lists_the_commands_in_order_with_a_line_each(call: Call) -> None:
    done = call("--help")
    lines = done.stdout.split("Commands:\n")[1].split("\n\n")[0].splitlines()
    assert [line.split()[0] for line in lines] == list(COMMANDS) == list(main.commands)
    assert not [line for line in lines if line.endswith("...")]


def test_each_command_has_the_name_and_the_line_that_the_table_gives_it() -> None:
    commands = main.commands.items()
    assert all(command.name == name for name, command in commands)
    assert {name: one.get_short_help_str() for name, one in commands} == SHORT_HELPS


@pytest.mark.parametrize("option", ["--help", "--version"])
def test_no_command_is_imported_for_the_help_page_and_the_version(option: str) -> None:
    code = f"""
import sys
from topo_verify.cli import SHORT_HELPS, main
try:
    main(["{option}"])
finally:
    print([n for n in [*SHORT_HELPS, "options"] if f"topo_verify.cli.{{n}}" in sys.modules])
"""
    done = python("-c", code)
    assert done.stdout.endswith("[]\n"), done.stderr


@pytest.mark.parametrize("command", ["", *COMMANDS, *(leaf for leaf in LEAVES if " " in leaf)])
def test_every_help_ends_with_examples_and_exit_codes(call: Call, command: str) -> None:
    done = call(f"{command} --help")
    assert done.exit_code == 0
    assert "Examples:\n    topo-verify " in done.stdout
    assert "Exit codes: 0 nothing found; 1 " in done.stdout.split("Examples:")[1]


@pytest.mark.parametrize("command", LEAVES)
def test_every_command_takes_format_and_quiet(call: Call, command: str) -> None:
    text = call(f"{command} --help").stdout
    assert "--format [pretty|json|markdown]" in text
    assert "--quiet" in text


def test_version_names_the_program_and_its_version(call: Call) -> None:
    import topo_verify

    assert call("--version").stdout == f"topo-verify {topo_verify.__version__}\n"


# ---------------------------------------------------------------- streams


def test_quiet_keeps_remarks_off_stderr_but_no_errors(call: Call) -> None:
    assert call("world sample --edges 5").stderr == "topo-verify: seed 0\n"
    assert call("world sample --edges 5 --quiet").stderr == ""
    assert call("explore nowhere.json --quiet").stderr != ""


@pytest.mark.nightly
def test_a_terminal_without_our_letters_gets_others(program: Program) -> None:
    done = program("verify basic,enhancement-i --quick", PYTHONIOENCODING="ascii")
    assert done.returncode == 0, done.stderr
    assert "\\xd7 2 mappers" in done.stdout


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("verify enhancement-iii-all+i,folding --quick", 0),
        ("explore nyc m4/99 --pick 'random(7)'", 0),
        ("prove percept records-written-early new-apart-step", 0),
        ("search mappers.py:ignores_direction --edges 2 --keep-going --workers {}", 1),
        ("conform mappers.py:ignores_direction --worlds generated:8 --workers {}", 1),
    ],
)
def test_runs_differ_in_timing_alone(program: Program, line: str, code: int) -> None:
    texts = {
        program(f"{line.format(n)} --format json", PYTHONHASHSEED=str(n)).stdout.split('"timing"')[
            0
        ]
        for n in range(3 if "{}" in line else 2)
    }
    assert len(texts) == 1
    assert json.loads(texts.pop() + '"timing": {}}')["exit"] == code


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("--help", 0),
        pytest.param("explore nyc", 0, marks=pytest.mark.long),
        ("world show nyc --format json", 0),
        pytest.param("verify", 3, marks=pytest.mark.long),  # the work ends early
    ],
)
def test_a_reader_who_leaves_is_no_error(folder: Path, line: str, code: int) -> None:
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(
        [sys.executable, "-m", "topo_verify", *line.split()],
        cwd=folder,
        stdout=write,
        stderr=subprocess.PIPE,
        check=False,
    )
    os.close(write)
    assert (done.returncode, done.stderr) == (code, b"")


@pytest.mark.long
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full here")
@pytest.mark.parametrize(
    ("line", "code", "said"),
    [
        ("explore m3/9999 2>/dev/full", 2, ""),
        ("world sample --edges 5 2>/dev/full", 0, ""),
        ("--help >/dev/full", 2, ""),
        ("explore nyc >/dev/full", 2, "cannot write to standard output: No space left on device"),
        ("explore nyc >&-", 2, "standard output is closed"),
        ("explore nyc >&- 2>&-", 2, ""),
        ("--help >&-", 2, "standard output is closed"),
        ("explore m3/9999 2>&-", 2, ""),
        ("explore m3/14 2>&-", 0, ""),
        ("world show - <&-", 2, ""),
        ("certify - <&-", 2, ""),
    ],
)
def test_exit_1_is_for_counterexamples_and_not_for_broken_streams(
    folder: Path, line: str, code: int, said: str
) -> None:
    shell = f"{shlex.quote(sys.executable)} -m topo_verify {line}"
    done = subprocess.run(["/bin/sh", "-c", shell], cwd=folder, capture_output=True, check=False)
    assert done.returncode == code
    assert said.encode() in done.stderr
    assert b"Traceback" not in done.stderr
    assert b"bug" not in done.stderr


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (MemoryError(), 3, "out of memory before the end"),
        (OSError(errno.ENOMEM, "Cannot allocate memory"), 3, "out of memory before the end"),
        (FileNotFoundError(2, "No usable temporary directory found"), 2, "TMPDIR no folder?"),
        (OSError(errno.ENOSPC, "No space left on device"), 2, "is the disk full"),
    ],
)
def test_what_the_machine_lacks_is_no_bug_of_ours(
    call: Call, monkeypatch: pytest.MonkeyPatch, error: Exception, code: int, words: str
) -> None:
    monkeypatch.setattr(runs, "resolve_world", Mock(side_effect=error))
    done = call("explore m3/14 --target basic")
    assert done.exit_code == code, done.output
    assert words in done.stderr
    assert done.stderr.count("\n") == 1


# ---------------------------------------------------------------- Ctrl-C


@pytest.mark.long
@pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_and_sigterm_exit_3_and_print_what_is_done(folder: Path, by: signal.Signals) -> None:
    words = ("verify", "mappers.py:starts_and_sleeps", "--move-timeout", "60", "--format", "json")
    code, out, error = interrupted(folder, *words, by=by)
    parts = json.loads(out)["results"]
    assert code == json.loads(out)["exit"] == 3
    assert [(part["part"], part["verdict"]) for part in parts] == [("small-worlds", "UNKNOWN")]
    assert parts[0]["checked"] == 2  # the worlds of one edge
    assert error == "topo-verify: interrupted after 1 result\n"


@pytest.mark.long
def test_an_interrupted_explore_keeps_the_runs_that_are_done(folder: Path) -> None:
    words = ("explore", "m1/0", "m2/5", "--target", "mappers.py:starts_and_sleeps")
    code, out, error = interrupted(folder, *words, "--move-timeout", "60")
    assert code == 3
    assert "m1/0" in out
    assert "m2/5" not in out
    assert "interrupted after 1 result" in error


def test_ctrl_c_before_any_work_exits_3(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("topo_verify.cli.options.targets", Mock(side_effect=KeyboardInterrupt))
    done = call("verify")
    assert done.exit_code == 3
    assert done.stderr == "topo-verify: interrupted before the first result\n"


# ---------------------------------------------------------------- what is left in the folder


@pytest.mark.long
def test_worlds_are_drawn_and_hypothesis_leaves_no_folder(program: Program, folder: Path) -> None:
    line = "world sample --strategy 'worlds(max_edges=9)' -n 40"
    before = sorted(folder.iterdir())
    done = program(line, PYTHONWARNINGS="error", PYTHONDONTWRITEBYTECODE="1")
    assert done.returncode == 0, done.stderr
    assert sorted(folder.iterdir()) == before
