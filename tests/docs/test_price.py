"""The tables of prices in docs/findings.md: made of the runs in docs/data, and those still hold."""

from __future__ import annotations

import csv
import re
import shlex
import shutil
from pathlib import Path

import pytest

from tests.python import python
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
    done = python(ROOT / script, *words, check=True)
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


def printed_ratio(lines: list[str], tmp_path: Path, *more: str) -> str:
    """What the script prints of these runs of a family of one mapper: the last cell of a row."""
    runs = tmp_path / "runs.csv"
    runs.write_text("\n".join(["family,seed,mapper,m,least,cost,ms", *lines]) + "\n")
    words = ["--families", "none", "--also", "king(2,2)", "--seeds", "3", "--runs", str(runs)]
    done = python(ROOT / "benchmarks" / "price.py", *words, *more, check=True)
    return done.stdout.splitlines()[-1].split("|")[-2].strip()


def test_the_error_is_that_of_the_ratio_and_not_of_the_cost_alone(tmp_path: Path) -> None:
    # Costs are twice the least cost, whatever that is: the ratio is known without an error.
    alike = [f'"king(2,2)",{k},one,5,{least},{2 * least},1.0' for k, least in enumerate((1, 5, 9))]
    assert printed_ratio(alike, tmp_path, "--mappers", "one") == "2.000 ± 0.000"
    # Residuals 1, -2, 1 of costs 3, 8, 19 beside 2·(1, 5, 9): sqrt(6 / (3·2)) / 5 = 0.2.
    costs = ((1, 3), (5, 8), (9, 19))
    apart = [f'"king(2,2)",{k},one,5,{least},{cost},1.0' for k, (least, cost) in enumerate(costs)]
    assert printed_ratio(apart, tmp_path, "--mappers", "one") == "2.000 ± 0.200"
    # The same beside a mapper that pays the least cost.
    half = [f'"king(2,2)",{k},half,5,{least},{least},1.0' for k, (least, _) in enumerate(costs)]
    paired = printed_ratio(apart + half, tmp_path, "--mappers", "one,half", "--against", "half")
    assert paired == "+1.000 ± 0.200, 2.000 ×"


def test_there_are_tables() -> None:
    assert len(COMMANDS) >= 2
