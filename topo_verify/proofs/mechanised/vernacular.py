"""A certificate as text: a source of Coq, or numbers for the extracted program.

Source: docs/mechanised.md; coq/Checker.v; coq/driver.ml.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from topo_verify.proofs.mechanised.decision_evidence import (
    EntailedDecision,
    EntailedDecisions,
    Fact,
)
from topo_verify.proofs.mechanised.evidence import (
    Alone,
    Arc,
    Arrive,
    Conflict,
    FoldedLog,
    Illegal,
    LogPlace,
    Marked,
    Meeting,
)
from topo_verify.robot.percept import Door, Percept

CertifiedStatement = Literal["map", "undetermined", "impossible"]

MANY = 50_000
"""Longer evidence for decisions is not written for Coq, whose kernel would take minutes."""


@dataclass(frozen=True, slots=True)
class CoqCertificate:
    """A statement about one log, with the evidence that a checker needs to verify it.

    Attributes:
        statement: one of the three at the head of certificates.py.
        percepts, doors: the log.
        fold: map, evidence and conflict; not trusted.
        decisions: the decisions of the trace that follow, with evidence; not trusted either.
    """

    statement: CertifiedStatement
    percepts: tuple[Percept, ...]
    doors: tuple[Door, ...]
    fold: FoldedLog
    decisions: EntailedDecisions

    @property
    def writes_decisions(self) -> bool:
        """Whether there are decisions whose evidence is short enough for Coq's kernel."""
        return bool(self.decisions.stated) and self.decisions.steps <= MANY


# ---------------------------------------------------------------- as a file of Coq

_THEOREM: dict[CertifiedStatement, str] = {
    "map": """\
(* The map is a world; it shows the log; every world that shows the log is isomorphic to it. *)
Theorem proved : world (map_of table) /\\ replays (map_of table) log /\\
  forall W, world W -> replays W log -> isomorphic (map_of table) W.
Proof. apply (certified_correct log table evidence). vm_cast_no_check (eq_refl true). Qed.""",
    "undetermined": """\
(* Two worlds of different size show the log. *)
Theorem proved : exists W1 W2, world W1 /\\ world W2 /\\
  replays W1 log /\\ replays W2 log /\\ darts W1 <> darts W2.
Proof. apply (refute_correct log table). vm_cast_no_check (eq_refl true). Qed.""",
    "impossible": """\
(* No world shows the log. *)
Theorem proved : forall W, world W -> ~ replays W log.
Proof. apply (impossible_correct log evidence conflict). vm_cast_no_check (eq_refl true). Qed.""",
}


_TOO_LONG = """
(* The decisions of the log are not stated here: too much evidence for Coq's kernel. *)
"""

_DECISIONS_FOLLOW = """\
(* Each decision holds in every world that shows the log up to its visit. *)
Theorem decisions_follow : forall d, In d decisions -> follows log d.
Proof. apply (decided_correct log merges decisions reasons). vm_cast_no_check (eq_refl true). Qed.

Print Assumptions decisions_follow.
"""


def coq_file(certificate: CoqCertificate) -> str:
    """The certificate as a source of Coq: log, map, evidence, statements and proofs."""
    fold, percepts = certificate.fold, certificate.percepts
    moves = [
        f"({door}, {_percept(percept)})"
        for door, percept in zip(certificate.doors, percepts[1:], strict=True)
    ]
    rows = [f"({r.following}, {r.previous}, {_option(r.other)})" for r in fold.table]
    conflict = fold.conflict or Illegal()  # a filler: the file always defines one
    decisions = certificate.decisions
    files, imports, decisions_text = "World.v and Log.v", "CheckerCorrect", ""
    if certificate.writes_decisions:
        files, imports = "World.v, Log.v and Decisions.v", f"{imports} Decisions"
        decisions_text = _decisions(decisions)
    elif decisions.steps > MANY:
        decisions_text = _TOO_LONG
    return f"""\
(* A certificate by topo-verify: {len(moves)} moves, {len(rows)} darts, {len(fold.meetings)} merges.
   It says what {files} define and nothing else; map and evidence are not trusted. *)
From Coq Require Import List PArith.
Import ListNotations.
From Topo Require Import World Log Table TableCorrect Checker {imports}.

(* The percept at the start, then each door with the percept behind it: degree, marker. *)
Definition log := {{| start := {_percept(percepts[0])}; moves := {_lines(moves)} |}}.

(* The map: for each dart the next and the previous one clockwise, and the other one of its edge. *)
Definition table : map_table := {_lines(rows)}.

(* Arcs that leave by one dart: forwards?, the visit that the move starts from. *)
Definition evidence : evidence := {_lines(map(_meeting, fold.meetings))}.

(* What contradicts, if something does. *)
Definition conflict := {_conflict(conflict)}.

{_THEOREM[certificate.statement]}

Print Assumptions proved.
{decisions_text}"""


def _decisions(decisions: EntailedDecisions) -> str:
    facts = [fact for one in decisions.stated for fact in one.facts]
    # The file defines a list called `evidence` before this, so the type needs its module's name.
    return f"""
(* What was decided, and at which visit: an edge leads from a place to another, or none does.
   A place is a visit and a door there. Visits are counted from 1, events of the trace from 0. *)
Definition decisions : list decision := {_lines(_declared(decisions.stated))}.

(* Arcs that leave by one dart, up to the last decision. *)
Definition merges : Checker.evidence := {_lines(map(_meeting, decisions.merges))}.

(* Why: the arc that joins the two; or what an edge between them makes one, and what contradicts. *)
Definition reasons : list reason := {_lines(map(_reason, facts))}.

{_DECISIONS_FOLLOW}"""


def _declared(stated: Iterable[EntailedDecision]) -> Iterator[str]:
    for one in stated:
        for number, fact in enumerate(one.facts):
            comment = "" if number else f"(* event {one.when}, {one.words} *)\n  "
            verb = "Leads" if isinstance(fact.reason, Arc) else "LeadsNot"
            yield f"{comment}{verb} {fact.visit} {_place(fact.one)} {_place(fact.other)}"


def _place(place: LogPlace) -> str:
    return f"({place[0]}%positive, {place[1]})"


def _reason(fact: Fact) -> str:
    match fact.reason:
        case Arc() as arc:
            return f"Joined {_arc(arc)}"
        case why:
            meetings = "; ".join(map(_meeting, why.meetings))
            return f"Refuted [{meetings}] ({_conflict(why.conflict)})"


def _percept(percept: Percept) -> str:
    return f"({percept.degree}, {_option(percept.marker)})"


def _option(number: int | None) -> str:
    return "None" if number is None else f"Some {number}"


def _arc(arc: Arc) -> str:
    return f"({str(arc.forwards).lower()}, {arc.visit}%positive)"


def _meeting(meeting: Meeting) -> str:
    return f"({_arc(meeting[0])}, {_arc(meeting[1])})"


def _conflict(conflict: Conflict) -> str:
    match conflict:
        case Arrive(meeting):
            return f"Arrive {_meeting(meeting)}"
        case Alone(visit):
            return f"Alone {visit}%positive"
        case Marked(visit):
            return f"Marked {visit}%positive"
        case Illegal():
            return "Marked 1%positive"  # a filler: the log is illegal, or some world shows it


def _lines(entries: Iterable[str]) -> str:
    return f"[{'; '.join(entries)}]".replace("; ", ";\n  ")


# ---------------------------------------------------------------- as numbers


def numbers(certificate: CoqCertificate) -> str:
    """The certificate in the format that coq/driver.ml describes and the program reads."""
    fold = certificate.fold
    moves = zip(certificate.doors, certificate.percepts[1:], strict=True)
    conflict = fold.conflict or Illegal()
    parts = [
        certificate.statement,
        _seen(certificate.percepts[0]),
        _counted([f"{door} {_seen(percept)}" for door, percept in moves]),
        _counted([f"{r.following} {r.previous} {_optional(r.other)}" for r in fold.table]),
        _counted([_pair(meeting) for meeting in fold.meetings]),
        _pointed(conflict),
    ]
    return "\n".join(parts) + "\n"


def numbers_of_decisions(certificate: CoqCertificate) -> str:
    """The decisions of a certificate in that format."""
    moves = zip(certificate.doors, certificate.percepts[1:], strict=True)
    decisions = certificate.decisions
    parts = [
        "decisions",
        _seen(certificate.percepts[0]),
        _counted([f"{door} {_seen(percept)}" for door, percept in moves]),
        _counted([_pair(meeting) for meeting in decisions.merges]),
        _counted([_fact(fact) for one in decisions.stated for fact in one.facts]),
    ]
    return "\n".join(parts) + "\n"


def _fact(fact: Fact) -> str:
    leads = isinstance(fact.reason, Arc)
    places = (fact.visit, *fact.one, *fact.other)
    return f"{int(leads)} {' '.join(map(str, places))} {_because(fact)}"


def _because(fact: Fact) -> str:
    match fact.reason:
        case Arc(forwards, visit):
            return f"j {int(forwards)} {visit}"
        case why:
            meetings = " ".join([str(len(why.meetings)), *map(_pair, why.meetings)])
            return f"r {meetings} {_pointed(why.conflict)}"


def _counted(entries: Sequence[str]) -> str:
    return "\n".join([str(len(entries)), *entries])


def _seen(percept: Percept) -> str:
    return f"{percept.degree} {_optional(percept.marker)}"


def _optional(number: int | None) -> str:
    return "-1" if number is None else str(number)


def _pair(meeting: Meeting) -> str:
    return " ".join(f"{int(arc.forwards)} {arc.visit}" for arc in meeting)


def _pointed(conflict: Conflict) -> str:
    match conflict:
        case Arrive(meeting):
            return f"a {_pair(meeting)}"
        case Alone(visit):
            return f"e {visit}"
        case Marked(visit):
            return f"m {visit}"
        case Illegal():
            return "m 1"
