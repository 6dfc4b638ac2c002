"""Blocks on a terminal.

A table that is too wide narrows its text columns down to their longest word, but never breaks
numbers and verdicts; if they do not fit, each row becomes a list.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from io import StringIO
from typing import IO, TYPE_CHECKING

from topo_verify.errors import LINE, shown
from topo_verify.report import blocks as bl
from topo_verify.report.blocks import ON_TERMINAL, TONES, VERDICTS

if TYPE_CHECKING:
    from rich.console import Console, RenderableType
    from rich.text import Text as Line

LONGEST_WORD = 20
"""Longer words may be broken."""

GAP = 2

LEAST_REST = 20
"""Least width of a column of width 0."""


def pretty(blocks: Iterable[bl.Block], out: IO[str], *, plain: bool = False) -> str:
    """The blocks as text for a terminal's width, else for COLUMNS, else for 80 columns.

    `plain`: without colours, whatever FORCE_COLOR says.
    """
    console = None
    lines: list[str] = []
    for block in blocks:
        if isinstance(block, bl.PictureBlock):
            continue
        if isinstance(block, bl.Raw):
            lines.append(block.text)  # not by Rich, which would wrap it and takes its time
            continue
        console = console or _console(out, plain=plain)
        if isinstance(block, bl.View):
            lines += block.lines(console.width)
            continue
        with console.capture() as printed:
            _print(block, console)
        lines += (line.rstrip() for line in printed.get().splitlines())
    return "".join(f"{line}\n" for line in lines)


def _console(out: IO[str], *, plain: bool) -> Console:
    from rich.console import Console

    wide = None if out.isatty() else _columns()
    return Console(
        file=StringIO(),  # Rich writes to it, though all is captured
        force_terminal=out.isatty() or None,
        width=wide,
        color_system=None if plain else "auto",
        highlight=False,
        markup=False,
        emoji=False,
        force_jupyter=False,
    )


def _columns() -> int:
    text = os.environ.get("COLUMNS", "")
    return int(text) if text.isascii() and text.isdigit() and 20 <= int(text) <= 1000 else bl.WIDTH


def _print(block: bl.Text | bl.Command | bl.Bullets | bl.TextTable, console: Console) -> None:
    from rich.padding import Padding
    from rich.text import Text as Line

    match block:
        case bl.Text(text):
            line = Line(bl.clean(text))
            if verdict := bl.opening_verdict(text):
                line.stylize(ON_TERMINAL[TONES[verdict]], 0, len(verdict))
            console.print(line)
        case bl.Command(line, label):
            # Not `clean`: a long id stays whole, for copying.
            console.print(Line(f"  {label}{shown(line, limit=LINE)}"), soft_wrap=True)
        case bl.Bullets(items):
            for item in items:
                console.print(Padding(Line(bl.clean(item)), (0, 0, 0, 2)))
        case bl.TextTable():
            widths = column_widths(block, console.width)
            if block.title:
                console.print(Line(bl.clean(block.title), style="bold"))
            if widths is not None:
                console.print(_grid(block, widths))
            else:
                for row in block.rows:
                    _print_list(block, row, console)


# ---------------------------------------------------------------- tables


def column_widths(table: bl.TextTable, width: int) -> list[int] | None:
    """The column widths in a line of this width; None if they do not fit."""
    room = width - GAP * (len(table.columns) - 1)
    least = [_least(table, place) for place in range(len(table.columns))]
    if table.widths:
        rest = room - sum(table.widths)
        if rest < (LEAST_REST if 0 in table.widths else 0):
            return None
        return [fixed or rest for fixed in table.widths]
    widths = [_most(table, place) for place in range(len(table.columns))]
    while sum(widths) > room:
        spare = [have - need for have, need in zip(widths, least, strict=True)]
        if max(spare) <= 0:
            return None
        widest = max((w for w, s in zip(widths, spare, strict=True) if s > 0), default=0)
        place = next(i for i, w in enumerate(widths) if w == widest and spare[i] > 0)
        widths[place] -= 1
    return widths


def _most(table: bl.TextTable, place: int) -> int:
    title = _title(table.columns[place]) if table.headed else ""
    return max(_length(title), *(_length(bl.cell_text(row[place])) for row in table.rows), 1)


def _least(table: bl.TextTable, place: int) -> int:
    whole = table.columns[place].startswith(">")
    longest = [_word(_title(table.columns[place])) if table.headed else 0]
    for row in table.rows:
        text = bl.cell_text(row[place])
        cell = row[place]
        word = cell if isinstance(cell, str) else cell.text
        longest.append(_length(text) if whole or word in VERDICTS else _word(text))
    return max(*longest, 1)


def _word(text: str) -> int:
    return min(max(map(_length, text.split()), default=0), LONGEST_WORD)


def _length(text: str) -> int:
    from rich.cells import cell_len

    return cell_len(text)


def _title(column: str) -> str:
    return bl.clean(column.removeprefix(">"))


def _grid(table: bl.TextTable, widths: Sequence[int]) -> RenderableType:
    from rich.table import Table as RichTable

    padding = (0, GAP, 0, 0)
    grid = RichTable(box=None, show_header=table.headed, pad_edge=False, padding=padding)
    for title, width in zip(table.columns, widths, strict=True):
        right = title.startswith(">")
        grid.add_column(
            _title(title), justify="right" if right else "left", overflow="fold", width=width
        )
    for row in table.rows:
        grid.add_row(*map(_line, row))
    return grid


def _line(cell: str | bl.Cell) -> Line:
    from rich.text import Text as Line

    tone = bl.cell_tone(cell)
    return Line(bl.cell_text(cell), style=ON_TERMINAL[tone] if tone else "")


def _print_list(table: bl.TextTable, row: Sequence[str | bl.Cell], console: Console) -> None:
    from rich.padding import Padding
    from rich.table import Table as RichTable
    from rich.text import Text as Line

    title = f"{_title(table.columns[0])} " if table.columns[0].startswith(">") else ""
    console.print(Line(title).append_text(_line(row[0])))
    cells = [(t, c) for t, c in zip(table.columns[1:], row[1:], strict=True) if bl.cell_text(c)]
    grid = RichTable(box=None, show_header=False, pad_edge=False, padding=(0, GAP, 0, 0))
    widest = max((_length(_title(title)) for title, _ in cells), default=0)
    grid.add_column(width=min(widest, console.width // 2), overflow="fold")
    grid.add_column(overflow="fold")
    for title, cell in cells:
        grid.add_row(_title(title), _line(cell))
    console.print(Padding(grid, (0, 0, 0, 2)))
