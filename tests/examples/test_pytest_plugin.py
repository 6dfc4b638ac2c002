"""The pytest file and the workflow that users copy, run as in their repository."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from topo_verify.checkers import CLAIMS

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"
PAGE = (ROOT / "docs" / "pytest.md").read_text()
WORKFLOW = (EXAMPLES / "github-workflow.yml").read_text()


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """A user's repository: the mapper, and its pytest file beside it."""
    shutil.copy(EXAMPLES / "mapper_python" / "mapper.py", tmp_path)
    shutil.copy(EXAMPLES / "pytest_plugin" / "test_mapper.py", tmp_path)
    return tmp_path


def shell(line: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a line as a step of a workflow does, with this environment's programs first."""
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    environment = {**os.environ, "PATH": path, "GITHUB_STEP_SUMMARY": "summary.md"}
    return subprocess.run(
        ["/bin/sh", "-e", "-c", line],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


def test_the_page_shows_the_file_as_it_is() -> None:
    shown = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    assert shown == [(EXAMPLES / "pytest_plugin" / "test_mapper.py").read_text()]


@pytest.mark.long
def test_the_mapper_passes_its_tests(repository: Path) -> None:
    done = shell("pytest -q -W error -p no:cacheprovider", repository)
    assert done.returncode == 0, done.stdout
    assert f"{len(CLAIMS) + 3} passed" in done.stdout
    summary = "mapper:explore: 86 of 86 worlds of 1 to 3 edges, 0 counterexamples\n"
    assert summary in done.stdout
    assert summary in PAGE


@pytest.mark.nightly
def test_a_wrong_one_fails_with_the_world(repository: Path) -> None:
    shutil.move(repository / "mapper.py", repository / "right.py")
    wrong = (EXAMPLES / "mapper_python" / "wrong.py").read_text()
    (repository / "mapper.py").write_text(wrong.replace("from mapper", "from right"))
    done = shell("pytest -q -p no:cacheprovider", repository)
    assert done.returncode == 1
    assert "FAILED test_mapper.py::test_mapper[map-isomorphic]" in done.stdout
    (shown,) = re.findall(r"```\n(map-isomorphic fails.*?)```", PAGE, re.DOTALL)
    assert shown in done.stdout
    again = re.search(r"again: (topo-verify replay m\d/\d+ --target mapper:explore)", done.stdout)
    assert again is not None
    assert shell(again[1], repository).returncode == 1


@pytest.mark.nightly
def test_the_steps_of_the_workflow_work(repository: Path) -> None:
    (record,) = re.findall(r"^#   (topo-verify record .*)$", WORKFLOW, re.MULTILINE)
    steps = re.findall(r"^ +run: (.*)$", WORKFLOW, re.MULTILINE)
    assert [step.split()[:2] for step in steps] == [
        ["pip", "install"],
        ["pytest", "--junitxml=junit.xml"],
        ["topo-verify", "verify"],
        ["topo-verify", "compare"],
    ]
    for line in (record, *steps[1:]):
        done = shell(line, repository)
        assert done.returncode == 0, done.stdout + done.stderr
    summary = (repository / "summary.md").read_text()
    assert "| equal | 953 |" in summary
    assert summary.endswith("No regression in 953 of 953 worlds.\n")
    assert summary.startswith("**EXHAUSTED**: mapper.py:explore, 86 of 86 worlds, 81 sampled\n")
    kept = re.findall(r"^ {12}(\S+)$", WORKFLOW, re.MULTILINE)
    assert kept == ["junit.xml", "verify.xml", "report.html", "badge.svg"]
    assert [name for name in kept if not (repository / name).stat().st_size] == []
    assert "topo_checked" in (repository / "junit.xml").read_text()
