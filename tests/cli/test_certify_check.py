"""`topo-verify certify --check`: a certificate that somebody sends, accepted or refused."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.conftest import Call, Results
from tests.helpers import edited, place, trace_of
from tests.proofs.mechanised.conftest import nowhere
from topo_verify import families
from topo_verify.proofs.mechanised import certificates, toolchain
from topo_verify.proofs.mechanised.certificate_format import HEADER, text_of
from topo_verify.robot.events import Event, Move, Reject, write_trace
from topo_verify.robot.percept import Percept

RUN = trace_of(families.lattice(3, 3))
TEXT = text_of(certificates.certificate_of(RUN))

needs_coq = pytest.mark.skipif(bool(toolchain.missing()), reason=toolchain.missing())


@pytest.fixture(autouse=True)
def files(folder: Path) -> None:
    """A log and its certificate."""
    (folder / "run.jsonl").write_bytes(write_trace(RUN))
    (folder / "run.cert").write_text(TEXT)


@pytest.fixture
def compiled(library: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The library is not compiled again."""

    def link(folder: Path, *, timeout: float) -> None:
        del timeout
        for path in library.glob("*.v*"):
            (folder / path.name).symlink_to(path)

    monkeypatch.setattr(certificates, "build", link)


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
def test_what_is_not_data_is_not_read(call: Call, text: str) -> None:
    Path("bad.cert").write_bytes(text.encode())
    done = call("certify --check bad.cert")
    assert done.exit_code == 2
    assert "bad.cert" in done.stderr
    assert "expected" in done.stderr


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
