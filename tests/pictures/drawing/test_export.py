"""The picture as a file: PNG, PDF and a page, the same bytes every time."""

from __future__ import annotations

import re
import sys
from base64 import b64encode
from hashlib import sha256
from pathlib import Path
from typing import Literal

import pytest

from topo_verify.errors import InputError
from topo_verify.pictures.drawing import Layout, document, lay_out, read_back, to_svg
from topo_verify.world.families import lattice
from topo_verify.world.rooted_map import World

pytestmark = pytest.mark.no_cover  # drawing is not trusted: it is left out of the measure

HOSTILE = "</title></svg><script>alert(1)</script><!--\"'&amp;\x00\x1b[31m\ud800\n"


@pytest.fixture(scope="module")
def world() -> World:
    return lattice(2, 3)


@pytest.fixture(scope="module")
def layout(world: World) -> Layout:
    return lay_out(world)


def test_an_svg_is_the_picture(world: World, layout: Layout) -> None:
    assert document(world, layout, "svg").decode() == to_svg(world, layout)


@pytest.mark.parametrize(("kind", "magic"), [("png", b"\x89PNG\r\n"), ("pdf", b"%PDF-")])
def test_png_and_pdf_are_rendered_the_same_every_time(
    world: World, layout: Layout, kind: Literal["png", "pdf"], magic: bytes
) -> None:
    pytest.importorskip("typst")
    made = document(world, layout, kind)
    assert made.startswith(magic)
    assert document(world, layout, kind) == made


def test_a_missing_renderer_is_named(
    world: World, layout: Layout, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "typst", None)
    with pytest.raises(InputError, match=r"needs typst: .* -m pip install typst, or"):
        document(world, layout, "png")


def test_a_page_asks_for_nothing_and_allows_its_own_styles_only(
    world: World, layout: Layout
) -> None:
    page = document(world, layout, "html").decode()
    assert "default-src 'none'" in page
    assert not re.search(r"https?://(?!www\.w3\.org/2000/svg)|<script| style=", page)
    for style in re.findall(r"<style>(.*?)</style>", page, re.DOTALL):
        assert b64encode(sha256(style.encode()).digest()).decode() in page


def test_hostile_names_stay_text(world: World) -> None:
    names = tuple(f"{HOSTILE}{k}" for k in range(6))
    nasty = World(
        world.alpha, world.sigma, world.root, name=HOSTILE, vertex_names=names,
        positions=world.positions, starts=world.starts,
    )  # fmt: skip
    svg = to_svg(nasty, lay_out(nasty))
    svg.encode()  # no lone surrogate
    assert [word for word in ("<script", "\x00", "\x1b") if word in svg] == []
    assert read_back.untruths(read_back.read(svg), nasty) == []
    assert "<script" not in document(nasty, lay_out(nasty), "html").decode()


def test_the_ending_of_a_file_says_its_format(world: World, tmp_path: Path) -> None:
    world.draw(tmp_path / "world.html")
    assert (tmp_path / "world.html").read_text().startswith("<!doctype html>")
