"""The two reference policies: `nearest`, which edge next, and `shortest`, which hypothesis first.

Mirrors: algorithms/policies.py. Differs: only these two, which define the reference costs. Few
hypotheses are sorted by insertion, many by counting distances; both keep the order of darts.

Source: docs/semantics.md, section 5.
"""

from __future__ import annotations

from topo_verify.compiled.chart import first_in_u, reach
from topo_verify.compiled.kernel import Words, kernel
from topo_verify.compiled.workspace import COUNTS, CV, DEP, NV, REM, SORTED, UO

FEW = 24
"""The most hypotheses that are sorted by insertion."""


@kernel
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
