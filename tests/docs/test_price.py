"""The tables of prices in docs/findings.md: made of the runs in docs/data, and those still hold."""

from __future__ import annotations

import csv
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from topo_verify import explore
from topo_verify.world.resolve import resolve_world

ROOT = Path(__file__).parent.parent.parent
PAGE = (ROOT / "docs" / "findings.md").read_text(encoding="utf-8")

COMMANDS = re.findall(r"    \.venv/bin/python (benchmarks/\S+ .*--runs docs/data/.*)", PAGE)


@pytest.mark.parametrize("command", COMMANDS)
def test_a_table_is_what_its_command_prints(command: str, tmp_path: Path) -> None:
    script, *words = shlex.split(command)
    place = words.index("--runs") + 1
    runs, words[place] = ROOT / words[place], str(tmp_path / "runs.csv")
    shutil.copy(runs, words[place])
    done = subprocess.run(
        [sys.executable, ROOT / script, *words], capture_output=True, text=True, check=True
    )
    printed = done.stdout.splitlines()
    assert len(printed) >= 3
    assert [line for line in printed if line not in PAGE.splitlines()] == []
    assert Path(words[place]).read_text() == runs.read_text(), "no run was missing"


@pytest.mark.parametrize("name", ["folding", "homing", "planner", "homing+planar"])
def test_a_run_of_the_data_is_paid_again(name: str) -> None:
    with (ROOT / "docs" / "data" / "price.csv").open(newline="") as file:
        (row,) = (
            row
            for row in csv.DictReader(file)
            if (row["family"], row["seed"]) == ("lattice(10,10,holes=0.2)", "0")
            and row["mapper"] == name
        )
    world = resolve_world("family:lattice(10,10,holes=0.2,seed=0)")
    assert (len(world.edges), world.least_cost()) == (int(row["m"]), int(row["least"]))
    assert explore(world, name).cost == int(row["cost"])


def test_there_are_tables() -> None:
    assert len(COMMANDS) >= 2
