"""All states of one world and the choices between them, found by running the mapper.

`StateGraph` runs the mapper with lists of choices until every way of every state lies on a
judged run. One run for a way suffices, since runs continue alike from equal states
(`memory.py`). The graph checks that a known state has as many ways and moves as before.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from topo_verify.algorithms import Algorithm
from topo_verify.campaign.attempt import Attempt
from topo_verify.errors import InternalError
from topo_verify.programs.loader import Mapper
from topo_verify.studies.search.states.memory import State, state
from topo_verify.studies.search.states.script import ChoicePoint, scripted
from topo_verify.world.rooted_map import World

END, LOST = -1, -2
"""The run ends; a claim has failed, or the clock stopped the run."""


@dataclass
class ChoiceState:
    """A state of the search.

    Attributes:
        prefix: the choices that first led to it.
        moves: number of moves that the mapper has made.
        ways: the state behind each way, `END` or `LOST`; None: not yet taken.
    """

    prefix: tuple[int, ...]
    moves: int
    ways: list[int | None]

    @property
    def open(self) -> int | None:
        """The first way that was not taken, or None."""
        return self.ways.index(None) if None in self.ways else None


class _Passed(NamedTuple):
    """A state on a run: its number, the way taken, the events before."""

    node: int
    taken: int
    events: int


@dataclass
class JudgedPath:
    """A run with its choices, as `--choices` counts them."""

    choices: tuple[int, ...]
    tried: Attempt
    passed: tuple[_Passed, ...]


@dataclass
class StateGraph:
    """The states of a mapper in one world: `search`, then everything else.

    `judged` runs a mapper in the world and judges it. `start` is the first state, `END` or `LOST`.
    """

    algorithm: Algorithm
    world: World
    judged: Callable[[Mapper], Attempt]
    start: int | None = None
    nodes: list[ChoiceState] = field(default_factory=list[ChoiceState])
    paths: list[JudgedPath] = field(default_factory=list[JudgedPath])
    _numbers: dict[State, int] = field(default_factory=dict[State, int])

    def search(self) -> None:
        """Take every way of every state."""
        self.paths.append(self.run(()))
        for node in self.nodes:  # grows as it goes
            while (way := node.open) is not None:
                self.paths.append(self.run((*node.prefix, way)))

    @property
    def choices(self) -> int:
        """The number of ways of all states."""
        return sum(len(node.ways) for node in self.nodes)

    def run(self, prefix: Sequence[int]) -> JudgedPath:
        """Run these ways, then ways that were not taken, or the first each time."""
        passed: list[_Passed] = []
        lost = False
        broken: Exception | None = None

        def chooser(moment: ChoicePoint) -> int:
            # Raised at the end: here it would count as the mapper's.
            nonlocal lost, broken
            number = LOST
            try:
                number = LOST if lost else self._number(moment, passed)
            except Exception as error:  # noqa: BLE001  raised below
                broken = broken or error
            if number == LOST:
                lost = True
                return 0
            way = self.nodes[number].open or 0
            if len(passed) < len(prefix):
                way = prefix[len(passed)]
            passed.append(_Passed(number, way, len(moment.trace)))
            return way

        tried = self.judged(scripted(self.algorithm, chooser))
        if broken is not None:
            raise broken
        lost = lost or tried.run.limit in ("move-timeout", "world-timeout")
        self._lead(passed, LOST if lost else END)
        return JudgedPath(tuple(step.taken for step in passed), tried, tuple(passed))

    def _number(self, moment: ChoicePoint, passed: Sequence[_Passed]) -> int:
        """The number of the state at a moment, or `LOST`."""
        number = self.nodes[passed[-1].node].ways[passed[-1].taken] if passed else self.start
        if number is None and (kept := state(moment, self.world)) is not None:
            number = self._numbers.setdefault(kept, len(self.nodes))
            if number == len(self.nodes):
                taken = tuple(step.taken for step in passed)
                self.nodes.append(ChoiceState(taken, moment.moves, [None] * len(moment.ways)))
            self._lead(passed, number)
        if number in (None, LOST):
            return LOST
        if number == END:
            raise self._different("the end of a run and a choice")
        node = self.nodes[number]
        for name, was, now in (
            ("ways", len(node.ways), len(moment.ways)),
            ("moves", node.moves, moment.moves),
        ):
            if was != now:
                raise self._different(f"{was} and {now} {name}")
        return number

    def _lead(self, passed: Sequence[_Passed], to: int) -> None:
        ways = self.nodes[passed[-1].node].ways if passed else [self.start]
        place = passed[-1].taken if passed else 0
        if ways[place] is None:
            ways[place] = to
            self.start = self.start if passed else to
        elif ways[place] != to and LOST not in (ways[place], to):
            raise self._different("a choice and the end of a run")

    def _different(self, how: str) -> InternalError:
        return InternalError(
            f"a state of {self.algorithm.name} in {self.world.text} has {how}: what the mapper"
            " remembers is not all in the state, or it does not do the same each time"
        )

    # ------------------------------------------------------------ the shortest failing choices

    def shortest_failing(self) -> JudgedPath | None:
        """The run with the fewest choices up to its first finding, if a claim fails."""
        failing = [path for path in self.paths if not path.tried.report.ok]
        culprits = dict.fromkeys(_culprit(path) for path in failing)
        ways = self._shortest()
        rows = [() if culprit is None else (*ways[culprit[0]], culprit[1]) for culprit in culprits]
        for row in sorted(rows, key=lambda row: (len(row), row)):
            path = self.run(row)
            if not path.tried.report.ok:
                return path
        return min(failing, key=lambda path: len(path.choices), default=None)

    def _shortest(self) -> dict[int, tuple[int, ...]]:
        """The fewest ways from the start to each state."""
        shortest: dict[int, tuple[int, ...]] = {}
        queue: deque[tuple[int, tuple[int, ...]]] = deque()
        if self.start is not None:
            queue.append((self.start, ()))
        while queue:
            number, choices = queue.popleft()
            if number in (END, LOST) or number in shortest:
                continue
            shortest[number] = choices
            ways = enumerate(self.nodes[number].ways)
            queue += ((to, (*choices, way)) for way, to in ways if to is not None)
        return shortest


def _culprit(path: JudgedPath) -> tuple[int, int] | None:
    """The state and way after which a claim first fails, or None."""
    last = len(path.tried.run.trace)
    findings = path.tried.report.findings
    first = min(last if finding.event is None else finding.event for finding in findings)
    before = [step for step in path.passed if step.events <= first]
    return (before[-1].node, before[-1].taken) if before else None
