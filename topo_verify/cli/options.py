"""Options and help that several commands share."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import wraps
from typing import Any

import click

from topo_verify.cli.failures import SUMMARY
from topo_verify.robot.limits import Limits


def epilog(*examples: str) -> str:
    """The end of a --help: examples, then the exit codes."""
    lines = "\n".join(f"  topo-verify {example}" for example in examples)
    return f"\b\nExamples:\n{lines}\n\n{SUMMARY}"


MOST_SECONDS = 10**6
"""The longest time limit, some eleven days."""


def _seconds(_context: click.Context, _option: click.Parameter, value: str) -> float:
    """A number of seconds, finite and above 0."""
    try:
        seconds = float(value)
    except ValueError:
        seconds = math.nan
    if not 0 < seconds <= MOST_SECONDS:
        raise click.BadParameter(
            f"{value!r} is no number of seconds, above 0 and up to {MOST_SECONDS}"
        )
    return seconds


def limits(command: Callable[..., int]) -> Callable[..., int]:
    """The limits of each run of a mapper, handed over as `limits`."""
    usual = Limits()

    @click.option(
        "--budget",
        type=click.IntRange(min=0),
        metavar="N",
        help="Moves in a world.  [default: the bound of claim cost-within-bound]",
    )
    @click.option(
        "--move-timeout",
        callback=_seconds,
        default=f"{usual.move_timeout:g}",
        show_default=True,
        metavar="SECONDS",
        help="Between two moves.",
    )
    @click.option(
        "--world-timeout",
        callback=_seconds,
        default=f"{usual.world_timeout:g}",
        show_default=True,
        metavar="SECONDS",
        help="In a world.",
    )
    @wraps(command)
    def wrapper(
        *args: Any, budget: int | None, move_timeout: float, world_timeout: float, **kwargs: Any
    ) -> int:
        return command(*args, limits=Limits(budget, move_timeout, world_timeout), **kwargs)

    return wrapper


def policies(command: Callable[..., int]) -> Callable[..., int]:
    """The policies of algorithms of the catalogue, handed over as `pick` and `order`."""
    pick = click.option(
        "--pick",
        metavar="POLICY",
        help="Which edge next: nearest, last, first, random(SEED).  [default: nearest]",
    )
    order = click.option(
        "--order",
        metavar="POLICY",
        help="Which hypothesis first: shortest, oldest, newest, random(SEED).  [default: shortest]",
    )
    return pick(order(command))


marker = click.option(
    "--marker", type=int, metavar="DART", help="Lay the marker elsewhere: let it point at DART."
)


MAX_EDGES = 1000
"""The most edges that worlds are counted and drawn with here: beyond, the numbers take minutes."""

world_class = click.option(
    "--class",
    "kind",
    default="any",
    show_default=True,
    metavar="CLASS",
    help="any, planar, genus:G, genus<=G, simple, loopless, max-degree:D; several with commas.",
)


program = click.option(
    "--cmd",
    "command",
    metavar="'PROGRAM ARGS'",
    help="A program in place of a TARGET, run without a shell: docs/oracle.md.",
)
