"""`prove --solver cvc5` and `prove --certify`: what they add, and what a missing package says."""

from __future__ import annotations

import sys

import pytest

from tests.cli.conftest import Call, Refused, Results

PACKAGES = {"--solver cvc5": "cvc5", "--certify": "drup"}


def test_a_second_solver_and_a_certificate_stand_in_the_result(results: Results) -> None:
    for module in ("cvc5", "drup", "pysat"):
        pytest.importorskip(module, reason=f"{module} is not installed: topo-verify[sat]")
    line = "prove bounded-closed --edges 2 --solver cvc5 --certify"
    (entry,) = results(line)["results"]
    assert entry["opinion"]["agrees"] == entry["opinion"]["total"] == 2
    assert entry["certificate"]["checked"]


def test_without_the_options_there_is_neither(results: Results) -> None:
    (entry,) = results("prove bounded-closed --edges 2")["results"]
    assert (entry["opinion"], entry["certificate"]) == (None, None)


@pytest.mark.parametrize("option", PACKAGES)
def test_a_missing_package_is_named_before_the_work(
    option: str, refused: Refused, call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, PACKAGES[option], None)
    refused(f"prove percept {option}", PACKAGES[option], "-m pip install 'topo-verify[sat]'")
    assert call(f"prove percept --list {option}").exit_code == 0
    assert call("prove percept").exit_code == 0
