"""A fresh Python, as tests start it."""

from __future__ import annotations

import os
import subprocess
import sys
from typing import Any


def python(
    *words: object,
    environment: dict[str, str] | None = None,
    check: bool = False,
    **options: Any,
) -> subprocess.CompletedProcess[str]:
    """Run Python with these words; what it prints and its exit code are in the result.

    Args:
        environment: what is set beside our own variables.
        options: those of `subprocess.run`.
    """
    return subprocess.run(
        [sys.executable, *map(str, words)],
        env={**os.environ, **(environment or {})},
        capture_output=True,
        text=True,
        check=check,
        **options,
    )
