"""Types for two kinds of darts that the checkers never mix: those of the world, and those of S.

A mix-up would judge a mapper by the wrong dart. The dart of an event becomes a `KnownDart` where
`is_open` has found S to have it. Only `MapInWorld` turns one kind into the other.
"""

from __future__ import annotations

from typing import NewType

WorldDart = NewType("WorldDart", int)

KnownDart = NewType("KnownDart", int)
