"""action.yml without GitHub: its text, and its steps in bash with a wheel.

What this does not show: that GitHub fills in the inputs as this file does; actions/setup-python.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).resolve().parent.parent
ACTION: dict[str, Any] = yaml.safe_load((ROOT / "action.yml").read_text(encoding="utf-8"))
STEPS: list[dict[str, Any]] = ACTION["runs"]["steps"]
PAGE = (ROOT / "docs" / "howto" / "ci.md").read_text(encoding="utf-8")
BASH = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c"]  # as GitHub calls it


@dataclass(frozen=True)
class Ran:
    """What a step did: its exit code, and what it wrote into the files that GitHub reads."""

    code: int
    summary: str
    outputs: str
    stderr: str


def run_step(name: str, folder: Path, programs: Path, **inputs: str) -> Ran:
    """Run the shell of a step with these inputs in place of its expressions."""
    (step,) = (step for step in STEPS if step["name"] == name)
    filled = {
        key: inputs[re.findall(r"inputs\.(\w+)", expression)[0]]
        for key, expression in step["env"].items()
    }
    summary, outputs = folder / "summary.md", folder / "outputs"
    done = subprocess.run(
        [*BASH, step["run"]],
        cwd=folder,
        env={
            **{key: value for key, value in os.environ.items() if key != "PYTHONPATH"},
            **filled,
            "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
            "PIP_NO_INDEX": "1",
            "PIP_NO_DEPS": "1",
            "RUNNER_TEMP": str(folder),
            "GITHUB_STEP_SUMMARY": str(summary),
            "GITHUB_OUTPUT": str(outputs),
        },
        capture_output=True,
        text=True,
        check=False,
    )
    texts = [path.read_text() if path.exists() else "" for path in (summary, outputs)]
    return Ran(done.returncode, texts[0], texts[1], done.stderr)


PROGRAMS = Path(sys.executable).parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
FAST: list[str] = PROJECT["optional-dependencies"]["fast"]


def test_every_input_stands_on_the_page_with_its_default() -> None:
    rows = re.findall(r"^\| `(\w+)` \| .* \| (.*) \|$", PAGE, re.MULTILINE)
    assert [name for name, _ in rows] == list(ACTION["inputs"])
    for name, default in rows:
        said = ACTION["inputs"][name].get("default", "none: it must be given")
        assert default == (said or {"install": "the folder of the action"}.get(name, "none"))


def test_no_shell_reads_an_expression() -> None:
    shells = [step["run"] for step in STEPS if "run" in step]
    assert len(shells) == 3
    assert not [text for text in shells if "${{" in text]
    assert all(step["shell"] == "bash" for step in STEPS if "run" in step)


def test_what_it_uses_is_pinned_to_a_version() -> None:
    used = [step["uses"] for step in STEPS if "uses" in step]
    assert used == ["actions/setup-python@v6"]


@pytest.mark.long
@pytest.mark.parametrize(
    ("target", "options", "code", "verdict"),
    [
        ("basic", "", 0, "EXHAUSTED"),
        ("basic,folding+planar", "--class genus:1", 1, "REFUTED"),
        ("no-such-mapper", "", 2, ""),
        # Every line of the options counts, and every word of a line.
        ("folding+planar", "--keep-going\n--class genus:1\n", 1, "REFUTED"),
        ("folding+planar", "  --keep-going \t\n\n  --class\n  planar", 0, "EXHAUSTED"),
        ("basic", "--edges 1", 2, ""),
        ("basic", "*", 2, ""),
        ("", "", 2, ""),
        # What judges nothing is no success.
        ("--help", "", 2, ""),
        ("-h", "", 2, ""),
        ("basic", "--help", 2, ""),
        ("basic", "--class planar\n-h", 2, ""),
    ],
)
def test_the_search_fails_the_step_just_as_it_should(
    target: str, options: str, code: int, verdict: str, tmp_path: Path
) -> None:
    done = run_step("Search", tmp_path, PROGRAMS, target=target, edges="2", options=options)
    assert done.code == code, done.stderr
    assert done.outputs == f"verdict={verdict}\n"
    assert verdict in done.summary


@pytest.mark.parametrize(
    ("target", "code", "says"),
    [
        ("enhancement-ii", 0, "No regression in 86 of 86 worlds"),
        ("homing", 1, "exceed the tolerance"),
        ("no-such-mapper", 2, ""),
    ],
)
def test_a_mapper_that_costs_more_than_its_baseline_fails(
    target: str, code: int, says: str, tmp_path: Path
) -> None:
    recorded = [str(PROGRAMS / "topo-verify"), "record", "enhancement-ii", "--worlds", "edges<=3"]
    subprocess.run([*recorded, "--out", "b.gz"], cwd=tmp_path, check=True, capture_output=True)
    done = run_step("Compare", tmp_path, PROGRAMS, target=target, baseline="b.gz")
    assert done.code == code, done.stderr
    assert says in done.summary


@pytest.mark.long
def test_an_input_cannot_become_a_command(tmp_path: Path) -> None:
    run_step("Search", tmp_path, PROGRAMS, target="$(touch a)", edges="1; touch b", options="`c`")
    assert {path.name for path in tmp_path.iterdir()} == {"topo-verify.md", "summary.md", "outputs"}


@pytest.mark.parametrize(
    ("target", "packages"),
    [("mapper.py:explore", ["."]), ("--library ./mapper.so:map_world", [".", *FAST])],
)
def test_what_calls_a_library_is_installed_with_it(
    target: str, packages: list[str], tmp_path: Path
) -> None:
    pip = tmp_path / "python"
    pip.write_text('#!/bin/sh\nprintf "%s\\n" "$@" > asked\n')
    pip.chmod(0o755)
    assert run_step("Install", tmp_path, tmp_path, install=".", target=target).code == 0
    asked = (tmp_path / "asked").read_text().split()
    assert asked == ["-m", "pip", "install", "--quiet", *packages]


@pytest.mark.nightly
def test_a_wheel_is_installed_and_the_mapper_checked_with_it(tmp_path: Path) -> None:
    path = os.pathsep.join([str(PROGRAMS), os.environ["PATH"]])  # the backend's own program
    build = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "-o", str(tmp_path)]
    built = subprocess.run(
        [*build, str(ROOT)], env={**os.environ, "PATH": path}, capture_output=True, check=False
    )
    assert built.returncode == 0, built.stderr
    (wheel,) = tmp_path.glob("*.whl")
    subprocess.run([sys.executable, "-m", "venv", str(tmp_path / "venv")], check=True)
    programs = tmp_path / "venv" / "bin"
    # What topo-verify depends on comes from here; the wheel's own files come first.
    (site,) = (tmp_path / "venv").glob("lib/python*/site-packages")
    (site / "more.pth").write_text(sysconfig.get_path("purelib") + "\n")
    installed = run_step("Install", tmp_path, programs, install=str(wheel), target="basic")
    assert installed.code == 0, installed.stderr
    assert (site / "topo_verify" / "cli").is_dir()
    shutil.copy(ROOT / "examples" / "own_mapper" / "declared.py", tmp_path)
    inputs = {"target": "declared.py:explore", "edges": "3", "options": ""}
    found = run_step("Search", tmp_path, programs, **inputs)
    assert (found.code, found.outputs) == (1, "verdict=REFUTED\n"), found.stderr
    assert "m3/5" in found.summary
