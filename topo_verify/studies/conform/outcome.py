"""A row on four levels: one run of the implementation, judged.

    result      the map is the world, the cost is honest and within the bound
    claims      the declared decisions are sound and justified, and the history proves the map
    decisions   the run equals that of the reference, event for event
    cost        the cost relative to that of the reference

A run without a map has ONE finding on level `result`, which says what the implementation did
instead. A world is undecided, neither passed nor failed, if the implementation skips it, gives it
up, or exceeds its time while it still moves; or if something else may have ended its process.

`look` notes, in the process that makes the run, how like the reference's it is. Of a world with a
finding it writes the transcript, if that is asked for: the messages of a program, or the trace.

What this does not show: that a program behaves in the same way the next time.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any, Literal, NamedTuple, get_args

import msgspec

from topo_verify.campaign.attempt import Attempt, Look, row_of
from topo_verify.campaign.row import Row
from topo_verify.campaign.run import explore
from topo_verify.campaign.targets import one_target
from topo_verify.checkers import Finding
from topo_verify.programs.loader import Target
from topo_verify.robot.events import write_trace
from topo_verify.studies.conform.likeness import Difference, Likeness, declares, first_difference
from topo_verify.world.formats import files

Level = Literal["result", "claims", "decisions", "cost"]

LEVELS: tuple[Level, ...] = get_args(Level)

LevelState = Literal["passed", "failed", "skipped", "errored", "undecided", "not-declared"]
"""The state of a world on one level."""

RESULT = ("percepts-true", "map-isomorphic", "cost-honest", "cost-within-bound")
"""The claims of level `result`. All others belong to level `claims`."""

KEPT = 5
"""The most findings that are kept for a world and a level."""


class WorldFinding(msgspec.Struct, frozen=True, kw_only=True):
    """A `Finding` with its kind.

    Attributes:
        kind: what the program did instead of delivering a map (docs/oracle.md), `move-timeout`,
            `budget`, `no-map`, `decisions`; else the claim.
        difference: on level `decisions`, the first difference of the runs.
    """

    claim: str
    kind: str
    world: str
    event: int | None = None
    expected: Any = None
    seen: Any = None
    message: str
    witness: str | None = None
    replay: str = ""
    difference: Difference | None = None


@dataclass(frozen=True, slots=True)
class WorldOutcome:
    """What a row says on each level.

    Attributes:
        states: by level; `decisions` only if a reference is to be followed.
        findings: by level, the first ones.
        why: the reason why the world is undecided, if it is.
        cost, reference: edge traversals, the implementation's and the reference's.
    """

    states: dict[Level, LevelState]
    findings: dict[Level, tuple[WorldFinding, ...]]
    why: str | None
    cost: int
    reference: int


def outcome_of(row: Row, like: str) -> WorldOutcome:
    """The outcome in one world.

    Args:
        row: its note is a `Likeness`; None: a worker was lost each time.
        like: the algorithm whose decisions it should make; empty: decisions are not compared.
    """
    note = None if row.note is None else msgspec.convert(row.note, Likeness)
    # A run that lost its worker once has the map of its second try.
    lost = row.ended != "map" and row.map is None
    open_ended = _open_ended(row)
    findings = [_found(row, one) for one in row.findings]
    result = [found for found in findings if found.claim in RESULT]
    claims = [found for found in findings if found.claim not in RESULT]
    if row.ended != "map":
        result = [] if row.lost or open_ended else [_loss(row, note)]
    if lost:
        # Without a map, claims about the map and the run as a whole add nothing to the one finding.
        claims = [
            found for found in claims if found.event is not None and found.claim != "map-entailed"
        ]
    unproved = lost or any(one.status == "undecided" for one in row.claims)
    states: dict[Level, LevelState] = {
        "result": open_ended or ("failed" if result else "passed"),
        "claims": "failed" if claims else open_ended or ("undecided" if unproved else "passed"),
    }
    kept: dict[Level, tuple[WorldFinding, ...]] = {
        "result": tuple(result[:KEPT]),
        "claims": tuple(claims[:KEPT]),
    }
    if like:
        difference = None if note is None else note.difference
        states["decisions"] = _likeness(note, open_ended, lost=lost)
        failed = states["decisions"] == "failed"
        kept["decisions"] = (_parted(row, like, difference),) if difference and failed else ()
    states["cost"] = "passed" if not (lost or result) else open_ended or "undecided"
    why = row.stopped if open_ended else None
    if row.lost is not None and "failed" not in states.values():
        for level in states:
            states[level] = "undecided"
        why = row.undecided
    return WorldOutcome(states, kept, why, row.cost, 0 if note is None else note.reference)


def _open_ended(row: Row) -> LevelState | None:
    """The state of a world in which the implementation cannot be judged; None if it can."""
    if row.ended in ("skip", "error"):
        return "skipped" if row.ended == "skip" else "errored"
    # Only this limit leaves it open: a run stopped by another one stands still or walks for ever.
    late = row.ended == "world-timeout" or (row.timed_out and row.undecided is not None)
    return "undecided" if late else None


def _found(row: Row, finding: Finding) -> WorldFinding:
    return WorldFinding(
        claim=finding.claim,
        kind=finding.claim,
        world=row.world,
        event=finding.event,
        expected=finding.expected,
        seen=finding.seen,
        message=finding.message,
        witness=finding.witness,
    )


def _loss(row: Row, note: Likeness | None) -> WorldFinding:
    """The single finding of a run without a map."""
    detail = "" if note is None else note.detail
    return WorldFinding(
        claim="map-isomorphic",
        kind=row.ended,
        world=row.world,
        expected="a map",
        message=f"no map was delivered: {row.stopped}{detail}",
    )


def _likeness(note: Likeness | None, open_ended: LevelState | None, *, lost: bool) -> LevelState:
    """The state of level `decisions`."""
    if note is None:
        return "undecided"
    if note.difference is None:
        return "not-declared" if note.silent else "passed"
    if note.difference.seen is None and lost:
        return open_ended or "undecided"  # the run was cut off before any difference
    return "failed"


def _parted(row: Row, like: str, difference: Difference) -> WorldFinding:
    """The first difference from the reference as a finding."""
    ours, theirs = (side or "does nothing more" for side in (difference.expected, difference.seen))
    return WorldFinding(
        claim="decisions",
        kind="decisions",
        world=row.world,
        event=difference.event,
        expected=difference.expected,
        seen=difference.seen,
        message=f"{like} {ours}; the mapper {theirs}",
        difference=difference,
    )


# ---------------------------------------------------------------- what is noted of a run

TRANSCRIPT = {"format": "topo-verify/transcript", "version": 1}
"""The head of a transcript: format and version."""


class Asked(NamedTuple):
    """What is asked about a run, as texts, which other processes can be handed.

    Attributes:
        like: the algorithm whose decisions it should make; empty: decisions are not compared.
        pick, order: policies of the reference.
        transcript: the folder for the transcripts of failing worlds; empty: none is written.
    """

    like: str = ""
    pick: str = "nearest"
    order: str = "shortest"
    transcript: str = ""

    @property
    def name(self) -> str:
        """The algorithm that costs and decisions are compared with."""
        return self.like or "basic"

    @property
    def reference(self) -> Target:
        """The same, to be run.

        Raises:
            InputError: there is no such algorithm or policy.
        """
        return one_target(self.name, pick=self.pick, order=self.order)


def look(*texts: str) -> Look:
    """Notes the likeness of runs to those of the reference.

    Args:
        texts: the fields of `Asked`.
    """
    asked = Asked(*texts)
    reference = asked.reference

    def noted(made: Attempt) -> Likeness:
        run, world = made.run, made.run.world
        like = explore(world, reference)
        note = Likeness(
            like.cost,
            bool(world.edges) and not declares(run.trace),
            first_difference(like.trace, run.trace) if asked.like else None,
            "" if run.misbehaved is None else run.misbehaved.detail,
        )
        if asked.transcript:
            row = msgspec.structs.replace(row_of(made, made.report.world, 0), note=note)
            outcome = outcome_of(row, asked.like)
            if any(outcome.findings.values()):
                _keep(asked.transcript, made, outcome)
        return note

    return noted


def _keep(folder: str, made: Attempt, outcome: WorldOutcome) -> None:
    """Write a transcript of one world."""
    world, run = made.report.world, made.run
    if made.lines is None:
        text = write_trace(run.kept_trace)
    else:
        head = {**TRANSCRIPT, "world": world, "target": run.algorithm, "stopped": run.stopped}
        rows: list[object] = [head]
        rows += [{"to" if way == ">" else "from": _text(line)} for way, line in made.lines]
        rows += [{"found": one.message} for level in outcome.findings.values() for one in level]
        text = msgspec.json.Encoder().encode_lines(rows)
    files.write(Path(folder) / f"{file_name(world)}.jsonl", text)


def file_name(world: str) -> str:
    """A file name for a world, valid in every file system and different for each world."""
    name = re.sub(r"[^A-Za-z0-9_.=,()-]", "-", world)
    plain = re.fullmatch(r"m[0-9]+/[0-9]+", world) or name == world
    tag = "" if plain and len(name) <= 80 else f"-{sha256(world.encode()).hexdigest()[:8]}"
    return name[:80] + tag


def _text(line: bytes) -> str:
    return line.decode(errors="backslashreplace")
