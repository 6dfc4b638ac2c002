"""SUMO's road networks, `.net.xml`: the undirected graph of their streets.

The reader takes each `<junction>` with `id`, `x`, `y` and each `<edge>` with `id`, `from`, `to` and
an optional `shape`; not those within a junction, whose id begins with ':'. Both directions of a
street are one edge, if their ids differ only in a leading '-', or as embedding.py says. It compares
the order that it finds with `incLanes` (clockwise; in a net for driving on the left, `lefthand`,
counter-clockwise) and says where they differ.

Why not sumolib? It ends with a KeyError that names no place where an attribute is missing that this
reader does not need (`version`, `type`, `incLanes`, lanes) or a coordinate, expands entities, and
knows no order of streets but that of `incLanes`, which leaves out those that only lead away.

Source: docs/formats.md; Eclipse SUMO, user documentation, "SUMO Road Networks".
"""

from __future__ import annotations

import re
from typing import TypeVar

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import embedding, geometry, markup
from topo_verify.world.formats.embedding import DrawnEdge, DrawnVertex
from topo_verify.world.formats.flaws import Flaws
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)


def decode(
    cls: type[W],
    data: bytes,
    *,
    name: str = "SUMO network",
    stem: str = "",
    largest_part: bool = False,
) -> W:
    """The world in the bytes; `largest_part` as for `embedding.as_world`."""
    flaws = Flaws(name)
    places: dict[str, DrawnVertex | None] = {}
    edges: dict[str, dict[str, str]] = {}
    points = 0
    is_lefthand = False

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
        lanes = attributes.get("incLanes", "").split()
        incoming = dict.fromkeys(lane.rpartition("_")[0] for lane in lanes)
        places[key] = DrawnVertex(key, (x, y), tuple(incoming)[:: -1 if is_lefthand else 1])

    def start(path: tuple[str, ...], attributes: dict[str, str]) -> None:
        nonlocal points, is_lefthand
        if path[0] != "net":
            raise InputError(
                f"{name}: expected a SUMO network, whose first element is <net>: name a file of"
                " that kind"
            )
        if not path[1:]:
            is_lefthand = attributes.get("lefthand") == "true"
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
    ways: list[DrawnEdge] = []
    for key, attributes in edges.items():
        ends = [attributes.get(side, "") for side in ("from", "to")]
        with flaws:
            if not places.keys() >= {*ends}:
                raise InputError(
                    f"{name}: edge '{shown(key, limit=60)}': expected the ids of two junctions as"
                    " 'from' and 'to'"
                )
            if number.keys() >= {*ends}:
                # lazily, as geometry.line
                shape = re.finditer(r"\S+", attributes.get("shape", ""))
                rows = (point[0].split(",") for point in shape)
                course = geometry.points(rows, f"{name}: edge '{shown(key, limit=60)}', shape")
                start_at, end_at = (number[junction] for junction in ends)
                street = key.removeprefix("-")
                ways.append(DrawnEdge(start_at, end_at, course, True, name=key, street=street))  # noqa: FBT003  directed
                continue
        flaws.touched |= {number[end] for end in ends if end in number}
    return embedding.as_world(cls, drawn, ways, flaws, name=stem, largest_part=largest_part)
