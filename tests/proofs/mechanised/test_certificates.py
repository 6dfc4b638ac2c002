"""Certificates for single logs: accepted by coqc and the extracted program; refused if forged."""

from __future__ import annotations

import random
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from tests.helpers import EMPTY, edited, of_type, trace_of, worlds
from tests.proofs.mechanised.conftest import LIMIT, nowhere
from topo_verify import World, families
from topo_verify.errors import InputError
from topo_verify.harness.log_report import certify
from topo_verify.proofs.mechanised import certificates, toolchain
from topo_verify.proofs.mechanised.evidence import Alone, Arrive, Illegal, MapRow, Marked
from topo_verify.proofs.mechanised.vernacular import CoqCertificate, coq_file
from topo_verify.robot.events import Event, Move, Start
from topo_verify.robot.percept import Percept

needs_ocaml = pytest.mark.skipif(
    shutil.which("ocamlfind") is None,
    reason="no OCaml compiler: apt-get install ocaml ocaml-findlib",
)


def log_of(world: World | str, mapper: str = "basic") -> tuple[Event, ...]:
    """The percepts and doors of a run."""
    return tuple(event for event in trace_of(world, mapper) if isinstance(event, Start | Move))


def logs() -> list[tuple[Event, ...]]:
    """Logs of small worlds, whole, cut short, and with one percept or door changed."""
    generator = random.Random(8)
    found: list[tuple[Event, ...]] = []
    for number, world in enumerate(worlds(range(1, 4))):
        whole = log_of(world, ("basic", "folding")[number % 2])
        found += [whole, whole[: max(1, len(whole) * 2 // 3)]]
        for _ in range(3):
            seen = Percept(generator.randrange(1, 5), generator.choice([None, 0, 1, 2]))
            found.append(edited(whole, generator.randrange(len(whole)), percept=seen))
            move = generator.randrange(1, len(whole))
            found.append(edited(whole, move, door=generator.randrange(4)))
    return found


def stated(trace: tuple[Event, ...]) -> str:
    """What must be stated of a log, by the checkers that speak Python."""
    verdict = certify(trace)
    if verdict.map is not None:
        return "map"
    return "undetermined" if verdict.witnesses else "impossible"


def by_coqc(place: Path, certificate: CoqCertificate) -> certificates.CertificateCheck:
    return certificates.by_kernel(place, "Log_of_the_test", coq_file(certificate), timeout=LIMIT)


def without_merges(certificate: CoqCertificate) -> CoqCertificate:
    return replace(certificate, fold=replace(certificate.fold, meetings=()))


LATTICE = log_of(families.lattice(3, 3))


# ---------------------------------------------------------------- what is stated


def test_what_is_stated_is_what_the_checkers_say() -> None:
    found = [certificates.certificate_of(log).statement for log in logs()]
    assert found == [stated(log) for log in logs()]
    assert set(found) == {"map", "undetermined", "impossible"}


@pytest.mark.parametrize("start", [Percept(2, None), Percept(2, 1), Percept(0, 0)])
def test_a_log_that_does_not_start_at_the_marker_is_impossible(start: Percept) -> None:
    assert (
        certificates.certificate_of(edited(LATTICE[:1], 0, percept=start)).statement == "impossible"
    )


def test_the_stated_map_is_the_proved_map() -> None:
    for world in worlds(range(1, 4)):
        table = certificates.certificate_of(log_of(world)).fold.table
        alpha = tuple(-1 if row.other is None else row.other for row in table)
        assert World(alpha, tuple(row.following for row in table), 0).is_isomorphic(world)


def test_a_closed_fold_has_a_row_for_every_dart() -> None:
    fold = certificates.certificate_of(LATTICE).fold
    assert fold.closed
    assert len(fold.table) == 24
    assert all(fold.table[row.following].previous == dart for dart, row in enumerate(fold.table))


def test_the_world_without_edges_and_negative_numbers_are_outside() -> None:
    with pytest.raises(InputError, match="the world without edges"):
        certificates.certificate_of(log_of(EMPTY))
    with pytest.raises(InputError, match="below 0"):
        certificates.certificate_of(edited(LATTICE, 3, door=-1))


# ---------------------------------------------------------------- by coqc


@pytest.mark.parametrize("cut", [len(LATTICE), len(LATTICE) // 2])
def test_coqc_accepts_a_certificate_and_names_no_axiom(place: Path, cut: int) -> None:
    certificate = certificates.certificate_of(LATTICE[:cut])
    assert by_coqc(place, certificate) == certificates.CertificateCheck(True, toolchain.version())


@pytest.mark.parametrize("kind", [Arrive, Marked, Alone, Illegal])
def test_coqc_accepts_that_no_world_shows_a_log(place: Path, kind: type) -> None:
    stated = (certificates.certificate_of(log) for log in logs())
    certificate = next(one for one in stated if isinstance(one.fold.conflict, kind))
    assert certificate.statement == "impossible"
    assert by_coqc(place, certificate).accepted


def test_coqc_refuses_a_tampered_map(place: Path) -> None:
    certificate = certificates.certificate_of(LATTICE)
    table = list(certificate.fold.table)
    table[0], table[1] = (
        MapRow(table[0].following, table[0].previous, table[1].other),
        MapRow(table[1].following, table[1].previous, table[0].other),
    )
    forged = replace(certificate, fold=replace(certificate.fold, table=tuple(table)))
    assert by_coqc(place, forged).accepted is False


def test_coqc_refuses_a_tampered_log(place: Path) -> None:
    certificate = certificates.certificate_of(LATTICE)
    other = (*certificate.percepts[:-1], Percept(1, None))
    checked = by_coqc(place, replace(certificate, percepts=other))
    assert checked.accepted is False
    assert "Error" in checked.why


def test_coqc_refuses_tampered_evidence(place: Path) -> None:
    assert by_coqc(place, without_merges(certificates.certificate_of(LATTICE))).accepted is False


def test_coqc_refuses_an_axiom_in_place_of_a_proof(place: Path) -> None:
    text = coq_file(certificates.certificate_of(LATTICE))
    begin = text.index("Proof.")
    forged = text[:begin] + "Admitted.\n\nPrint Assumptions proved.\n"
    assert toolchain.claims_unproved(forged)
    assert certificates.by_kernel(place, "Forged", forged, timeout=LIMIT).accepted is False


@pytest.mark.slow
def test_coqc_certifies_a_lattice_of_10_by_10(place: Path) -> None:
    certificate = certificates.certificate_of(log_of(families.lattice(10, 10)))
    assert certificate.statement == "map"
    assert by_coqc(place, certificate).accepted


# ---------------------------------------------------------------- by the extracted program


@needs_ocaml
def test_the_extracted_program_agrees_on_every_log_of_small_worlds(place: Path) -> None:
    for log in logs():
        certificate = certificates.certificate_of(log)
        assert certificates.extracted(place, certificate, timeout=LIMIT).accepted, certificate


@needs_ocaml
def test_the_extracted_program_refuses_what_is_tampered_with(place: Path) -> None:
    certificate = certificates.certificate_of(LATTICE)
    cut = certificates.certificate_of(LATTICE[:12])
    forged = [
        without_merges(certificate),
        replace(certificate, percepts=(*certificate.percepts[:-1], Percept(1, None))),
        replace(certificate, statement="undetermined"),
        replace(certificate, statement="impossible"),
        replace(cut, statement="map"),
        replace(cut, fold=replace(cut.fold, table=certificate.fold.table)),
        replace(certificate, doors=(-1, *certificate.doors[1:])),
    ]
    for one in forged:
        assert certificates.extracted(place, one, timeout=LIMIT).accepted is False, one


@needs_ocaml
@pytest.mark.slow
def test_the_extracted_program_certifies_ten_thousand_moves(place: Path) -> None:
    log = log_of(families.lattice(15, 15), "enhancement-ii")
    assert len(of_type(Move, log)) > 10_000
    assert certificates.extracted(place, certificates.certificate_of(log), timeout=LIMIT).accepted


# ---------------------------------------------------------------- which of them


def test_long_logs_go_to_the_extracted_program(
    monkeypatch: pytest.MonkeyPatch, library: Path
) -> None:
    def linked(folder: Path, *, timeout: float) -> None:
        del timeout
        for path in library.glob("*.v*"):
            (folder / path.name).symlink_to(path)

    told: list[str] = []
    monkeypatch.setattr(certificates, "build", linked)
    with certificates.checking(timeout=LIMIT, progress=told.append) as check:
        assert check("short", certificates.certificate_of(LATTICE)).by == toolchain.version()
        monkeypatch.setattr(certificates, "LONG", 10)
        if shutil.which("ocamlfind"):
            assert check("long", certificates.certificate_of(LATTICE)).by.startswith(
                "the checker extracted by"
            )
    assert told[:2] == ["compiling the proofs", "checking short.v"]


def test_what_is_not_checked_is_not_accepted(
    monkeypatch: pytest.MonkeyPatch, library: Path
) -> None:
    del library
    with certificates.checking(timeout=0.01) as check:
        late = check("late", certificates.certificate_of(LATTICE))
        assert late.accepted is None
        assert "longer than 0.01 seconds" in late.why
        monkeypatch.setattr(shutil, "which", nowhere)
        without = check("without", certificates.certificate_of(LATTICE))
    assert without.accepted is None
    assert "coqc and coqchk not installed" in without.why


def test_the_command_by_hand_names_the_sources_and_the_certificate() -> None:
    line = certificates.command("certificate_x")
    assert str(toolchain.SOURCES) in line
    assert line.index("CheckerCorrect") < line.index("certificate_x")
