"""What makes a site of docs/: contents, links from words, checked links, and the gallery.

`make docs` builds the site itself; these tests try its parts on small inputs that must fail.
"""

from __future__ import annotations

import importlib.util
import json
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

import pytest

from tests.pages import ROOT
from topo_verify.pictures.drawing.read_back import read, untruths
from topo_verify.world.families import FAMILIES
from topo_verify.world.resolve import resolve_world

if TYPE_CHECKING:
    from playwright.sync_api import Browser

DOCS = ROOT / "docs"


def part(path: str) -> ModuleType:
    """A Python file of docs/, which is no package."""
    spec = importlib.util.spec_from_file_location(Path(path).stem, DOCS / path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules.setdefault(f"docs_{Path(path).stem}", module)
    spec.loader.exec_module(module)
    return module


def test_every_page_stands_once_in_the_contents() -> None:
    parts = list(part("site/contents.py").parts((DOCS / "index.md").read_text()))
    entries = [page for _, pages in parts for _, page in pages]
    pages = {page.relative_to(DOCS).with_suffix("").as_posix() for page in DOCS.rglob("[!_]*.md")}
    assert sorted(entries) == sorted(pages - {"index"})


def test_the_contents_are_the_lists_of_the_page() -> None:
    index = "# T\n\n## One\n\n- [A](a.md): why\n- [B](b/c.md)\n\n## Two\n\nno list\n"
    assert part("site/contents.py").toctrees(index) == (
        "\n```{toctree}\n:hidden:\n:caption: One\n\nA <a>\nB <b/c>\n```\n"
    )


def test_a_notebook_becomes_its_cells_and_what_they_show(tmp_path: Path) -> None:
    cells = [
        {"cell_type": "markdown", "source": ["# Title\n", "[a](../docs/a.md), [b.py](b.py)"]},
        {"cell_type": "code", "source": ["print('<b>')\n", "x = 1\n", "x"]},
    ]
    path = tmp_path / "book.ipynb"
    path.write_text(json.dumps({"cells": cells}), encoding="utf-8")
    text = part("site/notebook.py").page(path)
    assert text == (
        "[a](../a.md), `b.py`\n\n```python\nprint('<b>')\nx = 1\nx\n```\n\n"
        "``````{raw} html\n<pre>&lt;b&gt;\n</pre><pre>1</pre>\n``````"
    )
    pytest.importorskip("matplotlib")
    cells[1]["source"] = ["import matplotlib.pyplot as plt\n", "plt.plot([1, 2])\n", "plt.show()"]
    path.write_text(json.dumps({"cells": cells}), encoding="utf-8")
    chart = part("site/notebook.py").page(path)
    assert chart.count("<svg style='max-width:100%") == chart.count("fill:currentColor") == 1
    assert "stroke: currentColor" in chart  # black on white would not follow the theme
    assert not {"#ffffff", "#000000"} & set(re.findall(r"#[0-9a-f]{6}", chart))
    cells[1]["source"] = ["1 / 0"]
    path.write_text(json.dumps({"cells": cells}), encoding="utf-8")
    with pytest.raises(ZeroDivisionError):
        part("site/notebook.py").page(path)


def test_words_are_found_whole_in_the_singular_and_the_plural() -> None:
    glossary = part("site/glossary.py")
    words = ("dart", "hypothesis", "reference dart", "policy", "genus")
    text = "Darts, the reference dart, hypotheses and policies; a darter. Genus."
    text += " Hypothesis draws a WORLD."
    found = [(text[start:end], word) for start, end, word in glossary.uses(text, words)]
    assert found == [
        ("Darts", "dart"),
        ("reference dart", "reference dart"),
        ("hypotheses", "hypothesis"),
        ("policies", "policy"),
        ("Genus", "genus"),
    ]


def test_the_glossary_has_no_word_twice() -> None:
    words = part("site/glossary.py").words_of((DOCS / "glossary.md").read_text())
    assert len(words) == len(set(words)) > 30


@pytest.mark.parametrize(
    ("link", "why"),
    [
        ("b.html", "names a file that is not there"),
        ("#nowhere", "names an anchor that is not there"),
        ("a.html#nowhere", "names an anchor that is not there"),
        ("http://nowhere", "is no address of the web"),
        ("javascript:alert(1)", "is no address of the web"),
    ],
)
def test_a_broken_link_is_seen(link: str, why: str, tmp_path: Path) -> None:
    checked = part("site/checked.py")
    page = tmp_path / "a.html"
    page.write_text(
        '<p id="here"><a href="#here"><a href="https://example.org/x"><a href="a.html">'
    )
    assert list(checked.broken(tmp_path)) == []
    page.write_text(f'<p id="here"><a href="{link}">')
    assert list(checked.broken(tmp_path)) == [f"a.html: {link} {why}"]


def test_a_page_that_another_was_written_over_is_seen(tmp_path: Path) -> None:
    lost = part("site/checked.py").lost
    page = tmp_path / "search.html"
    page.write_text("<h1>Hunting</h1>")
    assert list(lost(tmp_path, ["search"])) == []
    page.write_text('<div id="search-results"></div>')  # as Sphinx writes its own
    assert list(lost(tmp_path, ["search"])) == [
        "search.html: nothing of the source search stands there"
    ]


def test_a_long_name_is_broken_between_its_words() -> None:
    pieces = part("site/breaks.py").PLACE.split
    assert pieces("a/b.py:test_x") == ["a/", "b.", "py:", "test_", "x"]
    assert pieces("lattice(4,holes=0.2)") == ["lattice(", "4,", "holes=", "0.", "2)"]
    assert pieces("--quick") == ["--quick"]


def test_a_folder_of_this_machine_is_seen(tmp_path: Path) -> None:
    (tmp_path / "a.html").write_text(f"<code>{ROOT}/topo_verify/world/io.py</code>")
    (seen,) = part("site/checked.py").broken(tmp_path)
    assert "which a reader does not have" in seen


@pytest.mark.long
@pytest.mark.parametrize(
    "command",
    [
        "topo-verify replay m1/0 --target basic --player right.html",  # no counterexample
        "topo-verify play m1/0 -o FILE --target basic",  # the page does not stand last
        "topo-verify play m9/x -o wrong.html",
    ],
)
def test_a_player_that_shows_nothing_ends_the_build(command: str, tmp_path: Path) -> None:
    players = part("site/players.py")
    with pytest.raises(players.ExtensionError):
        players.make(command, tmp_path)


def test_the_line_of_a_definition_is_found() -> None:
    line_of = part("site/codelines.py").line_of
    source = "X: int = 1\n\n\nclass A:\n    def f(self): ...\n"
    assert [line_of(source, name) for name in ("X", "A", "A.f", "f")] == [1, 4, 5, None]


@pytest.mark.parametrize(
    ("name", "file", "begins"),
    [
        ("algorithms/motion.py:Pilot.back", "topo_verify/algorithms/motion.py", "    def back("),
        ("docs/test_site.py:part", "tests/docs/test_site.py", "def part("),
        ("Embedding.confirm", "topo_verify/proofs/coq/Embedding.v", "Theorem confirm "),
        ("World.marker", "topo_verify/proofs/coq/World.v", "Definition marker "),
    ],
)
def test_code_that_the_page_names_is_linked_at_its_line(name: str, file: str, begins: str) -> None:
    line = part("site/codelines.py").line_named(name)
    assert line.file == file
    lines = (ROOT / file).read_text().splitlines()
    number: int = line.number
    assert lines[number - 1].startswith(begins)


@pytest.mark.parametrize("name", ["basic", "Embedding.confir", "CITATION.cff", "no/file.py:f"])
def test_other_words_of_the_page_are_not_linked(name: str) -> None:
    assert part("site/codelines.py").line_named(name) is None


@pytest.fixture(scope="module")
def small_site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A site with the theme and the styles of docs/: a wide table, a report, long names."""
    for module in ("furo", "myst_parser"):
        pytest.importorskip(module, reason=f"{module} is not installed")
    folder = tmp_path_factory.mktemp("site")
    row = "|" + " enhancement-iii |" * 10
    long = "topo_verify.world.enumeration.classes.WorldClass.admits"
    names = (f"```{{py:method}} {long}{i}\n```\n" for i in range(2))
    table = f"# Wide\n\n{row}\n{'| --- ' * 10}|\n{row}\n\n## Part\n\n"
    report = f"<div><pre>\n{'report -' * 10}\n</pre></div>\n\n"  # lines of 80, as reports have
    (folder / "index.md").write_text(table + report + "".join(names))
    options = {
        "extensions": "myst_parser",
        "html_theme": "furo",
        "html_static_path": DOCS / "site" / "static",
        "html_css_files": "site.css",
    }
    settings = [f"-D{name}={value}" for name, value in options.items()]
    command = [sys.executable, "-m", "sphinx", "-q", "-C", *settings, str(folder), f"{folder}/out"]
    subprocess.run(command, check=True)
    return folder / "out"


CUT_REPORTS = (
    "() => [...document.querySelectorAll('pre')].filter(e => e.scrollWidth > e.clientWidth).length"
)


@pytest.mark.parametrize("name", ["index", "genindex"])
def test_no_page_is_wider_than_its_window(name: str, small_site: Path, browser: Browser) -> None:
    page = browser.new_page()
    page.goto((small_site / f"{name}.html").as_uri())
    for width in (360, 768, 1024, 1280, 1312, 1366, 1440, 1600, 1920):
        page.set_viewport_size({"width": width, "height": 800})
        page_width, contents_end = page.evaluate(
            "() => [document.documentElement.scrollWidth,"
            " document.querySelector('.toc-drawer').getBoundingClientRect().right]"
        )
        assert page_width <= width
        if width > 360:  # on a phone a report scrolls
            assert page.evaluate(CUT_REPORTS) == 0
        if name == "index" and width > 1312:  # below, the theme puts the contents behind a button
            assert contents_end <= width
    page.close()


def test_a_frame_follows_the_theme_of_the_site(small_site: Path, browser: Browser) -> None:
    page = browser.new_page(color_scheme="null")  # an emulated one overrules the theme in frames
    page.goto((small_site / "index.html").as_uri())
    page.evaluate("document.body.append(document.createElement('iframe'))")
    for theme in ("dark", "light", "dark"):
        page.evaluate(f"document.body.dataset.theme = '{theme}'")
        page.frames[1].wait_for_function(
            "dark => matchMedia('(prefers-color-scheme: dark)').matches === dark",
            arg=theme == "dark",
        )
    page.close()


def test_the_gallery_has_every_family_and_the_first_genera() -> None:
    pictures = part("gallery.py").PICTURES
    assert FAMILIES.keys() <= pictures.keys()
    assert {resolve_world(world).genus for world in pictures.values()} >= {0, 1, 2, 3}


def test_every_stored_picture_shows_its_world_and_stands_on_a_page() -> None:
    pictures = part("gallery.py").PICTURES
    stored = {path.stem: path.read_text() for path in (DOCS / "gallery").glob("*.svg")}
    pages = "".join(page.read_text() for page in DOCS.rglob("[!_]*.md"))
    assert stored.keys() == pictures.keys()
    for name, svg in stored.items():
        assert untruths(read(svg), resolve_world(pictures[name])) == [], name
        assert f"gallery/{name}.svg)" in pages


def test_a_picture_of_another_world_is_seen() -> None:
    svg = (DOCS / "gallery" / "m2-7.svg").read_text()
    assert untruths(read(svg), resolve_world("m2/8"))


def test_every_core_dependency_has_its_row() -> None:
    spec = importlib.util.spec_from_file_location("weights", ROOT / "benchmarks/dependencies.py")
    assert spec is not None
    assert spec.loader is not None
    weights = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(weights)
    page = (DOCS / "reference" / "dependencies.md").read_text()
    assert sorted(weights.core()) == sorted(weights.PURPOSES)
    for name, purpose in weights.PURPOSES.items():
        assert f"| {name} | {purpose} | " in page
    assert weights.size("click") > 100_000
    assert {"click", "numpy"} <= weights.needs("scipy") | weights.needs("click")
