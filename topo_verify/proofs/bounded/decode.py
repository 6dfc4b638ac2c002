"""What a model says happens: from the rows of an encoding to a world, a map, and doors.

Nothing is judged here: `replaying.py` does it all again in the simulator.
"""

from __future__ import annotations

from dataclasses import dataclass

from topo_verify.algorithms.chart import Dart
from topo_verify.proofs.bounded.cnf import Row
from topo_verify.proofs.bounded.encoding import Map, Worlds
from topo_verify.proofs.bounded.solve import Model
from topo_verify.proofs.bounded.word_rules import Play
from topo_verify.robot.percept import Door
from topo_verify.world.enumeration.rank_order import Table
from topo_verify.world.rooted_map import World

Word = tuple[Door, ...]


@dataclass(frozen=True, slots=True)
class Behind:
    """An excursion: the explored edges before it, the dart crossed, the doors taken behind it."""

    explored: frozenset[tuple[Dart, Dart]]
    e: Dart
    word: Word


@dataclass(frozen=True, slots=True, kw_only=True)
class Story:
    """What a model says happens. Darts are those of S, and of the world: they are one numbering.

    Attributes:
        explored: the edges of S, lesser dart first; v0 is known besides.
        word: the doors executed behind e; own: those of the hypothesis' own way home.
        turned: the door of an excursion behind e that came first, or None.
        earlier: what was executed behind another edge before, for records; and how deep they go.
    """

    world: World
    explored: frozenset[tuple[Dart, Dart]]
    e: Dart
    h: Dart
    word: Word
    own: Word
    turned: Door | None = None
    earlier: Behind | None = None
    levels: int | None = None


def decode_table(world: Worlds, model: Model) -> Table:
    """Degrees and alpha of a model, as they are numbered there."""
    held = sorted(place for place, vertex in world.vertex.items() if model.holds(vertex))
    alpha = [0] * len(world.darts)
    for (a, b), joined in world.joined.items():
        if model.holds(joined):
            alpha[a], alpha[b] = b, a
    return tuple(degree for _, degree in held), tuple(alpha)


def decode_world(world: Worlds, model: Model) -> World:
    """The world of a model, its darts as they are numbered there."""
    return World.from_code(decode_table(world, model))


def telling(play: Play) -> Row:
    """The Booleans from which `decode` makes the story; the rest follows, or does not matter."""
    maps = [play.chart] if play.earlier is None else [play.earlier.chart, play.chart]
    rows = [play.world.first, tuple(play.world.joined.values())]
    rows += [row for chart in maps for row in (chart.known, chart.explored)]
    rows += [play.e, play.h, play.made or (), *play.executed, *play.own]
    rows += [] if play.turned is None else [play.turned]
    rows += [] if play.earlier is None else [play.earlier.e, *play.earlier.executed]
    return tuple(literal for row in rows for literal in row)


def decode(play: Play, model: Model) -> Story:
    """What the model says happens."""
    world = decode_world(play.world, model)
    made = sum(map(model.holds, play.made)) if play.made is not None else None
    own = play.own or play.executed
    behind = play.earlier
    return Story(
        world=world,
        explored=_edges(world, play.chart, model),
        e=model.index(play.e),
        h=model.index(play.h),
        word=_word(play.executed if play.own else play.executed[:made], model),
        own=_word(own[:made], model),
        turned=None if play.turned is None else model.index(play.turned),
        earlier=None
        if behind is None
        else Behind(
            _edges(world, behind.chart, model),
            model.index(behind.e),
            _word(behind.executed, model),
        ),
        levels=play.levels,
    )


def _word(rows: tuple[Row, ...], model: Model) -> Word:
    return tuple(model.index(row) for row in rows)


def _edges(world: World, chart: Map, model: Model) -> frozenset[tuple[Dart, Dart]]:
    return frozenset(edge for edge in world.edges if model.holds(chart.explored[edge[0]]))
