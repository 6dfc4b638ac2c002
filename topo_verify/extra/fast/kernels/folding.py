"""The complete rule, `folding`.

Twin of algorithms/beyond/folding.py, `SeenPlaces`, `PartialFold` and `FoldingRule`, with the same
dart numbers and the same order of identifications, which decides the first contradiction. Differs:
there is one fold, and a **layer** is a list of changes, each one word: where, and what stands
there. Changes are undone unless they follow from what was seen. A kept layer is made again before
it folds on, so it sees what was joined since.

All remaining hypotheses are asked in one **stage**: what was joined since is noted once
(`layers.joined`, `layers.anew`), and kept layers move from one row to another.
"""

from __future__ import annotations

from topo_verify.extra.fast.kernels.events import OWN_OTHER_END, TURNED_ITSELF, TWO_OF_S, UNLIKE
from topo_verify.extra.fast.kernels.evidence import cite
from topo_verify.extra.fast.kernels.faults import *
from topo_verify.extra.fast.kernels.kernel import kernel
from topo_verify.extra.fast.kernels.workspace import *

WORD = 32
"""A change is `where << WORD`, and what stands there."""


@kernel
def add_place(run: RunWords, percept: int, known: int) -> int:
    """Add a node; return its first dart, or 0 (`stop` is set)."""
    places = run.places
    first = places.darts
    degree = percept >> SHIFT
    if first + degree > PLACE_DARTS:
        run.stop = STOP_FULL + FULL_PLACES
        return 0
    for dart in range(first, first + degree):
        places.node[dart] = first
        places.looks[dart] = 2 * degree + ((percept & MASK) > 0)
        places.leader[dart] = 0
        places.behind[dart] = 0
        places.weight[dart] = 0
    places.known[first] = 1 if planted(run.task, TAKES_EACH_PLACE_FOR_KNOWN) else known
    places.darts = first + degree
    return first


@kernel
def turn_at_place(places: PlaceWords, dart: int, door: int) -> int:
    first = places.node[dart]
    return first + (dart - first + door) % (places.looks[dart] >> 1)


@kernel
def resolve(places: PlaceWords, dart: int) -> int:
    up = places.leader[dart]
    while up != 0:
        dart = up
        up = places.leader[dart]
    return dart


@kernel
def across(places: PlaceWords, dart: int) -> int:
    """The other end of a dart's edge; 0: not seen."""
    return places.behind[resolve(places, dart)]


@kernel
def join_seen(run: RunWords, one: int, other: int) -> None:
    take_for_seen(run, join_places(run, one, other))


@kernel
def identify_seen(run: RunWords, one: int, other: int) -> None:
    places = run.places
    places.waiting[0] = one
    places.waiting[1] = other
    take_for_seen(run, fold(run, 2, 0))


@kernel
def join_places(run: RunWords, one: int, other: int) -> int:
    """Join two darts, and fold; return the contradiction or 0."""
    places = run.places
    one = resolve(places, one)
    other = resolve(places, other)
    if one == other:
        return OWN_OTHER_END
    had = places.behind[one]
    has = places.behind[other]
    if had == 0:
        change(run, places.place_of("behind") + one, other)
    if has == 0:
        change(run, places.place_of("behind") + other, one)
    waiting = 0
    if had != 0:
        places.waiting[0] = had
        places.waiting[1] = other
        waiting = 2
    if has != 0:
        places.waiting[waiting] = has
        places.waiting[waiting + 1] = one
        waiting += 2
    return fold(run, waiting, 1)


@kernel
def fold(run: RunWords, waiting: int, one_partner: int) -> int:
    """Identify the darts of each waiting pair, and what follows; return the contradiction.

    `one_partner`: nothing follows behind them, since they have one partner.
    """
    places = run.places
    for i in range(places.place_of("waiting"), places.place_of("waiting") + waiting, 2):
        if places.looks[run[i]] != places.looks[run[i + 1]]:
            return UNLIKE
    while waiting > 0:
        waiting -= 2
        small = resolve(places, places.waiting[waiting])
        large = resolve(places, places.waiting[waiting + 1])
        if small == large:
            continue
        s = places.node[small]
        n = places.node[large]
        if s == n:
            return TURNED_ITSELF
        if places.known[s] != 0:
            if places.known[n] != 0:
                return TWO_OF_S
            small, large = large, small
        elif places.known[n] == 0:
            light = places.weight[s]
            heavy = places.weight[n]
            if light > heavy:
                small, large = large, small
                n = s
            change(run, places.place_of("weight") + n, light + 1 + heavy)
        waiting = lay(run, small, large, waiting, one_partner)
        if waiting < 0:
            return -waiting
        if run.stop != 0:
            return UNLIKE
    return 0


@kernel
def lay(run: RunWords, small: int, large: int, waiting: int, one_partner: int) -> int:
    """Identify each dart of a node with that of its leader, clockwise from these.

    Returns the waiting words, or the contradiction, negative.
    """
    places = run.places
    places.laid += 1
    degree = places.looks[small] >> 1  # alike, so of one degree
    dart = small
    same = large
    if planted(run.task, IDENTIFIES_WITHOUT_TURNING):
        dart = places.node[small]
        same = places.node[large]
    beyond_dart = places.node[small] + degree
    beyond_same = places.node[large] + degree
    for _ in range(degree):
        change(run, places.place_of("leader") + dart, same)
        end = places.behind[dart]
        if end != 0 and not (one_partner != 0 and dart == small):
            end = resolve(places, end)
            if end == same:
                return -OWN_OTHER_END
            beyond = places.behind[same]
            if beyond == 0:
                change(run, places.place_of("behind") + same, end)
            elif beyond != end:
                if places.looks[beyond] != places.looks[end]:
                    return -UNLIKE
                if waiting + 2 > PLACE_DARTS:
                    run.stop = STOP_FULL + FULL_PLACES
                    return waiting
                places.waiting[waiting] = beyond
                places.waiting[waiting + 1] = end
                waiting += 2
        dart += 1
        if dart == beyond_dart:
            dart -= degree
        same += 1
        if same == beyond_same:
            same -= degree
    return waiting


@kernel
def change(run: RunWords, where: int, word: int) -> None:
    """Write a word; note the old one."""
    places = run.places
    number = places.changed
    if number >= CHANGED:
        run.stop = STOP_FULL + FULL_PLACES
        return
    places.changes[number] = (where << WORD) + run[where]
    places.changed = number + 1
    run[where] = word


@kernel
def take_for_seen(run: RunWords, wrong: int) -> None:
    """Keep changes without an assumption, unless they clash."""
    places = run.places
    if wrong != 0:
        take_back(run)
    places.merges += places.laid
    places.laid = 0
    places.changed = 0


@kernel
def take_back(run: RunWords) -> None:
    places = run.places
    for i in range(places.changed - 1, -1, -1):
        changed = places.changes[i]
        run[changed >> WORD] = changed & ((1 << WORD) - 1)
    places.changed = 0
    places.laid = 0


@kernel
def layers_of(layers: LayerWords, stage: int) -> int:
    return layers.place_of("odd") if stage & 1 else layers.place_of("even")


@kernel
def keep_layer(run: RunWords, h: int) -> None:
    layers, places = run.layers, run.places
    end = layers.size
    if end + places.changed > LAYER_WORDS:
        run.stop = STOP_FULL + FULL_PLACES
        return
    layers.first[h] = end
    base = layers_of(layers, layers.stage) + end
    for i in range(places.changed):
        where = places.changes[i] >> WORD
        run[base + i] = (where << WORD) + run[where]
    end += places.changed
    layers.end[h] = end
    layers.size = end


@kernel
def lay_again(run: RunWords, h: int) -> None:
    layers = run.layers
    base = layers_of(layers, layers.stage - 1)
    for i in range(base + layers.first[h], base + layers.end[h]):
        change(run, run[i] >> WORD, run[i] & ((1 << WORD) - 1))


@kernel
def start_fold(run: RunWords) -> None:
    places = run.places
    places.darts = 1
    places.changed = 0
    places.laid = 0
    places.merges = 0
    run.layers.stage = 0
    places.entry[0] = add_place(run, run.chart.percept[0], 1)


@kernel
def node_dart(run: RunWords, dart: int) -> int:
    chart = run.chart
    v = chart.vertex[dart]
    return turn_at_place(run.places, run.places.entry[v], dart - chart.first[v])


@kernel
def arrive_fold(run: RunWords, e: int, percept: int) -> None:
    """Note vu: a place seen before, or a new ghost."""
    places, layers = run.places, run.layers
    places.e = node_dart(run, e)
    places.vu = cross_fold(run, places.e, percept)
    layers.anew = 1
    layers.size = 0


@kernel
def cross_fold(run: RunWords, exit_place: int, percept: int) -> int:
    """The entry dart behind an exit; a new ghost if needed."""
    beyond = across(run.places, exit_place)
    if beyond == 0:
        beyond = add_place(run, percept, 0)
        if run.stop != 0:
            return 0
        join_seen(run, exit_place, beyond)
        if percept & MASK > 0:
            identify_seen(
                run, turn_at_place(run.places, beyond, (percept & MASK) - 1), run.places.entry[0]
            )
    return beyond


@kernel
def observe_fold(run: RunWords) -> None:
    places, layers, excursion = run.places, run.layers, run.excursion
    merges = places.merges
    joined = 0
    at = places.vu
    for step in range(1, excursion.size + 1):
        exit_place = turn_at_place(places, at, excursion.door[step - 1])
        darts = places.darts
        at = cross_fold(run, exit_place, excursion.percept[step])
        if run.stop != 0:
            return
        if places.darts != darts:
            layers.joined_one[joined] = exit_place
            layers.joined_other[joined] = at
            joined += 1
    layers.joined = joined
    layers.anew = places.merges != merges
    if joined > 0:
        layers.stage += 1
        layers.size = 0


@kernel
def refute_by_folding(run: RunWords, h: int) -> bool:
    layers = run.layers
    wrong = 0
    if layers.anew != 0:
        wrong = join_places(run, run.places.e, node_dart(run, h))
    elif layers.joined == 0:
        return False
    else:
        wrong = follow_layer(run, h)
    if wrong == 0:
        keep_layer(run, h)
    take_back(run)
    if wrong == 0:
        return False
    cite(run.evidence, 0, -1, -1, -1)
    run.evidence.wrong = wrong
    return True


@kernel
def follow_layer(run: RunWords, h: int) -> int:
    """Fold new edges into a layer; return the contradiction."""
    layers = run.layers
    lay_again(run, h)
    for i in range(layers.joined):
        if run.stop != 0:
            return 0
        wrong = join_places(run, layers.joined_one[i], layers.joined_other[i])
        if wrong != 0:
            return wrong
    return 0


@kernel
def conclude(run: RunWords, remaining: int) -> int:
    """The last hypothesis, if vu is known to be in S; -1: none."""
    places = run.places
    if remaining != 1:
        return -1
    known = places.known[places.node[resolve(places, places.vu)]]
    if known == 0 and not planted(run.task, FORGETS_THAT_VU_MAY_BE_NEW):
        return -1
    return run.remaining.dart[0]


@kernel
def learn_fold(run: RunWords, entry: int, new: int) -> None:
    """Note that vu is a new vertex of S, or that of `entry`."""
    places = run.places
    if new != 0:
        places.entry[run.chart.vertices - 1] = places.vu
        places.known[places.node[resolve(places, places.vu)]] = 1
    else:
        join_seen(run, places.e, node_dart(run, entry))
