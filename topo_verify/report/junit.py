"""An account as a JUnit file, which continuous integration shows: one test case a judged thing.

| outcome | in the file | because |
| --- | --- | --- |
| passed | no child | |
| failed | `failure` | a claim fails; the text has the command that shows it |
| undecided | `error` | a time-out or an UNKNOWN is no pass, and `skipped` counts as one |
| not judged | `skipped` | the mapper declares nothing about it, or it was not asked for |

The file is valid against the schema of Ant's JUnit task (tests/report/test_junit.py), the narrowest
of those in use. It wants times: a suite has its own where that is known, a case that of its suite
where it is alone in it; else they are 0. `seconds` among the properties is the time of the whole
run. The host is not named.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from topo_verify.report.account import UNFINISHED, Account, Ending, JudgedCase, JudgedSuite, Outcome
from topo_verify.report.html import xml_text

_CHILD: dict[Outcome, str] = {"failed": "failure", "undecided": "error", "not-judged": "skipped"}


def junit(account: Account, run: Ending) -> str:
    """The account as JUnit XML; a case says so if the work did not come to its end."""
    suites = list(account.suites)
    times = [run.seconds] if len(suites) == 1 else list(run.by_suite)
    if len(times) != len(suites):
        times = [0.0] * len(suites)
    if not run.finished or not suites:
        case = UNFINISHED if not run.finished else NOTHING
        suites.append(JudgedSuite("the run", (case,)))
        times.append(0.0)
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', "<testsuites>"]
    for number, (suite, seconds) in enumerate(zip(suites, times, strict=True)):
        lines += _suite(number, suite, seconds, account, run)
    return "\n".join([*lines, "</testsuites>", ""])


NOTHING = JudgedCase("judged something", "UNKNOWN", "undecided", message="nothing was judged")
"""The case of a run without results."""


def _suite(
    number: int, suite: JudgedSuite, seconds: float, account: Account, run: Ending
) -> Iterator[str]:
    count = Counter(case.outcome for case in suite.cases)
    place = xml_text(f"topo-verify.{run.command}")
    yield (
        f'<testsuite id="{number}" package="{place}" name="{xml_text(suite.name)}"'
        f' tests="{len(suite.cases)}" failures="{count["failed"]}" errors="{count["undecided"]}"'
        f' skipped="{count["not-judged"]}" hostname="localhost"'
        f' timestamp="{run.date:%Y-%m-%dT%H:%M:%S}" time="{seconds:.3f}">'
    )
    told = {
        "about": account.about,
        "verdict": account.extent.verdict,
        "checked": account.extent.words,
        "command": run.again,
        "seconds": f"{run.seconds:.3f}",
    }
    rows = (f'<property name="{k}" value="{xml_text(v)}"/>' for k, v in told.items())
    yield f"<properties>{''.join(rows)}</properties>"
    alone = seconds if len(suite.cases) == 1 else 0.0
    for case in suite.cases:
        opened = (
            f'<testcase name="{xml_text(case.name)}"'
            f' classname="{place}.{xml_text(suite.name)}" time="{alone:.3f}"'
        )
        inner = _inner(case, case.again or run.again)
        yield f"{opened}>{inner}</testcase>" if inner else f"{opened}/>"
    yield "<system-out/><system-err/>"
    yield "</testsuite>"


def _inner(case: JudgedCase, again: str) -> str:
    if case.outcome == "passed":
        return ""
    what = f"{case.verdict}, judged {case.judged}" if case.judged else case.verdict
    message = xml_text(f"{what}: {case.message}" if case.message else what)
    child = _CHILD[case.outcome]
    if child == "skipped":
        return f'<skipped message="{message}"/>'
    text = f"{message}\nagain: {xml_text(again)}"
    return f'<{child} type="{xml_text(case.verdict)}" message="{message}">{text}</{child}>'
