"""Records the JSON of many commands, without times; a refactoring must not change it.

    python benchmarks/recorded.py FOLDER            one file a command
    git diff --no-index OLD NEW                     how two recordings differ

The commands run in the root of this tree, in the environment of this Python. So an earlier commit
is recorded from a second checkout with a second environment. A recording takes some minutes.

What this does not show: text, pictures and pages, which the tests judge.
"""

from __future__ import annotations

import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

CHANGING = {"timing", "tool", "ms_per_move"}
"""Fields that differ between two runs or two versions."""

COMMANDS = """
verify --quick
verify examples/own_mapper/mapper.py:explore --quick
verify examples/own_mapper/mended.py:explore --quick
explore nyc
explore m3/14 m2/8 m1/0 --target all
explore m3/14 --target basic,enhancement-ii --pick last --order newest
explore family:lattice(10,10,holes=0.2,seed=7) --target all --gap
explore m4/41 --target enhancement-iii-all --marker all
explore m5/17 --target examples/own_mapper/mapper.py:explore
explore m5/17 --cmd "{python} examples/mapper_python/mapper.py"
explore m6/100 --engine compiled
explore m2/8 --target folding+planar --choices 0,1
world show nyc
world show m5/17 m5/18
world show m2/7 --twin undirected
world list --edges 3
world list --edges 5 --class planar,simple
world list --edges 4 --unrooted
world count --edges 1..6
world count --edges 1..5 --class simple
world count --edges 6 --by vertices
world sample --edges 20 -n 5
world sample --edges 30 --class genus:1 -n 3
world sample --strategy "nonplanar_worlds(genus=2)" -n 5
world draw m5/17 --doors --darts -o {folder}/m5-17.svg
world convert m5/17 --to graphml -o {folder}/m5-17.graphml
world convert nyc --to nx-json -o {folder}/nyc.nx.json
world show {folder}/m5-17.graphml {folder}/nyc.nx.json
world show tests/data/worlds/pp_mv_oberrhein.json tests/data/worlds/sumo_A10KW.json
search basic --edges 4
search basic --edges 4 --workers 0
search all --edges 4 --class planar
search basic --edges 5 --engine compiled
search basic,enhancement-iii-all --edges 4 --worst
search basic,enhancement-iii-all --edges 4 --compare basic,enhancement-iii-all
search examples/own_mapper/mapper.py:explore --edges 4
search examples/own_mapper/mended.py:explore --edges 4
search examples/undirected.py:undirected --edges 4 --keep-going
explore m4/1 m5/17 --target examples/wrong_mappers.py:a,examples/wrong_mappers.py:d
search --cmd "{python} examples/mapper_python/wrong.py" --edges 3
search basic --edges 4 --ledger {folder}/ledger
search basic --edges 3 --policies all
search enhancement-ii --edges 3 --policies every
prove --list
prove --kind inductive
prove percept word-confirm-step
prove --kind bounded --edges 3
conform examples/own_mapper/mapper.py:explore --worlds edges<=3
conform --cmd "{python} examples/mapper_python/mapper.py" --worlds edges<=3 --like basic
conform basic --worlds generated:20 --workers 0
conform --cmd "{python} examples/mapper_python/wrong.py" --worlds edges<=3
record basic --worlds edges<=3 --out {folder}/basic.jsonl
compare {folder}/basic.jsonl
compare {folder}/basic.jsonl enhancement-iii-all
explore m3/14 --target basic --trace {folder}/trace
replay {folder}/trace
replay {folder}/trace --world m3/15
play m4/41 -o {folder}/play.html
certify {folder}/trace -o {folder}/map.json
header
tour nyc
tour m5/17
arena basic,enhancement-iii-all,folding --suite tiny
reproduce --figure 6d --quick --out {folder}/figures
explore no-such-world
search no_such.py:explore
search basic --edges 0
"""


def without_times(value: Any) -> Any:
    """The JSON value without the fields that differ between two runs."""
    if isinstance(value, dict):
        return {key: without_times(item) for key, item in value.items() if key not in CHANGING}
    return [without_times(item) for item in value] if isinstance(value, list) else value


def record(command: str, folder: Path, scratch: Path) -> None:
    """Run one command and write its exit code and its JSON to a file of the folder."""
    words = shlex.split(command.format(python=sys.executable, folder=scratch))
    run = subprocess.run(  # noqa: S603  the project itself
        [sys.executable, "-m", "topo_verify", *words, "--format", "json", "--quiet"],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | {"PYTHONHASHSEED": "0"},
    )
    try:
        said = without_times(json.loads(run.stdout))
    except json.JSONDecodeError:
        said = {"stdout": run.stdout, "stderr": run.stderr}
    text = json.dumps({"command": command, "exit": run.returncode, "said": said}, indent=1)
    text = text.replace(str(scratch), "{folder}").replace(sys.executable, "{python}")
    name = re.sub(r"[^a-z0-9]+", "-", command.lower()).strip("-")[:80]
    (folder / f"{name}.json").write_text(text + "\n", encoding="utf-8")
    print(f"{run.returncode:3}  {command}", flush=True)


def main() -> None:
    """Record every command."""
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit((__doc__ or "").strip())
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        for command in COMMANDS.split("\n"):
            if command:
                record(command, folder, Path(scratch))


if __name__ == "__main__":
    main()
