"""An account as a JUnit file for continuous integration: one test case for each judged thing.

| outcome | in the file | because |
| --- | --- | --- |
| passed | no child | |
| failed | `failure` | a claim fails; the text has the command that shows it |
| undecided | `error` | it is no pass, and `skipped` would count as one |
| not judged | `skipped` | the mapper declares nothing about it, or it was not asked |

The file follows the schema of Ant's JUnit task, the narrowest in use. An unknown time is 0.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from topo_verify.report.account import Account, CaseOutcome, Ending, JudgedCase, JudgedSuite
from topo_verify.report.html import xml_text

_CHILD: dict[CaseOutcome, str] = {
    "failed": "failure",
    "undecided": "error",
    "not-judged": "skipped",
}


def junit(account: Account, run: Ending) -> str:
    """The account as JUnit XML, with a further case for each thing that the run lacks."""
    suites = list(account.suites)
    times = [run.seconds] if len(suites) == 1 else list(run.by_suite)
    if len(times) != len(suites):
        times = [0.0] * len(suites)
    if missing := run.missing or ([] if suites else [NOTHING]):
        suites.append(JudgedSuite("the run", tuple(missing)))
        times.append(0.0)
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', "<testsuites>"]
    for number, (suite, seconds) in enumerate(zip(suites, times, strict=True)):
        lines += _suite(number, suite, seconds, account, run)
    return "\n".join([*lines, "</testsuites>", ""])


NOTHING = JudgedCase("judged something", "UNKNOWN", "undecided", message="nothing was judged")


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
    properties = {
        "about": account.about,
        "verdict": account.extent.verdict,
        "checked": account.extent.words,
        "command": run.again,
        "seconds": f"{run.seconds:.3f}",
    }
    rows = (f'<property name="{k}" value="{xml_text(v)}"/>' for k, v in properties.items())
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
    verdict = f"{case.verdict}, judged {case.judged}" if case.judged else case.verdict
    message = xml_text(f"{verdict}: {case.message}" if case.message else verdict)
    child = _CHILD[case.outcome]
    if child == "skipped":
        return f'<skipped message="{message}"/>'
    text = f"{message}\nagain: {xml_text(again)}"
    return f'<{child} type="{xml_text(case.verdict)}" message="{message}">{text}</{child}>'
