"""The JUnit file: valid for the narrowest schema in use, and no UNKNOWN that looks like a pass."""

from __future__ import annotations

from dataclasses import replace
from xml.etree import ElementTree as ET

import pytest

from tests.report.accounts import HOSTILE, LONG_ID, RUN, account
from topo_verify.report.junit import junit

ATTRIBUTES = {
    "testsuites": set[str](),
    "testsuite": {
        *("id", "package", "name", "tests", "failures", "errors"),
        *("skipped", "hostname", "timestamp", "time"),
    },
    "properties": set[str](),
    "property": {"name", "value"},
    "testcase": {"name", "classname", "time"},
    "failure": {"type", "message"},
    "error": {"type", "message"},
    "skipped": {"message"},
    "system-out": set[str](),
    "system-err": set[str](),
}
"""All attributes of each element that the schema of Ant's JUnit task knows and that are used."""


def objections(text: str) -> list[str]:
    """What is wrong with a file, a sentence each."""
    root = ET.fromstring(text)  # noqa: S314  written by us a moment ago
    found = [
        f"{one.tag} has {sorted(one.attrib)}"
        for one in root.iter()
        if set(one.attrib) != ATTRIBUTES.get(one.tag)
    ]
    for number, suite in enumerate(root):
        tags = [one.tag for one in suite]
        cases = [one for one in suite if one.tag == "testcase"]
        if tags != ["properties", *["testcase"] * len(cases), "system-out", "system-err"]:
            found.append(f"{suite.get('name')} holds {tags}")
        if suite.get("id") != str(number):
            found.append(f"{suite.get('name')} has the id {suite.get('id')}")
        for name, child in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
            number_of = sum(case.find(child) is not None for case in cases)
            if suite.get(name) != str(number_of):
                found.append(f"{name} is {suite.get(name)}, and there are {number_of}")
        if suite.get("tests") != str(len(cases)):
            found.append(f"tests is {suite.get('tests')}, and there are {len(cases)}")
    return found


def test_each_outcome_is_what_continuous_integration_must_see() -> None:
    text = junit(account(), RUN)
    assert objections(text) == []
    children = [[one.tag for one in case] for case in ET.fromstring(text).iter("testcase")]  # noqa: S314
    assert children == [[], ["failure"], ["error"], ["skipped"]]


@pytest.mark.parametrize(
    ("what", "instead"),
    [
        ('failures="1"', 'failures="0"'),
        ('errors="1"', 'errors="0"'),
        ('tests="4"', 'tests="3"'),
        ('hostname="localhost" ', ""),
        ("<system-out/>", ""),
        ("<skipped message", "<skip message"),
    ],
)
def test_a_planted_mistake_in_the_file_is_seen(what: str, instead: str) -> None:
    text = junit(account(), RUN)
    assert what in text
    assert objections(text.replace(what, instead))


def test_a_failure_says_what_is_wrong_and_how_to_see_it() -> None:
    failure = ET.fromstring(junit(account(LONG_ID), RUN)).find(".//failure")  # noqa: S314
    assert failure is not None
    assert failure.get("message") == f"failed, judged 3 of 3: {LONG_ID}"
    assert (failure.text or "").endswith(f"\nagain: topo-verify replay {LONG_ID}")


def test_hostile_text_stays_text_and_control_characters_are_spelled_out() -> None:
    text = junit(account(HOSTILE), RUN)
    assert objections(text) == []
    assert not [c for c in text if c != "\n" and not c.isprintable()]
    case = list(ET.fromstring(text).iter("testcase"))[1]  # noqa: S314
    shown = HOSTILE.replace("\x1b", "\\x1b").replace("\ud800", "\\ud800")
    assert case.get("name") == shown


def test_an_interrupted_run_is_an_error_and_so_is_a_run_without_results() -> None:
    for made, run, name in (
        (account(), replace(RUN, finished=False), "finished"),
        (replace(account(), suites=()), RUN, "judged something"),
    ):
        text = junit(made, run)
        assert objections(text) == []
        last = list(ET.fromstring(text).iter("testcase"))[-1]  # noqa: S314
        assert (last.get("name"), last[0].tag) == (name, "error")
