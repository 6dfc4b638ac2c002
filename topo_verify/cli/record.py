"""`topo-verify record`: write a mapper's costs and decisions to a baseline, for `compare`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import click
import msgspec

from topo_verify import extras
from topo_verify.campaign.campaign import MAX_TIMEOUTS
from topo_verify.campaign.engine import on_engine
from topo_verify.campaign.row import Row
from topo_verify.cli import options
from topo_verify.cli.output import Output, Result
from topo_verify.cli.runs import finding_blocks
from topo_verify.errors import WriteError, plural
from topo_verify.report.blocks import Block, Text, TextTable
from topo_verify.robot.limits import Limits
from topo_verify.studies.baseline import record as study
from topo_verify.studies.baseline.file import encode
from topo_verify.studies.corpus import DEFAULT, CorpusWorlds, corpus_from
from topo_verify.world.formats import files

SHOWN = 3


@options.command(
    "record my_mapper.py:explore --out baseline.jsonl.gz",
    "record basic --worlds 'edges<=5' --worlds nyc --out basic.jsonl.gz",
)
@click.option("--out", required=True, metavar="FILE", help="Write the baseline to FILE.")
@click.option(
    "--worlds",
    multiple=True,
    metavar="WORLDS",
    help="As in conform: edges<=4, drawn:9:king(4,4), a folder …; repeatable.  [default: corpus]",
)
@options.seed("Seed of the generated worlds.")
@options.mappers(with_policies=True)
@options.workers(0)
@options.store
@extras.options("record", "engine")
@options.limits
def record(
    output: Output,
    *,
    mappers: options.Mappers,
    engine: str,
    out: str,
    worlds: tuple[str, ...],
    seed: int,
    workers: int,
    store: str | None,
    limits: Limits,
) -> int:
    """Run a mapper in every world of a corpus and write its costs, decisions and maps to a file."""

    def recorded() -> Iterator[Result[study.RecordEntry]]:
        output.require_places(out=out)
        texts = worlds or DEFAULT
        corpus = corpus_from(texts, seed=seed)
        failing: list[Row] = []

        def noted(rows: Iterable[Row]) -> Iterator[Row]:
            for row in rows:
                if row.failed and len(failing) < SHOWN:
                    failing.append(row)
                yield row

        with options.opened(store) as file, mappers.opened() as target:
            on_engine(engine, (target,), limits)  # fails early
            named, total = CorpusWorlds(corpus), corpus.total
            runs = study.baseline_runs(
                target, named, total, limits=limits, engine=engine, store=file
            )
            rows = noted(options.stored_rows(output, [runs], workers, file))
            baseline = study.record(target, corpus, rows, worlds=texts, seed=seed, limits=limits)
        # A partial baseline would make later comparisons look complete.
        whole = len(baseline.entries) == total
        entry = study.recorded(baseline, target, failing, out if whole else None)
        failed, incomplete = entry.wrong > 0, entry.undecided > 0
        try:
            if whole:
                files.write(out, encode(baseline))
        except WriteError:  # claims that fail are shown all the same
            yield Result(msgspec.structs.replace(entry, file=None), failed, incomplete)
            raise
        yield Result(entry, failed, incomplete)

    return output.run("record", recorded, _show, seed=seed, in_process=mappers.in_process)


def _show(entries: Sequence[study.RecordEntry]) -> Iterator[Block]:
    for entry in entries:
        rows = [
            ("mapper", entry.target),
            ("worlds", f"{entry.worlds:,}: {entry.corpus}"),
            ("no claim fails", f"{entry.equal:,}"),
            ("a claim fails", f"{entry.wrong:,}"),
            ("not decided", f"{entry.undecided:,}"),
            ("cost where right", f"{plural(entry.cost, 'edge traversal')}"),
            ("corpus hash", entry.digest[:16]),
        ]
        yield TextTable(("property", "value"), rows, headed=False)
        yield from finding_blocks(entry.findings)
        yield Text("")
        if entry.file is not None:
            yield Text(f"written: {entry.file}")
        else:
            times = f"{MAX_TIMEOUTS} time-outs"
            yield Text(f"No baseline was written: {times}, or no room for the file.")
