"""Theorems proved in Coq for worlds of any size, without axioms; `prove` checks them again.

One check serves all theorems that are asked about together. It takes the files that they need: no
source holds a word that assumes without proof; coqc compiles them in a temporary folder; Coq and
coqchk find no axiom. Else the verdict is UNKNOWN: a failed proof is no counterexample.

What this does not show: that the statements mean what they should (docs/proofs.md names the lines
to read), nor anything about the Python code.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

from topo_verify.proofs.mechanised import toolchain
from topo_verify.proofs.theorem import (
    Budget,
    Theorem,
    TheoremProgress,
    TheoremResult,
    no_progress,
)

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

NOT_VACUOUS = {"Run": "RunExists", "Mapper": "Examples"}
"""Files whose things exist, and the file that shows it (run_exists, torus_built); it is compiled
with each theorem that rests on the first. Of worlds all files have one (edge_alone_world)."""


def needed(names: Sequence[str]) -> tuple[str, ...]:
    """The files that these theorems need, in order of compilation."""
    roots = {row.file for row in STATEMENTS if row.name in names}
    files = {file for root in roots for file in toolchain.required(root)}
    for shown in files & {*NOT_VACUOUS}:
        files |= {*toolchain.required(NOT_VACUOUS[shown])}
    return tuple(file for file in toolchain.files() if file in files)


@dataclass(frozen=True, slots=True)
class LibraryCheck:
    """The result of checking the files: why nothing is proved, or coqchk's summary."""

    why: str = ""
    summary: str = ""
    seconds: float = 0.0


@cache
def library(names: tuple[str, ...], timeout: float, progress: TheoremProgress) -> LibraryCheck:
    """Check the files of these theorems once; `timeout`: seconds for each call."""
    if why := toolchain.missing():
        return LibraryCheck(why=why)
    begin = perf_counter()
    with TemporaryDirectory() as name:
        try:
            check = examine(Path(name), names, needed(names), timeout=timeout, progress=progress)
        except toolchain.Unfinished as error:
            check = LibraryCheck(why=str(error))
    return replace(check, seconds=perf_counter() - begin)


def examine(
    folder: Path,
    names: Sequence[str],
    files: Sequence[str],
    *,
    timeout: float,
    progress: TheoremProgress = no_progress,
) -> LibraryCheck:
    """Check theorems, and the files that they need, in an empty folder.

    Raises:
        toolchain.Unfinished: a call timed out, was killed, or lacks memory.
    """
    toolchain.copy_library(folder, files)
    for file in files:
        if words := toolchain.claims_unproved((folder / f"{file}.v").read_text(encoding="utf-8")):
            return LibraryCheck(why=f"{file}.v claims without proof: {', '.join(words)}")

    def compiled(done: int) -> None:
        progress("coqc compiles files", done, len(files))

    ran = toolchain.compile_all(folder, files, timeout=timeout, compiled=compiled)
    if not ran.accepted:
        return LibraryCheck(why=f"coqc refuses {ran.output[-300:]}")
    progress("coqchk checks the compiled files", 0, 1)
    if (output := asked(folder, names, timeout=timeout)) != toolchain.NO_AXIOMS:
        return LibraryCheck(why=f"the theorems rest on more than their proofs: {output[-300:]}")
    ran = toolchain.recheck(folder, files, timeout=timeout)
    if not ran.accepted:
        return LibraryCheck(why=f"coqchk does not say that there is no axiom: {ran.output[-300:]}")
    return LibraryCheck(summary=summary(ran.output))


def asked(folder: Path, names: Sequence[str], *, timeout: float) -> str:
    """Coq's answer about the axioms of these theorems together."""
    rows = [row for row in STATEMENTS if row.name in names]
    imports = " ".join(dict.fromkeys(row.file for row in rows))
    theorems = ", ".join(f"@{row.file}.{row.theorem}" for row in rows)
    text = f"From Topo Require {imports}.\nDefinition every := ({theorems}).\n"
    (folder / "asked.v").write_text(f"{text}Print Assumptions every.\n", encoding="utf-8")
    return toolchain.compile_one(folder, "asked", timeout=timeout).output


def summary(output: str) -> str:
    """coqchk's theory, axioms, and what is not <none>, in one line."""
    lines = output.partition("CONTEXT SUMMARY")[2].splitlines()
    points = [line.removeprefix("* ").strip() for line in lines if line.startswith("* ")]
    worth_saying = (p for p in points if p.startswith("Axioms") or not p.endswith("<none>"))
    return "; ".join(worth_saying)


def in_coq(file: str, theorem: str) -> str:
    """The statement of a theorem as its file has it, with the variables of its section.

    If the statement starts with a name that the file defines, as `maps_all basic`, the definition
    follows.
    """
    source = (toolchain.SOURCES / f"{file}.v").read_text(encoding="utf-8")
    before, _, after = re.split(
        rf"^(Theorem|Lemma|Example|Corollary) {theorem}\b",
        toolchain.without_comments(source),
        flags=re.MULTILINE,
    )
    _, _, section = before.rpartition("\nSection ")
    given = re.findall(
        r"^(?:Variables?|Hypothes[ei]s|Context)\b.*?\.\s*$",
        "" if "\nEnd " in section else section,
        re.MULTILINE | re.DOTALL,
    )
    statement = theorem + after.partition("Proof.")[0]
    name = re.split(r" :\s+", statement, maxsplit=1)[-1].split()[0]
    definition = re.findall(
        rf"^Definition {re.escape(name)}\b.*?\.\s*$", before, re.MULTILINE | re.DOTALL
    )
    return " ".join(" ".join([*given, statement, *definition]).split())


def theorem(statement: MechanisedStatement) -> Theorem:
    return Theorem(
        name=statement.name,
        kind="mechanised",
        claims=statement.claims,
        words=statement.words,
        symbols=f"Topo.{statement.file}.{statement.theorem}, in proofs/coq/{statement.file}.v: "
        + in_coq(statement.file, statement.theorem),
        solver_part="all of it, for worlds of any size; coqchk checks the compiled proof again",
        assumed=(),
        expected="PROVED",
        prove=partial(_prove, statement.name),
        queries=lambda: iter(()),
        deep=True,
    )


def _prove(name: str, budget: Budget) -> TheoremResult:
    check = library(budget.together or (name,), budget.timeout * LONGER, budget.progress)
    return TheoremResult(
        verdict="UNKNOWN" if check.why else "PROVED",
        solver="coqc" if toolchain.missing() else toolchain.version(),
        seconds=check.seconds,
        # Not vacuous: worlds exist (edge_alone_world), and the rest of NOT_VACUOUS.
        premises_satisfiable=None if check.why else True,
        note=check.why or f"coqchk: {check.summary}",
    )


MECHANISED: tuple[Theorem, ...] = tuple(map(theorem, STATEMENTS))
