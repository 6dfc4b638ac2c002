"""SUMO's road networks, `.net.xml`: the undirected graph of their streets.

The reader takes each `<junction>` with `id`, `x`, `y` and each `<edge>` with `id`, `from`, `to` and
an optional `shape`; not those within a junction, whose id begins with ':'. Both directions of a
street are one edge, if their ids differ only in a leading '-' or their shapes are each other's
reverse.

Source: docs/formats.md; Eclipse SUMO, user documentation, "SUMO Road Networks".
"""

from __future__ import annotations

import re
from typing import TypeVar

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import embedding, geometry, markup
from topo_verify.world.formats.embedding import DrawnEdge, DrawnVertex, Note
from topo_verify.world.formats.flaws import Flaws
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)


def decode(
    cls: type[W],
    data: bytes,
    *,
    name: str = "SUMO network",
    stem: str = "",
    largest_part: Note | None = None,
) -> W:
    """The world in the bytes; `largest_part` as for `embedding.as_world`."""
    flaws = Flaws(name)
    places: dict[str, DrawnVertex | None] = {}
    edges: dict[str, dict[str, str]] = {}
    points = 0

    def take(kind: str, attributes: dict[str, str]) -> None:
        key = attributes.get("id", "")
        subject = f"{name}: {kind} '{shown(key, limit=60)}'"
        if not key or key in (places if kind == "junction" else edges):
            why = "stands there twice" if key else "has no id"
            raise InputError(f"{subject} {why}: each needs a distinct id")
        if key.startswith(":"):
            return
        if kind == "edge":
            edges[key] = attributes
            return
        places[key] = None  # known, if not where it lies
        x, y = (geometry.number(attributes.get(axis, ""), f"{subject}, {axis}") for axis in "xy")
        places[key] = DrawnVertex(key, (x, y))

    def start(path: tuple[str, ...], attributes: dict[str, str]) -> None:
        nonlocal points
        if path[0] != "net":
            raise InputError(
                f"{name}: expected a SUMO network, whose first element is <net>: name a file of"
                " that kind"
            )
        if path[1:] in {("junction",), ("edge",)}:
            with flaws:
                take(path[1], attributes)
            points += attributes.get("shape", "").count(",") if path[1] == "edge" else 0
            embedding.require_size(name, vertices=len(places), edges=len(edges), points=points)

    def end(_path: tuple[str, ...], _text: str) -> None:
        """SUMO's texts are attributes."""

    markup.read(data, name=name, start=start, end=end)
    drawn = [place for place in places.values() if place is not None]
    number = {place.name: at for at, place in enumerate(drawn)}
    ways: dict[str, DrawnEdge] = {}
    for key, attributes in edges.items():
        ends = [attributes.get(side, "") for side in ("from", "to")]
        with flaws:
            if not places.keys() >= {*ends}:
                raise InputError(
                    f"{name}: edge '{shown(key, limit=60)}': expected the ids of two junctions as"
                    " 'from' and 'to'"
                )
            if number.keys() >= {*ends}:
                _add(ways, key, attributes, (number[ends[0]], number[ends[1]]), name)
                continue
        flaws.touched |= {number[end] for end in ends if end in number}
    return embedding.as_world(
        cls, drawn, list(ways.values()), flaws, name=stem, largest_part=largest_part
    )


def _add(
    ways: dict[str, DrawnEdge],
    key: str,
    attributes: dict[str, str],
    ends: tuple[int, int],
    name: str,
) -> None:
    # lazily, as geometry.line
    shape = re.finditer(r"\S+", attributes.get("shape", ""))
    rows = (point[0].split(",") for point in shape)
    course = geometry.points(rows, f"{name}: edge '{shown(key, limit=60)}', shape")
    other = ways.get(key[1:] if key.startswith("-") else f"-{key}")
    if other is None or (other.start, other.end) != ends[::-1]:
        ways[key] = DrawnEdge(*ends, course, directed=True, name=key)
