"""Certificates about the world of one vertex without an edge: what Coq accepts, and refuses."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pytest

from tests.extra.certificates.test_certificates import LATTICE, by_coqc, by_program, needs_ocaml
from tests.helpers import EMPTY, edited, trace_of, typed
from topo_verify.extra.certificates import certificates, evidence
from topo_verify.extra.certificates.certificate_format import CoqCertificate
from topo_verify.robot.events import Finish, Reject

POINT = trace_of(EMPTY)
"""Degree 0, no move, and a map of one vertex without a dart."""


def of_point(**other_map: Any) -> CoqCertificate:
    """The certificate of the run in the world without an edge; with `other_map` delivered."""
    right = typed(Finish, POINT[-1])
    delivered = msgspec.structs.replace(right.map, **other_map)
    return certificates.certificate_of(edited(POINT, 1, map=delivered))


def test_the_world_without_an_edge_is_certified_with_its_map(place: Path) -> None:
    found = by_coqc(place, of_point())
    assert (found.accepted, found.statement, found.delivered) == (True, "map", True)
    cut = by_coqc(place, certificates.certificate_of(POINT[:1]))
    assert (cut.accepted, cut.statement, cut.delivered) == (True, "map", False)


@pytest.mark.parametrize(
    "other",
    [{"vertices": ((), ())}, {"vertices": ()}, {"edges": ((0, 1),)}, {"marker": 0},
     {"vertices": ((0, 1),), "edges": ((0, 1),), "marker": 0}],
)  # fmt: skip
def test_another_map_is_not_claimed_to_be_that_world(other: dict[str, Any]) -> None:
    assert of_point(**other).numbering is None


@needs_ocaml
def test_false_claims_about_the_world_without_an_edge_are_refused(place: Path) -> None:
    right, leaf = of_point(), certificates.certificate_of(trace_of("m1/0"))
    rejection = next(event for event in trace_of("m3/5") if isinstance(event, Reject))
    decided = (POINT[0], rejection, POINT[1])
    reason = evidence.EntailedDecision(1, (reason_for_nothing(),))
    forged = {
        "no world shows it": replace(right, statement="impossible", fold=conflicting(right)),
        "two worlds show it": replace(right, statement="undetermined"),
        "it is the map of a longer log": replace(right, log=(POINT[0], *LATTICE[1:2])),
        "it is the map of another log": replace(right, log=LATTICE[:1]),
        "its map is a leaf": replace(right, fold=leaf.fold),
        "two vertices are that world": replace(
            of_point(vertices=((), ())), numbering=right.numbering
        ),
        "a pair is that world": replace(of_point(edges=((0, 1),)), numbering=right.numbering),
        "no map was delivered": replace(
            certificates.certificate_of(POINT[:1]), numbering=right.numbering
        ),
        "a decision follows there": replace(
            right, log=decided, decisions=replace(right.decisions, stated=(reason,))
        ),
    }
    assert by_program(place, right).accepted
    assert by_program(place, replace(right, log=decided)).accepted
    for kind, one in forged.items():
        assert by_program(place, one).accepted is False, kind


def conflicting(certificate: CoqCertificate) -> evidence.FoldedLog:
    """The fold of an impossible log, without evidence."""
    return replace(certificate.fold, conflict=evidence.Illegal())


def reason_for_nothing() -> evidence.Fact:
    """A reason why two places are not the ends of an edge, where there is no place."""
    return evidence.Fact(1, (1, 0), (1, 0), evidence.EdgeRefutation((), evidence.Alone(1)))
