"""The walks that commands show: of the run that a counterexample or a finding is about.

A search knows of its counterexample only the world and the claim. So the mapper runs there once
more, and its walk is shown if the same claim fails again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from topo_verify.campaign.judge import Report
from topo_verify.campaign.run import explore
from topo_verify.cli.runs import NamedWorld, finding_line, judged
from topo_verify.errors import InputError
from topo_verify.player import walk
from topo_verify.player.recording import PlayedRun
from topo_verify.programs.loader import Target
from topo_verify.report import account as acc
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


MOST_EXHIBITS = 12
"""So many counterexamples stand in a page; the others are counted."""


class FoundRuns:
    """The counterexamples that a command meets: the walk of the first, and exhibits for a page.

    Args:
        people: whether people read what is printed; they see a walk.
        page: whether a page is asked for; it shows all, up to `MOST_EXHIBITS`.
    """

    def __init__(self, *, people: bool, page: bool) -> None:
        self._people = people
        self._most = MOST_EXHIBITS if page else int(people)
        self._alone = page
        self._report: Report | None = None
        self._exhibits: dict[tuple[str, str], acc.Exhibit] = {}
        self._seen: set[tuple[str, str]] = set()
        self._late = False

    def keep(self, report: Report) -> None:
        """Keep the report of a run, if something is wrong in it."""
        if self._most and report.findings:
            self._report = self._report or report
            self.show(exhibit_of(report))

    def walk(self, report: Report | None) -> None:
        """Show the walk of a run to people, if it is the first; a page has its exhibit already."""
        if self._people:
            self._report = self._report or report

    def show(self, exhibit: acc.Exhibit | None) -> None:
        """Keep an exhibit for the page, if there is one."""
        if exhibit is not None:
            place = (exhibit.title, exhibit.name)
            self._seen.add(place)
            if len(self._exhibits) < self._most:
                self._exhibits.setdefault(place, exhibit)

    def run_again(
        self,
        targets: Sequence[Target],
        world: str,
        claim: str,
        limits: Limits,
        message: str = "",
        *,
        reports: Callable[[Target, World], Iterator[Report]] | None = None,
    ) -> None:
        """Run the mappers in the world of a counterexample; keep a run in which the claim fails.

        A mapper that draws lots may do well this time; then the world is shown without a run.

        Args:
            world: an id, a family's call, or `nyc`. Any other is passed over: a file may have
                changed since.
            message: what was wrong there.
            reports: makes the runs where there are several ways to choose; else each runs once.
        """
        if not self._most or (self._report is not None and not self._alone):
            return
        try:
            fixed = world == "nyc" or world.startswith("family:")
            there = resolve_world(world) if fixed else World.from_id(world)
        except InputError:
            return

        def once(target: Target, _there: World) -> Iterator[Report]:
            run = explore(there, target, limits=limits)
            self._late = run.limit in ("move-timeout", "world-timeout")  # once is enough
            report, _ = judged(run, NamedWorld(there, world), limits)
            yield report

        if len(self._exhibits) < self._most and not self._late:
            for target in targets:
                if (target_title(target.text, world), world) in self._exhibits:
                    continue
                for report in (reports or once)(target, there):
                    if any(finding.claim == claim for finding in report.findings):
                        self.keep(report)
                        return
        who = ",".join(target.text for target in targets)
        self.show(acc.Exhibit(target_title(who, world), there, world, (f"{claim}: {message}",)))

    @property
    def exhibits(self) -> tuple[acc.Exhibit, ...]:
        """The counterexamples for the page."""
        return tuple(self._exhibits.values()) if self._alone else ()

    @property
    def left_out(self) -> int:
        """How many more there were."""
        return len(self._seen) - len(self._exhibits)

    def blocks(self) -> Iterator[Block]:
        """The walk with its title, and the command that shows it again; none if there is none."""
        if self._report is None or not self._people:
            return
        yield Text("")
        yield Text(f"The walk of {self._report.target} in {self._report.world}:")
        yield Text("")
        yield from walk_view(self._report)
        yield Text("")
        replay_command = self._report.findings[0].replay
        if replay_command:
            yield Command(replay_command, "again: ")


def target_title(target: str, world: str) -> str:
    """The title of an exhibit: who, in which world."""
    return f"{target} in {world}"


def exhibit_of(report: Report, *others: PlayedRun) -> acc.Exhibit | None:
    """A run with its findings, to be looked at; None if the run is not known.

    Args:
        others: runs to be shown beside it.
    """
    if report.run is None:
        return None
    run = PlayedRun(report.target, tuple(report.run.trace), report.judgements, report.run.stopped)
    return acc.Exhibit(
        title=target_title(report.target, report.world),
        world=report.run.world,
        name=report.world,
        notes=tuple(map(finding_line, report.findings[:OTHERS])),
        runs=(run, *others),
        again=report.findings[0].replay if report.findings else "",
    )
