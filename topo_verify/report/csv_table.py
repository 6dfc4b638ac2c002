"""Rows as CSV, the same bytes on every machine."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from io import StringIO


def csv_text(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """The rows as CSV, below a row of titles."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(rows)
    return text.getvalue()
