"""`topo-verify replay --kernel`: the judge that is proved in Coq judges the run as well."""

from __future__ import annotations

import shutil
from pathlib import Path
from unittest.mock import Mock

import msgspec
import pytest

from tests.cli.conftest import Call, Results
from tests.helpers import trace_of
from tests.proofs.mechanised.conftest import nowhere
from topo_verify import World
from topo_verify.checkers import CLAIMS, check
from topo_verify.cli.replay import ProvedOpinion
from topo_verify.extra.certificates import judge
from topo_verify.proofs.mechanised import toolchain


@pytest.fixture
def trace(call: Call, folder: Path) -> Path:
    """The trace of `basic` in m5/17."""
    call("explore m5/17 --target basic --trace basic.jsonl")
    return folder / "basic.jsonl"


def opinion(monkeypatch: pytest.MonkeyPatch, *, more: int = 0) -> None:
    """Have the judge say what the checkers say, but that `more` of the last claim was judged."""
    checked = check(World.from_id("m5/17"), trace_of("m5/17"))
    told = [*checked]
    told[-1] = msgspec.structs.replace(told[-1], judged=told[-1].judged + more)
    answer = ProvedOpinion("the judge", tuple(told))
    monkeypatch.setattr(judge, "second_opinion", Mock(return_value=answer))


def test_the_output_says_that_the_proved_judge_judged(
    results: Results, call: Call, trace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opinion(monkeypatch)
    (entry,) = results(f"replay {trace.name} --kernel")["results"]
    assert (entry["kernel"]["by"], entry["kernel"]["why"]) == ("the judge", "")
    assert [one["claim"] for one in entry["kernel"]["judgements"]] == [*CLAIMS]
    said = "Judged again by the judge: the same of 10 of 10 claims."
    assert said in call(f"replay {trace.name} --kernel").stdout


def test_a_proved_judge_that_says_otherwise_is_a_bug_of_ours(
    call: Call, trace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opinion(monkeypatch, more=1)
    done = call(f"replay {trace.name} --kernel")
    assert done.exit_code == 70
    assert "the checkers say otherwise" in done.stderr


def test_without_coq_the_proved_judge_judges_nothing(
    results: Results, trace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shutil, "which", nowhere)
    (entry,) = results(f"replay {trace.name} --kernel", code=3)["results"]
    assert entry["kernel"]["by"] == ""
    assert "apt-get install" in entry["kernel"]["why"]
    assert results(f"replay {trace.name}")["results"][0]["kernel"] is None


@pytest.mark.coq
@pytest.mark.skipif(bool(judge.missing()), reason=judge.missing())
@pytest.mark.nightly
def test_the_proved_judge_is_built_and_judges(results: Results, trace: Path) -> None:
    (entry,) = results(f"replay {trace.name} --kernel")["results"]
    assert entry["kernel"]["by"] == f"the judge extracted by {toolchain.version()}"
