"""A run certified by Coq's kernel: a statement about one log, and its proof by computation.

The checkers of this package say what a log proves; here the same is stated in Coq, for that very
log, and proved by running a checker whose correctness is proved (coq/CheckerCorrect.v). The fold is
done outside (`evidence`) and is not trusted: the kernel follows the evidence. Three statements:

    map            every world that shows these percepts to these doors is isomorphic to this map
    undetermined   two worlds that differ show them
    impossible     no world shows them

The decisions that the log declares and that follow (claim 10) are a second statement: each holds in
every world that shows the log up to that moment (`decided`).

The file that is written says all of it in its first lines and stands alone beside the sources of
the library. Long logs take the kernel minutes; `extracted` runs the same checker as a program in
OCaml, which trusts, besides the kernel, Coq's extraction and the OCaml compiler.

What this does not show: that the percepts are what happened. The world without edges is outside.

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
"""So many moves are left to the extracted program, if there is a compiler for it."""

_PROGRAM = ("certifier.mli", "certifier.ml", "driver.ml")


@dataclass(frozen=True, slots=True)
class CertificateCheck:
    """What became of a certificate.

    Attributes:
        accepted: True, False, or None where it was not checked.
        by: the checker, with its version; "" if there was none.
        why: why it was refused or not checked.
        decisions: the same of the decisions, where the file for Coq does not settle them.
    """

    accepted: bool | None
    by: str
    why: str = ""
    decisions: CertificateCheck | None = None


def state(trace: Sequence[Event]) -> CoqCertificate:
    """What the log proves, stated, with its evidence.

    Raises:
        InputError: the trace is out of order; or its statement is outside the theory: a log of the
            world without edges, or with numbers below 0.
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
    statement = "impossible" if fold.conflict else shown
    return CoqCertificate(statement, percepts, doors, fold, evidence_for_decisions(trace))


@contextmanager
def checking(
    *, timeout: float, progress: Callable[[str], None] = lambda _: None
) -> Generator[Callable[[str, CoqCertificate], CertificateCheck]]:
    """Have certificates checked, each with the name of its file, without suffix.

    coqc checks them; long ones the extracted program does, where it can be made. What they build on
    is compiled once, when the first one comes, and goes away at the end.

    Args:
        timeout: seconds for each call of a program.
        tell: is told what is being done.
    """
    with TemporaryDirectory() as folder:
        yield _Checker(Path(folder), timeout, progress).check


class _Checker:
    """A folder in which certificates are checked."""

    def __init__(self, folder: Path, timeout: float, progress: Callable[[str], None]) -> None:
        self.folder, self.timeout, self.progress = folder, timeout, progress

    def check(self, name: str, certificate: CoqCertificate) -> CertificateCheck:
        """What becomes of it."""
        if why := toolchain.missing():
            return CertificateCheck(None, "", why)
        compiler = shutil.which("ocamlfind") is not None
        by_program = compiler and len(certificate.doors) > LONG
        try:
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
        if by_program or not certificate.writes_decisions:
            return replace(found, decisions=self.decisions(certificate, compiler=compiler))
        return found

    def decisions(self, certificate: CoqCertificate, *, compiler: bool) -> CertificateCheck | None:
        """What becomes of decisions that coqc is not asked about; None if there are none."""
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
    """Compile in the folder what certificates build on.

    Raises:
        InputError: the installed Coq does not take it.
        coqtools.TimeOut: a file takes too long.
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
    """Have coqc check a certificate, beside the compiled library."""
    (folder / f"{name}.v").write_text(text, encoding="utf-8")
    ran = toolchain.compile_one(folder, name, timeout=timeout)
    asked = text.count("\nPrint Assumptions ")
    accepted = ran.accepted and asked == ran.output.count(toolchain.NO_AXIOMS) > 0
    return CertificateCheck(accepted, toolchain.version(), "" if accepted else ran.output[-300:])


def extracted(folder: Path, certificate: CoqCertificate, *, timeout: float) -> CertificateCheck:
    """Have the extracted program check what a log proves of the map."""
    return _extracted(folder, numbers(certificate), timeout=timeout)


def extracted_decisions(
    folder: Path, certificate: CoqCertificate, *, timeout: float
) -> CertificateCheck:
    """Have the extracted program check the decisions."""
    return _extracted(folder, numbers_of_decisions(certificate), timeout=timeout)


def _extracted(folder: Path, stdin: str, *, timeout: float) -> CertificateCheck:
    """Have the extracted program check; it is compiled where it is not yet there."""
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
    """The command that checks a certificate by hand, in a folder where it lies."""
    names = " ".join([*toolchain.required(LIBRARY), name])
    return f"cp {sources}/*.v . && for f in {names}; do coqc -Q . Topo $f.v || break; done"
