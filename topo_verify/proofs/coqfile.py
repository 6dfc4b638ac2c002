"""A certificate written down: as a source of Coq, and as numbers for the extracted program.

Source: docs/mechanised.md; coq/Checker.v; coq/driver.ml.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from topo_verify.proofs.evidence import Alone, Arc, Arrive, Folded, Illegal, Marked, Meeting
from topo_verify.robot.percept import Door, Percept

Statement = Literal["map", "undetermined", "impossible"]


@dataclass(frozen=True, slots=True)
class Certificate:
    """A statement about one log, with what a checker needs to see that it is true.

    Attributes:
        statement: which of the three.
        percepts, doors: the log.
        fold: map, evidence and conflict; not trusted.
    """

    statement: Statement
    percepts: tuple[Percept, ...]
    doors: tuple[Door, ...]
    fold: Folded


# ---------------------------------------------------------------- as a file of Coq

_THEOREM: dict[Statement, str] = {
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


def coq_file(certificate: Certificate) -> str:
    """The certificate as a source of Coq: log, map, evidence, statement and proof."""
    fold, percepts = certificate.fold, certificate.percepts
    moves = [
        f"({door}, {_percept(percept)})"
        for door, percept in zip(certificate.doors, percepts[1:], strict=True)
    ]
    rows = [f"({r.following}, {r.previous}, {_option(r.other)})" for r in fold.table]
    conflict = fold.conflict or Illegal()
    return f"""\
(* A certificate by topo-verify: {len(moves)} moves, {len(rows)} darts, {len(fold.meetings)} merges.
   It says what World.v and Log.v define and nothing else; map and evidence are not trusted. *)
From Coq Require Import List PArith.
Import ListNotations.
From Topo Require Import World Log Table TableCorrect Checker CheckerCorrect.

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
"""


def _percept(percept: Percept) -> str:
    return f"({percept.degree}, {_option(percept.marker)})"


def _option(number: int | None) -> str:
    return "None" if number is None else f"Some {number}"


def _arc(arc: Arc) -> str:
    return f"({str(arc.forwards).lower()}, {arc.visit}%positive)"


def _meeting(meeting: Meeting) -> str:
    return f"({_arc(meeting[0])}, {_arc(meeting[1])})"


def _conflict(conflict: Arrive | Marked | Alone | Illegal) -> str:
    match conflict:
        case Arrive(meeting):
            return f"Arrive {_meeting(meeting)}"
        case Alone(visit):
            return f"Alone {visit}%positive"
        case Marked(visit):
            return f"Marked {visit}%positive"
        case Illegal():
            return "Marked 1%positive"  # none: the log is illegal, or some world shows it


def _lines(entries: Iterable[str]) -> str:
    return f"[{'; '.join(entries)}]".replace("; ", ";\n  ")


# ---------------------------------------------------------------- as numbers


def numbers(certificate: Certificate) -> str:
    """The certificate as the extracted program reads it; coq/driver.ml says how."""
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


def _counted(entries: Sequence[str]) -> str:
    return "\n".join([str(len(entries)), *entries])


def _seen(percept: Percept) -> str:
    return f"{percept.degree} {_optional(percept.marker)}"


def _optional(number: int | None) -> str:
    return "-1" if number is None else str(number)


def _pair(meeting: Meeting) -> str:
    return " ".join(f"{int(arc.forwards)} {arc.visit}" for arc in meeting)


def _pointed(conflict: Arrive | Marked | Alone | Illegal) -> str:
    match conflict:
        case Arrive(meeting):
            return f"a {_pair(meeting)}"
        case Alone(visit):
            return f"e {visit}"
        case Marked(visit):
            return f"m {visit}"
        case Illegal():
            return "m 1"
