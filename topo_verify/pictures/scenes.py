"""What each event of a run means, beside the world: the model behind every view of a run.

S is kept twice: as the mapper declares it (`Playback.map_at`, `Moment.growth`), and as far as it is
true (`Playback.map`, with the dart of the world for each dart of S). `WorldDart` and `KnownDart`
never mix; a plain `int` is a declared dart of S, which S need not have.

What this does not show: what a mapper thinks.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, NamedTuple

from topo_verify.checkers import Finding, Judgement
from topo_verify.checkers.darts import KnownDart, WorldDart
from topo_verify.checkers.excursions import Word
from topo_verify.checkers.map_in_world import MapInWorld
from topo_verify.checkers.replayed_trace import ReplayedTrace, Round
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Door
from topo_verify.robot.simulator import exit_dart
from topo_verify.world.rooted_map import World


class Spent(NamedTuple):
    """Edge traversals by the purpose that the mapper stated."""

    walk: int = 0
    cross: int = 0
    validate: int = 0
    retrace: int = 0
    unsaid: int = 0

    @property
    def cost(self) -> int:
        """All edge traversals, whatever their purpose."""
        return sum(self)


class Growth(NamedTuple):
    """What S grows by, as declared.

    Attributes:
        edge, dart: the two ends of the edge that is explored now.
        kind: `new`: the vertex of `dart` is new, and `dart` is its first; or `loop`.
        degree: of the vertex behind `edge`.
        true: whether it is so in the world; None after an illegal move or a false map.
    """

    edge: int
    kind: Literal["new", "loop"]
    dart: int
    degree: int
    true: bool | None


class Mismatch(NamedTuple):
    """Where the evidence of a rejection lies, in the world and on S.

    Attributes:
        sequence: which sequence of this edge shows it, from 0; None: the moves just made, or none.
        doors: the doors from vu to there.
        trail: the reference darts in the world at vu and behind each door.
        traced: the same on S, if the hypothesis were true, as far as S goes.
        leaves: the unexplored dart by which the doors leave S, or None.
        evidence: as the mapper cites it.
    """

    sequence: int | None
    doors: tuple[Door, ...]
    trail: tuple[WorldDart, ...]
    traced: tuple[KnownDart, ...]
    leaves: KnownDart | None
    evidence: ev.Evidence


@dataclass(frozen=True, slots=True)
class Moment:
    """One event, and the state after it.

    Attributes:
        number: the index of the event in the trace.
        position: the reference dart in the world; None from an illegal move on.
        known: the same on S, where S knows the place.
        left_by: of a move: the dart of the world by which the robot left.
        through: of a move: the same dart on S, or None.
        spent: edge traversals so far.
        edge: the dart of S whose other end is in question, or None.
        hypotheses: the darts posed for it and not yet decided.
        growth: of an augmentation.
        recorded: of an augmentation: what is known from now on behind unexplored darts of S.
        mismatch: of a rejection that can be judged.
        word: of a decision that can be judged: the doors from vu, and the percept behind each.
        findings: what is wrong at this event.
    """

    number: int
    event: ev.Event
    position: WorldDart | None
    known: KnownDart | None
    left_by: WorldDart | None
    through: KnownDart | None
    spent: Spent
    edge: int | None
    hypotheses: tuple[int, ...]
    growth: Growth | None
    recorded: tuple[tuple[KnownDart, Word], ...]
    mismatch: Mismatch | None
    word: Word
    findings: tuple[Finding, ...]


class DeclaredMap(NamedTuple):
    """S as the mapper declares it.

    Attributes:
        vertices: the first dart of each vertex, and its degree, which may be any number.
        edges: in the order of their exploration.
    """

    vertices: tuple[tuple[int, int], ...]
    edges: tuple[tuple[int, int], ...]


class Playback:
    """A run, event by event.

    Args:
        stopped: why the mapper ended without a map, or None.
    Attributes:
        findings: all that is wrong, in the order of the claims.
    Raises:
        InputError: the trace does not begin with its only `start`, or goes on after `finish`.
    """

    def __init__(
        self,
        world: World,
        trace: Sequence[ev.Event],
        judgements: Iterable[Judgement] = (),
        stopped: str | None = None,
    ) -> None:
        self.world, self.trace, self.stopped = world, tuple(trace), stopped
        self.replayed = ReplayedTrace(world, self.trace, stopped)
        self.findings = tuple(finding for judgement in judgements for finding in judgement.findings)
        self.moments = tuple(self._moments())

    @property
    def map(self) -> MapInWorld:
        """S as far as it is true; its `phi` gives the world's dart of a dart of S."""
        return self.replayed.map

    @property
    def cost(self) -> int:
        """The number of moves."""
        return self.replayed.cost

    @cached_property
    def first_finding(self) -> Finding | None:
        """The finding with the earliest event, else the first about the run as a whole; or None."""
        last = len(self.trace)
        when = {id(f): last if f.event is None else f.event for f in self.findings}
        return min(self.findings, key=lambda finding: when[id(finding)], default=None)

    @property
    def about_the_run(self) -> tuple[Finding, ...]:
        """The findings without an event."""
        return tuple(finding for finding in self.findings if finding.event is None)

    def map_at(self, number: int) -> DeclaredMap:
        """S after this event, as declared."""
        start = self.trace[0]
        assert isinstance(start, ev.Start)
        vertices, edges = [(0, start.percept.degree)], list[tuple[int, int]]()
        for event in self.trace[: number + 1]:
            if isinstance(event, ev.Augment):
                edges.append((event.edge, event.dart))
                if event.kind == "new":
                    vertices.append((event.dart, event.degree))
        return DeclaredMap(tuple(vertices), tuple(edges))

    def known(self, dart: WorldDart, number: int) -> KnownDart | None:
        """This dart of the world on S after an event; None where S does not have it."""
        known = self.map.number.get(dart)
        return known if known is not None and self.map.born[known] <= number else None

    def vertex(self, dart: KnownDart) -> int:
        """The vertex of a dart of S: 0 is v0, the others follow in order of discovery."""
        return bisect_right(self._firsts, dart) - 1

    def door(self, stands: WorldDart, out: WorldDart) -> Door:
        """The door that means the dart `out` to a robot with this reference dart, at its vertex."""
        places, degree = self.world.place_of, self.map.seen_at(stands).degree
        return (places[out] - places[stands]) % degree

    @cached_property
    def _firsts(self) -> list[KnownDart]:
        darts = sorted(self.map.phi)
        vertices = [self.world.vertex_of[self.map.phi[dart]] for dart in darts]
        return [d for d in darts if d == 0 or vertices[d] != vertices[d - 1]]

    def darts(self, vertex: int) -> Iterator[KnownDart]:
        """The darts of a vertex of S, ascending."""
        first = self._firsts[vertex]
        degree = self.map.seen_at(self.map.phi[first]).degree
        return map(KnownDart, range(first, first + degree))

    # ------------------------------------------------------------ how it is made

    def _moments(self) -> Iterator[Moment]:
        rounds = {judged.when: judged for judged in self.replayed.rounds}
        marks: dict[int | None, tuple[Finding, ...]] = {}
        for finding in self.findings:
            marks[finding.event] = (*marks.get(finding.event, ()), finding)
        spent, edge = Spent(), None
        hypotheses: tuple[int, ...] = ()
        for number, event in enumerate(self.trace):
            left_by = through = None
            if isinstance(event, ev.Move):
                purpose = event.purpose or "unsaid"
                spent = spent._replace(**{purpose: getattr(spent, purpose) + 1})
                left_by, through = self._left_by(number, event)
            else:
                edge, hypotheses = _question(event, edge, hypotheses)
            position = self._position(number)
            judged = rounds.get(number)
            yield Moment(
                number=number,
                event=event,
                position=position,
                known=None if position is None else self.known(position, number),
                left_by=left_by,
                through=through,
                spent=spent,
                edge=edge,
                hypotheses=hypotheses,
                growth=self._growth(number, event) if isinstance(event, ev.Augment) else None,
                recorded=() if judged is None else tuple(self._recorded(judged)),
                mismatch=None if judged is None else self._mismatch(judged),
                word=() if judged is None else judged.word,
                findings=marks.get(number, ()),
            )

    def _position(self, number: int) -> WorldDart | None:
        return self.replayed.positions[number] if number < len(self.replayed.positions) else None

    def _left_by(self, number: int, move: ev.Move) -> tuple[WorldDart | None, KnownDart | None]:
        before = self._position(number - 1)
        if before is None or not 0 <= move.door < self.map.seen_at(before).degree:
            return None, None
        dart = WorldDart(exit_dart(self.world, before, move.door))
        return dart, self.known(dart, number)

    def _growth(self, number: int, event: ev.Augment) -> Growth:
        spoiled = self.replayed.spoiled
        judged = number < len(self.replayed.positions) and (spoiled is None or number <= spoiled)
        true = number != spoiled if judged else None
        return Growth(event.edge, event.kind, event.dart, event.degree, true)

    def _recorded(self, judged: Round) -> Iterator[tuple[KnownDart, Word]]:
        if judged.when == self.replayed.spoiled or not (
            isinstance(judged.event, ev.Augment) and judged.pose
        ):
            return
        for sequence in judged.sequences:
            dart = KnownDart(judged.event.dart)
            at, rest = self.replayed.records.trace(dart, sequence, judged.when + 1)
            if rest:
                yield at, rest

    def _mismatch(self, judged: Round) -> Mismatch | None:
        event, chart = judged.event, self.map
        if not isinstance(event, ev.Reject) or judged.pose is None:
            return None
        if not chart.is_open(event.edge, judged.when) or not chart.is_open(
            event.hypothesis, judged.when
        ):
            return None
        cited = event.evidence
        words = (judged.word,) if cited.sequence is None else judged.sequences
        if event.rule in ("folding", "planar"):
            words = ((),)
        place = cited.sequence or 0
        if not (0 <= place < len(words) and 0 <= cited.step <= len(words[place])):
            return None
        doors = tuple(step.door for step in words[place][: cited.step])
        trail = [chart.end(event.edge)]
        for door in doors:
            trail.append(chart.beyond(trail[-1], door))
        traced, leaves = [KnownDart(event.hypothesis)], None
        for door in doors:
            out = chart.turn(traced[-1], door)
            if chart.is_open(out, judged.when):
                leaves = out
                break
            traced.append(chart.alpha[out])
        return Mismatch(cited.sequence, doors, tuple(trail), tuple(traced), leaves, cited)


def _question(
    event: ev.Event, edge: int | None, open_hypotheses: tuple[int, ...]
) -> tuple[int | None, tuple[int, ...]]:
    match event:
        case ev.Pose():
            return event.edge, event.hypotheses
        case ev.Reject(hypothesis=h) | ev.Confirm(hypothesis=h):
            return edge, tuple(dart for dart in open_hypotheses if dart != h)
        case ev.Augment():
            return None, ()
        case _:
            return edge, open_hypotheses
