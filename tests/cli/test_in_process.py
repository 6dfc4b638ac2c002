"""A mapper of the user's on the command line: in a process of its own, or with --in-process."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import Call, Program, Results
from tests.python import python
from topo_verify.checkers import check

RUDE = """
import asyncio, os, subprocess, sys
import topo_verify as tv

def explore(robot):
    return tv.CATALOGUE["basic"](robot)

def chats(robot):
    print("by print")
    os.write(1, b"by hand\\n")
    subprocess.run([sys.executable, "-c", "print('by a child')"])
    return explore(robot)

def cancels(robot):
    raise asyncio.CancelledError("no more")

def interrupts(robot):
    raise KeyboardInterrupt

def forgets(robot):
    found = explore(robot)
    events = robot.move.__self__.events
    moves = [event for event in events if type(event).__name__ == "Move"]
    events.remove(moves[-1])
    return found

def cheats(robot):
    from topo_verify.checkers import CLAIMS, Judgement
    judge = sys.modules["topo_verify.campaign.judge"]
    judge.check = lambda *_, **__: [Judgement(claim, "ok", 1, 1) for claim in CLAIMS]
    robot.move(0)
    return {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}
"""


@pytest.fixture
def rude(folder: Path) -> Path:
    """The current folder, with rude.py."""
    (folder / "rude.py").write_text(RUDE)
    return folder


LINES = {
    "explore": "explore m2/5 --target rude.py:{}",
    "replay": "replay m2/5 --target rude.py:{}",
    "search": "search rude.py:{} --edges 1 --workers 0",
    "conform": "conform rude.py:{} --worlds m2/5 --workers 0",
    "record": "record rude.py:{} --worlds m2/5 --out base.gz",
}


@pytest.mark.long
@pytest.mark.usefixtures("rude")
@pytest.mark.parametrize("line", LINES.values(), ids=LINES)
def test_what_a_mapper_prints_stands_marked_on_standard_error(program: Program, line: str) -> None:
    done = program(line.format("chats") + " --format json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["ok"]
    for words in ("by print", "by hand", "by a child"):
        assert f"rude.py:chats: {words}\n" in done.stderr


@pytest.mark.usefixtures("rude")
@pytest.mark.parametrize("line", LINES.values(), ids=LINES)
def test_an_exception_of_any_kind_is_a_finding_with_its_line(results: Results, line: str) -> None:
    lines: list[str] = [*RUDE.splitlines()]
    at = lines.index("def cancels(robot):") + 2
    said = json.dumps(results(line.format("cancels"), code=1)["results"])
    assert f"the mapper raised CancelledError: no more (rude.py, line {at})" in said


@pytest.mark.usefixtures("rude")
def test_a_mapper_that_interrupts_itself_interrupts_nobody_else(results: Results) -> None:
    (entry,) = results("explore m2/5 --target rude.py:interrupts", code=1)["results"]
    assert "the mapper raised KeyboardInterrupt (rude.py, line " in entry["stopped"]


@pytest.mark.usefixtures("rude")
def test_a_report_says_that_the_mapper_shared_a_process(call: Call, results: Results) -> None:
    line = "explore m2/5 --target rude.py:explore"
    assert results(line)["in_process"] is False
    assert results(f"{line} --in-process")["in_process"] is True
    assert "In process: a mapper of your own could see what judges it." in (
        call(f"{line} --in-process").stdout
    )
    assert "In process" not in call(line).stdout


@pytest.mark.usefixtures("rude")
def test_a_trace_with_fewer_moves_than_were_made_is_a_finding(results: Results) -> None:
    line = "explore m2/5 --target rude.py:forgets --in-process"
    (entry,) = results(line, code=1)["results"]
    (honest,) = results("explore m2/5 --target basic")["results"]
    assert entry["cost"] == honest["cost"]
    assert entry["claims"]["cost-honest"] == "failed"
    messages = [found["message"] for found in entry["findings"]]
    assert any("somebody changed the trace" in message for message in messages)
    # In a process of its own the mapper finds no trace.
    (entry,) = results(line.removesuffix(" --in-process"), code=1)["results"]
    assert "AttributeError" in entry["stopped"]


@pytest.mark.long
def test_workers_run_no_code_from_the_current_folder(folder: Path) -> None:
    (folder / "json.py").write_text("raise SystemExit('not the standard library')\n")
    line = "conform basic --worlds edges<=2 --workers 2"
    done = python("-P", "-m", "topo_verify", *line.split(), cwd=folder)
    assert done.returncode == 0, done.stderr
    assert "EXHAUSTED" in done.stdout


THROWS = """
import sys
for line in sys.stdin:
    sys.stderr.write("Error: Cannot find module './rules'\\n" + "    at somewhere\\n" * 8)
    sys.exit(1)
"""


def test_a_program_that_dies_shows_the_last_lines_of_its_standard_error(
    folder: Path, results: Results
) -> None:
    (folder / "throws.py").write_text(THROWS)
    line = f'explore m2/5 --cmd "{sys.executable} throws.py"'
    (entry,) = results(line, code=1)["results"]
    assert "Error: Cannot find module './rules' / at somewhere" in entry["stopped"]


JUDGING = {
    **LINES,
    "search": "search rude.py:{} --edges 2 --workers 0",
    "arena": "arena rude.py:{} --suite tiny --workers 0",
    "verify": "verify rude.py:{} --quick",
    "compare": "compare base.gz rude.py:{}",
}


@pytest.mark.usefixtures("rude")
@pytest.mark.parametrize("line", JUDGING.values(), ids=JUDGING)
def test_a_mapper_that_replaces_the_checkers_is_refuted_below_the_least_cost_of_a_proof(
    call: Call, monkeypatch: pytest.MonkeyPatch, line: str
) -> None:
    if "base.gz" in line:
        assert call("record basic --worlds m2/5 --out base.gz").exit_code == 0
    monkeypatch.setattr("topo_verify.campaign.judge.check", check)  # taken back after the test
    done = call(line.format("cheats") + " --in-process --format json")
    assert done.exit_code == 1, done.output
    assert "and the least cost of a proof is" in done.stdout
