"""The page of a report: one file, strict policy, the same bytes, and text that stays text."""

from __future__ import annotations

import base64
import hashlib
import re
from dataclasses import replace

import pytest

from tests.browser import Open
from tests.html_parts import Parts
from tests.report.accounts import HOSTILE, LONG_ID, RUN, account
from topo_verify.report.account import Exhibit
from topo_verify.report.page import report_page
from topo_verify.world import families


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def test_the_policy_allows_nothing_but_the_page_s_own_parts_and_the_player_s() -> None:
    page = Parts(report_page(account(), RUN))
    policy = next(a["content"] for _, a in page.tags if a.get("http-equiv"))
    assert policy is not None
    rules = dict(rule.split(None, 1) for rule in policy.split("; "))
    assert rules.pop("img-src") == "data:"
    styles, scripts = rules.pop("style-src").split(), rules.pop("script-src").split()
    assert set(rules.values()) == {"'none'"}
    assert rules.keys() == {"default-src", "base-uri", "form-action"}
    assert (len(styles), len(scripts)) == (2, 2)
    assert styles[0] == _hash(page.texts["style"][0])
    assert scripts[0] == _hash(page.texts["script"][-1])


def test_a_page_without_a_player_has_no_script() -> None:
    page = Parts(report_page(account(exhibit=False), RUN))
    assert "".join(page.texts["script"]) == ""
    assert not [tag for tag, _ in page.tags if tag in ("iframe", "details")]


def test_the_page_asks_for_no_other_file() -> None:
    text = report_page(account(), RUN)
    sources = [a.get("src") or "" for _, a in Parts(text).tags if "src" in a]
    assert sources
    assert all(source.startswith("data:image/svg+xml;base64,") for source in sources)
    assert not re.search(r"@import|url\(", text)
    assert not re.search(r"(?:href|src)=\"(?:https?:)?//", text)


def test_only_what_stands_under_timing_differs() -> None:
    other = replace(RUN, timing={"memory": {"basic": 5}})
    one, two = (report_page(account(), run) for run in (RUN, other))
    assert one != two
    cut = re.compile(r'<section id="timing">.*?</section>', re.DOTALL)
    assert cut.sub("", one) == cut.sub("", two)
    assert report_page(account(), RUN) == one


@pytest.mark.parametrize("text", [HOSTILE, "<b>", "a\nb"])
def test_no_text_becomes_a_tag_or_an_attribute(text: str) -> None:
    page, plain = (report_page(account(one), RUN) for one in (text, "x"))
    said = [
        # A long text is set in another class; nothing else may depend on a text.
        [(tag, sorted(attributes.keys() - {"class"})) for tag, attributes in Parts(one).tags]
        for one in (page, plain)
    ]
    assert said[0] == said[1]
    assert not [c for c in page if c != "\n" and not c.isprintable()]


def test_ids_are_short_where_they_are_read_and_whole_where_they_are_copied() -> None:
    page = report_page(account(LONG_ID, exhibit=False), RUN)
    codes = re.findall(r"<code class=\"copy\">(.*?)</code>", page)
    assert [code for code in codes if LONG_ID in code] == [f"topo-verify replay {LONG_ID}"] * 2
    rest = re.sub(r"<code class=\"copy\">.*?</code>|<pre>.*?</pre>", "", page, flags=re.DOTALL)
    assert LONG_ID not in rest
    assert "m30/12345…90321" in rest


def test_a_mapper_in_a_table_leads_to_its_run() -> None:
    page = Parts(report_page(account("./mapper"), RUN))
    (link,) = (a["href"] for tag, a in page.tags if tag == "a" and a["href"] == "#world-1")
    assert [tag for tag, a in page.tags if f"#{a.get('id')}" == link] == ["article"]
    assert "#world-1" not in report_page(account("./mapper", exhibit=False), RUN)


def test_it_says_how_much_was_judged_and_what_was_not() -> None:
    page = report_page(account(exhibit=False), replace(RUN, finished=False))
    assert "REFUTED: 1 of 3 worlds fail" in page
    assert '<td class="failed">failed</td><td class="number">3 of 3</td>' in page
    assert '<td class="open">? UNKNOWN</td>' in page
    assert '<td>not-declared</td><td class="number">0 of 3</td>' in page
    assert "Not complete: interrupted: the rest was not judged." in page
    assert "interrupted" not in report_page(account(exhibit=False), RUN)


def test_a_large_world_is_named_and_not_drawn() -> None:
    large = Exhibit("large", families.lattice(20, 20), "large", ())
    page = report_page(replace(account(), exhibits=(large,)), RUN)
    assert "large: 400 vertices, 760 edges, genus 0; too large to be drawn here." in page
    assert "<img" not in page


@pytest.mark.long
@pytest.mark.parametrize("width", [360, 1600])
def test_a_player_opens_at_a_click_and_is_shown_whole(show: Open, width: int) -> None:
    page = show(report_page(account(HOSTILE), RUN), width=width)
    assert page.locator("iframe").count() == 0
    page.click("details.play summary")
    frame = page.frame_locator("iframe")
    assert "alert(1)" in frame.locator("#title").inner_text()
    frame.locator("#on").click()
    assert frame.locator(".layers").first.evaluate("e => e.clientWidth") > 0
    assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
    assert page.locator("iframe").get_attribute("sandbox") == "allow-scripts"


@pytest.mark.long
def test_a_page_can_be_read_in_the_dark(show: Open) -> None:
    text = report_page(account(), RUN)
    light, dark = (
        show(text, color_scheme=scheme).evaluate("getComputedStyle(document.body).backgroundColor")
        for scheme in ("light", "dark")
    )
    assert (light, dark) == ("rgb(241, 240, 236)", "rgb(12, 15, 18)")
