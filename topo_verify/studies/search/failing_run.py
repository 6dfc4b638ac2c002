"""The judged run of a counterexample, as data that travels from a worker in the row's note.

So what is shown is what was judged: no mapper runs again to be shown.
"""

from __future__ import annotations

from typing import Any

import msgspec

from topo_verify.campaign.attempt import Attempt, Look
from topo_verify.campaign.judge import JudgedRun, Report
from topo_verify.campaign.row import Row
from topo_verify.robot.events import read_trace, write_trace
from topo_verify.world.rooted_map import World

MOST_EVENTS = 2000
"""Events of the longest run that is kept; a search keeps some hundred rows."""

LOOK = f"{__name__}:look"
"""The `look` of a campaign."""


class FailingRun(msgspec.Struct, frozen=True):
    """A report, and the rest of the run that it judges."""

    report: Report
    trace: str
    stopped: str | None


def look() -> Look:
    """What notes the run if a claim fails in it."""
    return _noted


def _noted(judged: Attempt) -> Any:
    report, run = judged.report, judged.run
    if not report.findings or not 0 < len(run.trace) <= MOST_EVENTS:
        return None
    try:
        trace = write_trace(run.trace).decode()
    except (TypeError, ValueError, OverflowError):
        return None  # a mapper in this process declared its own objects
    return FailingRun(report, trace, run.stopped)


def report_of(row: Row, claim: str) -> Report | None:
    """The report of the run in which this claim failed; None if it was not kept."""
    if row.note is None:
        return None
    kept = msgspec.convert(row.note, FailingRun)
    if all(finding.claim != claim for finding in kept.report.findings):
        return None
    trace = read_trace(kept.trace.encode())
    return kept.report.of(JudgedRun(World.from_id(row.world), trace, kept.stopped))
