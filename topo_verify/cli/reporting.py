"""--report, --junit and --badge: what a run came to, written to files when it has ended.

Each file is asked before the work begins whether it can be written, and is written whole or not at
all. What was done before an interrupt is written, too, and says that it is not all.
"""

from __future__ import annotations

import os
import platform
import shlex
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial, wraps
from importlib import metadata
from pathlib import Path
from typing import Any, Concatenate, ParamSpec, cast

import click

from topo_verify.cli.failures import ExitCode, version
from topo_verify.cli.output import Ending, Output
from topo_verify.errors import InputError, shown
from topo_verify.report.account import Account
from topo_verify.report.badge import badge
from topo_verify.report.junit import JunitRun, junit
from topo_verify.report.page import PageFacts, report_page
from topo_verify.world.formats import files

P = ParamSpec("P")

TAKE_PART = ("z3-solver", "hypothesis", "msgspec", "networkx", "numpy", "scipy")
"""The libraries whose versions a page names, since a result may depend on them."""

_EXITS = {
    ExitCode.NOTHING_FOUND: "nothing found in what was checked",
    ExitCode.CLAIM_FAILED: "a claim fails, or something is not as expected",
    ExitCode.INCOMPLETE: "incomplete; what was not decided is no pass",
}

_PRINTING = {"--report": 1, "--junit": 1, "--badge": 1, "--format": 1, "--quiet": 0}
"""Options that say how results are shown, and how many words follow each."""


@dataclass(frozen=True)
class ReportFiles:
    """The files that one call asks for; None: not this one."""

    report: str | None = None
    junit: str | None = None
    badge: str | None = None

    @property
    def named(self) -> dict[str, str]:
        """The file of each option that was given."""
        pairs = (("--report", self.report), ("--junit", self.junit), ("--badge", self.badge))
        return {option: name for option, name in pairs if name is not None}

    def check(self) -> None:
        """Raise InputError if it can be seen now that one of the files cannot be written."""
        for option, name in self.named.items():
            if (objection := _objection(name)) is not None:
                raise InputError(f"{option} {shown(name)}: {objection}; name a file to be written")
        places = [os.path.realpath(name) for name in self.named.values()]
        regular = [place for place in places if not Path(place).exists() or Path(place).is_file()]
        if len(set(regular)) < len(regular):
            raise InputError(
                f"expected different files for {' and '.join(self.named)}: one would overwrite the"
                " other"
            )


def _objection(name: str) -> str | None:
    """Why a file of this name cannot be written, as far as that is known now."""
    if name == "-":
        return "standard output is for the results"
    try:
        place = Path(os.path.realpath(name))
        if place.is_dir():
            return "this is a folder"
        if not place.parent.is_dir():
            return f"there is no folder {shown(place.parent)}"
        # An existing regular file is replaced by a new one, so the folder decides.
        target = place if place.exists() and not place.is_file() else place.parent
        if not os.access(target, os.W_OK):
            return "no permission to write there"
    except (OSError, ValueError) as error:  # ValueError: a null character
        return str(error)
    return None


def report_options(
    command: Callable[Concatenate[Output, P], int],
) -> Callable[Concatenate[Output, P], int]:
    """Add --report, --junit and --badge to a command that gives an account of its results."""

    @click.option("--report", metavar="FILE.html", help="Write one self-contained page.")
    @click.option("--junit", metavar="FILE.xml", help="Write a JUnit file, a case a judged thing.")
    @click.option("--badge", metavar="FILE.svg", help="Write a badge: verdict, and of how much.")
    @wraps(command)
    def wrapper(output: Output, /, *args: P.args, **kwargs: P.kwargs) -> int:
        named: Any = {name: kwargs.pop(name, None) for name in ("report", "junit", "badge")}
        asked = ReportFiles(**named)
        asked.check()
        output.exhibits = asked.report is not None
        output.report = partial(write_reports, asked) if asked.named else None
        return command(output, *args, **kwargs)

    return wrapper


def command_line(arguments: Sequence[str]) -> str:
    """The command line of these arguments, without those that say how results are shown."""
    words, rest = ["topo-verify"], iter(arguments)
    for word in rest:
        option, equals, _ = word.partition("=")
        if option not in _PRINTING:
            words.append(word)
        elif not equals and _PRINTING[option]:
            next(rest, None)
    return shlex.join(words)


def write_reports(asked: ReportFiles, account: Account, ending: Ending) -> None:
    """Write the files that were asked for.

    Raises:
        InputError: one of them cannot be written.
    """
    again = command_line(click.get_current_context().obj or ())
    now = datetime.now(UTC).replace(microsecond=0)
    if asked.report is not None:
        files.write(asked.report, report_page(account, _facts(ending, again, now)))
    if asked.junit is not None:
        files.write(asked.junit, junit(account, _run(ending, again, now)))
    if asked.badge is not None:
        files.write(asked.badge, badge(account))


def _facts(ending: Ending, again: str, now: datetime) -> PageFacts:
    return PageFacts(
        command=ending.command,
        again=again,
        exit_code=ending.code,
        exit_words=_EXITS[ExitCode(ending.code)],
        finished=ending.finished,
        versions=_versions(),
        timing={
            "written": f"{now:%Y-%m-%d %H:%M:%S} UTC",
            "took": f"{ending.seconds:.1f} s",
            **dict(_flat(ending.timing)),
        },
    )


def _flat(timing: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, str]]:
    """Each figure with the names that lead to it, as `ms_per_move, lattices, folding`."""
    for name, value in timing.items():
        path = f"{before}, {name}" if before else name
        if isinstance(value, dict):
            yield from _flat(cast("dict[str, Any]", value), path)
        else:
            yield path, str(value)


def _run(ending: Ending, again: str, now: datetime) -> JunitRun:
    return JunitRun(
        command=ending.command,
        again=again,
        finished=ending.finished,
        date=f"{now:%Y-%m-%dT%H:%M:%S}",
        seconds=ending.seconds,
        by_suite=ending.by_result,
    )


def _versions() -> dict[str, str]:
    own = {"topo-verify": version(), platform.python_implementation(): platform.python_version()}
    return own | {name: metadata.version(name) for name in TAKE_PART}
