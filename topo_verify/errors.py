"""Exceptions, grouped by who must act: the caller, the mapper's author, or us.

They are `InputError`, `ClaimFailed` (with `ClaimUndecided`) and `InternalError`; the command line
turns them into the exit codes 2, 1 (3) and 70.
"""

from __future__ import annotations

from topo_verify.text import LINE, shown


class TopoVerifyError(Exception):
    """Base of every exception that topo_verify raises on purpose."""


class InputError(TopoVerifyError, ValueError):
    """The input cannot be used; the text is one sentence: the input, the place and the mend.

    The sentence may quote a file's name or content, so its control characters are escaped.
    """

    def __init__(self, sentence: str) -> None:
        super().__init__(shown(sentence, limit=LINE))


class ClaimFailed(TopoVerifyError, AssertionError):
    """At least one claim does not hold for the mapper; the text is the report."""


class ClaimUndecided(TopoVerifyError, AssertionError):
    """No claim fails, but one was neither proved nor refuted; the text names it, with the report.

    What is not decided is no success. Where it is none of yours, catch it: `pytest.skip`, or
    `hypothesis.reject`.
    """


class InternalError(TopoVerifyError):
    """topo_verify contradicts itself: please report it with the world and the command line."""
