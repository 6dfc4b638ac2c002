"""A program that misbehaves: what tests/programs/misbehaving.py can do, and combinations of it.

    python hostile.py SEED

The seed and the world decide one to three ways, one after the other. It knows the two worlds of one
edge, and sometimes maps them rightly.
"""

import os
import signal
import sys
from pathlib import Path
from random import Random

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests" / "programs"))

import misbehaving
from misbehaving import LEAF, LOOP, POSE, WAYS, hear, say, write

SEED = sys.argv[1]


def stop_itself() -> None:
    """Wait for a SIGCONT that never comes."""
    os.kill(os.getpid(), signal.SIGSTOP)


def become_another() -> None:
    """Become a program that knows no protocol."""
    os.execvp("sleep", ["sleep", "60"])  # noqa: S606, S607  that is the point


def move(door: int) -> None:
    """Leave by the door, and listen."""
    say(type="move", door=door)
    hear()


def loosely() -> None:
    """Leave a child in another session."""
    misbehaving.LOOSE = True
    misbehaving.linger()


MORE = {
    **WAYS,
    "moves": lambda: move(0),
    "moves without listening": lambda: say(type="move", door=0),
    "declares a decision": lambda: say(type="declare", event=POSE),
    "forks": os.fork,
    "forks and leaves": lambda: os.fork() and sys.exit(3),
    "stops itself": stop_itself,
    "becomes another program": become_another,
    "ignores every signal": lambda: [signal.signal(n, signal.SIG_IGN) for n in (1, 2, 3, 13, 15)],
    "writes to standard error": lambda: os.write(2, b"\x1b[31m\xff\n" * 99),
    "leaves a child in a session": loosely,
    "writes half a message": lambda: write(b'{"type": "move", '),
    "is right": lambda: say(type="done", map=LOOP, cost=1),
}


def main() -> None:
    """Answer each world by the seed."""
    while (message := hear()).get("type") == "start":
        degree = message["percept"]["degree"]
        draw = Random(f"{SEED} {degree}")
        if draw.random() < 0.2:
            move(0)
            say(type="done", map=LEAF if degree == 1 else LOOP, cost=1)
            continue
        for way in draw.choices(sorted(MORE), k=draw.choice((1, 1, 2, 3))):
            misbehaving.WAY = way
            MORE[way]()


if __name__ == "__main__":
    main()
