"""The result of a check: a status for each claim, and a finding for each thing that is wrong."""

from __future__ import annotations

from typing import Any, Literal

import msgspec

Verdict = Literal["PROVED", "EXHAUSTED", "SAMPLED", "UNKNOWN", "REFUTED"]
"""It speaks of worlds of any size (PROVED), of a finite class, of some worlds, or of none."""

Status = Literal["ok", "failed", "partial", "not-declared", "not-asked", "undecided"]
"""Only `ok`, nothing wrong in all that there was to judge, says that a claim holds.

`partial`: the mapper declared some of the decisions that the claim speaks of; `not-declared`: none.
`not-asked`: the world is too large unless `strict`. `undecided`: a decision was neither proved nor
refuted.
"""


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
    """The status of one claim in one run, and its findings.

    Attributes:
        judged, of: how many things were judged, of how many (docs/semantics.md, section 9).
    """

    claim: str
    status: Status
    judged: int
    of: int
    findings: tuple[Finding, ...] = ()
