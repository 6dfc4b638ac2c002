"""The layout of the state of an enumeration: one array of 64-bit integers, fields at constant places.

A **step** joins the smallest open dart with a partner; the steps so far are a stack, and a field of
`_DEEP` places holds one number a step. See `enumeration.py` and `pruning.py`.
"""

from __future__ import annotations

MOST_LISTED_EDGES = 12
"""Layout `SMALL` has room for so many. (Ranks fit in 64 bits up to 16 edges, masks of darts up to 31.)"""

_DEEP = 2 * MOST_LISTED_EDGES + 2
"""Room for one number a step, a dart or a vertex."""

_used = 0


def _field(size: int = 1) -> int:
    """The place of the next field, which takes so many numbers."""
    global _used  # noqa: PLW0603  the layout is made once, when the module is loaded
    place = _used
    _used += size
    return place


# ---------------------------------------------------------------- what is asked for

G_DARTS = _field()
"""Of the worlds: 2m."""
G_START = _field()
"""The first rank."""
G_STOP = _field()
"""The rank after the last one."""
G_ROW = _DEEP
G_COMPLETIONS = _field(G_ROW * G_ROW)
"""F(u, r) at u · G_ROW + r."""

# ---------------------------------------------------------------- where the walk stands

G_RANK = _field()
"""Class `any`: the rank of the next world."""
G_SKIP = _field()
"""Class `any`: how many worlds are still to be passed over."""
G_ROOT = _field()
G_ROOT_AFTER = _field()
"""The rank behind all worlds with this root."""
G_DEPTH = _field()
G_CREATED = _field()
G_OPENED = _field()
G_VERTICES = _field()

G_DART = _field(_DEEP)
G_PARTNER = _field(_DEEP)
G_IS_NEW = _field(_DEEP)
"""Whether the partner is the first dart of a new vertex."""
G_AFTER = _field(_DEEP)
"""The rank behind all completions of the step."""

# ---------------------------------------------------------------- the class

G_PRUNED = _field()
"""Whether the class is another one than `any`."""
G_MOST_DEGREE = _field()
G_HAS_GENUS = _field()
"""Whether the genus is bounded."""
G_MOST_GENUS = _field()
G_EXACT = _field()
"""Whether the genus must be `G_MOST_GENUS`."""
G_LOOPLESS = _field()
"""Also where the class is `simple`."""
G_SIMPLE = _field()

# ---------------------------------------------------------------- the pruners

G_HANDLES = _field()
"""By how much the genus may still grow."""
G_ODD_WORDS = _field()
G_WORDS = _field()
G_NEXT = _field(_DEEP)
"""Of each open dart, the next one along its boundary; and the one before it."""
G_BEFORE = _field(_DEEP)

G_WORD = _field(_DEEP)
"""At each step: the darts of e's word but e, as a mask."""
G_WORD_PLACES = _field(_DEEP)
"""At each step: those of them that are 1, 3, 5, … places behind e."""
G_WORD_ODD = _field(_DEEP)
"""At each step: 1 if e's word, with e, has an odd length."""

G_WAS_HANDLES = _field(_DEEP)
G_WAS_ODD_WORDS = _field(_DEEP)
G_WAS_WORDS = _field(_DEEP)
G_DART_NEXT = _field(_DEEP)
G_DART_BEFORE = _field(_DEEP)
G_PARTNER_NEXT = _field(_DEEP)
G_PARTNER_BEFORE = _field(_DEEP)

G_OPEN_AT = _field(_DEEP)
"""How many open darts each vertex has."""
G_NEAR = _field(_DEEP)
"""The neighbours of each vertex, as a mask (`simple` alone)."""

G_SIZE = _used
