"""What the tests of the oracle share: programs to be run, and what becomes of one world."""

from __future__ import annotations

import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from topo_verify.campaign.backend import here
from topo_verify.campaign.campaign import Campaign, ListedWorlds, results
from topo_verify.studies.conform.conform import Asked, Conform, WorldOutcome, outcome_of
from topo_verify.studies.corpus import Corpus, CorpusWorlds, corpus_from

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


def deadly(folder: Path, deed: str, *, once: bool) -> str:
    """A mapper that is right, but does this where the robot sees a loop; once or each time."""
    done = folder / "done"
    mapper = folder / "deadly.py"
    mapper.write_text(
        "import os\nimport topo_verify as tv\nfrom pathlib import Path\n"
        "def explore(robot):\n"
        f"    if robot.percept.degree == 2 and not Path({str(done)!r}).exists():\n"
        f"        Path({str(done if once else folder)!r}).touch()\n"
        f"        {deed}\n"
        "    return tv.CATALOGUE['basic'](robot)\n"
    )
    return f"{mapper}:explore"


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


def conforming(target: str, corpus: Corpus, **more: Any) -> Conform:
    """The study of an implementation; `more`: fields of `Asked` and of the campaign."""
    asked = Asked(**{name: more.pop(name) for name in Asked._fields if name in more})
    worlds = ListedWorlds(corpus.total)
    return Conform(Campaign(worlds=worlds, mappers=(target,), **more), corpus, asked)


def outcomes(target: str, *texts: str, **more: Any) -> list[WorldOutcome]:
    """What becomes of these worlds, one after the other."""
    corpus = corpus_from(texts)
    study = conforming(target, corpus, **more)
    found = results(study.campaign, here(), CorpusWorlds(corpus))
    return [outcome_of(row, study.asked.like) for _, result in found for row in result.rows]


def kinds(made: WorldOutcome) -> list[str]:
    """The kinds of what is wrong, level by level."""
    return [found.kind for level in made.findings.values() for found in level]


def messages(made: WorldOutcome) -> str:
    """All that is said of what is wrong."""
    return "\n".join(found.message for level in made.findings.values() for found in level)
