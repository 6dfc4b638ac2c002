"""Batch mode, for an implementation with its own simulator: it reads worlds and writes runs.

    in     {"id": "m5/17", "world": {…world JSON…}}                                a line a world
    out    {"id": "m5/17", "doors": [0, 2, …], "declare": […], "map": {…}, "cost": 12}

The simulated robot walks the run's doors and makes its declarations. Runs may come in any order.
If a process fails, its unanswered worlds are bisected. If it is silent for the time limit of one
world, the finding goes to the first unanswered world.

What this does not show: that doors were chosen from percepts alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import islice
from typing import NamedTuple, Self

import msgspec

from topo_verify.campaign.attempt import Attempt, row_of
from topo_verify.campaign.campaign import Campaign, InFlight, Shard, ShardResults
from topo_verify.campaign.examiner import counted
from topo_verify.campaign.judge import judge
from topo_verify.campaign.run import explore
from topo_verify.campaign.worker import function_at
from topo_verify.errors import InputError
from topo_verify.programs import protocol as ms
from topo_verify.programs.child import GRACE, Child, Ended, ReaperProcess, Silent, TooLong
from topo_verify.programs.loader import Target
from topo_verify.programs.misbehaviour import Misbehaved, crash_report, decoded, shown_line
from topo_verify.programs.program import PREFIX, TranscriptLine, split
from topo_verify.robot.events import Robot
from topo_verify.robot.simulator import Misuse
from topo_verify.world.formats import world_json
from topo_verify.world.rooted_map import World

CHUNK = 2000
"""Worlds for each process."""

BatchAnswer = ms.BatchRun | Misbehaved
"""A run, or what the program did instead."""

_run: msgspec.json.Decoder[ms.BatchRun] = msgspec.json.Decoder(ms.BatchRun)


class DeliveredMap(NamedTuple):
    """The map of a run, as `explore` reads it."""

    vertices: Sequence[Sequence[int]]
    edges: Sequence[Sequence[int]]
    marker: int | None
    cost: int | None


class BatchReplay:
    """A program's answer as a mapper; without a run, the call raises the misbehaviour."""

    def __init__(self, answer: BatchAnswer) -> None:
        self.answer = answer
        self.misbehaved: Misbehaved | None = None

    def __call__(self, robot: Robot) -> DeliveredMap:
        """Walk the run's doors, and make each declaration in its place."""
        try:
            if isinstance(self.answer, Misbehaved):
                raise self.answer
            return _replay(self.answer, robot)
        except Misbehaved as why:
            self.misbehaved = why
            raise
        except Misuse as why:
            self.misbehaved = Misbehaved("bad-door", str(why))
            raise


def _replay(run: ms.BatchRun, robot: Robot) -> DeliveredMap:
    move, done = robot.move, 0
    for declared in run.declare:
        if not done <= declared.after <= len(run.doors):
            raise Misbehaved(
                "bad-declaration",
                f"expected decisions in order, this one after {done} … {len(run.doors)} moves; got"
                f" 'after': {declared.after}",
            )
        for door in run.doors[done : declared.after]:
            move(door)
        done = declared.after
        robot.declare(declared.event)
    for door in run.doors[done:]:
        move(door)
    if run.map is None:
        raise _without_a_map(run)
    return DeliveredMap(run.map.vertices, run.map.edges, run.map.marker, run.cost)


def _without_a_map(run: ms.BatchRun) -> Misbehaved:
    if run.skip is not None:
        return Misbehaved("skip", f"the program skips this world: {run.skip}")
    if run.error is not None:
        return Misbehaved("error", f"the program gives this world up: {run.error}")
    return Misbehaved("malformed", "expected 'map', 'skip' or 'error' in the run, got none of them")


def batched(campaign: Campaign, shards: Iterator[Shard], _in_flight: InFlight) -> ShardResults:
    """The backend: one process at a time; InputError if the target is no program."""
    look = None if campaign.look is None else function_at(campaign.look)(*campaign.asked)
    with BatchProgram(campaign) as program:
        while chunk := list(islice(shards, CHUNK)):
            worlds = [world for shard in chunk for world in campaign.worlds.worlds(shard)]
            answers = program.answers([(name, world) for _, name, world in worlds])
            for number, (shard, (place, name, world)) in enumerate(zip(chunk, worlds, strict=True)):
                attempt = _judged(campaign, name, world, answers.pop(number))
                yield shard, counted([[row_of(attempt, name, place, look=look)]])


def _judged(campaign: Campaign, name: str, world: World, answer: BatchAnswer) -> Attempt:
    player = BatchReplay(answer)
    run = explore(world, Target(campaign.mappers[0], player), limits=campaign.limits)
    run = replace(run, misbehaved=player.misbehaved)
    lines: list[TranscriptLine] = [(">", msgspec.json.encode(world_json.to_data(world)))]
    if isinstance(answer, ms.BatchRun):
        lines.append(("<", msgspec.json.encode(answer)))
    return Attempt(run, judge(run, where=name, strict=campaign.strict), lines=tuple(lines))


class BatchProgram:
    """Runs a program on batches of worlds: `with` it, then `answers`.

    InputError: the target is no program.
    """

    def __init__(self, campaign: Campaign) -> None:
        (target,) = campaign.mappers
        if not target.startswith(PREFIX):
            raise InputError(f"--batch: expected a program, got {target}: name one with --cmd")
        self.command = split(target.removeprefix(PREFIX))
        self._seconds, self._validate = campaign.limits.world_timeout, campaign.validate
        self._reaper = ReaperProcess()
        self._child: Child | None = None

    def answers(self, worlds: Sequence[tuple[str, World]]) -> dict[int, BatchAnswer]:
        """The program's answers for these worlds, by index."""
        ids = _ids(worlds)
        done: dict[int, BatchAnswer] = {}
        todo = [list(range(len(worlds)))]
        while todo:
            places = todo.pop()
            why = self._go({ids[place]: place for place in places}, worlds, done)
            if why is not None and why.kind == "unknown-world":
                # Which world the other runs belong to is open.
                for place in places:
                    done.pop(place, None)
            unanswered = [place for place in places if place not in done]
            if why is not None and len(unanswered) > 1 and why.kind != "silent":
                middle = len(unanswered) // 2
                todo += [unanswered[middle:], unanswered[:middle]]
            elif unanswered:
                assert why is not None, "a program that does not fail has answered everything"
                done[unanswered[0]] = why
                todo += [unanswered[1:]] if unanswered[1:] else []
        return done

    # ------------------------------------------------------------ a process

    def _go(
        self,
        waiting: dict[str, int],
        worlds: Sequence[tuple[str, World]],
        done: dict[int, BatchAnswer],
    ) -> Misbehaved | None:
        """Send worlds to a fresh process and collect its runs; return why it failed."""
        self._child = child = Child(self.command, self._reaper)
        try:
            # Read while writing, or both may wait.
            for name, place in list(waiting.items()):
                data = world_json.to_data(worlds[place][1])
                child.write(msgspec.json.encode(ms.BatchTask(name, data)) + b"\n")
                while waiting and child.has_line:
                    self._take(child, waiting, done)
            child.close_input()
            while waiting:
                self._take(child, waiting, done)
            _require_end(child)
        except Misbehaved as why:
            return why
        except TooLong:
            return Misbehaved("too-long", f"the program wrote a line of more than {ms.LIMIT} bytes")
        finally:
            child.end(politely=0 if waiting else GRACE)
        return None

    def _take(self, child: Child, waiting: dict[str, int], done: dict[int, BatchAnswer]) -> None:
        try:
            line = child.line(seconds=self._seconds)
        except Silent:
            words = f"the program wrote no run for {self._seconds:g} s"
            raise Misbehaved("silent", words) from None
        except Ended:
            raise crash_report(child, "wrote a run for this world") from None
        run: ms.BatchRun = decoded(line, _run.decode, validate=self._validate)
        if run.id not in waiting:
            raise Misbehaved(
                "unknown-world",
                f"expected the id of an unanswered world, got {run.id!r}: {shown_line(line)}",
            )
        done[waiting.pop(run.id)] = run

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        if self._child is not None:
            self._child.end()
        self._reaper.close()


def _require_end(child: Child) -> None:
    try:
        line = child.line(seconds=GRACE)
    except (Silent, Ended):
        return
    raise Misbehaved(
        "unknown-world", f"expected the end of the output, got another line: {shown_line(line)}"
    )


def _ids(worlds: Sequence[tuple[str, World]]) -> list[str]:
    """Names, with their index if repeated."""
    names: set[str] = set()
    ids: list[str] = []
    for place, (name, _) in enumerate(worlds):
        ids.append(f"{name} ({place})" if name in names else name)
        names.add(name)
    return ids
