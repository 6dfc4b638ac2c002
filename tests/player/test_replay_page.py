"""docs/replay.md: each walk on the page shows the mistake; tests/docs/test_pages.py runs them."""

from __future__ import annotations

import pytest

from tests.pages import commands_on

SHOWN = dict(commands_on("replay.md"))


@pytest.mark.parametrize(
    ("mapper", "mistake"),
    [
        ("a", "it came here by v1:4 and back by v1:2, so door 1 is door 3"),
        ("b", "the way home from v1:3 is by door 1; the robot took no door"),
        ("c", "who comes in by v0:1 sees (3, marker 2); the robot saw (3, marker 1)"),
        ("astray", "asked for door 4 at a vertex with 4 doors"),
    ],
)
def test_the_walk_says_the_mistake(mapper: str, mistake: str) -> None:
    (text,) = [text for line, text in SHOWN.items() if line.endswith(f":{mapper}")]
    assert mistake in " ".join(text.split())
