"""TARGETs that may be programs: what targets.py names, and `--cmd "program args"`.

A program's text is `--cmd` and its command, as one text: so it travels wherever texts of mappers
do, to workers, ledgers and baselines.

Source: docs/semantics.md, section 16.
"""

from __future__ import annotations

import shlex
import shutil
from hashlib import sha256
from pathlib import Path

from topo_verify.errors import InputError
from topo_verify.harness import targets as mappers
from topo_verify.programs.loading import Target
from topo_verify.programs.program import PREFIX, Program, split


def targets(text: str, *, pick: str | None = None, order: str | None = None) -> tuple[Target, ...]:
    """The mappers that a TARGET names: of the catalogue, of a module or a file, or a program.

    A program runs from its first world on, until it is closed or its object is gone.

    Raises:
        InputError: there is none, or a program was given policies.
    """
    if not text.startswith(PREFIX):
        return mappers.targets(text, pick=pick, order=order)
    if pick is not None or order is not None:
        raise InputError(f"{text}: a program has its own policies; leave --pick and --order out")
    return (Program(text.removeprefix(PREFIX)).target,)


def one_target(text: str, *, pick: str | None = None, order: str | None = None) -> Target:
    """The mapper that a TARGET names, if it is one.

    Raises:
        InputError: as `targets`; or it names several.
    """
    found = targets(text, pick=pick, order=order)
    if len(found) != 1:
        raise InputError(f"{text!r} names {len(found)} mappers: name one")
    return found[0]


def target_text(target: str | None, command: str | None, default: str | None = None) -> str:
    """The text of the TARGET that is given as an argument or by `--cmd`.

    Args:
        default: what is meant if neither is given.
    Raises:
        InputError: none is given, and there is no default; or both are.
    """
    if command is not None and target is None:
        return PREFIX + shlex.join(split(command))
    if command is None and target is None:
        target = default
    if command is not None or target is None:
        raise InputError(
            "name a TARGET, or a program with --cmd 'program args': one of the two, not both"
        )
    return target


def words(text: str) -> tuple[str, ...]:
    """The words of the command line that name this TARGET."""
    return ("--cmd", text.removeprefix(PREFIX)) if text.startswith(PREFIX) else (text,)


def fingerprint(text: str) -> str:
    """A hash of a program: its command, and what stands in the files that it names."""
    command = split(text.removeprefix(PREFIX))
    made = sha256(repr(command).encode())
    for place, word in enumerate(command):
        path = Path((shutil.which(word) or word) if place == 0 else word)
        try:
            made.update(path.read_bytes() if path.is_file() else b"")
        except (OSError, ValueError):  # what cannot be read, or is no name of a file
            continue
    return made.hexdigest()
