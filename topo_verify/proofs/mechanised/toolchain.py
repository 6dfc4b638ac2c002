"""Coq called as a program: the library compiled, checked and asked for its axioms.

The library is the folder coq/ beside this file; `_CoqProject` lists its files in an order in which
they can be compiled. Nothing is written there: it is compiled in a folder of the caller's. Every
call has a time limit, and a call that ends by it is `TimeOut`, never a refusal and never a pass.

What this does not show: that the installed coqc is the one that its authors released.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

SOURCES = Path(__file__).parents[1] / "coq"
"""Where the sources are."""

HOW_TO_GET_IT = (
    "apt-get install --no-install-recommends coq (Debian, Ubuntu), or opam install coq; the proofs"
    " were written for Coq 8.16"
)

NO_AXIOMS = "Closed under the global context"
"""What Coq prints of a theorem that rests on no axiom."""

FORBIDDEN = re.compile(
    r"\b(Admitted|admit|give_up|Axioms?|Parameters?|Conjectures?|Declare\s+Module|Abort|Unset\s+"
    r"(?:Guard|Positivity|Universe)\s+Checking|bypass_check|type_in_type|Extract\s+Constant)\b"
)
"""Words with which a source could claim what it does not prove."""


class TimeOut(Exception):
    """A call of coqc or coqchk took longer than it may."""


@dataclass(frozen=True, slots=True)
class ProgramRun:
    """What a program said, and whether it accepted."""

    accepted: bool
    output: str


def missing() -> str:
    """Why nothing can be compiled here; "" if it can."""
    lost = [program for program in ("coqc", "coqchk") if shutil.which(program) is None]
    return f"{' and '.join(lost)} not installed: {HOW_TO_GET_IT}" if lost else ""


@cache
def version() -> str:
    """Name and version of the compiler."""
    output = subprocess.run(
        ["coqc", "-print-version"],  # noqa: S607  the one on PATH is meant
        capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    return f"coqc {output.split()[0]}"


def files() -> tuple[str, ...]:
    """The names of the library's files, in an order in which they can be compiled."""
    lines = (SOURCES / "_CoqProject").read_text(encoding="utf-8").splitlines()
    return tuple(line.removesuffix(".v") for line in lines if line.endswith(".v"))


def required(name: str) -> tuple[str, ...]:
    """The files that one needs, itself included, in their order."""
    needed, todo = {name}, [name]
    while todo:
        text = (SOURCES / f"{todo.pop()}.v").read_text(encoding="utf-8")
        found = re.search(r"^From Topo Require Import ([\w\s]+)\.", text, re.MULTILINE)
        new = set(found[1].split() if found else ()) - needed
        needed |= new
        todo += new
    return tuple(file for file in files() if file in needed)


def without_comments(text: str) -> str:
    """A source without its comments (none of ours has one inside another)."""
    return re.sub(r"\(\*.*?\*\)", " ", text, flags=re.DOTALL)


def claims_unproved(text: str) -> tuple[str, ...]:
    """The words of a source that assume what ought to be proved."""
    return tuple(found[0] for found in FORBIDDEN.finditer(without_comments(text)))


def copy_library(folder: Path, names: Iterable[str]) -> None:
    """Copy these sources into the folder."""
    for name in names:
        shutil.copy(SOURCES / f"{name}.v", folder / f"{name}.v")


def compile_all(
    folder: Path, names: Iterable[str], *, timeout: float, flags: Sequence[str] = ()
) -> ProgramRun:
    """Compile these sources of the folder, one after the other, up to the first that is refused.

    Raises:
        TimeOut: one takes longer than `timeout` seconds.
    """
    for name in names:
        ran = compile_one(folder, name, timeout=timeout, flags=flags)
        if not ran.accepted:
            return ran
    return ProgramRun(accepted=True, output="")


def compile_one(
    folder: Path, name: str, *, timeout: float, flags: Sequence[str] = ()
) -> ProgramRun:
    """Compile one source of the folder."""
    return run(["coqc", *flags, "-q", "-Q", ".", "Topo", f"{name}.v"], folder, timeout=timeout)


def recheck(folder: Path, names: Iterable[str], *, timeout: float) -> ProgramRun:
    """Have coqchk check compiled files again; accepted only if it names no axiom."""
    library = [f"Topo.{name}" for name in names]
    ran = run(["coqchk", "-silent", "-o", "-Q", ".", "Topo", *library], folder, timeout=timeout)
    return ProgramRun(ran.accepted and "* Axioms: <none>" in ran.output, ran.output)


def run(command: Sequence[str], folder: Path, *, timeout: float, stdin: str = "") -> ProgramRun:
    """Run a program in the folder.

    Raises:
        TimeOut: it takes longer than `timeout` seconds; it was ended.
    """
    try:
        done = subprocess.run(  # noqa: S603  programs of Coq and OCaml, on files of our own
            command, cwd=folder, input=stdin, capture_output=True, text=True, check=False,
            timeout=timeout,
        )  # fmt: skip
    except subprocess.TimeoutExpired as error:
        raise TimeOut(f"{command[0]} took longer than {timeout:g} seconds") from error
    return ProgramRun(done.returncode == 0, f"{done.stdout}{done.stderr}".strip())
