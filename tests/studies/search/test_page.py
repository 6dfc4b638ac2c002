"""docs/search.md: every command on the page prints what stands behind it."""

from __future__ import annotations

import shlex

import pytest
from click.testing import CliRunner

from tests.pages import ROOT, commands_on
from topo_verify.cli import main
from topo_verify.studies.search.search import search
from topo_verify.world.enumeration.classes import WorldClass

SHOWN = commands_on("search.md")


@pytest.mark.parametrize(("line", "text"), SHOWN, ids=[line for line, _ in SHOWN])
def test_a_command_prints_what_the_page_shows(
    line: str, text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    assert CliRunner().invoke(main, shlex.split(line)).stdout == text


def test_the_page_shows_five_commands() -> None:
    assert len(SHOWN) == 5


@pytest.mark.parametrize(
    ("kind", "undirected", "unmarked"), [("any", 2, 2), ("loopless", 3, 2), ("simple", 4, 3)]
)
def test_the_smallest_worlds_that_need_the_marker_are_as_large_as_said(
    kind: str, undirected: int, unmarked: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    # docs/semantics.md, section 10.
    monkeypatch.chdir(ROOT)
    for name, edges in (("undirected", undirected), ("unmarked", unmarked)):
        target = f"examples/undirected.py:{name}"
        found = search(target, edges=4, world_class=WorldClass.parse(kind))
        assert found.counterexample is not None
        assert (found.counterexample.edges, found.counterexample.claim) == (
            edges,
            "no-false-confirm",
        )
