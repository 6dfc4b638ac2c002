"""The part `proofs` of the main job."""

from __future__ import annotations

import pytest

from topo_verify.proofs.catalogue import CONTROLS, choose
from topo_verify.proofs.first_order.theorems import OBLIGATIONS, mutant
from topo_verify.studies.verify.parts import Proofs

pytestmark = pytest.mark.usefixtures("proved_once")


def silence(_part: str, _done: int, _total: int) -> None:
    pass


@pytest.mark.nightly
def test_all_that_is_quick_comes_out_as_it_must() -> None:
    job = Proofs()
    job.work(silence)
    part = job.part()
    assert (part.part, part.verdict, part.ok) == ("proofs", "PROVED", True), part.summary
    assert part.checked == part.total == len(OBLIGATIONS) + len(CONTROLS)
    assert not part.findings


@pytest.mark.long
def test_quick_is_the_inductive_theorems_alone() -> None:
    job = Proofs(quick=True)
    job.work(silence)
    part = job.part()
    assert (part.verdict, part.checked) == ("PROVED", len(OBLIGATIONS))
    assert part.summary == f"{part.total} of {part.total} theorems proved for any size"


def test_a_mutant_that_is_not_refuted_is_a_finding() -> None:
    final = next(one for one in OBLIGATIONS if one.name == "confirm-final")
    harmless = mutant(final, "map-v0-sees-root")  # the other premises imply it
    job = Proofs([*choose(["percept"]), harmless])
    job.work(silence)
    part = job.part()
    assert (part.verdict, part.ok, part.failing) == ("REFUTED", False, 1)
    (finding,) = part.findings
    assert "confirm-final-without-map-v0-sees-root" in finding.message
    assert finding.replay.startswith("topo-verify prove confirm-final")


def test_work_that_was_cut_off_is_unknown() -> None:
    def interrupt(_part: str, done: int, _total: int) -> None:
        if done:
            raise KeyboardInterrupt

    job = Proofs(choose(["percept", "trace-step"]))
    with pytest.raises(KeyboardInterrupt):
        job.work(interrupt)
    part = job.part(interrupted=True)
    assert (part.verdict, part.checked, part.total) == ("UNKNOWN", 1, 2)
    assert "interrupted" in part.summary
