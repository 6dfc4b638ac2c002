"""Mappers that are right but for certain calls, counted in their process.

misdeeds.py:from_80_skip              declines from its 80th world on
misdeeds.py:at_20_map_from_60_hang    a wrong map once, then it hangs
misdeeds.py:unsorted_skip             declines each world that is smaller than one before it
python misdeeds.py from_80_skip       the first one as a program behind the pipe
"""

from __future__ import annotations

import itertools
import json
import os
import signal
import sys
import time
from collections.abc import Callable
from functools import partial
from typing import Any

from topo_verify import CATALOGUE, Robot
from topo_verify.algorithms.chart import Survey
from topo_verify.programs.library import Skipped
from topo_verify.robot.percept import Percept

DEEDS = ("map", "nothing", "skip", "error", "hang", "kill", "doors", "cost")

calls = itertools.count(1)

sizes = [0]
"""The edges of the worlds of this process so far."""


class Declined(Exception):
    """A program's message `error`."""


def done(deed: str, robot: Robot) -> Any:
    """What a misdeed delivers, if it delivers anything."""
    match deed:
        case "map":
            return {"vertices": ((),), "edges": (), "marker": None}
        case "skip":
            raise Skipped("not today")
        case "error":
            raise Declined("not today")
        case "hang":
            time.sleep(60)
        case "memory":
            raise MemoryError
        case "kill":
            os.kill(os.getpid(), signal.SIGKILL)
        case "doors":
            return CATALOGUE["basic"].with_policies(pick="last", order="newest")(robot)
        case "cost":
            robot.move(0)
            robot.move(0)
            return CATALOGUE["basic"](robot)
        case _:
            pass
    return None


def __getattr__(name: str) -> Callable[[Robot], Any]:
    words = name.split("_")
    if words[0] == "unsorted":
        return partial(unsorted, words[1])
    if words[0] not in ("at", "from"):
        raise AttributeError(name)
    plan = [
        (when, int(number), deed)
        for when, number, deed in zip(words[::3], words[1::3], words[2::3], strict=True)
    ]

    def explore(robot: Robot) -> Any:
        call = next(calls)
        for when, number, deed in plan:
            if call == number or (when == "from" and call > number):
                return done(deed, robot)
        return CATALOGUE["basic"](robot)

    return explore


def unsorted(deed: str, robot: Robot) -> Any:
    """Right as long as worlds come in the order of a search, smaller ones first."""
    survey = CATALOGUE["basic"](robot)
    sizes.append(len(survey.edges))
    return survey if sizes[-1] == max(sizes) else done(deed, robot)


class Piped:
    """The robot behind the pipe."""

    def __init__(self, percept: dict[str, Any]) -> None:
        self.percept = Percept(percept["degree"], percept["marker"])

    def move(self, door: int, purpose: object = None) -> Percept:
        """Leave by a door, for whatever purpose."""
        del purpose
        tell({"type": "move", "door": door})
        percept = json.loads(sys.stdin.readline())
        self.percept = Percept(percept["degree"], percept["marker"])
        return self.percept

    def declare(self, event: object) -> None:
        """Declare nothing."""
        del event


def tell(message: dict[str, Any]) -> None:
    """Write one message."""
    print(json.dumps(message), flush=True)  # noqa: T201  the protocol


if __name__ == "__main__":
    mapper = __getattr__(sys.argv[1])
    for line in sys.stdin:
        start = json.loads(line)
        if start["type"] == "stop":
            break
        try:
            survey = mapper(Piped(start["percept"]))
        except (Skipped, Declined) as why:
            tell({"type": "skip" if isinstance(why, Skipped) else "error", "why": str(why)})
            continue
        if survey is None:
            sys.exit(1)
        if isinstance(survey, Survey):
            survey = {"vertices": survey.vertices, "edges": survey.edges, "marker": survey.marker}
        tell({"type": "done", "map": survey})
