"""A line for each message of the protocol, and lines that hold none. Standard library alone."""

from __future__ import annotations

import json

MAP: dict[str, object] = {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}
EVENT: dict[str, object] = {"type": "pose", "edge": 0, "hypotheses": []}
DONE: dict[str, object] = {"type": "done", "map": MAP, "cost": 1}

MESSAGES: dict[str, dict[str, object]] = {
    "start": {"type": "start", "protocol": 1, "percept": {"degree": 1, "marker": 0}},
    "percept": {"type": "percept", "degree": 1, "marker": 0},
    "stop": {"type": "stop"},
    "move": {"type": "move", "door": 0},
    "declare": {"type": "declare", "event": EVENT},
    "done": DONE,
    "skip": {"type": "skip", "why": "too hard"},
    "error": {"type": "error", "why": "out of ideas"},
    "ready": {"type": "ready"},
    "refused": {"type": "refused", "why": "no such mapper"},
    "undelivered": {"type": "undelivered", "kind": "no-map", "why": "it raised"},
    "over": {"type": "over"},
    "stock": {"type": "stock"},
    "loaded": {"type": "loaded", "loaded": {}},
    "teleport": {"type": "teleport"},
    "nothing": {},
    "run": {"id": "m1/0", "doors": [0], "map": MAP},
}
"""A message of each type, one of an unknown type, one without a type, and a run of a batch."""

BROKEN: dict[str, bytes] = {
    "no JSON": b"hello\n",
    "not UTF-8": b'{"type":"\xff","id":"\xff"}\n',
    "nested": b'{"type":"move","x":' + b"[" * 100_000 + b"\n",
}
"""Lines that hold no message."""

LINES = {name: json.dumps(message).encode() + b"\n" for name, message in MESSAGES.items()} | BROKEN
