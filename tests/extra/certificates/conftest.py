"""The library in Coq, for the tests of this extra."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.proofs.mechanised.conftest import library, linked, place
from topo_verify.extra.certificates import certificates

__all__ = ["library", "linked", "place"]


@pytest.fixture
def compiled(library: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The library is not compiled again."""

    def link(folder: Path, *, timeout: float) -> None:
        del timeout
        for path in library.glob("*.v*"):
            (folder / path.name).symlink_to(path)

    monkeypatch.setattr(certificates, "build", link)
