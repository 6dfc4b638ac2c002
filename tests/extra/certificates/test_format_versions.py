"""Every version of the format of certificates: a stored one is read and accepted."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.formats import Format, files_of, missing
from tests.proofs.mechanised.conftest import LIMIT
from topo_verify.extra.certificates import certificates
from topo_verify.extra.certificates.certificate_format import HEADER, parse
from topo_verify.robot.events import read_trace

STORED = Path(__file__).parent / "formats"


def numbers_in(path: Path) -> list[int]:
    return parse(path.read_bytes(), name=path.name)


def read_certificate(path: Path) -> None:
    log = read_trace(path.with_suffix(".jsonl").read_bytes())
    assert certificates.is_about(numbers_in(path), log)


FORMATS = (Format("certificate", int(HEADER.rpartition(" ")[2]), read_certificate),)

FILES = files_of(STORED, FORMATS, without=[".jsonl"])


@pytest.mark.parametrize(("kind", "version", "file"), FILES)
def test_a_stored_certificate_is_read(kind: Format, version: int, file: Path) -> None:
    assert version not in kind.refused
    kind.read(file)


@pytest.mark.coq
@pytest.mark.parametrize(("kind", "version", "file"), FILES)
def test_a_stored_certificate_is_accepted(
    kind: Format, version: int, file: Path, place: Path
) -> None:
    assert version <= kind.version
    checked = certificates.by_kernel(place, numbers_in(file), timeout=LIMIT)
    assert (checked.accepted, checked.certified) == (True, 3)


def test_a_certificate_of_every_version_is_stored() -> None:
    assert missing(STORED, FORMATS) == []
