"""When two moments of two runs in one world are the same state: then what may follow is the same.

A state, in darts of the world:

    S          the explored edges, and of each known vertex the dart by which it was entered first:
               darts are numbered from it, and so ties between shortest paths go by it
    where      between two edges: the robot's vertex. Behind e: e, the hypotheses that remain, and
               under a motion other than `retrace` the last sequence, at whose end the robot stands
    memory     what the rule remembers

The reference dart of the robot only renames doors. Under `retrace` the robot always goes back to
vu, so the way back belongs to the hypothesis that was tried, not to the next choice (`owed`).

What rules remember. `none`, `prefix` and `history` have compared each sequence when it was new, and
keep nothing. `records` keeps T, and behind e the set of sequences that T will learn from. `folding`
keeps its fold, whose nodes are numbered here as they are found from v0 on; `planar` adds nothing.
Of any other rule nothing is known. So its memory is all that it holds, and all sequences in their
order, and S is in the order of its discovery: fewer moments are the same, none wrongly.
"""

from __future__ import annotations

import pickle
from collections.abc import Hashable, Iterator, Sequence

from topo_verify.algorithms import Rule
from topo_verify.algorithms.basic import NoRule
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.enhancement_i import PrefixRule
from topo_verify.algorithms.enhancement_ii import HistoryRule
from topo_verify.algorithms.enhancement_iii import RecordsRule, Seen
from topo_verify.algorithms.folding import FoldingRule, NodeDart, PartialFold
from topo_verify.algorithms.motion import Executed, Motion, retrace
from topo_verify.algorithms.planar import PlanarRule
from topo_verify.errors import InputError
from topo_verify.harness.search.states.script import ChoicePoint
from topo_verify.robot.percept import Door
from topo_verify.world.rooted_map import Dart, World

State = Hashable
"""Equal exactly where two moments of one mapper in one world are the same state."""

FORGETFUL = (NoRule, PrefixRule, HistoryRule)
"""Rules that remember nothing from one hypothesis to the next. (Rules made of them may.)"""


def state(
    moment: ChoicePoint, motion: Motion, world: World
) -> tuple[State, tuple[int, ...]] | None:
    """The state at a moment, and the places of its ways in the order of the darts of the world.

    None if S is no part of the world, for then it has no darts in it.
    """
    darts = world_darts(moment.chart, world)
    if darts is None:
        return None
    chart = moment.chart
    explored = sum(1 << darts[d] for d, other in enumerate(chart.alpha) if other is not None)
    entries = [darts[first] for first in chart.first]
    rule = moment.rule
    if type(rule) in KNOWN:
        entries.sort()  # the order of discovery changes nothing
    if moment.e is None:
        where: Hashable = world.vertex_of[darts[moment.at]]
    else:
        walked = moment.executed[-1].doors if moment.executed and motion is not retrace else ()
        remaining = sum(1 << darts[h] for h in moment.remaining)
        where = (darts[moment.e], remaining, walked)
    found = explored, tuple(entries), where, _memory(rule, moment.executed, darts)
    ways = moment.ways
    return found, tuple(sorted(range(len(ways)), key=lambda place: darts[ways[place]]))


def owed(moment: ChoicePoint, motion: Motion) -> int:
    """The moves of the way back to vu that a state leaves out, because it always comes."""
    return len(moment.executed[-1].doors) if motion is retrace and moment.executed else 0


def world_darts(chart: Chart, world: World) -> list[Dart] | None:
    """The dart of the world that each dart of S is; None if S is no part of the world."""
    assert world.root is not None, "the world has an edge"
    darts: list[Dart | None] = [None] * len(chart.alpha)
    entries = {0: world.root}
    for v, _, back in chart.outward(0):
        if back is not None:
            up = chart.across(back)
            left = darts[up]
            assert left is not None, "the search goes outward"
            entries[v] = _turned(world, world.alpha[left], chart.first[v] - back)
        if world.degrees[world.vertex_of[entries[v]]] != chart.degree[v]:
            return None
        for door, dart in enumerate(chart.darts(v)):
            darts[dart] = _turned(world, entries[v], door)
    found = [dart for dart in darts if dart is not None]
    if len(set(found)) < len(darts):  # a vertex is out of reach, or stands in S twice
        return None
    pairs = ((found[d], other) for d, other in enumerate(chart.alpha) if other is not None)
    return found if all(world.alpha[dart] == found[other] for dart, other in pairs) else None


def _turned(world: World, dart: Dart, door: Door) -> Dart:
    rotation = world.vertices[world.vertex_of[dart]]
    return rotation[(world.place_of[dart] + door) % len(rotation)]


# ---------------------------------------------------------------- what rules remember


def _memory(rule: Rule, executed: Sequence[Executed], darts: Sequence[Dart]) -> Hashable:
    if type(rule) in FORGETFUL:
        return None
    if isinstance(rule, RecordsRule) and type(rule) is RecordsRule:
        records = frozenset((darts[d], _trie(seen)) for d, seen in rule.records.items())
        return rule.levels, records, frozenset(sequence.doors for sequence in executed)
    if isinstance(rule, PlanarRule) and type(rule) is PlanarRule:
        return _memory(rule.rule, executed, darts)
    if isinstance(rule, FoldingRule) and type(rule) is FoldingRule:
        # vu is in the fold behind e, and e in the state.
        return tuple(_numbered(rule.fold)) if rule.entries else ()
    try:
        return pickle.dumps((rule, tuple(executed)))
    except Exception as error:
        raise InputError(
            f"--policies every: what rule {type(rule).__name__} remembers cannot be pickled"
            f" ({type(error).__name__}: {error}), so its states cannot be compared; ask for"
            " --policies all"
        ) from error


KNOWN: tuple[type[object], ...] = (*FORGETFUL, RecordsRule, PlanarRule, FoldingRule)
"""Rules of which this file knows what they remember."""


def _trie(seen: Seen) -> Hashable:
    return seen.percept, frozenset((door, _trie(place)) for door, place in seen.behind.items())


def _numbered(fold: PartialFold) -> Iterator[Hashable]:
    """The nodes as they are found from v0 on: what was seen, and what each door leads to."""
    seen = fold.seen
    places: dict[NodeDart, tuple[int, NodeDart]] = {}  # of a node: its number, and its dart found
    queue: list[NodeDart] = []

    def number(dart: NodeDart) -> tuple[int, Door]:
        dart = fold.resolve(dart)
        if seen.node[dart] not in places:
            places[seen.node[dart]] = len(queue), dart
            queue.append(dart)
        found, first = places[seen.node[dart]]
        return found, (dart - first) % seen.looks[dart][0]

    number(1)  # v0's dart with the marker
    for dart in queue:  # grows as it goes
        ends = [fold.across(fold.turn(dart, door)) for door in range(seen.looks[dart][0])]
        row = tuple(number(end) if end else None for end in ends)
        yield seen.looks[dart], fold.is_known(dart), row
