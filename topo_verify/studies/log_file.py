"""Reads the log of a robot from a file: JSON Lines, or a CSV table.

| door | degree | marker |
| --- | --- | --- |
|   | 2 | 0 |
| 0 | 3 |   |
| 1 | 2 | 1 |

The first row is the percept at the start; each further row is a door and the percept behind it. An
empty cell may hold a word of `EMPTY`, and a number may end in `.0`, as tables of floats write them.
Commas, semicolons or tabs separate the columns; other columns and empty rows are ignored. A row
with more or fewer cells than titles is refused, since a file that was cut might prove a wrong map.
"""

from __future__ import annotations

import csv
from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from itertools import chain, islice
from os import PathLike, fspath

from topo_verify.errors import InputError, plural
from topo_verify.robot.events import Event, Move, Start, Trace, read_events, write_trace
from topo_verify.robot.percept import MOST_DOORS, Percept
from topo_verify.world.formats import files

COLUMNS = ("door", "degree", "marker")

EMPTY = ("-", "nan", "none", "null", "na")
"""What may stand in an empty cell: `-` is what `tour` prints."""


COMPRESSED_OR_WIDE = (b"\xff\xfe", b"\xfe\xff", b"\x1f\x8b", b"PK\x03")
"""How files in UTF-16, of gzip and of zip begin."""


def read_log(path: str | PathLike[str]) -> Trace:
    """The events in a file of either kind; `-` is standard input. InputError: it holds no log."""
    with _opened(fspath(path)) as (lines, name, is_table):
        return tuple(
            (event for _, event in table_events(lines, name))
            if is_table
            else read_events(lines, name=name)
        )


def line_of(path: str, event: int) -> str:
    """Where in its file an event stands, as `row 7` or `line 7`; "" for standard input."""
    if path == "-":
        return ""
    with _opened(path) as (lines, name, is_table):
        if is_table:
            rows = (row for row, _ in table_events(lines, name))
            return f"row {next(islice(rows, event, None))}"
        filled = (number for number, line in enumerate(lines, 1) if line.strip())
        return f"line {next(islice(filled, event, None))}"


def event_in(path: str, event: int) -> str:
    """An event in words, with its place in its file if it has one: `event 3 (row 5)`."""
    line = path and line_of(path, event)
    return f"event {event} ({line})" if line else f"event {event}"


def write_log(path: str, trace: Trace) -> None:
    """Write the start and the moves as CSV if the name ends in .csv, else every event as JSON."""
    if not path.lower().endswith(".csv"):
        files.write(path, write_trace(trace))
        return
    rows = [",".join(COLUMNS)]
    for event in trace:
        if isinstance(event, Start | Move):
            door = event.door if isinstance(event, Move) else ""
            marker = "" if event.percept.marker is None else event.percept.marker
            rows.append(f"{door},{event.percept.degree},{marker}")
    files.write(path, "\n".join(rows) + "\n")


@contextmanager
def _opened(path: str) -> Generator[tuple[Iterator[bytes], str, bool]]:
    """The lines of a file, its name, and whether they are a CSV table."""
    name = "standard input" if path == "-" else path
    with nullcontext(files.standard_input()) if path == "-" else files.opened(path) as stream:
        lines = files.lines(stream, name=name)
        first: list[bytes] = []
        for line in lines:
            first.append(line)
            if line.strip():
                break
        if first and first[0].startswith(COMPRESSED_OR_WIDE):
            raise InputError(
                f"{name}: expected text in UTF-8, got UTF-16 or a compressed file: convert it"
            )
        head = first[-1].lower().strip() if first else b""
        is_untitled = head[:1].isdigit() or head[:1] in {b",", b";"}
        is_table = name.lower().endswith(".csv") or (
            b"{" not in head and (is_untitled or any(column.encode() in head for column in COLUMNS))
        )
        yield chain(first, lines), name, is_table


def table_events(lines: Iterable[bytes], name: str) -> Iterator[tuple[int, Event]]:
    """The events in the lines of a CSV table with titles, each with its row."""
    titles: list[str] = []
    separator = ","
    begun = False
    rows = (row for line in lines for row in line.splitlines())
    for number, line in enumerate(rows, 1):
        text = line.decode("utf-8-sig", errors="replace")
        if not titles:
            separator = max(",;\t", key=text.count)
        place = f"{name}, row {number}"
        try:
            (row,) = csv.reader([text], delimiter=separator)
        except csv.Error as error:
            raise InputError(f"{place}: expected cells of a table: {error}") from error
        cells = [cell.strip() for cell in row]
        if not any(cells):
            continue
        if not titles:
            titles = [cell.lower() for cell in cells]
            _require_columns(titles, place)
            continue
        if len(cells) != len(titles):
            mend = "is the file cut?"
            if text.startswith("#"):
                mend = "a table has no comments: delete the row"
            elif text.count('"') % 2:
                mend = "a cell may not go on in the next row: write it in one"
            raise InputError(
                f"{place}: expected {plural(len(titles), 'cell')}, as in the row of titles, got"
                f" {len(cells)}; {mend}"
            )
        yield number, _event(dict(zip(titles, cells, strict=True)), place, begun=begun)
        begun = True
    if not begun:
        raise InputError(
            f"{name}: expected a row with the percept at the start, as ',2,0', got none"
        )


def _require_columns(titles: Sequence[str], place: str) -> None:
    for column in COLUMNS:
        if titles.count(column) != 1:
            got = f"two {column!r}" if column in titles else f"no {column!r}"
            if "".join(titles).isdigit():
                got = "a row without titles: begin with them"
            raise InputError(f"{place}: expected the columns {', '.join(COLUMNS)}, got {got}")


def _event(cells: dict[str, str], place: str, *, begun: bool) -> Event:
    door, degree, marker = (cells.get(column, "").removesuffix(".0") for column in COLUMNS)
    door, marker = ("" if text.lower() in EMPTY else text for text in (door, marker))
    if bool(door) != begun:
        expected = "a door, as in every row but the first" if begun else "no door: the robot starts"
        raise InputError(f"{place}: expected {expected}, got {door!r}")
    for column, text in (("door", door), ("degree", degree), ("marker", marker)):
        is_number = text.isascii() and text.isdigit() and len(text) < 10
        if (text or column == "degree") and not (is_number and int(text) <= MOST_DOORS):
            mend = "; leave it empty where no marker is seen" if column == "marker" else ""
            raise InputError(
                f"{place}: expected a whole number from 0 to {MOST_DOORS} as {column},"
                f" got {text!r}{mend}"
            )
    percept = Percept(int(degree), int(marker) if marker else None)
    return Move(int(door), percept) if begun else Start(percept=percept)
