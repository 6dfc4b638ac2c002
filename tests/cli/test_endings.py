"""One ending for every run: exit code, standard output and files agree, whatever ends it.

Signals come from the program itself (`raise_signal`), so no test depends on the clock. At random
moments they come in benchmarks/torture/endings.py.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from unittest.mock import Mock
from xml.etree import ElementTree as ET

import pytest

from tests.cli.conftest import Call, Program, interrupted
from tests.processes import state
from tests.python import python
from tests.studies.search.searching import wait_for
from topo_verify import World
from topo_verify.cli import runs

ENDS = """
import os, resource, signal, time
from topo_verify.algorithms import CATALOGUE

explore = CATALOGUE["basic"]

def leaves(robot):
    os._exit(0)

def claims(robot):
    os._exit(1)

def crashes(robot):
    os.kill(os.getpid(), signal.SIGSEGV)

def killed(robot):
    os.kill(os.getpid(), signal.SIGKILL)

def quits(robot):
    os.kill(os.getpid(), signal.SIGQUIT)

def catches(robot):
    try:
        signal.raise_signal(signal.SIGINT)
    except KeyboardInterrupt:
        return {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}

def converts(robot):
    try:
        signal.raise_signal(signal.SIGTERM)
    except KeyboardInterrupt:
        raise ValueError("mine") from None

def waits(robot):
    try:
        signal.raise_signal(signal.SIGINT)
    except KeyboardInterrupt:
        while True:
            pass

def parent(name):
    def mapper(robot):
        os.kill(os.getppid(), getattr(signal, name))
        time.sleep(2)
        return explore(robot)
    return mapper

terminates, hangs_up, kills, exits = map(parent, ("SIGTERM", "SIGHUP", "SIGKILL", "SIGQUIT"))

def closes(robot):
    os.closerange(3, 99)
    return explore(robot)

def silences(robot):
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    return explore(robot)

def starves(robot):
    resource.setrlimit(resource.RLIMIT_NOFILE, (0, 0))
    return explore(robot)

def reaps(robot):
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    return explore(robot)

class Loses:
    def __del__(self):
        signal.raise_signal(signal.SIGINT)

def loses(robot):
    Loses()
    return explore(robot)
"""

FILES = ("--report", "r.html", "--junit", "r.xml", "--badge", "r.svg")


@pytest.fixture(autouse=True)
def stocked(folder: Path) -> None:
    """The folder has ends.py."""
    (folder / "ends.py").write_text(ENDS)


def codes(folder: Path) -> set[int]:
    """What page, JUnit file and badge say, as exit codes; a file that is missing says nothing."""
    said: set[int] = set()
    if (folder / "r.html").exists():
        said |= {n for n in range(4) if f"<p>Exit code {n}: " in (folder / "r.html").read_text()}
    if (folder / "r.xml").exists():
        root = ET.fromstring((folder / "r.xml").read_text())  # noqa: S314  our own file
        failures, errors = (
            sum(int(suite.get(kind, "0")) for suite in root) for kind in ("failures", "errors")
        )
        said.add(1 if failures else 3 if errors else 0)
    if (folder / "r.svg").exists():
        badge = (folder / "r.svg").read_text()
        letters = {">R<": 1, ">U<": 3, ">E<": 0, ">S<": 0}
        said |= {code for letter, code in letters.items() if letter in badge}
    return said


def ran(folder: Path, *words: str, first: str = "") -> tuple[int, str, str]:
    """Exit code and streams of a command, before which some lines of Python run."""
    code = f"{first}\nfrom topo_verify.cli import main\nmain()"
    done = python("-c", code, *words, cwd=folder, timeout=120)
    assert "Traceback" not in done.stderr
    return done.returncode, done.stdout, done.stderr


# ---------------------------------------------------------------- the process that returns the code


@pytest.mark.parametrize("mapper", ["leaves", "claims", "crashes", "killed", "quits"])
def test_a_mapper_that_ends_its_process_decides_nothing(folder: Path, mapper: str) -> None:
    words = ("explore", "m2/5", "--target", f"ends.py:{mapper}", "--in-process")
    code, out, error = ran(folder, *words, *FILES)
    assert (code, out, codes(folder)) == (3, "", set())
    assert error.count("\n") == 1


def test_a_mapper_that_closes_files_does_not_change_the_exit_code(folder: Path) -> None:
    words = ("explore", "m2/5", "--target", "ends.py:closes", "--in-process", "--format", "json")
    code, out, _ = ran(folder, *words, *FILES)
    assert {code, json.loads(out)["exit"]} == {0}


def test_output_that_a_mapper_sends_elsewhere_is_not_written(folder: Path) -> None:
    words = ("explore", "m2/5", "--target", "ends.py:silences", "--in-process", "--format", "json")
    assert ran(folder, *words)[:2] == (2, "")


def test_a_mapper_that_ignores_the_end_of_children_is_run_again(folder: Path) -> None:
    words = ("search", "ends.py:reaps", "--edges", "1", "--workers", "0", "--in-process")
    code, out, _ = ran(folder, *words, "--format", "json")
    assert {code, json.loads(out)["exit"]} == {0}


def test_a_mapper_that_damages_our_process_is_no_bug_of_ours(folder: Path) -> None:
    words = ("search", "ends.py:starves", "--edges", "1", "--workers", "0", "--in-process")
    assert ran(folder, *words)[:2] == (3, "")


@pytest.mark.parametrize(
    "line",
    [
        "search ends.py:leaves --edges 2 --workers 0",
        "conform ends.py:leaves --worlds m2/5 --workers 0",
        "record ends.py:leaves --worlds m2/5 --out b.gz",
        pytest.param("arena ends.py:leaves --worlds m2/5 --workers 0", marks=pytest.mark.long),
        pytest.param("verify ends.py:leaves --quick", marks=pytest.mark.long),
        "replay m2/5 --target ends.py:leaves",
        "play m2/5 --target ends.py:leaves",
    ],
)
def test_no_command_ends_with_the_code_of_a_mapper(program: Program, line: str) -> None:
    assert program(f"{line} --in-process").returncode == 3


def test_the_child_has_the_streams_of_the_command(folder: Path) -> None:
    words = ("-m", "topo_verify", "explore", "-", "--format", "json")
    done = python(*words, cwd=folder, input=World.from_id("m2/5").to_json(), check=True)
    assert json.loads(done.stdout)["ok"]


def test_a_signal_that_the_caller_ignores_is_ignored(folder: Path) -> None:
    ignoring = "import signal; signal.signal(signal.SIGHUP, signal.SIG_IGN)"
    raising = f"{ignoring}\n{AT_RESULTS}".replace("SIGINT", "SIGHUP")
    code, _, _ = ran(folder, "search", "basic", "--edges", "2", "--workers", "0", first=raising)
    assert code == 0


def test_sigterm_ends_a_command_in_the_background_of_a_script(folder: Path) -> None:
    """A shell lets such a command ignore SIGINT."""
    first = """
import os, signal, time
from topo_verify.studies.search.search import Search
signal.signal(signal.SIGINT, signal.SIG_IGN)
real = Search.work
def work(search, progress):
    os.kill(os.getppid(), signal.SIGTERM)
    time.sleep(5)
    real(search, progress)
Search.work = work
"""
    words = ("search", "basic", "--edges", "2", "--workers", "0", "--format", "json")
    code, out, _ = ran(folder, *words, *FILES, first=first)
    assert {code, json.loads(out)["exit"], *codes(folder)} == {3}


# ---------------------------------------------------------------- a signal that gets lost


@pytest.mark.parametrize("mapper", ["catches", "converts", "waits", "loses"])
@pytest.mark.parametrize(
    "line", ["explore m2/5 --target ends.py:{}", "search ends.py:{} --edges 2 --workers 0"]
)
def test_what_a_mapper_does_with_a_signal_is_no_result(
    folder: Path, line: str, mapper: str
) -> None:
    words = (*line.format(mapper).split(), "--in-process", "--move-timeout", "1")
    code, out, _ = ran(folder, *words, "--format", "json", *FILES)
    assert {code, json.loads(out)["exit"], *codes(folder)} == {3}


AT_RESULTS = """
import signal
from topo_verify.programs import interruption
from topo_verify.studies.search.search import Search
real = Search.entry
def entry(search, **how):
    signal.raise_signal(signal.SIGINT)
    return real(search, **how)
Search.entry = entry
"""

AS_ANOTHER = """
import ctypes, signal
from topo_verify.studies.search.search import Search
def work(search, progress):
    try:
        signal.raise_signal(signal.SIGINT)
    except KeyboardInterrupt:
        raise ctypes.ArgumentError("argument 1: KeyboardInterrupt") from None
Search.work = work
"""

TWICE = f"""{AT_RESULTS}
interruption.TOGETHER = 0
from topo_verify.campaign import campaign
def work(search, progress):
    signal.raise_signal(signal.SIGINT)
Search.work = work
"""


@pytest.mark.parametrize("first", [AT_RESULTS, AS_ANOTHER, TWICE], ids=["late", "other", "twice"])
def test_an_exception_after_a_signal_is_the_interruption(folder: Path, first: str) -> None:
    words = ("search", "basic", "--edges", "2", "--workers", "0", "--format", "json")
    code, out, error = ran(folder, *words, *FILES, first=first)
    assert {code, json.loads(out)["exit"], *codes(folder)} == {3}
    assert error.startswith("topo-verify: interrupted after ")


def test_ctrl_c_in_z3_interrupts_the_proof(folder: Path) -> None:
    first = """
import os, signal, threading, z3
real = z3.Solver.check
def check(solver, *assumed):
    size = 11
    at = [[z3.Bool(f"at {i} {j}", solver.ctx) for j in range(size)] for i in range(size + 1)]
    hard = z3.Solver(ctx=solver.ctx)
    hard.add(*(z3.Or(row) for row in at))
    hard.add(*(z3.Or(z3.Not(at[i][j]), z3.Not(at[k][j]))
               for j in range(size) for i in range(size + 1) for k in range(i)))
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    answer = real(hard)
    solver.reason_unknown = hard.reason_unknown
    return answer
z3.Solver.check = check
"""
    words = ("prove", "percept", "word-confirm-step", "--format", "json", *FILES)
    code, out, _ = ran(folder, *words, first=first)
    assert {code, json.loads(out)["exit"], *codes(folder)} == {3}
    assert json.loads(out)["results"] == []


# ---------------------------------------------------------------- signals from the first byte on

WHILE_WRITING = """
import signal
from topo_verify.world.formats import files
real = files.write
def write(*of):
    signal.raise_signal(signal.SIGTERM)
    real(*of)
    signal.raise_signal(signal.SIGINT)
    signal.raise_signal(signal.SIGQUIT)
files.write = write
"""


@pytest.mark.parametrize(
    ("line", "right"),
    [
        ("search basic --edges 2 --workers 0", 0),
        ("search mappers.py:guesses --edges 2 --workers 0 --in-process", 1),
        ("conform basic --worlds edges<=2 --workers 0", 0),
        ("arena basic --worlds edges<=2 --workers 0", 0),
        ("explore m2/5 --target basic", 0),
        pytest.param("verify basic --quick", 0, marks=pytest.mark.long),
    ],
)
def test_signals_are_ignored_once_output_begins(folder: Path, line: str, right: int) -> None:
    words = (*line.split(), "--format", "json", *FILES)
    code, out, error = ran(folder, *words, first=WHILE_WRITING)
    assert {code, json.loads(out)["exit"], *codes(folder)} == {right}
    assert "interrupted" not in error


@pytest.mark.parametrize("by", [signal.SIGHUP, signal.SIGQUIT])
def test_a_signal_from_outside_exits_3(folder: Path, by: signal.Signals) -> None:
    words = ("verify", "mappers.py:starts_and_sleeps", "--move-timeout", "60", "--format", "json")
    code, out, error = interrupted(folder, *words, by=by)
    assert code == 3
    assert "Traceback" not in error
    assert (json.loads(out)["exit"] == 3) if by == signal.SIGHUP else (out == "")


def test_a_failing_claim_outlives_an_interruption_of_its_repetition(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(runs.FoundRuns, "run_again", Mock(side_effect=KeyboardInterrupt))
    for line in ("search mappers.py:guesses --edges 2 --workers 0", "verify mappers.py:guesses"):
        done = call(f"{line} --in-process --format json")
        assert done.exit_code == json.loads(done.stdout)["exit"] == 1
        assert json.loads(done.stdout)["results"][0]["verdict"] == "REFUTED"


# ---------------------------------------------------------------- what cannot be written


WITH_A_FULL_DEVICE = pytest.mark.skipif(
    not Path("/dev/full").exists(), reason="no device that is always full here"
)


@WITH_A_FULL_DEVICE
@pytest.mark.parametrize("option", ["--report", "--junit", "--badge"])
@pytest.mark.parametrize(
    ("line", "right"),
    [
        ("search basic --edges 2 --workers 0", 2),
        ("search mappers.py:guesses --edges 2 --workers 0 --in-process", 1),
        ("explore m2/5 --target basic", 2),
    ],
)
def test_a_file_that_cannot_be_written_exits_2_unless_a_claim_fails(
    call: Call, folder: Path, line: str, right: int, option: str
) -> None:
    others = [word for at, word in enumerate(FILES) if option not in FILES[max(0, at - 1) : at + 1]]
    done = call(f"{line} {option} /dev/full {' '.join(others)} --format json")
    assert (done.exit_code, json.loads(done.stdout)["exit"]) == (right, right)
    assert "cannot write /dev/full" in done.stderr
    # JUnit and badge have no word for 2: it is an error, and UNKNOWN.
    assert codes(folder) <= {right, 1 if right == 1 else 3}
    page = folder / "r.html"
    assert not page.exists() or f"<p>Exit code {right}: " in page.read_text()


@WITH_A_FULL_DEVICE
@pytest.mark.parametrize(
    ("line", "right"),
    [
        ("search basic --edges 2 --workers 0", 2),
        ("search mappers.py:guesses --edges 2 --workers 0 --in-process", 1),
    ],
)
def test_a_full_standard_output_is_said_in_the_files(folder: Path, line: str, right: int) -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "topo_verify", *line.split(), *FILES],
            cwd=folder,
            stdout=full,
            stderr=subprocess.PIPE,
            check=False,
        )
    assert done.returncode == right
    assert codes(folder) == ({1} if right == 1 else {2, 3})
    assert b"cannot write to standard output" in done.stderr


@WITH_A_FULL_DEVICE
@pytest.mark.parametrize(
    ("line", "right"),
    [
        ("explore m2/5 --target basic --trace /dev/full", 2),
        ("explore m2/5 --target mappers.py:guesses --in-process --trace /dev/full", 1),
        ("explore m2/5 --target mappers.py:guesses --in-process --svg /dev/full", 1),
        ("explore m2/5 --target mappers.py:guesses --in-process --player /dev/full", 1),
        ("record basic --worlds m2/5 --out /dev/full", 2),
        ("record mappers.py:guesses --in-process --worlds m2/5 --out /dev/full", 1),
        ("replay m2/5 --target mappers.py:guesses --in-process --player /dev/full", 1),
    ],
)
def test_a_failing_claim_is_seen_though_another_file_cannot_be_written(
    call: Call, line: str, right: int
) -> None:
    done = call(f"{line} --format json")
    assert (done.exit_code, json.loads(done.stdout)["exit"]) == (right, right)
    assert len(json.loads(done.stdout)["results"]) == 1
    assert "cannot write /dev/full" in done.stderr


# ---------------------------------------------------------------- helpers and stops


ON_LINUX = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the command has no child")


def _processes(of: int) -> list[int]:
    found = [
        int(word)
        for task in Path(f"/proc/{of}/task").iterdir()
        for word in (task / "children").read_text().split()
    ]
    return found + [process for child in found for process in _processes(child)]


@ON_LINUX
@pytest.mark.parametrize("mapper", ["terminates", "hangs_up", "kills", "exits"])
@pytest.mark.parametrize(
    "line",
    [
        "explore m1/0 --target ends.py:{}",
        pytest.param("search ends.py:{} --edges 1 --workers 1", marks=pytest.mark.long),
        pytest.param("conform ends.py:{} --worlds edges<=1 --workers 1", marks=pytest.mark.long),
    ],
)
def test_a_mapper_that_ends_our_process_from_outside_decides_nothing(
    folder: Path, line: str, mapper: str
) -> None:
    code, _, error = ran(folder, *line.format(mapper).split())
    assert code == 3, error


def test_sigterm_in_a_callback_from_c_code_prints_no_traceback(folder: Path) -> None:
    code = """
import ctypes, signal
from topo_verify.programs import interruption
interruption.end_at_sigterm()
ctypes.CFUNCTYPE(None)(lambda: signal.raise_signal(signal.SIGTERM))()
"""
    assert python("-c", code, cwd=folder, check=True).stderr == ""


SLEEPS = ("search", "mappers.py:starts_and_sleeps", "--edges", "2", "--move-timeout", "60")


@ON_LINUX
def test_a_signal_to_the_process_that_starts_workers_exits_3(folder: Path) -> None:
    with _begun(folder, "--workers", "1") as running:
        launchers = [
            process
            for process in _processes(running.pid)
            if b"launcher import main" in Path(f"/proc/{process}/cmdline").read_bytes()
        ]
        os.kill(launchers[0], signal.SIGTERM)
        out, error = running.communicate(timeout=60)
    assert running.returncode == json.loads(out)["exit"] == 3
    assert "Traceback" not in error


@ON_LINUX
def test_a_stopped_command_stops_its_child_and_goes_on_with_it(folder: Path) -> None:
    with _begun(folder, "--workers", "0") as running:
        both = [running.pid, _processes(running.pid)[0]]
        running.send_signal(signal.SIGTSTP)
        wait_for(lambda: [state(process) for process in both] == ["T", "T"])
        running.send_signal(signal.SIGCONT)
        wait_for(lambda: "T" not in {state(process) for process in both})
        running.send_signal(signal.SIGINT)
        out, _ = running.communicate(timeout=60)
    assert running.returncode == json.loads(out)["exit"] == 3


def _begun(folder: Path, *more: str) -> subprocess.Popen[str]:
    running = subprocess.Popen(
        [sys.executable, "-m", "topo_verify", *SLEEPS, *more, "--format", "json"],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        process_group=0,  # stopping is for a group that a shell controls
    )
    wait_for((folder / "at-work").exists)
    return running
