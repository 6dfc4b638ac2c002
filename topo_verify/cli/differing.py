"""The worlds in which an implementation does not conform, to be looked at.

In each the implementation runs once more; where it parts from the reference, both runs stand side
by side.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from topo_verify.cli.runs import NamedWorld, judged
from topo_verify.cli.walks import MOST_EXHIBITS, exhibit_of, target_title
from topo_verify.harness.conform.conform import LevelResult
from topo_verify.harness.conform.outcome import ConformJob, WorldFinding
from topo_verify.harness.corpus import Corpus
from topo_verify.harness.judge import Report, judge
from topo_verify.harness.run import explore
from topo_verify.harness.targets import targets
from topo_verify.player.recording import PlayedRun
from topo_verify.report.account import Exhibit
from topo_verify.world.rooted_map import World


def exhibits(
    job: ConformJob, corpus: Corpus, levels: Sequence[LevelResult], *, batch: bool
) -> Iterator[Exhibit]:
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
    worlds = {at.name: at.world for at in corpus if at.name in first}
    for number, (name, findings) in enumerate(first.items()):
        runs: tuple[PlayedRun, ...] = ()
        if not batch and number < MOST_EXHIBITS:
            runs = tuple(_runs(job, worlds[name], findings))
        notes = dict.fromkeys(f"{one.kind}: {one.message}" for one in findings)
        yield Exhibit(
            title=target_title(job.target, name),
            world=worlds[name],
            name=name,
            notes=tuple(notes),
            runs=runs,
            again=findings[0].replay,
        )


def _runs(job: ConformJob, world: World, findings: Sequence[WorldFinding]) -> Iterator[PlayedRun]:
    """The run of the implementation, and that of the reference if the two part."""
    for target in targets(job.target, in_process=job.in_process):
        report = judge(explore(world, target, limits=job.limits), strict=job.strict)
        exhibit = exhibit_of(report)
        yield from exhibit.runs if exhibit is not None else ()
    if any(one.difference is not None for one in findings):
        like = explore(world, job.reference, pick=job.policies.pick, order=job.policies.order)
        yield PlayedRun(job.reference, like.trace)


def failing_run(job: ConformJob, corpus: Corpus, levels: Sequence[LevelResult]) -> Report | None:
    """The run in the first world that convicts an implementation by itself, made once more.

    A run that only parts from the reference's is shown where they part. None if there is no other,
    or if the same claim does not fail again.
    """
    convicting = (one for level in levels for one in level.findings if one.difference is None)
    finding = next(convicting, None)
    if finding is None:
        return None
    world = next(at.world for at in corpus if at.name == finding.world)
    for target in targets(job.target, in_process=job.in_process):
        run = explore(world, target, limits=job.limits)
        report, _ = judged(run, NamedWorld(world, finding.world), job.limits, strict=job.strict)
        if any(one.claim == finding.claim for one in report.findings):
            return report
    return None
