"""`topo-verify prove`: verdicts, exit codes, and what is refused."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path
from unittest.mock import Mock

import pytest

from tests.cli.conftest import Call, Refused, Results
from tests.proofs.first_order.test_theorems import spoiled
from topo_verify.proofs import catalogue as proofs_catalogue
from topo_verify.proofs.first_order.obligations import A
from topo_verify.proofs.first_order.terms import eq, neg
from topo_verify.proofs.mechanised import toolchain
from topo_verify.proofs.theorem import TheoremResult

NEGATIVE, MUTANT = (theorem.name for theorem in proofs_catalogue.CONTROLS)


def test_a_theorem_is_proved_and_the_controls_refuted(results: Results) -> None:
    envelope = results(f"prove percept {MUTANT} {NEGATIVE}")
    assert envelope["format"] == "topo-verify/prove"
    proved, mutant, negative = envelope["results"]
    assert (proved["verdict"], proved["premises_satisfiable"]) == ("PROVED", True)
    assert proved["claim"] == "true-hypothesis-kept"
    assert (mutant["verdict"], mutant["expected"], mutant["ok"]) == ("REFUTED", "REFUTED", True)
    assert (mutant["kind"], mutant["of"]) == ("mutant", "confirm-final")
    assert (negative["kind"], negative["edges"]) == ("negative", 2)
    assert negative["replayed"] == {"replayed": 1, "total": 1}


def test_the_table_shows_the_evidence_for_each_verdict(call: Call) -> None:
    done = call("prove percept undirected-any")
    assert done.exit_code == 0
    seen = " ".join(done.stdout.split())  # cells are folded
    for words in (
        "2 theorems (1 inductive, 1 negative)",
        "premises",
        "used 6",
        "replays",
        "1 of 1",
    ):
        assert words in seen
    assert "docs/proofs.md" in done.stdout


def test_the_head_names_coq_and_the_number_of_its_files(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(toolchain, "missing", Mock(return_value=""))
    monkeypatch.setattr(toolchain, "version", Mock(return_value="coqc 8.16.1"))
    monkeypatch.setattr(toolchain, "compile_all", Mock(side_effect=toolchain.Unfinished("late")))
    done = call("prove coq-confirmed")
    first, second, *_ = done.stdout.splitlines()
    assert first == "coqc 8.16.1: 1 theorem (1 mechanised)"
    assert second == "First coqc compiles 3 files and coqchk checks them again: some minutes."
    assert (done.exit_code, "UNKNOWN" in done.stdout, "late" in done.stdout) == (3, True, True)
    both = call("prove coq-confirmed percept").stdout.splitlines()[0]
    assert re.fullmatch(r"z3 .*, seed 0; coqc 8.16.1: 2 theorems .*", both)
    monkeypatch.setattr(toolchain, "missing", Mock(return_value="coqc not installed"))
    assert call("prove coq-posed").stdout.startswith("no coqc: 1 theorem (1 mechanised)\n")


def test_the_list_has_every_theorem_and_proves_none(results: Results, call: Call) -> None:
    envelope = results("prove --list")
    assert envelope["format"] == "topo-verify/prove-list"
    names = [entry["name"] for entry in envelope["results"]]
    assert len(names) == len(set(names)) > 80
    assert {entry["kind"] for entry in envelope["results"]} == {
        "inductive",
        "bounded",
        "negative",
        "mutant",
    }
    assert "induction over words" in call("prove word-trace-step --list").stdout


def test_kinds_and_sizes_are_chosen(results: Results) -> None:
    kinds = results("prove --list --kind negative")["results"]
    assert {entry["kind"] for entry in kinds} == {"negative"}
    small = results("prove --list --kind bounded --edges 2")["results"]
    assert small
    assert all(entry["edges"] <= 2 for entry in small)


def test_deep_adds_the_long_theorems(results: Results) -> None:
    usual = {entry["name"] for entry in results("prove --list")["results"]}
    deep = {entry["name"] for entry in results("prove --list --deep")["results"]}
    assert usual < deep


def test_the_questions_are_written_as_smt_lib(results: Results, folder: Path) -> None:
    results(f"prove percept {MUTANT} --smt2 there")
    texts = [(folder / "there" / f"{n}.smt2").read_text() for n in ("percept", MUTANT)]
    assert texts[0].startswith("(set-logic UF)")
    assert texts[1].startswith("(set-logic QF_UF)")
    assert all(text.rstrip().endswith("(check-sat)") for text in texts)


def test_a_question_that_cannot_be_written_is_refused(refused: Refused, folder: Path) -> None:
    (folder / "there" / "percept.smt2").mkdir(parents=True)
    refused("prove percept --smt2 there", "name another --smt2 DIR")


# ---------------------------------------------------------------- no pass is no pass


@pytest.fixture
def stocked(monkeypatch: pytest.MonkeyPatch) -> None:
    """A catalogue with theorems that do not come out as they should."""
    _, mutant = proofs_catalogue.CONTROLS
    lucky = Mock(return_value=TheoremResult(verdict="EXHAUSTED", solver="none"))
    unrefuted = dataclasses.replace(mutant, name="unrefuted", prove=lucky)
    vacuous = spoiled("vacuous", absurd=neg(eq(A, A)))
    shelf = (spoiled("unprovable"), vacuous, unrefuted)
    monkeypatch.setattr(proofs_catalogue, "catalogue", Mock(return_value=shelf))


@pytest.mark.usefixtures("stocked")
@pytest.mark.parametrize(
    ("name", "code", "verdict"),
    [("unprovable", 3, "UNKNOWN"), ("vacuous", 3, "UNKNOWN"), ("unrefuted", 1, "EXHAUSTED")],
)
def test_an_unexpected_or_vacuous_verdict_does_not_pass(
    results: Results, name: str, code: int, verdict: str
) -> None:
    (entry,) = results(f"prove {name}", code=code)["results"]
    assert (entry["ok"], entry["verdict"]) == (False, verdict)
    assert entry["note"] or entry["verdict"] != "UNKNOWN"


@pytest.mark.usefixtures("stocked")
def test_the_summary_names_what_did_not_pass(call: Call) -> None:
    done = call("prove vacuous unprovable")
    assert "VACUOUS" in done.stdout
    assert "Not as expected" in done.stdout
