"""Examines worlds in this process: runs an implementation, judges it, and compares it."""

from __future__ import annotations

import re
import shlex
from hashlib import sha256
from pathlib import Path
from types import TracebackType
from typing import Self

import msgspec

from topo_verify.harness.conform.outcome import (
    ConformJob,
    WorldResult,
    undecided_by_a_stranger,
    world_result,
)
from topo_verify.harness.corpus import Named
from topo_verify.harness.judge import Report, judge
from topo_verify.harness.run import Exploration, explore
from topo_verify.harness.second_try import tried
from topo_verify.harness.targets import one_target
from topo_verify.programs.foreign import Foreign
from topo_verify.programs.loader import Target
from topo_verify.programs.program import Program, TranscriptLine
from topo_verify.robot.events import write_trace
from topo_verify.world.formats import files

TRANSCRIPT = {"format": "topo-verify/transcript", "version": 1}
"""The head of a transcript: format and version."""


class Examiner:
    """Examines worlds. Life cycle: `with` it; a program runs from the first world to the end.

    Raises:
        InputError: there is no such mapper, algorithm or policy, or the job names several.
    """

    def __init__(self, job: ConformJob) -> None:
        self.reference = reference(job)
        self.job, self.target = job, one_target(job.target, in_process=job.in_process)
        mapper = self.target.mapper
        self.program = mapper if isinstance(mapper, Program) else None
        if self.program is not None:
            self.program.validate = job.validate and not isinstance(mapper, Foreign)
            # The transcript of a mapper in Python is its trace.
            spoken = not isinstance(mapper, Foreign)
            self.program.record = spoken and job.transcript is not None
            self.program.start()

    def examine(self, at: Named) -> WorldResult:
        """Run the implementation in a world; the outcome on each level."""
        job, program = self.job, self.program
        lines: list[TranscriptLine] | None = None

        def judged(run: Exploration) -> Report:
            nonlocal lines
            if program is not None and program.record and lines is None:
                lines = program.lines  # of the first run; the next line may make another
            report = judge(run, where=at.name, strict=job.strict)
            if program is not None:
                program.settle()  # it may have been run in a witness world, too
            return report

        run, report, killed = tried(at.world, self.target, job.limits, judged)
        made = world_result(
            run,
            report,
            at,
            job,
            reference=explore(at.world, self.reference),
            misbehaved=run.misbehaved,
            replay=shlex.join([*job.replay_arguments, *at.replay_arguments]),
        )
        if job.transcript is not None and any(made.findings.values()):
            keep(job.transcript, at, run, made, lines)
        if killed is not None:
            made = undecided_by_a_stranger(made, f"its process was ended by {killed}")
        return made

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self.program is not None:
            self.program.close()


def reference(job: ConformJob) -> Target:
    """The algorithm that an implementation is compared with.

    Raises:
        InputError: there is no such algorithm or policy.
    """
    return one_target(job.reference, pick=job.policies.pick, order=job.policies.order)


def keep(
    folder: str, at: Named, run: Exploration, made: WorldResult, lines: list[TranscriptLine] | None
) -> Path:
    """Write a transcript of one world: the messages of a program, or the trace of a mapper."""
    path = Path(folder) / f"{file_name(at.name)}.jsonl"
    if lines is None:
        text = write_trace(run.kept_trace)
    else:
        head = {**TRANSCRIPT, "world": at.name, "target": run.algorithm, "stopped": run.stopped}
        rows: list[object] = [head]
        rows += [{"to" if way == ">" else "from": _text(line)} for way, line in lines]
        rows += [{"found": message.message} for row in made.findings.values() for message in row]
        text = msgspec.json.Encoder().encode_lines(rows)
    files.write(path, text)
    return path


def file_name(world: str) -> str:
    """A file name for a world, valid in every file system and different for each world."""
    name = re.sub(r"[^A-Za-z0-9_.=,()-]", "-", world)
    plain = re.fullmatch(r"m[0-9]+/[0-9]+", world) or name == world
    tag = "" if plain and len(name) <= 80 else f"-{sha256(world.encode()).hexdigest()[:8]}"
    return name[:80] + tag


def _text(line: bytes) -> str:
    return line.decode(errors="backslashreplace")
