"""Fixtures of other rooms, for the tests of this one."""

from __future__ import annotations

from tests.cli.conftest import call, few_worlds_run_again, folder, refused, results
from tests.proofs.mechanised.conftest import library, linked, place

__all__ = [
    "call",
    "few_worlds_run_again",
    "folder",
    "library",
    "linked",
    "place",
    "refused",
    "results",
]
