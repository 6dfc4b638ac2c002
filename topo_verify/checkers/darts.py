"""Types for two kinds of darts that the checkers never mix: those of the world, and those of S.

A mix-up would judge a mapper by the wrong dart. A number that an event declares becomes a
`KnownDart` where `is_open` has found S to have it. Only `MapInWorld` turns one kind into the other,
through the tables `phi` and `number`.

What the types do not refuse: either kind where any number will do, as in a message.
"""

from __future__ import annotations

from typing import NewType

WorldDart = NewType("WorldDart", int)

KnownDart = NewType("KnownDart", int)
