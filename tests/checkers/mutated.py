"""Real traces with faults planted by a seeded generator: the same traces at each run.

Unlike doctored.py, whose examples differ from run to run, these can be compared between versions.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from random import Random
from typing import Any, NamedTuple

from msgspec.structs import replace

from topo_verify import World, explore
from topo_verify.algorithms import CATALOGUE, NAMED
from topo_verify.checkers import folding as f
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import exit_dart, percepts
from topo_verify.world.enumeration import rank_order

CITED = (None, f.UNLIKE, f.TURNED, f.OWN_END, f.TWO_OF_S, "it lies on another face than e")
RULES = ("motion", "prefix", "history", "records", "folding", "planar")
FIELDS = {
    *("door", "edge", "hypothesis", "dart", "degree", "step", "sequence", "at", "cost", "marker"),
    *("hypotheses", "doors", "vertices", "edges", "rule", "kind", "contradiction"),
    *("percept", "expected", "observed", "evidence", "record", "map"),
}
"""What is judged of an event."""


class Mutated(NamedTuple):
    """A trace to judge in a world, and why its run is said to have stopped."""

    world: World
    trace: ev.Trace
    stopped: str | None


def mutated_traces(seed: int, runs: int, *, most_edges: int = 7) -> Iterator[Mutated]:
    """Five traces of each run of a catalogue mapper, with 0 … 5 faults."""
    random = Random(seed)
    for _ in range(runs):
        edges = random.randrange(1, most_edges + 1)
        world = World.from_id(f"m{edges}/{random.randrange(rank_order.count(edges))}")
        mapper = random.choice(sorted(NAMED))
        pick, order = random.choice(("nearest", "last")), random.choice(("shortest", "newest"))
        chooses = mapper in CATALOGUE
        run = explore(
            world, mapper, pick=pick if chooses else None, order=order if chooses else None
        )
        for _ in range(5):
            stopped = None if random.randrange(9) else "it was stopped"
            yield Mutated(world, _Faults(random, world).planted(run.trace), stopped)


class _Faults:
    """Plants faults in traces of one world."""

    def __init__(self, random: Random, world: World) -> None:
        self.random, self.world = random, world
        self.percepts = percepts(world)

    def planted(self, real: ev.Trace) -> ev.Trace:
        """The trace with faults; mostly with the percepts that its doors then show."""
        trace: list[ev.Event] = [*real]
        for _ in range(self.random.choice((0, 1, 1, 1, 2, 2, 3, 5))):
            trace = self._changed(trace)
        if self.random.random() < 0.06:
            del trace[self.random.randrange(1, len(trace)) :]
        return tuple(self._seen(trace) if self.random.random() < 0.85 else trace)

    def _changed(self, trace: list[ev.Event]) -> list[ev.Event]:
        random = self.random
        if len(trace) < 3:
            return trace
        at, change = random.randrange(1, len(trace) - 1), random.randrange(10)
        if change == 0:
            del trace[at]
        elif change == 1:
            trace.insert(random.randrange(1, len(trace) - 1), trace[at])
        elif change == 2 and at > 1:
            trace[at - 1 : at + 1] = trace[at], trace[at - 1]
        elif change == 3:
            trace[at:at] = [ev.Move(random.randrange(4), self._percept()) for _ in range(at % 4)]
        elif change == 4:
            kinds, since = random.sample(ev.DECISIONS, 1 + at % 2), random.choice((0, at))
            return [e for place, e in enumerate(trace) if place < since or type(e) not in kinds]
        elif change == 5 and random.random() < 0.5:
            trace[0] = self._edited(trace[0])
        elif change == 6:
            trace[-1] = self._edited(trace[-1])
        else:
            trace[at] = self._edited(trace[at])
        return trace

    def _edited(self, struct: Any) -> Any:
        """The struct with one field changed, or one within it."""
        name = self.random.choice([name for name in struct.__struct_fields__ if name in FIELDS])
        value = getattr(struct, name)
        if isinstance(value, ev.Evidence | ev.Record | ev.MapData | Percept):
            return replace(struct, **{name: self._edited(value)})
        return replace(struct, **{name: self._near(name, value)})

    def _near(self, name: str, value: Any) -> Any:
        random = self.random
        if name == "rule":
            return random.choice(RULES)
        if name == "kind":
            return "loop" if value == "new" else "new"
        if name == "contradiction":
            return random.choice(CITED)
        if name in ("percept", "expected", "observed"):
            return self._percept()
        if isinstance(value, tuple):
            return self._near_row([*value], of_rows=name in ("vertices", "edges"))
        near = (self._number(), self._number(), (value or 0) + 1, (value or 0) - 1)
        return random.choice(near if name != "sequence" else (None, 0, 1, *near))

    def _near_row(self, row: list[Any], *, of_rows: bool) -> tuple[Any, ...]:
        random = self.random
        if row and random.random() < 0.4:
            row.insert(random.randrange(len(row)), row.pop(random.randrange(len(row))))
        elif row and random.random() < 0.3:
            del row[random.randrange(len(row))]
        elif of_rows and row:
            at = random.randrange(len(row))
            row[at] = self._near_row([*row[at]], of_rows=False)
        else:
            row.append((self._number(),) if of_rows else self._number())
        return tuple(row)

    def _number(self) -> int:
        darts = len(self.world.alpha)
        numbers: tuple[int, ...] = (*range(darts), *range(darts), -1, darts, darts + 1, 2**60)
        return numbers[self.random.randrange(len(numbers))]

    def _percept(self) -> Percept:
        degree = self.random.randrange(1, 6)
        return self.random.choice((Percept(degree, None), Percept(degree, 0), *self.percepts))

    def _seen(self, trace: Sequence[ev.Event]) -> Iterator[ev.Event]:
        """The trace with the percepts of the world, up to a door that is not there."""
        at: int | None = self.world.root
        for event in trace:
            if isinstance(event, ev.Move) and at is not None:
                degree = self.percepts[at].degree
                at = self.world.alpha[exit_dart(self.world, at, event.door)]
                yield replace(event, percept=self.percepts[at])
                if not 0 <= event.door < degree:
                    at = None
            else:
                yield event
