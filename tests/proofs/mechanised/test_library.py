"""The sources in Coq: complete, readable, without gaps; and that each check here can fail."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.proofs.mechanised.conftest import LIMIT
from topo_verify.checkers import CLAIMS
from topo_verify.proofs.mechanised import toolchain
from topo_verify.proofs.mechanised.theorems import STATEMENTS

ITEM = re.compile(
    r"^(?:Theorem|Lemma|Corollary|Definition|Fixpoint|Inductive|Record|Example|Ltac) ([\w']+)",
    re.MULTILINE,
)
"""A definition or a theorem, and its name."""


def sources() -> dict[str, str]:
    """The text of every source, by its name."""
    return {path.stem: path.read_text() for path in sorted(toolchain.SOURCES.glob("*.v"))}


def unused(texts: Mapping[str, str]) -> set[str]:
    """What is stated and never spoken of again; of an inductive type, its constructors count."""
    words = re.compile(r"[\w']+")
    plain = [toolchain.without_comments(text) for text in texts.values()]
    spoken = Counter(word for text in plain for word in words.findall(text))
    found: set[str] = set()
    for text in plain:
        for item in ITEM.finditer(text):
            body = text[item.start() : text.find("\n\n", item.start())]
            names = {item[1], *re.findall(r"[:|]=? *([A-Z]\w*) \(", body)}
            if max(spoken[name] for name in names) < 2:
                found.add(item[1])
    return found


def unexplained(text: str) -> list[str]:
    """The definitions and theorems that do not open with a comment."""
    lines = text.splitlines()
    items = [(i, found[1]) for i, line in enumerate(lines) if (found := ITEM.match(line))]
    return [name for i, name in items if i == 0 or not lines[i - 1].rstrip().endswith("*)")]


PAPER = Path(__file__).parents[3] / "docs" / "explanation" / "paper.md"
"""The page that goes through the paper sentence by sentence."""

CITED = re.compile(r"\bPaper, ([^:]+): (.+)$")
"""The end of a comment that names a statement of the paper, with its section, in our words."""


def sentences() -> set[tuple[str, str]]:
    """The sentences of the paper, each with its section, as the page about them has them."""
    table = PAPER.read_text(encoding="utf-8").partition("## Sentence by sentence")[2]
    rows = re.findall(r"^\| (\S[^|]*) \| (\S[^|]*) \|", table.partition("\n## ")[0], re.MULTILINE)
    return {(section, sentence) for section, sentence in rows}


def sourceless(text: str, theorem: str) -> bool:
    """Whether the words above a theorem name no sentence of the paper, nor say that it has none."""
    before = re.split(
        rf"^(?:Theorem|Lemma|Corollary|Example) {theorem}\b", text, flags=re.MULTILINE
    )
    comment = before[0].rpartition("(**")[2].strip()
    words = " ".join(comment.removesuffix("*)").split())
    stated = words.endswith(". Not in the paper.")
    cited = CITED.search(words)
    named = cited is not None and cited.start() > 0 and cited.groups() in sentences()
    return not comment.endswith("*)") or not (stated or named)


PROOFS = (Path(__file__).parents[3] / "docs" / "proofs.md").read_text(encoding="utf-8")
"""The page that maps each claim to its theorems."""


# ---------------------------------------------------------------- without Coq


def test_the_project_file_lists_every_source_but_the_extraction() -> None:
    assert set(toolchain.files()) == sources().keys() - {"Extract", "ExtractJudge", "Checked"}


def test_each_source_is_listed_after_those_that_it_needs() -> None:
    for name in toolchain.files():
        assert toolchain.required(name)[-1] == name


def test_nothing_is_claimed_without_proof() -> None:
    assert {
        name: words for name, t in sources().items() if (words := toolchain.claims_unproved(t))
    } == {}


@pytest.mark.parametrize(
    "gap",
    ["Admitted.", "Axiom a : False.", "Parameter p : nat.", "admit.", "Unset Guard Checking.",
     "Conjecture c : False.", "Proof. give_up."],
)  # fmt: skip
def test_each_way_to_claim_without_proof_is_seen(gap: str) -> None:
    assert toolchain.claims_unproved(f"(* no Axiom here *)\n{gap}\n")
    assert not toolchain.claims_unproved(f"(* {gap} *)")


def test_every_definition_and_theorem_opens_with_its_meaning() -> None:
    assert {name: lost for name, text in sources().items() if (lost := unexplained(text))} == {}
    assert unexplained("Lemma a : True.\n(** Told. *)\nLemma b : True.") == ["a"]


def test_every_theorem_of_the_catalogue_names_the_papers_sentence_or_says_that_there_is_none() -> (
    None
):
    texts = sources()
    assert [one.name for one in STATEMENTS if sourceless(texts[one.file], one.theorem)] == []


BOUND = "Paper, I: The worst case is O(m²n) edge traversals."


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (BOUND, ""),
        (BOUND, "Not in another paper."),
        (BOUND, BOUND.replace("m²n", "n")),
        (BOUND, BOUND.replace("I", "II-C")),
        ("*)\nTheorem", "*)\nDefinition other := 0.\nTheorem"),
    ],
    ids=["left out", "neither", "another sentence", "another section", "not directly above"],
)
def test_a_theorem_without_the_papers_sentence_is_found(old: str, new: str) -> None:
    text = f"(** The bound is so large.\n    {BOUND} *)\nTheorem bound_order m n : True."
    assert not sourceless(text, "bound_order")
    assert sourceless(text.replace(old, new), "bound_order")


def test_no_file_is_too_long_and_no_line_too_wide() -> None:
    for name, text in sources().items():
        assert len(text.splitlines()) <= 400, name
        assert max(map(len, text.splitlines())) <= 105, name


def test_no_lemma_is_unused_but_the_theorems_that_the_page_names() -> None:
    named = set(re.findall(r"`(?:\w+\.)?(\w+)`", PROOFS)) | {one.theorem for one in STATEMENTS}
    assert unused(sources()) <= named
    assert unused({"A": "Lemma a : True.\n\nLemma b : True. apply a.\n\n"}) == {"b"}


def test_the_page_maps_every_claim_to_theorems_that_are_there() -> None:
    rows = re.findall(r"^\| \d+ `([\w-]+)` \| (.+) \|$", PROOFS, re.MULTILINE)
    assert [claim for claim, _ in rows] == list(CLAIMS)
    stated = {(name, item[1]) for name, text in sources().items() for item in ITEM.finditer(text)}
    for _, theorems in rows:
        named = set(re.findall(r"`(\w+)\.(\w+)`", theorems))
        assert named
        assert named <= stated


def test_every_theorem_of_the_catalogue_is_in_its_file() -> None:
    texts = sources()
    for one in STATEMENTS:
        assert one.theorem in {item[1] for item in ITEM.finditer(texts[one.file])}, one.name
    assert len({one.name for one in STATEMENTS}) == len(STATEMENTS)
    assert {claim for one in STATEMENTS for claim in one.claims} == set(CLAIMS)


# ---------------------------------------------------------------- with Coq


def test_an_axiom_is_named_by_coqchk(place: Path) -> None:
    (place / "Gap.v").write_text("Axiom gap : False.\n")
    (place / "Whole.v").write_text("Definition whole := I.\n")
    assert toolchain.compile_all(place, ["Gap", "Whole"], timeout=LIMIT).accepted
    refused = toolchain.recheck(place, ["Gap"], timeout=LIMIT)
    assert not refused.accepted
    assert "Topo.Gap.gap" in refused.output
    assert toolchain.recheck(place, ["Whole"], timeout=LIMIT).accepted


@pytest.mark.nightly
@pytest.mark.rare
def test_no_proof_relies_on_a_name_that_coq_chose(library: Path, tmp_path: Path) -> None:
    del library
    toolchain.copy_library(tmp_path, toolchain.files())
    mangled = ["-mangle-names", "_mangled"]
    ran = toolchain.compile_all(tmp_path, toolchain.files(), timeout=LIMIT, flags=mangled)
    assert ran.accepted, ran.output
    (tmp_path / "Chosen.v").write_text(
        "Lemma chosen : forall n : nat, n = n.\nProof. intros. induction n; reflexivity. Qed.\n"
    )
    assert toolchain.compile_one(tmp_path, "Chosen", timeout=LIMIT).accepted
    assert not toolchain.compile_one(tmp_path, "Chosen", timeout=LIMIT, flags=mangled).accepted


@pytest.mark.skipif(bool(toolchain.missing()), reason="Coq is not installed")
def test_a_source_waits_for_what_it_needs_and_nothing_is_compiled_after_a_refusal(
    tmp_path: Path,
) -> None:
    (tmp_path / "Base.v").write_text("Definition base := I.\n")
    (tmp_path / "Needs.v").write_text("From Topo Require Import Base.\nDefinition a := base.\n")
    (tmp_path / "Wrong.v").write_text("From Topo Require Needs.\nDefinition b := base.\n")
    (tmp_path / "Behind.v").write_text("From Topo Require Import Wrong.\n")
    counts: list[int] = []
    ran = toolchain.compile_all(tmp_path, ["Needs", "Base"], timeout=LIMIT, compiled=counts.append)
    assert (ran.accepted, counts) == (True, [0, 1])
    refused = toolchain.compile_all(tmp_path, ["Behind", "Wrong", "Needs", "Base"], timeout=LIMIT)
    assert not refused.accepted
    assert "base" in refused.output
    assert not (tmp_path / "Behind.vo").exists()


def test_a_call_that_takes_too_long_is_no_refusal(place: Path) -> None:
    (place / "Long.v").write_text("Goal True. do 100000000 idtac. Abort.\n")
    with pytest.raises(toolchain.Unfinished, match=r"coqc took longer than 0\.5 seconds"):
        toolchain.compile_one(place, "Long", timeout=0.5)
