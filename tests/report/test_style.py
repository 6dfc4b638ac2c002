"""One style: the palette of the report is that of the player, and no statement rests on colour."""

from __future__ import annotations

import re

from topo_verify.player.page import part
from topo_verify.report.style import OF_TONE, ON_TERMINAL, PALETTE, TONES, VERDICTS


def test_the_palette_is_that_of_the_player() -> None:
    light, dark = re.findall(r":root\{(.*?)\}", part("page.css"))[:2]
    for place, rules in enumerate((light, dark)):
        theirs = dict(re.findall(r"--([a-z]+):\s*(#[0-9a-f]{6})", rules))
        assert theirs == {name: colour[place] for name, colour in PALETTE.items()}


def test_the_verdicts_begin_with_different_letters() -> None:
    assert len({verdict[0] for verdict in VERDICTS}) == len(VERDICTS)


def test_every_tone_has_a_colour_everywhere() -> None:
    assert set(TONES.values()) == OF_TONE.keys() == ON_TERMINAL.keys()
    assert set(OF_TONE.values()) <= PALETTE.keys()


def _luminance(colour: str) -> float:
    channels = (int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5))
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def test_every_tone_can_be_read_on_a_card() -> None:
    for name in (*OF_TONE.values(), "ink", "soft"):
        for ours, card in zip(PALETTE[name], PALETTE["card"], strict=True):
            low, high = sorted((_luminance(ours), _luminance(card)))
            assert (high + 0.05) / (low + 0.05) >= 4.5, name
