"""The tables of docs/findings.md and docs/data: printed by their commands, and the same twice."""

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
DATA = ROOT / "docs" / "data"
PAGE = (ROOT / "docs" / "findings.md").read_text(encoding="utf-8")

MADE_BY = {
    table: commands
    for table, cell in re.findall(
        r"^\| \[[\w-]+\]\(tables/([\w-]+)\.csv\) \| (.*) \|$",
        (DATA / "README.md").read_text(encoding="utf-8"),
        re.MULTILINE,
    )
    if (commands := re.findall(r"`python (-m research\.\w+ [^`]*--runs docs/data/[^`]*)`", cell))
}
"""The tables that are made of stored runs, each with its commands."""

Table = tuple[tuple[str, ...], ...]


def printed(text: str) -> list[Table]:
    """The tables in Markdown: the head, then the rows."""
    tables = re.findall(r"((?:^\|.*\n)+)", text + "\n", re.MULTILINE)
    cells = [
        [[cell.strip().strip("`") for cell in line.split("|")[1:-1]] for line in table.splitlines()]
        for table in tables
    ]
    return [tuple(tuple(row) for row in (rows[0], *rows[2:])) for rows in cells]


def stored(table: str) -> list[Table]:
    """The tables of a CSV file, which empty lines divide."""
    text = (DATA / "tables" / f"{table}.csv").read_text(encoding="utf-8")
    return [tuple(map(tuple, csv.reader(part.splitlines()))) for part in text.split("\n\n")]


@pytest.mark.parametrize("table", MADE_BY)
def test_a_table_is_what_its_commands_print(table: str, tmp_path: Path) -> None:
    rows = set[tuple[str, ...]]()
    for command in MADE_BY[table]:
        words = shlex.split(command)
        place = words.index("--runs") + 1
        runs, words[place] = ROOT / words[place], str(tmp_path / "runs.csv")
        shutil.copy(runs, words[place])
        done = python(*words, check=True, cwd=ROOT)
        rows |= {row for part in printed(done.stdout) for row in part}
        assert Path(words[place]).read_text() == runs.read_text(), "no run was missing"
    assert rows == {row for part in stored(table) for row in part}


SECTIONS = [part for part in PAGE.split("\n## ") if "data/tables/" in part and "\n| " in part]


def absent(section: str) -> list[dict[str, str]]:
    """The rows on the page that are in none of the tables to which their section links."""
    parts = [p for name in re.findall(r"data/tables/([\w-]+)\.csv", section) for p in stored(name)]
    rows = [dict(zip(part[0], row, strict=True)).items() for part in parts for row in part[1:]]
    return [
        shown
        for head, *body in printed(section)
        if not body[0][0].startswith("![")  # a row of pictures
        for shown in (dict(zip(head, row, strict=True)) for row in body)
        if not any(shown.items() <= row for row in rows)
    ]


@pytest.mark.parametrize("section", SECTIONS, ids=lambda text: text.splitlines()[0][:2])
def test_a_table_of_the_page_is_a_part_of_the_data(section: str) -> None:
    if "explore nyc" not in section:  # that section shows a table of its own
        assert absent(section) == []


def test_a_changed_cell_is_seen() -> None:
    (section,) = (part for part in SECTIONS if part.startswith("3."))
    assert len(absent(section.replace("1.283 ± 0.021", "1.282 ± 0.021"))) == 1


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
    done = python("-m", "research.price", *words, *more, check=True, cwd=ROOT)
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
    assert len(MADE_BY) >= 6
    assert len(SECTIONS) >= 4
    links = {path.name for path in (DATA / "tables").iterdir()}
    assert links == set(re.findall(r"tables/([\w-]+\.csv)", (DATA / "README.md").read_text()))
