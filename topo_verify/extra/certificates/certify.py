"""What the options of this extra do in `certify`: certificates are made, checked and shown."""

from __future__ import annotations

import re
from collections.abc import Generator, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import click

from topo_verify.cli.certify import KernelCheck, Prover
from topo_verify.cli.output import Output, Result
from topo_verify.errors import plural
from topo_verify.extra.certificates import certificates, study
from topo_verify.report.blocks import Block, Bullets, Text
from topo_verify.robot.events import Trace
from topo_verify.studies.log_file import read_log
from topo_verify.studies.log_report import Certificate


@dataclass(frozen=True, kw_only=True)
class CoqCertifier:
    """The values of --kernel, --check, --log and --timeout, and what they do."""

    proving: bool
    received: str | None
    about: str | None
    timeout: int

    def check(self, output: Output, *, alone: bool) -> int | None:
        """Check the certificate of --check; None without it."""
        if self.received is None:
            if self.about is not None:
                raise click.UsageError("--log LOG goes with --check CERTIFICATE: give both")
            return None
        if self.proving or not alone:
            raise click.UsageError(
                "--check CERTIFICATE takes --log LOG and --timeout, and no TRACE or other option"
            )
        return output.run("certify", partial(self._checked, output, self.received), _show_received)

    def _checked(self, output: Output, received: str) -> Iterator[Result[study.CertificateEntry]]:
        with self._checking(output) as check:
            log = None if self.about is None else read_log(self.about)
            entry = study.check_received(received, log, check)
            incomplete = entry.accepted is None or bool(entry.why)
            yield Result(entry, failed=entry.accepted is False, incomplete=incomplete)

    def _checking(self, output: Output) -> AbstractContextManager[study.NumbersChecker]:
        doing = partial(output.progress, done=0, total=1)
        return certificates.checking(timeout=self.timeout, progress=doing)

    @contextmanager
    def prover(self, output: Output, traces: Sequence[str]) -> Generator[Prover | None]:
        """What writes and checks the certificates of these logs; None without --kernel."""
        if not self.proving:
            yield None
            return
        with self._checking(output) as check:

            def prove(number: int, log: Trace, certificate: Certificate) -> KernelCheck:
                file = f"{_stem(traces, number)}.cert"
                return study.prove_log(traces[number], log, certificate, file, check)

            yield prove

    def show(self, proof: KernelCheck) -> Iterator[Block]:
        """The outcome of the certificate check, as blocks of text."""
        outcome = f"accepted by {proof.by}" if proof.accepted else f"NOT CHECKED: {proof.why}"
        delivered = " The delivered map is that world." if proof.delivered else ""
        proved, decisions = proof.decisions, ""
        if proved.entailed:
            by = f" by {proved.by}" if proved.by else ""
            why = f": {proved.why}" if proved.why else ""
            of = f"{proved.certified} of {proved.entailed}"
            decisions = f" Of the decisions that follow, {of} are certified{by}{why}."
        yield Text("")
        yield Text(
            f"{proof.file}: {_STATED[proof.statement]}; {outcome}.{delivered}{decisions}"
            " To check it again, in the folder of that file:"
        )
        yield Bullets((proof.command,))


def _stem(traces: Sequence[str], number: int) -> str:
    name = "standard_input" if traces[number] == "-" else Path(traces[number]).stem
    stem = re.sub(r"\W", "_", name, flags=re.ASCII)
    return f"certificate_{stem}" + (f"_{number + 1}" if len(traces) > 1 else "")


_STATED = {
    "map": "one world alone shows its log, and it is the map in the certificate",
    "undetermined": "two worlds that differ show its log, so it proves no map",
    "impossible": "no world shows its log",
}


def _show_received(entries: Sequence[study.CertificateEntry]) -> Iterator[Block]:
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
        if entry.why:
            yield Text(f"{entry.certificate}: NOT PROVED: {entry.why}.")
