"""Calls of coqc and coqchk on the library in proofs/coq/.

Files are compiled in the caller's folder, never in place. A call that times out, is killed, or runs
out of memory or stack raises `Unfinished`: neither a refusal nor a pass.

What this does not show: that the installed coqc is the one its authors released.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

SOURCES = Path(__file__).parents[1] / "coq"

HOW_TO_GET_IT = (
    "apt-get install --no-install-recommends coq (Debian, Ubuntu), or opam install coq; the proofs"
    " were written for Coq 8.16"
)

NO_AXIOMS = "Closed under the global context"
"""Coq's answer to `Print Assumptions` for a theorem without axioms."""

FORBIDDEN = re.compile(
    r"\b(Admitted|admit|give_up|Axioms?|Parameters?|Conjectures?|Declare\s+Module|Abort|Unset\s+"
    r"(?:Guard|Positivity|Universe)\s+Checking|bypass_check|type_in_type|Extract\s+Constant)\b"
)
"""Words with which a source could assume what it claims to prove."""


class Unfinished(Exception):
    """A program timed out, was killed, or lacked memory: it decided nothing."""


_LACKS = re.compile(r"(?i)out[ _]of[ _]memory|not enough memory|stack[ _]overflow|system error.*")
"""What Coq and OCaml programs print when they lack memory, stack or disk space."""

_SHELL_SIGNALS = range(129, 160)
"""Exit codes of a shell script whose program a signal ended: 128 + its number."""


@dataclass(frozen=True, slots=True)
class ProgramRun:
    accepted: bool
    output: str


def missing() -> str:
    """Why Coq cannot be called here, or ""."""
    lost = [program for program in ("coqc", "coqchk") if shutil.which(program) is None]
    return f"{' and '.join(lost)} not installed: {HOW_TO_GET_IT}" if lost else ""


@cache
def version() -> str:
    output = subprocess.run(
        ["coqc", "-print-version"],  # noqa: S607  the one on PATH is meant
        capture_output=True, text=True, check=False,
    ).stdout  # fmt: skip
    return " ".join(["coqc", *output.split()[:1]])


def files() -> tuple[str, ...]:
    """The names of the sources, in an order of compilation."""
    lines = (SOURCES / "_CoqProject").read_text(encoding="utf-8").splitlines()
    return tuple(line.removesuffix(".v") for line in lines if line.endswith(".v"))


def required(name: str) -> tuple[str, ...]:
    """The files that one file needs, itself included, in order of compilation."""
    needed, todo = {name}, [name]
    while todo:
        new = _required_by(SOURCES, todo.pop()) - needed
        needed |= new
        todo += new
    return tuple(file for file in files() if file in needed)


def _required_by(folder: Path, name: str) -> set[str]:
    text = (folder / f"{name}.v").read_text(encoding="utf-8")
    line = re.search(r"^From Topo Require (?:Import )?([\w\s]+)\.", text, re.MULTILINE)
    return set(line[1].split() if line else ())


def without_comments(text: str) -> str:
    """The source without comments, which must not be nested."""
    return re.sub(r"\(\*.*?\*\)", " ", text, flags=re.DOTALL)


def claims_unproved(text: str) -> tuple[str, ...]:
    """The forbidden words in a source."""
    return tuple(word[0] for word in FORBIDDEN.finditer(without_comments(text)))


def copy_library(folder: Path, names: Iterable[str]) -> None:
    for name in names:
        shutil.copy(SOURCES / f"{name}.v", folder / f"{name}.v")


def compile_all(
    folder: Path,
    names: Iterable[str],
    *,
    timeout: float,
    flags: Sequence[str] = (),
    compiled: Callable[[int], None] = lambda _done: None,
) -> ProgramRun:
    """Compile these sources, on all processors, each after those that it needs; stop at a refusal.

    Args:
        compiled: called with the number of compiled files, at first 0.
    Returns: the refusal, or what the last one printed.
    Raises:
        Unfinished: as `run`.
    """
    names = tuple(names)
    order = TopologicalSorter({name: _required_by(folder, name) & {*names} for name in names})
    order.prepare()
    outputs: dict[str, ProgramRun] = {}
    pool = ThreadPoolExecutor(os.cpu_count())
    try:
        running: dict[Future[ProgramRun], str] = {}
        while order.is_active():
            for name in sorted(order.get_ready(), key=names.index):
                running[pool.submit(compile_one, folder, name, timeout=timeout, flags=flags)] = name
            compiled(len(outputs))
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                ran = outputs[running[future]] = future.result()
                if not ran.accepted:
                    return ran
                order.done(running.pop(future))
    finally:  # also after a refusal or Ctrl-C
        pool.shutdown(cancel_futures=True)
    return outputs[names[-1]]


def compile_one(
    folder: Path, name: str, *, timeout: float, flags: Sequence[str] = ()
) -> ProgramRun:
    return run(["coqc", *flags, "-q", "-Q", ".", "Topo", f"{name}.v"], folder, timeout=timeout)


def recheck(folder: Path, names: Iterable[str], *, timeout: float) -> ProgramRun:
    """Check compiled files with coqchk; accepted only if it reports no axiom."""
    library = [f"Topo.{name}" for name in names]
    ran = run(["coqchk", "-silent", "-o", "-Q", ".", "Topo", *library], folder, timeout=timeout)
    # coqchk succeeds with axioms, too.
    return ProgramRun(ran.accepted and "* Axioms: <none>" in ran.output, ran.output)


def run(command: Sequence[str], folder: Path, *, timeout: float, stdin: str = "") -> ProgramRun:
    """Run a program in the folder.

    Raises:
        Unfinished: it exceeded `timeout` seconds, was killed, or lacked memory or stack.
    """
    try:
        done = subprocess.run(  # noqa: S603  programs of Coq and OCaml, on files of our own
            command, cwd=folder, input=stdin, capture_output=True, text=True, check=False,
            timeout=timeout,
        )  # fmt: skip
    except subprocess.TimeoutExpired as error:
        raise Unfinished(f"{command[0]} took longer than {timeout:g} seconds") from error
    code, output = done.returncode, f"{done.stdout}{done.stderr}".strip()
    if code < 0 or code in _SHELL_SIGNALS:
        number = -code if code < 0 else code - 128
        raise Unfinished(f"{command[0]} was ended by signal {number}, perhaps for lack of memory")
    if code and (lack := _LACKS.search(output)):
        raise Unfinished(f"{command[0]} ended without a result: {lack[0]}")
    return ProgramRun(code == 0, output)
