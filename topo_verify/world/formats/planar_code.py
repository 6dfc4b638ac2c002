"""planar_code: the binary format of plantri, for simple worlds, many to a file.

    >>planar_code<<  3  2 3 0  1 3 0  1 2 0       (a triangle; a number is a byte)

After the optional head come the graphs: the number of vertices, then for each vertex its neighbours
in clockwise order, from 1, and a zero. With more than 255 vertices a graph begins with a zero byte
and has numbers of two bytes, the high byte first unless the head is `>>planar_code le<<`. Files may
be joined: a head may stand before each graph, and lines may end behind one.

Rotations of any genus are read, as surftri and multi_genus write them; planar ones are written,
since other programs expect no others. What this does not show: that the writer meant clockwise; a
mirror image is a valid file.

Source: docs/formats.md; G. Brinkmann and B. D. McKay, plantri-guide.txt; the guide of CaGe and
    `planarg` of nauty 2.8 (head, byte order).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import accumulate
from os import PathLike
from typing import TypeVar

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)

MAX_VERTICES = 2**16 - 1

_HEAD = re.compile(rb">>planar_code(?: ?(le|be))? ?<<")

_BETWEEN = re.compile(rb"[\r\n]*+(?:(?=>>)|\Z)")
"""Ends of lines, which would else be the beginning of a graph of 10 or 13 vertices."""


def decode(
    cls: type[W],
    data: bytes,
    *,
    name: str = "planar_code",
    graph: int | None = None,
    stem: str = "",
) -> W:
    """The world in the bytes.

    Args:
        graph: its index; default: the only one.
        stem: the name of the world; with `graph`, the index follows.
    """
    neighbours = None
    number = -1
    for number, rows in enumerate(_graphs(data, name)):
        if number == (graph or 0):
            neighbours = rows
        if number == graph:
            break
    if number > 0 and graph is None:
        raise InputError(
            f"{name} holds {number + 1} graphs: say which, counted from 0, as in {name}:0 on the"
            " command line or World.load(path, graph=0) in Python; planar_code.worlds(path) has all"
        )
    if neighbours is None:
        held = f"{number + 1} graphs" if number >= 0 else "no graph"
        asked = "" if graph is None else f", and graph {graph} (counted from 0) is none of them"
        raise InputError(f"{name} holds {held}{asked}: name a file with the graph that is meant")
    title = stem if graph is None or not stem else f"{stem}-{graph}"
    return _world(cls, neighbours, name if graph is None else f"{name}, graph {graph}", title)


def worlds(path: str | PathLike[str]) -> Iterator[World]:
    """The worlds of a file of planar_code, in its order; raises as `World.load`."""
    name, stem = shown(path), files.stem(path)
    for number, rows in enumerate(_graphs(files.unpacked(files.read(path), name), name)):
        yield _world(World, rows, f"{name}, graph {number}", f"{stem}-{number}")


def encode(world: World) -> bytes:
    """The world as a file with one graph and a head.

    Raises:
        InputError: the world is not simple, not planar, or has more than `MAX_VERTICES` vertices.
    """
    require_simple_and_planar(world, "planar_code")
    if len(world.vertices) > MAX_VERTICES:
        raise InputError(
            f"planar_code numbers vertices up to {MAX_VERTICES}, and the world has"
            f" {len(world.vertices)}: write it as json"
        )
    degrees, alpha = world.code
    ends = list(accumulate(degrees))
    vertex_of = [vertex for vertex, degree in enumerate(degrees, 1) for _ in range(degree)]
    numbers = [len(degrees)]
    for end, degree in zip(ends, degrees, strict=True):
        numbers += [vertex_of[alpha[dart]] for dart in range(end - degree, end)]
        numbers.append(0)
    if len(degrees) < 256:
        return b">>planar_code<<" + bytes(numbers)
    wide = b"".join(number.to_bytes(2, "big") for number in numbers)
    return b">>planar_code be<<\0" + wide


def require_simple_and_planar(world: World, subject: str) -> None:
    """Refuse any other world."""
    if not world.is_simple:
        raise InputError(
            f"{subject} holds simple worlds, and this one has loops or parallel edges: keep it as"
            " world JSON"
        )
    if not world.is_planar:
        raise InputError(
            f"{subject} holds planar worlds, and this one has genus {world.genus}: keep it as world"
            " JSON"
        )


def _graphs(data: bytes, name: str) -> Iterator[list[Sequence[int]]]:
    little = False
    at = number = 0
    while True:
        if number and (between := _BETWEEN.match(data, at)):
            at = between.end()
        if data.startswith(b">>", at):
            head = _HEAD.match(data, at)
            if head is None:
                raise InputError(
                    f"{name}: expected the head '>>planar_code<<' at byte {at}, got"
                    f" '{shown(data[at : at + 20].decode('latin-1'))}'"
                )
            little, at = head[1] == b"le", head.end()
        if at >= len(data):
            return
        rows, at = _graph(data, at, f"{name}, graph {number}", little=little)
        yield rows
        number += 1


def _graph(data: bytes, at: int, name: str, *, little: bool) -> tuple[list[Sequence[int]], int]:
    wide = data[at] == 0  # no graph has 0 vertices
    size = data[at]
    if wide:
        size = int.from_bytes(data[at + 1 : at + 3], "little" if little else "big")
        if len(data) < at + 3 or not size:
            raise InputError(f"{name}: expected a number of vertices at byte {at}, got none")
    at += 3 if wide else 1
    rows: list[Sequence[int]] = []
    for vertex in range(1, size + 1):
        row, at = _wide_row(data, at, little=little) if wide else _row(data, at)
        if at > len(data):
            raise InputError(
                f"{name} ends within the neighbours of vertex {vertex} of {size}: the file is cut"
                " off; write it again"
            )
        rows.append(row)
    return rows, at


def _row(data: bytes, at: int) -> tuple[Sequence[int], int]:
    """The numbers up to the next zero, and the position behind it."""
    end = data.find(0, at)
    return (data[at:end], end + 1) if end >= 0 else ((), len(data) + 1)


def _wide_row(data: bytes, at: int, *, little: bool) -> tuple[Sequence[int], int]:
    row: list[int] = []
    while at + 2 <= len(data):
        number = int.from_bytes(data[at : at + 2], "little" if little else "big")
        at += 2
        if not number:
            return row, at
        row.append(number)
    return (), len(data) + 1


def _world(cls: type[W], rows: list[Sequence[int]], name: str, title: str) -> W:
    dart_of: dict[tuple[int, int], int] = {}
    rotations: list[list[int]] = []
    for vertex, row in enumerate(rows, 1):
        for other in row:
            _require_neighbour(vertex, other, len(rows), name)
            if (vertex, other) in dart_of:
                raise InputError(
                    f"{name}: vertex {vertex} names its neighbour {other} twice: only simple"
                    " graphs can be read, parallel edges look alike in planar_code"
                )
            dart_of[vertex, other] = len(dart_of)
        rotations.append([dart_of[vertex, other] for other in row])
    for vertex, other in dart_of:
        if (other, vertex) not in dart_of:
            raise InputError(
                f"{name}: vertex {vertex} names {other} as a neighbour, but {other} does not name"
                f" {vertex}: an edge stands at both its ends"
            )
    edges = [(dart, dart_of[b, a]) for (a, b), dart in dart_of.items() if a < b]
    try:
        return cls.from_rotations(rotations, edges, 0 if dart_of else None, name=title)
    except InputError as error:
        raise InputError(f"{name}: {error}") from error


def _require_neighbour(vertex: int, other: int, size: int, name: str) -> None:
    if other > size:
        raise InputError(
            f"{name}: vertex {vertex} names the neighbour {other}, and the vertices are 1 … {size}"
        )
    if other == vertex:
        raise InputError(f"{name}: vertex {vertex} is its own neighbour: loops cannot be read")
