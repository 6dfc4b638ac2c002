"""Certificates: a statement about one log, and a proof of it that Coq's kernel computes.

The checkers of this package judge what a log proves. A certificate states the same in Coq for one
log, and proves it by running a checker whose correctness is proved (coq/CheckerCorrect.v). The log
is folded in Python (`evidence.py`), which is not trusted: the kernel follows the evidence. A
certificate makes one of three statements:

    map            every world that shows these percepts to these doors is isomorphic to this map
    undetermined   two worlds that differ show them
    impossible     no world shows them

The declared decisions that follow (claim 10) are a second statement: each holds in every world that
shows the log up to that moment (`decision_evidence.py`).

The file needs only the sources of the library beside it; its first lines say what it states. Long
logs take the kernel minutes. `extracted` runs the same checker as a program in OCaml, which trusts
Coq's extraction and the OCaml compiler besides the kernel.

What this does not show: that the percepts are what happened, or anything of the world with no edge.

Source: docs/mechanised.md; docs/semantics.md, section 11.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

from topo_verify.checkers.replayed_trace import require_order
from topo_verify.errors import InputError
from topo_verify.proofs.mechanised import toolchain
from topo_verify.proofs.mechanised.decision_evidence import MOST, evidence_for_decisions
from topo_verify.proofs.mechanised.evidence import fold_log
from topo_verify.proofs.mechanised.vernacular import (
    MANY,
    CertifiedStatement,
    CoqCertificate,
    coq_file,
    numbers,
    numbers_of_decisions,
)
from topo_verify.robot.events import Event, Move, Start
from topo_verify.robot.percept import Percept

LIBRARY = "Decisions"
"""The file of the library that a certificate builds on."""

LONG = 10_000
"""Logs of more moves are checked by the extracted program, if OCaml is installed."""

_PROGRAM = ("certifier.mli", "certifier.ml", "driver.ml")


@dataclass(frozen=True, slots=True)
class CertificateCheck:
    """The result of checking a certificate.

    Attributes:
        accepted: True, False, or None if it was not checked.
        by: name and version of the checker; "" if none is installed.
        why: the reason why it was refused, or not checked.
        decisions: the result for the decisions, if they were checked apart from the file.
    """

    accepted: bool | None
    by: str
    why: str = ""
    decisions: CertificateCheck | None = None


def certificate_of(trace: Sequence[Event]) -> CoqCertificate:
    """The certificate of what a log proves, with its evidence.

    Raises:
        InputError: the trace is out of order; or the theory cannot state the log: it is of the
            world without edges, or has numbers below 0.
    """
    require_order(trace)
    percepts = tuple(event.percept for event in trace if isinstance(event, Start | Move))
    doors = tuple(event.door for event in trace if isinstance(event, Move))
    if not doors and percepts[0] == Percept(0, None):
        raise InputError(
            "the world without edges has no dart, and is outside the theory of the proofs in Coq:"
            " leave out --kernel"
        )
    if min((*doors, *(p.marker or 0 for p in percepts)), default=0) < 0:
        raise InputError(
            "the log has a door or a marker below 0, which cannot be stated as a natural number:"
            " leave out --kernel"
        )
    fold = fold_log(percepts, doors)
    shown: CertifiedStatement = "map" if fold.closed else "undetermined"
    # After a conflict the table is empty, and `closed` is true of an empty table.
    statement = "impossible" if fold.conflict else shown
    return CoqCertificate(statement, percepts, doors, fold, evidence_for_decisions(trace))


@contextmanager
def checking(
    *, timeout: float, progress: Callable[[str], None] = lambda _: None
) -> Generator[Callable[[str, CoqCertificate], CertificateCheck]]:
    """Yield a function that checks a certificate, given the name of its file without suffix.

    coqc checks it, or the extracted program if the log is long and OCaml is installed. The library
    is compiled once, for the first certificate, in a folder that is removed at the end.

    Args:
        timeout: seconds for each call of a program.
        progress: is called with a few words before each step.
    """
    with TemporaryDirectory() as folder:
        yield _Checker(Path(folder), timeout, progress).check


class _Checker:
    """Checks certificates in one folder, which keeps what was compiled."""

    def __init__(self, folder: Path, timeout: float, progress: Callable[[str], None]) -> None:
        self.folder, self.timeout, self.progress = folder, timeout, progress

    def check(self, name: str, certificate: CoqCertificate) -> CertificateCheck:
        """The result of checking a certificate, its decisions included."""
        if why := toolchain.missing():
            return CertificateCheck(None, "", why)
        compiler = shutil.which("ocamlfind") is not None
        by_program = compiler and len(certificate.doors) > LONG
        try:
            # It needs all the others, so it is compiled last.
            if not (self.folder / f"{LIBRARY}.vo").exists():
                self.progress("compiling the proofs")
                build(self.folder, timeout=self.timeout)
            self.progress(f"checking {name}.v")
            if by_program:
                found = extracted(self.folder, certificate, timeout=self.timeout)
            else:
                found = by_kernel(self.folder, name, coq_file(certificate), timeout=self.timeout)
        except toolchain.TimeOut as error:
            return CertificateCheck(None, toolchain.version(), str(error))
        # coqc has checked the decisions already if the file states them.
        if by_program or not certificate.writes_decisions:
            return replace(found, decisions=self.decisions(certificate, compiler=compiler))
        return found

    def decisions(self, certificate: CoqCertificate, *, compiler: bool) -> CertificateCheck | None:
        """The result for decisions that the file for Coq leaves out; None if there are none."""
        if certificate.decisions.too_long:
            return CertificateCheck(None, "", f"their evidence has more than {MOST:,} steps")
        if not certificate.decisions.stated:
            return None
        if not compiler:
            why = f"their evidence has more than {MANY:,} steps, and ocamlfind is not installed"
            return CertificateCheck(None, "", why)
        self.progress("checking the decisions")
        try:
            return extracted_decisions(self.folder, certificate, timeout=self.timeout)
        except toolchain.TimeOut as error:
            return CertificateCheck(None, toolchain.version(), str(error))


def build(folder: Path, *, timeout: float) -> None:
    """Compile in the folder the part of the library that certificates import.

    Raises:
        InputError: the installed Coq refuses a file.
        toolchain.TimeOut: a file takes too long.
    """
    names = toolchain.required(LIBRARY)
    toolchain.copy_library(folder, names)
    ran = toolchain.compile_all(folder, names, timeout=timeout)
    if not ran.accepted:
        raise InputError(
            f"{toolchain.version()} refuses the proofs that come with topo-verify, written for Coq"
            f" 8.16: {ran.output[:200]}"
        )


def by_kernel(folder: Path, name: str, text: str, *, timeout: float) -> CertificateCheck:
    """The result of compiling a certificate with coqc, beside the compiled library."""
    (folder / f"{name}.v").write_text(text, encoding="utf-8")
    ran = toolchain.compile_one(folder, name, timeout=timeout)
    # Every theorem of the file must be free of axioms: coqc accepts files with axioms, too.
    asked = text.count("\nPrint Assumptions ")
    accepted = ran.accepted and asked == ran.output.count(toolchain.NO_AXIOMS) > 0
    return CertificateCheck(accepted, toolchain.version(), "" if accepted else ran.output[-300:])


def extracted(folder: Path, certificate: CoqCertificate, *, timeout: float) -> CertificateCheck:
    """The result of the extracted program for the statement about the map."""
    return _extracted(folder, numbers(certificate), timeout=timeout)


def extracted_decisions(
    folder: Path, certificate: CoqCertificate, *, timeout: float
) -> CertificateCheck:
    """The result of the extracted program for the decisions."""
    return _extracted(folder, numbers_of_decisions(certificate), timeout=timeout)


def _extracted(folder: Path, stdin: str, *, timeout: float) -> CertificateCheck:
    """The result of the extracted program, which is compiled at its first use."""
    program = folder / "certifier"
    by = f"the checker extracted by {toolchain.version()}"
    if not program.exists():
        toolchain.copy_library(folder, ["Extract"])
        shutil.copy(toolchain.SOURCES / "driver.ml", folder)
        steps = (
            ["coqc", "-q", "-Q", ".", "Topo", "Extract.v"],
            ["ocamlfind", "ocamlopt", *_PROGRAM, "-o", program.name],
        )
        for step in steps:
            ran = toolchain.run(step, folder, timeout=timeout)
            if not ran.accepted:
                return CertificateCheck(None, by, f"{step[0]} fails: {ran.output[-300:]}")
    ran = toolchain.run([str(program)], folder, timeout=timeout, stdin=stdin)
    accepted = ran.accepted and ran.output == "accepted"
    return CertificateCheck(accepted, by, "" if accepted else ran.output[-300:] or "refused")


def command(name: str, sources: Path = toolchain.SOURCES) -> str:
    """The shell command that checks a certificate by hand, in the folder where it lies."""
    names = " ".join([*toolchain.required(LIBRARY), name])
    return f"cp {sources}/*.v . && for f in {names}; do coqc -Q . Topo $f.v || break; done"
