"""`topo-verify record`: write a mapper's costs and decisions to a baseline, for `compare`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import click
import msgspec

from topo_verify.campaign.campaign import CorpusWorlds
from topo_verify.campaign.corpus import DEFAULT, Corpus, corpus_from
from topo_verify.campaign.row import Row
from topo_verify.campaign.run import Engine, on_engine
from topo_verify.checkers import Finding
from topo_verify.cli import options
from topo_verify.cli.kept_runs import opened, stored_rows
from topo_verify.cli.options import Mappers
from topo_verify.cli.output import Output, Result
from topo_verify.cli.runs import finding_blocks
from topo_verify.errors import plural
from topo_verify.report.blocks import Block, Text, TextTable
from topo_verify.robot.limits import Limits
from topo_verify.studies.baseline.file import Baseline, encode
from topo_verify.studies.baseline.record import MAX_TIMEOUTS, baseline_runs, replay_command
from topo_verify.studies.baseline.record import record as run_all
from topo_verify.world.formats import files

SHOWN = 3
"""The number of failing worlds whose findings are shown."""


class RecordEntry(msgspec.Struct, frozen=True):
    """One recording: an entry of `results`.

    Attributes:
        worlds: the number of worlds in the corpus.
        equal, wrong, undecided: in how many no claim fails, a claim fails, and neither is known.
        dearer, cheaper, other_decisions: always 0; `compare` has the same fields.
        cost: total edge traversals in the worlds in which no claim fails.
        corpus, digest: the corpus in words, and its hash.
        file: the baseline; None if the mapper was stopped early, since then none is written.
        findings: of the first failing worlds.
    """

    target: str
    worlds: int
    equal: int
    wrong: int
    dearer: int
    cheaper: int
    other_decisions: int
    undecided: int
    cost: int
    corpus: str
    digest: str
    file: str | None
    findings: tuple[Finding, ...]


@options.command(
    "record my_mapper.py:explore --out baseline.jsonl.gz",
    "record basic --worlds 'edges<=5' --worlds nyc --out basic.jsonl.gz",
)
@click.option("--out", required=True, metavar="FILE", help="Write the baseline to FILE.")
@click.option(
    "--worlds",
    multiple=True,
    metavar="WORLDS",
    help="corpus, edges<=N, generated:N, a folder or a WORLD; repeatable.  [default: corpus]",
)
@options.seed("Seed of the generated worlds.")
@options.mappers(with_policies=True)
@options.workers(0)
@options.store
@options.engine
@options.limits
def record(  # noqa: PLR0913  an argument an option
    output: Output,
    *,
    mappers: Mappers,
    engine: Engine,
    out: str,
    worlds: tuple[str, ...],
    seed: int,
    workers: int,
    store: str | None,
    limits: Limits,
) -> int:
    """Run a mapper in every world of a corpus and write its costs, decisions and maps to a file.

    TARGET is one name of the catalogue, module:attribute or file.py:attribute.
    """

    def recorded() -> Iterator[Result[RecordEntry]]:
        texts = worlds or DEFAULT
        corpus = corpus_from(texts, seed=seed)
        failing: list[Row] = []

        def noted(rows: Iterable[Row]) -> Iterator[Row]:
            for row in rows:
                if row.failed and len(failing) < SHOWN:
                    failing.append(row)
                yield row

        with opened(store) as file, mappers.opened() as target:
            on_engine(engine, (target,), limits)  # whether it can be run is said before all else
            named = CorpusWorlds(corpus)
            runs = baseline_runs(
                target, named, corpus.total, limits=limits, engine=engine, store=file
            )
            rows = noted(stored_rows(output, [runs], workers, file))
            made = run_all(target, corpus, rows, worlds=texts, seed=seed, limits=limits)
        # A baseline of some of the worlds would make every later comparison look complete.
        whole = len(made.entries) == corpus.total
        if whole:
            files.write(out, encode(made))
        findings = tuple(
            msgspec.structs.replace(finding, replay=replay_command(target, row.world, limits))
            for row in failing
            for finding in row.findings
        )
        kept = _entry(made, corpus, out if whole else None, findings)
        yield Result(kept, failed=kept.wrong > 0, incomplete=kept.undecided > 0)

    return output.run("record", recorded, _show, seed=seed, in_process=mappers.in_process)


def _entry(
    made: Baseline, corpus: Corpus, file: str | None, findings: tuple[Finding, ...]
) -> RecordEntry:
    right = [entry for entry in made.entries if entry.right]
    wrong = sum(bool(entry.failed) for entry in made.entries)
    return RecordEntry(
        target=made.header.target,
        worlds=corpus.total,
        equal=len(right),
        wrong=wrong,
        dearer=0,
        cheaper=0,
        other_decisions=0,
        undecided=corpus.total - len(right) - wrong,
        cost=sum(entry.cost for entry in right),
        corpus=corpus.description,
        digest=corpus.digest,
        file=file,
        findings=findings,
    )


def _show(entries: Sequence[RecordEntry]) -> Iterator[Block]:
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
            yield Text(
                f"No baseline was written: the mapper was stopped after {MAX_TIMEOUTS} time-outs."
            )
