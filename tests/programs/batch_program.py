"""A program for batch mode that is right, but for one world, in which it errs in one way."""

import json
import os
import sys
import time
from collections.abc import Callable
from typing import Any

import msgspec

from topo_verify import World, explore
from topo_verify.robot.events import Augment, Confirm, Move, Pose, Reject

WAY = sys.argv[1] if len(sys.argv) > 1 else "right"
BAD = "m2/5"

Run = dict[str, Any]


def run_in(world: World, name: str) -> Run:
    found = explore(world, "basic")
    doors: list[int] = []
    declared: list[Run] = []
    for event in found.trace:
        if isinstance(event, Move):
            doors.append(event.door)
        elif isinstance(event, Pose | Reject | Confirm | Augment):
            declared.append({"after": len(doors), "event": msgspec.to_builtins(event)})
    delivered = msgspec.to_builtins(found.map)
    return {"id": name, "doors": doors, "declare": declared, "map": delivered, "cost": found.cost}


def say(text: str, end: str = "\n") -> None:
    sys.stdout.write(text + end)
    sys.stdout.flush()


def without_a_run(run: Run) -> Run | None:
    """What is done in the bad world beside writing its run."""
    match WAY:
        case "exits":
            sys.exit(3)
        case "hangs":
            time.sleep(60)
        case "garbage":
            say("spam")
        case "half a line":
            say('{"id": ', end="")
            os._exit(0)
        case "10 MB":
            say("x" * 10**7)
        case "twice":
            say(json.dumps(run))
        case "leaves out":
            return None
        case _:
            pass
    return run


BENT: dict[str, Callable[[Run], Run | None]] = {
    "another id": lambda run: {**run, "id": "m9/9"},
    "no door": lambda run: {**run, "doors": [*run["doors"], 99]},
    "no map": lambda run: {"id": run["id"], "doors": run["doors"]},
    "late decision": lambda run: {**run, "declare": [{**run["declare"][0], "after": 10000}]},
    "no decision": lambda run: {**run, "declare": [{"after": 0, "event": {"type": "start"}}]},
    "too many doors": lambda run: {**run, "doors": [0] * 100, "declare": []},
    "lies": lambda run: {**run, "cost": 999},
    "another map": lambda run: {
        **run,
        "map": {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0},
    },
    "skip": lambda run: {"id": run["id"], "skip": "not this one"},
    "error": lambda run: {"id": run["id"], "error": "not this one"},
}
"""The run of the bad world, as it should not be."""


def main() -> None:
    runs: list[Run] = []
    for line in sys.stdin:
        task = json.loads(line)
        right = run_in(World.from_json(json.dumps(task["world"])), task["id"])
        run = BENT.get(WAY, without_a_run)(right) if task["id"] == BAD else right
        if run is None:
            continue
        if WAY == "backwards":
            runs.insert(0, run)
        else:
            say(json.dumps(run))
    for run in runs:
        say(json.dumps(run))


if __name__ == "__main__":
    main()
