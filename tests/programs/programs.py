"""What the tests of the oracle share: programs to be run, and what becomes of one world."""

from __future__ import annotations

import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from topo_verify import World
from topo_verify.harness.conform.examiner import Examiner
from topo_verify.harness.conform.outcome import ConformJob, WorldResult
from topo_verify.harness.corpus import Named, corpus_from
from topo_verify.robot.limits import Limits

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
EXAMPLES = ROOT / "examples"


def python(*words: object) -> str:
    """A TARGET: these words behind this Python."""
    return "--cmd " + shlex.join([sys.executable, *map(str, words)])


def served(target: str) -> str:
    """A TARGET: a Python mapper behind the pipe."""
    return python("-m", "topo_verify.programs.serve", target)


def misbehaving(way: str) -> str:
    """A TARGET: the program that misbehaves in one way."""
    return python(HERE / "misbehaving.py", way)


def compiled(source: Path, folder: Path, *flags: str) -> str:
    """A TARGET: a program in C."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        pytest.skip("no C compiler here (neither cc nor gcc)")
    made = folder / source.stem
    words = [compiler, "-O2", "-Wall", "-Wextra", "-Werror", *flags, "-o", str(made), str(source)]
    subprocess.run(words, check=True)
    return f"--cmd {made}"


def javascript(source: Path) -> str:
    """A TARGET: a program in JavaScript."""
    node = shutil.which("node")
    if node is None:
        pytest.skip("no node here")
    return "--cmd " + shlex.join([node, str(source)])


def named(*ids: str) -> list[Named]:
    """Worlds by their ids."""
    return [Named(text, World.from_id(text), text, ("--worlds", text)) for text in ids]


def outcomes(
    target: str, *ids: str, limits: Limits | None = None, **more: Any
) -> list[WorldResult]:
    """What becomes of these worlds, or of WORLDS that are no ids, one after the other."""
    job = ConformJob(target=target, limits=limits or Limits(), **more)
    worlds = named(*ids) if ids and ids[0].startswith("m") else corpus_from(ids)
    with Examiner(job) as examiner:
        return [examiner.examine(at) for at in worlds]


def kinds(made: WorldResult) -> list[str]:
    """The kinds of what is wrong, level by level."""
    return [found.kind for level in made.findings.values() for found in level]


def messages(made: WorldResult) -> str:
    """All that is said of what is wrong."""
    return "\n".join(found.message for level in made.findings.values() for found in level)
