"""The option --dask of `search`."""

from __future__ import annotations

from typing import Any

import click


def _chosen(_context: click.Context, _option: click.Parameter, address: str | None) -> Any:
    if address is None:
        return None
    from topo_verify.extra.dask.backend import DaskBackend

    return DaskBackend(address)


dask = click.option(
    "--dask",
    "elsewhere",
    metavar="ADDRESS",
    callback=_chosen,
    help="Work on the Dask cluster of this scheduler; local: start one here.",
)
