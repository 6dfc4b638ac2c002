"""The game in which the history has to prove the map among worlds of any size.

    state       the fold of the history, where the robot stands in it, the worlds that are open
    choice      an open dart: to walk there along crossed edges, the shortest way, and cross it
    answer      the percept behind it
    the end     `GameEnding`: one world fits

Only at an open dart can something be seen that is not known. What is known of the worlds that are
open besides the fold (that they have m edges, say) may guide the robot, but ends no game.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

from topo_verify.errors import InternalError
from topo_verify.studies.game.drawn import DrawnWorld
from topo_verify.studies.game.folds import (
    FoldCode,
    Sight,
    crossed,
    distances,
    first_fold,
    open_darts,
    vertices,
)
from topo_verify.studies.game.search import GameChoice


class FoldState(NamedTuple):
    """A state of the game.

    Attributes:
        code: the fold of the history.
        at: the reference dart of the robot there.
        open: the numbers of the worlds that are open, ascending.
    """

    code: FoldCode
    at: int
    open: tuple[int, ...]


class GameEnding(NamedTuple):
    """How a game ends.

    Attributes:
        is_proved: whether a fold leaves one world only.
        bound: for a world, a fold that is not proved and a dart of it: the moves to go, at least.
    """

    is_proved: Callable[[FoldCode], bool]
    bound: Callable[[DrawnWorld, FoldCode, int], int]


class ProofRules:
    """The rules of this game (`search.Rules`).

    Args:
        worlds: those that the robot may be in.
        ending: how the game ends.
    """

    def __init__(self, worlds: Sequence[DrawnWorld], ending: GameEnding) -> None:
        self._worlds, self._ending = worlds, ending
        self._proved = dict[FoldCode, bool]()
        self._crossed = dict[tuple[FoldCode, int, Sight], tuple[FoldCode, int]]()

    def starts(self) -> list[FoldState]:
        """The states after the first percept."""
        seen = defaultdict[int, list[int]](list)
        for number, world in enumerate(self._worlds):
            seen[world.degrees[0]].append(number)
        return list(self._open((first_fold(degree), 0, held) for degree, held in seen.items()))

    def choices(self, state: FoldState) -> Iterator[GameChoice[FoldState]]:
        """Each open dart of the fold."""
        _, vertex = vertices(state.code[0])
        far = distances(state.code, vertex[state.at])
        for dart in open_darts(state.code):
            yield GameChoice(far[vertex[dart]] + 1, tuple(self._open(self._answers(state, dart))))

    def worlds(self, state: FoldState) -> int:
        """How many worlds are open."""
        return len(state.open)

    def parts(self, state: FoldState) -> list[FoldState]:
        """Two parts: the worlds whose numbers have the first bit that differs, and the others."""
        held = state.open
        if len(held) == 1:
            return []
        bit = 1 << (held[0] ^ held[-1]).bit_length() - 1
        cut = sum(not number & bit for number in held)
        return [state._replace(open=held[:cut]), state._replace(open=held[cut:])]

    def bounds(self, state: FoldState) -> Iterator[int]:
        """The bound of the ending."""
        for number in state.open:
            yield self._ending.bound(self._worlds[number], state.code, state.at)

    def _answers(self, state: FoldState, dart: int) -> Iterator[tuple[FoldCode, int, list[int]]]:
        """What may be seen behind an open dart: the fold then, where the robot is, the worlds."""
        seen = defaultdict[Sight, list[int]](list)
        for number in state.open:
            world = self._worlds[number]
            seen[world.sight(world.alpha[world.placed(state.code)[dart]])].append(number)
        for sight, held in seen.items():
            key = state.code, dart, sight
            if key not in self._crossed:
                self._crossed[key] = crossed(*key)
            yield *self._crossed[key], held

    def _open(self, answers: Iterable[tuple[FoldCode, int, list[int]]]) -> Iterator[FoldState]:
        """The answers that do not end the game, as states."""
        for code, at, held in answers:
            if code not in self._proved:
                self._proved[code] = self._ending.is_proved(code)
            if not self._proved[code]:
                yield FoldState(code, at, tuple(held))
            elif len(held) > 1:
                raise InternalError(f"{len(held)} worlds fit the fold {code}, which proves one")
