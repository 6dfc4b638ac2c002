"""Decisions of real runs: accepted by coqc and the extracted program; refused if changed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
from msgspec.structs import replace as replace_struct

from tests.extra.certificates.test_certificates import by_coqc, by_program, needs_ocaml, numbers_of
from tests.extra.certificates.test_evidence import BACKWARDS
from tests.helpers import edited, fits, of_type, trace_of, typed, worlds
from tests.helpers import place as place_of
from tests.proofs.mechanised.conftest import LIMIT
from topo_verify import World, families
from topo_verify.algorithms import CATALOGUE
from topo_verify.extra.certificates import certificates, evidence
from topo_verify.extra.certificates.certificate_format import CoqCertificate, data_file
from topo_verify.proofs.mechanised import toolchain
from topo_verify.robot.events import Augment, Confirm, Event, Move, Reject
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


def all_accepted(place: Path, found: Sequence[CoqCertificate]) -> bool:
    """Whether the check, run by coqc on many certificates in one file, accepts each of them."""
    parts = [data_file(numbers_of(one)) for one in found]
    modules = [f"Module M{i}.\n{part}End M{i}.\n" for i, part in enumerate(parts)]
    each = "; ".join(f"M{i}.numbers" for i in range(len(parts)))
    goal = f"forallb Topo.Certificate.check_numbers [{each}]%list = true"
    head = "From Coq Require Import List.\nImport ListNotations.\nFrom Topo Require Certificate.\n"
    end = f"Goal {goal}.\nvm_compute. reflexivity. Qed.\n"
    (place / "Many.v").write_text("".join([head, *modules, end]))
    return toolchain.compile_one(place, "Many", timeout=LIMIT).accepted


# ---------------------------------------------------------------- accepted


def test_coqc_accepts_the_decisions_of_every_algorithm(place: Path) -> None:
    assert len(runs()) > 150
    assert all_accepted(place, runs())
    assert not all_accepted(place, [*runs()[:3], forged(another_reason)[0]])


@needs_ocaml
def test_the_extracted_program_accepts_them_too(place: Path) -> None:
    for certificate in runs():
        found = by_program(place, certificate)
        assert found.accepted, certificate
        assert found.certified == len(certificate.decisions.stated)


@needs_ocaml
@pytest.mark.nightly
def test_the_extracted_program_accepts_those_of_every_world_of_3_edges(place: Path) -> None:
    for world in worlds([3]):
        for name in CATALOGUE:
            if fits(name, world):
                certificate = certificates.certificate_of(trace_of(world, name))
                assert by_program(place, certificate).accepted, (name, world)


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("world", "mapper"),
    [("family:lattice(4,4)", "basic"), *((f"m5/{i}", "enhancement-iii-all") for i in (900, 5000))],
)
def test_coqc_accepts_the_decisions_of_larger_worlds(place: Path, world: str, mapper: str) -> None:
    maze = families.lattice(4, 4) if world.startswith("family") else World.from_id(world)
    certificate = certificates.certificate_of(trace_of(maze, mapper))
    assert certificate.decisions.stated
    found = by_coqc(place, certificate)
    assert (found.accepted, found.certified) == (True, len(certificate.decisions.stated))


# ---------------------------------------------------------------- forged

Forgery = Callable[[evidence.Fact], evidence.Fact | None]


def another_reason(fact: evidence.Fact) -> evidence.Fact | None:
    """The arc back, which does not leave by the dart."""
    reason = fact.reason
    return (
        replace(fact, reason=evidence.Arc(not reason.forwards, reason.visit))
        if isinstance(reason, evidence.Arc)
        else None
    )


def confirmed_instead(fact: evidence.Fact) -> evidence.Fact | None:
    """The reason for a rejection becomes one for a confirmation: an arc that leaves by the dart."""
    visit, door = fact.one
    moves = of_type(Move, lattice().log)
    if isinstance(fact.reason, evidence.Arc) or visit > len(moves) or moves[visit - 1].door != door:
        return None
    return replace(fact, reason=evidence.Arc(forwards=True, visit=visit))


def rejected_instead(fact: evidence.Fact) -> evidence.Fact | None:
    """The reason for a confirmation becomes one for a rejection."""
    why = evidence.EdgeRefutation((), evidence.Alone(fact.visit))
    return replace(fact, reason=why) if isinstance(fact.reason, evidence.Arc) else None


def evidence_cut(fact: evidence.Fact) -> evidence.Fact | None:
    """The last merge under the assumption is left out."""
    reason = fact.reason
    if isinstance(reason, evidence.Arc) or not reason.meetings:
        return None
    return replace(fact, reason=replace(reason, meetings=reason.meetings[:-1]))


def of_a_later_move(fact: evidence.Fact) -> evidence.Fact | None:
    """The arc is a move that was not made yet."""
    later = len(of_type(Move, lattice().log))
    return (
        replace(fact, reason=evidence.Arc(forwards=True, visit=later))
        if isinstance(fact.reason, evidence.Arc)
        else None
    )


FORGERIES: tuple[Forgery, ...] = (
    another_reason,
    confirmed_instead,
    rejected_instead,
    evidence_cut,
    of_a_later_move,
)


def with_decision(
    certificate: CoqCertificate, number: int, facts: Sequence[evidence.Fact]
) -> CoqCertificate:
    """The certificate with these facts for one of its decisions."""
    stated = list(certificate.decisions.stated)
    stated[number] = replace(stated[number], facts=tuple(facts))
    return replace(certificate, decisions=replace(certificate.decisions, stated=tuple(stated)))


def forged(forgery: Forgery) -> list[CoqCertificate]:
    """The lattice's certificate with one fact changed, for each that can be changed so."""
    found: list[CoqCertificate] = []
    for number, one in enumerate(lattice().decisions.stated):
        for place, fact in enumerate(one.facts):
            if (changed := forgery(fact)) is not None:
                facts = [*one.facts[:place], changed, *one.facts[place + 1 :]]
                found.append(with_decision(lattice(), number, facts))
    return found


def rearranged() -> list[CoqCertificate]:
    """No merges of the log; a reason too few, one too many, and two in another order."""
    without = replace(lattice(), decisions=replace(lattice().decisions, merges=()))
    stated = lattice().decisions.stated
    number = max(range(len(stated)), key=lambda i: len(stated[i].facts))
    facts = stated[number].facts
    assert len(facts) > 3
    changed = (facts[:-1], (*facts, facts[-1]), (facts[0], *facts[:0:-1]))
    return [without, *(with_decision(lattice(), number, one) for one in changed)]


def changed_logs() -> list[CoqCertificate]:
    """The events changed and the evidence kept: each change declares what does not follow."""
    log, found = lattice().log, list[tuple[Event, ...]]()
    for when, event in enumerate(log):
        if isinstance(event, Reject):
            found.append(edited(log, when, hypothesis=event.hypothesis + 1))
            found.append((*log[:when], Confirm(*_ends(event), "motion"), *log[when + 1 :]))
        elif isinstance(event, Augment):
            found.append(edited(log, when, degree=event.degree + 1))
            found.append(edited(log, when, dart=event.dart + 1))
            found.append(edited(log, when, edge=event.edge + 1))
            kind = "loop" if event.kind == "new" else "new"
            found.append(edited(log, when, kind=kind))
    return [replace(lattice(), log=log) for log in found]


def _ends(event: Reject) -> tuple[int, int]:
    return event.edge, event.hypothesis


def test_facts_that_are_not_changed_are_accepted(place: Path) -> None:
    found = by_coqc(place, with_decision(lattice(), 0, lattice().decisions.stated[0].facts))
    assert found.certified == found.decisions == len(lattice().decisions.stated) == 20


@pytest.mark.parametrize("forgery", FORGERIES)
def test_coqc_refuses_a_tampered_reason(place: Path, forgery: Forgery) -> None:
    assert by_coqc(place, forged(forgery)[-1]).accepted is False


@needs_ocaml
@pytest.mark.parametrize("forgery", FORGERIES)
def test_the_extracted_program_refuses_tampered_reasons(place: Path, forgery: Forgery) -> None:
    found = forged(forgery)
    assert found
    assert [by_program(place, one).accepted for one in found] == [False] * len(found)


@needs_ocaml
def test_the_extracted_program_refuses_another_order_and_missing_merges(place: Path) -> None:
    assert by_program(place, lattice()).accepted
    assert [by_program(place, one).accepted for one in rearranged()] == [False] * 4


@needs_ocaml
def test_the_extracted_program_refuses_changed_events(place: Path) -> None:
    found = changed_logs()
    assert len(found) > 50
    assert [by_program(place, one).accepted for one in found] == [False] * len(found)


# ---------------------------------------------------------------- mistranslated


def mistranslated(monkeypatch: pytest.MonkeyPatch) -> CoqCertificate:
    """A false rejection, which a planted mistake takes for one that follows.

    In place of a confirmation stands the rejection of the same hypothesis. The mistake: where it is
    translated into places, another hypothesis stands for it, which was in fact refuted.
    """
    trace = trace_of(families.lattice(3, 3))
    rejections = {event.edge: event for event in trace if isinstance(event, Reject)}
    when, confirmed = next(
        (when, event)
        for when, event in enumerate(trace)
        if isinstance(event, Confirm) and event.edge in rejections
    )
    rejected = rejections[confirmed.edge]
    lie = replace_struct(rejected, hypothesis=confirmed.hypothesis)
    log = (*trace[:when], lie, *trace[when + 1 :])
    followed = [i for i, e in enumerate(log) if isinstance(e, Reject | Confirm | Augment)]

    def following(_: Sequence[Event]) -> Iterator[tuple[int, Event]]:
        return ((i, log[i]) for i in followed)

    monkeypatch.setattr(evidence, "following", following)
    facts = evidence.LogSoFar.facts

    def mistaken(
        log: evidence.LogSoFar, event: evidence.DeclaredDecision
    ) -> tuple[evidence.Fact, ...]:
        return facts(log, rejected if event is lie else event)

    monkeypatch.setattr(evidence.LogSoFar, "facts", mistaken)
    return certificates.certificate_of(log)


def test_a_false_rejection_that_python_mistranslates_is_refused(
    place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    certificate = mistranslated(monkeypatch)
    assert len(certificate.decisions.stated) == len(lattice().decisions.stated)
    assert by_coqc(place, certificate).accepted is False


# ---------------------------------------------------------------- left out


def test_decisions_that_do_not_follow_have_no_reasons(place: Path) -> None:
    log = trace_of(families.lattice(3, 3))
    when = place_of(log, Reject)
    rejected = typed(Reject, log[when])
    wrong = (*log[:when], Confirm(rejected.edge, rejected.hypothesis, "motion"), *log[when + 1 :])
    found = by_coqc(place, certificates.certificate_of(wrong))
    assert found.accepted
    assert found.certified == found.decisions - 1


@needs_ocaml
def test_after_a_new_vertex_that_is_not_proved_nothing_is_accepted(place: Path) -> None:
    for number, one in enumerate(lattice().decisions.stated[:-1]):
        event = lattice().log[one.when]
        found = by_program(place, with_decision(lattice(), number, ()))
        assert found.accepted is not isinstance(event, Augment), event


def test_a_decision_about_no_dart_is_left_out_with_all_after_it(place: Path) -> None:
    log = trace_of(families.lattice(3, 3))
    when = place_of(log, Reject)
    certificate = certificates.certificate_of(edited(log, when, hypothesis=-1))
    before = [
        one for one in lattice().decisions.stated if one.when < certificate.log.index(log[when - 1])
    ]
    found = by_coqc(place, certificate)
    assert (found.accepted, found.certified, found.decisions) == (True, len(before), len(before))


def test_evidence_that_is_too_long_is_left_out(
    place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(evidence, "MOST", 100)
    certificate = certificates.certificate_of(trace_of(families.lattice(3, 3)))
    assert certificate.decisions.too_long
    found = by_coqc(place, certificate)
    assert (found.accepted, found.statement, found.certified) == (True, "map", 0)
