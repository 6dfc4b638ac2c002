"""The launcher: its forks are hidden from their first moment on, and are like a fresh process."""

# A test may look inside.
# pyright: reportPrivateUsage=false

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from tests.python import python as ran
from topo_verify.errors import HelperLost
from topo_verify.programs import launcher
from topo_verify.programs.launcher import launch, prepare

LINUX = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere no process can be hidden")


@pytest.fixture(autouse=True)
def own_launcher(monkeypatch: pytest.MonkeyPatch) -> None:
    """No launcher yet; one that was started ends when its tests have."""
    monkeypatch.setattr(launcher, "_launchers", [])


TASKS = """
import json, os, sys
def tells(reader, writer):
    print("printed")
    told = [os.environ.get("SAID"), os.getcwd(), sys.stdin.read(), reader.readline().decode()]
    writer.write(json.dumps(told).encode() + b"\\n")
    writer.flush()
def ends(reader, writer):
    sys.exit(3)
"""


@pytest.fixture
def tasks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "tasks.py").write_text(TASKS)
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    return tmp_path


def heard(process: launcher.Launched) -> str:
    with process.channel.makefile() as lines:
        return lines.readline()


def test_a_fork_has_our_environment_folder_and_standard_error_of_now(
    tasks: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    prepare()
    monkeypatch.setenv("SAID", "later")
    monkeypatch.chdir(tasks)
    (tasks / "there").mkdir()
    for folder, place in ((None, tasks), ("there", tasks / "there")):
        process = launch("tasks:tells", folder=folder)
        process.channel.sendall(b"a line\n")
        assert heard(process) == f'["later", "{place}", "", "a line\\n"]\n'
        assert process.wait() == 0
        process.channel.close()
    assert capfd.readouterr() == ("", "printed\n" * 2)


@pytest.mark.usefixtures("tasks")
def test_the_end_of_a_fork_is_told_as_an_exit_code_or_a_signal() -> None:
    ends, waits = launch("tasks:ends"), launch("tasks:tells")
    assert os.getpgid(waits.pid) == waits.pid
    os.kill(waits.pid, signal.SIGTERM)
    assert (ends.wait(), waits.wait()) == (3, -signal.SIGTERM)
    for process in (ends, waits):
        process.channel.close()


@pytest.mark.usefixtures("tasks")
def test_an_answer_that_ctrl_c_left_unread_is_not_taken_for_another() -> None:
    process = launch("tasks:ends")
    started_by = launcher._launcher()
    started_by._control.sendall(launcher._ORDER.pack(0, b"-", process.pid))
    other = launch("tasks:ends")
    assert other.pid != process.pid
    assert other.wait() == 3
    for one in (process, other):
        one.channel.close()


@pytest.mark.usefixtures("tasks")
def test_a_launcher_that_is_killed_is_replaced_until_a_program_was_started() -> None:
    process = launch("tasks:tells")
    killed = launcher._launcher()._process
    killed.kill()
    assert process.wait() == -signal.SIGKILL
    process.channel.close()
    other = launch("tasks:ends")
    assert other.wait() == 3
    other.channel.close()
    prepare()
    killed = launcher._launcher()._process
    killed.kill()
    killed.wait()
    with pytest.raises(HelperLost, match="none can be started beside a mapper"):
        launch("tasks:ends")


COPIES = """
import os
from topo_verify.programs.launcher import launch, prepare
prepare()
if os.fork() == 0:
    process = launch("sys:intern")
    process.channel.close()
    os._exit(process.wait() != 1)  # it is called with the wrong arguments
assert os.waitstatus_to_exitcode(os.wait()[1]) == 0
process = launch("sys:intern")
assert process.wait() == 1
process.channel.close()
"""


def test_a_copy_of_the_process_has_a_launcher_of_its_own() -> None:
    done = ran("-c", COPIES)
    assert done.returncode == 0, done.stderr


PEEPS = """
import ctypes, os, sys
def tried(what, how):
    try:
        return what + " can be had" if how() >= 0 else ""
    except OSError:
        return ""
process, call = int(sys.argv[1]), ctypes.CDLL(None).syscall
pidfd = os.pidfd_open(process)
print(*filter(None, [
    tried("memory", lambda: os.open(f"/proc/{process}/mem", os.O_RDONLY)),
    *(tried("a file", lambda: os.open(f"/proc/{process}/fd/{n}", os.O_WRONLY)) for n in range(9)),
    *(tried("its own file", lambda: call(438, pidfd, n, 0)) for n in range(9)),
    tried("trace", lambda: ctypes.CDLL(None).ptrace(16, process, None, None)),
]), sep=", ")
"""


@LINUX
def test_a_fork_is_hidden_before_it_has_read_what_it_is_to_do() -> None:
    """Its first moment lasts as long as the test: it waits for a line that does not come."""
    prepare()
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as other:
        if "memory can be had" not in ran("-c", PEEPS, other.pid).stdout:
            pytest.skip("here no process reads the memory of another")
        other.kill()
    ours, theirs = socket.socketpair()
    with ours, theirs:
        process = launcher._launcher().ask(launcher._START, files=(theirs.fileno(), 2))
        assert ran("-c", PEEPS, process).stdout == "\n"
        assert ran("-c", PEEPS, launcher._launcher()._process.pid).stdout == "\n"
        os.kill(process, signal.SIGKILL)
        assert launcher._launcher().ask(launcher._WAIT, process) == -signal.SIGKILL
