"""What is noted of a run, in the process that makes it: its likeness to the reference's run.

Of a world with a finding the transcript is written, if that is asked for: the messages of a
program, or the trace of a mapper.
"""

from __future__ import annotations

import re
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

import msgspec

from topo_verify.campaign.row import Attempt, Look, row_of
from topo_verify.campaign.run import explore
from topo_verify.campaign.targets import one_target
from topo_verify.programs.loader import Target
from topo_verify.robot.events import write_trace
from topo_verify.studies.conform.likeness import Likeness, declares, first_difference
from topo_verify.studies.conform.outcome import WorldOutcome, outcome_of
from topo_verify.world.formats import files

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
