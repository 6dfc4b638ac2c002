"""Graphs that carry a rotation: a world as NetworkX, GraphML and node-link JSON can hold it.

The attributes are those of docs/formats.md, "Graphs with a rotation".
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final, NamedTuple, TypeVar

from topo_verify.errors import InputError, shown
from topo_verify.world import validation
from topo_verify.world.formats import geometry
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)

FORMAT: Final = "topo-verify/graph"
VERSION: Final = 1


class RotatedVertex(NamedTuple):
    """A node with its rotation; `label` is for messages."""

    label: str
    rotation: Any
    name: str | None = None
    at: tuple[float, float] | None = None


class RotatedEdge(NamedTuple):
    """An edge between two vertices, by their numbers."""

    start: int
    end: int
    darts: Any


def as_world(
    cls: type[W],
    vertices: Sequence[RotatedVertex],
    edges: Sequence[RotatedEdge],
    marker: object,
    *,
    source: str,
    about: Mapping[str, str],
) -> W:
    """The world with these rotations; `about` is its name, source and licence."""
    given = {
        "vertices": [vertex.rotation for vertex in vertices],
        "edges": [edge.darts for edge in edges],
        "marker": marker,
    }
    try:
        rotations, pairs, root = validation.map_parts(given)
        world = cls.from_rotations(
            rotations,
            pairs,
            root,
            **about,
            vertex_names=_of_all("name", [vertex.name for vertex in vertices]),
            positions=_of_all("x and y", [vertex.at for vertex in vertices]),
        )
        at = {dart: place for place, rotation in enumerate(rotations) for dart in rotation}
        for edge, (a, b) in zip(edges, pairs, strict=True):
            _require_ends(vertices, edge, (at[a], at[b]), (a, b))
    except InputError as error:
        raise InputError(f"{source}: {error}") from error
    return world


T = TypeVar("T")


def _of_all(subject: str, row: Sequence[T | None]) -> tuple[T, ...]:
    present = tuple(value for value in row if value is not None)
    if present and len(present) < len(row):
        raise InputError(
            f"{len(present)} of {len(row)} nodes have {subject}: give it to each, or to none"
        )
    return present


def _require_ends(
    vertices: Sequence[RotatedVertex],
    edge: RotatedEdge,
    places: tuple[int, int],
    darts: tuple[int, int],
) -> None:
    if Counter(places) != Counter((edge.start, edge.end)):
        joined, turned = (
            " and ".join(repr(shown(vertices[place].label, limit=60)) for place in pair)
            for pair in ((edge.start, edge.end), places)
        )
        raise InputError(
            f"the edge of darts {darts[0]} and {darts[1]} joins the nodes {joined}, but by their"
            f" 'rotation' these darts are at {turned}: correct one of the two"
        )


def point(x: object, y: object, subject: str) -> tuple[float, float] | None:
    """The position with these coordinates; None if both are None."""
    if x is None and y is None:
        return None
    if x is None or y is None:
        raise InputError(f"{subject} has one of x and y: give it both, or none")
    most = sys.float_info.max
    return geometry.number(x, f"{subject}, x", most), geometry.number(y, f"{subject}, y", most)


def attributes(world: World) -> dict[str, Any]:
    """The attributes of the graph."""
    texts = {"name": world.name, "source": world.source, "licence": world.licence}
    return {
        "format": FORMAT,
        "version": VERSION,
        **({} if world.root is None else {"marker": world.root}),
        **{key: text for key, text in texts.items() if text},
    }


def node_attributes(world: World, vertex: int) -> dict[str, Any]:
    """The attributes of one node."""
    attributes: dict[str, Any] = {"rotation": list(world.vertices[vertex])}
    if world.vertex_names:
        attributes["name"] = world.vertex_names[vertex]
    if world.positions:
        attributes["x"], attributes["y"] = map(float, world.positions[vertex])
    return attributes


def texts_of(graph: Mapping[str, Any]) -> dict[str, str]:
    """Name, source and licence among the attributes of a graph."""
    return {key: str(graph[key]) for key in ("name", "source", "licence") if key in graph}


def require_version(kind: object, version: object, *, source: str) -> None:
    """Refuse a graph of another format or of a newer version."""
    if kind != FORMAT:
        raise InputError(
            f"{source}: expected the graph's 'format' {FORMAT!r}, got {_quoted(kind)}: name a file"
            " that `topo-verify world convert` wrote"
        )
    if str(version) != str(VERSION):
        raise InputError(
            f"{source}: expected 'version' {VERSION} of {FORMAT}, got {_quoted(version)}: if it is"
            " newer, update topo-verify"
        )


def require_no_rotation(nodes: Iterable[Mapping[str, Any]], *, source: str) -> None:
    """Refuse a graph without `format` whose nodes have a rotation: it would be overlooked."""
    if any("rotation" in node for node in nodes):
        raise InputError(
            f"{source}: its nodes have a 'rotation', and the graph has no 'format': give the graph"
            f" the 'format' {FORMAT!r} and 'version' {VERSION}, or leave the rotations out"
        )


def _quoted(value: object) -> str:
    return f"'{shown(str(value), limit=60)}'"


def darts_in(text: str, subject: str) -> list[int]:
    """The darts in a text, as `0 5 3`."""
    words = text.split()
    for word in words:
        if not re.fullmatch(r"-?[0-9]{1,18}", word):
            raise InputError(
                f"{subject} has '{shown(word, limit=60)}', expected darts as in '0 5 3', integers"
                " with spaces between them"
            )
    return [int(word) for word in words]
