"""Walk it yourself, in a real browser: the reader is the robot, and is told what was luck."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.browser import Open
from tests.pictures.played import page_of
from topo_verify import World, explore, families
from topo_verify.robot.events import Augment, Event, Move

if TYPE_CHECKING:
    from playwright.sync_api import Page

WORLD = families.lattice(2, 4, holes=0.1, seed=2)


@pytest.fixture(scope="module")
def text() -> str:
    """The page of a small world."""
    return page_of(WORLD, "enhancement-ii")


def keys(page: Page, pressed: str) -> None:
    for key in pressed.split():
        page.keyboard.press(key)


def said(page: Page) -> str:
    return page.inner_text("#walk .says h3")


def follow(page: Page, events: tuple[Event, ...]) -> None:
    """Do what a mapper did: its doors, and its declarations."""
    for event in events:
        if isinstance(event, Move):
            page.click(f'#walk .door[data-key="{event.door}"]')
        elif isinstance(event, Augment) and event.kind == "new":
            page.keyboard.press("n")
        elif isinstance(event, Augment):
            page.click(f'#walk .badge[data-dart="{event.dart}"]')


@pytest.mark.long
def test_who_walks_as_a_sound_mapper_does_has_proved_the_map(show: Open, text: str) -> None:
    page = show(text, at="#walk")
    page.wait_for_timeout(200)  # the player writes its step after 120 ms, but not while one walks
    assert page.url.endswith("#walk")
    follow(page, explore(WORLD, "enhancement-ii").trace)
    assert said(page) == "Nothing on your map is unexplored"
    page.keyboard.press("Enter")
    assert said(page) == "Your walk proves this map"
    told = page.inner_text("#walk .says")
    assert "You made 16 moves. With the map in hand, a proof of this world takes 12" in told
    assert "enhancement-ii takes 16. The history proves the world." in told
    assert page.locator("#walk .says li").count() == len(WORLD.edges)
    for pane in (0, 1):
        assert page.locator("#walk .pane").nth(pane).locator(".road.followed").count() == 8
    assert (
        page.inner_text("#walk .pane:nth-child(2) small")
        == "no unexplored exit; drawn like the world"
    )
    drawings = page.locator("#walk .pane > svg").evaluate_all("all => all.map((o) => o.innerHTML)")
    assert drawings[0] == drawings[1]


@pytest.mark.nightly
def test_who_guesses_right_is_told_that_it_was_luck(show: Open, text: str) -> None:
    page = show(text, at="#walk")
    trace = explore(WORLD, "enhancement-ii").trace
    last = max(
        n for n, event in enumerate(trace) if isinstance(event, Move) and event.purpose == "cross"
    )
    unproved = (event for event in trace[last + 1 :] if isinstance(event, Augment))
    follow(page, (*trace[: last + 1], *unproved))  # the last road is closed without a walk
    page.keyboard.press("Enter")
    assert said(page) == "The map is right, but 1 of 8 decisions was luck"
    (luck,) = page.locator("#walk .says li.luck").all_inner_texts()
    assert luck.startswith("A road between places known: luck, for ")
    assert (
        "The history does not prove the world: the road marked orange may end elsewhere."
        in page.inner_text("#walk .says")
    )
    assert page.locator("#walk .road.luck").count() == 2
    page.keyboard.press("s")
    assert page.inner_text("#walk .pane h2 span") == "Another world"
    assert page.locator("#walk .pane").nth(0).locator(".vertex").count() > len(WORLD.vertices)
    walked = {event.edge for event in trace[: last + 1] if isinstance(event, Augment)}
    taken = page.locator("#walk .pane").nth(0).locator(".road:not(.far)")
    assert taken.count() >= len(walked)
    assert page.locator("#walk .pane").nth(0).locator(".road.far").count() > 0
    page.keyboard.press("s")
    assert page.inner_text("#walk .pane h2 span") == "The world"


@pytest.mark.long
def test_a_wrong_declaration_is_shown_where_it_is_wrong(show: Open, text: str) -> None:
    page = show(text, at="#walk")
    keys(page, "0 n 1 n 1 n 1 a 1")
    assert said(page) == "Your map contradicts what you see"
    told = page.inner_text("#walk .says p")
    keys(page, "0")
    assert page.inner_text("#walk .says p") == told  # what was seen then, and not what is seen now
    assert told.startswith("After move 5 you saw 3 exits, where your map shows ")
    keys(page, "Enter")
    assert said(page) == "A decision is wrong"
    assert page.locator("#walk .says li.wrong").inner_text() == (
        "A road between places known: wrong, the place behind it was new."
    )
    assert page.locator("#walk .pane").nth(0).locator(".road.wrong").count() == 1
    assert page.locator("#walk .pane").nth(1).locator('.road.wrong[data-darts="3 6"]').count() == 0
    assert page.locator("#walk .pane").nth(1).locator(".road.wrong").count() == 1


def test_where_a_wrong_road_ends_is_ringed_and_one_can_go_on_from_there(show: Open) -> None:
    page = show(page_of(World.from_id("m4/41"), "basic"), at="#walk")
    keys(page, "0 n 1 n 1 1 a 0 2 0 Enter")
    assert page.locator("#walk li.wrong").inner_text() == (
        "A road between places known: wrong, the road ends at the exit with the green ring."
    )
    ring = page.locator("#walk .pane").nth(1).locator(".ring.truth")
    (x, y) = (ring.get_attribute("cx"), ring.get_attribute("cy"))
    assert page.locator(f'#walk .stub circle[cx^="{str(x)[:6]}"][cy^="{str(y)[:6]}"]').count() == 1
    keys(page, "u")  # the wrong decision is taken back, the moves are kept
    assert said(page) == "A new road: where does it end?"
    assert page.inner_text("#walk .says .end") == "7 moves"
    assert page.locator("#walk .badge").count() == 3


@pytest.mark.long
def test_at_the_marker_only_an_exit_at_the_marker_is_offered(show: Open) -> None:
    page = show(page_of(World.from_id("m1/1"), "basic"), at="#walk")
    keys(page, "0")
    assert page.locator('#walk .says [data-key="n"]').is_disabled()
    words = (
        "You see the marker, so no place is new here: the road ends at the exit with the letter."
    )
    assert page.inner_text("#walk .says p").startswith(words)


@pytest.mark.long
def test_where_nothing_can_be_said_the_map_is_wrong_and_one_can_go_back(show: Open) -> None:
    page = show(page_of(World.from_id("m3/14"), "basic"), at="#walk")
    keys(page, "0 n 0 1 b")  # the wrong exit
    assert not said(page).startswith("Your map contradicts")
    keys(page, "2")  # a road to the marker's place, where no other exit is left
    assert said(page) == "Your map contradicts what you see"
    assert page.locator('#walk .says [data-key="n"]').is_disabled()
    assert page.locator("#walk .badge").count() == 0
    keys(page, "0 0")  # it stays until a decision is taken back
    assert page.inner_text("#walk .says p").startswith("The road (?) that you took next ends at")
    back = page.locator("#walk .says button.main")
    assert back.inner_text().startswith("Take back the last decision")
    back.click()
    assert page.locator("#walk .badge").count() == 2
    assert not said(page).startswith("Your map contradicts")


@pytest.mark.long
def test_it_may_be_said_at_once_and_taken_back(show: Open, text: str) -> None:
    page = show(text, at="#walk")
    page.check("#walk input[type=checkbox]")
    keys(page, "0 n 1 n 1 n 1 a")
    assert said(page) == "Your last decision is wrong"
    main = page.locator("#walk .says.bad button.main")
    assert main.inner_text().startswith("Take back the last decision")
    keys(page, "u n")
    assert "Your last decision is true, but not proved" in page.inner_text("#walk .says")
    keys(page, "u 1 0 n")
    assert "Your last decision is proved." in page.inner_text("#walk .says")
    assert page.inner_text("#walk .says .end") == "6 moves"


@pytest.mark.long
def test_the_reader_sees_percepts_only(show: Open, text: str) -> None:
    page = show(text, at="#walk")
    assert page.locator("#walk .vertex").count() == 2  # the place where one is, and S
    labels = page.locator("#walk .door").evaluate_all("all => all.map((one) => one.ariaLabel)")
    assert labels == ["Door 0, at which the marker points", "Door 1"]
    assert "Door 0 is the one at which the marker points" in page.inner_text("#walk .says")
    keys(page, "0 n")
    assert (
        page.locator("#walk .door").first.get_attribute("aria-label") == "Door 0, the way you came"
    )
    assert "Door 0 leads back" in page.inner_text("#walk .says")
    assert page.locator("main").evaluate("one => one.inert")
    select = page.locator("#walk select")
    width = select.evaluate("one => one.offsetWidth")
    assert select.evaluate("one => (one.style.maxWidth = 'none', one.offsetWidth)") == width


def test_the_first_world_is_one_that_the_reader_has_not_seen(show: Open, text: str) -> None:
    page = show(text)
    page.click("#walk-it")
    assert page.input_value("#walk select") == "random"
    assert said(page) == "Find out where every exit leads"
    page.keyboard.press("0")  # a loop at the marker: what is seen says which exit it ends at
    assert "Its arrow tells which: count from it. Say so:" in page.inner_text("#walk .says p")
    page = show(text, at="#step=3")
    for _ in range(2):  # the second time it is open already
        page.evaluate("location.hash = '#walk'")  # typed behind the address, it loads nothing
        page.wait_for_selector("#walk")
        page.evaluate("location.hash = ''")
    assert page.input_value("#walk select") == "page"
    page.keyboard.press("Escape")
    assert not page.locator("main").evaluate("one => one.inert")


def test_where_one_answer_is_left_the_game_does_not_advise_to_walk_on(show: Open) -> None:
    page = show(page_of(World.from_id("m1/0"), "basic"), at="#walk")
    keys(page, "0")
    assert "so it is a new place. Say so: press “It is a new place”." in page.inner_text(
        "#walk .says"
    )
    assert "Walk on" not in page.inner_text("#walk .says p")
    keys(page, "Enter")
    assert said(page) == "So far it is right, with 0 of 1 road on it"
    assert "The history proves the world." in page.inner_text("#walk .says")


@pytest.mark.parametrize("key", ["Escape", "?"])
def test_help_opens_in_the_game_and_a_key_closes_it_alone(show: Open, text: str, key: str) -> None:
    from playwright.sync_api import expect

    page = show(text, at="#walk")
    page.keyboard.press("?")
    assert "press its number" in page.inner_text("#help")
    page.keyboard.press(key)
    expect(page.locator("#help")).to_be_hidden()
    assert page.is_visible("#walk")


@pytest.mark.long
def test_no_key_reaches_the_player_and_escape_leads_back(show: Open, text: str) -> None:
    page = show(text, at="#step=3")
    page.click("#walk-it")
    assert page.evaluate("location.hash") == "#walk"  # a reload does not show the world
    keys(page, "0 n ArrowRight End")
    page.keyboard.press("Escape")
    assert page.locator("#walk").count() == 0
    assert page.evaluate("location.hash") == "#step=3"
    page.keyboard.press("ArrowRight")
    page.wait_for_url(lambda url: url.endswith("#step=4"))  # it is written a moment later
    page.click("#walk-it")  # the walk is where it was
    assert page.inner_text("#walk .says .end") == "1 move"


@pytest.mark.long
def test_a_world_is_built_corner_by_corner_and_walked(show: Open, text: str) -> None:
    page = show(text, at="#walk")
    page.select_option("#walk select", "own")
    keys(page, "1 n 1 1 2 4")  # a road to a new place, a loop, and a road between two corners
    assert page.inner_text("#walk .pane h2 small").startswith("2 places, 3 roads, genus")
    keys(page, "u u u")
    keys(page, "1 1 1 2")
    assert page.inner_text("#walk .pane h2 small") == "1 place, 2 roads, genus 1"
    keys(page, "Enter 0")
    assert page.locator("#walk .badge").count() == 3
    page.keyboard.press("Enter")
    assert page.inner_text("#walk .pane h2 small") == "1 place, 2 roads, genus 1"


@pytest.mark.nightly
def test_worlds_of_the_gallery_and_worlds_drawn_by_lot_can_be_walked(show: Open, text: str) -> None:
    page = show(text, at="#walk")
    names = page.locator("#walk option").all_inner_texts()
    assert names[:2] == ["that of this page", "one road (m1/0)"]
    drawings = [page.evaluate("recording.worlds[0].paths.length")]
    drawings += page.evaluate("recording.gallery.map(({ paths }) => paths.length)")
    for value in ["page", *map(str, range(len(names) - 3)), "random"]:
        page.select_option("#walk select", value)
        keys(page, "0 Enter")
        pane = page.locator("#walk .pane").nth(0)
        assert pane.locator(".vertex").count() > 0
        if value != "random":  # drawn by world/drawing, not by the small layout of the page
            assert pane.locator("svg > g > .road").count() >= drawings.pop(0)
    assert not drawings
    page.click("#walk button:has-text('another')")
    page.fill("#walk input[type=number]", "9")
    page.click("#walk h1")
    keys(page, "Enter")
    assert ", 9 roads, genus " in page.inner_text("#walk .pane h2 small")


@pytest.mark.long
def test_a_world_without_a_road_is_proved_by_looking(show: Open) -> None:
    page = show(page_of(World((), (), None), "basic"), at="#walk")
    keys(page, "Enter")
    assert said(page) == "Your walk proves this map"


@pytest.mark.long
@pytest.mark.parametrize(("width", "height"), [(360, 780), (1600, 900)])
def test_it_fits(show: Open, text: str, width: int, height: int) -> None:
    page = show(text, at="#walk", width=width, height=height)
    keys(page, "0 n 1 n 1")
    page.wait_for_timeout(50)
    inside = page.evaluate("document.querySelector('#walk').scrollWidth <= innerWidth")
    assert inside
    for k in (0, 1):
        pane = page.locator("#walk .pane").nth(k).bounding_box()
        svg = page.locator("#walk .pane > svg").nth(k).bounding_box()
        assert pane is not None
        assert svg is not None
        assert svg["height"] > 60
        assert svg["y"] + svg["height"] <= pane["y"] + pane["height"] + 1
    for name in ("n", "u", "↵"):
        box = page.locator(f'#walk .says [data-key="{name}"]').bounding_box()
        assert box is not None
        assert box["y"] + box["height"] <= height


def test_on_a_phone_the_verdict_begins_with_its_headline(show: Open) -> None:
    page = show(page_of(families.path(14), "basic"), at="#walk", width=360, height=740)
    keys(page, "0 n" + " 1 n" * 12 + " Enter")
    assert page.evaluate("document.querySelector('#walk .says').scrollTop") == 0
