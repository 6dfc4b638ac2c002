"""Tab completion in bash, by the line that docs/start/install.md gives."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

PAGE = (Path(__file__).parents[2] / "docs" / "start" / "install.md").read_text(encoding="utf-8")
LINE = 'eval "$(_TOPO_VERIFY_COMPLETE=bash_source topo-verify)"'

BASH = shutil.which("bash") or ""

pytestmark = pytest.mark.skipif(not BASH, reason="bash is not installed")


def completed(*lines: str) -> list[list[str]]:
    """What one bash offers for the last word of each of these command lines, sorted."""
    script = f"""
        {LINE}
        complete -p topo-verify > /dev/null
        for line; do
            COMPREPLY=()
            COMP_WORDS=($line)
            COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1))
            _topo_verify_completion topo-verify
            echo "${{COMPREPLY[@]}}"
        done
    """
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    done = subprocess.run(
        [BASH, "--noprofile", "--norc", "-c", script, "bash", *lines],
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return [sorted(line.split()) for line in done.stdout.splitlines()]


def test_the_page_gives_this_line() -> None:
    assert f"    {LINE}\n" in PAGE


@pytest.mark.long
def test_bash_offers_commands_options_and_values() -> None:
    offered = {
        "topo-verify repl": ["replay"],
        "topo-verify world co": ["convert", "count"],
        "topo-verify search basic --edg": ["--edges"],
        "topo-verify explore nyc --format m": ["markdown"],
        "topo-verify no-such": [],
    }
    assert completed(*offered) == list(offered.values())
