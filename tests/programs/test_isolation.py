"""What a mapper in another process finds when it looks at the process that judges it."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.python import python as ran
from topo_verify.programs.isolation import python_command

HIDDEN = "m3/14 is the world"

HARNESS = f"""
import ctypes, subprocess, sys
from topo_verify.programs import isolation
secret = ctypes.create_string_buffer({HIDDEN.encode()!r})
if sys.argv[1] == "shielded":
    assert isolation.shield()
place = str(ctypes.addressof(secret))
sys.exit(subprocess.run([sys.executable, "-c", sys.argv[2], place, sys.argv[3]]).returncode)
"""

PEEPS = """
import os, sys
parent, place, size = os.getppid(), int(sys.argv[1]), int(sys.argv[2])
try:
    with open(f"/proc/{parent}/mem", "rb") as memory:
        memory.seek(place)
        print(memory.read(size).decode())
except OSError as error:
    print(type(error).__name__)
"""


def peeped(how: str) -> str:
    """What a child reads in the memory of its parent."""
    size = str(len(HIDDEN))
    return ran("-c", HARNESS, how, PEEPS, size).stdout.strip()


def test_a_child_cannot_read_the_memory_of_a_shielded_process() -> None:
    if peeped("open") != HIDDEN:
        pytest.skip("here no process reads the memory of another")
    assert peeped("shielded") == "PermissionError"


DUMPABLE = """
import ctypes, sys
from topo_verify.programs import isolation
library, PR_GET_DUMPABLE = ctypes.CDLL(None), 3
print(library.prctl(PR_GET_DUMPABLE), isolation.shield(), library.prctl(PR_GET_DUMPABLE))
"""


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere no process can hide its memory")
def test_a_shielded_process_is_not_dumpable() -> None:
    """This is what keeps out an ordinary user; root is kept out by the capability it lacks."""
    assert ran("-c", DUMPABLE).stdout.split() == ["1", "True", "0"]


LOOKS = """
import os
def explore(robot):
    with open(f"/proc/{os.getppid()}/cmdline", "rb") as file:
        raise LookupError(file.read().strip(b"\\0").split(b"\\0"))
"""


@pytest.mark.skipif(not Path("/proc/self/cmdline").exists(), reason="no /proc here")
def test_no_world_stands_on_the_command_line_that_a_mapper_can_read(tmp_path: Path) -> None:
    (tmp_path / "looks.py").write_text(LOOKS)
    line = "explore m3/14 --target looks.py:explore --format json"
    done = ran("-m", "topo_verify", *line.split(), cwd=tmp_path)
    assert done.returncode == 1, done.stderr
    assert "LookupError: [b'" in done.stdout
    assert "b'm3/14'" not in done.stdout
    assert "b'-m']" in done.stdout  # what is left of the command line


def test_our_own_processes_import_nothing_from_the_current_folder(tmp_path: Path) -> None:
    for name in ("json", "msgspec"):  # one is imported before our path is set, one after
        (tmp_path / f"{name}.py").write_text(f"raise SystemExit('the wrong {name}')")
    command = python_command("topo_verify.programs.serve:child", "topo_verify.algorithms:nothing")
    done = ran(*command[1:], cwd=tmp_path, input="")
    assert "has no attribute 'nothing'" in done.stdout, done.stderr
