"""What follows if two places are the ends of one edge: recomputed naively, in shuffled orders."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.helpers import any_world, trace_of
from topo_verify import World
from topo_verify.checkers.darts import KnownDart
from topo_verify.checkers.entailment import FoldedTrace
from topo_verify.checkers.folding import OWN_END, TURNED, TWO_OF_S, UNLIKE, Fold, Place
from topo_verify.checkers.map_on_fold import MapOnFold
from topo_verify.robot.events import Augment, Reject, Trace

BEHIND_A_TURNED = "m15/56783627632649097"
"""A world in which more is met where a vertex would be itself, turned."""

THREE_ENDS = "m6/57535", "m8/6719310"
"""Worlds in which a dart gets three ends: of one look the first, of another look two."""


def rejections(trace: Trace) -> Iterator[tuple[MapOnFold, Place, Place]]:
    """At each rejection by folding: S on the fold so far, and the two places that would be ends."""
    folded = FoldedTrace(trace)
    on_fold = MapOnFold(folded.fold)
    for when, event in enumerate(trace, 1):
        assert not folded.read_to(when)
        if isinstance(event, Augment):
            on_fold.grow(event)
        elif isinstance(event, Reject) and event.rule == "folding":
            e, h = KnownDart(event.edge), KnownDart(event.hypothesis)
            yield on_fold, on_fold.places[e], on_fold.places[h]


def listed(on_fold: MapOnFold, one: Place, other: Place) -> set[str]:
    """The kinds of contradictions that the checker meets."""
    return {kind for kind, _ in on_fold.fold.contradictions(one, other, on_fold.entries)}


def naively(on_fold: MapOnFold, one: Place, other: Place, shuffle: Random) -> set[str]:
    """The same: every two places of one class are compared, until no two classes become one."""
    fold = on_fold.fold
    places = [(node, dart) for node in fold.roots() for dart in range(fold.degree(node))]
    looks = {node: (fold.degree(node), node == fold.find((0, 0))[0]) for node in fold.roots()}
    ends = {place: {end} for place in places if (end := fold.partner(place))}
    for place, end in ((fold.find(one), fold.find(other)), (fold.find(other), fold.find(one))):
        ends.setdefault(place, set()).add(end)
    number = {place: at for at, place in enumerate(shuffle.sample(places, len(places)))}
    met = set[str]()
    grew = True
    while grew:
        grew = False
        classes: dict[int, list[Place]] = {}
        for place in places:
            classes.setdefault(number[place], []).append(place)
        pairs = list[tuple[Place, Place]]()
        for same in classes.values():
            pairs += combinations(sorted({e for place in same for e in ends.get(place, ())}), 2)
            pairs += [(turned(fold, same[0]), turned(fold, place)) for place in same]
        for a, b in shuffle.sample(pairs, len(pairs)):
            if looks[a[0]] != looks[b[0]]:
                met.add(UNLIKE)
            elif number[a] != number[b]:
                gone, grew = number[b], True
                for place in places:
                    if number[place] == gone:
                        number[place] = number[a]
    if any(number[place] == number[end] for place, beyond in ends.items() for end in beyond):
        met.add(OWN_END)
    names = {node: {number[p] for p in places if p[0] == node} for node in fold.roots()}
    if any(len(names[node]) < fold.degree(node) for node in fold.roots()):
        met.add(TURNED)
    entries = [names[fold.find(entry)[0]] for entry in on_fold.entries]
    if any(one & other for one, other in combinations(entries, 2)):
        met.add(TWO_OF_S)
    return met


def turned(fold: Fold, place: Place) -> Place:
    """The next dart clockwise."""
    return place[0], (place[1] + 1) % fold.degree(place[0])


@pytest.mark.nightly
@given(any_world(max_edges=9), st.randoms(use_true_random=False))
def test_what_is_met_is_what_follows_in_any_order(world: World, shuffle: Random) -> None:
    for at, ends in enumerate(rejections(trace_of(world, "folding"))):
        if at % 5 == 0:
            assert listed(*ends) == naively(*ends, shuffle)
            assert listed(ends[0], ends[2], ends[1]) == listed(*ends)


@pytest.mark.no_cover
@pytest.mark.parametrize("place", [BEHIND_A_TURNED, *THREE_ENDS])
def test_what_is_met_does_not_depend_on_what_was_met_before(place: str) -> None:
    shuffle, most = Random(0), 0
    for ends in rejections(trace_of(World.from_id(place), "folding")):
        assert listed(*ends) == naively(*ends, shuffle) == naively(*ends, shuffle)
        most = max(most, len(listed(*ends)))
    assert most >= 3


def test_looking_ahead_leaves_no_trace() -> None:
    for on_fold, one, other in rejections(trace_of(World.from_id("m5/434"), "folding")):
        before = on_fold.fold.world(2)
        assert listed(on_fold, one, other) == listed(on_fold, one, other) != set()
        assert on_fold.fold.world(2) == before
