"""What a WORLD may be called: each way, its precedence, and what hostile text gets."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.world.formats.worlds import world_or_sentence
from topo_verify.errors import InputError
from topo_verify.world import World, families
from topo_verify.world.formats import files, planar_code
from topo_verify.world.resolve import resolve_world

TRIANGLE = families.complete(3)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder that commands run in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


# ---------------------------------------------------------------- every way


def test_a_graph_of_a_file_is_named_by_its_number(tmp_path: Path) -> None:
    cube = families.cube()
    file = tmp_path / "all.pc"
    one = planar_code.encode(cube)
    file.write_bytes(one + one.removeprefix(b">>planar_code<<"))
    assert resolve_world(f"{file}:1").is_isomorphic(cube)
    with pytest.raises(InputError, match="holds 2 graphs, and graph 2"):
        resolve_world(f"{file}:2")
    with pytest.raises(InputError, match="no such world"):
        resolve_world(f"{file}:{'9' * 5000}")


def test_an_id_names_its_world() -> None:
    assert resolve_world("m5/17") == World.from_id("m5/17")
    assert resolve_world("m5/17").name == "m5/17"


def test_a_family_with_its_arguments_names_a_world() -> None:
    made = families.lattice(10, 10, holes=0.2, seed=7)
    assert resolve_world("family:lattice(10,10,holes=0.2,seed=7)") == made
    assert resolve_world("family:lattice( 10, columns = 10, seed=7 , holes=2e-1)") == made
    assert resolve_world("family:lattice((3),0x3,)") == families.lattice(3, 3)
    assert resolve_world("family:dense(4,.5)") == families.dense(4, 0.5)
    assert resolve_world("family:torus(2,3)") == families.torus(2, 3)


def test_nyc_is_the_street_network_of_the_package() -> None:
    world = resolve_world("nyc")
    assert (world.name, world.is_planar) == ("nyc_osmnx", True)
    assert (len(world.vertices), len(world.edges)) == (46, 73)
    assert "OpenStreetMap contributors, ODbL" in world.licence


def test_a_path_names_the_world_in_the_file(folder: Path) -> None:
    TRIANGLE.save("triangle.json")
    assert (
        resolve_world("triangle.json") == resolve_world(str(folder / "triangle.json")) == TRIANGLE
    )


def test_a_dash_is_world_json_on_standard_input(monkeypatch: pytest.MonkeyPatch) -> None:
    text = TRIANGLE.to_json().encode()
    assert resolve_world("-", stdin=io.BytesIO(text)) == TRIANGLE
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(text)))
    assert resolve_world("-") == TRIANGLE


def test_what_is_wrong_on_standard_input_is_named_so() -> None:
    with pytest.raises(InputError, match="standard input is empty"):
        resolve_world("-", stdin=io.BytesIO())


def test_too_much_on_standard_input_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files, "LIMIT", 2**10)
    with pytest.raises(InputError, match="standard input is larger than"):
        resolve_world("-", stdin=io.BytesIO(bytes(2**10 + 1)))


# ---------------------------------------------------------------- precedence


@pytest.mark.parametrize("name", ["m2/3", "nyc", "-", "family:torus(1,1)"])
def test_a_file_with_the_name_of_something_else_is_reached_with_a_dot(
    folder: Path, name: str
) -> None:
    (folder / name).parent.mkdir(exist_ok=True)
    TRIANGLE.save(name)
    assert (
        resolve_world(name, stdin=io.BytesIO(World.from_id("m1/0").to_json().encode())) != TRIANGLE
    )
    assert resolve_world(f"./{name}") == TRIANGLE


@pytest.mark.parametrize("name", ["m2-3", "m2/3.json", "xm2", "m2/3\n", "NYC"])
def test_what_only_looks_like_an_id_is_a_path(folder: Path, name: str) -> None:
    (folder / name).parent.mkdir(exist_ok=True)
    TRIANGLE.save(name)
    assert resolve_world(name) == TRIANGLE


# ---------------------------------------------------------------- what is refused


@pytest.mark.parametrize(
    "text", ["", "nope", "m5-17", "lattice(3,3)", "x" * 5000, "a\0b", "\ud800"]
)
def test_what_names_no_world_is_told_what_a_world_may_be_called(folder: Path, text: str) -> None:
    assert folder.exists()
    with pytest.raises(InputError, match=r"no such world: .* a path, an id \(m5/17\)") as refusal:
        resolve_world(text)
    for way in ("family:lattice(10,10,holes=0.2,seed=7)", "nyc", "-"):
        assert way in str(refusal.value)
    assert str(refusal.value).isprintable()
    assert len(str(refusal.value)) < 500


def test_a_folder_is_no_world(folder: Path) -> None:
    with pytest.raises(InputError, match="Is a directory; name a file"):
        resolve_world(str(folder))


def test_a_rank_out_of_range_is_refused() -> None:
    with pytest.raises(InputError, match="run from 0 to 9"):
        resolve_world("m2/10")


@pytest.mark.parametrize(
    "text",
    [
        "family:",
        "family:(3)",
        "family:sphere(3)",
        "family:LATTICE(3,3)",
        "family:FAMILIES()",
        "family:__import__('os')",
        "family:lattice.__globals__()",
        "family: lattice(3,3)",
        "family:" + "(" * 100_000,
    ],
)
def test_an_unknown_family_is_told_which_there_are(text: str) -> None:
    with pytest.raises(InputError, match="no such family of worlds") as refusal:
        resolve_world(text)
    assert all(name in str(refusal.value) for name in families.FAMILIES)
    assert len(str(refusal.value)) < 500


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("lattice", "expected one call"),
        ("lattice(3,3", "was never closed"),
        ("lattice(3,3))", "unmatched"),
        ("lattice(3,3);torus(1,1)", "invalid syntax"),
        ("lattice(3,3)(3,3)", "expected one call"),
        ("lattice(3,3)+torus(1,1)", "expected one call"),
        ("lattice(" + "9" * 100_000 + ",1)", "expected at most 200 characters, got 100011"),
        ("lattice(" + "(" * 190 + ")", "the family is"),
        ("lattice(" + "[" * 90 + "]" * 90 + ")", "expected a number, got"),
        ("lattice(" + "-" * 180 + "1)", "expected a number, got"),
        ("lattice(3,\0)", "the family is"),
        ("lattice('\ud800')", "expected a call without"),
    ],
)
def test_what_is_no_call_is_told_what_the_family_expects(text: str, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence) as refusal:
        resolve_world(f"family:{text}")
    assert str(refusal.value).endswith("lattice(rows, columns, holes=0.0, seed=0, marker=None)")
    assert str(refusal.value).isprintable()
    assert len(str(refusal.value)) < 500


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ("3", "missing a required argument: 'columns'"),
        ("", "missing a required argument: 'rows'"),
        ("3,3,3", "too many positional arguments"),
        ("3,3,rows=3", "multiple values for argument 'rows'"),
        ("3,3,depth=3", "unexpected keyword argument 'depth'"),
        ("3,3,seed=1,seed=2", "each name once, got 'seed=2'"),
        ("3,holes=0.1,3", "positional argument follows keyword argument"),
        ("3,,3", "invalid syntax"),
        ("3,x", "expected a number, got 'x'"),
        ("9**9**9,1", r"expected a number, got '9\*\*9\*\*9'"),
        ("'3',3", "expected a number, got ''3''"),
        ("True,3", "expected a number, got 'True'"),
        ("3,1j", "expected a number, got '1j'"),
        ("3,...", "expected a number, got '...'"),
        ("3or 4,3", "expected a number, got '3or 4'"),
        ("*[3],3", r"expected a number, got '\*\[3\]'"),
        ("**3", r"expected name=value and each name once, got '\*\*3'"),
        ("lattice(3,3),3", r"expected a number, got 'lattice\(3,3\)'"),
        ("__import__('os').getpid(),3", "expected a number, got '__import__"),
        ("\uff13,3", "invalid character"),
        ("3,3,holes=nan", "expected a number, got 'nan'"),
        ("3,3,seed=1\n2", "invalid syntax"),
    ],
)
def test_arguments_that_do_not_fit_are_told_which_do(arguments: str, sentence: str) -> None:
    family = r"; the family is lattice\(rows, columns, holes=0.0, seed=0, marker=None\)$"
    with pytest.raises(InputError, match=sentence + ".*" + family) as refusal:
        resolve_world(f"family:lattice({arguments})")
    assert str(refusal.value).isprintable()


@given(
    name=st.sampled_from([*families.FAMILIES, "", "sphere"]),
    arguments=st.text(alphabet="0123.,-+e=seedholes()*_' \n", max_size=12),
)
def test_any_text_behind_family_gives_a_world_or_one_sentence(name: str, arguments: str) -> None:
    world = world_or_sentence(lambda: resolve_world(f"family:{name}({arguments})"))
    assert world is None or resolve_world(f"family:{world.name}") == world
