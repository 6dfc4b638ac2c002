"""What a check says: a status for each claim, and a finding for each thing that is wrong."""

from __future__ import annotations

from typing import Any, Literal

import msgspec

Status = Literal["ok", "failed", "not-declared"]
"""`not-declared`: the mapper declared no decision that the claim speaks of. That is not `ok`."""


class Finding(msgspec.Struct, frozen=True):
    """One thing that is wrong.

    Attributes:
        claim: which claim of SPEC section 7 fails.
        event: the index in the trace, or None if it is about the run as a whole.
        expected, seen: what should be there, what is.
        message: one sentence.
        world: which world; filled in by who knows its name.
        replay: the command line that shows it again; filled in likewise.
    """

    claim: str
    event: int | None
    expected: Any
    seen: Any
    message: str
    world: str = ""
    replay: str = ""


class Judgement(msgspec.Struct, frozen=True):
    """What became of one claim in one run."""

    claim: str
    status: Status
    findings: tuple[Finding, ...] = ()
