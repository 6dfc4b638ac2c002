"""A run, and a second one if the program of the first was killed in it.

A program, or a mapper in a process of its own, may be killed by what it does, or by a stranger: a
system that lacks memory sends SIGKILL. So the world is tried again. What the second run says of the
first:

    it crashed, and passes now           still a finding, and the message says so
    it got SIGKILL, and passes now       `killed`: the world is undecided
    it fails again                       the finding of the first run
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from topo_verify.harness.judge import Report
from topo_verify.harness.run import Exploration, explore
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.world.rooted_map import World


class Tried(NamedTuple):
    """A run in a world and its report.

    Attributes:
        killed: the signal with which a stranger may have ended an earlier run; None: none did.
    """

    run: Exploration
    report: Report
    killed: str | None = None


def tried(
    world: World, target: Target, limits: Limits, judged: Callable[[Exploration], Report]
) -> Tried:
    """Run a mapper in a world, again if its process was killed, and judge the run.

    Args:
        judged: makes the report on a run.
    """
    run = explore(world, target, limits=limits)
    report = judged(run)
    if run.misbehaved is None or run.misbehaved.signal is None:
        return Tried(run, report)
    second = explore(world, target, limits=limits)
    passed = judged(second)
    if not passed.ok:
        return Tried(run, report)
    if run.misbehaved.signal == "SIGKILL":
        return Tried(second, passed, run.misbehaved.signal)
    run = replace(run, stopped=f"{run.stopped}; at the second try it delivered one")
    return Tried(run, judged(run))
