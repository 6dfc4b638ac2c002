"""The page as a file: self-contained, the same bytes each time, and what it is told stays text."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

from tests.html_parts import Parts
from tests.pictures.played import page_of, played
from topo_verify import families
from topo_verify.campaign.run import explore
from topo_verify.checkers import Finding, Judgement
from topo_verify.pictures.page import SCRIPTS, part, player_page
from topo_verify.pictures.recording import GALLERY, GalleryWorld
from topo_verify.world.resolve import resolve_world

HOSTILE = "</script><script>alert(1)</script>\"'\x1b[31m{script}&lt;\ud800"
"""Text that would end a script, an attribute or a colour, or stand in for a part of the page."""


def recorded(page: str) -> dict[str, object]:
    """The data in a page."""
    data: dict[str, object] = json.loads(Parts(page).texts["script"][0])
    return data


def test_the_policy_allows_nothing_but_its_own_script_and_style() -> None:
    page = Parts(page_of(families.lattice(2, 2), "basic"))
    policy = next(a["content"] for _, a in page.tags if a.get("http-equiv"))
    assert policy is not None
    rules = dict(rule.split(None, 1) for rule in policy.split("; "))
    assert rules.keys() == {"default-src", "style-src", "script-src", "base-uri", "form-action"}
    for name, text in (("style", page.texts["style"][0]), ("script", page.texts["script"][1])):
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert rules[f"{name}-src"] == f"'sha256-{digest}'"
    assert {rules[name] for name in rules if not name.startswith(("style", "script"))} == {"'none'"}


def test_the_page_names_no_address_and_has_no_inline_style_or_handler() -> None:
    text = page_of(families.lattice(2, 2), "basic")
    assert set(re.findall(r"\w+://[^'\"\s]+", text)) == {"http://www.w3.org/2000/svg"}
    for _, attributes in Parts(text).tags:
        assert not [name for name in attributes if name in ("src", "href", "style")]
        assert not [name for name in attributes if name.startswith("on")]


def test_two_pages_of_one_run_are_equal_byte_for_byte() -> None:
    world = families.lattice(3, 3)
    assert page_of(world, "folding") == page_of(world, "folding")


def test_hostile_names_and_findings_stay_data() -> None:
    world = families.lattice(2, 2)
    world = replace(world, name=HOSTILE, vertex_names=(HOSTILE,) * len(world.vertices))
    finding = Finding("map-isomorphic", 2, None, None, HOSTILE)
    run = played(world, "basic", name=HOSTILE)
    run = replace(run, judgements=[Judgement("map-isomorphic", "failed", 1, 1, (finding,))])
    page = player_page(world, [run])
    clean = page_of(families.lattice(2, 2), "basic")
    assert [tag for tag, _ in Parts(page).tags] == [tag for tag, _ in Parts(clean).tags]
    assert "\x1b" not in page
    assert "</script><script>" in str(recorded(page)["name"])
    assert Parts(page).texts["script"][1] == Parts(clean).texts["script"][1]


def test_every_part_of_the_page_is_written_into_it() -> None:
    page = page_of(families.lattice(2, 2), "basic")
    for name in (*SCRIPTS, "page.css"):
        assert part(name) in page


def test_the_street_network_with_1468_moves_takes_less_than_156_kilobytes() -> None:
    page = page_of(resolve_world("nyc"), "basic")
    assert len(page.encode()) < 156_000


@pytest.mark.long
def test_a_network_of_216_edges_takes_less_than_300_kilobytes() -> None:
    world = families.king(10, 10, holes=0.2, seed=1)
    assert len(world.edges) == 216
    assert len(page_of(world, "basic").encode()) < 300_000


def test_a_notebook_shows_a_run_in_a_frame_that_may_run_scripts_and_nothing_else() -> None:
    run = explore(families.lattice(2, 2), "basic")
    tags = Parts(run._repr_html_()).tags  # pyright: ignore[reportPrivateUsage]
    assert [tag for tag, _ in tags] == ["style", "iframe"]
    assert tags[1][1]["sandbox"] == "allow-scripts"
    page = page_of(run.world, "basic")
    assert tags[1][1]["srcdoc"] == page.replace("<html ", '<html class="framed" ', 1)


def test_the_frame_follows_the_theme_of_the_notebook_and_else_of_the_system() -> None:
    run = explore(families.lattice(2, 2), "basic")
    style, _, _ = run._repr_html_().partition("<iframe")  # pyright: ignore[reportPrivateUsage]
    assert style == (
        "<style>.tv-frame{height:640px}"
        ":is([data-jp-theme-light=false],.vscode-dark,[theme=dark],[data-theme=dark]) .tv-frame"
        "{height:641px}"
        "@media(prefers-color-scheme:dark){[data-theme=auto] .tv-frame{height:641px}}</style>"
    )


def test_a_run_is_saved_as_a_page(tmp_path: Path) -> None:
    run = explore(families.lattice(2, 2), "basic")
    run.save(tmp_path / "run.html")
    assert (tmp_path / "run.html").read_text(encoding="utf-8") == page_of(run.world, "basic")


@pytest.mark.parametrize("shown", GALLERY, ids=lambda shown: shown.text)
def test_the_gallery_says_the_genus_and_the_symmetries_of_its_worlds(shown: GalleryWorld) -> None:
    world = resolve_world(shown.text)
    assert world.genus == shown.genus
    assert ("torus" in shown.name) == (world.genus == 1)
    marked = [replace(world, root=dart).code for edge in world.edges for dart in edge]
    assert marked.count(world.code) == shown.symmetries
