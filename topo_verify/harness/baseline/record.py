"""Recording of a baseline: a mapper runs in every world of a corpus, judged by every claim.

An entry keeps four results of a run: its cost; a hash of its doors; a hash of its declarations, or
None if there are none; the id of its map.

**The hash of the decisions** covers each `pose`, `reject`, `confirm` and `augment` with the number
of moves before it: edge, hypotheses, rule, kind, dart. The evidence of a rejection and the purpose
of a move say why, not what, and are left out. So two mappers have the same hashes if they make the
same moves and the same decisions at the same time, whatever reasons they give.

What this does not show: a difference between two runs whose 64-bit hashes collide.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from hashlib import sha256
from importlib import metadata

import msgspec

from topo_verify.errors import InputError
from topo_verify.harness.baseline.file import Baseline, BaselineEntry, Header
from topo_verify.harness.corpus import Corpus
from topo_verify.harness.engines import policies_of
from topo_verify.harness.judge import Report, judge, replay_line
from topo_verify.harness.judge import undecided as is_undecided
from topo_verify.harness.progress import Progress
from topo_verify.harness.run import Exploration, explore
from topo_verify.harness.targets import target_arguments
from topo_verify.programs.loader import Target
from topo_verify.programs.program import PREFIX
from topo_verify.robot.events import Augment, Confirm, Event, Move, Pose, Reject
from topo_verify.robot.limits import Limits
from topo_verify.world.enumeration import rank_order
from topo_verify.world.rooted_map import World

MAX_TIMEOUTS = 3
"""After this many time-outs the remaining worlds are not tried."""


@dataclass(frozen=True, slots=True)
class Recorded:
    """The run of a mapper in one world: the report, and the entry that a baseline keeps."""

    world: World
    report: Report
    entry: BaselineEntry
    timed_out: bool


def record(
    target: Target,
    corpus: Corpus,
    *,
    worlds: Sequence[str] = (),
    seed: int = 0,
    limits: Limits | None = None,
    tell: Progress | None = None,
    note: Callable[[Recorded], None] | None = None,
) -> Baseline:
    """Run the mapper in every world of the corpus.

    After `MAX_TIMEOUTS` time-outs it stops: then there are fewer entries than the header says.

    Args:
        worlds, seed: the arguments that gave the corpus, for the header.
        tell: called before each world.
        note: called after each world.
    """
    limits = limits or Limits()
    entries: list[BaselineEntry] = []
    named = ((at.name, at.world) for at in corpus)
    for seen in runs(target, named, corpus.total, limits, tell):
        entries.append(seen.entry)
        if note is not None:
            note(seen)
    header = Header(
        tool=metadata.version("topo-verify"),
        target=target.text,
        policies=policies_of(target),
        worlds=tuple(worlds),
        seed=seed,
        corpus=corpus.description,
        digest=corpus.digest,
        total=corpus.total,
        limits=limits,
    )
    return Baseline(header, tuple(entries))


def runs(
    target: Target,
    worlds: Iterable[tuple[str, World]],
    total: int,
    limits: Limits,
    tell: Progress | None = None,
) -> Iterator[Recorded]:
    """The mapper's runs in these worlds, in order; they end after `MAX_TIMEOUTS` time-outs."""
    timeouts = 0
    for number, (name, world) in enumerate(worlds):
        if tell is not None:
            tell(target.text, number, total)
        seen = _recorded(target, name, world, limits)
        yield seen
        timeouts += seen.timed_out
        if timeouts == MAX_TIMEOUTS:
            return


def _recorded(target: Target, name: str, world: World, limits: Limits) -> Recorded:
    run = explore(world, target, limits=limits)
    declined = run.misbehaved is not None and run.misbehaved.kind in ("skip", "error")
    report = judge(run, where=name, options=limits.options)
    replay = replay_command(target, name, limits)
    findings = tuple(msgspec.structs.replace(f, replay=replay) for f in report.findings)
    report = msgspec.structs.replace(report, findings=findings)
    # The missing map of an undecided run is a finding in its report, but refutes no claim.
    undecided = declined or is_undecided(run, report)
    entry = BaselineEntry(
        world=world.text,
        name="" if name == world.text else name,
        cost=run.cost,
        moves=_hash([event.door for event in run.trace if isinstance(event, Move)]),
        decisions=_decisions(run.trace),
        map=_map(run, report),
        failed=() if undecided else tuple(c for c, s in report.claims.items() if s == "failed"),
        undecided=undecided,
    )
    return Recorded(world, report, entry, run.limit in ("move-timeout", "world-timeout"))


def replay_command(target: Target, where: str, limits: Limits) -> str:
    """The command line that shows the mapper in the world `where` again."""
    if target.text.startswith(PREFIX):
        words = ("conform", *target_arguments(target.text), "--worlds", where, *limits.options)
        return shlex.join(["topo-verify", *words])
    policies = policies_of(target)
    return replay_line(where, target.text, policies, limits.options)


def _decisions(trace: Iterable[Event]) -> str | None:
    """A hash of the decisions, each with the number of moves before it; None if there are none."""
    moves, declared = 0, list[object]()
    for event in trace:
        match event:
            case Move():
                moves += 1
            case Pose():
                declared.append([moves, "pose", event.edge, event.hypotheses])
            case Reject() | Confirm():
                kind = "reject" if isinstance(event, Reject) else "confirm"
                declared.append([moves, kind, event.edge, event.hypothesis, event.rule])
            case Augment():
                grown = (event.edge, event.kind, event.dart, event.degree)
                declared.append([moves, "augment", *grown])
            case _:
                pass
    return _hash(declared) if declared else None


def _map(run: Exploration, report: Report) -> str | None:
    """The id of the delivered map, or a hash of its code if it is too large; None without a map."""
    if run.map is None:
        return None
    try:
        # If no claim fails the map is the world, so there is nothing to build.
        drawn = run.world if report.ok else World.from_map(run.map)
    except InputError:
        return None
    # The id is canonical, so the mapper's numbering of darts does not matter.
    small = len(drawn.edges) <= rank_order.MAX_ID_EDGES
    return drawn.id if small else f"sha256:{_hash(drawn.code)}"


def _hash(value: object) -> str:
    return sha256(msgspec.json.encode(value)).hexdigest()[:16]
