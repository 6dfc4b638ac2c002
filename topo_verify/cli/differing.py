"""The worlds in which an implementation does not conform, to be looked at.

In each the implementation runs once more; where it parts from the reference, both runs stand side
by side.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from topo_verify.campaign.campaign import Campaign
from topo_verify.campaign.judge import Report, judge
from topo_verify.campaign.run import explore
from topo_verify.cli.runs import NamedWorld, judged
from topo_verify.cli.walks import MOST_EXHIBITS, exhibit_of, target_title
from topo_verify.player.recording import PlayedRun
from topo_verify.report.account import Exhibit
from topo_verify.studies.conform.conform import Conform, LevelResult
from topo_verify.studies.conform.look import Asked
from topo_verify.studies.conform.outcome import WorldFinding
from topo_verify.world.rooted_map import World


def exhibits(study: Conform, levels: Sequence[LevelResult], *, batch: bool) -> Iterator[Exhibit]:
    """The first world of each kind of finding, each world once.

    Args:
        batch: the program reads worlds and writes runs; it is not asked again.
    """
    first: dict[str, list[WorldFinding]] = {}
    for level in levels:
        for kind in level.kinds:
            finding = next(one for one in level.findings if one.kind == kind)
            first.setdefault(finding.world, []).append(finding)
    if not first:
        return
    worlds = {at.name: at.world for at in study.corpus if at.name in first}
    for number, (name, findings) in enumerate(first.items()):
        runs: tuple[PlayedRun, ...] = ()
        if not batch and number < MOST_EXHIBITS:
            runs = tuple(_runs(study.campaign, worlds[name], findings))
        notes = dict.fromkeys(f"{one.kind}: {one.message}" for one in findings)
        yield Exhibit(
            title=target_title(study.target, name),
            world=worlds[name],
            name=name,
            notes=tuple(notes),
            runs=runs,
            again=findings[0].replay,
        )


def _runs(
    campaign: Campaign, world: World, findings: Sequence[WorldFinding]
) -> Iterator[PlayedRun]:
    """The run of the implementation, and that of the reference if the two part."""
    for target in campaign.load():
        report = judge(explore(world, target, limits=campaign.limits), strict=campaign.strict)
        exhibit = exhibit_of(report)
        yield from exhibit.runs if exhibit is not None else ()
    if any(one.difference is not None for one in findings):
        asked = Asked(*campaign.asked)
        yield PlayedRun(asked.name, explore(world, asked.reference).trace)


def failing_run(study: Conform, levels: Sequence[LevelResult]) -> Report | None:
    """The run in the first world that convicts an implementation by itself, made once more.

    A run that only parts from the reference's is shown where they part. None if there is no other,
    or if the same claim does not fail again.
    """
    convicting = (one for level in levels for one in level.findings if one.difference is None)
    finding = next(convicting, None)
    if finding is None:
        return None
    campaign = study.campaign
    world = next(at.world for at in study.corpus if at.name == finding.world)
    for target in campaign.load():
        run = explore(world, target, limits=campaign.limits)
        named = NamedWorld(world, finding.world)
        report, _ = judged(run, named, campaign.limits, strict=campaign.strict)
        if any(one.claim == finding.claim for one in report.findings):
            return report
    return None
