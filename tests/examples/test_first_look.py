"""The notebook of examples/: it runs from its first cell to its last, and says what it promises.

It is committed without outputs: they would be large (a page that plays a run), and change with
every picture. What they show is made and looked at here.
"""

from __future__ import annotations

import json
import re
from html import unescape
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
NOTEBOOK = EXAMPLES / "first_look.ipynb"

Cells = dict[str, dict[str, Any]]


@pytest.fixture(scope="module")
def outputs(tmp_path_factory: pytest.TempPathFactory) -> Cells:
    """What each cell of code shows, by its id: text by MIME type, printed text as `stdout`."""
    nbclient: Any = import_module("nbclient")
    nbformat: Any = import_module("nbformat")
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    client = nbclient.NotebookClient(
        notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": EXAMPLES}}
    )
    with pytest.MonkeyPatch.context() as patch:
        # A kernel keeps files in the home folder, and one on the way of each import.
        for name in ("IPYTHONDIR", "JUPYTER_RUNTIME_DIR"):
            patch.setenv(name, str(tmp_path_factory.mktemp(name)))
        patch.setenv("PYTHONDONTWRITEBYTECODE", "1")
        client.execute()
    return {cell.id: _shown(cell.outputs) for cell in notebook.cells if cell.cell_type == "code"}


def _shown(cells: list[Any]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for output in cells:
        assert output.output_type in {"execute_result", "display_data", "stream"}, output
        if output.output_type == "stream":
            assert output.name == "stdout", output.text
            found["stdout"] = output.text
        else:
            found |= output.data
    return found


def words(page: str) -> str:
    return re.sub(r"\s+", " ", unescape(re.sub("<[^>]*>", " ", page)))


def test_it_is_committed_without_outputs() -> None:
    cells = json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    assert len(code) == 11
    assert all((cell["outputs"], cell["execution_count"]) == ([], None) for cell in code)


@pytest.mark.nightly
def test_worlds_are_pictures(outputs: Cells) -> None:
    for cell in ("world", "town"):
        assert "<img " in outputs[cell]["text/html"]
        assert "text/plain" in outputs[cell]


@pytest.mark.long
def test_a_run_is_a_page_in_a_frame(outputs: Cells) -> None:
    assert "<iframe class=" in outputs["run"]["text/html"]


@pytest.mark.long
def test_the_catalogue_holds_what_is_claimed(outputs: Cells) -> None:
    assert "10 of 10 claims hold" in words(outputs["report"]["text/html"])


@pytest.mark.long
def test_the_mapper_is_right_by_luck_and_its_witness_tells(outputs: Cells) -> None:
    report = words(outputs["mapper"]["text/html"])
    assert "map-isomorphic ✓ ok" in report
    assert "map-entailed ✗ failed" in report
    finding = outputs["finding"]["text/html"]
    assert "the witness, with the same history: m4/86" in words(finding)
    assert finding.count("<img ") == 2
    assert outputs["proof"]["stdout"] == "in the triangle: ok\nin the witness:  failed\n"


@pytest.mark.long
def test_the_hunt_ends_in_the_world_of_docs_search(outputs: Cells) -> None:
    assert outputs["town"]["stdout"] == "every claim holds: True\n"
    assert "undirected in m4/183, " in words(outputs["smallest"]["text/html"])
    assert "!! no-false-confirm: edge 6 leads to dart 2" in outputs["smallest"]["text/html"]
    assert "smallest counterexample: m4/183" in words(outputs["search"]["text/html"])


@pytest.mark.long
def test_the_costs_are_a_plot_and_the_log_proves_a_ring(outputs: Cells) -> None:
    assert "image/png" in outputs["costs"]
    assert "PROVED: one world alone shows this log" in words(outputs["log"]["text/html"])
