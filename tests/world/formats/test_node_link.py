"""Node-link JSON: what the reader takes and refuses; test_rotated.py has the worlds."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.world.formats.worlds import world_or_sentence
from topo_verify.errors import InputError
from topo_verify.world import World, io
from topo_verify.world.formats import node_link

TEXT = node_link.encode(World.from_id("m4/41"))


def test_a_file_is_known_by_its_ending_and_names_a_world_without_a_name(tmp_path: Path) -> None:
    data = json.loads(TEXT)
    del data["graph"]["name"]
    file = tmp_path / "loop.NX.json"
    file.write_text(json.dumps(data))
    world = World.load(tmp_path / "loop.NX.json")
    assert (world, world.name) == (World.from_id("m4/41"), "loop.NX")
    file.rename(tmp_path / "loop.nx.json")
    assert World.load(tmp_path / "loop.nx.json").name == "loop"


def test_world_json_says_how_a_file_of_node_link_json_is_called() -> None:
    with pytest.raises(InputError, match=r"node-link JSON has a name that ends in \.nx\.json"):
        io.decode(World, TEXT)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("]}", "]", "is not valid JSON"),
        (TEXT, "", "is empty"),
        (TEXT, "[]", "node-link JSON: Expected `object`, got `array`.*; a world has a 'graph'"),
        ('"graph":{', '"graphs":{', "its nodes have a 'rotation', and the graph has no 'fo"),
        ('"marker":0', '"marker":true', r"`int \| null`, got `bool` - at `\$.graph.marker`"),
        ('"marker":0', '"marker":0,"marker":1', "has the field 'marker' twice"),
        ('"id":0', '"id":1', "two nodes have one id: give each a distinct id"),
        ('"id":0', '"id":{}', "node 0, id is an object, expected an id"),
        ('"source":0', '"source":[{}]', "edge 0 is an object, expected an id"),
        ('"id":0', '"id":' + "[" * 9999 + "]" * 9999, "nested too deeply|not valid JSON"),
        ('"id":0', '"id":' + "[" * 400 + "]" * 400, "edge 0 has the end 0"),
        ('"target":1', '"target":"1"', "edge 0 has the end '1', expected the id of a node"),
        ('"source":0', '"source":9', "edge 0 has the end 9, expected the id of a node"),
        ('"darts":[0,1]', '"darts":[0,1,2]', r"`array` of length 2.* - at `\$.edges\[0\].darts`"),
        ('"edges":', '"edge":', "expected its edges as 'edges', or 'links', got neither"),
        ('"edges":', '"links":[],"edges":', "expected its edges as 'edges', or 'links', got both"),
        ('"key":0', '"key":' + "[" * 100000, "nested too deeply|not valid JSON"),
        ('"rotation":[0]', '"rotation":[9223372036854775808]', r"`\$.nodes\[0\].rotation"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named_with_its_place(old: str, new: str, sentence: str) -> None:
    text = TEXT.replace(old, new, 1)
    assert text != TEXT
    with pytest.raises(InputError, match=sentence) as refusal:
        node_link.decode(World, text)
    assert str(refusal.value).startswith("node-link JSON")
    assert str(refusal.value).isprintable()


def test_an_edge_of_a_drawing_has_two_ends() -> None:
    text = '{"nodes": [{"id": 0, "x": 0, "y": 0}], "edges": [{"source": 0}]}'
    with pytest.raises(InputError, match="edge 0 has no 'target': give it the id of a node"):
        node_link.decode(World, text.encode())


@pytest.mark.parametrize("ids", [(0.5, 1.5), ([0, 0], [0, 1]), (None, True), ([[1, 2], "a"], [])])
def test_a_node_has_any_id_but_an_object(ids: tuple[Any, Any]) -> None:
    data = json.loads(TEXT)
    named = dict(enumerate((*ids, "two")))
    for node in data["nodes"]:
        node["id"] = named[node["id"]]
    for edge in data["edges"]:
        edge |= {end: named[edge[end]] for end in ("source", "target")}
    assert node_link.decode(World, json.dumps(data)) == World.from_id("m4/41")


def test_other_fields_are_ignored_whatever_they_hold() -> None:
    text = TEXT.replace('"id":0', '"id":0,"size":' + "9" * 5000 + ',"colour":{"of":[null]}', 1)
    assert node_link.decode(World, text) == World.from_id("m4/41")


@pytest.mark.no_cover
@given(data=st.data())
def test_any_change_gives_a_world_or_one_sentence(data: st.DataObject) -> None:
    value: Any = json.loads(TEXT)
    rows: list[Any] = [value, value["graph"], *value["nodes"], *value["edges"]]
    places = [(row, key) for row in rows for key in row]
    places += [
        (node["rotation"], i) for node in value["nodes"] for i in range(len(node["rotation"]))
    ]
    at, key = data.draw(st.sampled_from(places))
    at[key] = data.draw(st.none() | st.integers() | st.text(max_size=3) | st.lists(st.integers()))
    world_or_sentence(lambda: node_link.decode(World, json.dumps(value)))
