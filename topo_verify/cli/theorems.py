"""What `topo-verify prove` prints: entries for scripts, tables for people."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import msgspec

from topo_verify.report.blocks import Block, Bullets, Cell, Text, TextTable
from topo_verify.report.style import Tone
from topo_verify.text import plural

if TYPE_CHECKING:
    from topo_verify.proofs.theorem import Budget, Theorem, TheoremResult

KINDS = ("inductive", "mechanised", "bounded", "negative", "mutant")


class ReplayCount(msgspec.Struct, frozen=True):
    """How many of the models found the simulator has replayed."""

    replayed: int
    total: int


class ProofCheck(msgspec.Struct, frozen=True):
    """A certificate and what its checker said."""

    format: str
    checker: str
    checked: bool
    clauses: int
    steps: int
    why: str


class SecondOpinion(msgspec.Struct, frozen=True):
    """How often a second solver agrees on the questions of a theorem."""

    solver: str
    agrees: int
    unknown: int
    total: int


class ProveEntry(msgspec.Struct, frozen=True):
    """One theorem: an entry of `results`; docs/commands.md.

    Attributes:
        claim: the claims that rest on it, with commas.
        ok: the verdict is as expected, the premises are satisfiable, every model was replayed.
    """

    name: str
    kind: str
    claim: str
    verdict: str
    expected: str
    ok: bool
    premises_satisfiable: bool | None
    replayed: ReplayCount | None
    solver: str
    edges: int | None
    certificate: ProofCheck | None
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
    """One theorem as it is stated: an entry of `results` with --list."""

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


def entry_of(theorem: Theorem, outcome: TheoremResult, opinion: SecondOpinion | None) -> ProveEntry:
    """The entry of `results` for a theorem and its outcome."""
    made = outcome.certificate
    return ProveEntry(
        name=theorem.name,
        kind=theorem.kind,
        claim=",".join(theorem.claims),
        verdict=outcome.verdict,
        expected=theorem.expected,
        ok=theorem.ok(outcome),
        premises_satisfiable=outcome.premises_satisfiable,
        replayed=None if outcome.replayed is None else ReplayCount(*outcome.replayed),
        solver=outcome.solver,
        edges=theorem.edges,
        certificate=None
        if made is None
        else ProofCheck(
            made.format, made.checker, made.checked, made.clauses, made.steps, made.why
        ),
        checked=outcome.checked,
        total=outcome.total,
        counterexample=outcome.counterexample,
        history=outcome.history,
        core=outcome.core,
        opinion=opinion,
        of=theorem.of,
        words=theorem.words,
        note=outcome.note,
    )


def listed(theorem: Theorem) -> ProveListEntry:
    """The entry of `results` for a theorem with --list."""
    return ProveListEntry(
        name=theorem.name,
        kind=theorem.kind,
        claim=",".join(theorem.claims),
        expected=theorem.expected,
        edges=theorem.edges,
        deep=theorem.deep,
        of=theorem.of,
        words=theorem.words,
        symbols=theorem.symbols,
        solver_part=theorem.solver_part,
        argued=theorem.argued,
        assumed=theorem.assumed,
    )


# ---------------------------------------------------------------- for people

FEW = 5
"""Up to this number, --list shows theorems in full."""


def head(theorems: Sequence[Theorem], budget: Budget) -> str:
    """The first line: the solver, its seed, and how many theorems of each kind."""
    from topo_verify.proofs.solvers import z3_solver

    kinds = Counter[str](theorem.kind for theorem in theorems)
    counts = ", ".join(f"{kinds[kind]} {kind}" for kind in KINDS if kinds[kind])
    many = plural(len(theorems), "theorem")
    return f"{z3_solver.name()}, seed {budget.seed}: {many} ({counts})"


def _verdict(entry: ProveEntry) -> Cell:
    """The verdict, with the tone of a pass where a REFUTED was expected."""
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
    """The evidence for the verdict, in a few words."""
    words: list[str] = []
    if entry.total is not None:
        words.append(f"{entry.checked} of {plural(entry.total, 'world')}")
    if entry.kind in ("inductive", "bounded"):
        # The other kinds are refuted by a model of the premises, or Coq proves that they can hold.
        words += [_VACUITY[entry.premises_satisfiable]] if entry.verdict != "UNKNOWN" else []
    if entry.core and entry.kind == "inductive":
        words.append(f"used {plural(len(entry.core), 'premise')}")
    if entry.history is not None:
        words.append(f"in {entry.counterexample}, doors {' '.join(map(str, entry.history))}")
    if entry.replayed is not None:
        words.append("replays" if entry.replayed.replayed == entry.replayed.total else "NO REPLAY")
    if entry.certificate is not None:
        made = entry.certificate
        checked = "checked" if made.checked else f"NOT CHECKED ({made.why})"
        words.append(f"{made.format} {checked} by {made.checker}")
    if entry.opinion is not None:
        second = entry.opinion
        words.append(f"{second.solver} agrees on {second.agrees} of {second.total}")
        words += [f"unknown on {second.unknown}"] if second.unknown else []
    # A refuting history says more than the note, unless something went wrong.
    if entry.note and (not entry.ok or entry.history is None):
        words.append(entry.note)
    return "; ".join(words)


_VACUITY = {
    True: "premises satisfiable",
    False: "VACUOUS: its premises cannot hold",
    None: "premises not shown satisfiable",
}


def show(entries: Sequence[ProveEntry]) -> Iterator[Block]:
    """All theorems in one table, and the counts."""
    yield TextTable(
        ("theorem", "kind", "verdict", "", "what stands behind it"), [*map(_row, entries)]
    )
    yield from end(entries)


def live(entry: ProveEntry, seconds: float) -> Iterator[Block]:
    """The row of one theorem."""
    evidence = _evidence(entry) if entry.ok else f"NOT OK ({entry.kind}): {_evidence(entry)}"
    row = (entry.name, _verdict(entry), f"{seconds:.2f} s", evidence)
    columns = ("theorem", "verdict", ">time", "what stands behind it")
    yield TextTable(columns, [row], widths=(28, 9, 7, 0), headed=False)


def end(entries: Sequence[ProveEntry]) -> Iterator[Block]:
    """How many theorems of each kind came out as expected, and which did not."""
    yield Text("")
    rows: list[tuple[str, ...]] = []
    for kind in KINDS:
        mine = [entry for entry in entries if entry.kind == kind]
        if not mine:
            continue
        replays = [entry.replayed for entry in mine if entry.replayed is not None]
        done = sum(one.replayed for one in replays)
        papers = sum(entry.certificate is not None and entry.certificate.checked for entry in mine)
        rows.append(
            (
                kind,
                f"{sum(entry.ok for entry in mine)} of {len(mine)}",
                f"{done} of {sum(one.total for one in replays)}" if replays else "-",
                f"{papers} of {len(mine)}" if kind == "bounded" else "-",
            )
        )
    columns = ("kind", ">as expected", ">models replayed", ">with a checked certificate")
    yield TextTable(columns, rows)
    wrong = [f"{entry.name}: {entry.verdict}; {entry.note}" for entry in entries if not entry.ok]
    if wrong:
        yield Text("Not as expected:")
        yield Bullets(tuple(wrong))
    yield Text("What is argued, assumed and not shown: docs/proofs.md and docs/mechanised.md.")


def show_list(entries: Sequence[ProveListEntry]) -> Iterator[Block]:
    """The theorems in a table, or in full if they are few."""
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
