"""`topo-verify search`: find the smallest counterexample among all worlds of up to N edges."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from functools import partial
from itertools import chain
from pathlib import Path

import click

from topo_verify import extras
from topo_verify.campaign.backend import Elsewhere, MakeBackend, here, pooled
from topo_verify.campaign.campaign import MAX_LOST, Backend, Campaign
from topo_verify.campaign.engine import EngineSeconds
from topo_verify.campaign.examiner import examiner_of
from topo_verify.campaign.store import Store, StoredCampaign
from topo_verify.campaign.targets import targets
from topo_verify.campaign.work import processors
from topo_verify.cli import options
from topo_verify.cli.output import Output, Result
from topo_verify.cli.runs import unjudged
from topo_verify.errors import HelperLost, InputError, WriteError, plural
from topo_verify.programs.library import LIBRARY
from topo_verify.programs.loaded import watch
from topo_verify.programs.loader import Target
from topo_verify.report import account as acc
from topo_verify.report.blocks import Block, Bullets, Command, Text, TextTable
from topo_verify.robot.limits import Limits
from topo_verify.studies.search import search as study
from topo_verify.studies.search.again import RunAgain
from topo_verify.studies.search.choices import CHOICES, Choices, reports_of
from topo_verify.world.enumeration.classes import WorldClass


@options.command(
    "search basic --edges 5",
    "search my_mapper.py:explore --class planar --keep-going",
    "search enhancement-i --edges 6 --ledger FILE --worst",
    "search basic --policies every --edges 4 --worst",
    "search --compare enhancement-ii,enhancement-i --edges 5",
    reports=True,
)
@options.mappers(required=False)
@options.number("--edges", least=1, default=5, meaning="Worlds of 1 to N edges.")
@options.world_class
@options.workers()
@extras.options("search")
@click.option("--ledger", metavar="FILE", help="Keep finished work in FILE and resume from it.")
@click.option(
    "--depends",
    multiple=True,
    metavar="FILE",
    help="The TARGET uses FILE: if it changes, the ledger is refused. May be repeated.",
)
@click.option("--keep-going", is_flag=True, help="Do not stop at the first counterexample.")
@click.option(
    "--policies",
    type=click.Choice(CHOICES),
    default="reference",
    show_default=True,
    help="Use the reference policies, all named ones, or (to 4 edges) every possible choice.",
)
@click.option("--worst", is_flag=True, help="Show the highest costs and the worlds that have them.")
@click.option("--compare", metavar="A,B", help="Show where A costs more than B.")
@options.seed("Seed of the worlds that are run again.")
@options.limits
def search(
    output: Output,
    *,
    mappers: options.Mappers,
    edges: int,
    kind: str,
    workers: int | None,
    elsewhere: Elsewhere | None,
    ledger: str | None,
    depends: tuple[str, ...],
    keep_going: bool,
    policies: Choices,
    engine: str | None,
    worst: bool,
    compare: str | None,
    seed: int,
    limits: Limits,
) -> int:
    """Examine a mapper in every world of 1 to N edges, smallest first.

    The search stops at the smallest counterexample (REFUTED) or after the last world (EXHAUSTED).
    TARGET is a name of the catalogue, several with commas, all, module:attribute or
    file.py:attribute.

    Classes of a genus and a property of the graph end at 7 edges, except planar,loopless and
    planar,simple.
    """

    def searches() -> Iterator[Result[study.SearchEntry]]:
        campaign_of = partial(
            study.search_campaign,
            edges=edges,
            kind=str(WorldClass.parse(kind)),
            choices=policies,
            keep_going=keep_going,
            limits=limits,
            seed=seed,
            in_process=mappers.in_process,
            engine=engine,
        )
        for path in depends:
            if not Path(path).is_file():
                raise InputError(f"--depends {path}: there is no such file; name one that exists")
        with nullcontext() if elsewhere is None else elsewhere.opened(workers) as opened:
            if ledger is not None:
                watch()  # before a mapper is loaded, after a backend has read its settings
            needed = None if ledger is None else depends
            for searched in _searches(mappers, compare, ledger):
                campaign = campaign_of(searched)
                backend = _backend(campaign, searched, workers, opened, needed, output.note)
                with _opened(output, ledger, depends, campaign, searched) as store:
                    one_search = study.Search(campaign, searched, backend, store)
                    yield from _searched(output, one_search, compare=compare is not None)

    def show(entries: Sequence[study.SearchEntry]) -> Iterator[Block]:
        return chain.from_iterable(shown(entry, worst=worst) for entry in entries)

    return output.run(
        "search",
        searches,
        show,
        account=_account,
        extent=_extent,
        in_process=mappers.in_process,
    )


def _backend(
    campaign: Campaign,
    mappers: tuple[Target, ...],
    workers: int | None,
    elsewhere: MakeBackend | None,
    depends: tuple[str, ...] | None,
    note: Callable[[str], None],
) -> Backend:
    if elsewhere is not None:
        return elsewhere(depends)
    number = processors() if workers is None else workers
    if number or examiner_of(campaign).needs_worker:
        return pooled(number, depends, note)
    return here(mappers, depends=depends)


def _searches(
    mappers: options.Mappers, compare: str | None, ledger: str | None
) -> list[tuple[Target, ...]]:
    if bool(mappers.texts) == (compare is not None):
        raise InputError("expected either a TARGET or two mappers with --compare A,B")
    if compare is not None:
        pair = targets(compare)
        if len(pair) != 2 or pair[0] == pair[1]:
            raise InputError(
                f"--compare {compare}: expected two different algorithms of the catalogue, as A,B"
            )
        return [pair]
    separate: list[tuple[Target, ...]] = [(mapper,) for mapper in mappers.load(at_once=False)]
    if ledger is not None and len(separate) != 1:
        raise InputError(
            f"--ledger {ledger}: expected one TARGET, got {len(separate)}; search them one by one"
        )
    return separate


def _searched(
    output: Output, one_search: study.Search, *, compare: bool
) -> Iterator[Result[study.SearchEntry]]:
    campaign = one_search.campaign

    def result() -> Result[study.SearchEntry]:
        entry = one_search.entry(compare=compare)
        failed, incomplete = entry.verdict == "REFUTED", entry.verdict not in study.DONE
        return Result(entry, failed=failed, incomplete=incomplete)

    try:
        one_search.work(output.progress)
        one_search.run_again(output.progress)
    except (HelperLost, KeyboardInterrupt, WriteError):
        # Before raising: `Output` prints it, then exits 3, or 2 if the ledger is full.
        yield result()
        raise
    if one_search.seconds != EngineSeconds():
        known = output.timing.setdefault("engine", {"engine": 0.0, "checkers": 0.0})
        known["engine"] += one_search.seconds.engine
        known["checkers"] += one_search.seconds.checkers
    yield result()  # an interruption from here on keeps it
    entry = one_search.entry()
    reports = None if campaign.ways is None else partial(reports_of, campaign)
    for example in (entry.counterexample, *(claim.smallest for claim in entry.claims)):
        if example is None:
            continue
        report = one_search.report(example)
        if report is not None:
            output.found.keep(report)
        else:
            output.found.run_again(
                one_search.mappers,
                *(example.world, example.claim, campaign.limits, example.message),
                reports=reports,
            )


@contextmanager
def _opened(
    output: Output,
    ledger: str | None,
    depends: tuple[str, ...],
    campaign: Campaign,
    mappers: tuple[Target, ...],
) -> Generator[StoredCampaign | None]:
    if ledger is None:
        yield None
        return
    with Store(ledger) as store:
        known = store.resumed(campaign, mappers, depends)
        if known.since is not None:
            output.timing["ledger"] = dict(zip(("first", "last"), known.since, strict=True))
        try:
            yield known
        except KeyboardInterrupt:
            results = map(known.get, known.known())
            if any(result is not None and result.tally.worlds for result in results):
                output.note(f"{ledger} has the finished work: the same command goes on")
            else:
                output.note(f"{ledger} has nothing yet: no shard of worlds was finished")
            raise
        store.require_file()


# ---------------------------------------------------------------- the account


def _extent(entries: Sequence[study.SearchEntry]) -> str:
    if len(entries) != 1:
        return plural(len(entries), "result")
    return acc.counted(entries[0].checked, entries[0].total, acc.worlds(entries[0].total))


def _account(entries: Sequence[study.SearchEntry]) -> acc.Account:
    verdict = acc.joint_verdict([entry.verdict for entry in entries])
    failing = sum(size.failing for entry in entries for size in entry.by_edges)
    checked, total = sum(e.checked for e in entries), sum(e.total for e in entries)
    return acc.Account(
        ", ".join(entry.target for entry in entries),
        acc.extent(verdict, checked, total, failing),
        acc.suites((f"{entry.target}: {_class(entry, ', ')}", _cases(entry)) for entry in entries),
    )


def _class(entry: study.SearchEntry, before: str) -> str:
    kind = "" if entry.kind == "any" else f"{before}{entry.kind}"
    return f"worlds of 1 to {plural(entry.edges, 'edge')}{kind}"


def _cases(entry: study.SearchEntry) -> Iterator[acc.JudgedCase]:
    first = entry.counterexample
    yield acc.verdict_case(
        "every world of the class",
        entry.verdict,
        judged=f"{entry.checked:,} of {entry.total:,}",
        message="" if first is None else f"{first.claim} in {first.world}: {first.message}",
        again="" if first is None else first.replay,
    )
    wrong = {failing_claim.claim: failing_claim for failing_claim in entry.claims}
    for case in acc.claim_cases(entry.judgements):
        failing_claim = wrong.pop(case.name, None)
        yield case if failing_claim is None else _failing(failing_claim)
    yield from map(_failing, wrong.values())


def _failing(claim: study.FailingClaim) -> acc.JudgedCase:
    first = claim.smallest
    where = f"in {plural(claim.failing, 'world')}; {first.message}"
    return acc.JudgedCase(claim.claim, "failed", "failed", message=where, again=first.replay)


# ---------------------------------------------------------------- for people

SHOWN = 3


LOST_WORKER = (
    "A worker was lost, or the mapper stood still: another program may be the cause, or a busy"
    " machine. Tried again, nothing failed:"
)

NOT_THE_SAME = (
    "Tried again, the library does not do the same in these worlds: it writes out of place, perhaps"
    " in another world, or keeps something from world to world. To find the line, build it with -g"
    " -fsanitize=address and put LD_PRELOAD=$(gcc -print-file-name=libasan.so)"
    " ASAN_OPTIONS=detect_leaks=0 before this whole search."
)


def shown(entry: study.SearchEntry, *, worst: bool = False) -> Iterator[Block]:
    """A search as the command shows it; `worst`: with the highest costs."""
    policies = "" if entry.policies == "reference" else f", policies {entry.policies}"
    title = f"{_who(entry)}: {_class(entry, ', class ')}{policies}"
    rows = [
        (str(e.edges), str(e.checked), str(e.total), str(e.failing), *(_costs(e) if worst else ()))
        for e in entry.by_edges
    ]
    costs = (">max cost", ">mean", ">in worlds", "which") if worst else ()
    yield TextTable((">edges", ">checked", ">total", ">failing", *costs), rows, title)
    pairs = [_compared(e.edges, e.compare) for e in entry.by_edges if e.compare is not None]
    if pairs:
        yield Text("")
        yield TextTable(
            (
                *(">edges", ">A costs", ">B costs", ">A costs more", ">at most by"),
                *(">B costs more", "A costs more, first"),
            ),
            pairs,
            title="costs in edge traversals",
        )
    yield from _every(entry, worst=worst)
    yield Text("")
    yield Text(f"{entry.verdict}: {_conclusion(entry)}")
    if entry.lost:
        yield Text(NOT_THE_SAME if entry.target.startswith(LIBRARY) else LOST_WORKER)
        more = len(entry.lost) - SHOWN
        rest = (f"and {more} more: --format json has them",) if more > 0 else ()
        named = tuple(f"{lost.world}: {lost.how}" for lost in entry.lost[:SHOWN])
        yield Bullets((*named, *rest))
        if entry.target.startswith(LIBRARY) and len(entry.lost) >= MAX_LOST:
            yield Text(f"After {MAX_LOST} such worlds the library is given up.")
    if entry.run_again is not None and (entry.verdict != "REFUTED" or not entry.run_again.is_same):
        yield from _run_again(entry.run_again)
    if entry.engine != "reference":
        yield Text(f"judged by {entry.judged_by}: {plural(entry.by_checkers, 'world')}")
    yield from _counterexamples(entry)
    if entry.verdict != "REFUTED":
        yield from unjudged(entry.target, "these worlds", entry.judgements)


def _run_again(again: RunAgain) -> Iterator[Block]:
    end = "" if again.whole else "; then it was interrupted, and worlds are missing"
    yield Text(
        f"Run again: {plural(again.worlds, 'world')} alone, {again.row} in a row:"
        f" {again.same} same, {again.other} other, {again.undecided} undecided{end}."
    )
    if again.others:
        yield Text(
            f"Run again, alone or in another order, it does not do the same in"
            f" {_some(again.others, len(again.others))}: it takes other doors, or declines a world"
            " that it mapped. It draws lots, or keeps something from world to world. Seed it anew"
            " in each world, and the verdict can stand."
        )
    if again.undecided_worlds:
        yield Text(
            f"Run again, it is undecided in {_some(again.undecided_worlds, again.undecided)}:"
            " a signal or a time limit ended it there, or it declined. Perhaps the machine is busy"
            " or short of memory, or the mapper keeps memory from world to world."
        )


def _every(entry: study.SearchEntry, *, worst: bool) -> Iterator[Block]:
    sizes = [(e.edges, e.every) for e in entry.by_edges if e.every is not None and e.every.worlds]
    if not sizes:
        return
    rows = [(str(m), str(e.states), str(e.choices), e.decided_by, e.judged_by) for m, e in sizes]
    yield Text("")
    yield TextTable((">edges", ">states", ">choices", "decided by", "judged by"), rows)
    if not worst:
        return
    costs = [
        (str(m), *map(str, (e.cheapest, e.reference, e.dearest)), *_saved(e)) for m, e in sizes
    ]
    yield Text("")
    columns = (">edges", ">cheapest", ">reference", ">highest", ">saves", ">at most", "in")
    yield TextTable(columns, costs, "sums of costs: the least, of the reference, the most")
    low, reference = (sum(getattr(e, name) for _, e in sizes) for name in ("cheapest", "reference"))
    yield Text("")
    yield Text(
        f"No policy of pick and order saves more than {1 - low / reference:.1%} of what the"
        " reference policies cost in these worlds together."
    )


def _saved(entry: study.EveryCost) -> tuple[str, ...]:
    together = f"{1 - entry.cheapest / entry.reference:.1%}"
    most = entry.most_saved
    if most is None or most.reference == most.cheapest:
        return together, "-", "-"
    return together, f"{1 - most.cheapest / most.reference:.1%}", most.world


def _who(entry: study.SearchEntry) -> str:
    if all(e.compare is None for e in entry.by_edges):
        return entry.target
    first, _, second = entry.target.partition(",")
    return f"A {first}, B {second}"


def _costs(entry: study.ByEdges) -> tuple[str, ...]:
    mean = f"{entry.total_cost / entry.runs:.2f}" if entry.runs else "-"
    worst = _some(entry.worst, entry.attained)
    return str(entry.max_cost), mean, str(entry.attained), worst


def _compared(edges: int, pair: study.CostComparison) -> tuple[str, ...]:
    first = [f"{world.world} ({world.cost}, {world.other})" for world in pair.first]
    row = map(str, (edges, *pair.totals, pair.dearer, pair.most, pair.cheaper))
    return (*row, _some(first, pair.dearer))


def _some(names: Sequence[str], number: int) -> str:
    shown = ", ".join(names[:SHOWN])
    return f"{shown} …" if number > SHOWN else shown or "-"


def _conclusion(entry: study.SearchEntry) -> str:
    worlds = f"{entry.checked} of {plural(entry.total, 'world')} checked"
    if entry.from_ledger:
        now = sum(size.checked + size.undecided for size in entry.by_edges) - entry.from_ledger
        worlds += f" ({entry.from_ledger} from the ledger, {now} now)"
    failing = sum(size.failing for size in entry.by_edges)
    undecided = sum(size.undecided for size in entry.by_edges)
    late = f"; {undecided} more not decided" if undecided else ""
    if entry.undecided is not None:
        late += f", first {entry.undecided.world}: {entry.undecided.why}"
    if entry.verdict == "REFUTED" and not failing:
        return f"{worlds}, another verdict when one was run again{late}"
    if entry.verdict == "REFUTED":
        return f"{worlds}, a claim fails in {failing}{late}"
    if entry.verdict == "UNKNOWN":
        return f"{worlds}, no claim failed there{late}"
    return f"{worlds}, no claim failed{late}"


def _counterexamples(entry: study.SearchEntry) -> Iterator[Block]:
    first = entry.counterexample
    if first is None:
        return
    yield Text(f"smallest counterexample: {first.world}")
    yield Bullets((f"{first.claim}: {first.message}",))
    if first.replay:
        yield Command(first.replay, "again: ")
    if sum(size.failing for size in entry.by_edges) > 1:
        rows = [(c.claim, str(c.failing), c.smallest.world) for c in entry.claims]
        yield Text("")
        yield TextTable(("claim that fails", ">in worlds", "smallest"), rows)
