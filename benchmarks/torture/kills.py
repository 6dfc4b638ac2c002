"""Signals at random moments: to a command, or to one of its helpers.

Each trial starts a command in a process and sends it SIGKILL, SIGTERM or SIGINT one or more times,
restarting it after each. Then:

- it ended with the signal itself (SIGKILL) or with exit code 3 and a sentence (the other two), or
  had ended before with 0;
- no process is left over, and no file besides those that it keeps;
- when it may finish, its results are those of an undisturbed run.

If a helper is killed from outside, the command ends with 0 or 3, and never convicts.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from time import monotonic, sleep

from processes import children, descendants, left_over
from readers import Count
from trial import difference

SECONDS = 120
"""Most seconds of a command on the clock."""

OURS = {"out", "err", "begun"}

SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)


@dataclass(frozen=True)
class Command:
    """A command to disturb, and the file that it keeps."""

    words: tuple[str, ...]
    file: str = ""


COMMANDS = {
    "search": Command(
        ("search", "basic", "--edges", "5", "--workers", "2", "--ledger", "ledger"), "ledger"
    ),
    "conform": Command(("conform", "basic", "--worlds", "edges<=4", "--workers", "2")),
    "record": Command(
        ("record", "basic", "--worlds", "edges<=4", "--out", "basic.jsonl.gz"), "basic.jsonl.gz"
    ),
}


@dataclass
class Ended:
    """How a command in a folder ended."""

    code: int
    stdout: str
    stderr: str
    left: int
    files: set[str] = field(default_factory=set[str])


START = (
    "import sys\n"
    "from pathlib import Path\n"
    "from topo_verify.cli import main\n"
    "Path('begun').touch()\n"
    "main()\n"
)
"""The program `topo-verify`, which reports when the imports are done."""


def start(name: str) -> subprocess.Popen[str]:
    """A command in the current folder that has begun."""
    return begin((*COMMANDS[name].words, "--format", "json"))


def begin(arguments: Sequence[str]) -> subprocess.Popen[str]:
    """A command with these arguments in the current folder that has begun."""
    Path("begun").unlink(missing_ok=True)
    words = (sys.executable, "-c", START, *arguments)
    with Path("out").open("w") as out, Path("err").open("w") as err:
        process = subprocess.Popen(  # noqa: S603  our own program
            words, stdout=out, stderr=err, text=True, start_new_session=True
        )
    while not Path("begun").exists() and process.poll() is None:
        sleep(0.01)
    return process


def finish(process: subprocess.Popen[str], before: list[int]) -> Ended:
    """Wait until a command and its helpers end."""
    try:
        code = process.wait(SECONDS)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        code = 999
    left = left_over(before)
    told = [Path(name).read_text(errors="replace") for name in ("out", "err")]
    return Ended(code, *told, left, {path.name for path in Path().iterdir()} - OURS)


@cache
def undisturbed(name: str) -> tuple[str, float]:
    """The results of a command, and its time."""
    with TemporaryDirectory() as folder:
        os.chdir(folder)
        before = children()
        process, began = start(name), monotonic()
        done = finish(process, before)
        assert done.code == 0, done.stderr
        return results(done.stdout), monotonic() - began


def results(text: str) -> str:
    """The results as text, without clock figures and counts of earlier work."""
    document = json.loads(text)
    document.pop("timing", None)
    for entry in document["results"]:
        entry.pop("from_ledger", None)
    return json.dumps(document)


def _first_difference(text: str, true: str) -> str:
    return difference(json.loads(results(text)), json.loads(true))


# ---------------------------------------------------------------- a trial


def trial(name: str, seed: str) -> str | None:
    """Disturb a command one to three times, then let it finish; an objection, or None."""
    true, seconds = undisturbed(name)
    draw = Random(seed)
    with TemporaryDirectory() as folder:
        os.chdir(folder)
        for _ in range(draw.randint(1, 3)):
            number, wait = draw.choice(SIGNALS), draw.uniform(0.02, 1.1 * seconds)
            wrong = _disturbed(name, number, wait)
            if wrong is not None:
                return f"{signal.Signals(number).name} after {wait:.3f} s: {wrong}"
        return _let_finish(name, true)


def _disturbed(name: str, number: signal.Signals, wait: float) -> str | None:
    before = children()
    process = start(name)
    sleep(wait)
    process.send_signal(number)
    done = finish(process, before)
    # 0: the signal came after the end; so it did if all was printed while Python shut down.
    if done.code == -number and done.stdout.rstrip().endswith("}"):
        done.code = 0
    if done.code not in ((-number, 0) if number == signal.SIGKILL else (3, 0)):
        return f"ended with {done.code}: {done.stderr.strip()[-300:]}"
    if "Traceback" in done.stderr:
        return f"printed a traceback: {done.stderr.strip()[-300:]}"
    return _remains(name, done, killed=number == signal.SIGKILL)


def _remains(name: str, done: Ended, *, killed: bool) -> str | None:
    if done.left:
        return f"{done.left} processes left over"
    kept = {COMMANDS[name].file, COMMANDS[name].file + "-journal"}
    # Nobody can clear up after SIGKILL: a file that was being written stays under another name.
    strange = {file for file in done.files - kept if not (killed and file.startswith(".topo-"))}
    return f"left the files {sorted(strange)}" if strange else None


def _let_finish(name: str, true: str) -> str | None:
    before = children()
    done = finish(start(name), before)
    if done.code != 0:
        return f"let finish, it ended with {done.code}: {done.stderr.strip()[-300:]}"
    if results(done.stdout) != true:
        return f"let finish, its results differ: {_first_difference(done.stdout, true)}"
    return _remains(name, done, killed=True)


def helper_killed(name: str, seed: str) -> str | None:
    """Kill one helper of a command at a random moment; an objection, or None."""
    true, seconds = undisturbed(name)
    draw = Random(seed)
    with TemporaryDirectory() as folder:
        os.chdir(folder)
        before = children()
        process = start(name)
        sleep(draw.uniform(0.1, 0.9) * seconds)
        helpers = descendants(process.pid)
        if helpers:
            os.kill(draw.choice(helpers), signal.SIGKILL)
        done = finish(process, before)
        if done.code not in (0, 3) or "REFUTED" in done.stdout:
            return f"a helper was killed: exit code {done.code}: {done.stdout[-300:]} {done.stderr}"
        if done.code == 0 and results(done.stdout) != true:
            return f"a helper was killed, and then: {_first_difference(done.stdout, true)}"
        return _remains(name, done, killed=True)


def trials(name: str, seeds: list[str]) -> Count:
    """Disturb a command by these seeds; every third time one of its helpers."""
    count = Count()
    for place, seed in enumerate(seeds):
        wrong = helper_killed(name, seed) if place % 3 == 2 else trial(name, seed)
        count.trials += 1
        if wrong is not None:
            count.wrong.append(f"{name}, seed {seed!r}: {wrong}")
    return count
