"""`topo-verify certify --kernel`: what a log proves, stated in Coq and checked by it."""

from __future__ import annotations

import re
import shutil
from dataclasses import replace
from pathlib import Path
from unittest.mock import Mock

import pytest

from tests.cli.conftest import Call, Results
from tests.cli.test_certify import RING
from tests.helpers import of_type, place, trace_of, typed
from tests.proofs.mechanised.conftest import nowhere
from topo_verify.extra.certificates import certificates
from topo_verify.proofs.mechanised import toolchain
from topo_verify.robot.events import Augment, Confirm, Reject, write_trace

needs_coq = pytest.mark.skipif(bool(toolchain.missing()), reason=toolchain.missing())


@pytest.fixture(autouse=True)
def logs(folder: Path) -> None:
    """The logs of a ring of two: whole, cut short, and of no world."""
    (folder / "ring.jsonl").write_text(RING)
    (folder / "short log.jsonl").write_text("".join(RING.splitlines(keepends=True)[:2]))
    (folder / "none.jsonl").write_text(RING.replace('"marker": 1', '"marker": 0'))


def judging(monkeypatch: pytest.MonkeyPatch, checked: certificates.CertificateCheck) -> None:
    target = "topo_verify.extra.certificates.certificates._Checker.check"
    monkeypatch.setattr(target, Mock(return_value=checked))


COQC = certificates.CertificateCheck(accepted=True, by="coqc 0")


THREE = "certify ring.jsonl 'short log.jsonl' none.jsonl --kernel"


def test_each_verdict_is_stated_in_a_file_of_its_own(
    results: Results, monkeypatch: pytest.MonkeyPatch
) -> None:
    judging(monkeypatch, COQC)
    found = [entry["kernel"] for entry in results(THREE, code=1)["results"]]
    assert [one["statement"] for one in found] == ["map", "undetermined", "impossible"]
    assert {(one["accepted"], one["by"]) for one in found} == {(True, "coqc 0")}
    assert found[1]["file"] == "certificate_short_log_2.cert"
    for one in found:
        assert re.fullmatch(r"topo-verify/certificate 1\n[0-9 \n]+", Path(one["file"]).read_text())


@pytest.mark.usefixtures("linked")
@pytest.mark.nightly
def test_each_verdict_is_accepted_by_coqc(results: Results) -> None:
    found = [entry["kernel"] for entry in results(THREE, code=1)["results"]]
    assert [(one["accepted"], one["by"]) for one in found] == [(True, toolchain.version())] * 3


@pytest.mark.usefixtures("linked")
@pytest.mark.nightly
def test_the_command_that_is_printed_checks_the_certificate(call: Call, results: Results) -> None:
    text = call("certify ring.jsonl --kernel").stdout
    assert "one world alone shows its log, and it is the map in the certificate" in " ".join(
        text.split()
    )
    (entry,) = results("certify ring.jsonl --kernel")["results"]
    command = entry["kernel"]["command"]
    assert command == "topo-verify certify --check certificate_ring.cert --log ring.jsonl"
    assert call(command.removeprefix("topo-verify ")).exit_code == 0


def test_without_coq_the_file_is_written_and_the_exit_says_incomplete(
    results: Results, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shutil, "which", nowhere)
    (entry,) = results("certify ring.jsonl --kernel", code=3)["results"]
    assert entry["verdict"] == "PROVED"
    assert entry["kernel"]["accepted"] is None
    assert "apt-get install" in entry["kernel"]["why"]
    assert Path("certificate_ring.cert").read_text().startswith("topo-verify/certificate 1\n2 1\n")


def test_a_certificate_that_is_refused_is_a_bug_of_ours(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    judging(monkeypatch, certificates.CertificateCheck(accepted=False, by="coqc 0", why="no"))
    done = call("certify ring.jsonl --kernel")
    assert done.exit_code == 70
    said = " ".join(done.stderr.split())
    refused = "coqc 0 refuses certificate_ring.cert"
    assert f"{refused}, so our conclusion or our evidence is wrong: no" in said


def write_log(path: str, mapper: str = "basic", world: str = "m3/50") -> None:
    """Write the trace of a run with its decisions."""
    Path(path).write_bytes(write_trace(trace_of(world, mapper)))


def certified(number: int) -> certificates.CertificateCheck:
    return replace(COQC, statement="map", certified=number, decisions=number)


def test_decisions_that_follow_are_certified(
    call: Call, results: Results, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_log("run.jsonl")
    follow = len(of_type(Reject, trace_of("m3/50"))) + len(of_type(Confirm, trace_of("m3/50")))
    follow += len(of_type(Augment, trace_of("m3/50")))
    judging(monkeypatch, replace(certified(follow), delivered=True))
    (entry,) = results("certify run.jsonl --kernel")["results"]
    assert entry["decisions"]["entailed"] == entry["decisions"]["total"] == follow > 5
    assert entry["kernel"]["delivered"] is True
    assert entry["kernel"]["decisions"] == {
        "certified": follow, "entailed": follow, "by": "coqc 0", "why": ""
    }  # fmt: skip
    text = " ".join(call("certify run.jsonl --kernel").stdout.split())
    assert "The delivered map is that world." in text
    assert f"Of the decisions that follow, {follow} of {follow} are certified by coqc 0." in text


def test_a_log_without_decisions_has_no_sentence_about_them(
    call: Call, results: Results, monkeypatch: pytest.MonkeyPatch
) -> None:
    judging(monkeypatch, COQC)
    (entry,) = results("certify ring.jsonl --kernel")["results"]
    assert entry["kernel"]["decisions"] == {"certified": 0, "entailed": 0, "by": "", "why": ""}
    assert "decisions that follow," not in call("certify ring.jsonl --kernel").stdout


@pytest.mark.usefixtures("linked")
@pytest.mark.nightly
def test_a_decision_that_does_not_follow_is_not_certified(results: Results) -> None:
    trace = trace_of("m3/50")
    wrong = place(trace, Reject)
    rejected = typed(Reject, trace[wrong])
    elsewhere = Confirm(rejected.edge, rejected.hypothesis, "motion")
    Path("run.jsonl").write_bytes(write_trace((*trace[:wrong], elsewhere, *trace[wrong + 1 :])))
    (entry,) = results("certify run.jsonl --kernel", code=1)["results"]
    assert entry["decisions"]["entailed"] == entry["decisions"]["total"] - 1
    assert entry["kernel"]["decisions"]["certified"] == entry["decisions"]["entailed"]


def test_decisions_that_follow_only_in_planar_worlds_are_counted_apart(
    results: Results, call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_log("run.jsonl", "folding+planar", "m4/50")
    judging(monkeypatch, certified(8))
    (entry,) = results("certify run.jsonl --kernel")["results"]
    found = entry["kernel"]["decisions"]
    assert (found["certified"], found["entailed"]) == (8, 9)
    assert "planar worlds only" in found["why"]
    assert "8 of 9 are certified" in " ".join(call("certify run.jsonl --kernel").stdout.split())


def test_decisions_whose_evidence_is_too_long_make_the_run_incomplete(
    results: Results, call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_log("run.jsonl")
    judging(monkeypatch, certified(0))
    monkeypatch.setattr("topo_verify.extra.certificates.evidence.MOST", 5)
    (entry,) = results("certify run.jsonl --kernel", code=3)["results"]
    assert entry["kernel"]["accepted"]
    assert entry["kernel"]["decisions"]["certified"] == 0
    text = " ".join(call("certify run.jsonl --kernel").stdout.split())
    assert "are certified: their evidence has more than 5 steps." in text


def test_decisions_are_not_certified_by_a_certificate_that_is_not_checked(
    results: Results, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_log("run.jsonl")
    judging(monkeypatch, certificates.CertificateCheck(accepted=None, by="", why="no Coq"))
    (entry,) = results("certify run.jsonl --kernel", code=3)["results"]
    found = entry["kernel"]["decisions"]
    assert (found["certified"], found["by"]) == (0, "")
    assert found["why"] == "the certificate is not checked"


@pytest.mark.coq
@needs_coq
@pytest.mark.nightly
def test_the_decisions_of_a_run_are_accepted_by_coqc(results: Results) -> None:
    write_log("run.jsonl", "enhancement-iii-all")
    (entry,) = results("certify run.jsonl --kernel")["results"]
    found = entry["kernel"]["decisions"]
    assert found["certified"] == found["entailed"] == entry["decisions"]["total"] > 0
    assert found["by"] == toolchain.version()


def test_without_the_option_there_is_no_certificate(results: Results, folder: Path) -> None:
    (entry,) = results("certify ring.jsonl")["results"]
    assert entry["kernel"] is None
    assert not list(folder.glob("*.cert"))
