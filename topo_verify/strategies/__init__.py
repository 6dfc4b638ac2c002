"""Hypothesis strategies: worlds of many kinds, mappers, door words.

File by file::

    general.py     worlds, planar_, nonplanar_,     shapes.py        bounds, what is possible
                   tree_, dense_, uniform_worlds    growth.py        makes a world of bytes
    grids.py       lattices                         draws.py         draws the bytes
    symmetric.py   symmetric_worlds                 notes.py         notes and features
    mappers.py     mappers, policies, door_words    sample.py        STRATEGY by its name
    registration.py   called by Hypothesis

Arguments out of range, or bounds that no world keeps, raise `InputError`.
"""

from __future__ import annotations

if __name__ != "topo_verify.strategies":
    raise ImportError(
        f"this package is topo_verify.strategies; as {__name__!r} its classes would exist twice"
    )

from topo_verify.strategies.general import (
    dense_worlds,
    nonplanar_worlds,
    planar_worlds,
    tree_worlds,
    uniform_worlds,
    worlds,
)
from topo_verify.strategies.grids import lattices
from topo_verify.strategies.mappers import door_words, mappers, policies
from topo_verify.strategies.notes import observe
from topo_verify.strategies.symmetric import symmetric_worlds

__all__ = [
    "dense_worlds",
    "door_words",
    "lattices",
    "mappers",
    "nonplanar_worlds",
    "observe",
    "planar_worlds",
    "policies",
    "symmetric_worlds",
    "tree_worlds",
    "uniform_worlds",
    "worlds",
]
