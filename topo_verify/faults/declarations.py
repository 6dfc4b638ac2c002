"""Mistakes in the declarations of a mapper that is right."""

from __future__ import annotations

from functools import partial

from topo_verify.algorithms import CATALOGUE
from topo_verify.faults.fault import ForwardingRobot, planted
from topo_verify.robot.events import Decision, Evidence, Reject
from topo_verify.robot.percept import Percept

fault = partial(planted, "declarations")

basic = CATALOGUE["basic"]


@fault("basic", "robot", claim="true-hypothesis-kept")
class leaves_out_every_reject(ForwardingRobot):
    """no rejection is declared, so hypotheses are posed and never heard of again"""

    def declare(self, event: Decision) -> None:
        if not isinstance(event, Reject):
            super().declare(event)


@fault("basic", "robot", claim="true-hypothesis-kept")
class leaves_out_every_second_reject(ForwardingRobot):
    """every second rejection is not declared"""

    rejections = 0

    def declare(self, event: Decision) -> None:
        self.rejections += isinstance(event, Reject)
        if not isinstance(event, Reject) or self.rejections % 2:
            super().declare(event)


@fault("basic", "robot", claim="rejection-justified")
class calls_every_rejection_folding(ForwardingRobot):
    """each rejection by walking is declared as one by folding, with evidence that is made up"""

    def declare(self, event: Decision) -> None:
        if isinstance(event, Reject):
            percept = Percept(424242, None)
            event = Reject(event.edge, event.hypothesis, "folding", Evidence(999, percept, percept))
        super().declare(event)


@fault("basic", "robot", claim="rejection-justified")
class rejects_under_another_label(ForwardingRobot):
    """each rejection by walking is declared as one by folding, with evidence of nothing"""

    def declare(self, event: Decision) -> None:
        if isinstance(event, Reject):
            event = Reject(event.edge, event.hypothesis, "folding", Evidence(999))
        super().declare(event)
