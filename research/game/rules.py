"""The rules of two games: the history proves the map among all worlds, or among those of a class.

`ProofRules`, among worlds of any size:

    state       the fold of the history, where the robot stands in it, the open worlds
    choice      an open dart: go there along crossed edges, the shortest way, and cross it
    the end     `GameEnding`: one world fits

`ClassRules`, among a finite class of worlds:

    state       the worlds of the class in which the history happens, the robot's dart in each
    choice      a door
    the end     one world of the class is left

The answer is the percept behind the door. **Bound.** By partition refinement: darts that look
alike for k moves, door by door, need k moves to be told apart. A world must be told from the one
most like it.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import accumulate, count
from typing import NamedTuple

from research.game import folds as fd
from research.game.drawn import DrawnWorld
from research.game.search import GameChoice
from topo_verify.errors import InternalError


class FoldState(NamedTuple):
    """A state of `ProofRules`: a fold, the robot's reference dart, the open worlds ascending."""

    code: fd.FoldCode
    at: int
    open: tuple[int, ...]


class GameEnding(NamedTuple):
    """How a game ends.

    Attributes:
        is_proved: whether a fold leaves one world only.
        bound: least moves to go, for a world, an unproved fold and a dart of it.
    """

    is_proved: Callable[[fd.FoldCode], bool]
    bound: Callable[[DrawnWorld, fd.FoldCode, int], int]


class ProofRules:
    """The rules (`search.Rules`) of the game among all worlds."""

    def __init__(self, worlds: Sequence[DrawnWorld], ending: GameEnding) -> None:
        self._worlds, self._ending = worlds, ending
        self._proved = dict[fd.FoldCode, bool]()
        self._crossed = dict[tuple[fd.FoldCode, int, fd.Sight], tuple[fd.FoldCode, int]]()

    def starts(self) -> list[FoldState]:
        """The states after the first percept."""
        by_degree = defaultdict[int, list[int]](list)
        for number, world in enumerate(self._worlds):
            by_degree[world.degrees[0]].append(number)
        return list(
            self._open((fd.first_fold(degree), 0, held) for degree, held in by_degree.items())
        )

    def choices(self, state: FoldState) -> Iterator[GameChoice[FoldState]]:
        """The open darts of the fold."""
        _, vertex = fd.vertices(state.code[0])
        far = fd.distances(state.code, vertex[state.at])
        for dart in fd.open_darts(state.code):
            yield GameChoice(far[vertex[dart]] + 1, tuple(self._open(self._answers(state, dart))))

    def worlds(self, state: FoldState) -> int:
        """The number of open worlds."""
        return len(state.open)

    def parts(self, state: FoldState) -> list[FoldState]:
        """Split at the first differing bit of the worlds' numbers."""
        held = state.open
        if len(held) == 1:
            return []
        bit = 1 << (held[0] ^ held[-1]).bit_length() - 1
        cut = sum(not number & bit for number in held)
        return [state._replace(open=held[:cut]), state._replace(open=held[cut:])]

    def bounds(self, state: FoldState) -> Iterator[int]:
        """The ending's bound in each open world."""
        for number in state.open:
            yield self._ending.bound(self._worlds[number], state.code, state.at)

    def _answers(self, state: FoldState, dart: int) -> Iterator[tuple[fd.FoldCode, int, list[int]]]:
        """By percept: the fold then, the robot's dart, the worlds."""
        by_sight = defaultdict[fd.Sight, list[int]](list)
        for number in state.open:
            world = self._worlds[number]
            by_sight[world.sight(world.alpha[world.placed(state.code)[dart]])].append(number)
        for sight, held in by_sight.items():
            key = state.code, dart, sight
            if key not in self._crossed:
                self._crossed[key] = fd.crossed(*key)
            yield *self._crossed[key], held

    def _open(self, answers: Iterable[tuple[fd.FoldCode, int, list[int]]]) -> Iterator[FoldState]:
        """The answers that do not end the game."""
        for code, at, held in answers:
            if code not in self._proved:
                self._proved[code] = self._ending.is_proved(code)
            if not self._proved[code]:
                yield FoldState(code, at, tuple(held))
            elif len(held) > 1:
                raise InternalError(f"{len(held)} worlds fit the fold {code}, which proves one")


# ---------------------------------------------------------------- a finite class

ClassState = tuple[tuple[int, int], ...]
"""The worlds left, ascending, each with the robot's dart."""


class ClassRules:
    """The rules (`search.Rules`) of the game in a finite class.

    `counted` are the numbers of the worlds whose costs count, unknown to the robot.
    """

    def __init__(self, worlds: Sequence[DrawnWorld], counted: frozenset[int]) -> None:
        self._worlds, self._counted = worlds, counted
        self._looks = _refined(worlds)
        self._first = list(accumulate((len(world.alpha) for world in worlds), initial=0))

    def starts(self) -> list[ClassState]:
        """The states after the first percept."""
        return self._open([(number, 0) for number in range(len(self._worlds))])

    def choices(self, state: ClassState) -> Iterator[GameChoice[ClassState]]:
        """The doors by which the robot can leave."""
        number, dart = state[0]
        degree, _ = self._worlds[number].sight(dart)
        for door in range(degree):
            places = [(n, self._worlds[n].turned(dart, door)) for n, dart in state]
            behind = [(n, self._worlds[n].alpha[dart]) for n, dart in places]
            yield GameChoice(1, tuple(self._open(behind)))

    def worlds(self, state: ClassState) -> int:
        """The number of worlds left that count."""
        return sum(number in self._counted for number, _ in state)

    def parts(self, _state: ClassState) -> list[ClassState]:
        """No parts: splitting would not improve the bounds."""
        return []

    def bounds(self, state: ClassState) -> Iterator[int]:
        """For each counting world, the moves to tell it from all others."""
        darts = [self._first[number] + dart for number, dart in state]
        held = [
            dart for dart, (number, _) in zip(darts, state, strict=True) if number in self._counted
        ]
        needed = dict.fromkeys(held, 0)
        for moves, looks in enumerate(self._looks, start=1):
            alike = Counter(looks[dart] for dart in darts)
            if not (twins := [dart for dart in held if alike[looks[dart]] > 1]):
                break
            needed.update(dict.fromkeys(twins, moves))
        yield from needed.values()

    def _open(self, places: Sequence[tuple[int, int]]) -> list[ClassState]:
        """The places by percept, without single ones and those that do not count."""
        by_sight = defaultdict[fd.Sight, list[tuple[int, int]]](list)
        for number, dart in places:
            by_sight[self._worlds[number].sight(dart)].append((number, dart))
        states = map(tuple, by_sight.values())
        return [state for state in states if len(state) > 1 and self.worlds(state)]


def _refined(worlds: Sequence[DrawnWorld]) -> list[list[int]]:
    """For k = 0, 1, … the class of each dart of all worlds: equal just if k moves cannot tell."""
    first = list(accumulate((len(world.alpha) for world in worlds), initial=0))
    behind = [
        [
            first[number] + world.alpha[world.turned(dart, door)]
            for door in range(world.sight(dart)[0])
        ]
        for number, world in enumerate(worlds)
        for dart in range(len(world.alpha))
    ]
    names = defaultdict[object, int](count().__next__)
    looks = [[names[w.sight(dart)] for w in worlds for dart in range(len(w.alpha))]]
    while len(looks) < 2 or len(set(looks[-1])) > len(set(looks[-2])):
        last, names = looks[-1], defaultdict[object, int](count().__next__)
        looks.append(
            [names[last[dart], *(last[b] for b in behind[dart])] for dart in range(len(last))]
        )
    return looks
