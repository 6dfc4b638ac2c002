"""Records a baseline: the rows of a mapper in every world of a corpus, as lines of a file.

What this does not show: a difference between runs whose 64-bit hashes collide.
"""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Sequence
from importlib import metadata

import msgspec

from topo_verify.campaign import campaign as c
from topo_verify.campaign.backend import MapperCampaign
from topo_verify.campaign.identity import runs_here
from topo_verify.campaign.judge import replay_line
from topo_verify.campaign.row import Row
from topo_verify.campaign.run import policies_of
from topo_verify.campaign.store import Store
from topo_verify.campaign.targets import target_arguments
from topo_verify.checkers import Finding
from topo_verify.programs.loader import Target
from topo_verify.programs.program import PREFIX
from topo_verify.robot.limits import Limits, given_limits
from topo_verify.studies.baseline.file import Baseline, BaselineEntry, Header
from topo_verify.studies.corpus import Corpus
from topo_verify.world.rooted_map import World


def baseline_runs(
    target: Target,
    worlds: c.NamedWorlds,
    total: int,
    *,
    limits: Limits | None = None,
    engine: str = "reference",
    store: Store | None = None,
) -> MapperCampaign:
    """The runs of a mapper in named worlds; they end after `MAX_TIMEOUTS` time-outs."""
    policies = policies_of(target)
    campaign = c.Campaign(
        worlds=c.ListedWorlds(total),
        mappers=(target.text,),
        pick=None if policies is None else policies.pick,
        order=None if policies is None else policies.order,
        engine=engine,
        limits=given_limits(limits),
        in_process=runs_here(target),
        stop=c.Stop(timeouts=c.MAX_TIMEOUTS),
    )
    kept = None if store is None else store.resumed(campaign, [target], all_rows=True)
    return MapperCampaign(campaign, worlds, kept, target)


def record(
    target: Target,
    corpus: Corpus,
    rows: Iterable[Row],
    *,
    worlds: Sequence[str] = (),
    seed: int = 0,
    limits: Limits | None = None,
) -> Baseline:
    """The baseline of a mapper in a corpus; fewer `rows` if the runs ended early."""
    header = Header(
        tool=metadata.version("topo-verify"),
        target=target.text,
        policies=policies_of(target),
        worlds=tuple(worlds),
        seed=seed,
        corpus=corpus.description,
        digest=corpus.digest,
        total=corpus.total,
        limits=given_limits(limits),
    )
    return Baseline(
        header, tuple(entry_of(row, at.world) for row, at in zip(rows, corpus, strict=False))
    )


class RecordEntry(msgspec.Struct, frozen=True, kw_only=True):
    """One recording: an entry of `results`.

    Attributes:
        equal: number of worlds where no claim fails.
        wrong: number of worlds where a claim fails.
        undecided: number of worlds where neither is known.
        dearer, cheaper, other_decisions: always 0; `compare` has the same fields.
        cost: total edge traversals in the worlds in which no claim fails.
        corpus, digest: the corpus in words, and its hash.
        file: the baseline; null if the mapper was stopped early.
        findings: of the first failing worlds.
    """

    target: str
    worlds: int
    equal: int
    wrong: int
    dearer: int = 0
    cheaper: int = 0
    other_decisions: int = 0
    undecided: int
    cost: int
    corpus: str
    digest: str
    file: str | None
    findings: tuple[Finding, ...]


def recorded(
    baseline: Baseline, target: Target, failing: Iterable[Row], file: str | None
) -> RecordEntry:
    """The entry that reports on a recording, with the findings of the `failing` rows."""
    header = baseline.header
    right = [entry for entry in baseline.entries if entry.right]
    wrong = sum(bool(entry.failed) for entry in baseline.entries)
    return RecordEntry(
        target=header.target,
        worlds=header.total,
        equal=len(right),
        wrong=wrong,
        undecided=header.total - len(right) - wrong,
        cost=sum(entry.cost for entry in right),
        corpus=header.corpus,
        digest=header.digest,
        file=file,
        findings=tuple(
            msgspec.structs.replace(
                finding, replay=replay_command(target, row.world, header.limits)
            )
            for row in failing
            for finding in row.findings
        ),
    )


def entry_of(row: Row, world: World) -> BaselineEntry:
    """The line of a baseline that a row makes."""
    return BaselineEntry(
        world=world.text,
        name="" if row.world == world.text else row.world,
        cost=row.cost,
        moves=row.moves,
        decisions=row.decisions,
        map=row.map,
        failed=row.failed,
        undecided=row.undecided is not None,
    )


def replay_command(target: Target, where: str, limits: Limits) -> str:
    """The command line that shows the mapper in the world `where` again."""
    if target.text.startswith(PREFIX):
        words = ("conform", *target_arguments(target.text), "--worlds", where, *limits.options)
        return shlex.join(["topo-verify", *words])
    policies = policies_of(target)
    return replay_line(where, target.text, policies, limits.options)
