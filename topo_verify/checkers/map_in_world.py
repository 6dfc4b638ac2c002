"""The map S beside the world: which dart of the world each dart of S is.

Trusted. S is drawn from the declared augmentations, as far as they are true. It only grows, so one
drawing is S at every moment; questions name an event.

    phi      S -> world: which dart of the world a dart of S is
    across   world -> world: the other end of each edge
    number   world -> S: the inverse of phi
    vertices the darts of each vertex of S, clockwise from its first
    alpha    S -> S: the other end of each explored edge
    born     the event at which a dart of S appeared     (S at event i: the darts born before i)
    joined   the event at which it was explored, or NEVER
"""

from __future__ import annotations

import sys
from typing import TypeGuard, cast

from topo_verify.checkers.darts import KnownDart, WorldDart
from topo_verify.robot.events import Augment, MapData
from topo_verify.robot.percept import Door, Percept
from topo_verify.robot.simulator import exit_dart, first_percept, percepts
from topo_verify.world.rooted_map import World

NEVER = sys.maxsize


class MapInWorld:
    """S, from v0 alone to the whole world. Grows by `grow`, as a trace is read."""

    def __init__(self, world: World) -> None:
        self.world = world
        self._percepts = percepts(world) or (first_percept(world),)
        self.across = cast("tuple[WorldDart, ...]", world.alpha)
        self.phi: dict[KnownDart, WorldDart] = {}
        self.number: dict[WorldDart, KnownDart] = {}
        self.vertices: list[tuple[KnownDart, ...]] = []
        self.alpha: dict[KnownDart, KnownDart] = {}
        self.born: list[int] = []
        self.joined: list[int] = []
        if world.root is not None:
            self._add_vertex(WorldDart(world.root), 0)

    # ------------------------------------------------------------ the world

    def seen_at(self, dart: WorldDart) -> Percept:
        """The percept in the world with this reference dart."""
        return self._percepts[dart]

    def beyond(self, dart: WorldDart, door: Door) -> WorldDart:
        """The reference dart in the world after leaving by a door."""
        return self.across[exit_dart(self.world, dart, door)]

    def end(self, e: KnownDart) -> WorldDart:
        """The dart of the world at the other end of a dart of S."""
        return self.across[self.phi[e]]

    # ------------------------------------------------------------ S

    def is_world(self, delivered: MapData) -> bool:
        """Whether S is the whole world, and was delivered as it was declared."""
        edges = tuple([edge for edge in sorted(self.alpha.items()) if edge[0] < edge[1]])
        is_whole = len(self.alpha) == len(self.world.alpha)
        return is_whole and delivered == MapData(tuple(self.vertices), edges, 0)

    def grow(self, when: int, event: Augment) -> bool:
        """Let S grow by an augmentation; False, and no change, if it is not true here."""
        edge = event.edge
        if not self.is_open(edge, when):
            return False
        end = self.end(edge)
        is_new, here = end not in self.number, self.number.get(end, KnownDart(len(self.phi)))
        truth = is_new, here, self.seen_at(end).degree
        if (event.kind == "new", event.dart, event.degree) != truth:
            return False
        if is_new:
            self._add_vertex(end, when)
        for dart, other in ((edge, here), (here, edge)):
            self.alpha[dart], self.joined[dart] = other, when
        return True

    def _add_vertex(self, entry: WorldDart, when: int) -> None:
        rotation = self.world.vertices[self.world.vertex_of[entry]]
        first, place, degree = len(self.phi), self.world.place_of[entry], len(rotation)
        darts = cast("list[KnownDart]", [*range(first, first + degree)])
        images = cast("tuple[WorldDart, ...]", rotation[place:] + rotation[:place])
        self.vertices.append(tuple(darts))
        self.phi |= zip(darts, images, strict=True)
        self.number |= zip(images, darts, strict=True)
        self.born += [when] * degree
        self.joined += [NEVER] * degree

    def is_open(self, dart: int, when: int) -> TypeGuard[KnownDart]:
        """Whether this is an unexplored dart of S at event `when`."""
        return 0 <= dart < len(self.born) and self.born[dart] < when <= self.joined[dart]

    def turn(self, dart: KnownDart, door: Door) -> KnownDart:
        """The dart of S behind a door for a robot with reference dart `dart` on S."""
        return self.number[WorldDart(exit_dart(self.world, self.phi[dart], door))]
