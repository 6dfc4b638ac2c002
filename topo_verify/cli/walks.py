"""The walks that commands show: of the run that a counterexample or a finding is about.

A search knows of its counterexample only the world and the claim. So the mapper runs there once
more, and its walk is shown if the same claim fails again.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from topo_verify.cli.runs import NamedWorld, finding_line, judged
from topo_verify.errors import InputError
from topo_verify.harness.judge import Report
from topo_verify.harness.run import explore
from topo_verify.player import walk
from topo_verify.programs.loader import Target
from topo_verify.report.blocks import Block, Bullets, Command, Text, View
from topo_verify.robot.limits import Limits
from topo_verify.world.resolve import resolve_world
from topo_verify.world.rooted_map import World

OTHERS = 5
"""So many findings that the walk does not show are listed."""


def walk_view(report: Report, extent: walk.Extent = walk.BRIEF) -> Iterator[Block]:
    """The walk to the first finding of a run."""
    playback = report.playback
    if playback is not None:
        yield View(lambda width: walk.lines(playback, width, extent))


def other_findings(report: Report, extent: walk.Extent) -> Iterator[Block]:
    """The findings that the walk does not show."""
    playback = report.playback
    others = [
        finding
        for finding in report.findings
        if playback is None or not walk.is_shown(playback, finding, extent)
    ]
    if others:
        yield Text("")
        yield Text("Also wrong:")
        lines = [finding_line(finding) for finding in others[:OTHERS]]
        if len(others) > OTHERS:
            lines.append(f"and {len(others) - OTHERS} more: --format json shows them")
        yield Bullets(tuple(lines))


class FoundWalk:
    """The walk to the first counterexample that a command meets; lives for one call.

    Args:
        wanted: whether it is shown at all.
    """

    def __init__(self, *, wanted: bool = True) -> None:
        self._wanted = wanted
        self._report: Report | None = None

    def keep(self, report: Report) -> None:
        """Keep the report of a run, if it is the first in which something is wrong."""
        if self._wanted and self._report is None and report.findings:
            self._report = report

    def run_again(self, targets: Sequence[Target], world: str, claim: str, limits: Limits) -> None:
        """Run the mappers in the world of a counterexample; keep a run in which the claim fails.

        A mapper that draws lots may do well this time; then there is nothing to show.

        Args:
            world: an id, or `nyc`. Any other world is passed over: a file may have changed since.
        """
        if not self._wanted or self._report is not None:
            return
        try:
            there = resolve_world(world) if world == "nyc" else World.from_id(world)
        except InputError:
            return
        for target in targets:
            report, _ = judged(
                explore(there, target, limits=limits), NamedWorld(there, world), limits
            )
            if any(finding.claim == claim for finding in report.findings):
                self.keep(report)
                return

    def blocks(self) -> Iterator[Block]:
        """The walk with its title, and the command that shows it again; none if there is none."""
        if self._report is None:
            return
        yield Text("")
        yield Text(f"The walk of {self._report.target} in {self._report.world}:")
        yield Text("")
        yield from walk_view(self._report)
        yield Text("")
        replay_command = self._report.findings[0].replay
        if replay_command:
            yield Command(replay_command, "again: ")
