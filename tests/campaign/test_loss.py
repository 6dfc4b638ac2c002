"""What a lost process means: the table, as sentences."""

from __future__ import annotations

import pytest

from topo_verify.campaign.loss import MEANING, Loss


def test_a_right_mapper_does_not_crash() -> None:
    crashed = {lost: meaning for lost, meaning in MEANING.items() if lost[1] == "crashed"}
    ours = {lost for lost in crashed if lost[0] in ("process", "worker")}
    assert {crashed[lost] for lost in ours} == {"fails"}


def test_a_signal_that_others_send_convicts_only_a_mapper_that_fails_without_it() -> None:
    killed = {lost for lost, meaning in MEANING.items() if "killed" in lost and meaning == "fails"}
    assert killed == {("process", "killed", "wrong")}


def test_a_second_try_that_is_right_takes_nothing_back() -> None:
    """It leaves the world undecided, or the first try is a finding: never simply right."""
    assert {lost[1] for lost in MEANING if lost[2] == "right"} >= {"crashed", "killed", "silent"}
    assert {*MEANING.values()} == {"fails", "undecided"}


@pytest.mark.parametrize(
    ("loss", "by_chance"),
    [
        (Loss("worker", "crashed", "right"), True),
        (Loss("worker", "crashed", "lost"), False),
        (Loss("worker", "killed", "lost"), True),
        (Loss("process", "killed", "wrong"), False),
    ],
)
def test_another_run_may_end_differently_after_a_try_that_was_right_or_decided_nothing(
    loss: Loss, *, by_chance: bool
) -> None:
    assert loss.is_by_chance == by_chance


def test_a_case_that_the_table_lacks_is_no_verdict() -> None:
    with pytest.raises(KeyError):
        _ = Loss("machine", "memory", "right").meaning
