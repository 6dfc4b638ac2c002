"""What was judged only in part, not asked or not decided is shown, and never counted as held."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import msgspec
import pytest

from tests.cli.conftest import Call, Results
from tests.helpers import trace_of
from topo_verify.campaign import judge
from topo_verify.checkers import Judgement, check, claims
from topo_verify.robot.events import write_trace

PARTIAL = {
    "true-hypothesis-posed",
    "true-hypothesis-kept",
    "rejection-justified",
    "decisions-entailed",
}


def statuses(entry: dict[str, Any]) -> dict[str, str]:
    """The status of each judgement of an entry; it is the one that `claims` names."""
    assert all(set(one) >= {"claim", "status", "judged", "of"} for one in entry["judgements"])
    return {one["claim"]: one["status"] for one in entry["judgements"]}


def test_a_run_judged_in_part_is_shown_as_such(results: Results, call: Call) -> None:
    line = "explore nyc --target mappers.py:curt --in-process"
    (entry,) = results(line)["results"]
    assert statuses(entry) == entry["claims"]
    assert entry["ok"]
    assert {claim for claim, status in entry["claims"].items() if status == "partial"} == PARTIAL
    posed = next(one for one in entry["judgements"] if one["claim"] == "true-hypothesis-posed")
    assert (posed["judged"], posed["of"], posed["findings"]) == (1, 73, [])
    text = " ".join(call(line).stdout.split())
    assert "5 of 10 hold, 4 partial, 1 not declared" in text
    assert (
        "Judged in part, because mappers.py:curt left decisions undeclared or ended early" in text
    )
    assert "true-hypothesis-posed 1 of 73" in text


@pytest.mark.long
def test_a_search_and_a_report_over_many_worlds_say_so_as_well(
    results: Results, call: Call
) -> None:
    for command in (
        "search mappers.py:curt --edges 3 --workers 0 --in-process",
        "conform mappers.py:curt --worlds edges<=3 --workers 0 --in-process",
    ):
        entries = results(command)["results"]
        seen = {claim: status for entry in entries for claim, status in statuses(entry).items()}
        assert seen["true-hypothesis-posed"] == "partial"
        assert seen["map-isomorphic"] == "ok"
        assert "Judged in part, because mappers.py:curt" in " ".join(call(command).stdout.split())


def test_findings_stand_in_the_judgement_of_their_claim_too(results: Results) -> None:
    (entry,) = results("replay m3/14 --target mappers.py:guesses --in-process", code=1)["results"]
    inside = [found for one in entry["judgements"] for found in one["findings"]]
    assert inside == entry["findings"]
    assert statuses(entry) == entry["claims"]


@pytest.fixture
def undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let claim 10 be undecided in every run."""

    def checked(*run: Any, **more: Any) -> Sequence[Judgement]:
        *others, last = check(*run, **more)
        return [*others, msgspec.structs.replace(last, status="undecided", judged=last.of - 1)]

    monkeypatch.setattr(judge, "check", checked)


@pytest.mark.usefixtures("undecided")
@pytest.mark.parametrize(
    "line",
    [
        "explore m3/14 --target basic",
        "replay m3/14 --target basic",
        "replay trace.jsonl",
        "search basic --edges 2 --workers 0",
        "conform basic --worlds edges<=2 --workers 0",
        "record basic --worlds edges<=2 --out base.gz",
    ],
)
def test_an_undecided_claim_leaves_the_command_incomplete(
    results: Results, folder: Path, line: str
) -> None:
    (folder / "trace.jsonl").write_bytes(write_trace(trace_of("m3/14")))
    envelope = results(line, code=3)
    assert not envelope["ok"]
    verdicts = {entry.get("verdict") for entry in envelope["results"]}
    assert not verdicts & {"EXHAUSTED", "SAMPLED", "REFUTED"} or "conform" in line


@pytest.mark.usefixtures("undecided")
def test_an_undecided_claim_is_named(call: Call) -> None:
    text = " ".join(call("explore m3/14 --target basic").stdout.split())
    assert "9 of 10 hold, 1 undecided" in text
    assert "Neither proved nor refuted in m3/14: decisions-entailed" in text


# ---------------------------------------------------------------- not asked


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let claim 10 be asked only up to two edges."""
    for module in (claims, judge):
        monkeypatch.setattr(module, "LARGE", 2)


@pytest.mark.usefixtures("small")
@pytest.mark.parametrize(
    "line",
    [
        "explore m3/14 --target basic",
        "replay m3/14 --target basic",
        "conform basic --worlds m3/14 --workers 0",
    ],
)
def test_what_is_not_asked_is_said_and_asked_with_strict(
    results: Results, call: Call, line: str
) -> None:
    for option, status in (("", "not-asked"), (" --strict", "ok")):
        entries = results(line + option)["results"]
        seen = {claim: one for entry in entries for claim, one in statuses(entry).items()}
        assert seen["decisions-entailed"] == status
        text = " ".join(call(line + option).stdout.split())
        assert ("Not asked in worlds over" in text) == (status == "not-asked")


@pytest.mark.usefixtures("small")
@pytest.mark.parametrize(
    "line",
    [
        "explore m3/14 --target mappers.py:guesses --in-process",
        "conform mappers.py:guesses --worlds m3/14 --workers 0 --in-process",
    ],
)
def test_the_line_that_shows_a_finding_again_asks_as_much(
    results: Results, call: Call, line: str
) -> None:
    findings = results(f"{line} --strict", code=1)["results"][0]["findings"]
    assert all(" --strict" in finding["replay"] for finding in findings)
    again = findings[0]["replay"].removeprefix("topo-verify ")
    assert call(again).exit_code == 1
    for finding in results(line, code=1)["results"][0]["findings"]:
        assert "--strict" not in finding["replay"]
