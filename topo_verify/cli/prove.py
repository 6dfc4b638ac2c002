"""`topo-verify prove`: prove or refute the theorems behind the claims."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from time import perf_counter
from typing import Protocol, get_args

import click
import msgspec

from topo_verify import extras
from topo_verify.cli import options
from topo_verify.cli.output import Live, Output, Result, entry_of
from topo_verify.errors import InputError, plural
from topo_verify.proofs.theorem import (
    Budget,
    ClauseCertifier,
    RefutationCertificate,
    Theorem,
    TheoremKind,
)
from topo_verify.report import account as acc
from topo_verify.report.blocks import Block, Bullets, Cell, Text, TextTable, Tone
from topo_verify.robot.limits import MOST_SECONDS
from topo_verify.world.rooted_map import World

KINDS: tuple[TheoremKind, ...] = get_args(TheoremKind)


class ReplayCount(msgspec.Struct, frozen=True):
    """How many of the solver's models the simulator has confirmed.

    Attributes:
        replayed: those confirmed.
        total: all models.
    """

    replayed: int
    total: int


class SecondOpinion(msgspec.Struct, frozen=True):
    """How often a second solver agrees on the questions of a theorem.

    Attributes:
        solver: the second one.
        agrees, unknown, total: numbers of questions.
    """

    solver: str
    agrees: int
    unknown: int
    total: int


class SecondSolver(Protocol):
    """What --solver brings: another solver for the questions of a theorem."""

    NAME: str

    def require(self) -> None:
        """Check that it is installed; InputError if not."""
        ...

    def opinion(self, theorem: Theorem, *, timeout: float) -> SecondOpinion | None:
        """How often it agrees; None without questions; InternalError if it disagrees."""
        ...


class CertificateMaker(Protocol):
    """What --certify brings: checked certificates of bounded theorems."""

    certify: ClauseCertifier

    def require(self) -> None:
        """Check that it is installed; InputError if not."""
        ...


class ProveEntry(msgspec.Struct, frozen=True):
    """One theorem and its verdict.

    Attributes:
        claim: the claims that rest on it, with commas.
        ok: the verdict is as expected, the premises are satisfiable, every model was replayed.
        premises_satisfiable: whether all premises can hold; null if not asked.
        solver: what decided it, with its version.
        edges: the bound of a bounded theorem.
        checked, total: how many cases were decided, of how many; null: it has no cases.
        counterexample: a world, or the structure that refutes a mutant.
        history: the doors that show it.
        core: the premises that the proof used.
        note: why a verdict does not stand, if it does not.
    """

    name: str
    kind: TheoremKind
    claim: str
    verdict: str
    expected: str
    ok: bool
    premises_satisfiable: bool | None
    replayed: ReplayCount | None
    solver: str
    edges: int | None
    certificate: RefutationCertificate | None
    checked: int | None
    total: int | None
    counterexample: str | None
    history: tuple[int, ...] | None
    core: tuple[str, ...]
    opinion: SecondOpinion | None
    of: str | None
    words: str
    note: str


class ProveListEntry(msgspec.Struct, frozen=True):
    """One theorem with its statement.

    Attributes:
        claim: the claims that rest on it, with commas.
        expected: the verdict that is expected.
        edges: the bound of a bounded theorem.
        deep: whether it needs --deep, since it takes minutes.
        symbols: the statement as the solver gets it.
        solver_part: what the solver proves.
        argued: the steps that are argued in words, by their names in docs/proofs.md.
        assumed: what is not proved here.
    """

    name: str
    kind: str
    claim: str
    expected: str
    edges: int | None
    deep: bool
    of: str | None
    words: str
    symbols: str
    solver_part: str
    argued: tuple[str, ...]
    assumed: tuple[str, ...]


@options.command(
    "prove",
    "prove --list",
    "prove percept word-confirm-step --list",
    "prove --kind inductive --solver cvc5",
    "prove --kind bounded --certify",
    reports=True,
)
@click.argument("names", nargs=-1, metavar="[NAME...]")
@click.option("--list", "listing", is_flag=True, help="List the theorems and prove nothing.")
@click.option(
    "--kind", "kinds", multiple=True, type=click.Choice(KINDS), help="Only theorems of this kind."
)
@options.number("--edges", least=1, meaning="Bounded theorems only up to worlds of N edges.")
@extras.options("prove", "solver")
@options.number(
    "--timeout",
    least=1,
    most=MOST_SECONDS,
    default=60,
    metavar="SECONDS",
    meaning="Time limit of each question to a solver.",
)
@click.option("--deep", is_flag=True, help="Include the theorems that take minutes.")
@extras.options("prove", "certify")
@click.option("--smt2", "folder", metavar="DIR", help="Write each question to DIR as SMT-LIB 2.")
@options.seed("Seed of the solver.")
def prove(
    output: Output,
    *,
    names: tuple[str, ...],
    listing: bool,
    kinds: tuple[str, ...],
    edges: int | None,
    second: SecondSolver | None,
    timeout: int,
    deep: bool,
    certifier: CertificateMaker | None,
    folder: str | None,
    seed: int,
) -> int:
    """Prove the theorems that the claims rest on, and refute what must not be provable.

    NAME is a theorem, one in Coq also by its place there (Undirected.undirected_not_enough); by
    default all quick ones are proved. Inductive theorems hold in worlds of
    any size, bounded ones in every world of a few edges. A negative and a mutant are controls:
    false statements, which must be REFUTED.
    For a theorem in Coq, coqc compiles the files that it needs (3 to 53; 90 for all), and coqchk
    checks them and what they use of Coq's standard library: some minutes.
    A vacuous theorem is UNKNOWN, which does not pass (exit 3).
    """
    from topo_verify.proofs.catalogue import choose

    theorems = choose(names, kinds=kinds, edges=edges, deep=deep)
    if listing:
        return output.run("prove-list", lambda: map(_listed, theorems), _show_list)
    for brought in (second, certifier):
        if brought is not None:
            brought.require()  # now, not minutes later
    budget = Budget(
        timeout=timeout,
        seed=seed,
        certify=None if certifier is None else certifier.certify,
        progress=output.progress,
        together=tuple(theorem.name for theorem in theorems),
    )

    seconds: dict[str, float] = {}

    def proved() -> Iterator[Result[ProveEntry]]:
        for number, theorem in enumerate(theorems):
            output.progress(theorem.name, number, len(theorems))
            if folder is not None:
                _export(theorem, Path(folder))
            begin = perf_counter()
            result = _result(theorem, budget, second)
            # Not in the entry: results must be equal in every run.
            seconds[theorem.name] = perf_counter() - begin
            yield result

    head = [*map(Text, _head(theorems, budget))]
    live = Live(head, lambda entry: _live(entry, seconds[entry.name]), _end)

    return output.run(
        "prove",
        proved,
        _show,
        live=live,
        account=lambda entries: _account(output, entries, _again(second, timeout, seed)),
        seed=seed,
        deep=deep,
    )


def _account(output: Output, entries: Sequence[ProveEntry], options: str) -> acc.Account:
    for entry in sorted(entries, key=lambda theorem: (theorem.ok, theorem.kind != "negative")):
        output.found.show(_exhibit(entry))
    positive = [entry.verdict for entry in entries if entry.expected != "REFUTED"]
    things = "theorem" if len(entries) == 1 else "theorems"
    words = acc.counted(sum(entry.ok for entry in entries), len(entries), f"{things} as expected")
    suites: dict[str, list[acc.JudgedCase]] = {}
    for entry in sorted(entries, key=lambda theorem: KINDS.index(theorem.kind)):
        suites.setdefault(entry.kind, []).append(_case(entry, options))
    return acc.Account(
        plural(len(entries), "theorem"),
        acc.JudgedExtent(
            "PROVED" if acc.joint_verdict(positive) == "PROVED" else "EXHAUSTED", words
        ),
        acc.suites(suites.items()),
    )


def _case(entry: ProveEntry, options: str) -> acc.JudgedCase:
    # As for the exit code: only a definite, unexpected verdict fails.
    undecided = entry.verdict in ("UNKNOWN", entry.expected)
    return acc.JudgedCase(
        name=entry.name,
        verdict=entry.verdict,
        outcome="passed" if entry.ok else "undecided" if undecided else "failed",
        judged="" if entry.total is None else f"{entry.checked:,} of {entry.total:,}",
        message=f"{entry.words.removesuffix('.')}; {entry.note}" if entry.note else entry.words,
        again=f"topo-verify prove {entry.name}{options}",
    )


def _again(second: SecondSolver | None, timeout: int, seed: int) -> str:
    solver = "z3" if second is None else second.NAME
    given = {"--solver": (solver, "z3"), "--timeout": (timeout, 60), "--seed": (seed, 0)}
    return "".join(f" {name} {value}" for name, (value, usual) in given.items() if value != usual)


def _exhibit(entry: ProveEntry) -> acc.Exhibit | None:
    if entry.verdict != "REFUTED" or entry.counterexample is None or entry.history is None:
        return None
    try:
        world = World.from_id(entry.counterexample)
    except InputError:
        return None  # a structure, not a world
    return acc.Exhibit(
        title=f"{entry.name} in {entry.counterexample}",
        world=world,
        name=entry.counterexample,
        notes=(entry.words, f"shown by the doors {' '.join(map(str, entry.history))}"),
        again=f"topo-verify prove {entry.name}",
    )


def _export(theorem: Theorem, folder: Path) -> None:
    if folder.exists() and not folder.is_dir():
        raise InputError(f"--smt2 {folder}: expected a folder, got a file")
    for query in theorem.queries():
        path = folder / f"{query.name}.smt2"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            path.write_text(query.smt2, encoding="utf-8")
        except OSError as error:
            raise InputError(
                f"{path} cannot be written: {error}; name another --smt2 DIR"
            ) from error


def _listed(theorem: Theorem) -> Result[ProveListEntry]:
    return Result(entry_of(ProveListEntry, theorem, claim=",".join(theorem.claims)))


def _result(theorem: Theorem, budget: Budget, second: SecondSolver | None) -> Result[ProveEntry]:
    outcome = theorem.prove(budget)
    status = theorem.status(outcome)
    entry = entry_of(
        ProveEntry,
        theorem,
        theorem.reported(outcome),
        claim=",".join(theorem.claims),
        ok=status == "ok",
        replayed=None if outcome.replayed is None else ReplayCount(*outcome.replayed),
        opinion=None if second is None else second.opinion(theorem, timeout=budget.timeout),
    )
    return Result(entry, failed=status == "failed", incomplete=status == "open")


# ---------------------------------------------------------------- for people

FEW = 5
"""Up to this number, --list shows theorems in full."""


def _head(theorems: Sequence[Theorem], budget: Budget) -> Iterator[str]:
    from topo_verify.proofs.mechanised import theorems as in_coq
    from topo_verify.proofs.mechanised import toolchain
    from topo_verify.proofs.solvers import z3_solver

    kinds = Counter[str](theorem.kind for theorem in theorems)
    counts = ", ".join(f"{kinds[kind]} {kind}" for kind in KINDS if kinds[kind])
    coqc = "" if toolchain.missing() else toolchain.version()
    provers: list[str] = []
    if kinds.total() > kinds["mechanised"]:
        provers.append(f"{z3_solver.name()}, seed {budget.seed}")
    if kinds["mechanised"]:
        provers.append(coqc or "no coqc")
    yield f"{'; '.join(provers)}: {plural(len(theorems), 'theorem')} ({counts})"
    if kinds["mechanised"] and coqc:
        files = len(in_coq.needed(budget.together))
        yield f"First coqc compiles {files} files and coqchk checks them again: some minutes."


def _verdict(entry: ProveEntry) -> Cell:
    return Cell(entry.verdict, "held" if entry.ok else _TONE.get(entry.verdict, "failed"))


_TONE: dict[str, Tone] = {"UNKNOWN": "open"}


def _row(entry: ProveEntry) -> tuple[str | Cell, ...]:
    return (
        entry.name,
        entry.kind,
        _verdict(entry),
        "ok" if entry.ok else "not ok",
        _evidence(entry),
    )


def _evidence(entry: ProveEntry) -> str:
    words: list[str] = []
    if entry.total is not None:
        words.append(f"{entry.checked} of {plural(entry.total, 'world')}")
    if entry.kind in ("inductive", "bounded"):
        # The premises of other kinds hold in the refuting model, or by a proof in Coq.
        # They are asked about last, so an UNKNOWN may have no answer.
        known = entry.verdict != "UNKNOWN" or entry.premises_satisfiable is not None
        words += [_VACUITY[entry.premises_satisfiable]] if known else []
    if entry.core and entry.kind == "inductive":
        words.append(f"used {plural(len(entry.core), 'premise')}")
    if entry.history is not None:
        words.append(f"in {entry.counterexample}, doors {' '.join(map(str, entry.history))}")
    if entry.replayed is not None:
        words.append("replays" if entry.replayed.replayed == entry.replayed.total else "NO REPLAY")
    if entry.certificate is not None:
        proof = entry.certificate
        checked = "checked" if proof.checked else f"NOT CHECKED ({proof.why})"
        words.append(f"{proof.format} {checked} by {proof.checker}")
    if entry.opinion is not None:
        second = entry.opinion
        words.append(f"{second.solver} agrees on {second.agrees} of {second.total}")
        words += [f"unknown on {second.unknown}"] if second.unknown else []
    if entry.note and (not entry.ok or entry.history is None):
        words.append(entry.note)
    return "; ".join(words)


_VACUITY = {
    True: "premises satisfiable",
    False: "VACUOUS: its premises cannot hold",
    None: "premises not shown satisfiable",
}


def _show(entries: Sequence[ProveEntry]) -> Iterator[Block]:
    yield TextTable(
        ("theorem", "kind", "verdict", "", "what stands behind it"), [*map(_row, entries)]
    )
    yield from _end(entries)


def _live(entry: ProveEntry, seconds: float) -> Iterator[Block]:
    evidence = _evidence(entry) if entry.ok else f"NOT OK ({entry.kind}): {_evidence(entry)}"
    row = (entry.name, _verdict(entry), f"{seconds:.2f} s", evidence)
    columns = ("theorem", "verdict", ">time", "what stands behind it")
    yield TextTable(columns, [row], widths=(28, 9, 7, 0), headed=False)


def _end(entries: Sequence[ProveEntry]) -> Iterator[Block]:
    yield Text("")
    rows: list[tuple[str, ...]] = []
    for kind in KINDS:
        mine = [entry for entry in entries if entry.kind == kind]
        if not mine:
            continue
        replays = [entry.replayed for entry in mine if entry.replayed is not None]
        done = sum(replay.replayed for replay in replays)
        papers = sum(entry.certificate is not None and entry.certificate.checked for entry in mine)
        rows.append(
            (
                kind,
                f"{sum(entry.ok for entry in mine)} of {len(mine)}",
                f"{done} of {sum(replay.total for replay in replays)}" if replays else "-",
                f"{papers} of {len(mine)}" if kind == "bounded" else "-",
            )
        )
    columns = ("kind", ">as expected", ">models replayed", ">with a checked certificate")
    yield TextTable(columns, rows)
    wrong = [f"{entry.name}: {entry.verdict}; {entry.note}" for entry in entries if not entry.ok]
    if wrong:
        yield Text("Not as expected:")
        yield Bullets(tuple(wrong))
    yield Text("What is argued, assumed and not shown: docs/proofs.md.")


def _show_list(entries: Sequence[ProveListEntry]) -> Iterator[Block]:
    if len(entries) <= FEW:
        for entry in entries:
            yield from _details(entry)
        return
    rows = [
        (e.name, e.kind, e.expected, "" if e.edges is None else str(e.edges), e.words)
        for e in entries
    ]
    yield TextTable(("theorem", "kind", "expected", ">edges", "what it says"), rows)


def _details(entry: ProveListEntry) -> Iterator[Block]:
    yield Text(f"{entry.name} ({entry.kind}, expected {entry.expected}): {entry.words}")
    lines = (
        f"in symbols: {entry.symbols}",
        f"the solver: {entry.solver_part}",
        f"argued: {'; '.join(entry.argued) or 'nothing'}",
        f"assumed: {', '.join(entry.assumed) or 'nothing'}",
        f"claims: {entry.claim or 'none'}",
    )
    yield Bullets(lines)
