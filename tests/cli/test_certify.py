"""`topo-verify certify`: logs judged with no world."""

from __future__ import annotations

import gzip
import tracemalloc
from pathlib import Path

import pytest

from tests.cli.conftest import Call, Refused, Results
from topo_verify import World

RING = """\
{"type": "start", "percept": {"degree": 2, "marker": 0}}
{"type": "move", "door": 0, "percept": {"degree": 2, "marker": null}}
{"type": "move", "door": 1, "percept": {"degree": 2, "marker": 1}}
"""


TITLES = "door,degree,marker\n"
COLUMNS = "expected the columns door, degree, marker"
NUMBER = "expected a whole number from 0 to 1000000 as"


@pytest.fixture(autouse=True)
def logs(folder: Path) -> None:
    """The logs of a ring of two, whole and cut short, in the current folder."""
    (folder / "ring.jsonl").write_text(RING)
    (folder / "short.jsonl").write_text("".join(RING.splitlines(keepends=True)[:2]))


def test_a_proved_map_is_written(results: Results) -> None:
    (entry,) = results("certify ring.jsonl -o map.json")["results"]
    assert (entry["verdict"], entry["edges"], entry["open_darts"]) == ("PROVED", 2, 0)
    assert entry["decisions"] == {"entailed": 0, "total": 0}
    assert World.load("map.json").degrees == (2, 2)


def test_an_incomplete_log_is_unknown_and_exits_3_with_its_two_worlds(
    call: Call, results: Results
) -> None:
    assert call("certify short.jsonl").exit_code == 3
    (entry,) = results("certify short.jsonl --witness there", code=3)["results"]
    assert (entry["verdict"], entry["findings"]) == ("UNKNOWN", [])
    one, other = map(World.load, entry["witnesses"])
    assert not one.is_isomorphic(other)
    assert results("certify short.jsonl", code=3)["results"][0]["witnesses"] == [one.id, other.id]


def test_a_trace_of_explore_is_a_log(call: Call, results: Results) -> None:
    call("explore m4/300 --target folding --trace trace.jsonl")
    (entry,) = results("certify trace.jsonl")["results"]
    assert entry["verdict"] == "PROVED"
    assert entry["decisions"]["entailed"] == entry["decisions"]["total"] > 0
    assert " of " in call("certify trace.jsonl").stdout


def test_standard_input_is_a_log(results: Results) -> None:
    (entry,) = results("certify -", RING)["results"]
    assert entry["verdict"] == "PROVED"


@pytest.mark.parametrize(
    "table",
    [
        "door,degree,marker\n,2,0\n0,2,\n1,2,1\n",
        "door,degree,marker\n-,2,0\n0,2,-\n1,2,1\n",
        "door,degree,marker\nNaN,2,0.0\n0.0,2,None\n1.0,2,1.0\n",
        "\ufeffTime; Marker;Degree;Door\r\n;0;2;\r\n\r\n7;;2; 0\r\n8;1;2;1\r\n",
        'marker\tdoor\tdegree\n0\t\t2\n\t0\t"2"\n1\t1\t2',
        "sep=;\ndoor;degree;marker\n;2;0\n0;2;\n1;2;1\n",
        "\ufeffsep=;\r\ndoor;degree;marker\r\n;2;0\r\n0;2;\r\n1;2;1\r\n",
        '"sep=,"\n"door","degree","marker"\n"","2","0"\n"0","2",""\n"1","2","1"\n',
        "SEP=|\ndoor|degree|marker|a,b;c\n|2|0|\n0|2||\n1|2|1|\n",
        "sep=\t\ndoor\tdegree\tmarker\n\t2\t0\n0\t2\t\n1\t2\t1\n",
        "door,degree,marker\n,2.00,0.00\n0.00,2.00,\n1.00,2.00,1.00\n",
        "door;degree;marker\n;2,0;0,00\n0,0;2,0;\n1,0;2,0;1,0\n",
        'door,degree,marker\n,"2,0",0\n0,2,\n1,2,1\n',
        "door,degree,marker\nnan,2.000e+00,0.000e+00\n0e0,2E0,nan\n1.,2.,1.0e+0\n",
        "door,degree,marker\n<NA>,2,0\n0,2,<NA>\n1,2,1\n",
        "door,degree,marker\n#N/A,2,0\n0,2,N/A\n1,2,1\n",
        "door,degree,marker\n\\N,2,0\n0,2,NULL\n1,2,1\n",
        "door,degree,marker\nNone,+2,0\n0,2,NaT\n1,2,1\n",
        "\n \n;;\ndoor;degree;marker\n;2;0\n;;\n0;2;\n \n1;2;1\n\n",
        "door,degree,marker\r,2,0\r0,2,\r1,2,1\r",
    ],
)
def test_a_csv_table_is_a_log(results: Results, table: str) -> None:
    Path("ring.csv").write_text(table, encoding="utf-8", newline="")
    (entry,) = results("certify ring.csv")["results"]
    assert (entry["verdict"], entry["edges"], entry["advice"]) == ("PROVED", 2, None)


@pytest.mark.parametrize(
    ("table", "why"),
    [
        ("door,degree\n,2\n", f"t.csv, row 1: {COLUMNS}"),
        (",2,0\n0,2,\n", "got a row without titles: begin with them"),
        ("a,degree,marker\n", f"t.csv, row 1: {COLUMNS}, got no 'door'"),
        (TITLES, "t.csv: expected a row with the percept at the start"),
        (f"{TITLES}0,2,0\n", "row 2: expected no door: the robot starts, got '0'"),
        (f"{TITLES},2,0\n,2,\n", "row 3: expected a door, as in every row but"),
        (f"{TITLES}\n,2,0\n1,two,\n", f"row 4: {NUMBER} degree, got 'two'"),
        (f"{TITLES},2,0\n1,2,-1\n", f"row 3: {NUMBER} marker, got '-1'; leave it"),
        (f"{TITLES},2,0\n1,,\n", f"row 3: {NUMBER} degree, got ''"),
        (f"{TITLES},2,0\n1,9000000,\n", "from 0 to 1000000 as degree, got '9000000'"),
        (
            f"{TITLES},2,0\n# lunch\n",
            "row 3: expected 3 cells, as in the row of titles, got 1; a table has no comments",
        ),
        (
            'door,degree,marker,note\n,2,0,"a\nb"\n',
            "row 2: expected cells of a table: unexpected end of data; a cell in quotes",
        ),
        (f"{TITLES},1,0\n0,1", "row 3: expected 3 cells, as in the row"),
        (f"{TITLES},2,0\n1,2,1,9\n", "row 3: expected 3 cells, as in the row"),
        ("door,door,degree,marker\n,,2,0\n", f"row 1: {COLUMNS}, got"),
        ("# robot 7\ndoor,degree,marker\n,2,0\n", f"row 1: {COLUMNS}"),
        ("\ufeff".encode("utf-16"), "t.csv: expected text in UTF-8, got UTF-16"),
        ("sep=;\ndoor,degree,marker\n", f"t.csv, row 2: {COLUMNS}, got no 'door'"),
        (f'{TITLES},2,0\n0,2,"\n1,2,1\n', "row 3: expected cells of a table"),
        ("sep=;\nsep=;\n", "row 2: expected the columns"),
        ("sep=;\n", "t.csv: expected a row with the percept at the start"),
        (f"{TITLES},2.5,0\n", "row 2: expected a whole number from 0 to 1000000 as deg"),
        ("door;degree;marker\n;1,000;0\n", "row 2: expected a whole number"),
        (f"{TITLES},1_0,0\n", "row 2: expected a whole number"),
        (f"{TITLES},1e99,0\n", "row 2: expected a whole number"),
        (f"{TITLES},inf,0\n", "row 2: expected a whole number"),
        (f"{TITLES},<NA>,0\n", "row 2: expected a whole number"),
        (f"{TITLES},-2,0\n", "row 2: expected a whole number"),
        (f"{TITLES}-1,2,0\n", "expected no door: the robot starts, got '-1'; leave it em"),
        (f"{TITLES}-1.00,2,0\n", "the robot starts, got '-1.00'; leave it empty"),
        (f"{TITLES},2,0\n0,2,-1\n", "got '-1'; leave it empty where no marker is seen"),
        (f"{TITLES},2,0\n0,2,-1.0\n", "got '-1.0'; leave it empty where no marker"),
        (
            gzip.compress(f"{TITLES},2,0\n".encode(), mtime=0)[:-9],
            "t.csv is packed by gzip, and damaged",
        ),
    ],
)
def test_an_error_in_a_table_names_the_row(refused: Refused, table: str | bytes, why: str) -> None:
    Path("t.csv").write_bytes(table if isinstance(table, bytes) else table.encode())
    refused("certify t.csv", why)


def test_a_marker_of_minus_1_in_json_is_told_what_to_write(refused: Refused) -> None:
    Path("log.jsonl").write_text(RING.replace('"marker": null', '"marker": -1'))
    refused("certify log.jsonl", "log.jsonl, event 1: the marker is -1: write null")


@pytest.mark.parametrize("name", ["log.csv", "log.csv.gz", "log", "log.gz", "log.txt"])
@pytest.mark.parametrize("separator", ["", "sep=,\n"])
def test_a_log_may_be_packed_and_have_any_name(results: Results, name: str, separator: str) -> None:
    table = f"{separator}door,degree,marker\n,2,0\n0,2,\n1,2,1\n".encode()
    for log in (table, RING.encode()):
        if log is table or ".csv" not in name:
            for data in (log, gzip.compress(log)):
                Path(name).write_bytes(data)
                (entry,) = results(f"certify {name}")["results"]
                assert entry["verdict"] == "PROVED"


def test_an_incomplete_log_gets_advice(call: Call, results: Results) -> None:
    (entry,) = results("certify short.jsonl", code=3)["results"]
    assert entry["advice"] == {"walk": [1], "home": [0]}
    text = " ".join(call("certify short.jsonl").stdout.split())
    assert (
        "Next, from where the log ends (place 1): take door 1, and certify the longer log." in text
    )
    assert "Back to the marker, from where the log ends: take door 0." in text


def test_a_log_that_no_world_shows_is_refuted_and_exits_1(call: Call, results: Results) -> None:
    Path("false.jsonl").write_text(RING.replace('"marker": 1', '"marker": 7'))
    (entry,) = results("certify false.jsonl", code=1)["results"]
    assert (entry["verdict"], entry["witnesses"], entry["open_doors"]) == ("REFUTED", [], [])
    assert (entry["places"], entry["place"]) == ([], None)
    text = " ".join(call("certify false.jsonl").stdout.split())
    assert "no place behind a door shows (degree 2, marker at door 7)" in text


def test_where_only_the_delivered_map_is_wrong_no_reading_is_doubted(call: Call) -> None:
    Path("wrong.jsonl").write_text(
        RING + '{"type": "finish", "cost": 2, "map":'
        ' {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}}\n'
    )
    done = call("certify wrong.jsonl")
    assert done.exit_code == 1
    assert "map-entailed" in done.stdout
    assert "wrong reading" not in done.stdout


def test_the_open_doors_are_named_with_a_way_there_and_the_worlds_that_differ(
    call: Call, results: Results
) -> None:
    (entry,) = results("certify short.jsonl", code=3)["results"]
    assert (entry["places"], entry["place"]) == ([0, 1], 1)
    assert entry["open_doors"] == [
        {"event": 1, "place": 1, "door": 1, "walk": [1]},
        {"event": 0, "place": 0, "door": 1, "walk": [0, 1]},
    ]
    text = " ".join(call("certify short.jsonl").stdout.split())
    assert "1 move; true of several worlds, with 2 doors not known to have been crossed" in text
    assert "door 1 of place 1 (reached at event 1): from where the log ends, take door 1" in text
    assert "door 1 of place 0 (the first): from where the log ends, take doors 0, 1" in text
    assert "Two of the worlds that show this log; infinitely many do" in text
    assert "short.jsonl ? UNKNOWN - - 2 none declared" in text


def test_a_picture_shows_what_is_known_and_each_open_door_dotted(
    call: Call, refused: Refused
) -> None:
    call("certify short.jsonl --draw known.svg")
    known = Path("known.svg").read_text()
    assert "2 places, 2 open doors" in known
    assert known.count('class="tv-stub"') == 2
    assert known.count("data-vertex=") == 2
    assert known.count("<title>here</title>") == 1
    call("certify ring.jsonl --draw whole.svg")
    assert 'class="tv-stub"' not in Path("whole.svg").read_text()
    refused("certify short.jsonl ring.jsonl --draw known.svg", "expected one TRACE, got 2")
    done = call("certify ring.jsonl --draw missing/known.svg")
    assert done.exit_code == 3
    assert "PROVED" in done.stdout
    assert "--draw missing/known.svg: not written: " in done.stderr
    refused("certify ring.jsonl --draw known.txt", "expected a name that ends in .svg, .png")
    refused("certify ring.jsonl -o map.svg", "expected a name for data, as w.json")


def test_a_map_that_does_not_fit_in_the_plane_is_remarked(call: Call, results: Results) -> None:
    call("explore m2/8 --target basic --trace torus.jsonl")  # two loops that cross
    (entry,) = results("certify torus.jsonl")["results"]
    assert (entry["verdict"], entry["genus"]) == ("PROVED", 1)
    assert "does not fit in the plane (genus 1)" in call("certify torus.jsonl").stdout
    assert "does not fit" not in call("certify ring.jsonl").stdout


def test_a_contradiction_in_a_table_names_its_row(call: Call) -> None:
    Path("t.csv").write_text("door,degree,marker\n,2,0\n\n0,2,\n\n0,3,\n")
    text = " ".join(call("certify t.csv").stdout.split())
    assert "map-entailed, event 2: no world shows this history" in text
    assert "Event 2 is row 6 of t.csv." in text
    assert "The readings of event 0 (row 2) and event 2 (row 6) would be of one place." in text
    Path("turned.csv").write_text("door,degree,marker\n,2,0\n0,2,\n0,2,1\n")
    text_of_turned = " ".join(call("certify turned.csv").stdout.split())
    assert "perhaps the marker pointed at another door" in text_of_turned
    assert "The readings of" not in text_of_turned
    Path("t.jsonl").write_text(RING.replace('"marker": 1', '"marker": 7') + "\n")
    assert "Event 2 is line 3 of t.jsonl." in " ".join(call("certify t.jsonl").stdout.split())
    assert "t.csv ! REFUTED - - - none declared" in text


def test_an_edge_walked_five_times_is_proved(results: Results) -> None:
    start, there, back = (
        '{"type": "start", "percept": {"degree": 1, "marker": 0}}\n',
        '{"type": "move", "door": 0, "percept": {"degree": 1, "marker": null}}\n',
        '{"type": "move", "door": 0, "percept": {"degree": 1, "marker": 0}}\n',
    )
    log = start + there + back + there + back + there
    assert results("certify -", log)["results"][0]["verdict"] == "PROVED"


def test_a_long_patrol_takes_no_memory_but_eight_bytes_a_move(results: Results) -> None:
    start, there, back = RING.splitlines(keepends=True)
    again = there.replace('"door": 0', '"door": 1') + back
    Path("patrol.jsonl").write_text(start + there + back + again * 5000)
    results("certify patrol.jsonl")  # imports what it needs
    tracemalloc.start()
    (entry,) = results("certify patrol.jsonl")["results"]
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert entry["verdict"] == "PROVED"
    assert peak < 1_100_000  # its bytes alone are 660,000; 10,000 events apart took 4.6 million


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("certify nowhere.jsonl", "nowhere.jsonl"),
        ("certify ring.jsonl short.jsonl -o map.json", "expected one TRACE, got 2"),
        ("certify short.jsonl --witness ring.jsonl", "cannot create this folder"),
        ("certify doubled.jsonl", "doubled.jsonl, line 2: the key 'door' stands twice"),
        ("certify wide.jsonl", "wide.jsonl: the places of this log have 3000000 doors together"),
    ],
)
def test_bad_input_gets_one_sentence(refused: Refused, line: str, why: str) -> None:
    start, there, _ = RING.splitlines(keepends=True)
    Path("doubled.jsonl").write_text(start + there.replace("{", '{"door": 1, ', 1))
    wide = start + (there + there.replace(": 0", ": 1")) * 2
    Path("wide.jsonl").write_text(wide.replace('"degree": 2', '"degree": 1000000', 3))
    refused(line, why)


def test_a_witness_too_large_for_an_id_is_named_by_its_size(call: Call) -> None:
    Path("large.jsonl").write_text('{"type": "start", "percept": {"degree": 300, "marker": 0}}\n')
    assert "a world of 300 edges (--witness DIR writes it)" in call("certify large.jsonl").stdout
