"""`replay`: a counterexample's line, and traces judged again."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Call, Refused, Results
from topo_verify import families
from topo_verify.checkers import Judgement
from topo_verify.cli.runs import unjudged
from topo_verify.report.account import claim_cases
from topo_verify.robot.limits import BudgetExceeded


@pytest.fixture
def trace(call: Call, folder: Path) -> Path:
    """The trace of `basic` in m5/17."""
    call("explore m5/17 --target basic --trace basic.jsonl")
    return folder / "basic.jsonl"


def test_a_world_is_explored_anew_by_default_with_basic(results: Results) -> None:
    envelope = results("replay m5/17")
    assert envelope["format"] == "topo-verify/replay"
    (entry,) = envelope["results"]
    assert entry.keys() >= {"world", "target", "ok", "cost", "findings"}
    assert (entry["world"], entry["target"], entry["ok"], entry["trace"]) == (
        "m5/17", "basic", True, None,
    )  # fmt: skip


def test_policies_and_marker_are_taken(results: Results) -> None:
    line = "replay nyc --target basic --pick last --order newest --marker 3"
    assert results(line)["results"][0]["cost"] != results("replay nyc")["results"][0]["cost"]


def test_a_trace_is_judged_in_the_world_that_it_names(
    results: Results, call: Call, trace: Path
) -> None:
    (entry,) = results("replay basic.jsonl")["results"]
    assert (entry["world"], entry["target"], entry["cost"]) == ("m5/17", "basic", 13)
    assert entry["trace"] == "basic.jsonl"
    assert call("replay basic.jsonl").stdout == (
        "basic in m5/17, 13 edge traversals: 10 of 10 claims hold\n"
        "Nothing is wrong; --all shows the walk.\n"
    )
    (piped,) = results("replay -", trace.read_text())["results"]
    assert piped["ok"]


def test_a_trace_in_another_world_diverges_and_the_causes_are_named(
    results: Results, call: Call, trace: Path
) -> None:
    line = f"replay {trace.name} --world m5/18"
    (entry,) = results(line, code=1)["results"]
    assert {finding["claim"] for finding in entry["findings"]} >= {"percepts-true"}
    assert entry["findings"][0]["replay"] == f"topo-verify {line}"
    error = call(line).stderr
    for cause in ("another world", "another version", "edited"):
        assert cause in error


def test_an_edited_trace_is_refuted(call: Call, trace: Path) -> None:
    trace.write_text(trace.read_text().replace('"cost":13', '"cost":12'))
    done = call("replay basic.jsonl")
    assert done.exit_code == 1
    assert "!! cost-honest: the mapper reports a cost of 12" in done.stdout


@pytest.mark.nightly
def test_the_trace_of_a_large_world_needs_the_world(
    call: Call, results: Results, folder: Path
) -> None:
    families.lattice(12, 12).save(folder / "large.json")
    call("explore large.json --target basic --trace large.jsonl --marker 9")
    assert "name it with --world" in call("replay large.jsonl").stderr
    assert results("replay large.jsonl --world large.json --marker 9")["results"][0]["ok"]
    other = call("replay large.jsonl --world large.json --marker 10")
    assert other.exit_code == 1
    assert "it was recorded in another world or by another version" in " ".join(
        other.stderr.split()
    )


@pytest.mark.parametrize("option", ["--target basic", "--pick last", "--budget 5"])
def test_options_that_mean_nothing_for_a_trace_are_refused(
    refused: Refused, trace: Path, option: str
) -> None:
    refused(f"replay {trace.name} {option}", f"{option.split(maxsplit=1)[0]} with the trace")


START = '{"type": "start", "percept": {"degree": 1, "marker": 0}}'


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('{"type": "move", "door": 0, "percept": {"degree": 1, "marker": null}}', "type 'start'"),
        ('{"type": "dance"}', "line 1"),
        (START.replace('"start"', '"start", "version": 2'), "newer"),
        (START.replace('"start"', '"start", "world": "nyc"'), "expected a world id"),
        (START.replace('"start"', '"start", "world": "-"'), "expected a world id"),
        ("no JSON at all", "not valid JSON"),
        ("", "is empty"),
        ("[" * 100_000, "one JSON object"),
    ],
)
def test_a_broken_trace_is_refused_with_its_place(
    refused: Refused, folder: Path, text: str, words: str
) -> None:
    (folder / "broken.jsonl").write_text(text)
    refused("replay broken.jsonl", "broken.jsonl", words)


def test_a_run_out_of_time_is_not_decided(call: Call) -> None:
    done = call("replay nyc --target mappers.py:strolls --world-timeout 0.2")
    assert done.exit_code == 3
    assert "not decided, the mapper was stopped after 0.2 s" in " ".join(done.stdout.split())


def test_a_trace_without_an_algorithm_has_an_unknown_target(results: Results, trace: Path) -> None:
    start, *rest = trace.read_text().splitlines()
    event = json.loads(start)
    del event["algorithm"]
    trace.write_text("\n".join([json.dumps(event), *rest]))
    assert results("replay basic.jsonl")["results"][0]["target"] == "unknown"


# ---------------------------------------------------------------- the walk


def test_the_walk_to_the_first_finding_is_shown(call: Call) -> None:
    done = call("replay m2/5 --target mappers.py:ignores_direction")
    assert done.exit_code == 1
    assert "!! rejection-justified" in done.stdout
    assert "S after event" in done.stdout
    assert "true-hypothesis-kept, event 4" in done.stdout.partition("Also wrong:")[2]


def test_the_whole_walk_is_shown_where_it_is_asked_for(call: Call, trace: Path) -> None:
    done = call(f"replay {trace.name} --all")
    assert done.exit_code == 0
    assert "delivers a map" in done.stdout
    assert "\n    0  start" in done.stdout
    assert "\n    1 " not in call(f"replay {trace.name} --from 4").stdout


def test_the_walk_cannot_begin_behind_its_end(refused: Refused, trace: Path) -> None:
    for line in (f"replay {trace.name} --from 999", "replay m5/17 --from 999"):
        refused(line, "--from 999: expected an event of the run, 0 to ")


def test_the_walk_is_a_block_of_code_in_markdown(call: Call, trace: Path) -> None:
    assert "```\nA place is named by" in call(f"replay {trace.name} --all --format markdown").stdout


def test_the_log_of_a_robot_is_watched_in_its_map(call: Call) -> None:
    Path("log.csv").write_text("door,degree,marker\n,2,0\n0,2,\n1,2,1\n")
    assert "--world" in call("replay log.csv").stderr
    call("certify log.csv -o map.json")
    watched = call("replay log.csv --world map.json --player drive.html")
    assert watched.exit_code == 0
    assert watched.stdout.startswith(
        "log.csv in map, 2 edge traversals: 3 of 10 claims hold, 7 not declared\n"
        "The log proves its map.\n"
    )
    page = Path("drive.html").read_text()
    assert "<title>log.csv in map" in page
    assert "no map was delivered" not in page


def test_a_log_need_not_prove_its_map_but_fit_the_world(call: Call, results: Results) -> None:
    Path("log.csv").write_text("door,degree,marker\n,2,0\n0,2,\n")
    families.cycle(2).save("ring.json")
    assert "It does not prove its map yet" in call("replay log.csv --world ring.json").stdout
    (entry,) = results("replay log.csv --world ring.json")["results"]
    assert (entry["ok"], entry["findings"]) == (True, [])
    (entry,) = results("replay log.csv --world m2/0", code=1)["results"]
    assert {finding["claim"] for finding in entry["findings"]} == {"percepts-true"}


def test_a_trace_keeps_why_the_run_ended_without_a_map(
    call: Call, results: Results, folder: Path
) -> None:
    call("explore m3/8 --target mappers.py:walks --trace walks.jsonl")
    line = json.loads((folder / "walks.jsonl").read_text().splitlines()[0])
    assert line["stopped"] == str(BudgetExceeded(36))
    (entry,) = results("replay walks.jsonl", code=1)["results"]
    assert entry["stopped"] == line["stopped"]
    shown = call("replay walks.jsonl").stdout
    assert "no map was delivered: the mapper asked for more than 36 moves, its budget" in " ".join(
        shown.split()
    )
    assert "Events 1 to 2 repeat to the end of the run, 18 times in all." in shown


def test_a_trace_with_a_map_says_nothing_of_a_stop(results: Results, trace: Path) -> None:
    start, *rest = trace.read_text().splitlines()
    assert "stopped" not in start
    event = {**json.loads(start), "stopped": "a lie: it did deliver a map"}
    trace.write_text("\n".join([json.dumps(event), *rest]))
    (entry,) = results("replay basic.jsonl")["results"]
    assert (entry["ok"], entry["stopped"]) == (True, None)


@pytest.mark.parametrize(
    ("mapper", "words"),
    [
        (
            "CATALOGUE['basic'](robot)",
            "Not judged, because mine.py:explore delivers no map: map-entailed. ",
        ),
        (
            "robot.move(0)",
            (
                "Not judged, because mine.py:explore declares nothing about it:"
                " true-hypothesis-posed, true-hypothesis-kept, no-false-confirm,"
                " rejection-justified, decisions-entailed."
                " Not judged, because mine.py:explore delivers no map: map-entailed. "
            ),
        ),
    ],
)
def test_a_mapper_that_delivers_no_map_is_not_said_to_declare_nothing(
    call: Call, folder: Path, mapper: str, words: str
) -> None:
    text = f"from topo_verify import CATALOGUE\ndef explore(robot):\n    {mapper}\n"
    (folder / "mine.py").write_text(text)
    done = call("replay m3/14 --target mine.py:explore")
    assert done.exit_code == 1
    assert words in " ".join(done.stdout.split()) + " "


def test_what_is_declared_only_after_a_wrong_step_is_not_said_to_be_missing() -> None:
    posed = Judgement("true-hypothesis-posed", "failed", 1, 1)
    confirmed = Judgement("no-false-confirm", "not-declared", 0, 0)
    (sentence,) = unjudged("x", "m3/1", [posed, confirmed])
    assert sentence.text == (
        "Not judged, because x declares nothing about it before its first wrong step:"
        " no-false-confirm."
    )


def test_worlds_without_a_map_are_the_reason_why_map_entailed_is_judged_in_part() -> None:
    one = Judgement("map-entailed", "partial", 3, 4)
    (sentence,) = unjudged("x", "these worlds", [one])
    assert sentence.text == (
        "Judged in part, because x delivers no map in some of these worlds: map-entailed 3 of 4."
    )
    (case,) = claim_cases([one])
    assert case.message == "the mapper delivers no map in some worlds"
