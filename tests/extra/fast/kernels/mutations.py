"""Traces of right runs in which a few events are changed, by lot."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from random import Random
from typing import TypeVar

from msgspec.structs import replace

from topo_verify import CATALOGUE, World, explore
from topo_verify.algorithms.policies import ORDERS, PICKS
from topo_verify.extra.fast.kernels.events import CONTRADICTIONS, RULES
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import exit_dart, percepts
from topo_verify.world.enumeration import rank_order

T = TypeVar("T")

SIZES = (1, 2, 2, 3, 3, 4, 4, 5, 6, 7, 8, 9)
"""Edges of the worlds; small ones are drawn more often."""

TRACES_OF_A_RUN = 6

KINDS = (ev.Pose, ev.Reject, ev.Confirm, ev.Augment)


def mutated_traces(seed: int, number: int) -> Iterator[tuple[World, ev.Trace]]:
    draw = Random(seed)
    while number > 0:
        edges = draw.choice(SIZES)
        world = World.from_id(f"m{edges}/{draw.randrange(rank_order.count(edges))}")
        name, pick, order = (draw.choice([*names]) for names in (CATALOGUE, PICKS, ORDERS))
        trace = explore(world, name, pick=pick, order=order).trace
        mutation = Mutation(draw, world)
        for _ in range(min(number, TRACES_OF_A_RUN)):
            yield world, mutation.of_trace(trace)
        number -= TRACES_OF_A_RUN


class Mutation:
    """Changes events of traces in this world."""

    def __init__(self, draw: Random, world: World) -> None:
        self._draw, self._world, self._percepts = draw, world, percepts(world)

    # ------------------------------------------------------------ the trace

    def of_trace(self, trace: ev.Trace) -> ev.Trace:
        draw, events = self._draw, list(trace)
        for _ in range(draw.choice((0, 1, 1, 1, 2, 2, 3, 5))):
            if len(events) > 2:
                self._change(events, draw.randrange(1, len(events) - 1))
        last = events[-1]
        if isinstance(last, ev.Finish) and draw.random() < 0.25:
            events[-1] = self._of_finish(last)
        if draw.random() < 0.05 and len(events) > 3:
            del events[draw.randrange(2, len(events)) :]
        return tuple(self._seen(events) if draw.random() < 0.85 else events)

    def _change(self, events: list[ev.Event], place: int) -> None:
        draw = self._draw
        how = draw.randrange(9)
        if how == 0:
            del events[place]
        elif how == 1:
            events.insert(draw.randrange(1, len(events)), events[place])
        elif how == 2 and place + 2 < len(events):
            events[place : place + 2] = events[place + 1], events[place]
        elif how == 3:
            for _ in range(draw.randrange(1, 6)):
                events.insert(place, ev.Move(draw.randrange(3), Percept(1, None)))
        elif how == 4:
            silent = draw.sample(KINDS, draw.choice((1, 1, 2)))
            since = draw.choice((0, place))
            events[since:] = [event for event in events[since:] if type(event) not in silent]
        else:
            events[place] = self._of_event(events[place])

    def _seen(self, events: list[ev.Event]) -> Iterator[ev.Event]:
        """The events with the percepts of the world, up to a door that does not exist."""
        world, at = self._world, self._world.root
        for event in events:
            if isinstance(event, ev.Move) and at is not None:
                if 0 <= event.door < world.degrees[world.vertex_of[at]]:
                    at = world.alpha[exit_dart(world, at, event.door)]
                    event = replace(event, percept=self._percepts[at])  # noqa: PLW2901
                else:
                    at = None
            yield event

    # ------------------------------------------------------------ an event

    def _of_event(self, event: ev.Event) -> ev.Event:
        match event:
            case ev.Move(door, percept):
                return self._one_of(
                    *4 * [lambda: replace(event, door=self._near(door, 5))],
                    lambda: replace(event, percept=self._percept() or percept),
                )
            case ev.Pose():
                return self._of_pose(event)
            case ev.Reject(_, _, _, evidence):
                return self._one_of(
                    lambda: replace(event, edge=self._dart()),
                    lambda: replace(event, hypothesis=self._dart()),
                    lambda: replace(event, rule=self._draw.choice(RULES)),
                    lambda: replace(event, evidence=self._of_evidence(evidence)),
                    lambda: replace(event, evidence=self._of_evidence(evidence)),
                )
            case ev.Confirm():
                return self._one_of(
                    lambda: replace(event, edge=self._dart()),
                    lambda: replace(event, hypothesis=self._dart()),
                    lambda: replace(event, rule=self._draw.choice(RULES)),
                )
            case ev.Augment(edge, kind, dart):
                return self._one_of(
                    lambda: replace(event, edge=self._dart()),
                    lambda: replace(event, dart=self._dart()),
                    lambda: replace(event, degree=self._draw.randrange(6)),
                    lambda: replace(event, kind="new" if kind == "loop" else "loop"),
                    lambda: replace(event, edge=dart, dart=edge),
                )
            case _:
                return event

    def _of_pose(self, pose: ev.Pose) -> ev.Pose:
        draw, posed = self._draw, list(pose.hypotheses)
        how = draw.randrange(5)
        if how == 0:
            return replace(pose, edge=self._dart())
        if how == 1:
            posed.append(self._dart())
        elif how == 2 and posed:
            posed.append(draw.choice(posed))
        elif how == 3 and posed:
            del posed[draw.randrange(len(posed))]
        else:
            draw.shuffle(posed)
        return replace(pose, hypotheses=tuple(posed))

    def _of_evidence(self, cited: ev.Evidence) -> ev.Evidence:
        draw = self._draw
        return self._one_of(
            lambda: replace(cited, step=self._near(cited.step, 2)),
            lambda: replace(cited, expected=self._percept()),
            lambda: replace(cited, observed=self._percept()),
            lambda: replace(cited, expected=cited.observed, observed=cited.expected),
            lambda: replace(cited, sequence=draw.choice((None, -1, 0, 1, 2, 7))),
            lambda: replace(cited, at=draw.choice((None, self._dart()))),
            lambda: replace(cited, record=draw.choice((None, self._record()))),
            lambda: replace(cited, contradiction=draw.choice(CONTRADICTIONS) or None),
        )

    # ------------------------------------------------------------ the map

    def _of_finish(self, finish: ev.Finish) -> ev.Finish:
        cost, drawn = finish.cost, finish.map
        return self._one_of(
            lambda: replace(
                finish, cost=self._draw.choice((None, -1, 0, (cost or 0) + 1, -2, 2**40))
            ),
            lambda: replace(finish, map=replace(drawn, marker=self._draw.choice((None, 0, 1)))),
            lambda: replace(finish, map=ev.MapData((), (), None)),
            lambda: replace(finish, map=self._turned(drawn)),
            lambda: replace(finish, map=self._crossed(drawn)),
            lambda: replace(finish, map=self._renamed(drawn)),
        )

    def _turned(self, drawn: ev.MapData) -> ev.MapData:
        vertices = list(drawn.vertices)
        place = self._draw.randrange(len(vertices))
        vertices[place] = tuple(self._draw.sample(vertices[place], len(vertices[place])))
        return replace(drawn, vertices=tuple(vertices))

    def _crossed(self, drawn: ev.MapData) -> ev.MapData:
        """With two edges that exchange their ends."""
        edges = self._draw.sample(drawn.edges, len(drawn.edges))
        if len(edges) > 1:
            (a, b), (c, d), *rest = edges
            edges = [(a, d), (c, b), *rest]
        return replace(drawn, edges=tuple(edges))

    def _renamed(self, drawn: ev.MapData) -> ev.MapData:
        """The same map with other numbers for its darts."""
        darts = [dart for vertex in drawn.vertices for dart in vertex]
        numbers = self._draw.sample(range(-50, 50 + len(darts)), len(darts))
        name = dict(zip(darts, numbers, strict=True))
        return ev.MapData(
            tuple(tuple(name[dart] for dart in vertex) for vertex in drawn.vertices),
            tuple(tuple(name[dart] for dart in edge) for edge in drawn.edges),
            None if drawn.marker is None else name[drawn.marker],
        )

    # ------------------------------------------------------------ numbers

    def _one_of(self, *ways: Callable[[], T]) -> T:
        return self._draw.choice(ways)()

    def _dart(self) -> int:
        size = len(self._world.alpha)
        inside, long = self._draw.randrange(size), self._draw.choice((-(2**62), 2**62, 2**64))
        near = self._draw.randrange(-3, 70)
        return self._draw.choice((*4 * [inside], -1, -1, size, size, near, long))

    def _near(self, number: int, below: int) -> int:
        draw = self._draw
        return draw.choice((0, 1, number + 1, max(0, number - 1), draw.randrange(below), -1))

    def _percept(self) -> Percept | None:
        degree = self._draw.randrange(1, 6)
        other = self._draw.choice(self._percepts)
        return self._draw.choice((None, Percept(degree, None), Percept(degree, 0), other))

    def _record(self) -> ev.Record:
        doors = (self._draw.randrange(3) for _ in range(self._draw.randrange(3)))
        return ev.Record(self._dart(), tuple(doors))
