"""`world show`, `list`, `convert`, `count`, `sample` and `draw`."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import pytest

import topo_verify as tv
from tests.cli.conftest import Call, Refused, Results
from tests.python import python
from topo_verify import World, families
from topo_verify.pictures.drawing import choice, read_back
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.enumeration.pruned import ranked_tables


def test_what_a_reader_remarks_is_a_note_that_is_printed_once(call: Call) -> None:
    Path("two.net.xml").write_text(
        '<net><junction id="a" x="0" y="0"/><junction id="b" x="9" y="0"/>'
        '<edge id="there" from="a" to="b"/><edge id="back" from="b" to="a"/></net>'
    )
    for line in ("world show two.net.xml two.net.xml", "world convert two.net.xml"):
        (note,) = call(line).stderr.splitlines()
        assert note.startswith("topo-verify: two.net.xml: merged 1 ")
        assert call(f"{line} --quiet").stderr == ""


def test_show_has_the_promised_fields(results: Results) -> None:
    envelope = results("world show m3/14")
    assert envelope["format"] == "topo-verify/world-show"
    (entry,) = envelope["results"]
    del entry["source"], entry["licence"]
    assert entry == {
        "name": "m3/14", "id": "m3/14", "vertices": 3, "edges": 3, "faces": 2, "genus": 0,
        "degrees": [2, 3, 1], "simple": False, "loopless": True, "planar": True, "dual": "m3/19",
        "automorphisms": 1, "unrooted": "m3/3", "marker": 0,
        "least_cost": 4, "rotation": [[0, 1], [2, 3, 4], [5]],
        "edge_darts": [[0, 2], [1, 3], [4, 5]], "vertex_names": [], "twin": None,
    }  # fmt: skip


@pytest.mark.parametrize("name", ["m4/41", "nyc", "'family:torus(3,4)'", "m0/0"])
def test_show_gives_the_rotation_as_the_world_file_does(
    results: Results, call: Call, name: str
) -> None:
    (entry,) = results(f"world show {name}")["results"]
    file = json.loads(call(f"world convert {name}").stdout)
    assert entry["rotation"] == file["vertices"]
    assert entry["edge_darts"] == file["edges"]
    assert entry["vertex_names"] == file.get("vertex_names", [])


@pytest.mark.parametrize(
    ("names", "answer"),
    [
        *(("m4/4 m4/26", "yes"), ("m4/4 m4/6", "no, a mirror image"), ("m0/0 m3/14", "no")),
        ("'family:random_planar(300)' 'family:random_planar(300,marker=7)'", "yes"),
    ],
)
def test_show_says_of_two_worlds_whether_they_differ_in_the_marker_alone(
    call: Call, names: str, answer: str
) -> None:
    assert call(f"world show {names}").stdout.endswith(f"\nsame unrooted map: {answer}\n")
    assert "same unrooted map" not in call(f"world show {names} m1/0").stdout


def test_show_for_people_lists_each_vertex_with_its_darts_and_where_they_lead(call: Call) -> None:
    page = (Path(__file__).parents[2] / "docs" / "commands.md").read_text(encoding="utf-8")
    text = call("world show m4/41").stdout
    assert text.endswith("     2  6 7              2 5        1 1\n")
    assert f"$ topo-verify world show m4/41\n{text}```" in page
    named = World.from_rotations([[0], [1]], [[0, 1]], 0, vertex_names=("the hub", "\x1b[2J"))
    assert call("world show -", named.to_json()).stdout.endswith("""
vertex  name     darts clockwise  to darts  at vertices
     0  the hub  0                1         1
     1  \\x1b[2J  1                0         0
""")
    assert "darts clockwise" not in call("world show m0/0").stdout


def test_show_says_one_edge_traversal(call: Call) -> None:
    assert "least cost     1 edge traversal\n" in call("world show m1/0").stdout


def test_a_world_too_large_for_an_id_has_none_and_its_darts_are_in_json(
    call: Call, results: Results
) -> None:
    (entry,) = results("world show 'family:lattice(12,12)'")["results"]
    assert entry["id"] is None
    assert len(entry["rotation"]) == 144
    lines = call("world show 'family:lattice(12,12)'").stdout.splitlines()
    assert len(lines) == 13
    assert lines[-1] == "The darts of a world this large: --format json."


def test_show_for_people_tells_degrees_marker_and_licence(call: Call) -> None:
    text = call("world show nyc m0/0").stdout
    assert "2 of degree 1, 9 of degree 2, 14 of degree 3, 21 of degree 4" in text
    assert "planar         yes" in text
    assert "OpenStreetMap" in text
    assert "marker         none" in text


def test_convert_writes_what_can_be_read_again(call: Call, folder: Path) -> None:
    world = families.lattice(3, 4, seed=2)
    assert World.from_json(call("world convert 'family:lattice(3,4,seed=2)'").stdout) == world
    done = call("world convert 'family:lattice(3,4,seed=2)' --to json -o w.json")
    assert (done.exit_code, World.load(folder / "w.json")) == (0, world)
    assert "w.json" in done.stdout
    moved = call("world convert - --marker 3", world.to_json()).stdout
    assert World.from_json(moved) == world.with_marker(3)


def test_convert_in_json_is_an_envelope_all_the_same(results: Results) -> None:
    (entry,) = results("world convert m3/14")["results"]
    assert World.from_json(entry["text"]) == World.from_id("m3/14")
    (entry,) = results("world convert m3/14 -o w.json")["results"]
    assert (entry["file"], entry["text"]) == ("w.json", None)


@pytest.mark.parametrize(("to", "ending"), [("graphml", ".graphml"), ("nx-json", ".nx.json")])
@pytest.mark.parametrize("name", ["m4/41", "nyc", "'family:torus(3,4)'", "m0/0"])
def test_convert_writes_any_world_for_networkx(
    call: Call, folder: Path, to: str, ending: str, name: str
) -> None:
    text = call(f"world convert {name} --to {to}").stdout
    done = call(f"world convert {name} --to {to} -o w{ending}")
    assert (done.exit_code, done.stderr) == (0, "")
    assert (folder / f"w{ending}").read_text(encoding="utf-8") == text
    assert call(f"world convert w{ending}").stdout == call(f"world convert {name}").stdout


@pytest.mark.parametrize(
    ("file", "to"),
    [
        ("cube.pc", "planar_code"),
        ("cube.PLC", "planar_code"),
        ("cube.graphml", "graphml"),
        ("cube.nx.json", "nx-json"),
        ("cube.json", "json"),
        ("cube", "json"),
    ],
)
def test_convert_writes_the_format_that_the_name_of_the_file_says(
    call: Call, results: Results, file: str, to: str
) -> None:
    (entry,) = results(f"world convert 'family:cube()' -o {file}")["results"]
    assert (entry["to"], entry["file"]) == (to, file)
    assert World.from_json(call(f"world convert {file}").stdout).code == families.cube().code


def test_convert_says_how_a_file_is_called_that_can_be_read_again(call: Call) -> None:
    for to, file, ending in (("json", "w.pc", ".json"), ("nx-json", "w.json", ".nx.json")):
        done = call(f"world convert m4/41 --to {to} -o {file}")
        assert (
            done.stderr == f"topo-verify: {file}: to read it again, let its name end in {ending}\n"
        )
    assert call("world convert m4/41 --to nx-json -o w.json --quiet").stderr == ""
    assert "a name that ends in .nx.json" in call("world show w.json").stderr


@pytest.mark.parametrize(
    ("to", "locale"),
    [
        ("json", {"PYTHONIOENCODING": "latin-1"}),
        ("nx-json", {"PYTHONIOENCODING": "utf-16"}),
        ("graphml", {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}),
    ],
)
def test_data_on_stdout_is_utf8_whatever_the_locale(
    folder: Path, to: str, locale: dict[str, str]
) -> None:
    world = World.from_rotations([[0], [1]], [[0, 1]], 0, vertex_names=("Köln", "Łódź"))
    world.save(folder / "w.json")

    def output(*words: str) -> str:
        command = ("-m", "topo_verify", "world", *words)
        done = python(*command, cwd=folder, environment=locale, check=True, encoding="utf-8")
        return done.stdout

    name = f"v.{to}".replace("nx-json", "nx.json")
    (folder / name).write_text(output("convert", "w.json", "--to", to), encoding="utf-8")
    assert World.load(folder / name).vertex_names == world.vertex_names
    (entry,) = json.loads(output("convert", name, "--format", "json"))["results"]
    assert World.from_json(entry["text"]).vertex_names == world.vertex_names
    assert "Köln" in output("draw", name, "--doors")


def test_convert_keeps_the_largest_part_and_says_what_it_leaves_out(
    call: Call, folder: Path, refused: Refused
) -> None:
    nodes = [{"id": name, "x": x, "y": 0} for x, name in enumerate("abcde")]
    edges = [{"source": a, "target": b} for a, b in ("ab", "cd", "de")]
    (folder / "two.nx.json").write_text(json.dumps({"nodes": nodes, "edges": edges}))
    refused("world convert two.nx.json", "--largest-part")
    done = call("world convert two.nx.json --largest-part -o one.json")
    assert (done.exit_code, "'a', 'b'" in done.stderr) == (0, True)
    assert World.load(folder / "one.json").vertex_names == ("c", "d", "e")
    assert call("world convert two.nx.json --largest-part --quiet").stderr == ""
    shown = call("world show two.nx.json --largest-part --format json")
    assert json.loads(shown.stdout)["results"][0]["vertex_names"] == ["c", "d", "e"]
    assert "'a', 'b'" in shown.stderr


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        (
            "m0/0 --to planar_code",
            "--to planar_code: a binary format is written to a file; name one",
        ),
        ("m2/9 --to planar_code -o x.pc", "planar_code holds simple worlds"),
        ("named.json --to graphml -o x.pc", "GraphML cannot hold the character '\\x1b'"),
        ("m2/5 -o x.dot", "x.dot: no format with this ending is written: expected a name that"),
        ("m0/0 --to nonsense", "'json', 'planar_code', 'graphml', 'nx-json'"),
    ],
)
def test_convert_refuses_what_it_cannot_write(
    refused: Refused, folder: Path, line: str, sentence: str
) -> None:
    named = World.from_rotations([[0], [1]], [[0, 1]], 0, name="\x1b[2J")
    named.save(folder / "named.json")
    refused(f"world convert {line}", sentence)
    assert not [*folder.glob("x.*")]


def test_list_has_every_world_of_the_class_in_order(call: Call, results: Results) -> None:
    entries = results("world list --edges 3 --class genus:0")["results"]
    worlds = list(tv.worlds(edges=3, cls="planar"))
    assert entries == [{"id": w.id, "edges": 3, "class": "planar"} for w in worlds]
    assert call("world list --edges 3 --class planar").stdout.split() == [w.id for w in worlds]


def test_list_unrooted_has_the_first_world_of_each_map_without_its_marker(call: Call) -> None:
    found = [
        tv.World.from_id(name) for name in call("world list --edges 3 --unrooted").stdout.split()
    ]
    every = [w.with_marker(dart) for w in found for dart in range(6)]
    assert {w.id for w in every} == {w.id for w in tv.worlds(3)}
    assert len(found) == 20
    assert call("world list --edges 60 --class planar -n 2 --unrooted").stdout.split() == [
        "m60/0",
        "m60/1",
    ]


def test_list_prints_each_world_as_it_is_found(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(edges: int, kind: WorldClass) -> Iterator[tuple[int, rank_order.Table]]:
        yield from islice(ranked_tables(edges, kind), 2)
        raise KeyboardInterrupt

    monkeypatch.setattr("topo_verify.cli.world.ranked_tables", stopped)
    done = call("world list --edges 4")
    assert (done.exit_code, done.stdout) == (3, "m4/0\nm4/1\n")


def test_list_gives_the_first_of_more_worlds_than_can_be_listed(call: Call) -> None:
    ids = call("world list --edges 60 --class planar -n 3").stdout.split()
    assert ids == [world.id for world in islice(tv.worlds(edges=60, cls="planar"), 3)]


@pytest.mark.parametrize(
    ("line", "totals"),
    [
        ("--edges 6", [(6, "any", 110410)]),
        ("--edges 0..3", [(0, "any", 1), (1, "any", 2), (2, "any", 10), (3, "any", 74)]),
        ("--edges 5 --class planar", [(5, "planar", 2916)]),
        ("--edges 5 --class simple,planar", [(5, "planar,simple", 103)]),
        ("--edges 9 --class loopless,planar", [(9, "planar,loopless", 857956)]),
    ],
)
def test_count_gives_the_known_numbers(
    results: Results, line: str, totals: list[tuple[int, str, int]]
) -> None:
    entries = results(f"world count {line}")["results"]
    assert [(e["edges"], e["class"], e["total"]) for e in entries] == totals


def test_count_says_why_unrooted_worlds_are_not_counted(call: Call) -> None:
    assert "not counted" not in call("world count --edges 60 --class planar").stdout
    assert "-: not counted." in call("world count --edges 201").stdout


def test_count_by_vertices_has_a_row_for_each_number_of_vertices(
    call: Call, results: Results
) -> None:
    line = "world count --edges 2..3 --class planar --by vertices"
    rows = [(e["edges"], e["vertices"], e["total"]) for e in results(line)["results"]]
    assert rows == [(2, 1, 2), (2, 2, 5), (2, 3, 2), (3, 1, 5), (3, 2, 22), (3, 3, 22), (3, 4, 5)]
    assert call(line).stdout.splitlines()[1].split() == ["2", "planar", "1", "2"]


def test_a_range_that_cannot_be_counted_to_its_end_is_refused_at_once(call: Call) -> None:
    assert (
        "with 12 edges there may be"
        in call("world count --edges 1..12 --class simple,genus:1").stderr
    )


def test_count_is_exact_however_many_digits_it_takes(results: Results) -> None:
    (entry,) = results("world count --edges 200")["results"]
    assert entry["total"] == rank_order.count_by_recurrence(200) > 10**400


def test_sample_prints_ids_that_other_commands_take(call: Call, results: Results) -> None:
    done = call("world sample --edges 9 -n 4 --class planar --seed 5")
    ids = done.stdout.split()
    assert len(ids) == 4
    assert done.stderr == "topo-verify: seed 5\n"
    shown = results(f"world show {' '.join(ids)}")["results"]
    assert all(entry["planar"] and entry["edges"] == 9 for entry in shown)
    envelope = results("world sample --edges 9 -n 4 --class planar --seed 5")
    assert envelope["seed"] == 5
    assert [entry["id"] for entry in envelope["results"]] == ids
    printed = call("world sample --edges 9 -n 4 --class planar --seed 5 --format markdown").stdout
    assert printed == "\n".join(["```", *ids, "```", ""])


def test_sample_writes_world_files(call: Call, folder: Path) -> None:
    names = call("world sample --edges 220 -n 2 -o out/here").stdout.split()
    assert names == ["out/here/m220-seed0-0.json", "out/here/m220-seed0-1.json"]
    assert [len(World.load(folder / name).edges) for name in names] == [220, 220]


def test_a_sample_that_fails_leaves_no_folder(call: Call, folder: Path) -> None:
    assert call("world sample --edges 300 --class 'genus<=1' -o empty").exit_code == 2
    assert not (folder / "empty").exists()


def test_sample_draws_from_a_strategy(call: Call, results: Results) -> None:
    strategy = "nonplanar_worlds(genus=2, max_edges=9)"
    line = f"world sample --strategy '{strategy}' -n 3 --seed 0"
    done = call(line)
    ids = done.stdout.split()
    assert len(ids) == 3
    assert all(World.from_id(name).genus == 2 for name in ids)
    envelope = results(line)
    assert [entry["id"] for entry in envelope["results"]] == ids
    assert {entry["class"] for entry in envelope["results"]} == {None}
    assert {entry["strategy"] for entry in envelope["results"]} == {strategy}


# ---------------------------------------------------------------- draw


def test_draw_has_the_promised_fields(results: Results, folder: Path) -> None:
    envelope = results("world draw 'family:king(3,3)' -o king.svg")
    assert envelope["format"] == "topo-verify/world-draw"
    assert envelope["results"] == [
        {
            "world": "king(3,3)", "file": "king.svg", "layout": "positions", "vertices": 9,
            "shown": 9, "bridges": 4, "text": None,
        }
    ]  # fmt: skip
    assert (folder / "king.svg").read_text().startswith("<svg ")


def test_without_a_file_the_svg_is_printed_and_is_true(call: Call) -> None:
    picture = read_back.read(call("world draw m3/14 --doors --darts").stdout)
    assert read_back.untruths(picture, World.from_id("m3/14")) == []


def test_doors_and_darts_are_written_beside_the_edges(call: Call) -> None:
    svg = call("world draw m2/0 --doors").stdout
    assert svg.count('class="tv-soft"') == 4
    assert ">0:3<" in call("world draw m2/0 --doors --darts").stdout


def test_the_marker_may_be_elsewhere(call: Call) -> None:
    assert call("world draw m2/0").stdout != call("world draw m2/0 --marker 3").stdout


def test_the_part_that_is_shown_of_a_large_world_may_be_around_any_vertex(
    call: Call, results: Results, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(choice, "WHOLE", 20)  # it counts as large here
    monkeypatch.setattr(choice, "LIMIT", 30)
    line = "world draw family:random_planar(60,seed=1)"
    (entry,) = results(line)["results"]
    assert (entry["layout"], entry["shown"] < entry["vertices"]) == ("ball", True)
    assert "is drawn around its marker: no whole picture was read back true" in call(line).stderr
    vertices = [f'data-vertex="{vertex}"' for vertex in range(entry["vertices"])]
    hidden = next(k for k, vertex in enumerate(vertices) if vertex not in entry["text"])
    ball = call(f"{line} --around {hidden}").stdout
    assert vertices[hidden] in ball
    (circle,) = re.findall(rf'{vertices[hidden]} (cx="\S+" cy="\S+")', ball)
    assert f"{circle} r=" in ball.split("<title>here</title>")[0].split("<circle")[-1]


def test_a_vertex_that_is_not_there_is_refused(call: Call, refused: Refused) -> None:
    refused("world draw m3/14 --around 99", "--around 99: expected a vertex of the world, 0 … ")
    assert "shown whole" in call("world draw m3/14 --around 0").stderr


@pytest.mark.parametrize("name", ["w.gif", "svg", ""])
def test_a_name_with_another_ending_is_refused(refused: Refused, name: str) -> None:
    refused(f"world draw m2/0 -o '{name}'", "expected a name that ends in .svg, .png, .pdf, .html")


def test_a_twin_is_shown_and_drawn_beside_the_world(call: Call, results: Results) -> None:
    text = call("world show m2/7 --twin undirected -o both.svg").stdout
    assert "m2/7 has a twin without the marker's direction, m2/8, of genus 1" in text
    picture = Path("both.svg").read_text()
    assert picture.count("<svg ") == 3
    assert re.findall("<text[^>]*>(m.*?)</text>", picture) == ["m2/7, genus 0", "m2/8, genus 1"]
    view, card = re.search('viewBox="0 0 ([^"]+)"', picture), picture.partition("<rect ")[2]
    assert view is not None
    width, height = view[1].split()
    assert f'width="{width}" height="{height}"' in card[:80], "the card lies under both"
    (entry,) = results("world show m6/18704 --twin undirected")["results"]
    twin = entry["twin"]
    assert (twin["id"], twin["genus"], twin["why"], twin["file"]) == ("m6/18705", 0, "", None)
    assert results("world show m2/7")["results"][0]["twin"] is None


def test_a_world_without_a_twin_says_why(call: Call) -> None:
    text = call("world show m3/28 m1/0 --twin undirected").stdout
    assert "m3/28 has no twin without the marker's direction: no two darts look alike." in text
    assert "m1/0 has no twin without the marker's direction: a tree" in text
    assert "m2/3 has a twin without a marker" in call("world show m2/3 --twin none").stdout
