"""Reads the log of a robot from a file: JSON Lines, or a CSV table.

| door | degree | marker |
| --- | --- | --- |
|   | 2 | 0 |
| 0 | 3 |   |
| 1 | 2 | 1 |

The first row is the percept at the start; each further row is a door and the percept behind it. An
empty cell may hold a word of `EMPTY`, and a number may be a float, as `2.00`, `2,0` or `2e+00`.
Commas, semicolons or tabs separate the columns, or what a first line says, as Excel's `sep=;`.
Other columns and empty rows are ignored. A row with more or fewer cells than titles is refused,
since a file that was cut might prove a wrong map.

Why not pandas or `csv.Sniffer`? Both guess: they fill or drop the cells of a file that was cut.
"""

from __future__ import annotations

import csv
import re
from codecs import BOM_UTF8
from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from decimal import Decimal
from itertools import chain, islice
from os import PathLike, fspath

from topo_verify.errors import InputError, plural
from topo_verify.robot.events import Event, Move, Start, Trace, read_events, write_trace
from topo_verify.robot.percept import MOST_DOORS, Percept
from topo_verify.world.formats import files

COLUMNS = ("door", "degree", "marker")

EMPTY = ("-", "nan", "none", "null", "na", "n/a", "<na>", "#n/a", "nat", "nil", "\\n")
"""What may stand in an empty cell: `-` is what `tour` prints, the others what databases write."""


WIDE = (b"\xff\xfe", b"\xfe\xff")
"""How files in UTF-16 begin."""

_SEPARATOR = re.compile(r'"?sep=(.)"?[,;\t]*', re.IGNORECASE)
_NUMBER = re.compile(r"\+?[0-9]{1,9}(?:\.[0-9]{0,40})?(?:e[+-]?[0-9]{1,2})?", re.IGNORECASE)


def read_log(path: str | PathLike[str]) -> Trace:
    """The events in a file of either kind; `-` is standard input. InputError: it holds no log."""
    with _opened(fspath(path)) as (lines, name, is_table):
        return tuple(
            (event for _, event in table_events(lines, name))
            if is_table
            else json_events(lines, name)
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
        if first and first[0].startswith(WIDE):
            raise InputError(f"{name}: expected text in UTF-8, got UTF-16: save it as UTF-8")
        head = first[-1].removeprefix(BOM_UTF8).lower().strip() if first else b""
        is_untitled = head[:1].isdigit() or head[:1] in {b",", b";"}
        titles = (*COLUMNS, "sep=")
        is_table = files.unpacked_name(name).lower().endswith(".csv") or (
            b"{" not in head and (is_untitled or any(title.encode() in head for title in titles))
        )
        yield chain(first, lines), name, is_table


def json_events(lines: Iterable[bytes], name: str) -> Iterator[Event]:
    """The events in the lines of JSON; a marker of -1 is refused, it would be door -1."""
    for number, event in enumerate(read_events(lines, name=name)):
        if isinstance(event, Start | Move) and event.percept.marker == -1:
            raise InputError(
                f"{name}, event {number}: the marker is -1: write null where no marker is seen"
            )
        yield event


def table_events(lines: Iterable[bytes], name: str) -> Iterator[tuple[int, Event]]:
    """The events in the lines of a CSV table with titles, each with its row."""
    titles: list[str] = []
    given = separator = ""
    begun = False
    rows = (row for line in lines for row in line.splitlines())
    for number, line in enumerate(rows, 1):
        text = line.decode("utf-8-sig", errors="replace")
        if not titles:
            separator = given or max(",;\t", key=text.count)
            if not given and (match := _SEPARATOR.fullmatch(text.strip(" "))):
                given = match[1]
                continue
        place = f"{name}, row {number}"
        try:
            (row,) = csv.reader([text], delimiter=separator, strict=True)
        except csv.Error as error:
            raise InputError(
                f"{place}: expected cells of a table: {error}; a cell in quotes ends in its row"
            ) from error
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
    texts = {column: cells.get(column, "") for column in COLUMNS}
    is_empty = {column: text.lower() in ("", *EMPTY) for column, text in texts.items()}
    if is_empty["door"] == begun:
        expected = "a door, as in every row but the first" if begun else "no door: the robot starts"
        mend = "" if begun else "; leave it empty"
        raise InputError(f"{place}: expected {expected}, got {texts['door']!r}{mend}")
    numbers: dict[str, int | None] = {}
    for column, text in texts.items():
        numbers[column] = None if is_empty[column] else _number(text)
        if numbers[column] is None and (not is_empty[column] or column == "degree"):
            mend = "; leave it empty where no marker is seen" if column == "marker" else ""
            raise InputError(
                f"{place}: expected a whole number from 0 to {MOST_DOORS} as {column},"
                f" got {text!r}{mend}"
            )
    door, degree = numbers["door"] or 0, numbers["degree"] or 0
    percept = Percept(degree, numbers["marker"])
    return Move(door, percept) if begun else Start(percept=percept)


def _number(text: str) -> int | None:
    """The whole number, also written as a float; a comma before one or two zeros is decimal."""
    text = re.sub(r",(0{1,2})$", r".\1", text)
    if not _NUMBER.fullmatch(text):
        return None
    value = Decimal(text)
    return int(value) if value <= MOST_DOORS and value == value.to_integral_value() else None
