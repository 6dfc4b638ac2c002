"""A program that misbehaves in one way in the second world it is given, and is right in the others.

    python misbehaving.py WAY

It knows only worlds of one edge: `m1/0`, two vertices, and `m1/1`, a loop. Standard library alone.
"""

import json
import os
import select
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn

WAY = sys.argv[1] if len(sys.argv) > 1 else ""

LEAF = {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}
LOOP = {"vertices": [[0, 1]], "edges": [[0, 1]], "marker": 0}


def write(text: str | bytes) -> object:
    data = text if isinstance(text, bytes) else text.encode()
    while data:
        data = data[os.write(1, data) :]
    return None


def say(**message: object) -> object:
    return write(json.dumps(message) + "\n")


def hear() -> dict[str, Any]:
    message: dict[str, Any] = json.loads(sys.stdin.readline() or '{"type": "stop"}')
    return message


def linger() -> object:
    """A child in a group of its own that would live on for a minute; its number is told."""
    child = subprocess.Popen(
        [sys.executable, "-c", "import time; time.sleep(60)"], start_new_session=LOOSE
    )
    with Path("lingers").open("a", encoding="utf-8") as file:
        return file.write(f"{child.pid}\n")


LOOSE = WAY == "leaves a child in a session of its own"


def rest(seconds: float = 60) -> object:
    return time.sleep(seconds)  # type: ignore[func-returns-value]


def crash() -> object:
    return os.kill(os.getpid(), signal.SIGSEGV)  # type: ignore[func-returns-value]


def close(stream: int) -> object:
    return os.close(stream)  # type: ignore[func-returns-value]


def forever(data: bytes, stream: int = 1) -> NoReturn:
    while True:
        os.write(stream, data)


def deliver() -> object:
    """Map the loop as it should be."""
    return say(type="move", door=0), hear(), say(type="done", map=LOOP, cost=1)


def ignore_signals() -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    time.sleep(60)


POSE: dict[str, object] = {"type": "pose", "edge": 0, "hypotheses": []}

WAYS: dict[str, Callable[[], object]] = {
    "hangs": rest,
    "exits": lambda: sys.exit(7),
    "exits with success": lambda: sys.exit(0),
    "raises": lambda: [0][len(WAY)],
    "kills itself": lambda: os.kill(os.getpid(), signal.SIGKILL),
    "crashes": crash,
    "closes its output": lambda: (close(1), rest()),
    "closes its input": lambda: (close(0), say(type="move", door=0), rest()),
    "floods stdout": lambda: forever(b"x" * 65536),
    "floods stdout with lines": lambda: forever(b"spam\n" * 10000),
    "floods stderr": lambda: forever(b"spam\n" * 10000, 2),
    "floods moves": lambda: forever(b'{"type": "move", "door": 0}\n' * 1000),
    "floods declarations": lambda: forever(
        (json.dumps({"type": "declare", "event": POSE}) + "\n").encode() * 1000
    ),
    "prints garbage": lambda: write("hello, world\n"),
    "prints an empty line": lambda: write("\n"),
    "prints binary": lambda: write(b"\x00\x80\xff\xfe\n"),
    "prints binary in a string": lambda: write(b'{"type": "skip", "why": "\xff"}\n'),
    "prints half a line and exits": lambda: (write('{"type": "mo'), sys.exit(0)),
    "prints half a line and hangs": lambda: (write('{"type": "mo'), rest()),
    "prints a line of 10 MB": lambda: write(b'{"type": "skip", "why": "' + b"x" * 10**7 + b'"}\n'),
    "nests 100,000 brackets": lambda: write(b'{"type": "move", "x": ' + b"[" * 100_000 + b"\n"),
    "nests in a known field": lambda: write(b'{"type": "done", "map": ' + b"[" * 100_000 + b"\n"),
    "says NaN": lambda: write('{"type": "move", "door": NaN}\n'),
    "says half a door": lambda: say(type="move", door=0.5),
    "says true for a door": lambda: say(type="move", door=True),
    "says a door in words": lambda: say(type="move", door="0"),
    "says a huge door": lambda: say(type="move", door=10**40),
    "asks for door 99": lambda: say(type="move", door=99),
    "asks for door -1": lambda: say(type="move", door=-1),
    "says a list": lambda: write("[]\n"),
    "says null": lambda: write("null\n"),
    "says no type": lambda: say(door=0),
    "says an unknown type": lambda: say(type="teleport", to=5),
    "declares nonsense": lambda: say(type="declare", event={"type": "pose", "edge": "e"}),
    "declares a start": lambda: say(type="declare", event={"type": "start"}),
    "delivers a map of words": lambda: say(type="done", map="a square"),
    "delivers a map without edges": lambda: say(type="done", map={"vertices": [], "edges": []}),
    "delivers a map of nonsense": lambda: say(
        type="done", map={"vertices": [[0], [0]], "edges": [[5]], "marker": 9}
    ),
    "delivers another map": lambda: (say(type="move", door=0), hear(), say(type="done", map=LEAF)),
    "delivers too early": lambda: say(type="done", map=LOOP, cost=0),
    "lies about its cost": lambda: (
        say(type="move", door=0),
        hear(),
        say(type="done", map=LOOP, cost=5),
    ),
    "goes on after the end": lambda: (
        say(type="move", door=0),
        hear(),
        write((json.dumps({"type": "done", "map": LOOP}) + "\n") * 2),
    ),
    "goes on later": lambda: (deliver(), rest(0.1), write("and another thing\n")),
    "goes on in halves": lambda: (deliver(), write("and ano"), rest(0.1), write("ther\n")),
    "delivers and reads no more": lambda: (deliver(), rest()),
    "delivers and crashes": lambda: (deliver(), crash()),
    "delivers and ends": lambda: (deliver(), sys.exit(0)),
    "floods declarations of 1 MB": lambda: forever(
        (
            json.dumps({"type": "declare", "event": {**POSE, "hypotheses": [0] * 330_000}}) + "\n"
        ).encode()
    ),
    "ignores SIGTERM": ignore_signals,
    "leaves a child": lambda: (linger(), sys.exit(1)),
    "leaves a child in a session of its own": lambda: (linger(), sys.exit(1)),
    "skips": lambda: say(type="skip", why="no loops, please"),
    "gives up": lambda: say(type="error", why="out of ideas"),
    "walks for ever": lambda: [(say(type="move", door=0), hear()) for _ in iter(int, 1)],
    "strolls": lambda: [
        (say(type="move", door=0), hear(), select.select([], [], [], 0.1)) for _ in iter(int, 1)
    ],
}


def main() -> None:
    while (message := hear())["type"] == "start":
        degree = message["percept"]["degree"]
        if degree == 2:
            WAYS[WAY]()
            continue
        say(type="move", door=0)
        hear()
        say(type="done", map=LEAF if degree == 1 else LOOP, cost=1)


if __name__ == "__main__":
    main()
