"""Kernels read words by names, so a wrong name is an error of types: five mistakes, planted.

Each line with `type: ignore` plants one. mypy and pyright, both strict, refuse an ignore that has
nothing to ignore: should one of them let a mistake pass, the check of types fails here. What is no
name at all the step from names to offsets refuses, too.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable

import pytest

from topo_verify.extra.fast.kernels import events, workspace
from topo_verify.extra.fast.kernels.events import CONFIRM, MoveWords
from topo_verify.extra.fast.kernels.judging.layout import CaseWords
from topo_verify.extra.fast.kernels.judging.truth import follow_move
from topo_verify.extra.fast.kernels.names import Flat
from topo_verify.extra.fast.kernels.robot import declare
from topo_verify.extra.fast.kernels.workspace import RunWords


def right(run: RunWords, d: int) -> int:
    move = MoveWords(run, d)
    declare(run, CONFIRM, d, move.door, 0)
    run.robot.cost = run.chart.degree[run.chart.vertex[d]]
    return run.robot.cost


def wrong_field(run: RunWords, v: int) -> int:
    return run.chart.frist[v]  # type: ignore[attr-defined,no-any-return]  # pyright: ignore[reportAttributeAccessIssue, reportUnknownMemberType, reportUnknownVariableType]


def wrong_table(run: RunWords, d: int) -> int:
    return run.world.percept[d]  # type: ignore[attr-defined,no-any-return]  # pyright: ignore[reportAttributeAccessIssue, reportUnknownMemberType, reportUnknownVariableType]


def row_for_a_word(run: RunWords) -> None:
    run.robot.cost = run.chart.alpha  # type: ignore[assignment]  # pyright: ignore[reportAttributeAccessIssue]


def missing_cursor(run: RunWords, case: CaseWords, i: int) -> None:
    follow_move(run, case, i)  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]


def missing_argument(run: RunWords, e: int, h: int) -> None:
    declare(run, CONFIRM, e, h)  # type: ignore[call-arg]  # pyright: ignore[reportCallIssue]


def flat(kernel: Callable[..., object]) -> str:
    """The kernel over arrays and offsets."""
    (node,) = ast.parse(inspect.getsource(kernel)).body
    assert isinstance(node, ast.FunctionDef)
    return ast.unparse(Flat({**vars(events), **vars(workspace)}).visit_FunctionDef(node))


@pytest.mark.parametrize("kernel", [wrong_field, wrong_table, row_for_a_word])
def test_a_wrong_name_is_refused(kernel: Callable[..., object]) -> None:
    with pytest.raises(TypeError, match=r"no such name|is a row of words"):
        flat(kernel)


def test_right_names_are_offsets() -> None:
    assert "W[W_ROBOT_COST] = W[W_CHART_DEGREE + W[W_CHART_VERTEX + d]]" in flat(right)
