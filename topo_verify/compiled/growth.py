"""The layout of the state of an enumeration: one array of 64-bit integers, at constant places.

A **step** joins the smallest open dart with a partner; the steps so far are a stack, and a row of
`G_ROW` places holds one number a step, a dart or a vertex. See `enumeration.py` and `pruning.py`.
"""

from __future__ import annotations

from typing import Annotated

from topo_verify.compiled.names import Fields, Words, WordView

MOST_LISTED_EDGES = 12
"""Layout `SMALL` has room for so many. (Ranks fit in 64 bits up to 16 edges.)"""

G_ROW = 2 * MOST_LISTED_EDGES + 2
"""Room for one number a step, a dart or a vertex."""

PerGrown = Annotated[Words, "G_ROW"]


class WalkWords(WordView):
    """What is asked for, where the walk stands, the class, and the pruners."""

    darts: int  # of the worlds: 2m
    start: int  # the first rank
    stop: int  # the rank after the last one
    completions: Annotated[Words, "COMPLETIONS"]  # F(u, r) at u · G_ROW + r
    rank: int  # class `any`: the rank of the next world
    skip: int  # class `any`: how many worlds are still to be passed over
    root: int
    root_after: int  # the rank behind all worlds with this root
    depth: int
    created: int
    opened: int
    vertices: int
    dart: PerGrown
    partner: PerGrown
    is_new: PerGrown  # whether the partner is the first dart of a new vertex
    after: PerGrown  # the rank behind all completions of the step
    pruned: int  # whether the class is another one than `any`
    most_degree: int
    has_genus: int  # whether the genus is bounded
    most_genus: int
    exact: int  # whether the genus must be `most_genus`
    loopless: int  # also where the class is `simple`
    simple: int
    handles: int  # by how much the genus may still grow
    odd_words: int
    words: int
    next: PerGrown  # of each open dart, the next one along its boundary; and the one before it
    before: PerGrown
    word: PerGrown  # at each step: the darts of e's word but e, as a mask
    word_places: PerGrown  # at each step: those of them that are 1, 3, 5, … places behind e
    word_odd: PerGrown  # at each step: 1 if e's word, with e, has an odd length
    was_handles: PerGrown
    was_odd_words: PerGrown
    was_words: PerGrown
    dart_next: PerGrown
    dart_before: PerGrown
    partner_next: PerGrown
    partner_before: PerGrown
    open_at: PerGrown  # how many open darts each vertex has
    near: PerGrown  # the neighbours of each vertex, as a mask (`simple` alone)


GROWTH = Fields("G", WalkWords, {"G_ROW": G_ROW, "COMPLETIONS": G_ROW * G_ROW})
