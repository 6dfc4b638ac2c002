"""The options that this extra adds: certificates to `certify`, a second judge to `replay`."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

import click


def certify(command: Callable[..., int]) -> Callable[..., int]:
    """Add --kernel, --check, --log and --timeout; the command gets what they do as `coq`."""
    from topo_verify.cli.options import number
    from topo_verify.robot.limits import MOST_SECONDS

    @click.option(
        "--kernel", "proving", is_flag=True, help="Write a certificate for Coq and check it."
    )
    @click.option(
        "--check", "received", metavar="CERTIFICATE", help="Check a certificate with Coq."
    )
    @click.option("--log", "about", metavar="LOG", help="With --check: it must be about this log.")
    @number(
        "--timeout",
        least=1,
        most=MOST_SECONDS,
        default=600,
        metavar="SECONDS",
        meaning="Time limit of each program that checks a certificate.",
    )
    @wraps(command)
    def wrapper(
        *args: Any,
        proving: bool,
        received: str | None,
        about: str | None,
        timeout: int,
        **kwargs: Any,
    ) -> int:
        from topo_verify.extra.certificates.certify import CoqCertifier

        coq = CoqCertifier(proving=proving, received=received, about=about, timeout=timeout)
        return command(*args, coq=coq, **kwargs)

    return wrapper


def _judge(_context: click.Context, _option: click.Parameter, wanted: bool) -> Any:  # noqa: FBT001  click passes it so
    """The module that has the proved judge judge a run; None without."""
    if not wanted:
        return None
    from topo_verify.extra.certificates import replay

    return replay


kernel = click.option(
    "--kernel",
    "second",
    is_flag=True,
    callback=_judge,
    help="Have the judge proved in Coq judge, too.",
)
