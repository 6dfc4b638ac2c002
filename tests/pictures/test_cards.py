"""Reports and findings in a notebook: everything is said, and what comes from others stays text."""

from __future__ import annotations

import re
from base64 import b64decode
from html import unescape
from html.parser import HTMLParser
from typing import Any

import pytest

import topo_verify as tv
from topo_verify.checkers import Finding
from topo_verify.pictures import walk

WORLD = tv.World.from_id("m3/14")
HOSTILE = "<img src=x onerror=alert(1)>\"'&\x1b[2J</pre>"


TAGS = set(
    "style div p strong table thead tbody tr th td ul li figure img figcaption pre code".split()  # noqa: SIM905
)
"""The elements that cards are made of."""


def one_edge(_robot: tv.Robot) -> dict[str, Any]:
    """A mapper that says without a move that the world is one edge."""
    return {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}


class Elements(HTMLParser):
    """The elements of a page, in order; asserts that each that is opened is closed."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.all: list[tuple[str, dict[str, str | None]]] = []
        self.feed(page)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.all.append((tag, dict(attrs)))
        if tag != "img":
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def card(thing: Any) -> str:
    """The HTML that a notebook shows."""
    page: str = thing._repr_html_()
    Elements(page)
    return page


def words(page: str) -> str:
    return unescape(re.sub("<[^>]*>", " ", page))


def pictures(page: str) -> list[str]:
    return [b64decode(found).decode() for found in re.findall('base64,([^"]+)"', page)]


def test_a_report_shows_each_claim_with_its_coverage() -> None:
    report = tv.examine("enhancement-ii", WORLD)
    page = card(report)
    assert report.head in words(page)
    assert len(re.findall("<tr>", page)) == 1 + len(report.judgements)
    for one in report.judgements:
        assert re.search(f"{one.claim} .* ok .* {one.judged} of {one.of} ", words(page))
    assert pictures(page) == []


def test_a_report_with_a_finding_shows_the_world_and_the_walk_to_it() -> None:
    report = tv.examine(one_edge, WORLD)
    page = card(report)
    assert pictures(page) == [WORLD.draw()]
    assert report.playback is not None
    assert "\n".join(walk.lines(report.playback)) in unescape(page)
    for finding in report.findings:
        assert f"{finding.message}" in words(page)
    assert "✗ failed" in page
    assert "– not-declared" in page


def test_a_report_of_a_crash_says_that_there_is_no_map() -> None:
    def crash(_robot: tv.Robot) -> None:
        raise ValueError("lost")

    assert "map-isomorphic ✗ failed no map" in re.sub(
        r"\s+", " ", words(card(tv.examine(crash, WORLD)))
    )


def test_a_report_that_was_read_again_shows_what_it_holds() -> None:
    page = card(tv.examine(one_edge, WORLD).of(None))
    assert "✗ failed" in page
    assert "<pre" not in page


def test_a_finding_shows_its_world_and_its_witness() -> None:
    (finding,) = (f for f in tv.examine(one_edge, WORLD).findings if f.witness)
    assert finding.claim == "map-entailed"
    witness = tv.World.from_id(str(finding.witness))
    page = card(finding)
    assert pictures(page) == [WORLD.draw(), witness.draw()]
    assert finding.message in words(page)
    assert str(finding.expected) in words(page)


def test_a_world_that_is_its_own_witness_is_shown_once() -> None:
    assert len(pictures(card(Finding("c", 1, None, None, "m", "m3/14", "m3/14")))) == 1


@pytest.mark.parametrize("world", ["", "town.json", "nyc", "m3/999", "{", "m81/0"])
def test_a_world_without_a_picture_leaves_its_place_empty(world: str) -> None:
    assert pictures(card(Finding("c", None, None, None, "message", world=world))) == []


def test_what_comes_from_others_stays_text() -> None:
    world = tv.World.from_rotations(
        [[0], [1]], [[0, 1]], 0, name=HOSTILE, vertex_names=(HOSTILE, HOSTILE)
    )
    finding = Finding(HOSTILE, 1, HOSTILE, [HOSTILE], HOSTILE, None, world.to_json(), HOSTILE)
    report = tv.examine(one_edge, tv.World.from_id("m3/14"))
    one = report.judgements[0].__class__(HOSTILE, "failed", 0, 1, (finding,))
    spoilt = tv.Report(HOSTILE, HOSTILE, False, 0, {HOSTILE: "failed"}, (finding,), (one,))
    for page in (card(finding), card(spoilt.of(report.run)), card(spoilt)):
        tags = {tag for tag, _ in Elements(page).all}
        assert tags <= TAGS
        images = [attributes for tag, attributes in Elements(page).all if tag == "img"]
        assert all(one["src"] and one["src"].startswith("data:image/svg") for one in images)
        assert not any(
            key.startswith("on") for _, attributes in Elements(page).all for key in attributes
        )
        assert "\x1b" not in page
        assert "<img src=x onerror=alert(1)>" in unescape(page)


def test_the_same_report_gives_the_same_page() -> None:
    assert card(tv.examine(one_edge, WORLD)) == card(tv.examine(one_edge, WORLD))
