"""Worlds to walk: a few that come with every page."""

from __future__ import annotations

from typing import Any

from topo_verify.world.resolve import resolve_world

GALLERY = (
    ("one road", "m1/0"),
    ("one loop", "m1/1"),
    ("three roads", "m3/14"),
    ("four roads", "m4/41"),
    ("two loops that cross: a torus", "m2/9"),
    ("a ring of five", "family:cycle(5)"),
    ("a wheel", "family:wheel(4)"),
    ("two by three", "family:lattice(3,2)"),
    ("three by three", "family:lattice(3,3)"),
    ("seven places", "family:lattice(2,4,holes=0.1,seed=2)"),
    ("a small torus", "family:torus(3,3)"),
    ("a cube", "family:cube()"),
)
"""What each is called in the page, and its name as a WORLD."""


def gallery() -> list[dict[str, Any]]:
    """The worlds of the gallery as data for JSON, easy ones first."""
    worlds = [(name, text, resolve_world(text)) for name, text in GALLERY]
    return [
        {
            "name": f"{name} ({text})",
            "vertices": world.vertices,
            "edges": world.edges,
            "marker": world.root,
        }
        for name, text, world in worlds
    ]
