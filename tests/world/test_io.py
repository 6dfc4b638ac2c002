"""The name of a file says its format, wherever a world is loaded."""

from __future__ import annotations

import gzip
from codecs import BOM_UTF8
from io import BytesIO
from pathlib import Path

import pytest

from topo_verify.errors import InputError
from topo_verify.world import World, families
from topo_verify.world.formats import files, node_link, planar_code
from topo_verify.world.resolve import resolve_world

NET = (
    '<net><junction id="a" x="0" y="0"/><junction id="b" x="1" y="0"/>'
    '<edge id="e" from="a" to="b"/></net>'
)
GRAPHML = (
    '<graphml><key id="x" attr.name="x"/><key id="y" attr.name="y"/><graph>'
    '<node id="a"><data key="x">0</data><data key="y">0</data></node>'
    '<node id="b"><data key="x">1</data><data key="y">0</data></node>'
    '<edge source="a" target="b"/></graph></graphml>'
)
FILES = {
    "w.json": families.path(2).to_json().encode(),
    "w": families.path(2).to_json().encode(),
    "w.pc": planar_code.encode(families.path(2)),
    "w.plc": planar_code.encode(families.path(2)),
    "W.PC": planar_code.encode(families.path(2)),
    "w.graphml": GRAPHML.encode(),
    "w.net.xml": NET.encode(),
    "w.nx.json": node_link.encode(families.path(2)).encode(),
}


@pytest.mark.parametrize("name", ["w", "w.json", "w.pc", "w.PLC", "w.graphml", "w.nx.json"])
def test_a_world_is_saved_in_the_format_of_the_name(name: str, tmp_path: Path) -> None:
    world = families.path(2)
    world.save(tmp_path / name)
    assert World.load(tmp_path / name) == world
    assert (
        (tmp_path / name)
        .read_bytes()
        .startswith({"w.PLC": b">>", "w.graphml": b"<?"}.get(name, b""))
    )


@pytest.mark.parametrize("name", ["w.net.xml", "w.dot", "m4.629"])
def test_a_name_of_no_format_that_is_written_is_refused(name: str, tmp_path: Path) -> None:
    with pytest.raises(
        InputError, match=rf"{name}: no format with this ending is written: expected .* \.json, "
    ):
        families.path(2).save(tmp_path / name)
    assert not [*tmp_path.iterdir()]


def test_data_is_not_saved_under_the_name_of_a_picture(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"expected a name for data, as w\.json, got one for a pi"):
        families.path(2).save(tmp_path / "w.svg")
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize("name", ["w.json", "w.graphml", "w.net.xml"])
def test_a_byte_order_mark_is_passed_over(name: str, tmp_path: Path) -> None:
    file = tmp_path / name
    file.write_bytes(BOM_UTF8 + FILES[name])
    assert World.load(file) == families.path(2)


@pytest.mark.parametrize("name", FILES)
def test_a_file_is_read_as_its_name_says(name: str, tmp_path: Path) -> None:
    file = tmp_path / name
    file.write_bytes(FILES[name])
    world = World.load(file)
    assert world == families.path(2) == resolve_world(str(file))
    assert type(Town.load(file)) is Town
    assert world.name in {"w", "W", "path(2)"}


@pytest.mark.parametrize("ending", ["", ".gz", ".GZ"])
@pytest.mark.parametrize("name", FILES)
def test_a_file_of_every_format_may_be_packed(name: str, ending: str, tmp_path: Path) -> None:
    plain, packed = tmp_path / name, tmp_path / f"packed-{name}{ending}"
    plain.write_bytes(FILES[name])
    packed.write_bytes(gzip.compress(FILES[name]))
    assert World.load(packed) == World.load(plain) == resolve_world(str(packed))
    assert World.load(packed).name.removeprefix("packed-") == World.load(plain).name
    assert resolve_world("-", stdin=BytesIO(gzip.compress(FILES["w.json"]))) == families.path(2)


@pytest.mark.parametrize("name", ["k4.pl", "k4.json", "k4", "k4.graphml", "k4.net.xml", "k4.gz"])
def test_planar_code_is_read_under_any_name(name: str, tmp_path: Path) -> None:
    data = planar_code.encode(families.tetrahedron())
    (tmp_path / name).write_bytes(data)
    assert World.load(tmp_path / name).code == families.tetrahedron().code
    assert resolve_world("-", stdin=BytesIO(data)).code == families.tetrahedron().code
    (tmp_path / name).write_bytes(data + data)
    assert World.load(tmp_path / name, graph=1).code == families.tetrahedron().code
    assert resolve_world(f"{tmp_path / name}:1").code == families.tetrahedron().code


class Town(World):
    """A subclass is read as itself."""


@pytest.mark.parametrize("name", ["w.json", "w", "w.graphml", "w.net.xml"])
def test_a_file_of_one_world_has_no_graphs_to_choose_from(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(FILES[name])
    with pytest.raises(InputError, match=r"graph=0 is for planar_code \(.pc, .plc\)"):
        World.load(tmp_path / name, graph=0)


@pytest.mark.parametrize("name", FILES)
def test_a_file_that_is_too_large_is_refused_whatever_its_format(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(files, "LIMIT", 16)
    file = tmp_path / name
    file.write_bytes(FILES[name])
    with pytest.raises(InputError, match="is larger than"):
        World.load(file)
