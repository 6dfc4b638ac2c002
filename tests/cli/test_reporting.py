"""--report, --junit and --badge of the commands that judge."""

from __future__ import annotations

import os
import re
from pathlib import Path
from unittest.mock import Mock
from xml.etree import ElementTree as ET

import pytest

from tests.cli.conftest import Call, Refused
from tests.report.test_junit import objections
from topo_verify.checkers.findings import Judgement
from topo_verify.cli.output import command_line
from topo_verify.cli.verify import cases_of
from topo_verify.report.blocks import VERDICTS
from topo_verify.studies.verify.parts import Part

FILES = "--report r.html --junit r.xml --badge r.svg --quiet"


def _title() -> str:
    found = re.search(r"<title>(.*?)</title>", Path("r.svg").read_text())
    return found[1] if found else ""


COMMANDS = {
    "search 'mappers.py:guesses' --edges 2 --workers 0": (1, "REFUTED, 1 of 2 worlds fail"),
    "search basic --edges 2 --workers 0": (0, "EXHAUSTED, 12 of 12 worlds"),
    "prove percept undirected-any": (0, "PROVED, 2 of 2 theorems as expected"),
    "conform basic --like enhancement-ii --worlds m4/41 --worlds m1/0 --workers 0": (
        1,
        "REFUTED, 1 of 2 worlds fail",
    ),
    "explore m2/5 m1/0 --target mappers.py:guesses,basic": (1, "REFUTED, 1 of 4 runs fail"),
    "explore m3/14 --marker all --target folding": (0, "SAMPLED, 6 of 6 runs"),
    "explore nyc --target mappers.py:strolls --world-timeout 0.1": (3, "UNKNOWN, 0 of 1 runs"),
    "compare base.gz basic --tolerance 5": (1, "REFUTED, a regression in 1 of 2 worlds"),
    "compare base.gz enhancement-ii": (0, "SAMPLED, 2 of 2 worlds without regression"),
}
TAKE_LONG = {"prove", "conform", "compare"}


@pytest.mark.parametrize(
    "line",
    [
        pytest.param(line, marks=pytest.mark.long if line.split()[0] in TAKE_LONG else ())
        for line in COMMANDS
    ],
)
def test_each_command_gives_an_account_in_three_forms(line: str, call: Call) -> None:
    code, words = COMMANDS[line]
    if line.startswith("compare"):
        assert (
            call("record enhancement-ii --out base.gz --worlds m4/41 --worlds m1/0").exit_code == 0
        )
    done = call(f"{line} {FILES} --format json")
    assert done.exit_code == code, done.output
    assert _title().endswith(words)
    assert objections(Path("r.xml").read_text()) == []
    page = Path("r.html").read_text()
    assert f"<p>Exit code {code}: " in page
    assert f'again: <code class="copy">topo-verify {line.split(maxsplit=1)[0]} ' in page
    assert "--junit" not in page
    shown = page.count("<article ")
    assert shown == (0 if "SAMPLED, 2" in words or line.startswith("search basic") else shown)
    assert shown or code != 1  # what is undecided has no counterexample


def test_a_page_shows_each_counterexample_with_its_player(call: Call) -> None:
    call(f"search mappers.py:guesses --edges 2 --keep-going --workers 0 {FILES}")
    page = Path("r.html").read_text()
    assert page.count("<article ") == page.count('class="play"') == page.count("<figure>") >= 2
    assert "topo-verify replay m1/1 --target mappers.py:guesses" in page


@pytest.mark.nightly
def test_verify_has_a_suite_a_part_and_a_case_a_claim(call: Call) -> None:
    assert call(f"verify mappers.py:guesses --quick {FILES}").exit_code == 1
    suites = list(ET.parse("r.xml").getroot())  # noqa: S314  written by us a moment ago
    names = ["small-worlds", "sampled-worlds", "generated-worlds", "street-network"]
    assert [suite.get("name") for suite in suites] == names
    assert {suite.get("tests") for suite in suites} == {"11"}
    found = {c.get("name"): [one.tag for one in c] for c in suites[0].iter("testcase")}
    assert found["percepts-true"] == []
    assert found["map-isomorphic"] == ["failure"]
    assert found["decisions-entailed"] == ["skipped"]


@pytest.mark.long
def test_what_is_printed_is_the_same_with_a_report_and_without(call: Call) -> None:
    line = "search mappers.py:guesses --edges 2 --workers 0"
    assert call(line).stdout == call(f"{line} --report r.html").stdout


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ("--report -", "--report -: standard output is for the results"),
        ("--report .", "--report .: this is a folder"),
        ("--junit none/r.xml", "there is no folder"),
        ("--badge mappers.py/r.svg", "there is no folder"),
        ("--report a --junit ./a", "expected different files for --report and --junit"),
    ],
)
def test_a_file_that_cannot_be_written_is_refused_before_the_work(
    options: str, words: str, refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    never = Mock(side_effect=AssertionError("the work has begun"))
    monkeypatch.setattr("topo_verify.studies.search.search.Search.work", never)
    refused(f"search basic --edges 2 {options}", words)


def test_a_folder_without_permission_is_refused(
    refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "access", Mock(return_value=False))  # root may write anywhere
    refused(
        "search basic --edges 1 --report r.html", "--report r.html: no permission to write there"
    )


def test_the_command_line_leaves_out_how_results_are_shown() -> None:
    given = ["search", "a b.py:c", "--report", "r", "--junit=x", "--edges", "3", "--quiet"]
    assert command_line(given) == "topo-verify search 'a b.py:c' --edges 3"


def test_a_summary_opens_with_the_verdict_on_all(call: Call) -> None:
    lines = call("search basic --edges 2 --workers 0 --format markdown").stdout.splitlines()
    assert lines[0] == "**EXHAUSTED**: basic, 12 of 12 worlds"


NARROW = (
    pytest.param("search basic --edges 3 --worst --workers 0", marks=pytest.mark.long),
    pytest.param(
        "search --compare enhancement-ii,enhancement-i --edges 3 --workers 0",
        marks=pytest.mark.long,
    ),
    "conform basic --like enhancement-ii --worlds m4/41 --workers 0 --seed 0:0",
    pytest.param("prove percept undirected-any", marks=pytest.mark.long),
    "explore m4/41 m3/14 --target basic,folding",
    "explore m4/41 --gap",
    pytest.param(
        "explore 'family:lattice(10,10,holes=0.2,seed=7)' --target enhancement-iii-all+i",
        marks=pytest.mark.long,
    ),
    "explore m3/14 --target mappers.py:ignores_direction",
    "world show m4/41",
    "world count --edges 1..7",
    "world list --edges 2 -n 3",
    "record basic --worlds edges<=2 --out b.gz",
    pytest.param("verify mappers.py:guesses --quick", marks=pytest.mark.long),
)


@pytest.mark.parametrize("line", NARROW)
def test_fifty_columns_break_no_number_and_no_verdict(
    line: str, call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    printed: dict[int, str] = {}
    for columns in (400, 50):
        monkeypatch.setenv("COLUMNS", str(columns))
        printed[columns] = call(f"{line} --quiet").stdout
    wide = [one for one in printed[50].splitlines() if len(one) > 50 and "again: " not in one]
    assert wide == []
    words = {word for word in printed[400].split() if word.isdigit() or word in VERDICTS}
    assert words - set(printed[50].split()) == set()


def test_failures_of_which_no_finding_was_kept_are_counted_in_a_whole_phrase() -> None:
    part = Part(
        part="small-worlds",
        verdict="REFUTED",
        ok=False,
        checked=2,
        total=2,
        summary="",
        failing=2,
        claims={"cost-within-bound": {"failed": 2}},
        judgements=(Judgement("cost-within-bound", "failed", 2, 2),),
    )
    assert [case.message for case in cases_of(part)] == ["", "fails in 2 runs"]
