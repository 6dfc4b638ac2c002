"""The badge: a picture that says the verdict and how much was checked, and never more."""

from __future__ import annotations

from dataclasses import replace
from xml.etree import ElementTree as ET

import pytest

from tests.report.accounts import HOSTILE, account
from topo_verify.checkers.findings import Verdict
from topo_verify.report.account import Account, JudgedExtent
from topo_verify.report.badge import badge
from topo_verify.report.blocks import OF_TONE, PALETTE, TONES, VERDICTS

SVG = "{http://www.w3.org/2000/svg}"


def _badge(made: Account) -> ET.Element:
    return ET.fromstring(badge(made))  # noqa: S314  written by us a moment ago


@pytest.mark.parametrize("verdict", VERDICTS)
def test_it_has_the_verdict_s_letter_and_colour_and_the_numbers(verdict: Verdict) -> None:
    words = "8,954 of 8,954 worlds"
    picture = _badge(replace(account(), extent=JudgedExtent(verdict, words)))
    assert [one.text for one in picture.iter(f"{SVG}text")] == ["topo-verify", verdict[0], words]
    colours = [one.get("fill") for one in picture.iter(f"{SVG}rect")]
    assert PALETTE[OF_TONE[TONES[verdict]]].light in colours
    assert picture.get("aria-label") == f"topo-verify, a text: {verdict}, {words}"


def test_hostile_text_stays_text() -> None:
    made = replace(account(HOSTILE), extent=JudgedExtent("REFUTED", HOSTILE * 3))
    picture = _badge(made)
    tags = {one.tag.removeprefix(SVG) for one in picture.iter()}
    assert tags == {"svg", "title", "clipPath", "rect", "g", "text"}
    assert float(picture.get("width") or 0) < 700


def test_a_badge_is_as_wide_as_its_words() -> None:
    widths = [
        float(_badge(replace(account(), extent=JudgedExtent("SAMPLED", words))).get("width") or 0)
        for words in ("1 of 1 world", "8,954 of 8,954 worlds", "8,954 of 8,954 worlds, 361 sampled")
    ]
    assert widths == sorted(set(widths))
