"""Options and help that several commands share."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any

import click

from topo_verify.checkers.claims import LARGE
from topo_verify.cli.failures import SUMMARY
from topo_verify.errors import InputError
from topo_verify.harness.engines import ENGINES
from topo_verify.robot.limits import MOST_SECONDS, Limits


def epilog(*examples: str) -> str:
    """The end of a --help: examples, then the exit codes."""
    lines = "\n".join(f"  topo-verify {example}" for example in examples)
    return f"\b\nExamples:\n{lines}\n\n{SUMMARY}"


def _seconds(_context: click.Context, _option: click.Parameter, value: str) -> float:
    """The seconds in a text, above 0 and at most `MOST_SECONDS`."""
    try:
        seconds = float(value)
    except ValueError:
        seconds = math.nan  # NaN fails the comparison below, as the text "nan" does
    if not 0 < seconds <= MOST_SECONDS:
        raise click.BadParameter(f"expected seconds in (0, {MOST_SECONDS}], got {value!r}")
    return seconds


def seed(meaning: str) -> Callable[[Callable[..., int]], Callable[..., int]]:
    """Add --seed, whose help says what it is the seed of."""
    return click.option(
        "--seed",
        type=click.IntRange(min=0),
        default=0,
        show_default=True,
        metavar="N",
        help=meaning,
    )


def limits(command: Callable[..., int]) -> Callable[..., int]:
    """Add the limits of a run in one world; the command gets them as `limits`."""
    usual = Limits()

    @click.option(
        "--budget",
        type=click.IntRange(min=0),
        metavar="N",
        help="Most moves in one world.  [default: the bound of claim cost-within-bound]",
    )
    @click.option(
        "--move-timeout",
        callback=_seconds,
        default=f"{usual.move_timeout:g}",
        show_default=True,
        metavar="SECONDS",
        help="Longest time between two moves.",
    )
    @click.option(
        "--world-timeout",
        callback=_seconds,
        default=f"{usual.world_timeout:g}",
        show_default=True,
        metavar="SECONDS",
        help="Longest time in one world.",
    )
    @wraps(command)
    def wrapper(
        *args: Any, budget: int | None, move_timeout: float, world_timeout: float, **kwargs: Any
    ) -> int:
        return command(*args, limits=Limits(budget, move_timeout, world_timeout), **kwargs)

    return wrapper


def policies(command: Callable[..., int]) -> Callable[..., int]:
    """Add the policies of algorithms of the catalogue; the command gets `pick` and `order`."""
    pick = click.option(
        "--pick",
        metavar="POLICY",
        help="Which edge comes next: nearest, last, first, random(SEED).  [default: nearest]",
    )
    order = click.option(
        "--order",
        metavar="POLICY",
        help="Which hypothesis comes first: shortest, oldest, newest, random(SEED)."
        "  [default: shortest]",
    )
    return pick(order(command))


marker = click.option(
    "--marker", type=int, metavar="DART", help="Let the marker point at this DART instead."
)


MAX_EDGES = 1000
"""The most edges of a world that is counted or drawn here: larger counts take minutes."""

world_class = click.option(
    "--class",
    "kind",
    default="any",
    show_default=True,
    metavar="CLASS",
    help="any, planar, genus:G, genus<=G, simple, loopless, max-degree:D; several with commas.",
)


def make_folder(name: str, option: str) -> Path:
    """The folder that an option names, created if it is missing.

    Raises:
        InputError: it cannot be created.
    """
    try:
        Path(name).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{option} {name}: cannot create this folder: {error.strerror}") from error
    return Path(name)


engine = click.option(
    "--engine",
    type=click.Choice(ENGINES),
    default="reference",
    show_default=True,
    help="What runs algorithms of the catalogue; compiled is faster and needs numba.",
)


in_process = click.option(
    "--in-process",
    is_flag=True,
    help="Run a mapper of your own in this process: faster, and it is trusted not to look around.",
)


def target(command: Callable[..., int]) -> Callable[..., int]:
    """Add TARGET, as an argument or as --target; the command gets it as `target`."""

    @click.argument("target", required=False, metavar="[TARGET]")
    @click.option("--target", "named", metavar="TARGET", help="The same as the argument TARGET.")
    @wraps(command)
    def wrapper(*args: Any, target: str | None, named: str | None, **kwargs: Any) -> int:
        return command(*args, target=one_of(target, named), **kwargs)

    return wrapper


def one_of(target: str | None, named: str | None) -> str | None:
    """The TARGET that is given in one of two ways, the second being --target.

    Raises:
        InputError: it is given in both.
    """
    if target is not None and named is not None:
        raise InputError(f"expected one TARGET, got {target!r} and --target {named}; leave one out")
    return named if target is None else target


program = click.option(
    "--cmd",
    "command",
    metavar="'PROGRAM ARGS'",
    help="Run this program as the TARGET, without a shell; see docs/oracle.md.",
)


strict = click.option(
    "--strict", is_flag=True, help=f"Ask every claim in worlds over {LARGE} edges, too."
)
