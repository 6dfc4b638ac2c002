"""The animated SVG of a run: what it shows at every moment is so, in the world and on S."""

from __future__ import annotations

import itertools
import re
from dataclasses import replace
from functools import cache
from math import dist
from textwrap import wrap
from xml.etree import ElementTree as ET

import pytest

from tests.faults.every import EVERY
from tests.helpers import some
from tests.pictures.played import playback_of
from tests.pictures.test_narrator import WORLDS
from topo_verify import CATALOGUE, World, explore, families
from topo_verify.checkers import check
from topo_verify.errors import InputError
from topo_verify.extra.films.film import BESIDE, COLUMNS, MOST_EVENTS, animated_svg, times
from topo_verify.pictures.drawing import Layout, lay_out
from topo_verify.pictures.narrator import Narrator
from topo_verify.pictures.scenes import Moment, Playback
from topo_verify.programs.loader import Mapper
from topo_verify.robot import events as ev
from topo_verify.robot.simulator import percepts

WORLD = families.lattice(2, 4, holes=0.1, seed=2)
KEY = re.compile(r"([\d.]+)%\{(.*?)\}")
SVG = "{http://www.w3.org/2000/svg}"


class Film:
    """An animated SVG, read back: what is shown, and where, at a time."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.root = ET.fromstring(text)  # noqa: S314  it is our own
        self.seconds = float(re.findall(r"animation:([\d.]+)s", text)[0])
        rules = re.findall(r"@keyframes (k\d+)\{(.*?\})\}", text)
        self.keys = {name: [(float(p), v) for p, v in KEY.findall(body)] for name, body in rules}

    def keys_of(self, element: ET.Element) -> list[tuple[float, str]]:
        names = element.get("class", "").split()
        return [key for name in names for key in self.keys.get(name, [])]

    def is_shown(self, element: ET.Element, at: float) -> bool:
        now = [v for p, v in self.keys_of(element) if p <= 100 * at / self.seconds]
        return not now or now[-1] == "opacity:1"

    def place(self, element: ET.Element, at: float) -> tuple[float, float]:
        """Where a moving element is; between two keyframes it goes in a straight line."""
        percent = 100 * at / self.seconds
        places = [
            (p, *map(float, re.findall(r"(-?[\d.]+)px", v))) for p, v in self.keys_of(element)
        ]
        before = [one for one in places if one[0] <= percent][-1]
        after = next((one for one in places if one[0] > percent), before)
        share = (percent - before[0]) / ((after[0] - before[0]) or 1)
        return (
            before[1] + share * (after[1] - before[1]),
            before[2] + share * (after[2] - before[2]),
        )

    def groups(self, kind: str) -> list[tuple[ET.Element, ET.Element]]:
        """The elements of a class, each with the group that shows, hides or moves it."""
        return [
            (group, element)
            for group in self.root.iter(f"{SVG}g")
            for element in group
            if element.get("class") == kind
        ]

    def parent_of(self, kind: str) -> ET.Element:
        """The group of the only element of a class."""
        ((group, _),) = self.groups(kind)
        return group

    def words(self, at: float) -> str:
        shown = (group for group in self.root.iter(f"{SVG}g") if self.is_shown(group, at))
        bold = (text for group in shown for text in group.findall(f"{SVG}text[@font-weight]"))
        return " ".join(text.text or "" for text in bold)


@cache
def played(mapper: str = "enhancement-ii") -> tuple[Playback, Layout, Film]:
    by: Mapper | str = EVERY.get(mapper, mapper)
    run = explore(WORLD, by)
    playback = Playback(WORLD, run.trace, check(WORLD, run.trace, run.stopped), run.stopped)
    layout = lay_out(WORLD)
    return playback, layout, Film(animated_svg(playback, name=mapper))


def frames(playback: Playback) -> list[tuple[Moment, float]]:
    """Each moment, and a time shortly before its end."""
    return [(m, end - 0.03) for m, end in zip(playback.moments, times(playback)[1:], strict=True)]


def solid(film: Film, kind: str, at: float) -> set[int]:
    """The numbers of the vertices or edges that are shown solid."""
    return {k for k, (group, _) in enumerate(film.groups(kind)) if film.is_shown(group, at)}


def test_the_robot_stands_at_its_vertex_at_the_end_of_every_moment() -> None:
    playback, layout, film = played()
    group = film.parent_of("robot")
    for moment, at in frames(playback):
        centre = layout.centres[WORLD.vertex_of[some(moment.position)]]
        assert dist(film.place(group, at), centre) < 0.05


@pytest.mark.nightly
def test_on_a_torus_the_robot_leaves_on_one_side_and_comes_back_on_the_other() -> None:
    world = families.torus(3, 3)
    playback = Playback(world, explore(world, "folding").trace)
    layout, film = lay_out(world), Film(animated_svg(playback))
    assert layout.kind == "cell"
    group = film.parent_of("robot")
    for moment, at in frames(playback):
        centre = layout.centres[world.vertex_of[some(moment.position)]]
        assert dist(film.place(group, at), centre) < 0.05
    places = [film.place(group, film.seconds * p / 100) for p, _ in film.keys_of(group)]
    times_ = [p for p, _ in film.keys_of(group)]
    leaps = [
        times_[k + 1] - times_[k]
        for k, (a, b) in enumerate(itertools.pairwise(places))
        if dist(a, b) > 0.6 * layout.width
    ]
    assert leaps
    assert max(leaps) < 0.05  # per cent of the whole: it is not seen to cross the picture


def test_solid_is_just_what_s_has() -> None:
    playback, _, film = played()
    drawn, edges = playback.map, {d: k for k, edge in enumerate(WORLD.edges) for d in edge}
    for moment, at in frames(playback):
        known = [d for d in drawn.phi if drawn.born[d] <= moment.number]
        explored = [d for d in drawn.phi if drawn.joined[d] <= moment.number]
        assert solid(film, "place", at) == {WORLD.vertex_of[drawn.phi[d]] for d in known}
        assert solid(film, "road", at) == {edges[drawn.phi[d]] for d in explored}


def test_rings_are_where_the_evidence_was_seen_and_where_it_was_expected() -> None:
    playback, layout, film = played()
    rejections = 0
    for moment, at in frames(playback):
        shown = [
            (float(ring.get("cx", "")), float(ring.get("cy", "")))
            for group, ring in film.groups("ring")
            if film.is_shown(group, at)
        ]
        if not isinstance(moment.event, ev.Reject):
            assert shown == []
            continue
        rejections += 1
        evidence = moment.event.evidence
        assert evidence.expected is not None
        vertices = [min(range(7), key=lambda v: dist(layout.centres[v], ring)) for ring in shown]
        signatures = {percepts(WORLD)[WORLD.vertices[v][0]].signature for v in vertices}
        assert signatures == {some(evidence.observed).signature, evidence.expected.signature}
        (dashed,) = [
            min(range(7), key=lambda v: dist(layout.centres[v], centre))
            for group, ring in film.groups("ring")
            if film.is_shown(group, at) and ring.get("stroke-dasharray")
            for centre in [(float(ring.get("cx", "")), float(ring.get("cy", "")))]
        ]  # "the dashed ring" of the caption
        expected = percepts(WORLD)[WORLD.vertices[dashed][0]]
        assert expected.signature == evidence.expected.signature
    assert rejections == 3


def test_the_ghost_goes_to_where_the_marker_would_be_if_the_guess_were_right() -> None:
    playback, layout, film = played()
    confirmed = [at for moment, at in frames(playback) if isinstance(moment.event, ev.Confirm)]
    ghosts = [
        (g, hidden)
        for hidden in film.root.iter(f"{SVG}g")
        for g in hidden
        if g.find(f"{SVG}circle[@class='ghost']") is not None
    ]
    marked = layout.centres[WORLD.marker_vertex]
    assert len(ghosts) == 4
    ghost, hidden = ghosts[-1]
    assert film.is_shown(hidden, confirmed[-1])
    assert dist(film.place(ghost, confirmed[-1]), marked) < 0.05


def test_without_animation_it_shows_the_end() -> None:
    _, _, film = played()
    for group in film.root.iter(f"{SVG}g"):
        if "opacity" in str(film.keys_of(group)):
            assert film.is_shown(group, film.seconds) == (group.get("opacity") is None)
    still = film.parent_of("robot").get("transform", "")
    place = film.place(film.parent_of("robot"), film.seconds)
    assert tuple(map(float, re.findall(r"-?[\d.]+", still)[:2])) == place
    assert "@media(prefers-reduced-motion:reduce){*{animation:none!important}}" in film.text


def test_it_tells_each_moment_in_one_sentence() -> None:
    playback, _, film = played()
    told = [film.words(at) for _, at in frames(playback)]
    assert told[0] == "The robot wakes up beside the marker"
    assert "Guess 2 is wrong too, without a step" in told
    assert told[-1] == "The map is complete"
    assert [words for words in told if "wrong" in words] == [
        "Guess 1 is wrong",
        "Guess 1 is wrong",
        "Guess 2 is wrong too, without a step",
    ]


def test_a_wrong_decision_is_shown_where_it_is_made() -> None:
    playback, _, film = played("concludes-by-elimination")
    wrong = [
        m.number for m, at in frames(playback) if film.words(at) == "Here the mapper goes wrong"
    ]
    assert wrong[0] == some(playback.first_finding).event
    assert wrong[-1] == len(playback.moments) - 1


def test_of_a_mapper_that_declares_nothing_solid_is_where_it_has_been() -> None:
    playback, _, film = played("declares-nothing")
    been = {WORLD.marker_vertex}
    for moment, at in frames(playback):
        been.add(WORLD.vertex_of[some(moment.position)])
        assert solid(film, "place", at) == been


def test_it_loads_nothing_and_runs_nothing() -> None:
    text = played()[2].text
    assert not re.search(r"<script|href|url\(|@import|<foreignObject|\son\w+=", text)


def test_hostile_names_stay_text() -> None:
    name = "</title><script>alert(1)</script>\x1b[31m\"' &amp;"
    world = replace(WORLD, name=name)
    run = explore(world, "basic")
    film = Film(animated_svg(Playback(world, run.trace), name=name))
    title = film.root.findtext(f"{SVG}title") or ""
    assert title.count("<script>alert(1)</script>\\x1b[31m\"' &amp;") == 2
    assert title == film.root.get("aria-label")
    assert film.root.find(f".//{SVG}script") is None


def test_a_run_that_nobody_would_watch_to_its_end_is_refused() -> None:
    world = families.lattice(6, 6)
    playback = Playback(world, explore(world, "basic").trace)
    with pytest.raises(InputError, match=f"at most {MOST_EVENTS} events: write the player"):
        animated_svg(playback)


@pytest.mark.parametrize("name", list(CATALOGUE))
def test_every_saying_fits_below_the_world(name: str) -> None:
    for world in (families.lattice(3, 4), World((), (), None), *map(World.from_id, WORLDS)):
        for saying in Narrator(playback_of(world, name)).sayings:
            assert len(saying.title) <= 64
            compared = saying.kind == "bad" and None not in (saying.seen, saying.expected)
            assert len(wrap(saying.text, BESIDE if compared else COLUMNS)) <= 2, saying
