"""`topo-verify record`: keep what a mapper pays and decides in a baseline, for `compare`."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from functools import wraps
from typing import Any

import click
import msgspec

from topo_verify.algorithms import Algorithm
from topo_verify.checkers import Finding
from topo_verify.cli import options
from topo_verify.cli.layout import Block, Text, TextTable
from topo_verify.cli.output import Output, Result
from topo_verify.cli.output import options as output_options
from topo_verify.cli.runs import finding_blocks
from topo_verify.harness.baseline import file
from topo_verify.harness.baseline.record import Recorded
from topo_verify.harness.baseline.record import record as run_all
from topo_verify.harness.corpus import DEFAULT, Corpus, corpus_from
from topo_verify.harness.target_texts import target_text, targets
from topo_verify.harness.targets import one_target
from topo_verify.programs.loading import Target
from topo_verify.programs.program import Program
from topo_verify.robot.events import Policies
from topo_verify.robot.limits import Limits
from topo_verify.text import plural
from topo_verify.world.formats import files

MapperOpener = Callable[..., AbstractContextManager[Target]]
"""Opens the mapper of a command; a program runs as long as the block."""

SHOWN = 3
"""Of so many failing worlds the findings are shown."""


class RecordEntry(msgspec.Struct, frozen=True):
    """One recording: an entry of `results`; docs/commands.md.

    Attributes:
        worlds: how many the corpus has.
        equal, wrong, undecided: in how many the mapper is right, is not, and nobody knows.
        dearer, cheaper, other_decisions: 0; a mapper is no other than itself.
        cost: edge traversals in the worlds where it is right, summed up.
        corpus, digest: the corpus in words, and its own hash.
        file: the baseline; None where not every world was tried, for then none is written.
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


def mapper_options(run: Callable[..., int]) -> Callable[..., int]:
    """TARGET or --cmd, --pick and --order: handed over as `mapper`, which opens it.

    It may be told the policies that an algorithm of the catalogue has where none are asked for.
    """

    @click.argument("target", required=False, metavar="[TARGET]")
    @options.program
    @options.policies
    @wraps(run)
    def wrapper(
        *args: Any,
        target: str | None,
        command: str | None,
        pick: str | None,
        order: str | None,
        **kwargs: Any,
    ) -> int:
        def mapper(usual: Policies | None = None) -> AbstractContextManager[Target]:
            return _opened(target, command, (pick, order), usual)

        return run(*args, mapper=mapper, **kwargs)

    return wrapper


@contextmanager
def _opened(
    name: str | None,
    cmd: str | None,
    asked: tuple[str | None, str | None],
    usual: Policies | None,
) -> Generator[Target]:
    """The one mapper that is meant; a program runs as long as the block."""
    text = target_text(name, cmd)
    pick, order = asked
    if cmd is None:
        target = one_target(text, pick=pick, order=order)
    else:
        (target,) = targets(text, pick=pick, order=order)
    if usual is not None and isinstance(target.mapper, Algorithm):
        target = one_target(target, pick=pick or usual.pick, order=order or usual.order)
    try:
        yield target
    finally:
        if isinstance(target.mapper, Program):
            target.mapper.close()


@click.command(
    short_help="Keep what a mapper pays and decides, for compare.",
    epilog=options.epilog(
        "record my_mapper.py:explore --out baseline.jsonl.gz",
        "record basic --worlds 'edges<=5' --worlds nyc --out basic.jsonl.gz",
    ),
)
@click.option("--out", required=True, metavar="FILE", help="The baseline that is written.")
@click.option(
    "--worlds",
    multiple=True,
    metavar="WORLDS",
    help="corpus, edges<=N, generated:N, a folder or a WORLD; repeatable.  [default: corpus]",
)
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    default=0,
    show_default=True,
    metavar="N",
    help="Draws the generated worlds.",
)
@mapper_options
@options.limits
@output_options
def record(
    output: Output,
    *,
    mapper: MapperOpener,
    out: str,
    worlds: tuple[str, ...],
    seed: int,
    limits: Limits,
) -> int:
    """Run a mapper in every world of a corpus and keep cost, decisions and map of each.

    TARGET is one name of the catalogue, module:attribute or file.py:attribute.
    """

    def recorded() -> Iterator[Result[RecordEntry]]:
        texts = worlds or DEFAULT
        corpus = corpus_from(texts, seed=seed)
        failing: list[Recorded] = []

        def note(seen: Recorded) -> None:
            if seen.entry.failed and len(failing) < SHOWN:
                failing.append(seen)

        with mapper() as target:
            made = run_all(
                target,
                corpus,
                worlds=texts,
                seed=seed,
                limits=limits,
                tell=output.progress,
                note=note,
            )
        whole = len(made.entries) == corpus.total
        if whole:
            files.write(out, file.encode(made))
        kept = _entry(made, corpus, out if whole else None, failing)
        yield Result(kept, failed=kept.wrong > 0, incomplete=kept.undecided > 0)

    return output.run("record", recorded, _show, seed=seed)


def _entry(
    made: file.Baseline, corpus: Corpus, file: str | None, failing: Sequence[Recorded]
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
        findings=tuple(finding for seen in failing for finding in seen.report.findings),
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
            yield Text("No baseline is written: after three time-outs the mapper was stopped.")
