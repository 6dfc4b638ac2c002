"""A program that speaks protocol 1: it maps a single edge and declines a loop."""

import json
import sys


def send(**message):
    print(json.dumps(message), flush=True)


def main():
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] == "stop":
            return
        if message["protocol"] != 1 or message["percept"] != {"degree": 1, "marker": 0}:
            send(type="skip", why="expected protocol 1 and a vertex of degree 1")
            continue
        send(type="move", door=0, purpose="cross")
        seen = json.loads(sys.stdin.readline())
        new = {"type": "augment", "edge": 0, "kind": "new", "dart": 1, "degree": seen["degree"]}
        send(type="declare", event={"type": "pose", "edge": 0, "hypotheses": []})
        send(type="declare", event=new)
        edge = {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}
        send(type="done", map=edge, cost=1)


if __name__ == "__main__":
    main()
