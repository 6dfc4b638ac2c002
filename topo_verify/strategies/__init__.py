"""Hypothesis strategies: worlds of many kinds, mappers, door words.

    general.py     worlds, planar_worlds, nonplanar_worlds    shapes.py     bounds, what is possible
    trees.py       tree_worlds                                growth.py     makes a world of bytes
    dense.py       dense_worlds                               draws.py      draws the bytes
    grids.py       lattices                                   mappers.py    mappers, policies
    symmetric.py   symmetric_worlds                           doors.py      door_words
    uniform.py     uniform_worlds                             notes.py      notes and features
    sample.py      worlds outside of any test                 resolve.py    STRATEGY by its name
    naming.py      prints a strategy as its call

The entry point `hypothesis` calls registration.py. docs/property-tests.md begins with a
first test and shows the simplest world of each strategy.
"""

from __future__ import annotations

if __name__ != "topo_verify.strategies":
    raise ImportError(
        f"this package is topo_verify.strategies; as {__name__!r} its classes would exist twice"
    )

from topo_verify.strategies.dense import dense_worlds
from topo_verify.strategies.doors import door_words
from topo_verify.strategies.general import nonplanar_worlds, planar_worlds, worlds
from topo_verify.strategies.grids import lattices
from topo_verify.strategies.mappers import mappers, policies
from topo_verify.strategies.notes import observe
from topo_verify.strategies.symmetric import symmetric_worlds
from topo_verify.strategies.trees import tree_worlds
from topo_verify.strategies.uniform import uniform_worlds

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
