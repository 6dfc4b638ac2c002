"""The option --engine of search, explore, record and reproduce."""

from __future__ import annotations

import click

_NAMES = click.Choice(("reference", "compiled"))

engine = click.option(
    "--engine",
    type=_NAMES,
    default="reference",
    show_default=True,
    help="compiled is faster and needs numba; only for the catalogue.",
)

search_engine = click.option(
    "--engine",
    type=_NAMES,
    help="compiled is faster and needs numba.  [default: reference; compiled with --library, and"
    " for a mapper in Python in 50,000 worlds or more]",
)
