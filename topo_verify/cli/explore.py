"""`topo-verify explore`: runs algorithms in given worlds; cost and verdict of each run.

With `--marker all`, two darts from which the world looks the same make one rooted map: one run
serves both, and `same_as` marks the repeated entry.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, count
from statistics import mean
from typing import Literal, Protocol

import click
import msgspec

from topo_verify import extras
from topo_verify.campaign.engine import on_engine
from topo_verify.campaign.judge import Report, is_for_engine
from topo_verify.campaign.run import Exploration
from topo_verify.checkers import Finding, Judgement, Status
from topo_verify.checkers.claims import LARGE
from topo_verify.checkers.findings import Verdict
from topo_verify.cli import former, options, runs
from topo_verify.cli.output import Output, Result, Rows, entry_of
from topo_verify.errors import InputError, plural
from topo_verify.pictures.recording import PlayedRun
from topo_verify.pictures.scenes import Playback
from topo_verify.programs.loader import Target
from topo_verify.report import account as acc
from topo_verify.report.blocks import Block, Text, TextTable
from topo_verify.robot.events import write_trace
from topo_verify.robot.limits import Limits
from topo_verify.studies.gap import Gap
from topo_verify.studies.gap import gap as measure
from topo_verify.studies.search.states.every import ListedChoices
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import Code


class ChosenPolicies(msgspec.Struct, frozen=True):
    """The policies of a run; None for a mapper that has none."""

    pick: str | None
    order: str | None


class ExploreEntry(msgspec.Struct, frozen=True):
    """One run of a mapper.

    Attributes:
        isomorphic: the map is the world.
        entailed: the history alone proves the map.
        ok: no claim failed, and the run ended in time.
        gap: with --gap, if the mapper declares every decision; otherwise null.
        marker: the dart that the marker points at, numbered as in the world's file.
        place: the vertex of the marker.
        same_as: with `--marker all`, a smaller dart from which the world looks the same; this
            run is that one's.
        rejected_free: hypotheses rejected without a move since the decision before; by `basic`,
            where vu shows the marker in another direction than the hypothesis predicts.
        rejected_moving: hypotheses rejected by a move.
        confirmed: hypotheses confirmed.
        by_compiled_judge: the compiled judge, which is not trusted, judged the run; the checkers
            judged it only if that convicted it or left it open.
    """

    world: str
    algorithm: str
    policies: ChosenPolicies
    vertices: int
    edges: int
    genus: int
    cost: int
    least_cost: int
    isomorphic: bool
    entailed: bool
    ok: bool
    findings: tuple[Finding, ...]
    rejected_free: int
    rejected_moving: int
    confirmed: int
    claims: dict[str, Status]
    judgements: tuple[Judgement, ...]
    stopped: str | None
    gap: Gap | None
    marker: int | None
    place: int
    same_as: int | None = None
    by_compiled_judge: bool = False


All = Literal["all"]


def _dart_or_all(
    _context: click.Context, _option: click.Parameter, value: str | None
) -> int | All | None:
    if value is None or value == "all":
        return "all" if value else None
    try:
        return int(value)
    except ValueError:
        raise click.BadParameter(f"expected a dart (a number) or all, got {value!r}") from None


marker_option = click.option(
    "--marker",
    callback=_dart_or_all,
    metavar="DART|all",
    help="Let the marker point at this DART; all: at each dart in turn.",
)


class RunFile(Protocol):
    """What an option of an extra asks for: a file made of one run."""

    @property
    def name(self) -> str:
        """The name of the file."""
        ...

    def write(self, playback: Playback, mapper: str) -> None:
        """Write the animated run of this mapper to the file."""
        ...


@dataclass(frozen=True)
class _ExploreOptions:
    limits: Limits
    trace: str | None
    player: str | None
    files: tuple[RunFile, ...]
    strict: bool
    gap: bool
    everywhere: bool
    choices: ListedChoices | None


@options.command(
    "explore nyc",
    "explore m3/14 --target basic,enhancement-ii --trace FILE",
    "explore m2/8 --target folding+planar --choices 0,1",
    "explore nyc --target folding --marker all",
    "explore 'family:lattice(10,10,holes=0.2)' --target my_mapper.py:explore",
    reports=True,
)
@click.argument("worlds", nargs=-1, required=True, metavar="WORLD...")
@options.mappers(
    "all",
    meaning="Names of the catalogue, module:attribute or file.py:attribute, with commas."
    " May be repeated.",
    several=True,
    with_policies=True,
)
@click.option(
    "--choices",
    metavar="LIST",
    help="Choose by these numbers, as 0,2,1: which e, which h next (one run only).",
)
@extras.options("explore", "engine")
@marker_option
@click.option("--trace", metavar="FILE", help="Write the trace as JSON Lines (one run only).")
@options.player
@extras.options("explore", "svg")
@options.strict
@click.option(
    "--gap", is_flag=True, help="Count the hypotheses that were walked although already refuted."
)
@options.limits
def explore(
    output: Output,
    *,
    worlds: tuple[str, ...],
    mappers: options.Mappers,
    choices: str | None,
    engine: str,
    marker: int | Literal["all"] | None,
    trace: str | None,
    player: str | None,
    strict: bool,
    gap: bool,
    limits: Limits,
    **added: RunFile | None,
) -> int:
    """Run algorithms in given worlds and show what each run costs and which claims hold.

    WORLD is a file, a world id (m5/17), family:lattice(10,10,holes=0.2,seed=7), nyc (a real street
    network) or - (world JSON on standard input). Rejected free: without a move, by basic only where
    the marker's direction at the end of the new edge differs at once.
    """
    everywhere = marker == "all"
    run_files = {option: file for option, file in added.items() if file is not None}
    file_names = {option: file.name for option, file in run_files.items()}

    def explored() -> Iterator[Result[ExploreEntry]]:
        targets = on_engine(engine, mappers.load(), limits)
        output.require_places(trace=trace, **file_names)
        if everywhere:
            others = {"trace": trace, "player": player, "gap": gap, **file_names}
            _require_one_marker(others)
        starts = runs.named_worlds(worlds, marker if isinstance(marker, int) else None)
        for option, value in {"trace": trace, **file_names, "choices": choices}.items():
            if value is not None and not (everywhere and option == "choices"):
                _require_one_run(f"--{option}", value, targets, starts)
        runs.require_one_world(player, len(starts))
        listed = None
        if choices is not None and not everywhere:
            if mappers.pick is not None or mappers.order is not None:
                raise InputError(
                    f"--choices {choices}: the choices are the policies; leave out --pick and"
                    " --order"
                )
            listed = ListedChoices(targets[0], choices)
            targets = (listed.target,)
        asked = _ExploreOptions(
            limits, trace, player, tuple(run_files.values()), strict, gap, everywhere, listed
        )
        return _results(output, starts, targets, asked)

    return output.run(
        "explore",
        explored,
        _show_markers if everywhere else _show,
        account=_account,
        in_process=mappers.in_process,
    )


def _require_one_run(
    option: str, value: str, targets: Sequence[Target], starts: Sequence[runs.NamedWorld]
) -> None:
    if value == "-":
        raise InputError(f"{option} -: standard output is for the results; name a file")
    if len(targets) * len(starts) != 1:
        raise InputError(
            f"{option} {value}: expected one run, got {len(targets) * len(starts)}; name one"
            " WORLD, and one mapper with --target"
        )


def _require_one_marker(others: Mapping[str, object]) -> None:
    for option, value in others.items():
        if value:
            raise InputError(
                former(f"explore --marker all --{option}")
                or f"--{option} is for one marker: leave it out, or name one with --marker DART"
            )


def _results(
    output: Output,
    starts: Sequence[runs.NamedWorld],
    targets: Sequence[Target],
    asked: _ExploreOptions,
) -> Iterator[Result[ExploreEntry]]:
    for at in starts:
        if asked.everywhere and not at.world.alpha:
            raise InputError(f"--marker all: {at.name} has no edge that a marker could point at")
    groups = [
        (at, target, [*_placed(at)] if asked.everywhere else [at])
        for at in starts
        for target in targets
    ]
    total, number = sum(len(places) for _, _, places in groups), count()
    played: list[PlayedRun] = []
    try:
        for at, target, places in groups:
            results: dict[Code, Result[ExploreEntry]] = {}
            for place in places:
                output.progress(f"{target.text} in {at.name}", next(number), total)
                first = results.get(place.world.code) if asked.everywhere else None
                if first is None:
                    result, run = _explored(output, place, target, asked, played)
                    results[place.world.code] = result
                    yield result
                    _write_run(asked, run, played[-1])
                else:
                    yield replace(first, entry=_as_at(place, first.entry))
    finally:  # an interrupt keeps the runs that are done
        if asked.player is not None and played:
            runs.write_page(asked.player, starts[0].world, starts[0].name, played)


def _explored(
    output: Output,
    at: runs.NamedWorld,
    target: Target,
    asked: _ExploreOptions,
    played: list[PlayedRun],
) -> tuple[Result[ExploreEntry], Exploration]:
    choices = asked.choices
    run, report, incomplete = runs.judged(
        target,
        at,
        asked.limits,
        strict=asked.strict,
        before_judging=lambda run: run if choices is None else choices.checked(run),
    )
    if choices is not None:
        report = choices.named(report, asked.limits)
    output.found.keep(report)
    played.append(PlayedRun(run.algorithm, run.trace, report.judgements, run.stopped))
    return _result(run, at, report, asked, incomplete=incomplete), run


def _write_run(asked: _ExploreOptions, run: Exploration, played: PlayedRun) -> None:
    if asked.trace is not None:
        files.write(asked.trace, write_trace(run.kept_trace).decode())
    if asked.files:
        playback = Playback(run.world, run.trace, played.judgements, run.stopped)
        for file in asked.files:
            file.write(playback, run.algorithm)


def _placed(at: runs.NamedWorld) -> Iterator[runs.NamedWorld]:
    for dart in range(len(at.world.alpha)):
        yield runs.NamedWorld(replace(at.world.with_marker(dart), name=at.name), at.text, dart)


def _as_at(place: runs.NamedWorld, entry: ExploreEntry) -> ExploreEntry:
    root = place.world.root
    assert root is not None, "a place is a dart"
    return msgspec.structs.replace(
        entry, marker=root, place=place.world.vertex_of[root], same_as=entry.marker
    )


# ---------------------------------------------------------------- for people


def _show(entries: Sequence[ExploreEntry]) -> Iterator[Block]:
    if len(entries) > 1 and len({entry.algorithm for entry in entries}) == 1:
        rows = [(entry.world, str(entry.edges), *_row(entry)) for entry in entries]
        yield TextTable(("world", ">edges", *_COLUMNS), rows, title=entries[0].algorithm)
    else:
        for number, group in enumerate(_by_world(entries)):
            if number:
                yield Text("")
            yield _world_table(group)
    for entry in entries:
        if entry.findings:
            yield Text("")
        yield from _wrong(entry, f"{entry.algorithm} in {entry.world}")
    sentences = dict.fromkeys(
        sentence
        for entry in entries
        if not entry.findings and entry.stopped is None
        for sentence in _judged_how(entry)
    )
    for sentence in sentences:
        yield Text("")
        yield sentence
    yield from _gap_table(entries)


def _judged_how(entry: ExploreEntry) -> Iterator[Text]:
    """Sentences about what was not fully judged, and about a judge that is not trusted."""
    yield from runs.unjudged(entry.algorithm, entry.world, entry.judgements)
    if entry.by_compiled_judge:
        yield Text(
            f"Judged by the compiled judge, since {entry.world} has over {LARGE} edges; with"
            " --strict the checkers judge every claim, which takes longer."
        )


def _wrong(entry: ExploreEntry, run: str) -> Iterator[Block]:
    yield from runs.finding_blocks(entry.findings, run)
    if entry.stopped is not None and not entry.findings:
        yield Text(f"{run} is not decided: {entry.stopped}")


def _gap_table(entries: Sequence[ExploreEntry]) -> Iterator[Block]:
    gaps = [(entry, entry.gap) for entry in entries if entry.gap is not None]
    if gaps:
        yield Text("")
        yield Rows(gaps).table(
            ("algorithm", lambda row: row[0].algorithm),
            ("world", lambda row: row[0].world),
            (">false", lambda row: row[1].false),
            (">walked", lambda row: row[1].walked),
            (">refutable", lambda row: row[1].refutable),
            (">gap", lambda row: f"{row[1].share:.1%}"),
            title="false hypotheses: walked although the history refuted them",
        )


_COLUMNS = (">cost", ">of least", ">rejected free", ">moving", "claims")


def _row(entry: ExploreEntry) -> tuple[str, ...]:
    rejected = [str(entry.rejected_free), str(entry.rejected_moving)]
    if rejected == ["0", "0"] and "not-declared" in entry.claims.values():
        rejected = ["-", "-"]
    return (
        str(entry.cost),
        f"{entry.cost / entry.least_cost:.2f}" if entry.least_cost else "-",
        *rejected,
        runs.claims_cell(entry.claims, incomplete=not entry.ok and not entry.findings),
    )


def _by_world(entries: Sequence[ExploreEntry]) -> Iterator[list[ExploreEntry]]:
    """The runs by world; a group begins with the first algorithm, since names may repeat."""
    group: list[ExploreEntry] = []
    for entry in entries:
        if group and entry.algorithm == group[0].algorithm:
            yield group
            group = []
        group.append(entry)
    if group:
        yield group


def _world_table(group: Sequence[ExploreEntry]) -> TextTable:
    first = group[0]
    title = f"{_size(first)}, genus {first.genus}, least cost {first.least_cost}"
    basic = next((e.cost for e in group if e.algorithm == "basic" and len(group) > 1), 0)
    columns: tuple[str, ...] = ("algorithm", *_COLUMNS)
    rows: list[tuple[str, ...]] = [(entry.algorithm, *_row(entry)) for entry in group]
    if basic:
        columns = (*columns[:2], ">of basic", *columns[2:])
        ratios = [f"{entry.cost / basic:.2f}" for entry in group]
        rows = [(*row[:2], of, *row[2:]) for row, of in zip(rows, ratios, strict=True)]
    return TextTable(columns, rows, title)


def _size(entry: ExploreEntry) -> str:
    vertices = plural(entry.vertices, "vertex", "vertices")
    return f"{entry.world}: {vertices}, {plural(entry.edges, 'edge')}"


# ---------------------------------------------------------------- entry and account


def _result(
    run: Exploration,
    at: runs.NamedWorld,
    report: Report,
    asked: _ExploreOptions,
    *,
    incomplete: bool,
) -> Result[ExploreEntry]:
    # The gap is a share of all false hypotheses, so all must be declared.
    measured = None
    if asked.gap and report.ok and not {"not-declared", "partial"} & {*report.claims.values()}:
        measured = measure(run.trace)
    entry = entry_of(
        ExploreEntry,
        run,
        report,
        world=at.name,
        policies=run.policies or ChosenPolicies(None, None),
        vertices=len(at.world.vertices),
        edges=len(at.world.edges),
        genus=at.world.genus,
        least_cost=at.world.least_cost(),
        isomorphic=report.claims["map-isomorphic"] == "ok",
        entailed=report.claims["map-entailed"] == "ok",
        ok=not report.findings and not incomplete,
        gap=measured,
        marker=at.world.root,
        place=0 if at.world.root is None else at.world.vertex_of[at.world.root],
        by_compiled_judge=is_for_engine(run, strict=asked.strict),
    )
    return Result(entry, failed=bool(report.findings), incomplete=incomplete)


def _account(entries: Sequence[ExploreEntry]) -> acc.Account:
    verdicts = [_verdict(entry) for entry in entries]
    failing, decided = verdicts.count("REFUTED"), verdicts.count("SAMPLED")
    words = acc.counted(decided, len(entries), "runs")
    if failing:
        words = acc.counted(failing, len(entries), "runs fail")
    mappers = list(dict.fromkeys(entry.algorithm for entry in entries))
    return acc.Account(
        mappers[0] if len(mappers) == 1 else plural(len(mappers), "mapper"),
        acc.JudgedExtent(acc.joint_verdict(verdicts), words),
        acc.suites(
            (_run_name(entry), _run_cases(entry)) for entry in entries if entry.same_as is None
        ),
    )


def _verdict(entry: ExploreEntry) -> Verdict:
    return "REFUTED" if entry.findings else "SAMPLED" if entry.ok else "UNKNOWN"


def _run_name(entry: ExploreEntry) -> str:
    at = "" if entry.marker is None else f", marker at dart {entry.marker}"
    return f"{entry.algorithm} in {entry.world}{at}"


def _run_cases(entry: ExploreEntry) -> Iterator[acc.JudgedCase]:
    first, verdict = entry.findings[0] if entry.findings else None, _verdict(entry)
    yield acc.verdict_case(
        "the run as a whole",
        verdict,
        message=(entry.stopped or "") if first is None else f"{first.claim}: {first.message}",
        again="" if first is None else first.replay,
    )
    yield from acc.claim_cases(entry.judgements)


# ---------------------------------------------------------------- --marker all


def _show_markers(entries: Sequence[ExploreEntry]) -> Iterator[Block]:
    groups: dict[tuple[str, str], list[ExploreEntry]] = {}
    for entry in entries:
        groups.setdefault((entry.world, entry.algorithm), []).append(entry)
    for number, world in enumerate(dict.fromkeys(entry.world for entry in entries)):
        of_world = [group for (name, _), group in groups.items() if name == world]
        if number:
            yield Text("")
        yield TextTable(
            _MARKER_COLUMNS, [_marker_row(group) for group in of_world], _marker_title(of_world[0])
        )
    yield Text("")
    yield Text(
        "At: the vertex where the marker lies, and the dart that it points at, as the world's file"
        " numbers them (of equal places the first). Saved: what the best place saves of the mean"
        " over all darts."
    )
    for entry in chain.from_iterable(groups.values()):
        if entry.same_as is None:
            yield from _wrong(entry, _run_name(entry))


_MARKER_COLUMNS = ("algorithm", ">mean", ">best", ">at", ">worst", ">at", ">saved", "claims")


def _marker_title(group: Sequence[ExploreEntry]) -> str:
    kinds = sum(entry.same_as is None for entry in group)
    return (
        f"{_size(group[0])}, genus {group[0].genus}, the marker at each of"
        f" {plural(len(group), 'dart')}, {kinds} of them different"
    )


def _marker_row(group: Sequence[ExploreEntry]) -> tuple[str, ...]:
    decided = [entry for entry in group if entry.ok]
    bad = next((entry for entry in group if not entry.ok), None)
    claims = runs.claims_cell(
        (bad or group[0]).claims, incomplete=bad is not None and not bad.findings
    )
    if not decided:
        return (group[0].algorithm, *"-" * 6, claims)
    average = mean(entry.cost for entry in decided)
    best, worst = (pick(decided, key=lambda entry: entry.cost) for pick in (min, max))
    saved = f"{1 - best.cost / average:.0%}" if average else "-"
    return (
        group[0].algorithm,
        f"{average:.0f}",
        *(str(best.cost), _where(best), str(worst.cost), _where(worst)),
        saved,
        claims,
    )


def _where(entry: ExploreEntry) -> str:
    return f"{entry.place}:{entry.marker}"
