"""A mapper that writes messages of the protocol into the pipe of its process.

Its seed (environment variable `FORGER`) and the first percept decide the messages, the moments, and
whether its map is right.
"""

import fcntl
import os
import stat
import sys
from pathlib import Path
from random import Random

sys.path.append(str(Path(__file__).resolve().parents[2] / "tests" / "programs"))

from messages import LINES

from topo_verify.algorithms import algorithm
from topo_verify.programs import loaded
from topo_verify.robot.events import Robot

WORLDS = ("before a move", "after a move", "after a decision", "after the end")

MOMENTS = (*WORLDS * 3, "while it is loaded", "when it is asked what it has loaded")


def moments(seed: str) -> set[str]:
    """The moments at which the mapper of a seed writes."""
    draw = Random(seed)
    return {*draw.choices(MOMENTS, k=draw.choice((1, 1, 2, 3)))}


def write(draw: Random) -> None:
    """Write one to three lines into the pipe to topo-verify."""
    for place in range(3, 64):
        try:
            found, flags = os.fstat(place), fcntl.fcntl(place, fcntl.F_GETFL)
        except OSError:  # it is not open
            continue
        if stat.S_ISFIFO(found.st_mode) and flags & os.O_ACCMODE == os.O_WRONLY:
            data = b"".join(
                LINES[name] for name in draw.choices(sorted(LINES), k=draw.choice((1, 1, 3)))
            )
            while data:
                data = data[os.write(place, data) :]
            return


def explore(robot: Robot) -> object:
    """Map a world, and write at the moments of the seed."""
    draw = Random(f"{SEED} {robot.percept}")
    if "before a move" in CHOSEN:
        write(draw)
    if "after a move" in CHOSEN and robot.percept.degree:
        robot.move(0)
        write(draw)
        robot.move(0)
    if "after a decision" in CHOSEN:
        robot.declare({"type": "pose", "edge": 0, "hypotheses": []})
        write(draw)
    result = algorithm("basic")(robot) if draw.random() < 0.7 else None
    if "after the end" in CHOSEN:
        sys.setprofile(lambda _frame, event, function: _flushed(event, function, draw))
    return result


def _flushed(event: str, function: object, draw: Random) -> None:
    """Write once the message that ends the world is sent."""
    if event == "c_return" and "flush of _io.BufferedWriter" in repr(function):
        sys.setprofile(None)
        write(draw)


def _listed(values: str = "") -> loaded.Loaded:
    write(Random(f"{SEED} listed"))
    return LOADED(values)


SEED = os.environ.get("FORGER", "")
CHOSEN = moments(SEED) if SEED else set[str]()
LOADED = loaded.loaded
if "when it is asked what it has loaded" in CHOSEN:
    loaded.loaded = _listed
if "while it is loaded" in CHOSEN:
    write(Random(f"{SEED} loading"))
