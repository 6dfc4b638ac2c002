"""`topo-verify search`: find the smallest counterexample among all worlds of up to N edges."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from functools import partial
from itertools import chain
from pathlib import Path

import click

from topo_verify.campaign.backend import clustered, here, pooled
from topo_verify.campaign.campaign import Campaign
from topo_verify.campaign.cluster import Cluster, both_given, connected
from topo_verify.campaign.engines import Engine
from topo_verify.campaign.identity import Identity, source_hash
from topo_verify.campaign.store import Store, StoredCampaign
from topo_verify.campaign.targets import target_text, targets
from topo_verify.campaign.work import processors
from topo_verify.cli import options
from topo_verify.cli.accounts import search_account
from topo_verify.cli.output import Output, Result
from topo_verify.cli.output import options as output_options
from topo_verify.cli.reporting import report_options
from topo_verify.cli.searched import show as show_entry
from topo_verify.cli.walks import FoundRuns
from topo_verify.errors import InputError
from topo_verify.programs.loaded import watch
from topo_verify.programs.loader import Target
from topo_verify.report.account import Account
from topo_verify.report.blocks import Block
from topo_verify.robot.limits import Limits
from topo_verify.studies.search.choices import CHOICES, Choices, reports_of
from topo_verify.studies.search.search import DONE, Search, SearchEntry, search_campaign
from topo_verify.world.enumeration.classes import WorldClass


@dataclass(frozen=True)
class _SearchOptions:
    """The options of one call."""

    edges: int
    kind: WorldClass
    workers: int
    ledger: str | None
    depends: tuple[str, ...]
    seed: int
    keep_going: bool
    policies: Choices
    engine: Engine
    worst: bool
    compare: bool
    limits: Limits
    in_process: bool


@options.command(
    "search basic --edges 5",
    "search my_mapper.py:explore --class planar --keep-going",
    "search enhancement-i --edges 6 --ledger FILE --worst",
    "search basic --policies every --edges 4 --worst",
    "search --compare enhancement-ii,enhancement-i --edges 5",
)
@options.target
@options.program
@options.in_process
@click.option(
    "--edges",
    type=click.IntRange(min=1),
    default=5,
    show_default=True,
    metavar="N",
    help="Worlds of 1 to N edges.",
)
@options.world_class
@click.option(
    "--workers",
    type=click.IntRange(min=0),
    metavar="N",
    help="Number of worker processes; 0: only this one.  [default: one per processor]",
)
@click.option(
    "--dask",
    metavar="ADDRESS",
    help="Work on the Dask cluster whose scheduler has this ADDRESS; local: start one here.",
)
@click.option("--ledger", metavar="FILE", help="Keep finished work in FILE and resume from it.")
@click.option(
    "--depends",
    multiple=True,
    metavar="FILE",
    help="The TARGET depends on FILE: if it changes, the ledger is refused. May be repeated.",
)
@click.option("--keep-going", is_flag=True, help="Do not stop at the first counterexample.")
@click.option(
    "--policies",
    type=click.Choice(CHOICES),
    default="reference",
    show_default=True,
    help="Use the reference policies, all named ones, or every possible choice.",
)
@options.engine
@click.option("--worst", is_flag=True, help="Show the highest costs and the worlds that have them.")
@click.option("--compare", metavar="A,B", help="Show where A costs more than B.")
@options.seed("Seed of the worlds that are run again.")
@options.limits
@output_options
@report_options
def search(  # noqa: PLR0913  an argument an option
    output: Output,
    *,
    target: str | None,
    command: str | None,
    in_process: bool,
    edges: int,
    kind: str,
    workers: int | None,
    dask: str | None,
    ledger: str | None,
    depends: tuple[str, ...],
    keep_going: bool,
    policies: Choices,
    engine: Engine,
    worst: bool,
    compare: str | None,
    seed: int,
    limits: Limits,
) -> int:
    """Examine a mapper in every world of 1 to N edges, smallest first.

    The search stops at the smallest counterexample (REFUTED) or after the last world (EXHAUSTED).
    TARGET is a name of the catalogue, several with commas, all, module:attribute or
    file.py:attribute.
    """

    def searches() -> Iterator[Result[SearchEntry]]:
        asked = _SearchOptions(
            edges=edges,
            kind=WorldClass.parse(kind),
            workers=processors() if workers is None else workers,
            ledger=ledger,
            depends=depends,
            seed=seed,
            keep_going=keep_going,
            policies=policies,
            engine=engine,
            worst=worst,
            compare=compare is not None,
            limits=limits,
            in_process=in_process,
        )
        _require_files(depends)
        with _cluster(dask, workers) as cluster:
            if ledger is not None:
                watch()  # before a mapper is loaded, and after Dask has read its settings
            for mappers in _mappers(target, command, compare, ledger, in_process=in_process):
                yield from _searched(output, mappers, asked, found, cluster)

    def body(entries: Sequence[SearchEntry]) -> Iterator[Block]:
        return chain.from_iterable(show_entry(entry, worst=worst) for entry in entries)

    def account(entries: Sequence[SearchEntry]) -> Account:
        return search_account(entries, body(entries), found)

    found = FoundRuns(output)
    show = partial(_with_walk, body=body, found=found)
    return output.run("search", searches, show, account=account, in_process=in_process)


def _require_files(depends: Sequence[str]) -> None:
    for path in depends:
        if not Path(path).is_file():
            raise InputError(f"--depends {path}: there is no such file; name one that exists")


def _cluster(dask: str | None, workers: int | None) -> AbstractContextManager[Cluster | None]:
    """The Dask cluster, if one is asked for."""
    if dask is None:
        return nullcontext()
    if workers is not None:
        raise both_given(dask, workers)
    return connected(dask)


def _with_walk(
    entries: Sequence[SearchEntry],
    body: Callable[[Sequence[SearchEntry]], Iterable[Block]],
    found: FoundRuns,
) -> Iterator[Block]:
    """What is said of the entries, then the walk of the first counterexample."""
    yield from body(entries)
    yield from found.blocks()


def _mappers(
    target: str | None,
    command: str | None,
    compare: str | None,
    ledger: str | None,
    *,
    in_process: bool,
) -> list[tuple[Target, ...]]:
    """The mappers of each search: one, or the two that are compared."""
    if (target is None and command is None) == (compare is None):
        raise InputError("expected either a TARGET or two mappers with --compare A,B")
    if compare is not None:
        pair = targets(compare)
        if len(pair) != 2 or pair[0] == pair[1]:
            raise InputError(
                f"--compare {compare}: expected two different algorithms of the catalogue, as A,B"
            )
        return [pair]
    text = target_text(target, command)
    found: list[tuple[Target, ...]] = [(mapper,) for mapper in targets(text, in_process=in_process)]
    if ledger is not None and len(found) != 1:
        raise InputError(
            f"--ledger {ledger}: expected one TARGET, got {len(found)}; search them one by one"
        )
    return found


def _searched(
    output: Output,
    mappers: tuple[Target, ...],
    asked: _SearchOptions,
    found: FoundRuns,
    cluster: Cluster | None,
) -> Iterator[Result[SearchEntry]]:
    """The result of one search; after Ctrl-C, of the worlds done so far."""
    campaign = search_campaign(
        mappers,
        edges=asked.edges,
        kind=str(asked.kind),
        choices=asked.policies,
        keep_going=asked.keep_going,
        limits=asked.limits,
        seed=asked.seed,
        in_process=asked.in_process,
        engine=asked.engine,
    )
    depends = None if asked.ledger is None else asked.depends
    backend = pooled(asked.workers, depends) if asked.workers else here(mappers, depends=depends)
    if cluster is not None:
        backend = clustered(cluster, depends)
    with _opened(output, asked, campaign, mappers) as store:
        study = Search(campaign, mappers, backend, store)

        def result() -> Result[SearchEntry]:
            entry = study.entry(compare=asked.compare)
            failed, incomplete = entry.verdict == "REFUTED", entry.verdict not in DONE
            return Result(entry, failed=failed, incomplete=incomplete)

        try:
            study.work(output.progress)
            study.run_again(output.progress)
        except KeyboardInterrupt:
            # Yield before raising: `Output` prints what it has and then exits 3.
            yield result()
            raise
        if campaign.engine == "compiled":
            _note_seconds(output, study)
        entry = study.entry()
        reports = None if campaign.ways is None else partial(reports_of, campaign)
        for one in (entry.counterexample, *(claim.smallest for claim in entry.claims)):
            if one is not None:
                found.run_again(
                    mappers, one.world, one.claim, asked.limits, one.message, reports=reports
                )
        yield result()


def _note_seconds(output: Output, study: Search) -> None:
    """Enter the processor time of the engine and of the checkers, apart, into `timing`."""
    known = output.timing.setdefault("engine", {"engine": 0.0, "checkers": 0.0})
    known["engine"] += study.seconds.engine
    known["checkers"] += study.seconds.checkers


@contextmanager
def _opened(
    output: Output, asked: _SearchOptions, campaign: Campaign, mappers: tuple[Target, ...]
) -> Generator[StoredCampaign | None]:
    """The store, if one is asked for."""
    if asked.ledger is None:
        yield None
        return
    with Store(asked.ledger) as store:
        now = Identity(mappers, asked.depends).loaded()
        known = store.campaign(campaign.identity(source_hash(mappers)), now)
        if known.since is not None:
            output.timing["ledger"] = dict(zip(("first", "last"), known.since, strict=True))
        yield known
        store.require_file()
