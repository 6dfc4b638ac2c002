"""An account as a JUnit file, which continuous integration shows: one test case a judged thing.

| outcome | in the file | because |
| --- | --- | --- |
| passed | no child | |
| failed | `failure` | a claim fails; the text has the command that shows it |
| undecided | `error` | a time-out or an UNKNOWN is no pass, and `skipped` counts as one |
| not judged | `skipped` | the mapper declares nothing about it, or it was not asked for |

The elements and attributes are those of the schema that Jenkins publishes, in its order.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from topo_verify.report.account import Account, JudgedCase, JudgedSuite, Outcome
from topo_verify.report.escape import xml_text

_CHILD: dict[Outcome, str] = {"failed": "failure", "undecided": "error", "not-judged": "skipped"}


@dataclass(frozen=True)
class JunitRun:
    """What the file says of a run beside its account.

    Attributes:
        command: of topo-verify, as `verify`.
        again: the command line that repeats the run.
        finished: whether the work came to its end; if not, a case says so.
        date, seconds: when the work ended (ISO 8601), and how long it took.
    """

    command: str
    again: str
    finished: bool
    date: str
    seconds: float


def junit(account: Account, run: JunitRun) -> str:
    """The account as JUnit XML."""
    suites = list(account.suites)
    if not run.finished:
        suites.append(JudgedSuite("the run", (UNFINISHED,)))
    total = _counts([case for suite in suites for case in suite.cases])
    name = xml_text(f"topo-verify {run.command}: {account.about}")
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<testsuites name="{name}" {total} time="{run.seconds:.3f}">',
    ]
    for suite in suites:
        lines += _suite(suite, run)
    return "\n".join([*lines, "</testsuites>", ""])


UNFINISHED = JudgedCase(
    "came to its end", "UNKNOWN", "undecided", message="interrupted: the rest was not judged"
)
"""The case of a run that was interrupted."""


def _counts(cases: Sequence[JudgedCase]) -> str:
    count = Counter(case.outcome for case in cases)
    return f'tests="{len(cases)}" failures="{count["failed"]}" errors="{count["undecided"]}"'


def _suite(suite: JudgedSuite, run: JunitRun) -> Iterator[str]:
    skipped = sum(case.outcome == "not-judged" for case in suite.cases)
    yield (
        f'<testsuite name="{xml_text(suite.name)}" {_counts(suite.cases)} skipped="{skipped}"'
        f' timestamp="{run.date}">'
    )
    place = xml_text(f"topo-verify.{run.command}.{suite.name}")
    for case in suite.cases:
        opened = f'<testcase name="{xml_text(case.name)}" classname="{place}"'
        inner = _inner(case, case.again or suite.again or run.again)
        yield f"{opened}>{inner}</testcase>" if inner else f"{opened}/>"
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
