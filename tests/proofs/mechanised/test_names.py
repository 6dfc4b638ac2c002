"""One name for one thing in Coq: all files can be imported together, in any order.

Coq lets a later import hide the names of an earlier one, so a file that imports two homonyms means
by the name whichever came last. No file of ours does that by accident: every public name is unique
over the library, and none hides a name of the standard modules that the library imports.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

import pytest

from tests.proofs.mechanised.conftest import LIMIT
from tests.proofs.mechanised.test_library import sources
from topo_verify.proofs.mechanised import toolchain

SENTENCE = re.compile(
    r"(?:Theorem|Lemma|Corollary|Definition|Fixpoint|Example|Ltac|(Inductive)|(Record)|(Notation))"
    r"\s+([\w']+)(.*)",
    re.DOTALL,
)
"""A sentence that declares a public name; its first groups tell what else it declares."""

SECTION = re.compile(r"(Section|End)\s+\w+")

LOCATED = re.compile(r"^(\w+) (Topo|Coq)\.([\w.]+)\.([\w']+)$(?!\n +\(shorter name)", re.MULTILINE)
"""An answer of `Locate` that is meant by the short name: kind, root, module, name."""


def declared(text: str) -> Iterator[str]:
    """The public names of a source: items, constructors, fields, and notations of no section."""
    depth = 0
    for sentence in re.split(r"\.(?=\s|$)", toolchain.without_comments(text)):
        if section := SECTION.fullmatch(sentence.strip()):
            depth += 1 if section[1] == "Section" else -1
        elif found := SENTENCE.fullmatch(sentence.strip()):
            inductive, record, notation, name, body = found.groups()
            if notation and depth:
                continue  # a notation ends with its section
            yield name
            if inductive:
                yield from re.findall(r"(?::=|\|)\s*([\w']+)", body)
            if record:
                yield from re.findall(r"[{;]\s*([\w']+)\s*:", body)


def homonyms(texts: Mapping[str, str]) -> dict[str, list[str]]:
    """The names that several files declare, or one file twice, with those files."""
    where: dict[str, list[str]] = {}
    for file, text in texts.items():
        for name in declared(text):
            where.setdefault(name, []).append(file)
    return {name: files for name, files in where.items() if len(files) > 1}


def misleading(text: str) -> list[str]:
    """The notations that are not an item applied to arguments but bear another file's name."""
    notations = re.findall(r"^Notation ([\w']+) := \(+(?:\w+\.)?([\w']+)", text, re.MULTILINE)
    public = {name for source in sources().values() for name in declared(source)}
    return [name for name, item in notations if name in public and name != item]


# ---------------------------------------------------------------- without Coq


def test_no_name_is_declared_twice() -> None:
    assert homonyms(sources()) == {}


@pytest.mark.long
def test_no_notation_gives_a_public_name_another_meaning() -> None:
    assert {file: lost for file, text in sources().items() if (lost := misleading(text))} == {}
    assert misleading("Notation link := (same assumed L).\nNotation same := (same A).") == ["link"]


@pytest.mark.parametrize(
    ("planted", "name"),
    [
        ("Definition seen := 0.", "seen"),
        ("Lemma turn_lt : True.", "turn_lt"),
        ("Inductive two := (* a comment *) One | consistent.", "consistent"),
        ("Inductive a_pair : Prop :=\n| same_refl : a_pair\n| other : a_pair.", "same_refl"),
        ("Record pair := { left_of : nat; start : nat }.", "start"),
        ("Notation closed := (fun L => L).", "closed"),
        ("Section A.\nFixpoint walk n := n.\nEnd A.", "walk"),
    ],
)
def test_a_planted_homonym_is_found(planted: str, name: str) -> None:
    assert list(homonyms(sources() | {"Planted": planted})) == [name]


def test_a_notation_of_a_section_ends_with_it() -> None:
    assert list(declared("Section A.\nNotation f := (f 0).\nEnd A.\nNotation g := 0.")) == ["g"]


# ---------------------------------------------------------------- with Coq


def located(folder: Path, imports: Iterable[str], names: Iterable[str]) -> list[tuple[str, str]]:
    """Module and name of all that these short names mean, after these imports."""
    lines = [*imports, *(f"Locate {name}." for name in names)]
    (folder / "Located.v").write_text("\n".join(lines))
    ran = toolchain.compile_one(folder, "Located", timeout=LIMIT)
    assert ran.accepted, ran.output
    # Tactics have names of their own kind: the tactic `cut` and the definition `cut` do not meet.
    answers = (found.groups() for found in LOCATED.finditer(ran.output))
    return [(f"{root}.{module}", name) for kind, root, module, name in answers if kind != "Ltac"]


def terms(text: str) -> set[str]:
    """The public names of a source that are no tactics."""
    return set(declared(text)) - set(re.findall(r"^Ltac (\w+)", text, re.MULTILINE))


@pytest.mark.parametrize("step", [1, -1], ids=["in order", "in reverse"])
def test_after_a_joint_import_every_name_means_what_its_file_says(place: Path, step: int) -> None:
    texts = {file: sources()[file] for file in toolchain.files()}
    expected = {(f"Topo.{file}", name) for file, text in texts.items() for name in terms(text)}
    imports = [f"From Topo Require Import {file}." for file in list(texts)[::step]]
    found = located(place, imports, sorted(name for _, name in expected))
    assert set(found) == expected


def test_no_name_hides_one_of_the_standard_library(place: Path) -> None:
    texts = sources()
    lines = (re.findall(r"^From Coq Require Import .*\.$", t, re.MULTILINE) for t in texts.values())
    imports = sorted({line for found in lines for line in found})
    names = sorted({name for text in texts.values() for name in terms(text)})
    assert located(place, imports, names) == []
    assert located(place, imports, ["last"]) == [("Coq.Lists.List", "last")]


def test_the_names_found_in_the_text_are_those_that_coqc_declares(library: Path) -> None:
    kinds = ("def", "prf", "ind", "constr", "rec", "proj", "ex", "coref", "thm")
    entry = re.compile(rf"^(?:{'|'.join(kinds)}) \d+:\d+ \S+ ([\w']+)$", re.MULTILINE)
    for file in toolchain.files():
        found = set(entry.findall((library / f"{file}.glob").read_text()))
        assert found == terms(sources()[file]), file
