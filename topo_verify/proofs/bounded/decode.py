"""Decoding: from an assignment of an encoding to a world, a map and doors.

Nothing is judged here; `replay.py` repeats what was decoded in the simulator.
"""

from __future__ import annotations

from dataclasses import dataclass

from topo_verify.proofs.bounded.cnf import CnfRow
from topo_verify.proofs.bounded.encoding import EncodedMap, Worlds
from topo_verify.proofs.bounded.solve import Assignment
from topo_verify.proofs.bounded.word_rules import EncodedCounterexample
from topo_verify.robot.events import MapDart
from topo_verify.robot.percept import Door
from topo_verify.world.enumeration.rank_order import Table
from topo_verify.world.rooted_map import World

DoorWord = tuple[Door, ...]


@dataclass(frozen=True, slots=True)
class EarlierExcursion:
    """An earlier excursion: the explored edges before it, the dart crossed, the doors behind it."""

    explored: frozenset[tuple[MapDart, MapDart]]
    e: MapDart
    word: DoorWord


@dataclass(frozen=True, slots=True, kw_only=True)
class BoundedCounterexample:
    """A decoded counterexample. The darts of S and of the world have one numbering.

    Attributes:
        explored: the edges of S, smaller dart first; S knows v0 besides.
        e, h: the dart that was crossed, and the hypothesis for its other end.
        word: the doors executed behind e.
        own: the doors of the hypothesis' own way home.
        turned: the door of a first excursion behind e, or None.
        earlier: for records, the excursion behind another edge that was recorded before.
        levels: for records, the depth to which they are compared; None: any depth.
    """

    world: World
    explored: frozenset[tuple[MapDart, MapDart]]
    e: MapDart
    h: MapDart
    word: DoorWord
    own: DoorWord
    turned: Door | None = None
    earlier: EarlierExcursion | None = None
    levels: int | None = None


def decode_table(world: Worlds, model: Assignment) -> Table:
    """The degrees and alpha of an assignment, with its numbers of darts."""
    # (first dart, degree) of each vertex: sorted, they stand in the order of their darts.
    held = sorted(place for place, vertex in world.vertex.items() if model.holds(vertex))
    alpha = [0] * len(world.darts)
    for (a, b), joined in world.joined.items():
        if model.holds(joined):
            alpha[a], alpha[b] = b, a
    return tuple(degree for _, degree in held), tuple(alpha)


def decode_world(world: Worlds, model: Assignment) -> World:
    """The world of an assignment, with its numbers of darts."""
    return World.from_code(decode_table(world, model))


def decoded_booleans(encoded: EncodedCounterexample) -> CnfRow:
    """The Booleans that `decode` reads; the others follow from them, or do not matter."""
    # Their order decides which counterexample comes first, so a new one belongs at the end.
    maps = [encoded.chart] if encoded.earlier is None else [encoded.earlier.chart, encoded.chart]
    rows = [encoded.world.first, tuple(encoded.world.joined.values())]
    rows += [row for chart in maps for row in (chart.known, chart.explored)]
    rows += [encoded.e, encoded.h, encoded.made or (), *encoded.executed, *encoded.own]
    rows += [] if encoded.turned is None else [encoded.turned]
    rows += [] if encoded.earlier is None else [encoded.earlier.e, *encoded.earlier.executed]
    return tuple(literal for row in rows for literal in row)


def decode(encoded: EncodedCounterexample, model: Assignment) -> BoundedCounterexample:
    """The counterexample that an assignment encodes."""
    world = decode_world(encoded.world, model)
    # The steps that are made are a prefix of the word, so their number says which they are.
    made = sum(map(model.holds, encoded.made)) if encoded.made is not None else None
    # Only `prefix` tells the two apart. There `made` speaks of the own way, and the executed word
    # is taken whole.
    own = encoded.own or encoded.executed
    behind = encoded.earlier
    return BoundedCounterexample(
        world=world,
        explored=_edges(world, encoded.chart, model),
        e=model.index(encoded.e),
        h=model.index(encoded.h),
        word=_word(encoded.executed if encoded.own else encoded.executed[:made], model),
        own=_word(own[:made], model),
        turned=None if encoded.turned is None else model.index(encoded.turned),
        earlier=None
        if behind is None
        else EarlierExcursion(
            _edges(world, behind.chart, model),
            model.index(behind.e),
            _word(behind.executed, model),
        ),
        levels=encoded.levels,
    )


def _word(rows: tuple[CnfRow, ...], model: Assignment) -> DoorWord:
    return tuple(model.index(row) for row in rows)


def _edges(
    world: World, chart: EncodedMap, model: Assignment
) -> frozenset[tuple[MapDart, MapDart]]:
    return frozenset(edge for edge in world.edges if model.holds(chart.explored[edge[0]]))
