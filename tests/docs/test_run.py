"""docs/explanation/run.md: the functions that it names are called, in its processes and its order.

The command of the page runs with a profile function in every process, which writes down the first
call of each function. Each line is appended at once, so the lines of all processes stand in the
order of the calls. A station runs only after the one before it has answered, so this order does not
depend on the speed of the machine. What this does not show: what goes in and out.
"""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator, Sequence
from itertools import product
from typing import NamedTuple

import pytest

from tests.pages import ROOT, steps

PAGE = (ROOT / "docs" / "explanation" / "run.md").read_text(encoding="utf-8")

RECORDER = """
import os, sys, threading
known = set()
def note(frame, event, _argument):
    code = frame.f_code
    if event == "call" and code not in known and code.co_flags & 1:  # no module, no class body
        known.add(code)
        if code.co_filename.startswith({package!r}):
            place = code.co_filename[len({package!r}):] + ":" + code.co_qualname
            file = os.open({calls!r}, os.O_WRONLY | os.O_APPEND | os.O_CREAT)
            os.write(file, f"{{os.getpid()}} {{place}}\\n".encode())
            os.close(file)
os.register_at_fork(after_in_child=known.clear)
threading.setprofile(note)
sys.setprofile(note)
"""
"""The `sitecustomize` of each process that the command starts."""


class Call(NamedTuple):
    """The first call in a process of the function at `FILE:FUNCTION`."""

    process: str
    place: str


class Station(NamedTuple):
    """A station: the page's word for its process, and `FILE:FUNCTION`."""

    process: str
    place: str


def stations(page: str) -> list[Station]:
    """The stations on a page; one line may name several functions."""
    return [
        Station(line[1], place)
        for line in re.finditer(r"^\d+\. \*\*(.+?)\*\* (.*)$", page, re.MULTILINE)
        for place in re.findall(r"`([\w/]+\.py:[\w.]+)`", line[2])
    ]


def objections(page: str, calls: Sequence[Call]) -> Iterator[str]:
    """What a page says of a run that these calls do not show."""
    called = {call.place for call in calls}
    ran = {place.partition(":")[0] for place in called} | {"my_mapper.py"}
    for name in dict.fromkeys(re.findall(r"\b[\w/]+\.py(?::[\w.]+)?", page)):
        if name not in called | ran and name != "my_mapper.py:explore":
            yield f"{name} does not run"
    at = {call: number for number, call in reversed([*enumerate(calls)])}
    wanted = stations(page)
    words = [*dict.fromkeys(station.process for station in wanted)]
    candidates: list[list[str]] = []
    for word in words:
        places = [station.place for station in wanted if station.process == word]
        processes = dict.fromkeys(call.process for call in calls)
        candidates.append([p for p in processes if all(Call(p, name) in at for name in places)])
        if not candidates[-1]:
            yield f"no process calls everything of {word}: {', '.join(places)}"
    best = -1
    for chosen in product(*candidates):
        if len(set(chosen)) < len(chosen):
            continue
        process = dict(zip(words, chosen, strict=True))
        order = [at[Call(process[station.process], station.place)] for station in wanted]
        late = (i for i in range(1, len(order)) if order[i] < order[i - 1])
        best = max(best, next(late, len(order)))
    if 0 <= best < len(wanted):
        yield f"{wanted[best].place} is called before {wanted[best - 1].place}"


@pytest.fixture(scope="module")
def calls(tmp_path_factory: pytest.TempPathFactory) -> list[Call]:
    """The calls of the command on the page."""
    folder, hook = tmp_path_factory.mktemp("run"), tmp_path_factory.mktemp("hook")
    written = hook / "calls"
    package = f"{ROOT / 'topo_verify'}{os.sep}"
    recorder = RECORDER.format(package=package, calls=str(written))
    (hook / "sitecustomize.py").write_text(recorder, encoding="utf-8")
    mapper, command = (step for step in steps(PAGE) if step.kind in {"file", "command"})
    (folder / mapper.name).write_text(mapper.text, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "topo_verify", *shlex.split(command.text)[1:]],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(hook)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (1, "")
    assert "REFUTED: 1 of 86 worlds checked" in done.stdout
    lines = written.read_text(encoding="utf-8").splitlines()
    return [Call(*line.split(" ", maxsplit=1)) for line in lines]


@pytest.mark.long
def test_the_run_takes_the_way_that_the_page_describes(calls: list[Call]) -> None:
    assert list(objections(PAGE, calls)) == []


def test_the_stations_are_numbered_and_all_processes_are_explained() -> None:
    numbers = [int(number) for number in re.findall(r"^(\d+)\. ", PAGE, re.MULTILINE)]
    assert numbers == [*range(1, len(numbers) + 1)]
    explained = re.findall(r"^\| \*\*(.+?)\*\* \|", PAGE, re.MULTILINE)
    assert explained == [*dict.fromkeys(s.process for s in stations(PAGE))]


SHORT = """
1. **command** `cli/search.py:search`. In: options.
2. **worker** `campaign/campaign.py:examine`, then `checkers/claims.py:check`.
3. **command** `cli/search.py:shown`.
"""

RUN = [
    Call("7", "cli/search.py:search"),
    Call("8", "campaign/campaign.py:examine"),
    Call("8", "checkers/claims.py:check"),
    Call("7", "cli/search.py:shown"),
]


def test_a_page_that_describes_its_run_meets_no_objection() -> None:
    assert list(objections(SHORT, RUN)) == []


@pytest.mark.parametrize(
    ("page", "run", "objection"),
    [
        (SHORT + "See `cli/explore.py`.", RUN, "cli/explore.py does not run"),
        (SHORT + "See `cli/search.py:seek`.", RUN, "cli/search.py:seek does not run"),
        (SHORT, RUN[:2] + RUN[3:], "checkers/claims.py:check does not run"),
        (SHORT, [RUN[0], RUN[2], RUN[1], RUN[3]], "claims.py:check is called before campaign/"),
        (SHORT, [RUN[3], *RUN[:3]], "search.py:shown is called before checkers/"),
        (
            SHORT,
            [*RUN[:2], Call("9", RUN[2].place), RUN[3]],
            "no process calls everything of worker",
        ),
    ],
)
def test_a_page_that_describes_another_run_is_noticed(
    page: str, run: list[Call], objection: str
) -> None:
    assert any(objection in found for found in objections(page, run))
