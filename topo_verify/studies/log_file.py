"""Reads the log of a robot from a file: JSON Lines, or a CSV table.

| door | degree | marker |
| --- | --- | --- |
|   | 2 | 0 |
| 0 | 3 |   |
| 1 | 2 | 1 |

The first row is the percept at the start; each further row is a door and the percept behind it. An
empty cell may hold a word of `EMPTY`, and a number may end in `.0`, as tables of floats write them.
Commas, semicolons or tabs separate the columns; other columns and empty rows are ignored.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator
from contextlib import nullcontext
from itertools import chain

import msgspec

from topo_verify.errors import InputError
from topo_verify.robot.events import Event, Move, Start, Trace, read_events
from topo_verify.robot.percept import Percept
from topo_verify.world.formats import files

COLUMNS = ("door", "degree", "marker")

EMPTY = ("-", "nan", "none", "null", "na")
"""What may stand in an empty cell: `-` is what `tour` prints."""


def read_log(path: str) -> Trace:
    """The events in a file; `-` is standard input. InputError if it holds no log."""
    name = "standard input" if path == "-" else path
    with nullcontext(files.standard_input()) if path == "-" else files.opened(path) as stream:
        lines = files.lines(stream, name=name)
        first: list[bytes] = []
        for line in lines:
            first.append(line)
            if line.strip():
                break
        whole = chain(first, lines)
        head = first[-1].lower().strip() if first else b""
        is_untitled = head[:1].isdigit() or head[:1] in {b",", b";"}
        is_table = b"{" not in head and (
            is_untitled or any(column.encode() in head for column in COLUMNS)
        )
        return tuple(table_events(whole, name) if is_table else read_events(whole, name=name))


def table_events(lines: Iterable[bytes], name: str) -> Iterator[Event]:
    """The events in the lines of a CSV table with titles."""
    titles: list[str] = []
    separator = ","
    begun = False
    for number, line in enumerate(lines, 1):
        text = line.decode("utf-8-sig", errors="replace").strip("\r\n")
        if not titles:
            separator = max(",;\t", key=text.count)
        (row,) = csv.reader([text], delimiter=separator)
        cells = [cell.strip() for cell in row]
        if not any(cells):
            continue
        if titles:
            named = dict(zip(titles, cells, strict=False))
            yield _event(named, f"{name}, row {number}", begun=begun)
            begun = True
            continue
        titles = [cell.lower() for cell in cells]
        for column in COLUMNS:
            if column not in titles:
                columns = ", ".join(COLUMNS)
                raise InputError(
                    f"{name}, row {number}: expected the columns {columns}, got no {column!r}"
                )
    if not begun:
        raise InputError(f"{name}: expected a row with the percept at the start, got none")


def _event(cells: dict[str, str], place: str, *, begun: bool) -> Event:
    door, degree, marker = (cells.get(column, "").removesuffix(".0") for column in COLUMNS)
    door, marker = ("" if text.lower() in EMPTY else text for text in (door, marker))
    if bool(door) != begun:
        expected = "a door, as in every row but the first" if begun else "no door: the robot starts"
        raise InputError(f"{place}: expected {expected}, got {door!r}")
    for column, text in (("door", door), ("degree", degree), ("marker", marker)):
        is_number = text.isascii() and text.isdigit() and len(text) < 10
        if not is_number and (text or column == "degree"):
            raise InputError(
                f"{place}: expected a whole number from 0 on as {column}, got {text!r}"
            )
    data = {"degree": int(degree), "marker": int(marker) if marker else None}
    try:
        percept = msgspec.convert(data, Percept)
    except msgspec.ValidationError as error:
        raise InputError(f"{place}: {error}") from error
    return Move(int(door), percept) if begun else Start(percept=percept)
