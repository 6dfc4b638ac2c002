"""Native mappers for tests, compiled by cc; a test is skipped where there is none."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from topo_verify.programs.library import header_text

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples" / "native_c" / "mapper.c"
HOSTILE = ROOT / "tests" / "programs" / "hostile.c"
MISDEEDS = ROOT / "tests" / "campaign" / "misdeeds.c"
HOSTILE_NUMBA = ROOT / "tests" / "extra" / "fast" / "hostile_numba.py"


def built(folder: Path, *options: str, source: Path = EXAMPLE) -> str:
    """The TARGET of a native mapper, compiled with these options."""
    if shutil.which("cc") is None:
        pytest.skip("cc is not installed")
    (folder / "topo_verify.h").write_text(header_text(), encoding="utf-8")
    name = "".join(c for c in "".join((source.stem, *options)) if c.isalnum())
    line = ["cc", "-O1", "-w", "-shared", "-fPIC", f"-I{folder}", *options]
    subprocess.run([*line, "-o", folder / f"{name}.so", source], check=True)
    return f"--library {folder / f'{name}.so'}"


def hostile(folder: Path, deed: str) -> str:
    """The TARGET of a mapper that does this in worlds whose marker is at a place of degree 4."""
    return built(folder, f"-DDEED={deed}", source=HOSTILE)


def misdeeds(folder: Path) -> str:
    """The TARGET of the mapper that does what MISDEEDS says in certain calls of a process."""
    return built(folder, f"-I{EXAMPLE.parent}", source=MISDEEDS)
