"""Folding, the complete rule: it keeps a hypothesis exactly if some world that fits makes it true.

Mirrors: algorithms/folding.py, `SeenPlaces`, `PartialFold` and `FoldingRule`, with the same numbers
for darts and the same order of identifications, which decides what contradiction is met first.
Differs: there is one fold, and a **layer** is a list of changes. Whatever is found is noted and
taken back, unless it follows from what was seen alone. A layer that is kept is its changes, and
they are made again before it folds on: so it reads through to what was joined below since, as the
reference's does.

A change is one word: where, and what stands there (the new word in a layer, the old one in what is
to be taken back). `around` is written out: the darts of a node are numbers in a row.

All hypotheses that remain are asked after each mismatch, so what was joined since, and whether
places were identified, is noted once for all layers (`NJOINED`, `ANEW`). What is asked then is a
stage: the layers that are kept are written one after another into one field, while those of the
stage before stand in another.

Source: docs/semantics.md, section 11.
"""

from __future__ import annotations

from topo_verify.compiled.events import OWN_OTHER_END, TURNED_ITSELF, TWO_OF_S, UNLIKE
from topo_verify.compiled.evidence import cite
from topo_verify.compiled.faults import *
from topo_verify.compiled.kernel import Words, kernel
from topo_verify.compiled.workspace import *

WORD = 32
"""A change is `where << WORD`, and what stands there."""


@kernel
def add_place(W: Words, percept: int, known: int) -> int:
    """Add a node with this percept at its first dart, which is returned; 0: `STOP` is set."""
    first = W[NPLACE_DARTS]
    degree = percept >> SHIFT
    if first + degree > PLACE_DARTS:
        W[STOP] = STOP_FULL + FULL_PLACES
        return 0
    for dart in range(first, first + degree):
        W[NODE + dart] = first
        W[LOOKS + dart] = 2 * degree + ((percept & MASK) > 0)
        W[LEADER + dart] = 0
        W[BEHIND + dart] = 0
        W[WEIGHT + dart] = 0
    W[KNOWN + first] = 1 if planted(W, TAKES_EACH_PLACE_FOR_KNOWN) else known
    W[NPLACE_DARTS] = first + degree
    return first


@kernel
def turn_at_place(W: Words, dart: int, door: int) -> int:
    """The dart that is so many doors clockwise from this one."""
    first = W[NODE + dart]
    return first + (dart - first + door) % (W[LOOKS + dart] >> 1)


@kernel
def resolve(W: Words, dart: int) -> int:
    """The dart that stands for all that are the same dart."""
    up = W[LEADER + dart]
    while up != 0:
        dart = up
        up = W[LEADER + dart]
    return dart


@kernel
def across(W: Words, dart: int) -> int:
    """The other end of a dart's edge; 0 if nothing was seen behind it."""
    return W[BEHIND + resolve(W, dart)]


@kernel
def join_seen(W: Words, one: int, other: int) -> None:
    """Join two darts to one edge, and fold; nothing is assumed."""
    take_for_seen(W, join_places(W, one, other))


@kernel
def identify_seen(W: Words, one: int, other: int) -> None:
    """Make two darts one, and fold; nothing is assumed."""
    W[WAITING] = one
    W[WAITING + 1] = other
    take_for_seen(W, fold(W, 2, 0))


@kernel
def join_places(W: Words, one: int, other: int) -> int:
    """Join two darts to one edge, and fold. Returns the contradiction; 0: none."""
    one = resolve(W, one)
    other = resolve(W, other)
    if one == other:
        return OWN_OTHER_END
    had = W[BEHIND + one]
    has = W[BEHIND + other]
    if had == 0:
        change(W, BEHIND + one, other)
    if has == 0:
        change(W, BEHIND + other, one)
    # The last pair is folded first: what is behind h, if anything, with the vertex of e in S.
    waiting = 0
    if had != 0:
        W[WAITING] = had
        W[WAITING + 1] = other
        waiting = 2
    if has != 0:
        W[WAITING + waiting] = has
        W[WAITING + waiting + 1] = one
        waiting += 2
    return fold(W, waiting, 1)


@kernel
def fold(W: Words, waiting: int, one_partner: int) -> int:
    """Make the two darts of each pair one, and draw what follows. Returns the contradiction.

    Args:
        waiting: how many words of pairs wait.
        one_partner: whether the two darts of each pair have one partner, so that nothing more is to
            be drawn from what lies behind them.
    """
    for i in range(WAITING, WAITING + waiting, 2):
        if W[LOOKS + W[i]] != W[LOOKS + W[i + 1]]:
            return UNLIKE
    while waiting > 0:
        waiting -= 2
        small = resolve(W, W[WAITING + waiting])
        large = resolve(W, W[WAITING + waiting + 1])
        if small == large:
            continue
        s = W[NODE + small]
        n = W[NODE + large]
        if s == n:
            return TURNED_ITSELF
        if W[KNOWN + s] != 0:  # it leads whatever is identified with it
            if W[KNOWN + n] != 0:
                return TWO_OF_S
            small, large = large, small
        elif W[KNOWN + n] == 0:
            light = W[WEIGHT + s]
            heavy = W[WEIGHT + n]
            if light > heavy:  # keeps every chain of leaders short
                small, large = large, small
                n = s
            change(W, WEIGHT + n, light + 1 + heavy)
        waiting = lay(W, small, large, waiting, one_partner)
        if waiting < 0:
            return -waiting
        if W[STOP] != 0:
            return UNLIKE
    return 0


@kernel
def lay(W: Words, small: int, large: int, waiting: int, one_partner: int) -> int:
    """Make each dart of a node one with that of its leader, from these two on, clockwise.

    Returns the words of pairs that wait then; or the contradiction, as a negative number.
    """
    W[LAID] += 1
    degree = W[LOOKS + small] >> 1  # alike, so of one degree
    dart = small
    same = large
    if planted(W, IDENTIFIES_WITHOUT_TURNING):
        dart = W[NODE + small]
        same = W[NODE + large]
    beyond_dart = W[NODE + small] + degree
    beyond_same = W[NODE + large] + degree
    for _ in range(degree):
        change(W, LEADER + dart, same)
        end = W[BEHIND + dart]
        if end != 0 and not (one_partner != 0 and dart == small):
            end = resolve(W, end)
            if end == same:
                return -OWN_OTHER_END
            beyond = W[BEHIND + same]
            if beyond == 0:
                change(W, BEHIND + same, end)
            elif beyond != end:
                if W[LOOKS + beyond] != W[LOOKS + end]:
                    return -UNLIKE
                if waiting + 2 > PLACE_DARTS:
                    W[STOP] = STOP_FULL + FULL_PLACES
                    return waiting
                W[WAITING + waiting] = beyond
                W[WAITING + waiting + 1] = end
                waiting += 2
        dart += 1
        if dart == beyond_dart:
            dart -= degree
        same += 1
        if same == beyond_same:
            same -= degree
    return waiting


# ---------------------------------------------------------------- changes, and layers of them


@kernel
def change(W: Words, where: int, word: int) -> None:
    """Write a word, and note what stood there."""
    number = W[NCHANGES]
    if number >= CHANGED:
        W[STOP] = STOP_FULL + FULL_PLACES
        return
    W[CHANGES + number] = (where << WORD) + W[where]
    W[NCHANGES] = number + 1
    W[where] = word


@kernel
def take_for_seen(W: Words, wrong: int) -> None:
    """Take for seen what was found where nothing was assumed; or drop it if it clashes."""
    if wrong != 0:
        take_back(W)
    W[MERGES] += W[LAID]
    W[LAID] = 0
    W[NCHANGES] = 0


@kernel
def take_back(W: Words) -> None:
    """Take back every change, the last one first."""
    for i in range(W[NCHANGES] - 1, -1, -1):
        changed = W[CHANGES + i]
        W[changed >> WORD] = changed & ((1 << WORD) - 1)
    W[NCHANGES] = 0
    W[LAID] = 0


@kernel
def layers_of(stage: int) -> int:
    """The field that has the layers of a stage."""
    return LAYERS_ODD if stage & 1 else LAYERS_EVEN


@kernel
def keep_layer(W: Words, h: int) -> None:
    """Keep what is found as the layer of a hypothesis."""
    end = W[NLAYER_WORDS]
    if end + W[NCHANGES] > LAYER_WORDS:
        W[STOP] = STOP_FULL + FULL_PLACES
        return
    W[LAYER_FIRST + h] = end
    base = layers_of(W[STAGE]) + end
    for i in range(W[NCHANGES]):
        where = W[CHANGES + i] >> WORD
        W[base + i] = (where << WORD) + W[where]
    end += W[NCHANGES]
    W[LAYER_END + h] = end
    W[NLAYER_WORDS] = end


@kernel
def lay_again(W: Words, h: int) -> None:
    """Make the changes of the layer that was kept of a hypothesis, at the stage before."""
    base = layers_of(W[STAGE] - 1)
    for i in range(base + W[LAYER_FIRST + h], base + W[LAYER_END + h]):
        change(W, W[i] >> WORD, W[i] & ((1 << WORD) - 1))


# ---------------------------------------------------------------- the rule


@kernel
def start_fold(W: Words) -> None:
    """Start with v0 alone."""
    W[NPLACE_DARTS] = 1
    W[NCHANGES] = 0
    W[LAID] = 0
    W[MERGES] = 0
    W[STAGE] = 0
    W[ENTRIES] = add_place(W, W[CP], 1)


@kernel
def node_dart(W: Words, dart: int) -> int:
    """The dart of a node that a dart of S is."""
    v = W[CV + dart]
    return turn_at_place(W, W[ENTRIES + v], dart - W[CF + v])


@kernel
def arrive_fold(W: Words, e: int, percept: int) -> None:
    """Take note of vu, which is a place seen before, or a new ghost."""
    W[PLACE_E] = node_dart(W, e)
    W[PLACE_VU] = cross_fold(W, W[PLACE_E], percept)
    W[ANEW] = 1
    W[NLAYER_WORDS] = 0


@kernel
def cross_fold(W: Words, exit_place: int, percept: int) -> int:
    """The dart by which the robot comes in behind an exit; adds a ghost if it is new there."""
    beyond = across(W, exit_place)
    if beyond == 0:
        beyond = add_place(W, percept, 0)
        if W[STOP] != 0:
            return 0
        join_seen(W, exit_place, beyond)
        if percept & MASK > 0:
            identify_seen(W, turn_at_place(W, beyond, (percept & MASK) - 1), W[ENTRIES])
    return beyond


@kernel
def observe_fold(W: Words) -> None:
    """Keep every percept of the excursion, which ended in a mismatch."""
    merges = W[MERGES]
    joined = 0
    at = W[PLACE_VU]
    for step in range(1, W[NDOORS] + 1):
        exit_place = turn_at_place(W, at, W[DOORS + step - 1])
        darts = W[NPLACE_DARTS]
        at = cross_fold(W, exit_place, W[PP + step])
        if W[STOP] != 0:
            return
        if W[NPLACE_DARTS] != darts:
            W[JOINED_ONE + joined] = exit_place
            W[JOINED_OTHER + joined] = at
            joined += 1
    W[NJOINED] = joined
    W[ANEW] = W[MERGES] != merges
    if joined > 0:
        W[STAGE] += 1
        W[NLAYER_WORDS] = 0


@kernel
def refute_by_folding(W: Words, h: int) -> bool:
    """Whether no world allows the hypothesis; the contradiction is cited."""
    wrong = 0
    if W[ANEW] != 0:
        wrong = join_places(W, W[PLACE_E], node_dart(W, h))
    elif W[NJOINED] == 0:
        return False  # its layer stays as it is
    else:
        wrong = follow_layer(W, h)
    if wrong == 0:
        keep_layer(W, h)
    take_back(W)
    if wrong == 0:
        return False
    cite(W, 0, -1, -1, -1)
    W[EV_WRONG] = wrong
    return True


@kernel
def follow_layer(W: Words, h: int) -> int:
    """Fold what was joined since into the layer of a hypothesis. Returns the contradiction."""
    lay_again(W, h)
    for i in range(W[NJOINED]):
        if W[STOP] != 0:
            return 0
        wrong = join_places(W, W[JOINED_ONE + i], W[JOINED_OTHER + i])
        if wrong != 0:
            return wrong
    return 0


@kernel
def conclude(W: Words, remaining: int) -> int:
    """The last hypothesis, once vu is known to be a vertex of S; -1: none."""
    if remaining != 1:
        return -1
    known = W[KNOWN + W[NODE + resolve(W, W[PLACE_VU])]]
    if known == 0 and not planted(W, FORGETS_THAT_VU_MAY_BE_NEW):
        return -1
    return W[REM]


@kernel
def learn_fold(W: Words, entry: int, new: int) -> None:
    """Note which vertex of S vu is: a new one, or that of `entry`."""
    if new != 0:
        W[ENTRIES + W[NV] - 1] = W[PLACE_VU]
        W[KNOWN + W[NODE + resolve(W, W[PLACE_VU])]] = 1
    else:
        join_seen(W, W[PLACE_E], node_dart(W, entry))
