"""Coq certificates of what a log proves: made here and checked, or received and checked."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Sequence

import msgspec

from topo_verify.cli.certify import CertifiedDecisions, KernelCheck
from topo_verify.errors import InternalError
from topo_verify.extra.certificates import certificate_format, certificates, evidence
from topo_verify.robot.events import Trace
from topo_verify.studies.log_report import Certificate
from topo_verify.world.formats import files

NumbersChecker = Callable[[Sequence[int]], certificates.CertificateCheck]


class ReceivedDecisions(msgspec.Struct, frozen=True):
    """The decisions of a log that a certificate proves to follow."""

    certified: int
    total: int


class CertificateEntry(msgspec.Struct, frozen=True):
    """What Coq says of a received certificate.

    Attributes:
        certificate: its file.
        accepted: null if nothing checked the certificate.
        by: what accepted or refused it; "" if nothing did.
        statement: map, undetermined or impossible, if accepted; else null.
        why: why it is refused, unchecked, or silent about a part of the log; else "".
        delivered: it states that the delivered map is the world.
        decisions: those of the log, if one is given; else those in the certificate.
    """

    certificate: str
    accepted: bool | None
    by: str
    statement: str | None
    why: str
    delivered: bool
    decisions: ReceivedDecisions


def prove_log(
    trace: str, log: Trace, certificate: Certificate, file: str, check: NumbersChecker
) -> KernelCheck:
    """Write the certificate of a log (in the file `trace`) to a file and have it checked.

    InternalError: Coq refuses it, or it states another result than the fold.
    """
    # The certificate comes from a second fold. If the folds differed, Coq would accept a true
    # statement, but not the one that the user reads.
    stated = certificates.certificate_of(log)
    shown = "undetermined" if certificate.fold is not None else "impossible"
    if stated.statement != ("map" if certificate.map is not None else shown):
        raise InternalError(f"{trace}: two folds of one log differ: {stated.statement}")
    text = certificate_format.text_of(stated)
    files.write(file, text)
    checked = check(certificate_format.parse(text.encode(), name=file))
    # None: not checked. For a true conclusion some evidence is accepted (coq/Accepted.v), so a
    # refusal is Python's mistake.
    if checked.accepted is False:
        raise InternalError(
            f"{checked.by} refuses {file}, so our conclusion or our evidence is wrong:"
            f" {checked.why}"
        )
    log_name = "LOG" if trace == "-" else trace
    return KernelCheck(
        stated.statement,
        file,
        checked.accepted,
        checked.by,
        checked.why,
        shlex.join(["topo-verify", "certify", "--check", file, "--log", log_name]),
        checked.delivered,
        _certified(checked, certificate.entailed, too_long=stated.decisions.too_long),
    )


def _certified(
    checked: certificates.CertificateCheck, entailed: int, *, too_long: bool
) -> CertifiedDecisions:
    if not entailed:
        return CertifiedDecisions(0, 0, "", "")
    if not checked.accepted:
        return CertifiedDecisions(0, entailed, "", "the certificate is not checked")
    if too_long:
        why = f"their evidence has more than {evidence.MOST:,} steps"
        return CertifiedDecisions(0, entailed, "", why)
    why = (
        "the others follow in planar worlds only, or rest on one that does, and the proofs in Coq"
        " do not speak of planarity"
    )
    missing = checked.certified < entailed
    return CertifiedDecisions(checked.certified, entailed, checked.by, why if missing else "")


def check_received(file: str, log: Trace | None, check: NumbersChecker) -> CertificateEntry:
    """Check a received certificate, about this log if one is given."""
    numbers = certificate_format.parse(files.read(file), name=file)
    if log is not None and not certificates.is_about(numbers, log):
        checked = certificates.CertificateCheck(
            accepted=False, by="topo-verify", why="the certificate is about another log"
        )
    else:
        checked = check(numbers)
    why, total = checked.why, checked.decisions
    if log is not None and checked.accepted:
        # What no certificate can state counts as not proved.
        why, total = certificate_format.left_out(log), certificate_format.decisions_in(log)
    return CertificateEntry(
        file,
        checked.accepted,
        checked.by,
        checked.statement,
        why,
        checked.delivered,
        ReceivedDecisions(checked.certified, total),
    )
