"""The plot: well-formed, a sign a mapper and family, hostile names as text."""

from __future__ import annotations

from xml.etree import ElementTree as ET

import pytest

from topo_verify.campaign.row import Judged, Row
from topo_verify.checkers import CLAIMS
from topo_verify.extra.arena.folder import plot_of, table_csv
from topo_verify.extra.arena.league import League
from topo_verify.extra.arena.plot import Axis
from topo_verify.extra.arena.suites import Suite, drawn, every
from topo_verify.programs.loader import Target
from topo_verify.report.blocks import PictureBlock, Text
from topo_verify.report.html import blocks_as_html
from topo_verify.report.markdown import markdown

SUITE = Suite("small", "a test", (every(1), drawn("lattice(3,3,holes=0.2)", 3)))
HOSTILE = "</text><script>alert(1)</script>"
HELD = tuple(Judged("ok", 3, 3) for _ in CLAIMS)


@pytest.fixture
def league() -> League:
    """Two mappers that pay 1.5 and 3 times LB, a little more where a world is larger."""
    league = League((Target(HOSTILE, print), Target("b,c", print)), (SUITE,), 0)
    for mapper, least in ((HOSTILE, 15), ("b,c", 30)):
        for place, world in enumerate(SUITE.worlds(0)):
            league.rows[mapper, world] = Row(
                mapper=mapper,
                world=world,
                place=place,
                edges=1 + place,
                least=10,
                cost=least + place,
                claims=HELD,
            )
    return league


def picture(league: League) -> str:
    entries = league.entries()
    return plot_of(league, SUITE, entries)


def test_it_has_a_sign_for_each_family_and_one_in_the_legend(league: League) -> None:
    root = ET.fromstring(picture(league))  # noqa: S314  made a moment ago
    assert len(root.findall(".//{*}polygon")) == 3  # the second mapper; the first has circles
    texts = [element.text for element in root.findall(".//{*}text")]
    names = {"2", "2: lattice(3,3,holes=0.2), 4 edges"}
    assert {"small: a test", "cost / LB", "b,c"} | names <= {*texts}
    assert any((text or "").startswith("</text>") for text in texts)
    (name,) = (text for text in root.findall(".//{*}text") if text.text == "b,c")
    assert float(name.get("x", "")) < 100, "on a phone it is seen without moving the plot"
    assert '[fill="#fdfcf9"],' in picture(league)  # the card of a dark page


@pytest.mark.parametrize(
    ("low", "high", "ticks"),
    [
        (1, 30, [1, 2, 5, 10, 20]),
        (1, 2.2, [1, 1.5, 2]),
        (1, 1.7, [1, 1.2, 1.4, 1.6]),
        (1.15, 1.4, [1.2, 1.3, 1.4]),
        (1.31, 1.39, []),
    ],
)
def test_a_short_axis_has_values_beside_it_as_well(
    low: float, high: float, ticks: list[float]
) -> None:
    assert Axis(low, high, 0, 100).ticks == ticks


def test_a_page_holds_it_and_letters_leave_it_out(league: League) -> None:
    block = PictureBlock(picture(league), 'the "plot"')
    (figure,) = blocks_as_html([block])
    assert figure.startswith('<figure class="chart"><img alt="the &quot;plot&quot;" src="data:')
    assert markdown([Text("a"), block, Text("b")]) == "a\n\nb\n"


def test_the_csv_quotes_names_and_has_a_row_a_family(league: League) -> None:
    lines = table_csv(league.entries()).splitlines()
    assert len(lines) == 1 + 2 * 3
    assert lines[4].startswith('2,"b,c",small,,5,')
