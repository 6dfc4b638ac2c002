"""Mistakes in the declarations of a mapper that is right."""

from __future__ import annotations

from functools import partial

from topo_verify.algorithms import CATALOGUE
from topo_verify.faults.fault import Fault, ForwardingRobot
from topo_verify.robot.events import Decision, Evidence, Reject
from topo_verify.robot.percept import Percept

fault = partial(Fault, part="declarations")

basic = CATALOGUE["basic"]


class _SilentOnRejections(ForwardingRobot):
    def declare(self, event: Decision) -> None:
        if not isinstance(event, Reject):
            super().declare(event)


leaves_out_every_reject = fault(
    name="leaves-out-every-reject",
    why="no rejection is declared, so hypotheses are posed and never heard of again",
    claim="true-hypothesis-kept",
    mapper=lambda robot: basic(_SilentOnRejections(robot)),
)


class _SilentOnEverySecond(ForwardingRobot):
    rejections = 0

    def declare(self, event: Decision) -> None:
        self.rejections += isinstance(event, Reject)
        if not isinstance(event, Reject) or self.rejections % 2:
            super().declare(event)


leaves_out_every_second_reject = fault(
    name="leaves-out-every-second-reject",
    why="every second rejection is not declared",
    claim="true-hypothesis-kept",
    mapper=lambda robot: basic(_SilentOnEverySecond(robot)),
)


class _CitesNonsense(ForwardingRobot):
    def declare(self, event: Decision) -> None:
        if isinstance(event, Reject):
            percept = Percept(424242, None)
            event = Reject(event.edge, event.hypothesis, "folding", Evidence(999, percept, percept))
        super().declare(event)


calls_every_rejection_folding = fault(
    name="calls-every-rejection-folding",
    why="each rejection by walking is declared as one by folding, with evidence that is made up",
    claim="rejection-justified",
    mapper=lambda robot: basic(_CitesNonsense(robot)),
)


class _CitesNothing(ForwardingRobot):
    def declare(self, event: Decision) -> None:
        if isinstance(event, Reject):
            event = Reject(event.edge, event.hypothesis, "folding", Evidence(999))
        super().declare(event)


rejects_under_another_label = fault(
    name="rejects-under-another-label",
    why="each rejection by walking is declared as one by folding, with evidence of nothing",
    claim="rejection-justified",
    mapper=lambda robot: basic(_CitesNothing(robot)),
)
