"""What a robot does behind an edge, as words of doors; and what these words show later.

Trusted. **Excursions.** The moves behind an edge are reduced to the word of doors from vu to where
the robot stands. A *sequence* is the word at a mismatch in motion. **Records.** Once it is known
where the edge leads, each sequence is traced on S up to the first unexplored dart; what remains of
it shows what lies behind that dart.

Source: docs/semantics.md, section 9, "Moves become words"; section 7, "Records".
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from topo_verify.checkers.darts import KnownDart
from topo_verify.checkers.map_in_world import MapInWorld
from topo_verify.robot.percept import Door, Percept


class Step(NamedTuple):
    """One door of a word, and the percept behind it on entry."""

    door: Door
    percept: Percept


Word = tuple[Step, ...]


class Excursion:
    """The moves behind one posed edge, reduced. Begins with the pose; ends with the next.

    Args:
        is_late: the pose was not made behind the edge, so the word stays empty.
    Attributes:
        word: the steps from vu to where the robot stands.
        sequences: the words at the mismatches so far.
    """

    def __init__(self, *, is_late: bool = False) -> None:
        self._is_late = is_late
        self.word: list[Step] = []
        self.sequences: tuple[Word, ...] = ()
        # After coming back by door k the next door counts k further on.
        self._turned: Door = 0

    def move(self, door: Door, degree: int, behind: Percept) -> None:
        """Leave a vertex of this degree by a door; `behind` is sensed there."""
        door = (door + self._turned) % degree
        if door == 0 and self.word:
            self._turned = self.word.pop().door
        elif not self._is_late:
            self.word.append(Step(door, behind))
            self._turned = 0


class Records:
    """What was sensed behind unexplored darts of S, and since which event it is known."""

    def __init__(self, drawn: MapInWorld) -> None:
        self._map = drawn
        self._words: dict[KnownDart, list[tuple[int, Word]]] = {}

    def add(self, when: int, start: KnownDart, sequences: Iterable[Word]) -> None:
        """Keep what sequences from a dart of S show, each behind the first unexplored dart."""
        for sequence in sequences:
            # explored only at `when`
            at, rest = self.trace(start, sequence, when + 1)
            if rest:
                self._words.setdefault(at, []).append((when, rest))

    def trace(self, at: KnownDart, word: Word, when: int) -> tuple[KnownDart, Word]:
        """Where a word from a dart of S leads on S at event `when`.

        Returns: the first unexplored dart that it leaves by, and the word from there on; or the
            dart of arrival at its end, and no word.
        """
        for place, step in enumerate(word):
            exit_at = self._map.turn(at, step.door)
            if self._map.is_open(exit_at, when):
                return exit_at, word[place:]
            at = self._map.alpha[exit_at]
        return at, ()

    def behind(self, dart: KnownDart, doors: tuple[Door, ...], when: int) -> Percept | None:
        """What was known at event `when` of the place behind an unexplored dart and doors."""
        for since, word in self._words.get(dart, ()):
            if since < when and tuple(step.door for step in word[1 : len(doors) + 1]) == doors:
                return word[len(doors)].percept
        return None
