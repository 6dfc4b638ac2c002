"""The library in Coq, for the tests of this extra."""

from __future__ import annotations

from tests.proofs.mechanised.conftest import library, linked, place

__all__ = ["library", "linked", "place"]
