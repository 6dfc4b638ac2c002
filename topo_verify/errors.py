"""What can go wrong, sorted by whose move it is to mend it.

One base, three children: the caller's mistake (`InputError`), a claim that does not hold
(`ClaimFailed`), a bug of ours (`InternalError`). The command line turns them into the exit
codes 2, 1 and 70.
"""


class TopoVerifyError(Exception):
    """Base of every exception that topo_verify raises on purpose."""


class InputError(TopoVerifyError, ValueError):
    """What came in cannot be used: one sentence that names the input, the place and the mend."""


class ClaimFailed(TopoVerifyError, AssertionError):
    """A mapper was examined and at least one claim does not hold; the text is the report."""


class InternalError(TopoVerifyError):
    """topo_verify contradicts itself: please report it with the world and the command line."""
