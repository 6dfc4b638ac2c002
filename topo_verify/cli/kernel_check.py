"""Certificates for Coq on the command line: one made for a log, or one that was received."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from topo_verify.cli.output import Output, Result
from topo_verify.errors import InternalError
from topo_verify.harness.log_report import Certificate
from topo_verify.report.blocks import Block, Bullets, Text
from topo_verify.robot.events import Trace
from topo_verify.text import plural
from topo_verify.world.formats import files

if TYPE_CHECKING:
    from topo_verify.proofs.mechanised.certificates import CertificateCheck

    Check = Callable[[Sequence[int]], CertificateCheck]


class CertifiedDecisions(msgspec.Struct, frozen=True):
    """How many of the decisions that follow Coq accepted.

    Attributes:
        by: the checker; "" if nothing was checked.
        why: the reason why some are not certified; "" if all are.
    """

    certified: int
    entailed: int
    by: str
    why: str


class KernelCheck(msgspec.Struct, frozen=True):
    """The certificate for Coq of one log, and what its checker said.

    Attributes:
        statement: map, undetermined or impossible.
        file: the certificate.
        accepted: null if nothing checked the certificate.
        by, why: the checker; the reason why nothing was checked.
        command: checks it again, in the folder of the certificate.
        delivered: whether Coq accepted that the delivered map is the world.
        decisions: those of the log that follow, certified.
    """

    statement: str
    file: str
    accepted: bool | None
    by: str
    why: str
    command: str
    delivered: bool
    decisions: CertifiedDecisions

    @property
    def incomplete(self) -> bool:
        """True if the certificate or a decision that follows was left unchecked."""
        return self.accepted is None or bool(self.decisions.entailed and not self.decisions.by)


class ReceivedDecisions(msgspec.Struct, frozen=True):
    """How many of the decisions in a certificate's log it proves to follow."""

    certified: int
    total: int


class CertificateEntry(msgspec.Struct, frozen=True):
    """One received certificate: the entry of `results`; docs/commands.md.

    Attributes:
        accepted: null if nothing checked the certificate.
        by: what accepted or refused it; "" if nothing did.
        statement: map, undetermined or impossible, of an accepted certificate; else null.
        why: the reason why it is refused, or not checked; "" if it is accepted.
        delivered: whether it states that the delivered map is the world.
    """

    certificate: str
    accepted: bool | None
    by: str
    statement: str | None
    why: str
    delivered: bool
    decisions: ReceivedDecisions


def checking(output: Output, timeout: int) -> AbstractContextManager[Check]:
    """A context that yields the function which checks the numbers of a certificate."""
    from topo_verify.proofs.mechanised import certificates

    return certificates.checking(
        timeout=timeout, progress=lambda doing: output.progress(doing, 0, 1)
    )


# ---------------------------------------------------------------- a certificate of one's own


def prove(
    traces: Sequence[str], number: int, log: Trace, certificate: Certificate, check: Check
) -> KernelCheck:
    """Write the certificate of a log, and return what its checker says of it.

    Raises:
        InternalError: Coq refuses it, or it states another result than the fold.
    """
    from topo_verify.proofs.mechanised import certificate_format, certificates

    # The certificate is stated by a fold of its own. Were the two folds to differ, Coq would
    # still accept a true statement, but not the one that the user was told.
    stated = certificates.certificate_of(log)
    shown = "undetermined" if certificate.fold is not None else "impossible"
    if stated.statement != ("map" if certificate.map is not None else shown):
        raise InternalError(f"{traces[number]}: two folds of one log differ: {stated.statement}")
    file = f"{_stem(traces, number)}.cert"
    text = certificate_format.text_of(stated)
    files.write(file, text)
    checked = check(certificate_format.parse(text.encode(), name=file))
    # `accepted` is None where nothing was checked; only False means that Coq refused. Where the
    # conclusion is true, some evidence is accepted (coq/Accepted.v): the mistake is Python's.
    if checked.accepted is False:
        raise InternalError(
            f"{checked.by} refuses {file}, so our conclusion or our evidence is wrong:"
            f" {checked.why}"
        )
    log_name = "LOG" if traces[number] == "-" else traces[number]
    return KernelCheck(
        statement=stated.statement,
        file=file,
        accepted=checked.accepted,
        by=checked.by,
        why=checked.why,
        command=shlex.join(["topo-verify", "certify", "--check", file, "--log", log_name]),
        delivered=checked.delivered,
        decisions=_certified_decisions(
            checked, certificate.entailed, too_long=stated.decisions.too_long
        ),
    )


def _certified_decisions(
    checked: CertificateCheck, entailed: int, *, too_long: bool
) -> CertifiedDecisions:
    """How many of the decisions that follow are certified, and why the others are not."""
    from topo_verify.proofs.mechanised.decision_evidence import MOST

    if not entailed:
        return CertifiedDecisions(0, 0, "", "")
    if not checked.accepted:
        return CertifiedDecisions(0, entailed, "", "the certificate is not checked")
    if too_long:
        why = f"their evidence has more than {MOST:,} steps"
        return CertifiedDecisions(0, entailed, "", why)
    why = (
        "the others follow in planar worlds only, or rest on one that does, and the proofs in Coq"
        " do not speak of planarity"
    )
    missing = checked.certified < entailed
    return CertifiedDecisions(checked.certified, entailed, checked.by, why if missing else "")


def _stem(traces: Sequence[str], number: int) -> str:
    """The name of a log's certificate without its suffix, different for each of the logs."""
    # Two logs may have one stem: hence the number.
    name = "standard_input" if traces[number] == "-" else Path(traces[number]).stem
    stem = re.sub(r"\W", "_", name, flags=re.ASCII)
    return f"certificate_{stem}" + (f"_{number + 1}" if len(traces) > 1 else "")


_STATED = {
    "map": "one world alone shows its log, and it is the map in the certificate",
    "undetermined": "two worlds that differ show its log, so it proves no map",
    "impossible": "no world shows its log",
}


def show_proof(proof: KernelCheck) -> Iterator[Block]:
    """The lines that tell of a certificate: what it states, who accepted it, how to check it."""
    outcome = f"accepted by {proof.by}" if proof.accepted else f"NOT CHECKED: {proof.why}"
    delivered = " The delivered map is that world." if proof.delivered else ""
    decisions = _decisions_sentence(proof.decisions)
    yield Text("")
    yield Text(
        f"{proof.file}: {_STATED[proof.statement]}; {outcome}.{delivered}{decisions}"
        " To check it again, in the folder of that file:"
    )
    yield Bullets((proof.command,))


def _decisions_sentence(proved: CertifiedDecisions) -> str:
    if not proved.entailed:
        return ""
    by = f" by {proved.by}" if proved.by else ""
    why = f": {proved.why}" if proved.why else ""
    of = f"{proved.certified} of {proved.entailed}"
    return f" Of the decisions that follow, {of} are certified{by}{why}."


# ---------------------------------------------------------------- a certificate received


def checked_certificate(file: str, log: Trace | None, check: Check) -> Result[CertificateEntry]:
    """The result of checking a certificate that is said to be about a log, if one is given.

    Raises:
        InputError: the file is no certificate, or no certificate can be about that log.
    """
    from topo_verify.proofs.mechanised import certificate_format, certificates

    numbers = certificate_format.parse(files.read(file), name=file)
    if log is not None and not certificates.is_about(numbers, log):
        checked = certificates.CertificateCheck(
            accepted=False, by="topo-verify", why="the certificate is about another log"
        )
    else:
        checked = check(numbers)
    entry = CertificateEntry(
        certificate=file,
        accepted=checked.accepted,
        by=checked.by,
        statement=checked.statement,
        why=checked.why,
        delivered=checked.delivered,
        decisions=ReceivedDecisions(checked.certified, checked.decisions),
    )
    return Result(entry, failed=checked.accepted is False, incomplete=checked.accepted is None)


def show_received(entries: Sequence[CertificateEntry]) -> Iterator[Block]:
    """The lines that tell whether a received certificate is accepted, and what it states."""
    for entry in entries:
        if entry.statement is None:
            word = "NOT CHECKED" if entry.accepted is None else f"REFUSED by {entry.by}"
            yield Text(f"{entry.certificate}: {word}: {entry.why}")
            continue
        delivered = " The delivered map is that world." if entry.delivered else ""
        of = f"{entry.decisions.certified} of {plural(entry.decisions.total, 'decision')}"
        decisions = f" Proved to follow: {of}." if entry.decisions.total else ""
        yield Text(
            f"{entry.certificate}: accepted by {entry.by}: {_STATED[entry.statement]}."
            f"{delivered}{decisions}"
        )
