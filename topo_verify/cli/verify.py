"""`topo-verify verify`: the main job, one report."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import click

from topo_verify.checkers import CLAIMS, Finding
from topo_verify.cli import options, version
from topo_verify.cli.output import Live, Output, Result
from topo_verify.cli.runs import finding_blocks, unjudged
from topo_verify.errors import plural
from topo_verify.programs.loader import Target
from topo_verify.report import account as acc
from topo_verify.report.blocks import Block, Text, TextTable
from topo_verify.robot.limits import Limits
from topo_verify.studies.verify import verify as campaign
from topo_verify.studies.verify.parts import Part


@options.command(
    "verify", "verify my_mapper.py:explore", "verify --quick --format json", reports=True
)
@options.mappers("all")
@click.option("--quick", is_flag=True, help="Check smaller worlds, in a few seconds.")
@options.seed("Seed of the sampled and generated worlds.", campaign.SEED)
@options.limits
def verify(
    output: Output,
    *,
    mappers: options.Mappers,
    quick: bool,
    seed: int,
    limits: Limits,
) -> int:
    """Check the catalogue's algorithms, or a mapper of your own, part by part.

    TARGET is `all` (the default), names of the catalogue with commas, package.module:attribute
    or path/file.py:attribute. A mapper takes a robot and returns a map. The parts counts and
    proofs do not depend on your mapper and are left out.
    """
    loaded = mappers.load()

    def parts() -> Iterator[Result[Part]]:
        tell = output.progress
        for part in campaign.verify(loaded, quick=quick, seed=seed, limits=limits, tell=tell):
            incomplete = part.verdict == "UNKNOWN"
            yield Result(part, failed=part.verdict == "REFUTED", incomplete=incomplete)
            if part.findings:
                for first in _first_of_each(part):
                    output.found.run_again(loaded, first.world, first.claim, limits, first.message)

    others = campaign.left_out(loaded)
    head = tuple(map(Text, _head(loaded, seed, others)))
    return output.run(
        "verify",
        parts,
        lambda entries: _show(head, entries),
        live=Live(head, _live, _end),
        account=lambda entries: acc.Account(
            _who(loaded),
            _extent(entries),
            acc.suites((part.part, cases_of(part)) for part in entries),
        ),
        target=mappers.texts[0],
        quick=quick,
        seed=seed,
        in_process=mappers.in_process,
        left_out=others,
    )


# ---------------------------------------------------------------- the account


WORLDLESS = ("counts", "proofs")
"""The parts that run no mapper: they count worlds, and theorems."""


def cases_of(part: Part) -> Iterator[acc.JudgedCase]:
    """A case for the part, and one for each claim."""
    yield acc.verdict_case(
        "the part as a whole",
        part.verdict,
        judged=f"{part.checked:,} of {part.total:,}",
        message=part.summary,
        again=part.findings[0].replay if part.findings else "",
    )
    for case in acc.claim_cases(part.judgements):
        failing = part.claims.get(case.name, {}).get("failed", 0)
        words = f"fails in {plural(failing, 'run')}" if failing else ""
        yield replace(case, message="; ".join(filter(None, (words, case.message))))


def _extent(parts: Sequence[Part]) -> acc.JudgedExtent:
    """The worlds of the finite class and the sampled ones; theorems have their own table."""
    verdict = acc.joint_verdict([part.verdict for part in parts])
    tried = [part for part in parts if part.part not in WORLDLESS]
    failing = sum(part.failing for part in tried)
    if verdict == "REFUTED" and not failing:
        wrong = ", ".join(part.part for part in parts if part.verdict == "REFUTED")
        return acc.JudgedExtent(verdict, f"{wrong}: see the report")
    finite = [part for part in tried if part.verdict == "EXHAUSTED"]
    if verdict in ("REFUTED", "UNKNOWN") or not finite:
        verdict = "SAMPLED" if verdict not in ("REFUTED", "UNKNOWN") else verdict
        checked, total = sum(p.checked for p in tried), sum(p.total for p in tried)
        return acc.extent(verdict, checked, total, failing)
    number, total = sum(p.checked for p in finite), sum(p.total for p in finite)
    sampled = sum(part.checked for part in tried if part.verdict == "SAMPLED")
    words = acc.counted(number, total, acc.worlds(number))
    return acc.JudgedExtent("EXHAUSTED", f"{words}, {sampled:,} sampled" if sampled else words)


# ---------------------------------------------------------------- for people


def _who(mappers: Sequence[Target]) -> str:
    return mappers[0].text if len(mappers) == 1 else plural(len(mappers), "mapper")


def _first_of_each(part: Part) -> Iterator[Finding]:
    first: dict[tuple[str, str], Finding] = {}
    for finding in part.findings:
        first.setdefault((finding.world, finding.replay), finding)
    yield from first.values()


def _head(mappers: Sequence[Target], seed: int, others: Sequence[str]) -> Iterator[str]:
    yield f"topo-verify {version()}: {_who(mappers)}, {len(CLAIMS)} claims, seed {seed}"
    if others:
        yield (
            f"Left out: {' and '.join(others)}, which do not depend on the mapper; without a"
            " TARGET they are done."
        )


def _show(head: Iterable[Block], entries: Sequence[Part]) -> Iterator[Block]:
    yield from head
    columns = ("part", "verdict", ">checked", ">total", "summary")
    rows = [(e.part, e.verdict, str(e.checked), str(e.total), e.summary) for e in entries]
    yield TextTable(columns, rows)
    for entry in entries:
        yield from _first(entry)
    yield from _end(entries)


def _live(entry: Part) -> Iterator[Block]:
    row = (entry.part, entry.verdict, entry.summary)
    yield TextTable(("part", "verdict", "summary"), [row], widths=(16, 9, 0), headed=False)
    yield from _first(entry)


def _first(entry: Part) -> Iterator[Block]:
    # Findings are sorted by world; one replay command means one run.
    smallest = [f for f in entry.findings if f.replay == entry.findings[0].replay]
    if smallest:
        yield from finding_blocks(
            smallest, f"smallest counterexample here: {smallest[0].world}", shown=2
        )


def _end(entries: Sequence[Part]) -> Iterator[Block]:
    for entry in entries:
        if entry.costs:
            yield Text("")
            yield _costs(entry)
    yield Text("")
    yield Text(_conclusion(entries))
    if not any(entry.verdict == "REFUTED" for entry in entries):
        yield from dict.fromkeys(
            sentence
            for entry in entries
            for sentence in unjudged("the mapper", f"part {entry.part}", entry.judgements)
        )


def _conclusion(entries: Sequence[Part]) -> str:
    if any(entry.verdict == "REFUTED" for entry in entries):
        return "A claim fails: the commands after 'again' show the walks."
    proved = any(entry.part == "proofs" for entry in entries)
    things = "worlds and theorems" if proved else "worlds"
    words = f"No claim failed in the {things} counted above; nothing else was checked."
    if not all(entry.ok for entry in entries):
        words = "No claim failed, but not everything was checked."
    return words


def _costs(entry: Part) -> TextTable:
    rows: list[tuple[str, ...]] = []
    for cost in entry.costs:
        rejected = cost.rejected_free + cost.rejected_moving
        rows.append(
            (
                f"({cost.algorithm})" if cost.reference else cost.algorithm,
                str(cost.cost),
                "fails" if cost.ratio is None else f"{cost.ratio:.2f}",
                "-" if cost.ratio is None else f"{cost.of_least:.2f}",
                f"{100 * cost.rejected_free / rejected:.0f} %" if rejected else "-",
            )
        )
    columns = ("mapper", ">cost", ">of basic", ">of least", ">rejected without motion")
    title = f"{entry.part}: costs in edge traversals"
    if any(cost.reference for cost in entry.costs):
        title += ", (others) for comparison"
    return TextTable(columns, rows, title=title)
