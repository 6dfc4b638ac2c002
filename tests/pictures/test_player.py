"""The player in a real browser: each control does what it says, on screens of any size."""

from __future__ import annotations

import html
import re
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from tests.browser import Open
from tests.pictures.played import page_of, played
from topo_verify import World, families
from topo_verify.campaign.run import explore
from topo_verify.checkers import Finding, Judgement
from topo_verify.faults import FAULTS
from topo_verify.pictures.fold_places import fold_places
from topo_verify.pictures.page import player_page
from topo_verify.pictures.scenes import Playback
from topo_verify.robot.events import Robot

if TYPE_CHECKING:
    from playwright.sync_api import Page


@pytest.fixture(scope="module")
def lattice() -> str:
    """A run without findings."""
    return page_of(families.lattice(3, 4), "enhancement-ii")


@pytest.fixture(scope="module")
def lucky() -> str:
    """A run that is right by luck: only its witness shows what is wrong."""
    return page_of(World.from_id("m2/1"), FAULTS["confirms-what-is-alone"].mapper)


@pytest.fixture(scope="module")
def wrong() -> str:
    """A run with findings in this very world."""
    return page_of(World.from_id("m3/8"), FAULTS["restores-with-the-wrong-sign"].mapper)


@pytest.fixture(scope="module")
def two() -> str:
    """Two mappers side by side."""
    return page_of(families.lattice(3, 4), "basic", "folding")


def step(page: Page) -> int:
    """The step that is shown; the address must say it, too."""
    from playwright.sync_api import expect

    shown = int(page.input_value("#slider"))
    expect(page).to_have_url(re.compile(f"#step={shown}$"))
    return shown


def shows(page: Page, part: str = "#slider") -> Any:
    """What can be awaited of a part; the page's policy forbids to await an expression."""
    from playwright.sync_api import expect

    return expect(page.locator(part))


def title(page: Page) -> str:
    """The bold sentence."""
    return page.inner_text(".say h3")


@pytest.mark.long
def test_a_run_without_findings_opens_at_its_first_question(show: Open, lattice: str) -> None:
    page = show(lattice)
    assert step(page) > 0
    assert title(page) == "Was it here before?"
    assert page.locator(".badge").count() > 0
    assert not page.is_visible("#finding")
    page.keyboard.press("Home")
    assert step(page) == 0
    assert title(page) == "The robot wakes up beside the marker"


@pytest.mark.long
def test_a_run_without_a_question_opens_at_its_first_decision_if_it_has_one(show: Open) -> None:
    page = show(page_of(World.from_id("m1/0"), "basic"))
    assert step(page) > 0
    assert step(show(page_of(World((), (), None), "basic"))) in (0, 1)


def test_where_the_only_guesses_come_after_the_last_move_it_opens_early(show: Open) -> None:
    page = show(page_of(World.from_id("m3/13"), "enhancement-ii"))
    assert " ".join(page.inner_text("#key").split()) == "new 1 moves 1 of 3 least 3 step 2 of 11"


def test_a_walk_in_circles_opens_at_the_end_of_its_first_round(show: Open) -> None:
    def circles(robot: Robot) -> None:
        while True:
            robot.move(1 % robot.percept.degree)

    page = show(page_of(World.from_id("m4/41"), circles))
    assert step(page) == 4
    assert page.inner_text(".say .wrong").startswith("map-isomorphic: no map was delivered")
    remark = "events 1 to 4 repeat to the end of the run, 31 times in all"
    assert page.inner_text(".say .remark") == remark
    assert page.inner_text("#key").count("moves") == 1


@pytest.mark.long
@pytest.mark.parametrize(("width", "height"), [(1366, 768), (1280, 800), (1600, 900), (720, 691)])
def test_no_caption_is_cut(show: Open, wrong: str, two: str, width: int, height: int) -> None:
    for text in (wrong, two):
        page = show(text, width=width, height=height)
        cut = page.evaluate("""() => [...Array(+byId('slider').max + 1).keys()].filter((step) => {
            byId('slider').value = step;
            byId('slider').dispatchEvent(new Event('input'));
            const said = [...document.querySelectorAll('.said')];
            return said.some((one) => one.scrollHeight > one.clientHeight);
        })""")
        assert not cut


def test_a_small_world_fills_its_pane(show: Open) -> None:
    page = show(page_of(World.from_id("m4/41"), "basic"), width=1366, height=768)
    shares = page.evaluate("""() => {
        const pane = document.querySelector('.layers.world').getBoundingClientRect();
        const all = [...document.querySelectorAll('.world .road, .world .vertex')];
        const boxes = all.map((one) => one.getBoundingClientRect());
        const size = (from, to) => Math.max(...boxes.map((box) => box[to]))
            - Math.min(...boxes.map((box) => box[from]));
        return [size('left', 'right') / pane.width, size('top', 'bottom') / pane.height];
    }""")
    assert 0.6 < max(shares) <= 1


@pytest.mark.long
def test_the_address_says_which_step(show: Open, lattice: str) -> None:
    page = show(lattice, at="#step=21")
    assert step(page) == 21
    page.evaluate("location.hash = '#step=5'")
    shows(page).to_have_value("5")
    assert title(show(lattice, at="#step=999999")) == "The map is complete"


@pytest.mark.long
def test_buttons_and_keys_step_either_way(show: Open, lattice: str) -> None:
    page = show(lattice, at="#step=0")
    for _ in range(3):
        page.click("#on")
    page.click("#back")
    assert step(page) == 2
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowLeft")
    assert step(page) == 3
    page.keyboard.press("End")
    assert page.inner_text("#key").endswith("113 of 113")
    page.keyboard.press("Home")
    assert step(page) == 0


@pytest.mark.nightly
def test_decisions_are_found_from_either_side(show: Open, lattice: str) -> None:
    page = show(lattice, at="#step=16")
    page.click("#after")
    after = step(page)
    page.keyboard.press("n")
    assert step(page) > after > 16
    page.keyboard.press("p")
    assert step(page) == after
    page.click("#before")
    assert step(page) < after


@pytest.mark.long
def test_play_pauses_on_demand_and_runs_to_the_end(show: Open, lattice: str) -> None:
    page = show(lattice, at="#step=3")
    page.keyboard.press("Space")
    assert page.inner_text("#play") == "Pause"
    page.click("#play")
    assert page.inner_text("#play") == "Play"
    assert step(page) >= 3
    page.fill("#slider", "108")
    page.select_option("#speed", "max")
    page.click("#play")
    shows(page).to_have_value("113")
    shows(page, "#play").to_have_text("Play")
    assert title(page) == "The map is complete"


@pytest.mark.long
def test_slider_and_chart_lead_to_a_step(show: Open, lattice: str) -> None:
    page = show(lattice)
    page.fill("#slider", "40")
    assert step(page) == 40
    box = page.locator("#chart svg").bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    assert abs(step(page) - 56) <= 1


@pytest.mark.long
def test_a_run_with_findings_opens_at_the_first_and_goes_on_to_the_next(
    show: Open, wrong: str
) -> None:
    page = show(wrong)
    first = step(page)
    assert title(page) == "Guess 2 is wrong, it says"
    assert "true-hypothesis-kept" in page.inner_text(".say .wrong")
    assert page.locator(".world .ring").count() >= 1
    assert page.locator(".map .ring.would").count() == 1  # "the dashed ring" of the sentence
    assert page.inner_text(".compared b") == "≠"
    page.keyboard.press("f")
    assert step(page) > first
    page.keyboard.press("F")
    assert step(page) == first
    page.locator(".findings button").last.click()
    assert step(page) == int(page.get_attribute("#slider", "max") or 0)
    page.click("#finding")
    assert step(page) == first


@pytest.mark.long
@pytest.mark.parametrize("fault", ["mirrors-the-direction", "ignores-direction-behind-e"])
def test_the_page_of_a_wrong_confirmation_says_what_speaks_against_it(
    show: Open, fault: str
) -> None:
    page = show(page_of(World.from_id("m2/5"), FAULTS[fault].mapper))
    assert title(page) == "Guess 1 is right, it says"
    assert "no-false-confirm" in page.inner_text(".say .wrong")
    assert "as it should" not in page.inner_text(".say")
    assert "the marker would have to point another way" in page.inner_text(".say p")
    assert "at v0:1 the robot would see (3, marker 2)" in page.inner_text(".say .wrong")
    assert page.inner_text(".compared b") == "≠"


@pytest.mark.long
def test_luck_is_shown_beside_the_witness(show: Open, lucky: str) -> None:
    page = show(lucky)
    assert page.input_value("#view") == "witness"
    assert page.locator("main h2 >> nth=1").inner_text().startswith("A witness")
    assert page.locator(".witness .ring.part").count() == 2, "one vertex here is two there"
    assert page.locator(".world .ring.part").count() == 1
    page.select_option("#view", "map")
    assert page.locator(".map").count() == 1


@pytest.mark.long
def test_two_mappers_go_in_step_by_cost_or_by_edge(show: Open, two: str) -> None:
    page = show(two, at="#step=10")
    assert page.locator("main h2 span").all_inner_texts() == ["basic", "folding"]
    assert "basic 10 of" in page.inner_text("#key")
    assert "folding 10 of" in page.inner_text("#key")
    for purpose in ("walking", "new", "testing", "back"):
        assert re.search(rf"{purpose}\s+\d+ : \d+", page.inner_text("#key"))
    page.select_option("#clock", "edge")
    page.fill("#slider", "9")
    costs = page.evaluate(
        "Array.from(document.querySelectorAll('#key b'), (b) => parseInt(b.textContent)).slice(4)"
    )
    assert costs[0] != costs[1]
    assert page.locator(".map").count() == 2  # the sentences tell of badges and rings on it
    assert page.locator(".map .stub:not(.off)").count() > 0
    page.select_option("#view", "world")
    assert page.locator(".world").count() == 2
    page.select_option("#second", "")
    assert page.locator(".world").count() == 1
    assert page.locator(".map").count() == 1


@pytest.mark.long
def test_what_the_robot_does_not_know_is_faint_or_hidden(show: Open, lattice: str) -> None:
    page = show(lattice, at="#step=0")
    assert page.locator(".world .vertex.far").count() == 11
    page.keyboard.press("k")
    assert page.locator(".world .vertex:visible").count() == 1
    page.keyboard.press("End")
    assert page.locator(".world .vertex:visible").count() == 12


def test_a_cut_surface_has_sides_and_its_map_once_an_edge_leaves_by_one(show: Open) -> None:
    page = show(page_of(World.from_id("m2/8"), "basic"), at="#step=0")
    assert page.locator(".world .sides path").count() == 4
    assert page.locator(".map .sides.off").count() == 1
    page.keyboard.press("End")
    assert page.locator(".map .sides.off").count() == 0
    page = show(page_of(World.from_id("m4/629"), "basic"))
    letters = page.locator(".world .sides text").all_text_contents()
    assert sorted(letters) == sorted("abcdabcd")


@pytest.mark.long
def test_both_panes_pan_and_zoom_together(show: Open, lattice: str) -> None:
    def boxes() -> list[Any]:
        boxes: list[Any] = page.eval_on_selector_all(
            "main svg:last-child", "all => all.map((svg) => svg.getAttribute('viewBox'))"
        )
        return boxes

    page = show(lattice)
    whole = boxes()
    page.keyboard.press("+")
    near = boxes()
    assert near[0] == near[1] != whole[0]
    page.mouse.move(300, 300)
    page.mouse.down()
    page.mouse.move(350, 320)
    page.mouse.up()
    assert boxes()[0] == boxes()[1] != near[0]
    page.mouse.wheel(0, -300)
    page.keyboard.press("0")
    assert boxes() == whole
    page.locator(".zoomers button").first.click()
    assert boxes()[0] == near[0]


SIZES = ((1400, 900), (390, 800), (360, 740), (1600, 1000), (3840, 2160))


@pytest.mark.long
@pytest.mark.parametrize("name", ["lattice", "wrong", "two"])
def test_nothing_has_to_be_scrolled(show: Open, name: str, request: pytest.FixtureRequest) -> None:
    page = show(request.getfixturevalue(name))
    for width, height in (*SIZES, (720, 736), (720, 691)):
        page.set_viewport_size({"width": width, "height": height})
        # In one go: the panes are made anew shortly after the size has changed.
        root, *panes = page.evaluate(
            "[...document.querySelectorAll('html, main .layers')]"
            ".map((one) => [one.scrollWidth, one.scrollHeight])"
        )
        assert root == [width, height]
        assert min(height for _, height in panes) > 100


def test_three_findings_can_be_read_whole_on_a_phone(show: Open) -> None:
    def walks_nowhere(_robot: object) -> object:
        return {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}

    page = show(page_of(World.from_id("m4/41"), walks_nowhere), width=360, height=740)
    assert page.locator(".say .wrong li:not(.remark)").count() == 3
    assert page.eval_on_selector(".said", "one => one.scrollHeight <= one.clientHeight")
    assert page.evaluate("document.documentElement.scrollHeight") == 740


@pytest.mark.long
def test_every_control_has_a_name_and_a_place_in_the_order_of_focus(show: Open, wrong: str) -> None:
    page = show(wrong)
    names = page.eval_on_selector_all(
        "button, select, input",
        """all => all.filter((one) => one.checkVisibility()).map((one) =>
            one.getAttribute('aria-label') || one.textContent.trim()
                || one.closest('label').textContent.trim())""",
    )
    assert all(names)
    page.focus("#before")
    order: list[str] = []
    for _ in range(6):
        order.append(page.evaluate("document.activeElement.id"))
        page.keyboard.press("Tab")
    assert order == ["before", "back", "play", "on", "after", "finding"]
    assert page.get_attribute("#says", "aria-live") == "polite"
    assert "Step" in (page.get_attribute("#slider", "aria-valuetext") or "")


@pytest.mark.long
def test_help_names_the_signs_and_closes(show: Open, lattice: str) -> None:
    page = show(lattice)
    page.keyboard.press("?")
    assert page.is_visible("#help")
    parts = ["Keys", "Walk it yourself", "What the signs mean"]
    assert page.locator("#help h2").all_inner_texts() == parts
    from playwright.sync_api import expect

    for key in ("Escape", "?"):
        page.keyboard.press(key)
        expect(page.locator("#help")).to_be_hidden()  # the browser closes it when it can
        # A closed dialog keeps the focus until the next frame, and a key may come before.
        page.dispatch_event("#help button", "keydown", {"key": "?", "bubbles": True})
        expect(page.locator("#help")).to_be_visible()


def test_hostile_names_are_shown_as_text(show: Open) -> None:
    name = "</script><img src=x onerror=alert(1)>\"'\x1b[31m"
    world = families.lattice(2, 2)
    world = replace(world, vertex_names=(name,) * len(world.vertices))
    finding = Finding("map-isomorphic", 2, None, None, name)
    judgements = [Judgement("map-isomorphic", "failed", 1, 1, (finding,))]
    run = replace(played(world, "basic", name=name), judgements=judgements)
    page = show(player_page(world, [run, run], name=name))
    shown = name.replace("\x1b", "\\x1b")
    assert page.inner_text("#title") == f"{shown} beside {shown} in {shown}"
    assert page.inner_text(".say >> nth=1 >> .wrong li") == f"map-isomorphic: {shown}"
    page.select_option("#view", "world")
    assert page.locator(".world .vertex title").first.text_content() == shown
    assert page.locator("img").count() == 0


@pytest.mark.long
def test_a_rejection_by_folding_rings_the_two_places_that_would_be_one(show: Open) -> None:
    run = played(families.dodecahedron(), "folding")
    (event, *_) = fold_places(Playback(families.dodecahedron(), run.trace).moments).clashes
    page = show(player_page(families.dodecahedron(), [run]), at=f"#step={event}")
    assert page.locator(".world .ring").count() == 2
    assert page.inner_text(".compared b") == "≠"
    assert page.locator("figcaption").all_inner_texts() == ["one place", "the other"]


@pytest.mark.long
def test_in_a_frame_that_is_hidden_at_first_it_waits_for_its_room(show: Open) -> None:
    world = families.lattice(2, 2)
    inside = html.escape(player_page(world, [played(world, "basic")]))
    frame = f'<iframe style="display: none" width="900" height="700" srcdoc="{inside}"></iframe>'
    page = show(frame)
    page.wait_for_timeout(200)
    page.eval_on_selector("iframe", "frame => frame.style.display = 'block'")
    layers = page.frame_locator("iframe").locator(".layers").first
    layers.locator("svg").first.wait_for()
    assert 0 < layers.evaluate("e => parseFloat(e.style.getPropertyValue('--u'))") < 5


@pytest.mark.long
@pytest.mark.parametrize(("is_light", "system"), [("true", "dark"), ("false", "light")])
def test_a_notebook_s_frame_plays_on_its_own_in_the_notebook_s_theme(
    show: Open, is_light: str, system: str
) -> None:
    run = explore(families.lattice(2, 2), "basic")
    frame = run._repr_html_()  # pyright: ignore[reportPrivateUsage]
    theme = f'<body data-jp-theme-light="{is_light}">'
    page = show(f"<!doctype html><title>notebook</title>{theme}{frame}", color_scheme=system)
    inside = page.frame_locator("iframe")
    ground = inside.locator("body").evaluate("body => getComputedStyle(body).backgroundColor")
    assert ground == ("rgb(241, 240, 236)" if is_light == "true" else "rgb(12, 15, 18)")
    inside.locator("#on").click()
    inside.locator("#after").click()
    assert int(inside.locator("#slider").input_value()) > 1


def test_numbers_badges_and_the_question_of_neighbouring_exits_keep_apart(show: Open) -> None:
    page = show(page_of(World.from_id("m5/136"), "basic"), at="#step=26", width=1366, height=768)
    page.check("#darts")
    numbers, signs = page.evaluate("""() => {
        const centre = (part) => {
            const { x, y, width, height } = part.getBoundingClientRect();
            return [x + width / 2, y + height / 2];
        };
        return ['.map .names .dart', '.map .unknown, .map .badge'].map((parts) => {
            const all = [...document.querySelectorAll(parts)].map(centre);
            const gaps = all.flatMap(([x, y], k) => all.slice(k + 1).map(([u, v]) =>
                Math.hypot(x - u, y - v)));
            return Math.min(...gaps);
        });
    }""")
    assert numbers > 12
    assert signs > 28


@pytest.mark.long
def test_a_wrong_confirmation_is_drawn_as_wrong(show: Open, wrong: str) -> None:
    page = show(wrong, at="#step=54")
    assert title(page) == "Guess 1 is right, it says"
    assert page.locator(".ghost.bad, .badge.hot").count() == 2
    assert not page.locator(".badge.kept").count()


def test_two_runs_in_a_large_world_open_on_the_world(show: Open) -> None:
    page = show(page_of(families.lattice(6, 6), "basic", "folding"))
    assert page.input_value("#view") == "world"
