"""All states of one world and the choices between them, found by running the mapper.

`StateGraph` runs the mapper again and again, with a list of choices, and goes on where a state has
a way that was not taken yet. So each way of each state lies on a run, and each run is judged by
every claim, as any other. A state that was met before is not searched again: that is what makes the
states of a world few where its runs are beyond counting.

Why it suffices to judge a way on one run that takes it:

    1, 6        the percepts and the count of moves are the robot's; no history changes them.
    2, 3, 4, 5  a decision behind e is right or wrong by S, e and the world, which the state has.
    7           the range of the costs is computed over all runs (`ranges.py`).
    8           the percepts that a rejection cites come from S, T and the sequences of this e: the
                state has them. A contradiction of folding comes from the fold: it has that, too.
    9, 10       more history proves no less. If the evidence of claim 8 holds, S (or T) contradicts
                the hypothesis, however S was come by. A way home that was walked to the marker
                proves its hypothesis. And so on, edge by edge: docs/semantics.md, section 11.

The last is an argument, not a check: claims 9 and 10 are judged on the runs that were made, and
what follows for the other runs into the same state rests on it.

The ways of a state are counted in the order of the darts of the world. (`--choices` counts them
in the order of the darts of S, which depends on the run.)

`StateGraph` also checks itself: where two runs take one way, they must pay the same for it and meet
the same state behind it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from topo_verify.algorithms import Algorithm
from topo_verify.errors import InternalError, TopoVerifyError
from topo_verify.harness.search.states.memory import State, owed, state
from topo_verify.harness.search.states.script import ChoicePoint, scripted
from topo_verify.harness.second_try import Tried
from topo_verify.programs.loader import Mapper
from topo_verify.world.rooted_map import World

END = -1
"""Where a run ends: behind it there is no state."""


class StateWay(NamedTuple):
    """One way out of a state.

    Attributes:
        cost: the moves up to the next state, in edge traversals; ways back that always come are
            paid with the hypothesis that was tried.
        to: the number of the next state, or `END`.
    """

    cost: int
    to: int


@dataclass
class ChoiceState:
    """A state: some ways that lead to it, and its ways, None while they were not taken."""

    prefix: tuple[int, ...]
    ways: list[StateWay | None]

    @property
    def open(self) -> int | None:
        """The first way that was not taken; None: all were."""
        return self.ways.index(None) if None in self.ways else None


class _Passed(NamedTuple):
    """A state that a run passed: its number, the way it took, what it had paid, its events."""

    node: int
    taken: int
    paid: int
    events: int


@dataclass
class JudgedPath:
    """A run with the choices that made it, as `--choices` counts them."""

    choices: tuple[int, ...]
    tried: Tried
    passed: tuple[_Passed, ...]


@dataclass
class StateGraph:
    """The states of a mapper in one world. Life cycle: `search`, then everything else.

    Args:
        judged: runs a mapper in the world and judges it.

    Attributes:
        start: the way from the start to the first state.
        nodes: the states, in the order in which they were met.
        paths: the runs that were made.
    """

    algorithm: Algorithm
    world: World
    judged: Callable[[Mapper], Tried]
    start: StateWay | None = None
    nodes: list[ChoiceState] = field(default_factory=list[ChoiceState])
    paths: list[JudgedPath] = field(default_factory=list[JudgedPath])
    _numbers: dict[State, int] = field(default_factory=dict[State, int])

    def search(self) -> None:
        """Take every way of every state."""
        self._search(())
        for node in self.nodes:  # grows as it goes
            while (way := node.open) is not None:
                self._search((*node.prefix, way))

    @property
    def choices(self) -> int:
        """How many ways all states have together."""
        return sum(len(node.ways) for node in self.nodes)

    def _search(self, prefix: tuple[int, ...]) -> None:
        """Run once, and keep the run: the ways of the prefix, then some that were not taken."""
        path = self.run(prefix)
        self.paths.append(path)
        self._note(path.passed, path.tried.run.cost)

    def run(self, prefix: Sequence[int]) -> JudgedPath:
        """The run that takes these ways, then ways that were not taken, or the first each time."""
        chosen: list[int] = []
        passed: list[_Passed] = []
        lost = False
        broken: TopoVerifyError | None = None

        def chooser(moment: ChoicePoint) -> int:
            # What is raised here would count as the mapper's own: so it is kept until the end.
            nonlocal lost, broken
            try:
                way = None if lost else followed(moment)
            except TopoVerifyError as error:
                way, broken = None, broken or error
            # No way: S is wrong, which is a finding; the run ends as it may.
            lost = way is None
            return way or 0

        def followed(moment: ChoicePoint) -> int | None:
            found = state(moment, self.algorithm.motion, self.world)
            if found is None:
                return None
            taken = tuple(one.taken for one in passed)
            number = self._number(found[0], taken, len(found[1]))
            way = self.nodes[number].open or 0
            if len(passed) < len(prefix):
                way = prefix[len(passed)]
            paid = moment.moves + owed(moment, self.algorithm.motion)
            passed.append(_Passed(number, way, paid, moment.events))
            chosen.append(found[1][way])
            return found[1][way]

        tried = self.judged(scripted(self.algorithm, chooser))
        if broken is not None:
            raise broken
        return JudgedPath(tuple(chosen), tried, tuple(passed))

    def _number(self, found: State, prefix: tuple[int, ...], ways: int) -> int:
        number = self._numbers.setdefault(found, len(self.nodes))
        if number == len(self.nodes):
            self.nodes.append(ChoiceState(prefix, [None] * ways))
        if len(self.nodes[number].ways) != ways:
            raise self._different(f"has {len(self.nodes[number].ways)} ways and {ways}")
        return number

    def _note(self, passed: Sequence[_Passed], cost: int) -> None:
        """Put on record where the ways of one run lead, and what they cost."""
        first = StateWay(passed[0].paid, passed[0].node) if passed else StateWay(cost, END)
        if self.start not in (None, first):
            raise self._different(f"begins with {self.start} and {first}")
        self.start = first
        for place, here in enumerate(passed, 1):
            way = StateWay(cost - here.paid, END)
            if place < len(passed):
                way = StateWay(passed[place].paid - here.paid, passed[place].node)
            ways = self.nodes[here.node].ways
            if ways[here.taken] not in (None, way):
                raise self._different(f"leads by one way to {ways[here.taken]} and to {way}")
            ways[here.taken] = way

    def _different(self, how: str) -> InternalError:
        return InternalError(
            f"a state of {self.algorithm.name} in {self.world.text} {how}: what the mapper"
            " remembers is not all in the state, or it does not do the same each time"
        )

    # ------------------------------------------------------------ the shortest failing choices

    def shortest_failing(self) -> JudgedPath | None:
        """The run with the fewest choices up to its first finding; None if no claim fails.

        It is run again, with the choices that lead to the failing state the shortest way.
        """
        failing = [path for path in self.paths if not path.tried.report.ok]
        culprits = dict.fromkeys(_culprit(path) for path in failing)
        ways = self._shortest()
        rows = [() if one is None else (*ways[one[0]], one[1]) for one in culprits]
        for row in sorted(rows, key=lambda row: (len(row), row)):
            path = self.run(row)
            if not path.tried.report.ok:
                return path
        return min(failing, key=lambda path: len(path.choices), default=None)

    def _shortest(self) -> dict[int, tuple[int, ...]]:
        """The fewest ways that lead from the start to each state."""
        found: dict[int, tuple[int, ...]] = {}
        queue: deque[tuple[int, tuple[int, ...]]] = deque()
        if self.start is not None:
            queue.append((self.start.to, ()))
        while queue:
            number, choices = queue.popleft()
            if number == END or number in found:
                continue
            found[number] = choices
            for way, taken in self._taken(number):
                queue.append((taken.to, (*choices, way)))
        return found

    def _taken(self, number: int) -> Iterator[tuple[int, StateWay]]:
        ways = self.nodes[number].ways
        return ((way, taken) for way, taken in enumerate(ways) if taken is not None)


def _culprit(path: JudgedPath) -> tuple[int, int] | None:
    """The state and the way behind which a claim first fails; None: before any choice."""
    last = len(path.tried.run.trace)
    findings = path.tried.report.findings
    first = min(last if finding.event is None else finding.event for finding in findings)
    before = [one for one in path.passed if one.events <= first]
    return (before[-1].node, before[-1].taken) if before else None
