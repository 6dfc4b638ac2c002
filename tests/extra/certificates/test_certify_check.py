"""`topo-verify certify --check`: a certificate that somebody sends, accepted or refused."""

# A test may look inside.
# pyright: reportPrivateUsage=false

from __future__ import annotations

import operator
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from unittest.mock import Mock

import msgspec
import pytest

from tests.cli.conftest import Call, Refused, Results
from tests.helpers import edited, place, trace_of, typed, with_darts
from tests.proofs.mechanised.conftest import nowhere
from topo_verify import families
from topo_verify.extra.certificates import certificates
from topo_verify.extra.certificates.certificate_format import HEADER, text_of
from topo_verify.proofs.mechanised import toolchain
from topo_verify.robot.events import Augment, Confirm, Event, Finish, Move, Reject, write_trace
from topo_verify.robot.percept import Percept

RUN = trace_of(families.lattice(3, 3))
TEXT = text_of(certificates.certificate_of(RUN))

needs_coq = pytest.mark.skipif(bool(toolchain.missing()), reason=toolchain.missing())


@pytest.fixture(autouse=True)
def files(folder: Path) -> None:
    """A log and its certificate."""
    (folder / "run.jsonl").write_bytes(write_trace(RUN))
    (folder / "run.cert").write_text(TEXT)


ENDED = {
    "killed": "kill -KILL $$",
    "killed under a shell": "exit 137",
    "no memory": "echo 'Error: Out of memory.'; exit 1",
    "no stack": "echo 'Error: Stack overflow.'; exit 1",
    "no room": "echo 'Error: System error: \"No space left on device\"'; exit 1",
    "no memory at its start": "echo 'Fatal error: not enough memory' >&2; kill -ABRT $$",
}
"""How a coqc ends that has decided nothing, as shell commands."""


def put_coqc(monkeypatch: pytest.MonkeyPatch, ends: str, file: str) -> None:
    """Install a coqc that ends in this way at its last word, and compiles all other files."""
    toolchain.version.cache_clear()
    Path("bin").mkdir()
    for name in ("coqc", "coqchk"):
        program = Path("bin", name)
        program.write_text(
            f'#!/bin/sh\nfor word; do :; done\n[ "$word" = {file} ] && {{ {ends}; }}\n'
            '[ "$word" = -print-version ] && { echo "8.16.1 4.13.1"; exit; }\n'
            'touch "${word%.v}.vo"\n'
        )
        program.chmod(0o700)
    monkeypatch.setenv("PATH", f"{Path('bin').absolute()}{os.pathsep}{os.environ['PATH']}")


# ---------------------------------------------------------------- accepted


@pytest.mark.usefixtures("compiled")
def test_a_certificate_is_accepted_and_says_what_it_states(call: Call, results: Results) -> None:
    (entry,) = results("certify --check run.cert --log run.jsonl")["results"]
    decisions = entry["decisions"]
    assert decisions == {"certified": 20, "total": 20}
    assert {key: entry[key] for key in ("certificate", "accepted", "by", "statement", "why")} == {
        "certificate": "run.cert",
        "accepted": True,
        "by": toolchain.version(),
        "statement": "map",
        "why": "",
    }
    text = " ".join(call("certify --check run.cert").stdout.split())
    assert "one world alone shows its log, and it is the map in the certificate" in text
    assert "The delivered map is that world. Proved to follow: 20 of 20 decisions." in text


HIDDEN = (Confirm(0, 10**6 + 1, "motion"), Augment(-1, "new", 0, 2))
"""Decisions about numbers that no dart has; with any other decision behind them."""


@pytest.mark.parametrize("hidden", [HIDDEN, (*HIDDEN, Confirm(0, 1, "motion"))])
def test_what_a_certificate_cannot_state_of_a_log_counts_as_not_proved(
    call: Call, results: Results, monkeypatch: pytest.MonkeyPatch, hidden: tuple[Event, ...]
) -> None:
    checked = certificates.CertificateCheck(
        accepted=True, by="coqc 0", statement="map", delivered=True, certified=20, decisions=20
    )
    monkeypatch.setattr(certificates._Checker, "check", Mock(return_value=checked))
    Path("hide.jsonl").write_bytes(write_trace((*RUN[:-1], *hidden, RUN[-1])))
    line = "certify --check run.cert --log hide.jsonl"
    (entry,) = results(line, code=3)["results"]
    assert (entry["accepted"], entry["statement"]) == (True, "map")
    assert entry["decisions"] == {"certified": 20, "total": 20 + len(hidden)}
    assert f"{len(hidden)} decisions of the log cannot be stated" in entry["why"]
    text = " ".join(call(line).stdout.split())
    assert f"Proved to follow: 20 of {20 + len(hidden)} decisions." in text
    assert "NOT PROVED: " in text


@pytest.mark.usefixtures("compiled")
@pytest.mark.parametrize("name", [operator.neg, (2**61).__add__])
def test_the_numbers_of_a_delivered_map_do_not_matter(
    results: Results, name: Callable[[int], int]
) -> None:
    end = typed(Finish, RUN[-1])
    renamed = (*RUN[:-1], msgspec.structs.replace(end, map=with_darts(end.map, name)))
    Path("named.jsonl").write_bytes(write_trace(renamed))
    (entry,) = results("certify named.jsonl --kernel")["results"]
    assert (entry["verdict"], entry["kernel"]["delivered"]) == ("PROVED", True)
    (entry,) = results(f"certify --check {entry['kernel']['file']} --log named.jsonl")["results"]
    assert entry["delivered"]


# ---------------------------------------------------------------- refused


def words(change: Callable[[list[str]], list[str]]) -> str:
    """The certificate with its numbers changed."""
    return HEADER + "\n" + " ".join(change(TEXT.split("\n", 1)[1].split())) + "\n"


FORGED = {
    "truncated": words(lambda numbers: numbers[:-1]),
    "half of it": words(lambda numbers: numbers[: len(numbers) // 2]),
    "empty": HEADER + "\n",
    "extra data": words(lambda numbers: [*numbers, "0"]),
    "two certificates": words(lambda numbers: numbers * 2),
    "another degree": words(lambda numbers: ["3", *numbers[1:]]),
    "a huge door": words(lambda numbers: [*numbers[:4], str(10**15), *numbers[5:]]),
    "a huge count": words(lambda numbers: [*numbers[:2], str(10**15), *numbers[3:]]),
}


@pytest.mark.usefixtures("compiled")
@pytest.mark.parametrize("kind", FORGED)
def test_a_forged_certificate_is_refused(results: Results, kind: str) -> None:
    Path("forged.cert").write_text(FORGED[kind])
    (entry,) = results("certify --check forged.cert", code=1)["results"]
    assert (entry["accepted"], entry["statement"]) == (False, None)
    assert entry["by"] == toolchain.version()
    assert entry["why"]


@pytest.mark.parametrize(
    ("kind", "why"),
    [
        (words(lambda numbers: [*numbers, str(2**60 + 1)]), "a number is larger than 2^60"),
        (words(lambda numbers: [*numbers, "9" * 100_000]), "a number is larger than 2^60"),
        (words(lambda numbers: ["1000001", *numbers[1:]]), "doors together: expected at most"),
    ],
)
def test_what_would_only_cost_time_is_refused_at_once(
    results: Results, monkeypatch: pytest.MonkeyPatch, kind: str, why: str
) -> None:
    monkeypatch.setattr(shutil, "which", nowhere)  # it is refused without Coq
    Path("forged.cert").write_text(kind)
    (entry,) = results("certify --check forged.cert", code=1)["results"]
    assert why in entry["why"]


def other_logs() -> dict[str, tuple[Event, ...]]:
    """Logs that are not the one of the certificate, and differ in one thing."""
    return {
        "another world": trace_of("m3/5"),
        "another decision": edited(RUN, place(RUN, Reject), hypothesis=0),
        "a decision less": tuple(e for i, e in enumerate(RUN) if i != place(RUN, Reject)),
        "another percept": edited(RUN, place(RUN, Move), percept=Percept(3, 0)),
        "no map delivered": RUN[:-1],
        "another map delivered": (*RUN[:-1], trace_of("m3/5")[-1]),
    }


@pytest.mark.parametrize("kind", other_logs())
def test_a_certificate_about_another_log_is_refused(
    call: Call, results: Results, kind: str
) -> None:
    Path("other.jsonl").write_bytes(write_trace(other_logs()[kind]))
    (entry,) = results("certify --check run.cert --log other.jsonl", code=1)["results"]
    assert (entry["accepted"], entry["why"]) == (False, "the certificate is about another log")
    text = call("certify --check run.cert --log other.jsonl").stdout
    assert "REFUSED by topo-verify: the certificate is about another log" in text


# ---------------------------------------------------------------- unreadable


@pytest.mark.parametrize(
    "text",
    [
        "",
        "topo-verify/certificate 2\n1 2 3\n",
        TEXT + "(* a comment *)\n",
        TEXT.replace("\n1", "\n(* 1 *) 1", 1),
        TEXT + "Definition world W := True.\n",
        HEADER + "\n].\nModule Topo. End Topo.\n",
        HEADER + "\n1 -1\n",
        HEADER + "\n0x10\n",
        HEADER + "\n1\r\n",
        HEADER + "\n\u0661\n",
        "(* A certificate *)\nTheorem proved : True.\nProof. exact I. Qed.\n",
    ],
)
def test_what_is_not_data_is_not_read(refused: Refused, text: str) -> None:
    Path("bad.cert").write_bytes(text.encode())
    refused("certify --check bad.cert", "bad.cert", "expected")


def test_the_place_of_what_is_not_data_is_told(call: Call) -> None:
    Path("bad.cert").write_text(HEADER + "\n1 2\n3 x\n")
    stderr = " ".join(call("certify --check bad.cert").stderr.split())
    assert "bad.cert, line 3: expected natural numbers, spaces and line ends, got 'x'" in stderr


@pytest.mark.parametrize(
    "line",
    [
        "certify",
        "certify --log run.jsonl",
        "certify run.jsonl --check run.cert",
        "certify --check run.cert --kernel",
        "certify --check run.cert -o map.json",
        "certify --check nowhere.cert",
        "certify --check run.cert --log nowhere.jsonl",
        "certify --check run.cert --log run.cert",
    ],
)
def test_what_cannot_be_done_is_said_in_one_sentence(call: Call, line: str) -> None:
    assert call(line).exit_code == 2


# ---------------------------------------------------------------- not checked


def test_without_coq_nothing_is_accepted(
    results: Results, call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shutil, "which", nowhere)
    (entry,) = results("certify --check run.cert", code=3)["results"]
    assert (entry["accepted"], entry["by"]) == (None, "")
    assert "apt-get install" in entry["why"]
    assert "NOT CHECKED" in call("certify --check run.cert").stdout


@pytest.fixture
def own_version() -> Iterator[None]:
    """What another coqc says is forgotten."""
    yield
    toolchain.version.cache_clear()


@pytest.mark.usefixtures("own_version")
@pytest.mark.parametrize("file", ["World.v", "Data.v", "Checked.v"])
@pytest.mark.parametrize("how", ENDED)
def test_a_coqc_that_was_killed_or_lacked_memory_has_refused_nothing(
    results: Results, call: Call, monkeypatch: pytest.MonkeyPatch, how: str, file: str
) -> None:
    put_coqc(monkeypatch, ENDED[how], file)
    (entry,) = results("certify --check run.cert", code=3)["results"]
    assert (entry["accepted"], entry["statement"]) == (None, None)
    assert "coqc " in entry["why"]
    assert "NOT CHECKED: coqc " in call("certify --check run.cert").stdout
    # A certificate of our own that coqc refuses would be a bug of ours, exit code 70.
    (entry,) = results("certify run.jsonl --kernel", code=3)["results"]
    assert (entry["verdict"], entry["kernel"]["accepted"]) == ("PROVED", None)


@pytest.mark.usefixtures("own_version")
@pytest.mark.parametrize("file", ["World.v", "-print-version"])
def test_a_coqc_that_was_killed_refutes_no_theorem(
    results: Results, monkeypatch: pytest.MonkeyPatch, file: str
) -> None:
    put_coqc(monkeypatch, ENDED["killed"], file)
    (entry,) = results("prove coq-certificate --timeout 77", code=3)["results"]
    assert (entry["verdict"], entry["ok"]) == ("UNKNOWN", False)
    if file == "World.v":
        assert "coqc was ended by signal 9" in entry["note"]
