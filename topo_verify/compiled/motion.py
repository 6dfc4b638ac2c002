"""Motion: excursions from vu, and which edge and which hypothesis is walked next.

Mirrors: algorithms/motion.py, `Pilot`, `Hypothesis`, `retrace`, `overlap`; algorithms/policies.py,
`nearest` and `shortest`. Differs: a hypothesis is its dart alone; its way home is followed along
PAR where it is needed and is written down nowhere. Of the policies there are only these two, which
define the reference costs. Few hypotheses are sorted by insertion, many by counting distances; both
keep the order of darts.

Source: docs/semantics.md, sections 2, 5, 6, 7; listing 1 lines 10-15, listing 2 lines 15-23.
"""

from __future__ import annotations

from topo_verify.compiled.chart import door, first_in_u, reach, tree
from topo_verify.compiled.events import CROSS, RETRACE, VALIDATE, WALK
from topo_verify.compiled.faults import *
from topo_verify.compiled.kernel import Words, inlined, kernel
from topo_verify.compiled.robot import move
from topo_verify.compiled.workspace import *


@inlined
def walk(W: Words, at: int, v: int) -> int:
    """Walk on S to v along the tree rooted there. Returns the reference dart at the end."""
    if W[CV + at] == v:
        return at
    # Rooted at the end of the walk, so that each vertex on it has its dart towards the end.
    tree(W, v, W[CV + at])
    while W[CV + at] != v:
        exit_dart = W[TOWARDS + W[CV + at]]
        move(W, door(W, at, exit_dart), WALK)
        if W[STOP] != 0:
            break
        at = W[CA + exit_dart]
    return at


@inlined
def cross(W: Words, at: int, e: int) -> int:
    """Leave the known world by e. Returns the percept at vu, where excursions start."""
    percept = move(W, door(W, at, e), CROSS)
    W[TURNED] = 0
    W[NDOORS] = 0
    W[PP] = percept
    return percept


@inlined
def forward(W: Words, door: int) -> None:
    """Walk one more door of a sequence, relative to the dart by which the place was entered."""
    relative = door if planted(W, SETS_OUT_UNTURNED) else door - W[TURNED]
    degree = W[DG + W[VT + W[POS]]]
    # Twice at most: for a mapper that mistook the place, or the sign of `turned`.
    while relative < 0:
        relative += degree
    while relative >= degree:
        relative -= degree
    percept = move(W, relative, VALIDATE)
    W[TURNED] = 0
    n = W[NDOORS]
    W[DOORS + n] = door
    W[PP + n + 1] = percept
    W[NDOORS] = n + 1


@inlined
def back(W: Words, steps: int) -> None:
    """Retrace until only this many doors of the excursion are left. 0: back at vu."""
    if planted(W, RETRACES_ONE_EDGE_SHORT) and steps == 0:
        steps = 1
    if planted(W, RETRACES_IN_THE_WRONG_ORDER):
        turn_round(W, steps)
    while W[NDOORS] > steps:
        # The dart of entry leads back; the reference dart is turned away from it by `turned`.
        relative = -W[TURNED]
        degree = W[DG + W[VT + W[POS]]]
        while relative < 0:
            relative += degree
        while relative >= degree:
            relative -= degree
        move(W, relative, RETRACE)
        if W[STOP] != 0:
            return
        n = W[NDOORS] - 1
        W[NDOORS] = n
        # It arrives by the dart that this door left by: so far is it turned from the entry.
        W[TURNED] = W[DOORS + n]
        if planted(W, FORGETS_ITS_ORIENTATION):
            W[TURNED] = 0
        if planted(W, RESTORES_WITH_THE_WRONG_SIGN):
            W[TURNED] = -W[DOORS + n]


@kernel
def turn_round(W: Words, steps: int) -> None:
    """Reverse the doors of the excursion from a step on: a planted mistake."""
    low = steps
    high = W[NDOORS] - 1
    while low < high:
        kept = W[DOORS + low]
        W[DOORS + low] = W[DOORS + high]
        W[DOORS + high] = kept
        low += 1
        high -= 1


@kernel
def choice(W: Words, remaining: int) -> int:
    """Which of H is walked next, as an index of REM: by `retrace` the first, or `overlap`.

    In SHARED it leaves how many doors that one shares with the last sequence.
    """
    W[SHARED] = 0
    if W[MOTION] == 0 or W[NSEQ] == 0:
        return 0  # A1.8 A1.15 A3.9 A3.24
    best = 0
    longest = -1
    for i in range(remaining):
        shared = common_prefix(W, W[REM + i])
        # Of those that tie the first: the order policy decides.
        if shared > longest:
            longest = shared
            best = i
    W[SHARED] = longest
    return best  # A2.7 A2.22


@kernel
def common_prefix(W: Words, h: int) -> int:
    """How many doors the way home from h shares with the last sequence, from vu on."""
    n = W[NDOORS]
    at = h
    for length in range(n):
        up = W[PAR + W[CV + at]]
        if up < 0 or door(W, at, up) != W[DOORS + length]:
            return length
        at = W[CA + up]
    return n


# ---------------------------------------------------------------- the two reference policies


FEW = 24
"""The most hypotheses that are sorted by insertion."""


@inlined
def nearest(W: Words, at: int) -> int:
    """The dart of U whose vertex is nearest on S to the robot; ties: the lowest dart."""
    root = W[CV + at]
    if W[UO + root] > 0:
        return first_in_u(W, root)
    return reach(W, root)


@kernel
def shortest(W: Words, number: int) -> None:
    """Sort H by the length of the validation path, then by dart; it comes in the order of darts."""
    if number > FEW:
        counted(W, number)
        return
    for i in range(1, number):
        h = W[REM + i]
        depth = W[DEP + W[CV + h]]
        j = i
        while j > 0 and W[DEP + W[CV + W[REM + j - 1]]] > depth:
            W[REM + j] = W[REM + j - 1]
            j -= 1
        W[REM + j] = h


@kernel
def counted(W: Words, number: int) -> None:
    """Sort H as `shortest` does, in a time linear in H and S."""
    for depth in range(W[NV]):
        W[COUNTS + depth] = 0
    for i in range(number):
        W[COUNTS + W[DEP + W[CV + W[REM + i]]]] += 1
    below = 0
    for depth in range(W[NV]):
        here = W[COUNTS + depth]
        W[COUNTS + depth] = below
        below += here
    for i in range(number):
        h = W[REM + i]
        depth = W[DEP + W[CV + h]]
        W[SORTED + W[COUNTS + depth]] = h
        W[COUNTS + depth] += 1
    for i in range(number):
        W[REM + i] = W[SORTED + i]
