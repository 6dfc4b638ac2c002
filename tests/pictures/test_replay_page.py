"""The walk that `replay` prints says the mistake of each mapper in examples/wrong_mappers.py."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.python import python

WRONG = Path(__file__).resolve().parents[2] / "examples" / "wrong_mappers.py"


@pytest.mark.parametrize(
    ("mapper", "world", "mistake"),
    [
        ("a", "m3/5", "it came here by v1:4 and back by v1:2, so door 1 is door 3"),
        ("b", "m2/1", "the way home from v1:3 is by door 1; the robot took no door"),
        ("c", "m2/5", "at v0:1 the robot would see (3, marker 2); it saw (3, marker 1)"),
        ("astray", "m3/5", "asked for door 4 at a vertex with 4 doors"),
    ],
)
def test_the_walk_says_the_mistake(mapper: str, world: str, mistake: str) -> None:
    done = python("-m", "topo_verify", "replay", world, "--target", f"{WRONG}:{mapper}")
    assert mistake in " ".join(done.stdout.split()), done.stderr
