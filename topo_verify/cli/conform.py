"""`topo-verify conform`: the oracle for an implementation, in Python or any program."""

from __future__ import annotations

import re
import secrets
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import product

import click
import msgspec

from topo_verify.campaign.backend import MapperCampaign
from topo_verify.campaign.campaign import Campaign, ListedWorlds, close
from topo_verify.campaign.judge import Report, judge
from topo_verify.campaign.run import explore
from topo_verify.campaign.store import Store, StoredCampaign
from topo_verify.campaign.targets import each_text, one_target, target_arguments
from topo_verify.campaign.work import processors
from topo_verify.cli import options, runs
from topo_verify.cli.output import Output, Result
from topo_verify.errors import InputError, WriteError, plural
from topo_verify.pictures.recording import PlayedRun
from topo_verify.pictures.scenes import Playback
from topo_verify.pictures.walk import parting
from topo_verify.programs.program import OPTIONS
from topo_verify.report import account as acc
from topo_verify.report.blocks import Block, Bullets, Command, Text, TextTable, View
from topo_verify.robot.limits import Limits
from topo_verify.studies.conform.batch import batched
from topo_verify.studies.conform.conform import Asked, Conform, LevelResult, WorldFinding
from topo_verify.studies.corpus import CorpusWorlds, corpus_from
from topo_verify.world.rooted_map import World

SHOWN = 3


def _seeds(_context: click.Context, _option: click.Parameter, value: str | None) -> tuple[int, int]:
    if value is None:
        return 0, secrets.randbelow(2**32)
    match = re.fullmatch(r"([0-9]{1,18})(?::([0-9]{1,18}))?", value)
    if match is None:
        raise click.BadParameter(f"expected N or N:ORDER, two numbers from 0, got {value!r}")
    return int(match[1]), int(match[2] or match[1])


@options.command(
    "conform my_mapper.py:explore",
    "conform --cmd './mapper --fast' --like enhancement-ii",
    "conform --cmd ./mapper --worlds 'edges<=5' --worlds nyc --transcript DIR",
    "conform --cmd ./simulator --batch --worlds generated:10000",
    reports=True,
)
@options.mappers()
@click.option(
    "--worlds",
    "texts",
    multiple=True,
    metavar="WORLDS",
    help="corpus, edges<=N, generated:N[:STRATEGY], drawn:N:FAMILY, a folder, any WORLD;"
    " may be repeated."
    "  [default: corpus]",
)
@click.option(
    "--like",
    metavar="ALGORITHM",
    help="Compare every event with this algorithm of the catalogue; several with commas.",
)
@options.policies
@click.option("--batch", is_flag=True, help="The program reads worlds and writes runs.")
@options.workers()
@options.store
@click.option("--validate", is_flag=True, help="Refuse fields that no schema lists.")
@options.strict
@click.option("--transcript", metavar="DIR", help="Write the messages of failing worlds to DIR.")
@click.option(
    "--seed",
    "seeds",
    callback=_seeds,
    metavar="N[:ORDER]",
    help="Seed of the generated worlds, and of the order in which the worlds are met."
    "  [default: 0, and an order drawn anew]",
)
@options.limits
def conform(
    output: Output,
    *,
    mappers: options.Mappers,
    texts: tuple[str, ...],
    like: str | None,
    pick: str | None,
    order: str | None,
    batch: bool,
    workers: int | None,
    store: str | None,
    validate: bool,
    strict: bool,
    transcript: str | None,
    seeds: tuple[int, int],
    limits: Limits,
) -> int:
    """Try an implementation in many worlds and judge it on four separate levels.

    result: its map and its cost. claims: its declared decisions, and whether its history proves the
    map. decisions: every event, compared with --like ALGORITHM. cost: compared with that algorithm
    (or basic). --cmd names a program that speaks protocol 1.
    """
    seed, order_seed = seeds

    def standings() -> Iterator[Result[LevelResult]]:
        corpus = corpus_from(texts, seed=seed)
        usual = Asked()
        likes = each_text(like) if like else ("",)
        number = processors() if workers is None else workers
        if batch and store is not None:
            raise InputError("expected --batch or --store, got both: leave one out")
        if transcript is not None:
            options.make_folder(transcript, "--transcript")
        # The results do not depend on the order.
        output.timing["seed"] = f"{seed}:{order_seed}"
        if corpus.total > 1:
            words = "give it to --seed for the same order of the worlds"
            output.note(f"seed {seed}:{order_seed}: {words}")
        flags = dict(batch=batch, validate=validate, strict=strict, in_process=mappers.in_process)  # noqa: C408
        studies: list[Conform] = []  # all are made before any works, to refuse a wrong name
        for text, name in product(_texts(mappers.texts[0]), dict.fromkeys(likes)):
            campaign = Campaign(
                worlds=ListedWorlds(corpus.total),
                mappers=(text,),
                limits=limits,
                strict=strict,
                validate=validate,
                in_process=mappers.in_process,
                seed=order_seed,
                drawn=not batch,  # it gets the worlds in their order
            )
            again = _replay_command(text, name, (pick, order), flags, limits)
            asked = Asked(name, pick or usual.pick, order or usual.order, transcript or "")
            studies.append(Conform(campaign, corpus, asked, again))
        with options.opened(store) as file:
            for study in studies:
                yield from _tried(output, study, None if batch else number, file, shared)

    shared: dict[str, Playback] = {}
    given = (("--pick", pick), ("--order", order))
    chosen = "".join(f" {option} {value}" for option, value in given if value is not None)
    return output.run(
        "conform",
        standings,
        partial(_show, shared=shared, chosen=chosen),
        account=_account,
        seed=seed,
        corpus=list(texts) or ["corpus"],
        in_process=mappers.in_process,
    )


def _texts(text: str) -> list[str]:
    asked = each_text(text)
    for name in asked:
        if not (name.startswith(OPTIONS) or ":" in name):
            one_target(name)  # refuses an unknown name
    return list(asked)


def _tried(
    output: Output,
    study: Conform,
    workers: int | None,
    store: Store | None,
    shared: dict[str, Playback],
) -> Iterator[Result[LevelResult]]:
    """The result on each level; without `workers`, of a batch program."""
    batch = workers is None
    try:
        if workers is None:
            study.work(batched, output.progress)
        else:
            runs = MapperCampaign(study.campaign, CorpusWorlds(study.corpus), _kept(study, store))
            for row in options.stored_rows(output, [runs], workers, store):
                study.enter(row)
    except (KeyboardInterrupt, WriteError):
        # Before raising: `Output` prints it, then exits 3, or 2 if the store is full.
        yield from map(_result, study.level_results())
        raise
    levels = tuple(study.level_results())
    yield from map(_result, levels)  # an interruption from here on keeps them
    if output.style != "json" and not batch:
        output.found.walk(_failing_run(study, levels))
    if output.exhibits:
        for exhibit in _exhibits(study, levels, batch=batch):
            output.found.show(exhibit)
    if output.style != "json" or output.exhibits:
        for level in levels:
            shared.update(_shared(study, level))


def _kept(study: Conform, store: Store | None) -> StoredCampaign | None:
    if store is None:
        return None
    campaign = msgspec.structs.replace(study.campaign, seed=0)  # it decides the order alone
    mappers = campaign.load()
    try:
        name = f"{study.target}, like {study.asked.like}"
        return store.resumed(campaign, mappers, name=name, all_rows=True)
    finally:
        close(mappers)


def _result(standing: LevelResult) -> Result[LevelResult]:
    verdict = standing.verdict
    return Result(standing, failed=verdict == "REFUTED", incomplete=verdict == "UNKNOWN")


def _replay_command(
    target: str,
    like: str,
    policies: tuple[str | None, str | None],
    flags: Mapping[str, bool],
    limits: Limits,
) -> tuple[str, ...]:
    words = ["topo-verify", "conform", *target_arguments(target)]
    pick, order = policies
    for name, value in (("--like", like or None), ("--pick", pick), ("--order", order)):
        words += [name, value] if value is not None else []
    words += [f"--{name.replace('_', '-')}" for name, given in flags.items() if given]
    return (*words, *limits.options)


# ---------------------------------------------------------------- for people


def _show(
    entries: Sequence[LevelResult], shared: Mapping[str, Playback], chosen: str
) -> Iterator[Block]:
    for number, levels in enumerate(_by_study(entries).values()):
        if number:
            yield Text("")
        yield from _shown(levels, shared, chosen)


def _by_study(entries: Sequence[LevelResult]) -> dict[tuple[str, str], list[LevelResult]]:
    studies: dict[tuple[str, str], list[LevelResult]] = {}
    for entry in entries:
        studies.setdefault((entry.target, entry.like), []).append(entry)
    return studies


_COLUMNS = ("level", "verdict", ">passed", ">failed", ">not decided", ">of worlds")


def _judged(level: LevelResult) -> tuple[str, ...]:
    if level.level == "cost":
        return "measured", str(level.passed), "-"
    return level.verdict, str(level.passed), str(level.failed)


def _shown(
    levels: Sequence[LevelResult], shared: Mapping[str, Playback], chosen: str
) -> Iterator[Block]:
    rows = [
        (
            *(level.level, *_judged(level)),
            *(str(level.worlds - level.passed - level.failed), str(level.worlds)),
        )
        for level in levels
    ]
    first = levels[0]
    asked_like = any(level.level == "decisions" for level in levels)
    beside = "like" if asked_like else "costs beside"
    yield TextTable(_COLUMNS, rows, title=f"{first.target}, {beside} {first.like}{chosen}")
    gone = {
        "skipped": first.skipped,
        "given up": first.errored,
        "out of time": first.undecided,
        "not tried": first.not_tried,
    }
    if any(gone.values()):
        yield Text("")
        words = ", ".join(f"{number} {state}" for state, number in gone.items() if number)
        yield Text(f"Not decided: {words}.")
        yield Bullets(first.why[:SHOWN])
    if silent := sum(level.not_declared for level in levels):
        yield Text("")
        yield Text(
            f"decisions: not decided in {plural(silent, 'world')}, because {first.target} declares"
            " nothing; leave out --like, or declare."
        )
    for level in levels:
        yield from _findings(level, shared)
    yield from _costs(levels[-1], chosen)
    judgements = [judgement for level in levels for judgement in level.judgements]
    for sentence in runs.unjudged(first.target, "these worlds", judgements) if first.passed else ():
        yield Text("")
        yield sentence


def _findings(level: LevelResult, shared: Mapping[str, Playback]) -> Iterator[Block]:
    for kind, number in level.kinds.items():
        finding = next(other for other in level.findings if other.kind == kind)
        yield Text("")
        title = f"{level.level}: {kind}" if kind != level.level else kind
        yield Text(f"{title} in {plural(number, 'world')}, first {finding.world}:")
        yield from _difference(finding, level, shared)
        yield Command(finding.replay, "again: ")


def _difference(
    finding: WorldFinding, level: LevelResult, shared: Mapping[str, Playback]
) -> Iterator[Block]:
    """One finding; if two runs differ, their common walk, and what each does then."""
    parted, run = finding.difference, shared.get(finding.replay)
    if parted is None or run is None:
        where = "" if finding.event is None else f"event {finding.event}: "
        yield Bullets((f"{where}{finding.message}",))
        return
    sides = ((level.like, parted.expected), (level.target, parted.seen))
    lines = [(name, does or "does nothing more") for name, does in sides]
    yield Text("")
    yield View(lambda width: parting(run, parted.at, lines, width))
    yield Text("")


def _shared(study: Conform, level: LevelResult) -> dict[str, Playback]:
    """The reference's run where a mapper first differs from it, by its replay command."""
    for finding in level.findings:
        if finding.difference is not None:
            world = next(at.world for at in study.corpus if at.name == finding.world)
            run = explore(world, study.asked.reference)
            return {finding.replay: Playback(world, run.trace)}
    return {}


def _costs(level: LevelResult, chosen: str) -> Iterator[Block]:
    if level.level != "cost" or level.cost.ratio is None:
        return
    cost = level.cost
    yield Text("")
    yield Text(
        f"Cost over {plural(level.passed, 'world')}: {plural(cost.mapper, 'edge traversal')},"
        f" {level.like}{chosen} {cost.reference}: {cost.ratio:.3f} of it."
    )
    other = [price for price in level.priced if price.ratio not in (1.0, None)]
    if not other:
        return
    ranked = sorted(other, key=lambda price: -(price.ratio or 0))
    outer = list(dict.fromkeys([*ranked[:SHOWN], *ranked[-SHOWN:]]))
    rows = [(o.world, str(o.mapper), str(o.reference), f"{o.ratio:.3f}") for o in outer]
    yield TextTable(("world", ">cost", f">{level.like}", ">ratio"), rows)


# ---------------------------------------------------------------- the account


def _account(levels: Sequence[LevelResult]) -> acc.Account:
    names = list(dict.fromkeys(level.target for level in levels))
    verdict = acc.joint_verdict([level.verdict for level in levels])
    whole = [level for level in levels if level.verdict == verdict]
    failed = max((level.failed for level in whole), default=0)
    passed = min((level.passed for level in levels), default=0)
    total = levels[0].worlds if levels else 0
    words = acc.counted(passed, total, f"{acc.worlds(total)} conform")
    if verdict == "REFUTED":
        words = acc.counted(failed, total, f"{acc.worlds(total)} fail")
    several = len({level.like for level in levels}) > 1
    suites = (
        (f"{target}, like {like}" if several else target, _cases(of_study))
        for (target, like), of_study in _by_study(levels).items()
    )
    extent = acc.JudgedExtent(verdict, words)
    return acc.Account(", ".join(names), extent, acc.suites(suites))


def _cases(levels: Sequence[LevelResult]) -> Iterator[acc.JudgedCase]:
    for level in levels:
        first = level.findings[0] if level.findings else None
        yield acc.verdict_case(
            f"level {level.level}",
            level.verdict,
            judged=f"{level.passed:,} of {level.worlds:,}",
            message=(level.why or ("",))[0] if first is None else f"{first.world}: {first.message}",
            again="" if first is None else first.replay,
        )
        for case in acc.claim_cases(level.judgements):
            finding = next((other for other in level.findings if other.claim == case.name), None)
            if finding is None:
                yield case
            else:
                yield replace(case, message=finding.message, again=finding.replay)


# ---------------------------------------------------------------- for the page


def _exhibits(
    study: Conform, levels: Sequence[LevelResult], *, batch: bool
) -> Iterator[acc.Exhibit]:
    """The first world of each kind of finding; a batch program is not run again."""
    first: dict[str, list[WorldFinding]] = {}
    for level in levels:
        for kind in level.kinds:
            finding = next(other for other in level.findings if other.kind == kind)
            first.setdefault(finding.world, []).append(finding)
    if not first:
        return
    worlds = {at.name: at.world for at in study.corpus if at.name in first}
    target = study.target + (f", like {study.asked.like}" if study.asked.like else "")
    for number, (name, findings) in enumerate(first.items()):
        played: tuple[PlayedRun, ...] = ()
        if not batch and number < runs.MOST_EXHIBITS:
            played = tuple(_runs_in(study.campaign, worlds[name], findings))
        notes = dict.fromkeys(f"{other.kind}: {other.message}" for other in findings)
        yield acc.Exhibit(
            title=runs.target_title(target, name),
            world=worlds[name],
            name=name,
            notes=tuple(notes),
            runs=played,
            again=findings[0].replay,
        )


def _runs_in(
    campaign: Campaign, world: World, findings: Sequence[WorldFinding]
) -> Iterator[PlayedRun]:
    for target in campaign.load():
        report = judge(explore(world, target, limits=campaign.limits), strict=campaign.strict)
        exhibit = runs.exhibit_of(report)
        yield from exhibit.runs if exhibit is not None else ()
    if any(finding.difference is not None for finding in findings):
        asked = Asked(*campaign.asked)
        yield PlayedRun(asked.name, explore(world, asked.reference).trace)


def _failing_run(study: Conform, levels: Sequence[LevelResult]) -> Report | None:
    """The run in the first world where a claim fails, made again; None if it holds this time."""
    findings = (finding for level in levels for finding in level.findings)
    convicting = (finding for finding in findings if finding.difference is None)
    finding = next(convicting, None)
    if finding is None:
        return None
    campaign = study.campaign
    world = next(at.world for at in study.corpus if at.name == finding.world)
    for target in campaign.load():
        named = runs.NamedWorld(world, finding.world)
        _, report, _ = runs.judged(target, named, campaign.limits, strict=campaign.strict)
        if any(other.claim == finding.claim for other in report.findings):
            return report
    return None
