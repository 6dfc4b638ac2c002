"""When a history proves the map: by the fold alone, for classes that have worlds of any size.

A world in which the history happens lies below the fold: the part of it that was seen is a quotient
of the fold (its vertices may be one where they look alike), and beyond the open darts of this
quotient there may be anything that the class allows. So whether one world of the class is left
follows from the quotients.
"""

from __future__ import annotations

from math import prod

from topo_verify.studies.game.folds import OPEN, FoldCode, open_darts, quotients, vertices


def is_closed(code: FoldCode) -> bool:
    """Whether one world fits, of all worlds: no dart is open (docs/semantics.md, section 11)."""
    return OPEN not in code[1]


def is_single_of_vertices(code: FoldCode, n: int) -> bool:
    """Whether one world fits, of all worlds with n vertices.

    A quotient with n vertices lies in as many of these worlds as its open darts can be joined in
    pairs. One with fewer and an open dart lies in any number of them, for a vertex that was not
    seen may have any number of loops. Others lie in none.
    """
    if is_closed(code):
        return True
    if len(code[0]) < n:
        return False  # the fold itself, in which a dart is open
    fitting = 0
    for quotient in quotients(code):
        open_now = len(open_darts(quotient))
        if len(quotient[0]) < n and open_now:
            return False
        if len(quotient[0]) == n and open_now % 2 == 0:
            fitting += prod(range(1, open_now, 2))
    return fitting == 1


def is_single_planar(code: FoldCode) -> bool:
    """Whether one world fits, of all planar worlds.

    A planar quotient with an open dart lies in two at least: hang a leaf on each, or a path of two.
    One that is not planar lies in none.
    """
    if is_closed(code):
        return True
    if is_planar(code):
        return False  # the fold itself, in which a dart is open
    planar = [quotient for quotient in quotients(code) if is_planar(quotient)]
    return len(planar) == 1 and is_closed(planar[0])


def is_planar(code: FoldCode) -> bool:
    """Whether the fold is planar; a leaf on every open dart changes nothing about that."""
    degrees, alpha = code
    first, vertex = vertices(degrees)
    todo, faces = set(range(len(alpha))), 0
    while todo:
        faces += 1
        dart = start = min(todo)
        while True:
            todo.discard(dart)
            end = dart if alpha[dart] == OPEN else alpha[dart]  # an open dart is a dead end
            v = vertex[end]
            dart = first[v] + (end - first[v] + 1) % degrees[v]
            if dart == start:
                break
    edges = sum(dart < end for dart, end in enumerate(alpha))
    return len(degrees) - edges + faces == 2
