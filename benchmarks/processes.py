"""Counts what a search costs beside its worlds: processes, loadings, judgements, replays, files.

    python benchmarks/processes.py                  the README's search, and one of 792 right worlds
    python benchmarks/processes.py search basic     any other command

A hook in every Python of the command writes down each process that is started or forked, and each
call of the functions below. The seconds are those of a second run, without the hook.

On two processors:

                        my_mapper.py    mended.py (792 worlds)
    processes           8               63
      starts of Python  6               10
    loadings            2               4
    judgements          3               1634
    replays             4               1634
    files that run      76              71
    seconds             0.7             2.1

What this does not show: processes that a program in another language starts.
"""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path
from time import perf_counter

ROOT = Path(__file__).resolve().parent.parent

MAPPER = """
def explore(robot):
    return {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}
"""

COMMANDS = (
    "search my_mapper.py:explore --edges 4",
    f"search {ROOT}/examples/own_mapper/mended.py:explore --edges 4",
)

COUNTED = {
    "programs/loader.py:object_at": "loadings of the mapper",
    "checkers/claims.py:check": "judgements",
    "checkers/replayed_trace.py:ReplayedTrace.__init__": "replays",
}

STARTED = ("launcher", "serve:child", "serve:fresh", "reaper")
"""The kinds of processes that are started, by what their command names."""

HOOK = """
import os, sys, threading
files = set()
def write(line):
    file = os.open({lines!r}, os.O_WRONLY | os.O_APPEND | os.O_CREAT)
    os.write(file, line.encode() + b"\\n")
    os.close(file)
def heard(event, arguments):
    if event == "subprocess.Popen":
        words = " ".join(map(os.fsdecode, arguments[1]))
        write("start " + next((kind for kind in {started} if kind in words.replace(".py", "").
            replace("import ", "").replace(" ", ":")), "other"))
    elif event == "os.fork":
        write("fork fork")
def called(frame, event, _argument):
    code = frame.f_code
    if event == "call" and code.co_flags & 1 and code.co_filename.startswith({package!r}):
        file = code.co_filename[len({package!r}):]
        if file not in files:
            files.add(file)
            write("file " + file)
        place = file + ":" + code.co_qualname
        if place in {counted}:
            write("call " + place)
sys.addaudithook(heard)
threading.setprofile(called)
sys.setprofile(called)
"""


def measure(command: str, folder: Path) -> None:
    """Run the command with the hook, then without, and print its numbers."""
    lines, hook = folder / "lines", folder / "hook"
    hook.mkdir(exist_ok=True)
    lines.write_text("start command\n", encoding="utf-8")
    text = HOOK.format(
        lines=str(lines),
        package=f"{ROOT / 'topo_verify'}{os.sep}",
        counted=set(COUNTED),
        started=STARTED,
    )
    (hook / "sitecustomize.py").write_text(text, encoding="utf-8")
    words = [sys.executable, "-m", "topo_verify", *shlex.split(command)]
    for path in (str(hook), None):
        environment = os.environ | ({} if path is None else {"PYTHONPATH": path})
        begin = perf_counter()
        subprocess.run(words, cwd=folder, env=environment, stdout=subprocess.DEVNULL, check=False)  # noqa: S603  the project itself
        seconds = perf_counter() - begin
    said = [line.split(" ", 1) for line in lines.read_text(encoding="utf-8").splitlines()]
    started = Counter(kind for sort, kind in said if sort == "start")
    forks = sum(sort == "fork" for sort, _ in said)
    print(f"topo-verify {command}")
    print(
        f"  {started.total() + forks:6} processes: {started.total()} starts, {forks} forks", end=""
    )
    print(f" ({', '.join(f'{number} {kind}' for kind, number in started.items())})")
    for place, meaning in COUNTED.items():
        print(f"  {said.count(['call', place]):6} {meaning}")
    print(f"  {len({name for sort, name in said if sort == 'file'}):6} files that run")
    print(f"  {seconds:6.2f} s")


def main() -> None:
    """Measure the commands."""
    given = shlex.join(sys.argv[1:])
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        (folder / "my_mapper.py").write_text(MAPPER, encoding="utf-8")
        for command in (given,) if given else COMMANDS:
            measure(command, folder)


if __name__ == "__main__":
    main()
