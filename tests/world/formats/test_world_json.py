"""World JSON: it comes back as it went, and nothing but a world is read."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.world.formats.worlds import sentence_of, world_or_sentence
from topo_verify.errors import InputError
from topo_verify.world import World, families
from topo_verify.world.enumeration import rank_order
from topo_verify.world.formats import files, world_json

DATA = Path(__file__).parents[2] / "data"
NETWORKS = ["pp_mv_oberrhein", "sumo_A10KW"]
HEAD = '"format":"topo-verify/world","version":1'
EDGE = '{"format":"topo-verify/world","version":1,"vertices":[[0],[1]],"edges":[[0,1]],"marker":0}'

texts = st.text(st.characters(exclude_categories=["Cs"]), max_size=8)
numbers = st.floats(allow_nan=False, allow_infinity=False)


@st.composite
def dressed_worlds(draw: st.DrawFn) -> World:
    """Worlds with everything that a file can carry, darts and vertices in any order."""
    edges = draw(st.integers(0, 8))
    rank = draw(st.integers(0, rank_order.count(edges) - 1))
    plain = World.from_code(rank_order.unrank(edges, rank))
    plain = plain.renumbered(draw(st.permutations(range(2 * edges))))
    vertices = draw(st.permutations(plain.vertices))
    size = len(vertices)
    return World.from_rotations(
        vertices,
        plain.edges,
        plain.root,
        name=draw(texts),
        vertex_names=draw(st.just(()) | st.tuples(*[texts] * size)),
        positions=draw(st.just(()) | st.tuples(*[st.tuples(numbers, numbers)] * size)),
        source=draw(texts),
        licence=draw(texts),
    )


def refusal_of(text: str | bytes) -> str:
    """The one sentence that refuses it."""
    return sentence_of(lambda: World.from_json(text), "world JSON")


def doctored(**fields: Any) -> str:
    """The world with one edge, some fields replaced."""
    return json.dumps({**json.loads(EDGE), **fields})


# ---------------------------------------------------------------- there and back


@pytest.mark.nightly
@given(world=dressed_worlds())
@pytest.mark.no_cover
def test_a_world_comes_back_with_all_that_it_carries(world: World) -> None:
    back = World.from_json(world.to_json())
    assert back == world
    assert back.vertices == world.vertices
    assert repr(back.positions) == repr(world.positions)  # every bit of every float
    for field in ("name", "vertex_names", "source", "licence"):
        assert getattr(back, field) == getattr(world, field)
    assert back.to_json() == world.to_json()
    jsonschema.validate(json.loads(world.to_json()), world_json.schema())


@pytest.mark.parametrize("world", [World((), (), None), World.from_id("m1/1"), families.king(3, 3)])
def test_a_file_comes_back(world: World, tmp_path: Path) -> None:
    world.save(tmp_path / "file.json")
    assert World.load(tmp_path / "file.json") == world
    assert (tmp_path / "file.json").read_text() == world.to_json() + "\n"


def test_the_text_is_the_documented_one() -> None:
    assert World.from_id("m1/0").to_json() == EDGE.replace('"vert', '"name":"m1/0","vert')
    assert World((), (), None).to_json() == (
        '{"format":"topo-verify/world","version":1,"name":"","vertices":[[]],"edges":[],"marker":null}'
    )


@pytest.mark.parametrize("name", NETWORKS)
def test_a_real_network_is_read_and_comes_back(name: str) -> None:
    file = DATA / "worlds" / f"{name}.json"
    world = World.load(file)
    assert world.name == name
    assert world.is_simple
    assert json.loads(world.to_json()) == json.loads(file.read_bytes())


def test_the_networks_are_the_ones_that_their_readme_describes() -> None:
    grid, roads = (World.load(DATA / "worlds" / f"{name}.json") for name in NETWORKS)
    assert (len(grid.vertices), len(grid.edges), grid.genus) == (177, 181, 0)
    assert (len(roads.vertices), len(roads.edges), roads.genus) == (185, 277, 1)


def test_every_file_of_other_peoples_data_has_its_notice_beside_it() -> None:
    notice = (DATA / "README.md").read_text()
    for name in NETWORKS:
        assert name in notice
    assert "OpenStreetMap contributors" in notice
    package = Path(world_json.__file__).parents[1] / "data"
    assert "© OpenStreetMap contributors" in (package / "ATTRIBUTION.md").read_text()
    assert {file.name for file in package.iterdir()} == {"nyc_osmnx.json", "ATTRIBUTION.md"}


# ---------------------------------------------------------------- names


def test_a_world_without_a_name_is_called_after_its_file(tmp_path: Path) -> None:
    (tmp_path / "my.town.json").write_text(EDGE)
    assert World.load(tmp_path / "my.town.json").name == "my.town"
    (tmp_path / "other.json").write_text(doctored(name=""))
    assert World.load(tmp_path / "other.json").name == "other"
    (tmp_path / "named.json").write_text(doctored(name="village"))
    assert World.load(tmp_path / "named.json").name == "village"
    assert World.from_json(EDGE).name == ""


def test_a_file_name_that_is_no_text_gives_a_name_that_is(tmp_path: Path) -> None:
    file = Path(os.fsdecode(os.fsencode(tmp_path) + b"/\xff.json"))
    file.write_text(EDGE)
    assert World.load(file).name == "\N{REPLACEMENT CHARACTER}"


# ---------------------------------------------------------------- the schema


def test_the_schema_in_the_package_is_the_one_that_is_made() -> None:
    file = Path(world_json.__file__).with_name("world.schema.json")
    made = json.dumps(world_json.schema(), indent=2) + "\n"
    assert file.read_text() == made, "write this text into the file, and the change into CHANGELOG"


def test_the_schema_refuses_what_the_reader_refuses() -> None:
    schema = world_json.schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.validate(json.loads(EDGE), schema)
    for broken in ({"marker": "0"}, {"extra": 1}, {"edges": [[0]]}, {"version": 2}):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(json.loads(doctored(**broken)), schema)


# ---------------------------------------------------------------- what is refused: JSON


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "world JSON is empty: a world is one JSON object"),
        (" \n", "world JSON is empty"),
        (EDGE[:-1], "is not valid JSON: input data was truncated; a world is one JSON object"),
        (EDGE + "{}", "is not valid JSON: trailing characters"),
        ("door,degree,marker\n,2,0\n", "one JSON object (a log is judged by certify LOG, and"),
        (EDGE.replace("0", "00"), "is not valid JSON"),
        (EDGE.replace("0]", "NaN]"), "is not valid JSON: invalid character"),
        (EDGE.replace("0]", "Infinity]"), "is not valid JSON"),
        ("[" * 100_000, "expected `object`, got `array`; correct it: a world is one JSON"),
        ('{"a":' * 100_000, "expected a world, got lists that are nested too deeply"),
        ('{"a":' + "[" * 100_000, "nested too deeply"),
        ("{" + HEAD + ',"vertices":' + "[" * 100_000, "nested too deeply"),
        ("null", "expected `object`, got `null`"),
        ("7", "expected `object`, got `int`"),
        ("'a'", "not valid JSON"),
    ],
    ids=lambda text: f"{text:.20}",
)
def test_what_is_no_json_object_is_refused(text: str, sentence: str) -> None:
    seen = refusal_of(text)
    assert any(part in seen for part in sentence.split("|"))
    assert refusal_of(text.encode()) == seen


@pytest.mark.parametrize("data", [b"\xff\xfe{\0}\0", b'{"name":"\xe4"}', b"\x80"])
def test_what_is_no_utf_8_is_refused(data: bytes) -> None:
    assert "is not UTF-8 text: 'utf-8' codec can't decode byte" in refusal_of(data)


def test_a_text_with_half_a_surrogate_pair_is_refused() -> None:
    assert "is not UTF-8 text" in refusal_of(EDGE.replace("marker", "\ud800"))
    assert "is not valid JSON" in refusal_of(EDGE.replace("{", '{"name":"\\ud800",'))


def test_a_byte_order_mark_is_passed_over() -> None:
    assert World.from_json("\ufeff" + EDGE) == World.from_json(EDGE.encode("utf-8-sig"))


def test_a_large_text_is_refused_before_it_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files, "LIMIT", 2**20)
    assert "larger than 1 MiB" in refusal_of("[" * (2**20 + 1))


# ---------------------------------------------------------------- what is refused: fields


@pytest.mark.parametrize(
    ("field", "value", "sentence"),
    [
        ("format", "topo-verify/trace", ": expected the 'format' 'topo-verify/world', got"),
        ("format", "a\nb" * 999, r": expected the 'format' 'topo-verify/world', got 'a\nba\nb"),
        ("format", None, ", format: expected `str`, got `null`; correct it: 'format' is the"),
        ("version", 2, " has version 2 of the world format, and this topo-verify reads versions"),
        ("version", 0, ", version: invalid enum value 0; correct it: 'version' is the version"),
        ("version", True, ", version: expected `int`, got `bool`"),
        ("version", 1.0, ", version: expected `int`, got `float`"),
        ("name", 5, ", name: expected `str`, got `int`; correct it: 'name' is a text"),
        ("name", None, ", name: expected `str`, got `null`"),
        ("vertices", None, ", vertices: expected `array`, got `null`; correct it: 'vertices' is"),
        ("vertices", [0, 1], ", vertices[0]: expected `array`, got `int`"),
        ("vertices", [[0], [True]], ", vertices[1][0]: expected `int`, got `bool`"),
        ("vertices", [[0], [1.0]], ", vertices[1][0]: expected `int`, got `float`"),
        ("vertices", [[0], ["1"]], ", vertices[1][0]: expected `int`, got `str`"),
        ("vertices", [[0], [None]], ", vertices[1][0]: expected `int`, got `null`"),
        ("vertices", [[0], [2**63]], ", vertices[1][0]: expected `int` <= 9223372036854775807"),
        ("vertices", [[0], [10**400]], ", vertices[1][0]: "),
        ("vertices", [[0], [1], [1]], ": dart 1 stands at two places of 'vertices'"),
        ("vertices", [], ": 'vertices' is empty"),
        ("edges", [[0, 1, 2]], ", edges[0]: expected `array` of length 2; correct it: 'edges' is"),
        ("edges", [], ": dart 0 of vertices[0] belongs to no edge"),
        ("edges", {"0": 1}, ", edges: expected `array`, got `object`"),
        ("marker", None, ": marker None with 2 darts: the marker points at a dart; it is null"),
        ("marker", 2, ": the marker points at dart 2, which no vertex has"),
        ("marker", False, ", marker: expected `int | null`, got `bool`; correct it: 'marker' is"),
        ("marker", [0], ", marker: expected `int | null`, got `array`"),
        ("vertex_names", [], ", vertex_names: expected `array` of length >= 1"),
        ("vertex_names", ["a"], ": vertex_names has 1 entries for 2 vertices"),
        ("vertex_names", ["a", 2], ", vertex_names[1]: expected `str`, got `int`"),
        ("positions", [], ", positions: expected `array` of length >= 1"),
        ("positions", [[0, 0]], ": positions has 1 entries for 2 vertices"),
        ("positions", [[0, 0], [1]], ", positions[1]: expected `array` of length 2"),
        ("positions", [[0, 0], [10**400, 0]], ", positions[1][0]: number out of range"),
        ("positions", [[0, 0], ["1", 0]], ", positions[1][0]: expected `float`, got `str`"),
        ("source", 1, ", source: expected `str`, got `int`"),
        ("licence", [], ", licence: expected `str`, got `array`"),
        ("colour", "red", ": object contains unknown field `colour`; leave it out: a world is"),
        ("\u001b[31m\n", 1, r": object contains unknown field `\x1b[31m\n`"),
        ("k" * 9999, 1, ": object contains unknown field `kkkk"),
    ],
)
def test_a_field_that_does_not_fit_is_named_with_what_belongs_there(
    field: str, value: object, sentence: str
) -> None:
    assert refusal_of(doctored(**{field: value})).startswith(f"world JSON{sentence}")


@pytest.mark.parametrize("field", ["format", "version", "vertices", "edges", "marker"])
def test_a_field_that_is_missing_is_named_with_what_it_is(field: str) -> None:
    fields = json.loads(EDGE)
    del fields[field]
    seen = refusal_of(json.dumps(fields))
    assert f"object missing required field `{field}`; add it: '{field}' is" in seen


@pytest.mark.parametrize("field", ["format", "version", "vertices", "edges", "marker"])
def test_a_field_that_stands_twice_is_named_even_with_the_same_value(field: str) -> None:
    value = json.dumps(json.loads(EDGE)[field])
    for key in (f'"{field}"', f'"\\u{ord(field[0]):04x}{field[1:]}"'):
        twice = EDGE[:-1] + f",{key}:{value}}}"
        assert refusal_of(twice) == (
            f"world JSON has the field '{field}' twice: leave one of the two out"
        )


def test_a_newer_version_is_refused_whatever_fields_it_has() -> None:
    newer = '{"format":"topo-verify/world","version":3,"surface":{"a":[{}]},"version":3}'
    assert refusal_of(newer).endswith("reads versions up to 1: update it")


def test_numbers_as_long_as_the_file_are_refused() -> None:
    for text in (
        EDGE.replace("[1]", f"[{'9' * 10**6}]"),
        EDGE.replace(":0}", f":-{'9' * 10**6}}}"),
    ):
        assert "integer value out of range" in refusal_of(text)


def test_the_file_is_named_in_the_sentence(tmp_path: Path) -> None:
    file = tmp_path / "town.json"
    for text, place in (
        ("{", "town.json is not valid"),
        (doctored(marker="x"), "town.json, marker"),
    ):
        file.write_text(text)
        with pytest.raises(InputError, match=place):
            World.load(file)
    file.write_text(doctored(marker=7))
    with pytest.raises(InputError, match=r"town.json: the marker points at dart 7"):
        World.load(file)


def test_a_world_whose_texts_are_no_unicode_is_not_written(tmp_path: Path) -> None:
    world = World((), (), None, name="\ud800")
    with pytest.raises(InputError, match="expected Unicode in the world's name and texts"):
        world.to_json()
    with pytest.raises(InputError, match="expected Unicode"):
        world.save(tmp_path / "world.json")
    assert list(tmp_path.iterdir()) == []


# ---------------------------------------------------------------- what is refused: anything


@given(data=st.binary(max_size=60))
def test_any_bytes_give_a_world_or_one_sentence(data: bytes) -> None:
    world = world_or_sentence(lambda: World.from_json(data))
    assert world is None or World.from_json(world.to_json()) == world


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda values: st.lists(values, max_size=4) | st.dictionaries(st.text(max_size=5), values),
    max_leaves=10,
)
fields = st.sampled_from([*world_json.schema()["$defs"]["WorldFile"]["properties"], "other"])


@given(changes=st.dictionaries(fields, json_values, max_size=3))
@pytest.mark.no_cover
def test_any_values_in_the_fields_give_a_world_or_one_sentence(changes: dict[str, Any]) -> None:
    world = world_or_sentence(lambda: World.from_json(doctored(**changes)))
    assert world is None or World.from_json(world.to_json()) == world


@given(world=dressed_worlds(), data=st.data())
def test_any_damage_to_a_file_gives_a_world_or_one_sentence(
    world: World, data: st.DataObject
) -> None:
    text = world.to_json().encode()
    start = data.draw(st.integers(0, len(text)))
    stop = data.draw(st.integers(start, min(start + 12, len(text))))
    new = data.draw(
        st.binary(max_size=6)
        | st.sampled_from([b"", b"-1", b"0", b",", b"]", b"[[", b'"', b"1e9", b"null", b"true"])
    )
    other = world_or_sentence(lambda: World.from_json(text[:start] + new + text[stop:]))
    assert other is None or World.from_json(other.to_json()) == other
