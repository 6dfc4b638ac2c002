"""The planar prior: in a planar world, only darts on e's own face of S can be its other end.

Mirrors: algorithms/planar.py, `PlanarRule` before the complete rule. Differs: the face is a mark on
its darts, the number of this e.

Source: docs/semantics.md, section 8.
"""

from __future__ import annotations

from topo_verify.compiled.chart import turn
from topo_verify.compiled.events import OTHER_FACE
from topo_verify.compiled.kernel import Words, kernel
from topo_verify.compiled.prefix import cite
from topo_verify.compiled.workspace import CA, EV_WRONG, FACE, NFACES


@kernel
def face(W: Words, e: int) -> None:
    """Mark the darts of S on the face of e."""
    W[NFACES] += 1
    dart = e
    while True:
        W[FACE + dart] = W[NFACES]
        # An unexplored dart is a dead end, so turn back. The next dart of the face is sigma∘alpha,
        # where alpha of an open dart is the dart itself.
        if W[CA + dart] >= 0:
            dart = W[CA + dart]
        dart = turn(W, dart, 1)
        if dart == e:
            return


@kernel
def refute_by_face(W: Words, h: int) -> bool:
    """Whether the hypothesis is false in every planar world, since it lies on another face."""
    if W[FACE + h] == W[NFACES]:
        return False
    cite(W, 0, -1, -1)
    W[EV_WRONG] = OTHER_FACE
    return True
