"""How large the smallest worlds are that need the marker and its direction."""

from __future__ import annotations

import pytest

from tests.pages import ROOT
from topo_verify.studies.search.search import search
from topo_verify.world.enumeration.classes import WorldClass


@pytest.mark.long
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
        found = search(target, edges=4, cls=WorldClass.parse(kind))
        assert found.counterexample is not None
        assert (found.counterexample.edges, found.counterexample.claim) == (
            edges,
            "no-false-confirm",
        )
