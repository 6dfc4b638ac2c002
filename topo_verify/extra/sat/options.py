"""The options that this extra adds to `prove`: --solver and --certify."""

from __future__ import annotations

from typing import Any

import click


def _second(_context: click.Context, _option: click.Parameter, name: str) -> Any:
    """The module of the second solver; None for Z3 alone."""
    if name == "z3":
        return None
    from topo_verify.extra.sat import cvc5_solver

    return cvc5_solver


solver = click.option(
    "--solver",
    "second",
    type=click.Choice(["z3", "cvc5"]),
    default="z3",
    show_default=True,
    callback=_second,
    help="cvc5: ask cvc5 every question as well.",
)


def _certifier(_context: click.Context, _option: click.Parameter, wanted: bool) -> Any:  # noqa: FBT001  click passes it so
    """The module that makes certificates; None without."""
    if not wanted:
        return None
    from topo_verify.extra.sat import drup

    return drup


certify = click.option(
    "--certify",
    "certifier",
    is_flag=True,
    callback=_certifier,
    help="Make and check certificates of bounded theorems.",
)
