"""`topo-verify prove`: prove or refute the theorems behind the claims."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

import click

from topo_verify.cli import options
from topo_verify.cli import theorems as shown
from topo_verify.cli.accounts import prove_account
from topo_verify.cli.output import Live, Output, Result
from topo_verify.cli.output import options as output_options
from topo_verify.cli.reporting import report_options
from topo_verify.cli.walks import FoundRuns
from topo_verify.errors import InputError, InternalError
from topo_verify.report.account import Account, Exhibit
from topo_verify.report.blocks import Block, Text
from topo_verify.robot.limits import MOST_SECONDS
from topo_verify.world.rooted_map import World

if TYPE_CHECKING:
    from topo_verify.proofs.theorem import Budget, Theorem


@click.command(
    short_help="Prove the theorems behind the claims: Z3 and Coq.",
    epilog=options.epilog(
        "prove",
        "prove --list",
        "prove percept word-confirm-step --list",
        "prove --kind inductive --solver cvc5",
        "prove --kind bounded --certify",
    ),
)
@click.argument("names", nargs=-1, metavar="[NAME...]")
@click.option("--list", "listing", is_flag=True, help="List the theorems and prove nothing.")
@click.option(
    "--kind",
    "kinds",
    multiple=True,
    type=click.Choice(shown.KINDS),
    help="Only theorems of this kind.",
)
@click.option(
    "--edges",
    type=click.IntRange(min=1),
    metavar="N",
    help="Bounded theorems only up to worlds of N edges.",
)
@click.option(
    "--solver",
    type=click.Choice(["z3", "cvc5"]),
    default="z3",
    show_default=True,
    help="cvc5: ask cvc5 every question as well.",
)
@click.option(
    "--timeout",
    type=click.IntRange(1, MOST_SECONDS),
    default=60,
    show_default=True,
    metavar="SECONDS",
    help="Time limit of each question to a solver.",
)
@click.option("--deep", is_flag=True, help="Include the theorems that take minutes.")
@click.option("--certify", is_flag=True, help="Make and check certificates of bounded theorems.")
@click.option("--smt2", "folder", metavar="DIR", help="Write each question to DIR as SMT-LIB 2.")
@options.seed("Seed of the solver.")
@output_options
@report_options
def prove(  # noqa: PLR0913  an argument an option
    output: Output,
    *,
    names: tuple[str, ...],
    listing: bool,
    kinds: tuple[str, ...],
    edges: int | None,
    solver: str,
    timeout: int,
    deep: bool,
    certify: bool,
    folder: str | None,
    seed: int,
) -> int:
    """Prove the theorems that the claims rest on, and refute what must not be provable.

    NAME is a theorem; by default all quick ones are proved. Inductive theorems speak of worlds of
    any size, bounded ones of every world of a few edges; negatives and mutants must be REFUTED. A
    theorem that is vacuous or stays UNKNOWN does not pass (exit 3).
    """
    from topo_verify.proofs.catalogue import choose
    from topo_verify.proofs.theorem import Budget

    theorems = choose(names, kinds=kinds, edges=edges, deep=deep)
    if listing:
        return output.run(
            "prove-list", lambda: map(Result, map(shown.listed, theorems)), shown.show_list
        )
    # Now and not at the first question that needs them, which may be minutes away.
    _require(second=solver == "cvc5", certify=certify)
    budget = Budget(timeout=timeout, seed=seed, certify=certify, progress=output.progress)

    seconds: dict[str, float] = {}

    def proved() -> Iterator[Result[shown.ProveEntry]]:
        for number, theorem in enumerate(theorems):
            output.progress(theorem.name, number, len(theorems))
            if folder is not None:
                _export(theorem, Path(folder))
            begin = perf_counter()
            result = _result(theorem, budget, second=solver == "cvc5")
            # Kept apart from the entry: outside `timing`, results must be equal in every run.
            seconds[theorem.name] = perf_counter() - begin
            yield result

    def one(entry: shown.ProveEntry) -> Iterator[Block]:
        return shown.live(entry, seconds[entry.name])

    live = Live((Text(shown.head(theorems, budget)),), one, shown.end)
    found = FoundRuns(output)

    def account(entries: Sequence[shown.ProveEntry]) -> Account:
        # What is not as expected comes first.
        for entry in sorted(entries, key=lambda one: (one.ok, one.kind != "negative")):
            found.show(_exhibit(entry))
        return prove_account(entries, _again(solver, timeout, seed), shown.show(entries), found)

    return output.run("prove", proved, shown.show, live=live, account=account, seed=seed, deep=deep)


def _again(solver: str, timeout: int, seed: int) -> str:
    """The options of a command that proves one theorem again, as this one did."""
    given = {"--solver": (solver, "z3"), "--timeout": (timeout, 60), "--seed": (seed, 0)}
    return "".join(f" {name} {value}" for name, (value, usual) in given.items() if value != usual)


def _exhibit(entry: shown.ProveEntry) -> Exhibit | None:
    """The world that refutes a statement, and the walk in it that shows it; None if none does."""
    if entry.verdict != "REFUTED" or entry.counterexample is None or entry.history is None:
        return None
    try:
        world = World.from_id(entry.counterexample)
    except InputError:
        return None  # a structure that is no world
    return Exhibit(
        title=f"{entry.name} in {entry.counterexample}",
        world=world,
        name=entry.counterexample,
        notes=(entry.words, f"shown by the doors {' '.join(map(str, entry.history))}"),
        again=f"topo-verify prove {entry.name}",
    )


def _require(*, second: bool, certify: bool) -> None:
    """Refuse to begin if a solver or a checker is missing."""
    from topo_verify.proofs.bounded import drup
    from topo_verify.proofs.solvers import cvc5_solver

    if second:
        cvc5_solver.require_tools()
    if certify:
        drup.require_tools()


def _export(theorem: Theorem, folder: Path) -> None:
    from topo_verify.proofs.solvers.cvc5_solver import export

    if folder.exists() and not folder.is_dir():
        raise InputError(f"--smt2 {folder}: expected a folder, got a file")
    for query in theorem.queries():
        export(query, folder)


def _result(theorem: Theorem, budget: Budget, *, second: bool) -> Result[shown.ProveEntry]:
    outcome = theorem.prove(budget)
    opinion = _opinion(theorem, budget) if second else None
    status = theorem.status(outcome)
    return Result(
        shown.entry_of(theorem, outcome, opinion),
        failed=status == "failed",
        incomplete=status == "open",
    )


def _opinion(theorem: Theorem, budget: Budget) -> shown.SecondOpinion | None:
    """How often cvc5 agrees with Z3 on a theorem's questions; None if it has none.

    Raises:
        InternalError: the two solvers contradict each other.
    """
    from topo_verify.proofs.solvers.cvc5_solver import ask

    opinions = [ask(query, timeout=budget.timeout) for query in theorem.queries()]
    for opinion in opinions:
        if opinion.agreement == "disagrees":
            raise InternalError(f"the solvers disagree: {opinion}")
    if not opinions:
        return None
    count = Counter(opinion.agreement for opinion in opinions)
    return shown.SecondOpinion(opinions[0].solver, count["agrees"], count["unknown"], len(opinions))
