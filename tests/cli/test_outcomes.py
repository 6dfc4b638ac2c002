"""Exit code, JSON, first line, page, JUnit and badge of every command agree on every outcome.

| outcome | exit code | verdict | JUnit |
| --- | --- | --- | --- |
| passed | 0 | PROVED, EXHAUSTED or SAMPLED | neither failures nor errors |
| refuted | 1 | REFUTED | failures |
| undecided, interrupted, a worker lost for good | 3 | UNKNOWN | errors, no failures |

What this does not show: that a verdict is right; only that no form says more than another.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path
from typing import Any
from unittest.mock import Mock
from xml.etree import ElementTree as ET

import msgspec
import pytest

from tests.cli.conftest import Call
from topo_verify.campaign import progress
from topo_verify.checkers.findings import Verdict
from topo_verify.cli.output import ProgressBar, entry_of
from topo_verify.proofs import catalogue as proofs_catalogue
from topo_verify.proofs.theorem import RefutationCertificate, Theorem, TheoremResult

FILES = "--report r.html --junit r.xml --badge r.svg"
SKIPS = """
import json, sys
for line in sys.stdin:
    if json.loads(line)["type"] == "start":
        print(json.dumps({"type": "skip", "why": "not today"}), flush=True)
"""
DEADLY = """
import os
from pathlib import Path
from mappers import right

def once(robot):
    if robot.percept.degree == 2 and not Path("killed").exists():
        Path("killed").touch()
        os.kill(os.getpid(), 9)
    return right(robot)
"""
SKIPPING = f"--cmd '{sys.executable} skips.py'"
VERDICT_OF = {0: {"PROVED", "EXHAUSTED", "SAMPLED"}, 1: {"REFUTED"}, 3: {"UNKNOWN"}}


@dataclass(frozen=True)
class Forms:
    """What one outcome is in every form."""

    code: int
    envelope: dict[str, Any]
    first_line: str
    page: str
    junit: ET.Element
    badge: str


def forms(call: Call, line: str, again: Callable[[], None] = lambda: None) -> Forms:
    """Every form of a command line, which is run twice.

    Args:
        again: is called before each run, so that both are alike.
    """
    again()
    printed = call(f"{line} --quiet --format markdown {FILES}")
    files = [Path(name).read_text() for name in ("r.html", "r.xml", "r.svg")]
    again()
    data = call(f"{line} --quiet --format json")
    assert data.exit_code == printed.exit_code, data.output + printed.output
    first = printed.stdout.partition("\n")[0]
    page, junit, badge = files
    return Forms(data.exit_code, json.loads(data.stdout), first, page, ET.fromstring(junit), badge)  # noqa: S314  our own file


def require_agreement(found: Forms, code: int) -> None:
    """Require the exit code, and that no form says anything else."""
    assert (found.code, found.envelope["exit"]) == (code, code), found.first_line
    assert found.envelope["ok"] == (code == 0)
    head = re.match(r"\*\*([A-Z]+)\*\*: (.*)", found.first_line)
    assert head is not None, found.first_line
    verdict, words = head[1], head[2]
    assert verdict in VERDICT_OF[code], found.first_line
    if verdict == "UNKNOWN":  # "12 of 12 worlds" would say that all was done
        assert not re.search(r"\b([0-9,]+) of \1(?![0-9,])(?!.*interrupted)", words), words
    ranks = code == 1 and found.envelope["format"] == "topo-verify/arena"
    assert ranks or f"</span></span> {verdict}: " in found.page
    assert f"<p>Exit code {code}: " in found.page
    title = re.search(r"<title>(.*?)</title>", found.badge)
    assert title is not None
    assert f": {verdict}, " in title[1]
    assert f">{verdict[0]}</text>" in found.badge
    suites = list(found.junit)
    verdicts = {
        one.get("value") for one in found.junit.iter("property") if one.get("name") == "verdict"
    }
    assert verdicts == {verdict}
    failures, errors = (
        sum(int(suite.get(name, "0")) for suite in suites) for name in ("failures", "errors")
    )
    assert (failures > 0) == (code == 1), "JUnit"
    if code != 1:
        assert (errors > 0) == (code == 3), "JUnit"
    require_entries(found)


def require_entries(found: Forms) -> None:
    """Require that no entry of the results contradicts the exit code."""
    entries = found.envelope["results"]
    unexpected = [one for one in entries if one.get("verdict") == "REFUTED" != one.get("expected")]
    assert not unexpected or found.code == 1
    if found.code == 0:
        assert not [one for one in entries if one.get("verdict") == "UNKNOWN"]
        assert not [one for one in entries if one.get("ok") is False]


# ---------------------------------------------------------------- what is tried


@pytest.fixture(autouse=True)
def stocked(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The folder has a program that skips all worlds and a mapper that is killed once."""
    (folder / "skips.py").write_text(SKIPS)
    (folder / "deadly.py").write_text(DEADLY)
    (one, *_) = proofs_catalogue.choose(["percept"])

    def planted(name: str, verdict: Verdict, expected: Verdict) -> Theorem:
        result = TheoremResult(verdict=verdict, solver="none", premises_satisfiable=True)
        return replace(one, name=name, expected=expected, prove=Mock(return_value=result))

    shelf = (
        planted("proved", "PROVED", "PROVED"),
        planted("proved-too", "PROVED", "PROVED"),
        planted("unproved", "UNKNOWN", "PROVED"),
        planted("unrefuted", "PROVED", "REFUTED"),
    )
    monkeypatch.setattr(proofs_catalogue, "catalogue", Mock(return_value=shelf))


@pytest.fixture
def baseline(call: Call) -> None:
    """A baseline of `basic`."""
    assert call("record basic --worlds edges<=2 --out b.gz --quiet").exit_code == 0


OUTCOMES = [
    ("verify mappers.py:right --quick --in-process", 0),
    ("verify mappers.py:guesses --quick --in-process", 1),
    (f"verify --quick {SKIPPING}", 3),
    ("search basic --edges 2 --workers 0", 0),
    ("search basic,mappers.py:guesses --edges 2 --workers 0 --in-process", 1),
    (f"search --edges 2 --workers 0 {SKIPPING}", 3),
    ("prove proved proved-too", 0),
    ("prove proved unrefuted unproved", 1),
    ("prove proved unproved", 3),
    ("conform basic --worlds 'edges<=2' --workers 0", 0),
    ("conform mappers.py:guesses --worlds 'edges<=2' --workers 0 --in-process", 1),
    (f"conform --worlds 'edges<=2' --workers 0 {SKIPPING}", 3),
    ("compare b.gz basic", 0),
    ("compare b.gz mappers.py:guesses --in-process", 1),
    (f"compare b.gz {SKIPPING}", 3),
    ("arena basic --suite tiny --workers 0", 0),
    ("arena basic,mappers.py:guesses --suite tiny --workers 0 --in-process", 1),
    (f"arena --suite tiny --workers 0 {SKIPPING}", 3),
]


@pytest.mark.nightly
@pytest.mark.usefixtures("baseline")
@pytest.mark.parametrize(("line", "code"), OUTCOMES, ids=lambda one: str(one).partition(" ")[0])
def test_every_form_of_an_outcome_agrees(line: str, code: int, call: Call) -> None:
    require_agreement(forms(call, line), code)


# ---------------------------------------------------------------- interrupted


@pytest.fixture
def interrupt(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], None]:
    """Let Ctrl-C come at this call of the progress bar; every command calls it often."""

    def interrupt(at: int) -> None:
        calls = count(1)

        def pressed(*_: object) -> None:
            if next(calls) == at:
                raise KeyboardInterrupt

        monkeypatch.setattr(progress, "INTERVAL", 0)  # it is told of everything, however fast
        monkeypatch.setattr(ProgressBar, "__call__", pressed)

    return interrupt


INTERRUPTED = [
    ("verify mappers.py:right --quick --in-process", (1, 3)),
    ("search basic,folding --edges 2 --workers 0", (1, 2)),
    ("prove proved proved-too", (1, 2)),
    ("conform basic --worlds 'edges<=2' --workers 0", (1, 5)),
    ("conform basic,folding --worlds 'edges<=2' --workers 0", (14,)),
    ("compare b.gz basic", (1, 5)),
    ("arena basic,folding --suite tiny --workers 0", (1, 5)),
]


@pytest.mark.usefixtures("baseline")
@pytest.mark.parametrize(
    ("line", "at"),
    [
        pytest.param(line, at, id=f"{line[:30]} at {at}")
        for line, places in INTERRUPTED
        for at in places
    ],
)
def test_every_form_of_an_interrupted_run_agrees(
    line: str, at: int, call: Call, interrupt: Callable[[int], None]
) -> None:
    found = forms(call, line, lambda: interrupt(at))
    require_agreement(found, 3)
    assert "interrupted" in found.page


@pytest.mark.usefixtures("baseline")
@pytest.mark.parametrize(
    ("line", "at"),
    [
        ("search mappers.py:guesses,basic --edges 2 --workers 0 --in-process", 8),
        ("prove unrefuted proved", 2),
        ("conform mappers.py:guesses --worlds 'edges<=2' --workers 0 --in-process", 8),
        ("arena mappers.py:guesses --suite tiny --workers 0 --in-process", 9),
    ],
)
def test_a_refutation_outranks_the_interrupt(
    line: str, at: int, call: Call, interrupt: Callable[[int], None]
) -> None:
    require_agreement(forms(call, line, lambda: interrupt(at)), 1)


@pytest.mark.usefixtures("baseline")
@pytest.mark.parametrize(
    "line",
    [
        "explore m2/5 --target basic,folding",
        "record basic --worlds 'edges<=2' --out c.gz",
        "play m2/5 --target basic,folding",
    ],
)
def test_an_interrupted_run_that_has_no_report_is_not_ok(
    line: str, call: Call, interrupt: Callable[[int], None]
) -> None:
    interrupt(2)
    done = call(f"{line} --quiet --format json")
    envelope = json.loads(done.stdout)
    assert (done.exit_code, envelope["exit"], envelope["ok"]) == (3, 3, False)
    assert not Path("c.gz").exists()


# ---------------------------------------------------------------- lost workers, resumed runs


@pytest.mark.nightly
@pytest.mark.parametrize(
    "line",
    [
        "search deadly.py:once --edges 2 --workers 2",
        "conform deadly.py:once --worlds 'edges<=2' --workers 2",
        "arena deadly.py:once --suite tiny --workers 2",
    ],
)
def test_every_form_of_a_killed_mapper_agrees(line: str, call: Call) -> None:
    """At the second try it is right: it may have been killed by another program."""
    require_agreement(forms(call, line, lambda: Path("killed").unlink(missing_ok=True)), 3)


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("line", "at"),
    [
        ("search basic --edges 2 --workers 0 --ledger done", 1),
        ("arena basic --suite tiny --workers 0 --out done", 9),
    ],
)
def test_every_form_of_a_resumed_run_agrees(
    line: str, at: int, call: Call, interrupt: Callable[[int], None]
) -> None:
    interrupt(at)
    assert call(f"{line} --quiet").exit_code == 3
    interrupt(0)
    require_agreement(forms(call, line), 0)


def test_an_entry_takes_its_fields_from_what_it_reports_on_and_refuses_a_wrong_one() -> None:
    refused = RefutationCertificate(format="drup", checker="a checker", checked=False)
    assert entry_of(_Checked, refused, checker="another") == _Checked("another", checked=False)
    with pytest.raises(msgspec.ValidationError, match="checker"):
        entry_of(_Checked, refused, checker=1)
    with pytest.raises(msgspec.ValidationError, match="missing required field `checked`"):
        entry_of(_Checked, checker="a checker")


class _Checked(msgspec.Struct, frozen=True):
    checker: str
    checked: bool
    total: int = 0
