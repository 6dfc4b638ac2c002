"""Decisions of real runs: accepted by coqc and the extracted program; refused if changed."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from tests.helpers import edited, fits, of_type, trace_of, worlds
from tests.proofs.mechanised.conftest import LIMIT
from tests.proofs.mechanised.test_certificates import needs_ocaml
from tests.proofs.mechanised.test_decision_evidence import BACKWARDS
from topo_verify import World, families
from topo_verify.algorithms import CATALOGUE
from topo_verify.proofs.mechanised import certificates, toolchain, vernacular
from topo_verify.proofs.mechanised import decision_evidence as evidence
from topo_verify.proofs.mechanised.decision_evidence import EdgeRefutation, EntailedDecision, Fact
from topo_verify.proofs.mechanised.evidence import Alone, Arc
from topo_verify.proofs.mechanised.vernacular import CoqCertificate, coq_file
from topo_verify.robot.events import Reject
from topo_verify.world.enumeration.rank_order import count


def some(edges: int, number: int) -> list[World]:
    """A few of the worlds with so many edges, evenly over their ids."""
    return [World.from_id(f"m{edges}/{index * count(edges) // number}") for index in range(number)]


@cache
def runs() -> tuple[CoqCertificate, ...]:
    """Every algorithm in every world of up to 2 edges, and in some of 3 to 5."""
    small = [*worlds((1, 2)), *some(3, 4), *some(4, 3), *some(5, 3)]
    found = [
        certificates.certificate_of(trace_of(world, name))
        for world in small
        for name in CATALOGUE
        if fits(name, world)
    ]
    trace = trace_of("m3/5")
    first = of_type(Reject, trace)[0]
    itself = edited(trace, trace.index(first), hypothesis=first.edge)
    found += map(certificates.certificate_of, (BACKWARDS, itself))
    return tuple(one for one in found if one.decisions.stated)


@cache
def lattice() -> CoqCertificate:
    return certificates.certificate_of(trace_of(families.lattice(3, 3)))


def together(certificates: Sequence[CoqCertificate]) -> str:
    """Many certificates in one file, a module each, asked together what they rest on."""
    parts: list[str] = []
    for number, one in enumerate(certificates):
        head, imports, body = coq_file(one).partition("CheckerCorrect Decisions.\n")
        body = re.sub(r"^Print Assumptions \w+\.$", "", body, flags=re.MULTILINE)
        parts.append(f"{'' if number else head + imports}Module M{number}.\n{body}End M{number}.\n")
    names = ("proved", "decisions_follow")
    theorems = [f"M{i}.{name}" for i in range(len(parts)) for name in names]
    parts.append(f"Definition every := ({', '.join(theorems)}).\nPrint Assumptions every.\n")
    return "".join(parts)


def by_coqc(place: Path, text: str) -> certificates.CertificateCheck:
    return certificates.by_kernel(place, "Decisions_of_the_test", text, timeout=LIMIT)


def by_program(place: Path, certificate: CoqCertificate) -> bool | None:
    return certificates.extracted_decisions(place, certificate, timeout=LIMIT).accepted


# ---------------------------------------------------------------- accepted


def test_coqc_accepts_the_decisions_of_every_algorithm(place: Path) -> None:
    text = together(runs())
    assert text.count("Theorem decisions_follow") == len(runs()) > 150
    assert by_coqc(place, text) == certificates.CertificateCheck(True, toolchain.version())


@needs_ocaml
def test_the_extracted_program_accepts_them_too(place: Path) -> None:
    for certificate in runs():
        assert by_program(place, certificate), certificate


@needs_ocaml
@pytest.mark.slow
def test_the_extracted_program_accepts_those_of_every_world_of_3_edges(place: Path) -> None:
    for world in worlds([3]):
        for name in CATALOGUE:
            if fits(name, world):
                certificate = certificates.certificate_of(trace_of(world, name))
                assert by_program(place, certificate), (name, world)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("world", "mapper"),
    [("family:lattice(4,4)", "basic"), *((f"m5/{i}", "enhancement-iii-all") for i in (900, 5000))],
)
def test_coqc_accepts_the_decisions_of_larger_worlds(place: Path, world: str, mapper: str) -> None:
    maze = families.lattice(4, 4) if world.startswith("family") else World.from_id(world)
    certificate = certificates.certificate_of(trace_of(maze, mapper))
    assert certificate.decisions.stated
    assert by_coqc(place, coq_file(certificate)).accepted


# ---------------------------------------------------------------- forged

Forgery = Callable[[Fact], Fact | None]


def another_place(fact: Fact) -> Fact | None:
    """The edge leads, or does not lead, elsewhere: to the next dart there."""
    visit, door = fact.other
    turned = (door + 1) % lattice().percepts[visit - 1].degree
    return replace(fact, other=(visit, turned)) if isinstance(fact.reason, Arc) else None


def confirmed_instead(fact: Fact) -> Fact | None:
    """A rejection turned into a confirmation, by an arc that does leave by the dart."""
    (visit, door), reason = fact.one, fact.reason
    if isinstance(reason, Arc) or not reason.meetings or lattice().doors[visit - 1] != door:
        return None
    return replace(fact, reason=Arc(True, visit))


def rejected_instead(fact: Fact) -> Fact | None:
    """A confirmation turned into a rejection."""
    why = EdgeRefutation((), Alone(fact.visit))
    return replace(fact, reason=why) if isinstance(fact.reason, Arc) else None


def evidence_cut(fact: Fact) -> Fact | None:
    """The last merge under the assumption is left out."""
    reason = fact.reason
    if isinstance(reason, Arc) or not reason.meetings:
        return None
    return replace(fact, reason=replace(reason, meetings=reason.meetings[:-1]))


def a_move_early(fact: Fact) -> Fact | None:
    """Decided one move before: the robot had not come in there yet."""
    return replace(fact, visit=fact.visit - 1) if fact.other == (fact.visit, 0) else None


def a_move_late(fact: Fact) -> Fact | None:
    """Decided with a visit that the log does not have."""
    return replace(fact, visit=len(lattice().percepts) + 1)


FORGERIES: tuple[Forgery, ...] = (
    another_place,
    confirmed_instead,
    rejected_instead,
    evidence_cut,
    a_move_early,
    a_move_late,
)


def with_facts(certificate: CoqCertificate, facts: Sequence[Fact]) -> CoqCertificate:
    """The certificate with these facts in place of its own."""
    stated = (EntailedDecision(0, "changed", tuple(facts)),)
    return replace(certificate, decisions=replace(certificate.decisions, stated=stated))


def facts_of(certificate: CoqCertificate) -> list[Fact]:
    return [fact for one in certificate.decisions.stated for fact in one.facts]


def forged(forgery: Forgery) -> list[CoqCertificate]:
    """The lattice's certificate with one fact changed, for each that can be changed so."""
    facts = facts_of(lattice())
    found: list[CoqCertificate] = []
    for number, fact in enumerate(facts):
        if (changed := forgery(fact)) is not None:
            found.append(with_facts(lattice(), [*facts[:number], changed, *facts[number + 1 :]]))
    return found


def rearranged() -> list[CoqCertificate]:
    """Facts in another order, and without the merges of the log."""
    without = replace(lattice(), decisions=replace(lattice().decisions, merges=()))
    return [with_facts(lattice(), facts_of(lattice())[::-1]), without]


def test_facts_that_are_not_changed_are_accepted(place: Path) -> None:
    same = with_facts(lattice(), facts_of(lattice()))
    assert by_coqc(place, coq_file(same)).accepted


@pytest.mark.parametrize("forgery", FORGERIES)
def test_coqc_refuses_a_tampered_decision(place: Path, forgery: Forgery) -> None:
    checked = by_coqc(place, coq_file(forged(forgery)[-1]))
    assert checked.accepted is False
    assert "decided log merges decisions reasons" in " ".join(checked.why.split())


@pytest.mark.parametrize("which", [0, 1])
def test_coqc_refuses_another_order_and_missing_merges(place: Path, which: int) -> None:
    checked = by_coqc(place, coq_file(rearranged()[which]))
    assert checked.accepted is False
    assert "decided log merges decisions reasons" in " ".join(checked.why.split())


def test_coqc_refuses_a_decision_without_a_reason(place: Path) -> None:
    text = coq_file(lattice())
    reasons = text.index("Definition reasons")
    short = text[:reasons] + text[reasons:].replace("[Joined (true, 1%positive);", "[", 1)
    assert short != text
    assert by_coqc(place, short).accepted is False


def test_coqc_refuses_decisions_that_are_admitted(place: Path) -> None:
    text = coq_file(lattice())
    begin = text.index("Proof. apply (decided_correct")
    forged = f"{text[:begin]}Admitted.\n\nPrint Assumptions decisions_follow.\n"
    assert by_coqc(place, forged).accepted is False


@needs_ocaml
@pytest.mark.parametrize("forgery", FORGERIES)
def test_the_extracted_program_refuses_tampered_decisions(place: Path, forgery: Forgery) -> None:
    found = forged(forgery)
    assert found
    assert [by_program(place, one) for one in found] == [False] * len(found)


@needs_ocaml
def test_the_extracted_program_refuses_another_order_and_missing_merges(place: Path) -> None:
    assert by_program(place, lattice())
    assert [by_program(place, one) for one in rearranged()] == [False, False]


# ---------------------------------------------------------------- who checks


@pytest.fixture
def linked(monkeypatch: pytest.MonkeyPatch, library: Path) -> None:
    """The library is not compiled again."""

    def link(folder: Path, *, timeout: float) -> None:
        del timeout
        for path in library.glob("*.v*"):
            (folder / path.name).symlink_to(path)

    monkeypatch.setattr(certificates, "build", link)


@pytest.mark.usefixtures("linked")
def test_decisions_are_checked_with_the_map_by_coqc() -> None:
    with certificates.checking(timeout=LIMIT) as check:
        assert check("short", lattice()) == certificates.CertificateCheck(True, toolchain.version())


@needs_ocaml
@pytest.mark.usefixtures("linked")
def test_decisions_with_long_evidence_go_to_the_extracted_program(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(vernacular, "MANY", 100)
    assert "too much evidence for Coq's kernel" in coq_file(lattice())
    assert "decisions_follow" not in coq_file(lattice())
    with certificates.checking(timeout=LIMIT) as check:
        found = check("many", lattice())
        assert (found.accepted, found.by) == (True, toolchain.version())
        assert found.decisions is not None
        assert found.decisions.accepted
        assert found.decisions.by.startswith("the checker extracted by")
        refused = check("forged", forged(evidence_cut)[0]).decisions
        assert refused is not None
        assert refused.accepted is False
        monkeypatch.setattr(certificates, "LONG", 10)
        monkeypatch.setattr(vernacular, "MANY", 10_000)
        both = check("long", lattice())
        assert both.by == getattr(both.decisions, "by", "")
        assert both.by.startswith("the checker extracted by")


@pytest.mark.usefixtures("linked")
def test_decisions_that_nobody_can_check_are_not_accepted(monkeypatch: pytest.MonkeyPatch) -> None:
    which = shutil.which

    def no_compiler(program: str) -> str | None:
        return None if program == "ocamlfind" else which(program)

    monkeypatch.setattr(shutil, "which", no_compiler)
    monkeypatch.setattr(vernacular, "MANY", 100)
    with certificates.checking(timeout=LIMIT) as check:
        found = check("many", lattice())
        assert found.accepted
        assert found.decisions is not None
        assert found.decisions.accepted is None
        assert "ocamlfind is not installed" in found.decisions.why
        monkeypatch.setattr(evidence, "MOST", 100)
        given_up = check("most", certificates.certificate_of(trace_of(families.lattice(3, 3))))
        assert given_up.decisions is not None
        assert given_up.decisions.accepted is None
        assert "more than" in given_up.decisions.why
