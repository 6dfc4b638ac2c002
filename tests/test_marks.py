"""Which tests run where: the marks of parameters, and the rooms that `make test` traces."""

from __future__ import annotations

import pytest

from tests.conftest import ROOT, TRACED
from tests.marks import with_marks


def test_the_parameters_that_are_named_are_marked() -> None:
    parameters = with_marks("abc", long=["a"], nightly=["c"])
    assert [one.values for one in parameters] == [("a",), ("b",), ("c",)]
    assert [[mark.name for mark in one.marks] for one in parameters] == [["long"], [], ["nightly"]]


def test_a_name_that_no_parameter_has_is_refused() -> None:
    with pytest.raises(ValueError, match="'d'"):
        with_marks("abc", nightly=["d"])


def test_make_collects_the_traced_tests_of_every_traced_room() -> None:
    assert f"foreach room,{' '.join(TRACED)}," in (ROOT / "Makefile").read_text(encoding="utf-8")
