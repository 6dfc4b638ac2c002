"""Clauses over named Booleans: what the bounded encodings are written in.

A formula is in conjunctive normal form from the start, so every solver, and the checker of
certificates, reads the same clauses: no translation stands between them that would have to be
trusted. As in DIMACS a literal is a number: `v` says that Boolean `v` is true, `-v` that it is
false. Clauses stand in named **groups**, one for each premise, so that an unsatisfiable core can be
told in words. The group `REFUTED` is the negated conclusion; a formula without it is the premises
alone, and must be satisfiable, or the theorem says nothing.

    row           literals of which exactly one is true: "which dart", "which door"
    one-hot       writing a value as such a row
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations

CnfLiteral = int
CnfRow = tuple[CnfLiteral, ...]
Clause = tuple[CnfLiteral, ...]

REFUTED = "refuted"
"""The group that says: and yet the conclusion is false."""

MET = "met"
"""In the premises alone: what the conclusion speaks of does occur, so that it is not empty."""


class Formula:
    """A conjunction of clauses that grows. Names are unique; Boolean `v` is `names[v - 1]`."""

    def __init__(self) -> None:
        self.names: list[str] = []
        self.groups: dict[str, list[Clause]] = {}
        self.met: list[Clause] = []

    # ------------------------------------------------------------ saying things

    def boolean(self, name: str) -> CnfLiteral:
        """A new Boolean."""
        self.names.append(name)
        return len(self.names)

    def booleans(self, name: str, size: int) -> CnfRow:
        """New Booleans `name.0`, `name.1`, …, with nothing said about them."""
        return tuple(self.boolean(f"{name}.{index}") for index in range(size))

    def row(self, group: str, name: str, size: int) -> CnfRow:
        """A new one-hot row."""
        row = self.booleans(name, size)
        self.exactly_one(group, row)
        return row

    def add(self, group: str, *literals: CnfLiteral) -> None:
        """One of these holds."""
        self.groups.setdefault(group, []).append(literals)

    def imply(self, group: str, premises: Sequence[CnfLiteral], *conclusions: CnfLiteral) -> None:
        """If all premises hold, one of the conclusions does."""
        self.add(group, *(-premise for premise in premises), *conclusions)

    def exactly_one(self, group: str, literals: Sequence[CnfLiteral]) -> None:
        """One of these holds, and no two."""
        self.add(group, *literals)
        for one, other in combinations(literals, 2):
            self.add(group, -one, -other)

    def define_and(self, group: str, name: str, literals: Sequence[CnfLiteral]) -> CnfLiteral:
        """A new Boolean that holds exactly if all of these do."""
        both = self.boolean(name)
        for literal in literals:
            self.add(group, -both, literal)
        self.imply(group, literals, both)
        return both

    def define_or(self, group: str, name: str, literals: Sequence[CnfLiteral]) -> CnfLiteral:
        """A new Boolean that holds exactly if one of these does, or more."""
        return -self.define_and(group, name, [-literal for literal in literals])

    def equate(self, group: str, guard: Sequence[CnfLiteral], one: CnfRow, other: CnfRow) -> None:
        """Where the guard holds, the two rows are equal, literal by literal."""
        for a, b in zip(one, other, strict=True):
            self.imply(group, (*guard, a), b)
            self.imply(group, (*guard, b), a)

    def define_equal(self, group: str, name: str, one: CnfRow, other: CnfRow) -> CnfLiteral:
        """A new Boolean that holds exactly if the two one-hot rows are equal."""
        equal = self.boolean(name)
        self.equate(group, (equal,), one, other)
        for a, b in zip(one, other, strict=True):
            self.imply(group, (a, b), equal)
        return equal

    # ------------------------------------------------------------ what was said

    @property
    def clauses(self) -> list[Clause]:
        """All clauses, group by group."""
        return [clause for clauses in self.groups.values() for clause in clauses]

    def premises(self) -> Formula:
        """The formula without its negated conclusion, where what that speaks of occurs."""
        alone = Formula()
        alone.names = list(self.names)
        alone.groups = {name: row for name, row in self.groups.items() if name != REFUTED}
        alone.groups[MET] = list(self.met)
        return alone

    def smt2(self) -> str:
        """SMT-LIB 2: one named assertion a group, no command after them."""
        lines = ["(set-logic QF_UF)"]
        lines += [f"(declare-const {name} Bool)" for name in self.names]
        for group, clauses in self.groups.items():
            lines.append("(assert (! (and true")
            lines += [f"  {self._disjunction(clause)}" for clause in clauses]
            lines.append(f") :named {group}))")
        return "\n".join(lines) + "\n"

    def _disjunction(self, clause: Iterable[CnfLiteral]) -> str:
        written = [
            self.names[literal - 1] if literal > 0 else f"(not {self.names[-literal - 1]})"
            for literal in clause
        ]
        return written[0] if len(written) == 1 else f"(or false {' '.join(written)})"
