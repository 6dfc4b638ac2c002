"""Short names of the lines of a figure, for labels and heads of columns."""

from __future__ import annotations

SHORT = {
    "basic": "basic",
    "enhancement-i": "I",
    "enhancement-ii": "II",
    "enhancement-ii+i": "II+I",
    "enhancement-iii-one": "III one",
    "enhancement-iii-one+i": "III one+I",
    "enhancement-iii-all": "III all",
    "enhancement-iii-all+i": "III all+I",
    "folding": "folding",
    "edges": "edges m",
    "least-cost": "least cost",
}
"""By the name in results. `+I` walks as Enhancement I does: on from where a percept differed."""
