"""The theorems proved in Coq, as theorems of the catalogue."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.proofs.mechanised.conftest import LIMIT, nowhere
from topo_verify.proofs.mechanised import theorems, toolchain
from topo_verify.proofs.mechanised.theorems import MECHANISED, STATEMENTS
from topo_verify.proofs.theorem import Budget

NAMES = tuple(one.name for one in STATEMENTS)

CHECKED = "Theory: Set is predicative; Axioms: <none>"


@pytest.fixture(autouse=True)
def afresh() -> Iterator[None]:
    """What was found is kept for the rest of a run; not from one test to the next."""
    theorems.library.cache_clear()
    yield
    theorems.library.cache_clear()


def test_each_statement_is_a_theorem_that_is_expected_to_be_proved() -> None:
    assert [theorem.name for theorem in MECHANISED] == [one.name for one in STATEMENTS]
    for theorem in MECHANISED:
        assert (theorem.kind, theorem.expected, theorem.deep) == ("mechanised", "PROVED", True)
        assert list(theorem.queries()) == []


def test_without_coq_nothing_is_known_and_the_way_to_get_it_is_told(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("shutil.which", nowhere)
    outcome = MECHANISED[0].prove(Budget())
    assert outcome.verdict == "UNKNOWN"
    assert "apt-get install --no-install-recommends coq" in outcome.note
    assert MECHANISED[0].status(outcome) == "open"


def test_what_takes_too_long_is_unknown(monkeypatch: pytest.MonkeyPatch, library: Path) -> None:
    del library
    monkeypatch.setattr(theorems, "LONGER", 1)
    outcome = MECHANISED[0].prove(Budget(timeout=0.01))
    assert outcome.verdict == "UNKNOWN"
    assert "longer than 0.01 seconds" in outcome.note


def test_the_theorems_rest_on_no_axiom(place: Path) -> None:
    assert theorems.asked(place, NAMES, timeout=LIMIT) == toolchain.NO_AXIOMS


def test_theorems_that_rest_on_an_axiom_are_not_proved(
    monkeypatch: pytest.MonkeyPatch, place: Path
) -> None:
    (place / "Gap.v").write_text("Axiom gap : False.\nLemma a : False.\nProof. exact gap. Qed.\n")
    assert toolchain.compile_one(place, "Gap", timeout=LIMIT).accepted
    gap = theorems.MechanisedStatement("coq-gap", "Gap", "a", (), "False.")
    monkeypatch.setattr(theorems, "STATEMENTS", (*STATEMENTS, gap))
    assert "Gap.gap : False" in theorems.asked(place, ("coq-gap",), timeout=LIMIT)
    assert theorems.asked(place, ("coq-posed",), timeout=LIMIT) == toolchain.NO_AXIOMS


def test_a_library_with_a_gap_is_refused(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, library: Path
) -> None:
    del library
    gap, empty = tmp_path / "gap", tmp_path / "empty"
    gap.mkdir()
    empty.mkdir()
    (gap / "_CoqProject").write_text("A.v\n")
    (gap / "A.v").write_text("Lemma a : False.\nAdmitted.\n")
    monkeypatch.setattr(toolchain, "SOURCES", gap)
    why = theorems.examine(empty, (), ("A",), timeout=LIMIT).why
    assert why == "A.v claims without proof: Admitted"
    (gap / "A.v").write_text("Lemma a : False.\nProof. auto. Qed.\n")
    assert "coqc refuses" in theorems.examine(empty, (), ("A",), timeout=LIMIT).why


def test_a_theorem_needs_the_files_behind_it_and_all_theorems_need_every_file() -> None:
    confirmed = ("World", "Rotation", "Embedding")
    assert theorems.needed(["coq-confirmed", "no theorem in Coq"]) == confirmed
    assert theorems.needed(NAMES) == toolchain.files()


def test_what_is_said_of_all_worlds_runs_or_mappers_is_compiled_with_one_of_them() -> None:
    assert theorems.in_coq("Rotation", "edge_alone_world").startswith("edge_alone_world : world")
    for row in STATEMENTS:
        rests_on, files = toolchain.required(row.file), theorems.needed([row.name])
        assert "Rotation" in files
        assert "Run" not in rests_on or "RunExists" in files
        assert "Mapper" not in rests_on or "Examples" in files


def test_the_symbols_are_the_statement_in_its_file_with_the_variables_of_its_section() -> None:
    symbols = {theorem.name: theorem.symbols for theorem in MECHANISED}
    assert symbols["coq-confirmed"] == (
        "Topo.Embedding.confirm, in proofs/coq/Embedding.v: Variables (M W : Map) (phi : nat -> "
        "nat). Hypotheses (WM : is_map M) (WW : is_map W) (E : embedded M W phi). confirm a h w c "
        "r j : a < darts W -> h < darts M -> walk W a w = Some c -> walk M h w = Some r -> marker "
        "M r = Some j -> marker W c = Some j -> a = phi h."
    )
    assert (
        "in proofs/coq/Algorithms.v: basic_correct : maps_all basic. Definition maps_all (A : "
        "algorithm) := forall pick path order W, good_pick pick -> "
    ) in symbols["coq-basic"]
    assert symbols["coq-basic"].endswith(" (vertices W + (2 * m - 1) * (2 * (vertices W - 1))).")
    for text in symbols.values():
        assert text.endswith(".")
        assert not {"(*", "Proof", "Theorem", "Lemma", "Qed"} & {*text.split()}


@pytest.mark.nightly
@pytest.mark.usefixtures("linked")
def test_the_whole_compiled_library_is_checked_again() -> None:
    for theorem in MECHANISED:
        outcome = theorem.prove(Budget(timeout=LIMIT, together=NAMES))
        assert theorem.ok(outcome), outcome.note
        assert CHECKED in outcome.note
