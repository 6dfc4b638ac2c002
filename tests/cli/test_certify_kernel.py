"""`topo-verify certify --kernel`: what a log proves, stated in Coq and checked by it."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from tests.cli.conftest import Call, Results
from tests.proofs.coq.conftest import nowhere
from topo_verify.proofs import coqtools, kernel

RING = """\
{"type": "start", "percept": {"degree": 2, "marker": 0}}
{"type": "move", "door": 0, "percept": {"degree": 2, "marker": null}}
{"type": "move", "door": 1, "percept": {"degree": 2, "marker": 1}}
"""

needs_coq = pytest.mark.skipif(bool(coqtools.missing()), reason=coqtools.missing())


@pytest.fixture(autouse=True)
def logs(folder: Path) -> None:
    """The logs of a ring of two: whole, cut short, and of no world."""
    (folder / "ring.jsonl").write_text(RING)
    (folder / "short log.jsonl").write_text("".join(RING.splitlines(keepends=True)[:2]))
    (folder / "none.jsonl").write_text(RING.replace('"marker": 1', '"marker": 0'))


THREE = "certify ring.jsonl 'short log.jsonl' none.jsonl --kernel"


def test_each_verdict_is_stated_in_a_file_of_its_own(
    results: Results, monkeypatch: pytest.MonkeyPatch
) -> None:
    def accepted(*_: object) -> kernel.Checked:
        return kernel.Checked(accepted=True, by="coqc 0")

    monkeypatch.setattr("topo_verify.proofs.kernel._Checker.check", accepted)
    found = [entry["kernel"] for entry in results(THREE, code=1)["results"]]
    assert [one["statement"] for one in found] == ["map", "undetermined", "impossible"]
    assert {(one["accepted"], one["by"]) for one in found} == {(True, "coqc 0")}
    assert found[1]["file"] == "certificate_short_log_2.v"
    assert "forall W, world W -> ~ replays W log" in Path("certificate_none_3.v").read_text()


@needs_coq
@pytest.mark.slow
def test_each_verdict_is_accepted_by_coqc(results: Results) -> None:
    found = [entry["kernel"] for entry in results(THREE, code=1)["results"]]
    assert [(one["accepted"], one["by"]) for one in found] == [(True, coqtools.version())] * 3


@needs_coq
@pytest.mark.slow
def test_the_command_that_is_printed_checks_the_certificate(call: Call, folder: Path) -> None:
    text = call("certify ring.jsonl --kernel").stdout
    assert "every world that shows this log is isomorphic to this map" in " ".join(text.split())
    done = subprocess.run(
        ["/bin/sh", "-c", kernel.command("certificate_ring")],
        cwd=folder, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout.strip() == coqtools.NO_AXIOMS


def test_without_coq_the_file_is_written_and_the_exit_says_incomplete(
    results: Results, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shutil, "which", nowhere)
    (entry,) = results("certify ring.jsonl --kernel", code=3)["results"]
    assert entry["verdict"] == "PROVED"
    assert entry["kernel"]["accepted"] is None
    assert "apt-get install" in entry["kernel"]["why"]
    assert "Theorem proved" in Path("certificate_ring.v").read_text()


def test_a_certificate_that_is_refused_is_a_bug_of_ours(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(*_: object) -> kernel.Checked:
        return kernel.Checked(accepted=False, by="coqc 0", why="no")

    monkeypatch.setattr("topo_verify.proofs.kernel._Checker.check", refused)
    done = call("certify ring.jsonl --kernel")
    assert done.exit_code == 70
    assert "coqc 0 refuses certificate_ring.v: no" in done.stderr


def test_without_the_option_there_is_no_certificate(results: Results, folder: Path) -> None:
    (entry,) = results("certify ring.jsonl")["results"]
    assert entry["kernel"] is None
    assert not list(folder.glob("*.v"))
