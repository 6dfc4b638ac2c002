"""Theorems proved in Coq for worlds of any size, without axioms; `prove` checks them again.

One check of the library serves all: no source holds a word that assumes without proof; coqc
compiles them in a temporary folder; Coq and coqchk find no axiom. Else the verdict is UNKNOWN: a
failed proof is no counterexample.

What this does not show: that the statements mean what they should (docs/proofs.md names the lines
to read), nor anything about the Python code.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

from topo_verify.proofs.mechanised import toolchain
from topo_verify.proofs.theorem import Budget, Theorem, TheoremResult

LONGER = 10
"""A coqc call takes longer than a query: factor of the time limit."""


@dataclass(frozen=True, slots=True)
class MechanisedStatement:
    name: str
    file: str
    theorem: str
    claims: tuple[str, ...]
    words: str


def _statements() -> Iterator[MechanisedStatement]:
    with (toolchain.SOURCES / "theorems.csv").open(encoding="utf-8", newline="") as table:
        for row in csv.DictReader(table):
            file, theorem = row["theorem"].split(".")
            claims = tuple(row["claims"].split())
            yield MechanisedStatement(row["name"], file, theorem, claims, row["words"])


STATEMENTS = tuple(_statements())


@dataclass(frozen=True, slots=True)
class LibraryCheck:
    """The result of checking the library: why nothing is proved, or coqchk's summary."""

    why: str = ""
    summary: str = ""
    seconds: float = 0.0


@cache
def library(timeout: float) -> LibraryCheck:
    """Check the library once; `timeout`: seconds for each call."""
    if why := toolchain.missing():
        return LibraryCheck(why=why)
    begin = perf_counter()
    with TemporaryDirectory() as name:
        try:
            check = examine(Path(name), timeout=timeout)
        except toolchain.Unfinished as error:
            check = LibraryCheck(why=str(error))
    return replace(check, seconds=perf_counter() - begin)


def examine(folder: Path, *, timeout: float) -> LibraryCheck:
    """Check the library in an empty folder.

    Raises:
        toolchain.Unfinished: a call timed out, was killed, or lacks memory.
    """
    names = toolchain.files()
    toolchain.copy_library(folder, names)
    for name in names:
        if words := toolchain.claims_unproved((folder / f"{name}.v").read_text(encoding="utf-8")):
            return LibraryCheck(why=f"{name}.v claims without proof: {', '.join(words)}")
    ran = toolchain.compile_all(folder, names, timeout=timeout)
    if not ran.accepted:
        return LibraryCheck(why=f"coqc refuses {ran.output[-300:]}")
    if (output := asked(folder, timeout=timeout)) != toolchain.NO_AXIOMS:
        return LibraryCheck(why=f"the theorems rest on more than their proofs: {output[-300:]}")
    ran = toolchain.recheck(folder, names, timeout=timeout)
    if not ran.accepted:
        return LibraryCheck(why=f"coqchk does not say that there is no axiom: {ran.output[-300:]}")
    return LibraryCheck(summary=summary(ran.output))


def asked(folder: Path, *, timeout: float) -> str:
    """Coq's answer about the axioms of all theorems together."""
    imports = " ".join(dict.fromkeys(row.file for row in STATEMENTS))
    theorems = ", ".join(f"@{row.file}.{row.theorem}" for row in STATEMENTS)
    text = f"From Topo Require {imports}.\nDefinition every := ({theorems}).\n"
    (folder / "asked.v").write_text(f"{text}Print Assumptions every.\n", encoding="utf-8")
    return toolchain.compile_one(folder, "asked", timeout=timeout).output


def summary(output: str) -> str:
    """coqchk's theory, axioms, and what is not <none>, in one line."""
    lines = output.partition("CONTEXT SUMMARY")[2].splitlines()
    points = [line.removeprefix("* ").strip() for line in lines if line.startswith("* ")]
    worth_saying = (p for p in points if p.startswith("Axioms") or not p.endswith("<none>"))
    return "; ".join(worth_saying)


def theorem(statement: MechanisedStatement) -> Theorem:
    return Theorem(
        name=statement.name,
        kind="mechanised",
        claims=statement.claims,
        words=statement.words,
        symbols=f"Topo.{statement.file}.{statement.theorem}, in proofs/coq/{statement.file}.v",
        solver_part="all of it, for worlds of any size; coqchk checks the compiled proof again",
        assumed=(),
        expected="PROVED",
        prove=partial(_prove, statement.name),
        queries=lambda: iter(()),
        deep=True,
    )


def _prove(name: str, budget: Budget) -> TheoremResult:
    budget.progress(f"{name}: coqc and coqchk on the whole library", 0, 1)
    check = library(budget.timeout * LONGER)
    return TheoremResult(
        verdict="UNKNOWN" if check.why else "PROVED",
        solver="coqc" if toolchain.missing() else toolchain.version(),
        seconds=check.seconds,
        # Not vacuous: worlds and runs exist (torus_world, run_exists).
        premises_satisfiable=None if check.why else True,
        note=check.why or f"coqchk: {check.summary}",
    )


MECHANISED: tuple[Theorem, ...] = tuple(map(theorem, STATEMENTS))
