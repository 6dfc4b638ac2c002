"""--report, --junit and --badge: the account of a run, written to files when it has ended.

Each file is asked before the work begins whether it can be written, and is written whole or not at
all. What was done before an interrupt is written, too, and says that it is not all.
"""

from __future__ import annotations

import os
import platform
import shlex
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

from topo_verify.cli.failures import version
from topo_verify.errors import InputError, shown
from topo_verify.report.account import Account, Ending
from topo_verify.report.badge import badge
from topo_verify.report.junit import junit
from topo_verify.report.page import report_page
from topo_verify.world.formats import files

TAKE_PART = ("z3-solver", "hypothesis", "msgspec", "networkx", "numpy", "scipy")
"""The libraries whose versions a page names, since a result may depend on them."""

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

    def write(self, account: Account, ending: Ending) -> None:
        """Write the files that were asked for.

        Raises:
            InputError: one of them cannot be written.
        """
        if self.report is not None:
            files.write(self.report, report_page(account, ending))
        if self.junit is not None:
            files.write(self.junit, junit(account, ending))
        if self.badge is not None:
            files.write(self.badge, badge(account))

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


def versions() -> dict[str, str]:
    """The versions of the package, of Python and of the libraries that take part."""
    own = {"topo-verify": version(), platform.python_implementation(): platform.python_version()}
    return own | {name: metadata.version(name) for name in TAKE_PART}
