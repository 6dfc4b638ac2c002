"""Certificates: a statement about one log, which Coq proves by computation.

Python folds the log (`evidence.py`) and is not trusted; Coq runs a checker that is proved correct
(coq/Certificate.v, coq/Checked.v). A certificate states that decisions follow (claim 10), and

    map            every world that shows this log is isomorphic to this map, and to the delivered
                   map if that is right
    undetermined   two worlds that differ show it
    impossible     no world shows it

Long certificates go to the same checker, extracted to OCaml, which trusts Coq's extraction and the
OCaml compiler as well.

What this does not show: that the percepts are what happened.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Generator, Iterable, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory

from topo_verify.errors import InputError
from topo_verify.extra.certificates import certificate_format
from topo_verify.extra.certificates.certificate_format import (
    STATEMENTS,
    WIDEST,
    CertifiedStatement,
    CoqCertificate,
)
from topo_verify.extra.certificates.evidence import (
    FoldedLog,
    MapRow,
    evidence_for_decisions,
    fold_log,
)
from topo_verify.proofs.mechanised import toolchain
from topo_verify.robot.events import Event, Finish, MapData, Move, Start, require_order
from topo_verify.robot.percept import Percept

LIBRARY = "Certificate"

LONG = 200_000
"""Longer certificates go to the extracted program, if OCaml is installed."""

EDGELESS = FoldedLog(table=(), meetings=(), conflict=None)

_PROGRAM = ("certifier.mli", "certifier.ml", "driver.ml")


@dataclass(frozen=True, slots=True)
class CertificateCheck:
    """The result of checking a certificate.

    Attributes:
        accepted: None if it was not checked; `why` has the reason.
        by: the checker and its version; "" if none is installed.
        delivered: does it state that the delivered map is right?
        certified, decisions: number of decisions stated, and declared.
    """

    accepted: bool | None
    by: str
    why: str = ""
    statement: CertifiedStatement | None = None
    delivered: bool = False
    certified: int = 0
    decisions: int = 0


def certificate_of(trace: Sequence[Event]) -> CoqCertificate:
    """The certificate of what a log proves.

    Raises:
        InputError: the trace is out of order, has numbers below 0, or too many doors.
    """
    require_order(trace)
    percepts, doors = _walk(trace)
    _require_statable(percepts, doors)
    edgeless = not doors and percepts[0] == Percept(0, None)
    fold = EDGELESS if edgeless else fold_log(percepts, doors)
    shown: CertifiedStatement = "map" if fold.closed else "undetermined"
    # After a conflict the table is empty, and so closed.
    statement = "impossible" if fold.conflict else shown
    log = certificate_format.stated_log(trace)
    delivered = log[-1]
    numbering = None
    if statement == "map" and isinstance(delivered, Finish):
        numbering = numbering_of(delivered.map, fold.table)
    decisions = evidence_for_decisions(log)
    return CoqCertificate(statement, log, fold, numbering, decisions)


def is_about(numbers: Sequence[int], trace: Sequence[Event]) -> bool:
    """Do the numbers of a certificate begin with the log of this trace?

    Raises:
        InputError: as `certificate_of`.
    """
    require_order(trace)
    _require_statable(*_walk(trace))
    lines = certificate_format.log_lines(certificate_format.stated_log(trace))
    log = list(chain.from_iterable(lines))
    # No log is the beginning of another one.
    return list(numbers[: len(log)]) == log


def _walk(trace: Sequence[Event]) -> tuple[tuple[Percept, ...], tuple[int, ...]]:
    return (
        tuple(event.percept for event in trace if isinstance(event, Start | Move)),
        tuple(event.door for event in trace if isinstance(event, Move)),
    )


def _require_statable(percepts: Sequence[Percept], doors: Sequence[int]) -> None:
    sensed = chain.from_iterable((p.degree, p.marker or 0) for p in percepts)
    if min(chain(doors, sensed)) < 0:
        raise InputError(
            "the log has a door, a degree or a marker below 0, which cannot be stated as a natural"
            " number: leave out --kernel"
        )
    if (width := sum(p.degree for p in percepts)) > WIDEST:
        raise InputError(
            f"the places of this log have {width:,} doors together, and Coq counts at most"
            f" {WIDEST:,}: is a degree wrong? Else leave out --kernel"
        )


def numbering_of(delivered: MapData, table: Sequence[MapRow]) -> tuple[tuple[int, int], ...] | None:
    """The isomorphism from a delivered map to a proved one; None if they differ.

    Pair i: the table's dart for delivered dart i, the position of table dart i.
    """
    if not table:
        return () if delivered.vertices == ((),) and not delivered.edges else None
    labels = list(chain.from_iterable(delivered.vertices))
    place = {label: i for i, label in enumerate(labels)}
    after = {r[i - 1]: dart for r in delivered.vertices for i, dart in enumerate(r)}
    other = {one: two for x, y in delivered.edges for one, two in ((x, y), (y, x))}
    sizes = {len(labels), len(place), len(other), 2 * len(delivered.edges), len(table)}
    if len(sizes) > 1 or delivered.marker not in place or not all(delivered.vertices):
        return None
    of_table: dict[int, int] = {}
    todo: list[tuple[int, int]] = [(0, delivered.marker)]
    for dart, label in todo:
        if dart in of_table:
            continue
        of_table[dart] = label
        partner = table[dart].other
        if label not in after or label not in other or partner is None:
            return None
        todo += [(table[dart].following, after[label]), (partner, other[label])]
    # The checker compares every dart again.
    if any(of_table[dart] != label for dart, label in todo) or len(of_table) < len(table):
        return None
    back = [place[of_table[dart]] for dart in range(len(table))]
    ahead = {i: dart for dart, i in enumerate(back)}
    return tuple((ahead[i], back[i]) for i in range(len(back))) if len(ahead) == len(back) else None


@contextmanager
def checking(
    *, timeout: float, progress: Callable[[str], None] = lambda _: None
) -> Generator[Callable[[Sequence[int]], CertificateCheck]]:
    """Yield a function that checks certificates; `timeout`: seconds for each call of a program."""
    with TemporaryDirectory() as folder:
        yield _Checker(Path(folder), timeout, progress).check


class _Checker:
    def __init__(self, folder: Path, timeout: float, progress: Callable[[str], None]) -> None:
        self.folder, self.timeout, self.progress = folder, timeout, progress

    def check(self, numbers: Sequence[int]) -> CertificateCheck:
        if why := certificate_format.doubt(numbers):
            return CertificateCheck(accepted=False, by="topo-verify", why=why)
        if why := toolchain.missing():
            return CertificateCheck(accepted=None, by="", why=why)
        try:
            if not (self.folder / f"{LIBRARY}.vo").exists():
                self.progress("compiling the proofs")
                build(self.folder, timeout=self.timeout)
            self.progress("checking the certificate")
            if len(numbers) > LONG and shutil.which("ocamlfind") is not None:
                return extracted(self.folder, numbers, timeout=self.timeout)
            return by_kernel(self.folder, numbers, timeout=self.timeout)
        except toolchain.Unfinished as error:
            return CertificateCheck(accepted=None, by=toolchain.version(), why=str(error))


def build(folder: Path, *, timeout: float) -> None:
    """Compile the library that the check needs.

    Raises:
        InputError: the installed Coq refuses a file.
    """
    names = toolchain.required(LIBRARY)
    toolchain.copy_library(folder, names)
    ran = toolchain.compile_all(folder, names, timeout=timeout)
    if not ran.accepted:
        raise InputError(
            f"{toolchain.version()} refuses the proofs that come with topo-verify, written for Coq"
            f" 8.16: {ran.output[:200]}"
        )


UNPROVED = "its numbers are no certificate, or their evidence does not prove what they state"

_SUMMARY = re.compile(r"= Some \((\d), (\d), \((\d+), (\d+)\)\)")


def by_kernel(folder: Path, numbers: Sequence[int], *, timeout: float) -> CertificateCheck:
    """Check with coqc, beside the compiled library."""
    (folder / "Data.v").write_text(certificate_format.data_file(numbers), encoding="utf-8")
    toolchain.copy_library(folder, ["Checked"])
    ran = toolchain.compile_all(folder, ["Data", "Checked"], timeout=timeout)
    summary = _SUMMARY.search(ran.output)
    # coqc accepts files with axioms, too.
    if not ran.accepted or toolchain.NO_AXIOMS not in ran.output or summary is None:
        why = f"{UNPROVED} ({ran.output[-300:]})"
        return CertificateCheck(accepted=False, by=toolchain.version(), why=why)
    return _accepted(toolchain.version(), map(int, summary.groups()))


def extracted(folder: Path, numbers: Sequence[int], *, timeout: float) -> CertificateCheck:
    """Check with the extracted program, compiled at first use."""
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
                why = f"{step[0]} fails: {ran.output[-300:]}"
                return CertificateCheck(accepted=None, by=by, why=why)
    stdin = " ".join(map(str, numbers))
    ran = toolchain.run([str(program)], folder, timeout=timeout, stdin=stdin)
    word, *summary = ran.output.split() or [""]
    if not ran.accepted or word != "accepted":
        why = f"{UNPROVED} ({ran.output[-300:]})"
        return CertificateCheck(accepted=False, by=by, why=why)
    return _accepted(by, map(int, summary))


def _accepted(by: str, summary: Iterable[int]) -> CertificateCheck:
    claim, delivered, certified, decisions = summary
    return CertificateCheck(
        accepted=True,
        by=by,
        statement=STATEMENTS[claim],
        delivered=bool(delivered),
        certified=certified,
        decisions=decisions,
    )
