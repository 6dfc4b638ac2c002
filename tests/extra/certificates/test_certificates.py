"""Certificates for single logs: accepted by coqc and the extracted program; refused if forged."""

from __future__ import annotations

import operator
import random
import shutil
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from tests.helpers import edited, of_type, some, trace_of, typed, with_darts, worlds
from tests.proofs.mechanised.conftest import LIMIT, nowhere
from topo_verify import World, families
from topo_verify.errors import InputError
from topo_verify.extra.certificates import certificate_format, certificates
from topo_verify.extra.certificates.certificate_format import (
    CertifiedStatement,
    CoqCertificate,
    parse,
    text_of,
)
from topo_verify.extra.certificates.evidence import Alone, Arrive, Illegal, MapRow, Marked
from topo_verify.proofs.mechanised import toolchain
from topo_verify.robot.events import Event, Finish, MapData, Move, Start
from topo_verify.robot.percept import Percept
from topo_verify.studies.log_report import certify

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


def numbers_of(certificate: CoqCertificate) -> list[int]:
    """The numbers of a certificate, as they are read from its text."""
    return parse(text_of(certificate).encode(), name="test")


def by_coqc(place: Path, certificate: CoqCertificate) -> certificates.CertificateCheck:
    return certificates.by_kernel(place, numbers_of(certificate), timeout=LIMIT)


def by_program(place: Path, certificate: CoqCertificate) -> certificates.CertificateCheck:
    return certificates.extracted(place, numbers_of(certificate), timeout=LIMIT)


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


def test_negative_numbers_are_outside() -> None:
    with pytest.raises(InputError, match="below 0"):
        certificates.certificate_of(edited(LATTICE, 3, door=-1))


# ---------------------------------------------------------------- by coqc


@pytest.mark.parametrize(
    ("cut", "statement"), [(len(LATTICE), "map"), (len(LATTICE) // 2, "undetermined")]
)
def test_coqc_accepts_a_certificate_and_names_no_axiom(
    place: Path, cut: int, statement: CertifiedStatement
) -> None:
    found = by_coqc(place, certificates.certificate_of(LATTICE[:cut]))
    assert found == certificates.CertificateCheck(
        accepted=True, by=toolchain.version(), statement=statement
    )


@pytest.mark.parametrize("kind", [Arrive, Marked, Alone, Illegal])
def test_coqc_accepts_that_no_world_shows_a_log(place: Path, kind: type) -> None:
    stated = (certificates.certificate_of(log) for log in logs())
    certificate = next(one for one in stated if isinstance(one.fold.conflict, kind))
    assert certificate.statement == "impossible"
    assert by_coqc(place, certificate).accepted


def with_table(certificate: CoqCertificate, table: Sequence[MapRow]) -> CoqCertificate:
    return replace(certificate, fold=replace(certificate.fold, table=tuple(table)))


def tampered() -> dict[str, CoqCertificate]:
    """The certificate of a lattice with one thing changed that makes it false or unproved."""
    whole, cut = certificates.certificate_of(LATTICE), certificates.certificate_of(LATTICE[:12])
    first, second, *rest = whole.fold.table
    crossed = [first._replace(other=second.other), second._replace(other=first.other), *rest]
    return {
        "map": with_table(whole, crossed),
        "another map": with_table(whole, certificates.certificate_of(log_of("m1/0")).fold.table),
        "log": replace(whole, log=edited(LATTICE, len(LATTICE) - 1, percept=Percept(1, None))),
        "no evidence": without_merges(whole),
        "evidence of another log": replace(
            whole, fold=replace(whole.fold, meetings=cut.fold.meetings)
        ),
        "undetermined": replace(whole, statement="undetermined"),
        "impossible": replace(whole, statement="impossible"),
        "map of a log with open darts": replace(cut, statement="map"),
        "map that an incomplete log does not prove": with_table(
            replace(cut, statement="map"), whole.fold.table
        ),
    }


@pytest.mark.parametrize("kind", tampered())
def test_coqc_refuses_what_is_tampered_with(place: Path, kind: str) -> None:
    found = by_coqc(place, tampered()[kind])
    assert found.accepted is False
    assert "Error" in found.why


@pytest.mark.nightly
def test_coqc_certifies_a_lattice_of_10_by_10(place: Path) -> None:
    certificate = certificates.certificate_of(log_of(families.lattice(10, 10)))
    assert certificate.statement == "map"
    assert by_coqc(place, certificate).accepted


# ---------------------------------------------------------------- the delivered map


RUN = trace_of(families.lattice(3, 3))


def delivering(delivered: MapData) -> tuple[Event, ...]:
    return edited(RUN, len(RUN) - 1, map=delivered)


def right_map() -> MapData:
    end = typed(Finish, RUN[-1])
    return end.map


def relabelled() -> MapData:
    """The right map with other numbers for its darts, vertices, edges and ends in another order."""
    right = right_map()
    return MapData(
        tuple(tuple(9 + 7 * dart for dart in (*r[1:], r[0])) for r in right.vertices[::-1]),
        tuple((9 + 7 * y, 9 + 7 * x) for x, y in right.edges[::-1]),
        9 + 7 * some(right.marker),
    )


def wrong_maps() -> dict[str, MapData]:
    """The right map with one thing changed."""
    right = right_map()
    (a, b), (c, d), *edges = right.edges
    first, *vertices = right.vertices
    replaced = msgspec.structs.replace
    return {
        "edges": replaced(right, edges=((a, d), (c, b), *edges)),
        "edge too many": replaced(right, edges=(*right.edges, (a, b))),
        "edge to nowhere": replaced(right, edges=((a, 999), (c, d), *edges)),
        "edge left out": replaced(right, edges=((c, d), *edges)),
        "rotation": replaced(right, vertices=(first, *(r[::-1] for r in vertices))),
        "vertex without darts": replaced(right, vertices=(*right.vertices, ())),
        "dart twice": replaced(right, vertices=((*first, first[0]), *vertices)),
        "marker": replaced(right, marker=b),
        "marker nowhere": replaced(right, marker=999),
    }


@pytest.mark.parametrize("delivered", [right_map(), relabelled()])
def test_coqc_compares_the_delivered_map_with_the_proved_one(
    place: Path, delivered: MapData
) -> None:
    found = by_coqc(place, certificates.certificate_of(delivering(delivered)))
    assert found.accepted
    assert found.delivered


def test_a_delivered_map_that_is_not_the_proved_one_is_not_claimed_to_be() -> None:
    for kind, delivered in wrong_maps().items():
        assert certificates.certificate_of(delivering(delivered)).numbering is None, kind


@needs_ocaml
def test_a_wrong_delivered_map_is_refused_whatever_the_numbering(place: Path) -> None:
    for right in (right_map(), relabelled()):
        assert by_program(place, certificates.certificate_of(delivering(right))).delivered
    numbering = certificates.certificate_of(RUN).numbering
    for kind, delivered in wrong_maps().items():
        certificate = certificates.certificate_of(delivering(delivered))
        claimed = by_program(place, replace(certificate, numbering=numbering))
        assert claimed.accepted is False, kind
        assert by_program(place, certificate).delivered is False


@needs_ocaml
def test_a_wrong_numbering_of_the_right_map_is_refused(place: Path) -> None:
    certificate = certificates.certificate_of(RUN)
    one, two, *rest = some(certificate.numbering)
    for wrong in [(two, one, *rest), (one, two, *rest[:-1]), (one, one, *rest), ()]:
        assert by_program(place, replace(certificate, numbering=wrong)).accepted is False
    nothing = replace(certificate, log=certificate.log[:-1])
    assert by_program(place, nothing).accepted is False


@pytest.mark.parametrize("name", [operator.neg, (2**61).__add__])
def test_a_delivered_map_is_judged_whatever_its_numbers(
    place: Path, name: Callable[[int], int]
) -> None:
    right = delivering(with_darts(right_map(), name))
    assert by_coqc(place, certificates.certificate_of(right)).delivered
    assert certificate_format.left_out(right) == ""
    for kind, wrong in wrong_maps().items():
        certificate = certificates.certificate_of(delivering(with_darts(wrong, name)))
        assert isinstance(certificate.log[-1], Finish)
        assert certificate.numbering is None, kind


def test_a_number_that_is_changed_in_one_place_is_another_dart() -> None:
    """-5 and 5 are two darts, also once they are numbered anew."""
    first, *vertices = right_map().vertices
    wrong = msgspec.structs.replace(right_map(), vertices=((*first[:-1], -first[-1]), *vertices))
    assert first[-1] > 0
    assert certificates.certificate_of(delivering(wrong)).numbering is None


def test_a_delivered_value_that_is_no_map_is_left_out() -> None:
    for value in (MapData(((0, 1),), ((0, 1, 2),), 0), MapData(((0, 1),), ((0, 1),), None)):
        log = delivering(value)
        assert not of_type(Finish, certificates.certificate_of(log).log)
        assert "the delivered value cannot be stated" in certificate_format.left_out(log)


# ---------------------------------------------------------------- by the extracted program


@needs_ocaml
def test_the_extracted_program_agrees_on_every_log_of_small_worlds(place: Path) -> None:
    for log in logs():
        certificate = certificates.certificate_of(log)
        found = by_program(place, certificate)
        assert (found.accepted, found.statement) == (True, certificate.statement), certificate


@needs_ocaml
@pytest.mark.parametrize("kind", tampered())
def test_the_extracted_program_refuses_what_is_tampered_with(place: Path, kind: str) -> None:
    assert by_program(place, tampered()[kind]).accepted is False


@needs_ocaml
def test_kernel_and_program_refuse_numbers_that_are_no_certificate(place: Path) -> None:
    numbers = numbers_of(certificates.certificate_of(RUN))
    forged = {
        "truncated": numbers[:-1],
        "half": numbers[: len(numbers) // 2],
        "nothing": [],
        "more data": [*numbers, 0],
        "a count without an end": [*numbers[:2], 2**59, *numbers[3:]],
        "a dart beyond all": [*numbers[:-1], 2**59],
        "a door beyond all": [*numbers[:4], 2**59, *numbers[5:]],
        "a kind of event that is none": [*numbers[:3], 5, *numbers[4:]],
    }
    assert certificates.extracted(place, numbers, timeout=LIMIT).accepted
    for kind, one in forged.items():
        assert certificates.extracted(place, one, timeout=LIMIT).accepted is False, kind
        assert certificates.by_kernel(place, one, timeout=LIMIT).accepted is False, kind


@needs_ocaml
def test_the_extracted_program_reads_no_signs_and_no_words(place: Path) -> None:
    assert certificates.extracted(place, [1, -1], timeout=LIMIT).accepted is False
    for stdin in ("0x1", "accepted", "1_000", "2305843009213693952", "9" * 40):
        ran = toolchain.run([str(place / "certifier")], place, timeout=LIMIT, stdin=stdin)
        assert not ran.accepted, stdin
        assert "accepted" not in ran.output


@needs_ocaml
@pytest.mark.nightly
def test_the_extracted_program_certifies_ten_thousand_moves(place: Path) -> None:
    log = log_of(families.lattice(15, 15), "enhancement-ii")
    assert len(of_type(Move, log)) > 10_000
    assert by_program(place, certificates.certificate_of(log)).accepted


# ---------------------------------------------------------------- which of them


@pytest.mark.usefixtures("compiled")
def test_long_certificates_go_to_the_extracted_program(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[str] = []
    numbers = numbers_of(certificates.certificate_of(LATTICE))
    with certificates.checking(timeout=LIMIT, progress=told.append) as check:
        assert check(numbers).by == toolchain.version()
        monkeypatch.setattr(certificates, "LONG", 10)
        if shutil.which("ocamlfind"):
            assert check(numbers).by.startswith("the checker extracted by")
    assert told[:2] == ["compiling the proofs", "checking the certificate"]


def test_what_is_not_checked_is_not_accepted(
    monkeypatch: pytest.MonkeyPatch, library: Path
) -> None:
    del library
    numbers = numbers_of(certificates.certificate_of(LATTICE))
    with certificates.checking(timeout=0.01) as check:
        late = check(numbers)
        assert late.accepted is None
        assert "longer than 0.01 seconds" in late.why
        monkeypatch.setattr(shutil, "which", nowhere)
        without = check(numbers)
    assert without.accepted is None
    assert "coqc and coqchk not installed" in without.why


def test_a_log_with_too_many_doors_is_refused_before_anything_runs(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    wide = edited(LATTICE, 3, percept=Percept(2**60, None))
    with pytest.raises(InputError, match="doors together, and Coq counts at most 1,000,000"):
        certificates.certificate_of(wide)
    monkeypatch.setattr(shutil, "which", nowhere)
    certificate = certificates.certificate_of(LATTICE)
    with certificates.checking(timeout=LIMIT) as check:
        found = check(numbers_of(replace(certificate, log=wide)))
        assert (found.accepted, found.by) == (False, "topo-verify")
        assert "doors together: expected at most 1,000,000" in found.why
        larger = check([*numbers_of(certificate), 2**60 + 1])
        assert (larger.accepted, larger.why) == (False, "a number is larger than 2^60")
