"""Signals at random moments, to a command or to its whole group: every form of its end agrees.

Each trial starts a command with --report, --junit and --badge, and sends SIGINT, SIGTERM, SIGHUP or
SIGQUIT once or twice, half of the time close to its end. Then:

- exit code, JSON (or the first line of Markdown), page, JUnit file and badge say the same;
- without output, the exit code is 3, and there is no file;
- no traceback is printed, and no process is left over.
"""

from __future__ import annotations

import json
import os
import re
import signal
from contextlib import suppress
from functools import cache
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from time import monotonic, sleep
from xml.etree import ElementTree as ET

from kills import Ended, begin, finish
from processes import children
from readers import Count

FILES = ("--report", "r.html", "--junit", "r.xml", "--badge", "r.svg")

COMMANDS = {
    "verify": ("verify", "basic", "--quick", *FILES),
    "verify own": ("verify", "mapper.py:explore", "--quick", *FILES),
    "explore": ("explore", "nyc", "m4/99", "family:lattice(9,9)", *FILES),
    "explore own": ("explore", "nyc", "m4/99", "--target", "mapper.py:explore", *FILES),
    "search": ("search", "basic,folding", "--edges", "4", "--workers", "2", *FILES),
    "search here": ("search", "basic", "--edges", "4", "--workers", "0", *FILES),
    "search own": ("search", "mapper.py:explore", "--edges", "3", "--workers", "2", *FILES),
    "search wrong": ("search", "mapper.py:guess", "--edges", "3", "--keep-going", *FILES),
    "search in process": (
        *("search", "mapper.py:explore", "--edges", "3", "--workers", "0", "--in-process"),
        *FILES,
    ),
    "search compiled": (
        *("search", "basic", "--edges", "5", "--engine", "compiled", "--workers", "2"),
        *FILES,
    ),
    "search ledger": ("search", "basic", "--edges", "4", "--ledger", "ledger", *FILES),
    "prove": ("prove", "--kind", "inductive", *FILES),
    "prove bounded": ("prove", "--kind", "bounded", "--edges", "3", *FILES),
    "conform": ("conform", "basic,folding", "--worlds", "edges<=4", "--workers", "2", *FILES),
    "conform own": ("conform", "mapper.py:explore", "--worlds", "edges<=3", *FILES),
    "compare": ("compare", "baseline.gz", "basic", "--workers", "2", *FILES),
    "arena": ("arena", "basic,mapper.py:guess", "--suite", "tiny", "--workers", "2", *FILES),
    "arena out": ("arena", "basic", "--worlds", "edges<=2", "--out", "league", *FILES),
    "record": ("record", "basic", "--worlds", "edges<=4", "--out", "new.gz", "--workers", "2"),
    "replay": ("replay", "nyc", "--target", "mapper.py:explore"),
    "play": ("play", "nyc", "--target", "basic,folding"),
    "certify": ("certify", "run.jsonl"),
    "tour": ("tour", "nyc"),
    "reproduce": ("reproduce", "--figure", "6", "--quick", "--graphs", "1", "--workers", "2"),
    "world draw": ("world", "draw", "nyc", "-o", "nyc.svg"),
    "world count": ("world", "count", "--edges", "6", "--class", "simple"),
    "world sample": ("world", "sample", "--edges", "30", "-n", "200"),
}

MAPPER = """
from topo_verify.algorithms import CATALOGUE

explore = CATALOGUE["basic"]

def guess(robot):
    for _ in range(3):
        robot.move(0)
    return {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}
"""

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)

VERDICTS = {0: {"PROVED", "EXHAUSTED", "SAMPLED"}, 1: {"REFUTED"}, 3: {"UNKNOWN"}}


def _prepare(folder: str) -> None:
    os.chdir(folder)
    Path("mapper.py").write_text(MAPPER)
    before = children()
    for words in (
        ("record", "basic", "--worlds", "edges<=3", "--out", "baseline.gz"),
        ("explore", "nyc", "--target", "basic", "--trace", "run.jsonl"),
    ):
        done = finish(begin(words), before)
        assert done.code == 0, done.stderr


@cache
def _made() -> dict[str, bytes]:
    """The files that commands read."""
    with TemporaryDirectory() as folder:
        _prepare(folder)
        return {name: Path(name).read_bytes() for name in ("mapper.py", "baseline.gz", "run.jsonl")}


def _enter(folder: str) -> None:
    made = _made()
    os.chdir(folder)
    for name, data in made.items():
        Path(name).write_bytes(data)


@cache
def _seconds(name: str) -> float:
    with TemporaryDirectory() as folder:
        _enter(folder)
        before = children()
        began = monotonic()
        done = finish(begin((*COMMANDS[name], "--format", "json")), before)
        assert done.code in (0, 1), done
        wrong = objection(done, "json")
        assert wrong is None, wrong
        return monotonic() - began


def trial(name: str, seed: str) -> str | None:
    """Signal a command once or twice; an objection, or None."""
    draw = Random(seed)
    seconds, style = _seconds(name), draw.choice(("json", "json", "markdown"))
    first = draw.uniform(*draw.choice(((0.0, 1.0), (0.8, 1.1)))) * seconds
    sent = [(first, draw.choice(SIGNALS))]
    if draw.random() < 0.6:
        sent.append((draw.choice((0.0, 0.01, 0.3, 1.2)) * draw.random(), draw.choice(SIGNALS)))
    whole = draw.random() < 0.4
    with TemporaryDirectory() as folder:
        _enter(folder)
        before = children()
        process = begin((*COMMANDS[name], "--format", style, "--quiet"))
        sleep(0.02)  # the handlers are there
        for wait, number in sent:
            sleep(wait)
            with suppress(ProcessLookupError):
                if process.poll() is None:
                    (os.killpg if whole else os.kill)(process.pid, number)
        wrong = objection(finish(process, before), style)
    if wrong is None:
        return None
    moments = ", ".join(f"{number.name} after {wait:.3f} s" for wait, number in sent)
    return f"{moments}, {'group' if whole else 'process'}, {style}: {wrong}"


def objection(done: Ended, style: str) -> str | None:
    """Why the forms of an end do not agree, or None."""
    if "Traceback" in done.stderr or "Exception ignored" in done.stderr:
        return f"printed a traceback: {done.stderr[-900:]}"
    if done.left:
        return f"{done.left} processes left over"
    if done.code not in VERDICTS:
        return f"exit code {done.code}: {done.stderr[-300:]}"
    if [name for name in done.files if name.startswith(".topo-verify")] and done.stdout:
        return f"left a file: {sorted(done.files)}"
    said = {"exit": done.code, **dict(_said(done, style))}
    if not done.stdout and (done.code != 3 or len(said) > 1 or not done.stderr):
        return f"without output: {said}, {done.stderr[-300:]!r}"
    code = done.code
    wrong = {form: what for form, what in said.items() if what not in (code, *VERDICTS[code])}
    return f"exit code {code}, but {wrong}; {done.stderr[-200:]!r}" if wrong else None


def _said(done: Ended, style: str) -> dict[str, object]:
    """What each form says, an exit code or a verdict."""
    said: dict[str, object] = {}
    if done.stdout and style == "json":
        envelope = json.loads(done.stdout)
        said["JSON"] = envelope["exit"]
        if envelope["ok"] != (done.code == 0):
            said["ok"] = envelope["ok"]
    names = done.files & {"r.html", "r.xml", "r.svg"}
    files = {name: Path(name).read_text() for name in names}
    if done.stdout and style == "markdown" and files:
        said["first line"] = _match(r"\*\*([A-Z]+)\*\*: ", done.stdout.partition("\n")[0])
    if "r.html" in files:
        said["page"] = int(_match("<p>Exit code ([0-9]+): ", files["r.html"]))
    if "r.svg" in files:
        said["badge"] = _match("<title>[^<]*: ([A-Z]+), [^<]*</title>", files["r.svg"])
    if "r.xml" in files:
        root = ET.fromstring(files["r.xml"])  # noqa: S314  our own file
        verdicts = {p.get("value") for p in root.iter("property") if p.get("name") == "verdict"}
        said["JUnit verdict"] = "/".join(map(str, verdicts))
        failures, errors = (
            sum(int(suite.get(what, "0")) for suite in root) for what in ("failures", "errors")
        )
        said["JUnit counts"] = 1 if failures else 3 if errors else 0
    return said


def _match(pattern: str, text: str) -> str:
    found = re.search(pattern, text)
    return found[1] if found else "nothing"


def unseen() -> list[str]:
    """Planted endings whose outputs disagree and that the trials miss."""
    page, badge = "<p>Exit code 0: ", "<title>basic: EXHAUSTED, all</title>"
    both = {"r.html", "r.svg"}
    planted = {
        "a JSON with another exit code": (3, '{"exit": 0, "ok": false}', "", ""),
        "a page with another exit code": (3, '{"exit": 3, "ok": false}', page, ""),
        "a badge with another verdict": (3, '{"exit": 3, "ok": false}', "", badge),
        "an end without output and sentence": (0, "", "", ""),
        "an end by a signal": (-2, "", "", ""),
        "a file without output": (3, "", page, badge),
    }
    missed: list[str] = []
    with TemporaryDirectory() as folder:
        os.chdir(folder)
        for what, (code, stdout, html, svg) in planted.items():
            Path("r.html").write_text(html or f"<p>Exit code {code}: ")
            Path("r.svg").write_text(svg or "<title>basic: UNKNOWN, none</title>")
            if objection(Ended(code, stdout, "", 0, both), "json") is None:
                missed.append(what)
    return missed


def trials(name: str, seeds: list[str]) -> Count:
    """Signal a command by these seeds."""
    count = Count()
    for seed in seeds:
        wrong = trial(name, seed)
        count.trials += 1
        if wrong is not None:
            count.wrong.append(f"{name}, seed {seed!r}: {wrong}")
    return count
