"""Drawings with many flaws, and drawings in several parts."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from topo_verify.errors import InputError
from topo_verify.world import World, io
from topo_verify.world.formats.flaws import Flaws

Nodes = list[tuple[str, Any, Any]]
Edges = list[tuple[str, str]]

# ---------------------------------------------------------------- writers of drawings


def graphml(nodes: Nodes, edges: Edges) -> str:
    """The drawing as GraphML."""
    places = "".join(
        f'<node id="{name}"><data key="x">{x}</data><data key="y">{y}</data></node>'
        for name, x, y in nodes
    )
    ways = "".join(f'<edge id="{a}{b}" source="{a}" target="{b}"/>' for a, b in edges)
    keys = '<key id="x" attr.name="x"/><key id="y" attr.name="y"/>'
    return f"<graphml>{keys}<graph>{places}{ways}</graph></graphml>"


def net(nodes: Nodes, edges: Edges) -> str:
    """The drawing as a road network."""
    places = "".join(f'<junction id="{name}" x="{x}" y="{y}"/>' for name, x, y in nodes)
    ways = "".join(f'<edge id="{a}{b}" from="{a}" to="{b}"/>' for a, b in edges)
    return f"<net>{places}{ways}</net>"


def node_link(nodes: Nodes, edges: Edges) -> str:
    """The drawing as node-link JSON."""
    return json.dumps(
        {
            "nodes": [{"id": name, "x": x, "y": y} for name, x, y in nodes],
            "edges": [{"source": a, "target": b} for a, b in edges],
        }
    )


WRITERS: dict[str, Callable[[Nodes, Edges], str]] = {
    ".graphml": graphml,
    ".net.xml": net,
    ".nx.json": node_link,
}


@pytest.fixture(params=WRITERS)
def drawn(request: pytest.FixtureRequest, tmp_path: Path) -> Callable[[Nodes, Edges], Path]:
    """A function that writes a drawing in each format."""

    def write(nodes: Nodes, edges: Edges) -> Path:
        file = tmp_path / f"town{request.param}"
        file.write_text(WRITERS[request.param](nodes, edges))
        return file

    return write


Drawn = Callable[[Nodes, Edges], Path]


def refusal_of(file: Path) -> str:
    """The one sentence that refuses the drawing."""
    with pytest.raises(InputError) as refusal:
        World.load(file)
    sentence = str(refusal.value)
    assert sentence.startswith(str(file))
    assert sentence.isprintable()
    return sentence


# ---------------------------------------------------------------- many flaws

SQUARE: Nodes = [("a", 0, 0), ("b", 9, 0), ("c", 9, 9), ("d", 0, 9)]
AROUND: Edges = [("a", "b"), ("b", "c"), ("c", "d"), ("d", "a")]


def test_flaws_of_every_kind_are_in_one_refusal(drawn: Drawn) -> None:
    nodes = [
        *SQUARE,
        ("b", 7, 7),  # a second time
        ("north", 5, "up"),  # no number
        ("alone", 5, 5),
        ("far", 18, 0),
        ("under", 9, 0),  # where b lies
    ]
    edges = [
        *AROUND,
        ("a", "nowhere"),
        ("a", "far"),  # over b
        ("b", "under"),  # one point
        ("c", "north"),  # no flaw of its own
    ]
    sentence = refusal_of(drawn(nodes, edges))
    assert "5 flaws" in sentence or "6 flaws" in sentence
    for name in ("'b'", "'north'", "nowhere", "'a'", "'alone'"):
        assert name in sentence
    assert "'far' has no edge" not in sentence
    assert "cnorth" not in sentence


def test_the_first_ten_flaws_are_named_and_all_are_counted(drawn: Drawn) -> None:
    lost = [(f"lost{number:03}", number, 20) for number in range(300)]
    sentence = refusal_of(drawn([*SQUARE, *lost], AROUND))
    assert "300 flaws, the first 10 of them" in sentence
    assert [f"lost{number:03}" in sentence for number in (0, 9, 10, 299)] == [True] * 2 + [
        False
    ] * 2
    assert len(sentence) < 4000


def test_one_flaw_is_said_alone(drawn: Drawn) -> None:
    assert "flaws" not in refusal_of(drawn([*SQUARE, ("alone", 5, 5)], AROUND))


def test_other_exceptions_pass_through_the_flaws() -> None:
    flaws = Flaws("it")
    with pytest.raises(KeyError), flaws:
        raise KeyError
    assert not flaws
    flaws.refuse()


# ---------------------------------------------------------------- several parts

PARTS: Nodes = [("p", 50, 0), ("q", 60, 0), *SQUARE, ("alone", 5, 5)]


def test_the_largest_part_is_kept_and_the_rest_is_told(
    drawn: Drawn, caplog: pytest.LogCaptureFixture
) -> None:
    file = drawn(PARTS, [("p", "q"), *AROUND])
    refusal_of(file)
    caplog.set_level("INFO")
    world = io.load(World, file, largest_part=True)
    assert world == World.load(drawn(SQUARE, AROUND))
    assert world.vertex_names == ("a", "b", "c", "d")
    (sentence,) = caplog.messages
    assert "4 of 7 vertices and 4 of 5 edges" in sentence
    assert all(f"'{name}'" in sentence for name in ("p", "q", "alone"))
    assert "2 parts" in sentence


def test_of_equal_parts_the_first_is_kept(drawn: Drawn) -> None:
    file = drawn([("a", 0, 0), ("b", 1, 0), ("c", 0, 9), ("d", 1, 9)], [("c", "d"), ("a", "b")])
    assert io.load(World, file, largest_part=True).vertex_names == ("a", "b")


def test_a_flaw_in_a_part_that_is_left_out_is_none(drawn: Drawn) -> None:
    nodes = [*SQUARE, ("p", 50, 0), ("q", 60, 0), ("r", 70, 0)]
    file = drawn(nodes, [*AROUND, ("p", "q"), ("p", "r")])
    assert "'p'" in refusal_of(file)
    assert len(io.load(World, file, largest_part=True).vertices) == 4


def test_a_drawing_of_one_part_is_whole(drawn: Drawn, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level("INFO")
    file = drawn(SQUARE, AROUND)
    assert io.load(World, file, largest_part=True) == World.load(file)
    assert not caplog.messages


def test_a_drawing_in_several_parts_with_edges_is_refused(drawn: Drawn) -> None:
    sentence = refusal_of(drawn([*SQUARE, ("p", 50, 0), ("q", 60, 0)], [*AROUND, ("p", "q")]))
    assert "4 of 6 vertices" in sentence
    assert "--largest-part" in sentence
