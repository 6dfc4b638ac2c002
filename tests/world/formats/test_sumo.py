"""SUMO: the streets of a network, each once, and what is refused."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.world.formats.worlds import sentence_of, world_or_sentence
from topo_verify.world import World
from topo_verify.world.formats import embedding, sumo

# As netconvert writes it, shortened: a crossing with streets to the west, the north and, by a
# bend, the east; a one-way street from the east to the north.
NET = b"""<?xml version="1.0" encoding="UTF-8"?>
<!-- generated -->
<net version="1.16" junctionCornerDetail="5" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://sumo.dlr.de/xsd/net_file.xsd">
    <location netOffset="0.00,0.00" convBoundary="0.00,0.00,200.00,200.00"/>
    <type id="highway.residential" priority="3"/>
    <edge id=":C_0" function="internal">
        <lane id=":C_0_0" index="0" speed="6.51" length="9.03" shape="98.40,107.20 98.40,92.80"/>
    </edge>
    <edge id="WC" from="W" to="C" priority="-1">
        <lane id="WC_0" index="0" speed="13.89" length="92.80" shape="0.00,98.40 92.80,98.40"/>
    </edge>
    <edge id="CW" from="C" to="W" priority="-1"/>
    <edge id="7#1" from="C" to="N" shape="100.00,100.00 100.10,150.00 100.00,200.00"/>
    <edge id="-7#1" from="N" to="C" shape="100.00,200.00 101.00,150.00 100.00,100.00"/>
    <edge id="CE" from="C" to="E" shape="100.00,100.00 150.00,50.00,3.00 200.00,100.00"/>
    <edge id="EC" from="E" to="C" shape="200.00,100.00 150.00,50.00,3.00 100.00,100.00"/>
    <edge id="EN" from="E" to="N"/>
    <junction id="W" type="dead_end" x="0.00" y="100.00" incLanes="" intLanes="" shape="0,0"/>
    <junction id="C" type="priority" x="100.00" y="100.00"><request index="0"/></junction>
    <junction id="N" type="dead_end" x="100.00" y="200.00"/>
    <junction id="E" type="dead_end" x="200.00" y="100.00"/>
    <junction id=":C_1" type="internal" x="1.00" y="1.00"/>
    <connection from="WC" to="CE" fromLane="0" toLane="0" via=":C_0_0" dir="s" state="M"/>
</net>"""


def refusal_of(data: bytes) -> str:
    """The one sentence that refuses it."""
    return sentence_of(lambda: sumo.decode(World, data), "SUMO network")


def test_a_file_is_refused_as_soon_as_it_has_too_much(monkeypatch: pytest.MonkeyPatch) -> None:
    """Before its end, which is not XML."""
    data = NET.replace(b"</net>", b"<broken")
    assert "is not valid XML" in refusal_of(data)
    monkeypatch.setattr(embedding, "MOST_POINTS", 9)
    assert "expected at most 500,000 edges, their vertices, and 9 points in" in refusal_of(data)
    monkeypatch.undo()
    monkeypatch.setattr(embedding, "MOST_EDGES", 2)
    assert "expected at most 2 edges" in refusal_of(data)


def test_a_network_is_read_each_street_once_and_nothing_within_junctions() -> None:
    world = sumo.decode(World, NET, stem="town")
    assert world.name == "town"
    assert world.vertex_names == ("W", "C", "N", "E")
    assert world.degrees == (1, 3, 2, 2)
    names = [world.vertex_names[world.vertex_of[world.alpha[d]]] for d in world.vertices[1]]
    assert names == ["N", "E", "W"]  # clockwise from the north
    assert world.root == 0
    assert (world.is_planar, world.is_simple) == (True, True)


def test_opposite_edges_with_courses_and_ids_of_their_own_are_two_streets() -> None:
    apart = NET.replace(b'id="-7#1"', b'id="8"')
    world = sumo.decode(World, apart)
    assert world.degrees == (1, 4, 3, 2)
    assert not world.is_simple


@pytest.mark.parametrize(
    ("there", "back", "merged"),
    [
        ("0,3.3 100,3.3", "", 1),  # side by side
        ("0,3.3 100,3.3", "100,-3.3 50,-3.3 0,-3.3", 1),
        ("0,0 50,20.01 100,0", "100,0 50,20.02 0,0", 1),  # rounding
        ("0.01,0 50,20.01 100,0", "100,-0.01 50.01,20.01 0,0", 1),
        ("0,0 50,20 100,0", "100,0 50,20.5 0,0", 0),
        ("0,0 5,4 100,0", "100,0 5,5 0,0", 1),
        ("0,0 50,20 100,0", "100,0 40,30 50,50 0,0", 0),
        ("0,0 50,20 100,0", "", 0),
        ("0,0 50,20 100,0", "100,0 75,10 50,20 0,0", 1),  # a point between two others
        ("0,0 50,20 100,0", "100,0 50,20 25,10 12.5,5 0,0", 1),
        ("0,0 50,20 100,0.01", "100,0 75,10.01 50,20.01 0,0", 1),
        ("0,0 50,20 100,0", "100,0 75,12 50,21 0,0", 0),
    ],
)
def test_both_directions_are_one_edge_if_their_courses_differ_by_rounding_or_are_straight(
    there: str, back: str, merged: int, caplog: pytest.LogCaptureFixture
) -> None:
    edges = "".join(
        f'<edge id="{ends}" from="{ends[0]}" to="{ends[1]}" shape="{shape}"/>'
        for ends, shape in (("ab", there), ("ba", back))
    ).replace('shape=""', "")
    places = '<junction id="a" x="0" y="0"/><junction id="b" x="100" y="0"/>'
    with caplog.at_level("INFO"):
        world = sumo.decode(World, f"<net>{places}{edges}</net>".encode())
    assert len(world.edges) == 2 - merged
    (remark,) = caplog.messages
    assert re.findall("[0-9]+", remark) == (["1"] if merged else ["0", "1"])


@pytest.mark.parametrize(
    ("lanes", "attributes", "differ"),
    [
        (b"WC_0 -7#1_0 -7#1_1 EC_0 :C_w0_0", b"", 0),
        (b"WC_0 WC_1 EC_0 -7#1_0", b"", 1),
        (b"WC_0 EC_0 -7#1_0", b' lefthand="true"', 0),
        (b"WC_0 -7#1_0 EC_0", b' lefthand="true"', 1),
        (b"EC_0 WC_0", b"", 0),
        (b"EC_0 other_0 WC_0 -7#1_0", b"", 0),
        (b"", b"", 0),
    ],
)
def test_another_order_of_the_lanes_that_lead_to_a_junction_is_said(
    lanes: bytes, attributes: bytes, differ: int, caplog: pytest.LogCaptureFixture
) -> None:
    data = NET.replace(b'y="100.00"><', b'y="100.00" incLanes="%s"><' % lanes)
    data = data.replace(b"<net", b"<net" + attributes)
    assert data.count(lanes)
    assert sumo.decode(World, data) == sumo.decode(World, NET)
    assert [len(re.findall("'C'", text)) for text in caplog.messages] == [1] * differ


def test_an_id_with_a_minus_is_the_way_back_only_between_the_same_junctions() -> None:
    other = NET.replace(b'id="-7#1" from="N" to="C"', b'id="-7#1" from="C" to="N"')
    assert sumo.decode(World, other).degrees == (1, 4, 3, 2)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        (b"<net ", b"<!DOCTYPE net [<!ENTITY a 'b'>]><net ", "has a document type"),
        (b"</net>", b"", "is not valid XML"),
        (b'"N" type="dead_end" x="100.00"', b'"N" type="dead_end"', "junction 'N', x is ''"),
        (b'y="200.00"', b'y="up"', "junction 'N', y is 'up', expected a number"),
        (b'junction id="N"', b'junction id="W"', "junction 'W' stands there twice"),
        (b'junction id="N"', b"junction", "junction '' has no id"),
        (b'edge id="CW"', b'edge id="WC"', "edge 'WC' stands there twice"),
        (b'from="E" to="N"', b'from="E"', "edge 'EN': expected the ids of two junctions"),
        (b'from="E" to="N"', b'from=":C_1" to="N"', "edge 'EN': expected the ids of two junctions"),
        (b"150.00,50.00,3.00", b"150.00", "edge 'CE', shape has a point of 1 coordinates"),
        (b"150.00,50.00,3.00", b"150.00,x", "edge 'CE', shape is 'x', expected a number"),
        (b'id="EN" from="E" to="N"', b'id="EN" from="E" to="E"', "begins a loop that is a single"),
        (b'id="EN" from="E" to="N"', b'id="EN" from="C" to="W"',
         "at vertex 'W' two edges leave at the same angle, 'WC' toward (100.0, 100.0) and 'EN'"),
        (b'<edge id="WC" from="W"', b'<edge id="WC" from="N"', ""),
        (b"</net>", b'<junction id="Z" x="9" y="9"/></net>', "vertex 'Z' has no edge"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named_with_its_place(old: bytes, new: bytes, sentence: str) -> None:
    data = NET.replace(old, new, 1)
    assert data != NET
    if sentence:
        assert sentence in refusal_of(data)
    else:
        assert len(sumo.decode(World, data).edges) == 5


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (b"<additional/>", "expected a SUMO network, whose first element is <net>"),
        (b"<net/>", "has no vertex"),
        (b"\0\0", "is not valid XML"),
    ],
)
def test_what_is_no_network_is_refused(data: bytes, sentence: str) -> None:
    assert sentence in refusal_of(data)


@given(data=st.data())
def test_any_change_to_a_file_gives_a_world_or_one_sentence(data: st.DataObject) -> None:
    parts = NET.split(b'"')
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(parts) - 1))
        other = data.draw(st.integers(0, len(parts) - 1))
        parts[at] = data.draw(st.sampled_from([parts[other], b"", b"-", b"0", b"C", b"1e400,0"]))
    content = b'"'.join(parts)
    stop = data.draw(st.integers(len(content) // 2, len(content)))
    world_or_sentence(lambda: sumo.decode(World, content[:stop]))
