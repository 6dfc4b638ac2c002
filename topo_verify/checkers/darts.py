"""Two kinds of darts that the checkers never mix: those of the world, and those of the map S.

Both are numbers, and both number the same things differently: a mix-up would judge a mapper by the
wrong dart. So each is a type of its own, and a plain number, as an event declares it, is neither. A
number becomes a `KnownDart` where `is_open` has found S to have it, and a dart of one kind becomes
one of the other only in `MapInWorld`, through the tables `phi` and `number`.

What the types do not refuse: either kind where any number will do, as in a message.
"""

from __future__ import annotations

from typing import NewType

WorldDart = NewType("WorldDart", int)
"""A dart of the world, as World numbers it."""

KnownDart = NewType("KnownDart", int)
"""A dart that S has: those of v0 come first, then those of each new vertex, clockwise."""
