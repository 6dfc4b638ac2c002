"""The result of a check: a status for each claim, and a finding for each thing that is wrong."""

from __future__ import annotations

from typing import Any, Literal

import msgspec

Verdict = Literal["PROVED", "EXHAUSTED", "SAMPLED", "UNKNOWN", "REFUTED"]
"""A conclusion about worlds of any size, about every world of a finite class, about some worlds,
about none, or a counterexample (docs/semantics.md, section 16)."""

Status = Literal["ok", "failed", "partial", "not-declared", "not-asked", "undecided"]
"""`ok`: all that there was to judge was judged, and nothing is wrong. `partial`: the mapper
declared some of the decisions that the claim speaks of; `not-declared`: none. `not-asked`: the
world is too large for this claim unless `strict` is asked for. `undecided`: a decision was neither
proved nor refuted. Only `ok` says that the claim holds."""


class Finding(msgspec.Struct, frozen=True):
    """One thing that is wrong.

    Attributes:
        claim: which claim of docs/semantics.md, section 9 fails.
        event: the index in the trace, or None if it is about the run as a whole.
        expected, seen: what should be there, what is.
        message: one sentence.
        witness: a world with the same history in which the mapper is wrong (its id; beyond 200
            edges its JSON), for the claims on what a history proves.
        world, replay: which world, and the command line that shows it again.
    """

    claim: str
    event: int | None
    expected: Any
    seen: Any
    message: str
    witness: str | None = None
    world: str = ""
    replay: str = ""


class Judgement(msgspec.Struct, frozen=True):
    """The status of one claim in one run, how much of the run it rests on, and its findings.

    Attributes:
        judged, of: how many things were judged, of how many (docs/semantics.md, section 9).
    """

    claim: str
    status: Status
    judged: int
    of: int
    findings: tuple[Finding, ...] = ()
