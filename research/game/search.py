"""The value of a game of robot against world: the least cost, in the worst case or in sum.

The robot makes a **choice**, a number of moves. Each answer of the world leaves a **state**, or
ends the game. The value of a state is

    worst case   least over the choices of   moves + the greatest value over the answers
    sum          least over the choices of   moves · worlds + the sum of the values

where `worlds` is the number of worlds that the state leaves open.

**Search.** The limit is a state's lower bound. Only choices with a lower bound within the limit
are tried; if none attains it, the least value still possible is the next limit. The number of
states is limited, not the time, so that two calls end alike. Values of parts of the worlds, or
their sum, are a lower bound.
"""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterable, Sequence
from typing import Generic, NamedTuple, Protocol, TypeVar

from topo_verify.errors import InternalError

S = TypeVar("S", bound=Hashable)


class Least(NamedTuple):
    """A cost that no robot undercuts, in moves; `is_value`: some robot attains it."""

    cost: int
    is_value: bool


class _OutOfStates(Exception):
    pass


class GameChoice(NamedTuple, Generic[S]):
    """A number of moves, and the states that their answers leave open."""

    moves: int
    states: tuple[S, ...]


class Rules(Protocol[S]):
    """The rules of a game."""

    def starts(self) -> Sequence[S]:
        """The states after the first percept."""
        ...

    def choices(self, state: S, /) -> Iterable[GameChoice[S]]:
        """The robot's next choices."""
        ...

    def worlds(self, state: S, /) -> int:
        """The number of counting worlds that a state leaves open."""
        ...

    def parts(self, state: S, /) -> Sequence[S]:
        """States that divide the open worlds; or none."""
        ...

    def bounds(self, state: S, /) -> Iterable[int]:
        """For a state without parts: a positive lower bound for each world."""
        ...


class Solver(Generic[S]):
    """The values of the states of a game; `mean`: of the sum, not the worst case."""

    def __init__(self, rules: Rules[S], *, mean: bool, most_states: float = math.inf) -> None:
        self._rules, self._mean, self._most_states = rules, mean, most_states
        self._bound = dict[S, float]()
        self._choices = dict[S, Sequence[GameChoice[S]]]()
        self._solved, self._parted = set[S](), set[S]()

    @property
    def states(self) -> int:
        """The number of states met."""
        return len(self._bound)

    def least(self, state: S) -> Least:
        """The value of a state, or the bound that was reached."""
        try:
            return Least(int(self.value(state)), is_value=True)
        except _OutOfStates:
            return Least(int(self.bound(state)), is_value=False)

    def value(self, state: S, limit: float = math.inf) -> float:
        """The value of a state; or a lower bound above the limit."""
        bound = self.bound(state)
        if bound <= limit and state not in self._parted:
            bound = self._by_parts(state, bound, limit)
        while bound <= limit and state not in self._solved:
            value = self._attempt(state, bound)
            if value < bound:
                raise InternalError(f"{state} has the value {value}, below its bound {bound}")
            if value == bound:
                self._solved.add(state)
            self._bound[state] = bound = value
        return bound

    def bound(self, state: S) -> float:
        """The best known lower bound on the value of a state."""
        if state not in self._bound:
            parts = self._rules.parts(state)
            bounds = map(self.bound, parts) if parts else self._rules.bounds(state)
            self._bound[state] = sum(bounds) if self._mean else max(bounds)
        return self._bound[state]

    def _by_parts(self, state: S, bound: float, limit: float) -> float:
        parts = self._rules.parts(state)
        bound = self._bound[state] = max(bound, self._answers(parts, 0, limit))
        if bound <= limit:
            self._parted.add(state)
        return bound

    def _attempt(self, state: S, limit: float) -> float:
        """The value up to the limit; else a lower bound above it."""
        if state not in self._choices:
            if self.states > self._most_states:
                raise _OutOfStates
            self._choices[state] = tuple(self._rules.choices(state))
        weight = self._rules.worlds(state) if self._mean else 1
        least = math.inf
        for choice in self._choices[state]:
            least = min(least, self._answers(choice.states, choice.moves * weight, limit))
            if least <= limit:
                break
        return least

    def _answers(self, states: Sequence[S], paid: int, limit: float) -> float:
        """The value over these states plus `paid`; or a bound above the limit."""
        if not self._mean:
            total = paid + max(map(self.bound, states), default=0)
            for state in states:
                if total > limit:
                    break
                total = max(total, paid + self.value(state, limit - paid))
            return total
        total = paid + sum(map(self.bound, states))
        for state in states:
            if total > limit:
                break
            bound = self.bound(state)
            total += self.value(state, limit - total + bound) - bound
        return total
