"""An implementation in every world of a corpus: levels, verdicts, workers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
import pytest

from tests.programs.programs import compiled, conforming, javascript, misbehaving
from topo_verify.campaign.backend import pooled
from topo_verify.errors import InputError
from topo_verify.robot.events import Start, read_trace
from topo_verify.robot.limits import BudgetExceeded, Limits
from topo_verify.studies.conform.batch import batched
from topo_verify.studies.conform.conform import MOST_TIMEOUTS, LevelResult
from topo_verify.studies.corpus import corpus_from

EXAMPLES = Path(__file__).parents[3] / "examples"

MAPPERS = f"{Path(__file__).parents[2] / 'cli' / 'mappers.py'}"


def standings(
    target: str, *texts: str, workers: int = 0, batch: bool = False, **more: Any
) -> dict[str, LevelResult]:
    study = conforming(target, corpus_from(texts), drawn=not batch, **more)
    study.work(batched if batch else pooled(workers))
    return {standing.level: standing for standing in study.level_results()}


def verdicts(found: dict[str, LevelResult]) -> list[str]:
    return [standing.verdict for standing in found.values()]


def test_a_reference_is_like_itself_on_every_level() -> None:
    found = standings("enhancement-ii", "edges<=3", like="enhancement-ii")
    assert list(found) == ["result", "claims", "decisions", "cost"]
    assert verdicts(found) == ["EXHAUSTED"] * 4
    assert {standing.passed for standing in found.values()} == {86}
    assert found["cost"].cost.ratio == 1.0
    assert len(found["cost"].priced) == 86


def test_a_corpus_that_is_no_finite_class_is_sampled() -> None:
    assert verdicts(standings("basic", "edges<=2", "nyc")) == ["SAMPLED"] * 3


def test_each_level_is_reported_apart() -> None:
    found = standings("basic", "m4/41", "m1/0", like="enhancement-ii")
    assert [(s.passed, s.failed) for s in found.values()] == [(2, 0), (2, 0), (1, 1), (2, 0)]
    (parted,) = found["decisions"].findings
    assert parted.world == "m4/41"
    assert parted.message.startswith("enhancement-ii rejects that edge 7 leads to 4 (by history)")
    cost = found["cost"].cost
    assert (cost.mapper, cost.reference, cost.ratio) == (12, 10, 1.2)


def test_policies_are_those_of_the_reference() -> None:
    world = "family:lattice(3,3)"
    alike = standings("basic", world, like="basic")
    assert alike["decisions"].passed == 1
    other = standings("basic", world, like="basic", pick="last")
    assert other["decisions"].failed == 1


def test_a_mapper_that_declares_nothing_is_never_said_to_decide_alike() -> None:
    found = standings(f"{MAPPERS}:silent", "edges<=2", like="enhancement-i")
    assert found["result"].passed == 12
    assert found["decisions"].not_declared == 12
    assert found["decisions"].verdict == "UNKNOWN"
    assert found["claims"].claims["rejection-justified"] == {"not-declared": 12}


def test_claims_fail_on_their_own_level() -> None:
    found = standings(f"{MAPPERS}:ignores_direction", "edges<=2")
    assert found["result"].verdict == found["claims"].verdict == "REFUTED"
    assert "true-hypothesis-kept" in found["claims"].kinds
    assert "true-hypothesis-kept" not in found["result"].kinds


def test_costs_are_those_of_worlds_that_are_mapped_rightly() -> None:
    found = standings(f"{MAPPERS}:guesses", "edges<=2")
    assert found["cost"].passed == found["result"].passed < 12
    assert len(found["cost"].priced) == found["cost"].passed


def test_a_python_mapper_that_ends_its_worker_is_a_finding(tmp_path: Path) -> None:
    mapper = tmp_path / "deadly.py"
    mapper.write_text(
        "import os\nimport topo_verify as tv\n"
        "def explore(robot):\n"
        "    if robot.percept.degree == 2:\n        os._exit(9)\n"
        "    return tv.CATALOGUE['basic'](robot)\n"
    )
    found = standings(f"{mapper}:explore", "m1/0", "m1/1", "m2/0", workers=2)
    assert found["result"].kinds == {"worker-lost": 1}
    assert found["result"].passed == 2
    assert "exit code 9" in found["result"].findings[0].message


def test_a_program_that_hangs_in_each_of_the_first_worlds_is_not_tried_in_the_rest() -> None:
    limits = Limits(move_timeout=0.06)
    found = standings(misbehaving("hangs"), *["m1/1"] * 8, limits=limits)
    assert (found["result"].failed, found["result"].not_tried) == (3, 5)


@pytest.mark.nightly
def test_after_many_time_outs_the_rest_is_not_tried(tmp_path: Path) -> None:
    mapper = tmp_path / "stuck.py"
    mapper.write_text(
        "import time\nimport topo_verify as tv\n"
        "def explore(robot):\n"
        "    if robot.percept.degree == 2:\n        time.sleep(60)\n"
        "    return tv.CATALOGUE['basic'](robot)\n"
    )
    texts = ["m1/0", *["m1/1"] * (MOST_TIMEOUTS + 5)]
    found = standings(f"{mapper}:explore", *texts, limits=Limits(move_timeout=0.06))
    assert (found["result"].passed, found["result"].failed) == (1, MOST_TIMEOUTS)
    assert found["result"].not_tried == 5


def test_worlds_that_are_declined_leave_the_verdict_open() -> None:
    found = standings(misbehaving("skips"), "edges<=1")
    assert (found["result"].passed, found["result"].skipped) == (1, 1)
    assert verdicts(found) == ["UNKNOWN"] * 3
    assert found["result"].why == ("m1/1: the program skips this world: no loops, please",)


@pytest.mark.parametrize("workers", [0, 2])
@pytest.mark.parametrize(
    ("target", "like", "words"),
    [
        ("basic", "nothing", "nothing"),
        ("--cmd /no/such/program", "", "cannot start"),
        ("nowhere.py:explore", "", "no file"),
    ],
)
def test_bad_input_is_told_whoever_meets_it(
    target: str, like: str, words: str, workers: int
) -> None:
    with pytest.raises(InputError, match=words):
        standings(target, "edges<=1", like=like, workers=workers)


# ---------------------------------------------------------------- transcripts


def test_of_a_failing_world_what_was_said_is_kept(tmp_path: Path) -> None:
    standings(misbehaving("says an unknown type"), "edges<=1", transcript=str(tmp_path))
    (file,) = tmp_path.iterdir()
    assert file.name == "m1-1.jsonl"
    head, *lines = map(msgspec.json.decode, file.read_text().splitlines())
    assert (head["format"], head["version"]) == ("topo-verify/transcript", 1)
    assert head["world"] == "m1/1"
    assert '"start"' in lines[0]["to"]
    assert lines[1] == {"from": '{"type": "teleport", "to": 5}'}
    assert "teleport" in lines[2]["found"]


def test_of_a_python_mapper_the_trace_is_kept(tmp_path: Path) -> None:
    standings(f"{MAPPERS}:guesses", "m2/0", "family:path(4)", transcript=str(tmp_path))
    names = sorted(file.name for file in tmp_path.iterdir())
    assert names[0] == "family-path(4)-" + names[0].split("-")[-1]
    assert names[1] == "m2-0.jsonl"
    assert '"type":"start"' in (tmp_path / names[1]).read_text()


def test_a_trace_that_is_kept_says_why_the_run_ended(tmp_path: Path) -> None:
    standings(f"{MAPPERS}:walks", "m2/0", transcript=str(tmp_path))
    start = read_trace((tmp_path / "m2-0.jsonl").read_bytes())[0]
    assert isinstance(start, Start)
    assert start.stopped == str(BudgetExceeded(30))


# ---------------------------------------------------------------- the examples


@pytest.mark.nightly
@pytest.mark.parametrize("language", ["c", "js", "python", "short python"])
def test_the_examples_decide_as_the_reference_event_for_event(
    language: str, tmp_path: Path
) -> None:
    target = {
        "c": lambda: compiled(EXAMPLES / "mapper_c" / "mapper.c", tmp_path),
        "js": lambda: javascript(EXAMPLES / "mapper_js" / "mapper.js"),
        "python": lambda: f"{EXAMPLES / 'mapper_python' / 'mapper.py'}:explore",
        "short python": lambda: f"{EXAMPLES / 'mapper_python' / 'short.py'}:explore",
    }[language]()
    found = standings(target, "corpus", like="basic", validate=True)
    assert verdicts(found) == ["SAMPLED"] * 4, found["decisions"].findings[:1]
    assert {standing.passed for standing in found.values()} == {953}


@pytest.mark.long
@pytest.mark.parametrize(
    ("language", "first", "words"),
    [
        ("c", "m3/5", "asked for more than 69 moves"),
        ("js", "m2/5", "asked for more than 16 moves"),
        ("python", "m2/4", "is not isomorphic to the true map"),
    ],
)
def test_the_wrong_examples_are_found_out(
    language: str, first: str, words: str, tmp_path: Path
) -> None:
    target = {
        "c": lambda: compiled(EXAMPLES / "mapper_c" / "mapper.c", tmp_path, "-DWRONG"),
        "js": lambda: javascript(EXAMPLES / "mapper_js" / "mapper.js") + " --wrong",
        "python": lambda: f"{EXAMPLES / 'mapper_python' / 'wrong.py'}:explore",
    }[language]()
    found = standings(target, "edges<=3", like="basic")
    assert found["result"].verdict == "REFUTED"
    assert found["result"].findings[0].world == first
    assert words in found["result"].findings[0].message
    assert first in (EXAMPLES.parent / "docs" / "oracle.md").read_text()
